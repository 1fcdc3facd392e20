//! `mode13h palette`: look at a palette, convert it, or make one for a model.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::Args;
use mode13h::export::{self, Picture, PixelShape, Png, Scale};
use mode13h::mesh::obj;
use mode13h::palette::auto::Entries;
use mode13h::palette::file::Format;
use mode13h::palette::{Palette, builtin};

use crate::failure::Failure;
use crate::options::{self, Up};
use crate::turntable::Turntable;
use crate::{input, output, read_files};

#[derive(Args)]
pub(crate) struct Options {
    #[arg(value_name = "FILE|NAME", required_unless_present = "from", help = help())]
    palette: Option<OsString>,
    /// Make one for a model: black, a ramp for each of its materials by how much of it is seen over a turn, colours for
    /// its textures, white
    #[arg(long, value_name = "MODEL", conflicts_with = "palette")]
    from: Option<OsString>,
    /// The axis of that model that points up
    #[arg(long, value_name = "AXIS", value_enum, default_value = "y", conflicts_with = "palette")]
    up: Up,
    /// Show an edge where faces of that model without normals meet at more than this angle [default: the model's smoothing
    /// groups, or else 40; scans are smooth]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = options::crease, conflicts_with = "palette")]
    crease: Option<f32>,
    /// Write it to a file, in the format of its extension; .png makes a chart of the colours
    #[arg(short, long, value_name = "OUT")]
    out: Option<PathBuf>,
}

fn help() -> String {
    format!("A file ({}), or a built-in palette: {}", input::palette_extensions(), input::palette_names())
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let (name, palette, made) = match (&options.from, &options.palette) {
        (Some(model), _) => make(model, options.up, options.crease, options.out.as_deref())?,
        (None, words) => {
            let (name, palette) = input::palette(words.as_deref().unwrap_or_default())?;
            options.out.as_deref().map_or(Ok(()), read_files::spare)?;
            (name, palette, String::new())
        }
    };
    match &options.out {
        None => output::print(&(look(&name, &palette) + &made)),
        Some(out) => convert(&name, &palette, out),
    }
}

/// A palette for a model, to be written to `out`: what to call it, the palette, and what is where in it, a line for each surface.
fn make(model: &OsStr, up: Up, crease: Option<f32>, out: Option<&Path>) -> Result<(String, Palette, String), Failure> {
    let input::Model { name, mesh } = input::model(model, &obj::Options { crease })?;
    out.map_or(Ok(()), read_files::spare)?;
    let textures = input::textures(&mesh);
    let mut stage = Turntable::of_model(mesh, up.into(), &textures);
    let automatic = stage.automatic().map_err(Failure::work)?.clone();
    let mut lines = String::new();
    let materials = stage.scene.objects().iter().flat_map(|object| &object.materials);
    for (material, entries) in materials.zip(automatic.entries.iter().flatten()) {
        let (entries, what) = match entries {
            Entries::Ramp { ramp, .. } => (ramp, "a ramp"),
            Entries::Textures { block } => (block, "colours of textures"),
            _ => continue,
        };
        let material = if material.name.is_empty() { &name } else { &material.name };
        let line = format!("{material}: {what}, entries {} to {}", entries.first(), entries.last());
        // A name may hold anything; no terminal is sent it.
        lines.extend(line.chars().map(|c| if c.is_control() { ' ' } else { c }).chain(['\n']));
    }
    Ok((name, automatic.palette, lines))
}

fn convert(name: &str, palette: &Palette, out: &Path) -> Result<(), Failure> {
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    if extension.eq_ignore_ascii_case("png") {
        return output::file(|| chart(palette, out)).map_err(Failure::work);
    }
    let Some(format) = Format::by_extension(&extension) else {
        let known = input::palette_extensions();
        let reason = format!("{}: no kind of palette that can be written: {known}, or .png", out.display());
        return Err(Failure::words(reason));
    };
    let bytes = format.write(palette, name);
    output::file(|| export::write_atomically(out, |file| file.write_all(&bytes))).map_err(Failure::work)
}

/// The 256 colours in 16 rows of 16, each a square of 16 pixels.
fn chart(palette: &Palette, out: &Path) -> Result<(), export::ExportError> {
    let indices: Vec<u8> = (0..=255).collect();
    let squares = Picture {
        pixels: &indices,
        width: 16,
        height: 16,
        pitch: 16,
        palette: palette.colors(),
        shape: PixelShape::SQUARE,
    };
    Png { scale: Scale::To { width: 256, height: 256 }, rgb: false }.save(&squares, out)
}

/// The palette as text: what it is, and its colours; painted where the terminal can.
fn look(name: &str, palette: &Palette) -> String {
    let ramps = match palette.ramps() {
        0 => "no ramps".to_string(),
        1 => "1 ramp of 256".to_string(),
        ramps => format!("{ramps} ramps of {}", 256 / ramps),
    };
    let provenance = builtin::by_name(name).map_or("", |builtin| builtin.provenance);
    let mut text = format!("{name}: {ramps}. {provenance}").trim_end().to_string() + "\n";
    let painted = output::is_colored_terminal();
    let in_a_row = if painted { 32 } else { 8 };
    for (row, colors) in palette.colors().chunks(in_a_row).enumerate() {
        text += &format!("{:3}", row * in_a_row);
        for color in colors {
            text += &if painted {
                format!("\x1b[48;2;{};{};{}m  ", color.r, color.g, color.b)
            } else {
                format!(" {:06x}", color.to_u32())
            };
        }
        text += if painted { "\x1b[0m\n" } else { "\n" };
    }
    text
}
