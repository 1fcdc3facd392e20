//! `mode13h palette`: look at a palette, convert it, or make one for a model.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use mode13h::Angle;
use mode13h::export::{self, Picture, Png, Scale};
use mode13h::palette::builtin::Builtin;
use mode13h::palette::{Palette, builtin};
use mode13h::scene::UpAxis;
use mode13h_assets::auto_palette::Entries;
use mode13h_assets::model_file;
use mode13h_assets::palette_file::Format;
use serde::Serialize;
use serde_json::{Value, json};

use crate::failure::{Failure, on_one_line};
use crate::{input, options, output, read_files};

#[derive(Args)]
#[command(group(ArgGroup::new("what").args(["palette", "from"])))]
pub(crate) struct Options {
    #[arg(
        value_name = "FILE|NAME",
        help = "A palette file, or the name of a built-in palette",
        long_help = long_help(),
    )]
    palette: Option<OsString>,
    /// Make a palette for a model
    ///
    /// It holds black, white, a ramp for each material and colours for the textures. The more of a material is visible over
    /// a turn of the model, the longer its ramp.
    #[arg(long, value_name = "MODEL")]
    from: Option<OsString>,
    /// Choose which model axis points up [default: y; z for a flat sheet facing z]
    #[arg(long, value_name = "AXIS", value_parser = options::axis(), requires = "from", conflicts_with = "palette")]
    up: Option<UpAxis>,
    /// Keep the model's edges sharp above DEGREES, if it has no normals
    ///
    /// [default: the model's smoothing groups, or else 40; scans are smooth]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = options::crease, requires = "from", conflicts_with = "palette")]
    crease: Option<Angle>,
    /// Convert to FILE, in the format given by its extension; .png draws a chart
    #[arg(short, long, value_name = "FILE", conflicts_with = "json")]
    out: Option<PathBuf>,
    /// Print the colours as JSON
    #[arg(long)]
    json: bool,
}

fn long_help() -> String {
    format!(
        "A palette file ({}), an indexed picture (.png, .gif, .pcx, .aseprite), or the name of a built-in palette; \
         `mode13h list palettes` shows those",
        input::palette_extensions()
    )
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { from, palette, up, crease, out, json } = options;
    let (name, palette, made) = match (from, palette) {
        (Some(model), _) => make(model, *up, *crease, out.as_deref())?,
        (None, Some(words)) => {
            let (name, palette) = input::palette(words)?;
            out.as_deref().map_or(Ok(()), read_files::spare)?;
            (name, palette, Vec::new())
        }
        (None, None) => {
            return Err(Failure::words(
                "no palette: give FILE|NAME or --from MODEL; `mode13h list palettes` shows the built-in ones",
            ));
        }
    };
    match out {
        Some(out) => convert(&name, &palette, out),
        None if *json => output::print_json(&as_json(&name, &palette, &made)),
        None => {
            let made: String = made.iter().map(Made::line).collect();
            output::print(&(look(&name, &palette) + &made))
        }
    }
}

/// The contents of a built-in palette, and where it comes from.
pub(crate) fn summary(builtin: &Builtin) -> String {
    format!("{}. {}", ramps(builtin.palette), builtin.provenance).trim_end().to_string()
}

fn as_json(name: &str, palette: &Palette, made: &[Made]) -> Value {
    let colors = palette.colors().iter().map(|color| format!("#{:06x}", color));
    json!({
        "schema": output::SCHEMA,
        "name": name,
        "ramps": palette.ramps(),
        "colors": colors.collect::<Vec<_>>(),
        "materials": made,
    })
}

/// Entries that a palette made for a model holds for one of its materials.
#[derive(Serialize)]
struct Made {
    material: String,
    what: &'static str,
    first: u8,
    last: u8,
}

impl Made {
    fn line(&self) -> String {
        let Made { material, what, first, last } = self;
        // A name may contain anything, so it is not sent to a terminal as it is.
        on_one_line(&format!("{material}: {what}, entries {first} to {last}")) + "\n"
    }
}

/// Makes a palette for a model, to be written to `out`. Returns what to call it, the palette, and what its entries are
/// for.
fn make(
    model: &OsStr,
    up: Option<UpAxis>,
    crease: Option<Angle>,
    out: Option<&Path>,
) -> Result<(String, Palette, Vec<Made>), Failure> {
    let model = input::model(model, &model_file::Options { crease })?;
    out.map_or(Ok(()), read_files::spare)?;
    let name = model.name.clone();
    let mut stage = model.stage(up, false)?;
    let automatic = stage.automatic()?;
    let mut made = Vec::new();
    let materials = stage.scene.objects().iter().flat_map(|object| &object.materials);
    for (material, entries) in materials.zip(automatic.entries.iter().flatten()) {
        let (entries, what) = match entries {
            Entries::Ramp { ramp, .. } => (ramp, "a ramp"),
            Entries::Textures { block } => (block, "colours of textures"),
            _ => continue,
        };
        let material = if material.name.is_empty() { name.clone() } else { material.name.clone() };
        made.push(Made { material, what, first: entries.first(), last: entries.last() });
    }
    Ok((name, automatic.palette, made))
}

fn convert(name: &str, palette: &Palette, out: &Path) -> Result<(), Failure> {
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    if extension.eq_ignore_ascii_case("png") {
        return output::file(out, || chart(palette, out));
    }
    let Some(format) = Format::by_extension(&extension) else {
        let known = input::palette_extensions();
        let reason = format!("{}: not a palette format that can be written: {known}, or .png", out.display());
        return Err(Failure::words(reason));
    };
    output::bytes(out, &format.write(palette, name))
}

/// The 256 colours in 16 rows of 16, each a square of 16 pixels.
fn chart(palette: &Palette, out: &Path) -> Result<(), export::ExportError> {
    let indices: Vec<u8> = (0..=255).collect();
    let squares = Picture::of(&indices, 16, palette);
    Png { scale: Scale::To { width: 256, height: 256 }, rgb: false }.save(&squares, out)
}

fn ramps(palette: &Palette) -> String {
    match palette.ramps() {
        0 => "no ramps".to_string(),
        1 => "1 ramp of 256".to_string(),
        ramps => format!("{ramps} ramps of {}", 256 / ramps),
    }
}

/// The palette as text: what it is, and its colours, painted if the terminal can show them.
fn look(name: &str, palette: &Palette) -> String {
    // A file may have the name of a built-in palette.
    let builtin = builtin::by_name(name).filter(|builtin| *builtin.palette == *palette);
    let provenance = builtin.map_or("", |builtin| builtin.provenance);
    let mut text = format!("{name}: {}. {provenance}", ramps(palette)).trim_end().to_string() + "\n";
    let painted = output::is_colored_terminal();
    let in_a_row = if painted { 32 } else { 8 };
    for (row, colors) in palette.colors().chunks(in_a_row).enumerate() {
        text += &format!("{:3}", row * in_a_row);
        for color in colors {
            text += &if painted {
                format!("\x1b[48;2;{};{};{}m  ", color.r, color.g, color.b)
            } else {
                format!(" {:06x}", color)
            };
        }
        text += if painted { "\x1b[0m\n" } else { "\n" };
    }
    text
}
