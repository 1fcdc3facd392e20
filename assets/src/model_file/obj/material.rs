//! MTL files, and the materials in them that a model uses.

use core::iter;
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use mode13h::mesh::Surface;

use super::line::{Lines, keyword, number, numbers};
use super::statement::Statements;
use crate::model_file::warnings::{LeftOut, Warnings};
use crate::model_file::word::{name, shown_name, sibling_path, words};
use crate::model_file::{ModelFileError, ModelFileErrorKind};

/// The surfaces for `model.names`, in their order.
pub(super) fn surfaces(
    model: &Statements,
    path: &Path,
    library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    warnings: &mut Warnings,
) -> Result<Vec<Surface>, ModelFileError> {
    let mut known = HashMap::new();
    let mut all_read = true;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = Files { folder, library, read: HashMap::new() };
    for (line, text) in &model.libraries {
        // One name that may contain blanks, or several names; or with folders in Windows notation.
        let slashed = text.replace('\\', "/");
        let mut found = files
            .find(iter::once(text.as_str()))
            .or_else(|error| if slashed == *text { Err(error) } else { files.find(iter::once(slashed.as_str())) });
        if found.is_err() && text.split_whitespace().nth(1).is_some() {
            found = files.find(slashed.split_whitespace()).or(found);
        }
        match found {
            Ok(paths) => {
                for path in paths {
                    if let Some(bytes) = files.read.get_mut(&path).and_then(Option::take) {
                        read(&bytes, &path, &mut known, warnings)?;
                    }
                }
            }
            Err(error) => {
                all_read = false;
                let path = path.display();
                warnings.push(|| {
                    let name = shown_name(text);
                    format!("{path}:{line}: cannot read {name} ({error}); materials are white and matt")
                });
            }
        }
    }
    let mut surfaces = Vec::new();
    for (name, line) in model.names.iter().zip(&model.name_lines) {
        surfaces.push(known.get(name).cloned().unwrap_or_else(|| {
            // A missing file has already been reported.
            if all_read && !name.is_empty() {
                let path = path.display();
                warnings.push(|| {
                    format!("{path}:{line}: there is no material {}; it is white and matt", shown_name(name)) //
                });
            }
            Surface { name: name.clone(), ..Surface::default() }
        }));
    }
    warn_of_no_exponent(&surfaces, path, warnings);
    Ok(surfaces)
}

/// Warns, once for the model, of surfaces with a `Ks` but no `Ns` above 0: they are drawn without a highlight.
fn warn_of_no_exponent(surfaces: &[Surface], path: &Path, warnings: &mut Warnings) {
    let has_none = |surface: &&Surface| surface.specular != [0.0; 3] && surface.shininess <= 0.0;
    let mut without = surfaces.iter().filter(has_none);
    let Some(first) = without.next() else { return };
    let others = match without.count() {
        0 => String::new(),
        1 => " and one other".into(),
        more => format!(" and {more} others"),
    };
    let (path, name) = (path.display(), &first.name);
    warnings.push(|| format!("{path}: material {name}{others}: Ks without an Ns above 0 gives no highlight"));
}

/// The MTL files that a model names. Each is read once, however often it is named.
struct Files<'a, L> {
    folder: &'a Path,
    library: L,
    /// The bytes of each file; `None` once its materials have been taken.
    read: HashMap<PathBuf, Option<Vec<u8>>>,
}

impl<L: FnMut(&Path) -> io::Result<Vec<u8>>> Files<'_, L> {
    /// The paths of these files, if all can be read.
    fn find<'n>(&mut self, names: impl Iterator<Item = &'n str>) -> io::Result<Vec<PathBuf>> {
        names
            .map(|name| {
                let path = self.folder.join(name);
                if !self.read.contains_key(&path) {
                    let bytes = (self.library)(&path)?;
                    self.read.insert(path.clone(), Some(bytes));
                }
                Ok(path)
            })
            .collect()
    }
}

/// Reads the materials of one file; of two with the same name the later one wins.
fn read(
    bytes: &[u8],
    path: &Path,
    known: &mut HashMap<String, Surface>,
    warnings: &mut Warnings,
) -> Result<(), ModelFileError> {
    let mut lines = Lines::new(bytes);
    let mut current: Option<Surface> = None;
    let (mut has_d, mut left_out) = (false, LeftOut::default());
    while let Some((line, text)) =
        lines.next().map_err(|error| ModelFileError::of_file(path, ModelFileErrorKind::Read(error)))?
    {
        let (word, rest) = keyword(text);
        if word == b"newmtl" {
            let new = Surface { name: name(rest), ..Surface::default() };
            has_d = false;
            known.extend(current.replace(new).map(|done| (done.name.clone(), done)));
            continue;
        }
        let Some(surface) = &mut current else { continue };
        let result = match word {
            b"Kd" => color(rest).map(|color| set(&mut surface.diffuse, color, path, line, warnings)),
            b"Ks" => color(rest).map(|color| set(&mut surface.specular, color, path, line, warnings)),
            b"Ns" => numbers(&mut words(rest), f32::is_finite, "an exponent (1)")
                .map(|[exponent]| surface.shininess = exponent.max(0.0)),
            b"map_Kd" => {
                surface.texture = texture(rest).map(|file| sibling_path(path, &file));
                if places_otherwise(rest) {
                    left_out.add("options of map_Kd (-s, -o, -clamp)", line);
                }
                Ok(())
            }
            // If both are given, `d` wins: some programs mean the opposite by `Tr`, and write both.
            b"Tr" if has_d => Ok(()),
            b"d" | b"Tr" => opacity(rest).map(|share| {
                has_d |= word == b"d";
                surface.opacity = if word == b"d" { share } else { 1.0 - share };
                if surface.opacity == 0.0 {
                    left_out.add("a fully transparent material is drawn opaque; its d or Tr is", line);
                    surface.opacity = 1.0;
                }
            }),
            b"map_d" => {
                left_out.add("map_d", line);
                Ok(())
            }
            _ => Ok(()),
        };
        result.map_err(|kind| ModelFileError::of_line(path, line, kind))?;
    }
    known.extend(current.map(|done| (done.name.clone(), done)));
    left_out.warn(path, warnings);
    Ok(())
}

/// Parses the value of `d` or `Tr`, which may follow `-halo`.
fn opacity(rest: &[u8]) -> Result<f32, ModelFileErrorKind> {
    let mut words = words(rest).filter(|word| *word != b"-halo");
    numbers(&mut words, f32::is_finite, "an opacity (1)").map(|[share]| share.clamp(0.0, 1.0))
}

/// Red, green and blue, or one number for all three. `None` for a spectral file or CIE XYZ, which no program writes.
fn color(rest: &[u8]) -> Result<Option<[f32; 3]>, ModelFileErrorKind> {
    const WHAT: &str = "a colour (1 or 3)";
    let mut words = words(rest).peekable();
    if words.next_if(|word| matches!(*word, b"spectral" | b"xyz")).is_some() {
        return Ok(None);
    }
    let red = number(&mut words)?.ok_or(ModelFileErrorKind::Missing(WHAT))?;
    let Some(green) = number(&mut words)? else { return Ok(Some([red; 3])) };
    let blue = number(&mut words)?.ok_or(ModelFileErrorKind::Missing(WHAT))?;
    Ok(Some([red, green, blue]))
}

fn set(component: &mut [f32; 3], color: Option<[f32; 3]>, path: &Path, line: u64, warnings: &mut Warnings) {
    match color {
        Some(color) => *component = color,
        None => {
            warnings
                .push(|| format!("{}:{line}: only red, green and blue are supported; this is ignored", path.display()));
        }
    }
}

/// The file name after the options of a texture statement; `None` if there is none.
fn texture(rest: &[u8]) -> Option<String> {
    let mut rest = rest.trim_ascii();
    while rest.starts_with(b"-") {
        let (option, mut after) = keyword(rest);
        // -o, -s and -t have one to three numbers, -mm two, all others one word.
        let most = match option {
            b"-o" | b"-s" | b"-t" => 3,
            b"-mm" => 2,
            _ => 1,
        };
        for i in 0..most {
            let (value, next) = keyword(after);
            let is_number = str::from_utf8(value).is_ok_and(|value| value.parse::<f32>().is_ok());
            if i > 0 && !is_number {
                break;
            }
            after = next;
        }
        rest = after.trim_ascii();
    }
    (!rest.is_empty()).then(|| name(rest))
}

/// Returns whether the options of a texture statement move, stretch or clamp the texture.
fn places_otherwise(rest: &[u8]) -> bool {
    let mut neutral = 0.0;
    let mut option: &[u8] = b"";
    words(rest).any(|word| {
        if word.starts_with(b"-") && number(&mut [word].into_iter()).is_err() {
            (option, neutral) = (word, if word == b"-s" { 1.0 } else { 0.0 });
            return false;
        }
        let value = number(&mut [word].into_iter());
        match option {
            b"-s" | b"-o" => match value {
                Ok(value) => value != Some(neutral),
                // The name of the file.
                Err(_) => {
                    option = b"";
                    false
                }
            },
            b"-clamp" => word == b"on",
            _ => false,
        }
    })
}
