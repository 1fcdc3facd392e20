//! Models from Wavefront OBJ files, with their MTL files.
//!
//! | statement | read as |
//! |---|---|
//! | `v x y z` | a position; a weight after it is ignored |
//! | `v x y z r g b` | a position and a colour, used if each vertex has one and all faces share a grey material without a texture, otherwise ignored with a warning; a face has the mean of its corners |
//! | `vt u v`, `vn x y z` | texture coordinates (`v` defaults to 0), a normal |
//! | `f`, with `v`, `v/vt`, `v//vn`, `v/vt/vn` | a face of three corners or more, fewer are dropped with a warning; negative indices count back from the last; an index may refer to a later entry of the file |
//! | `s` | a smoothing group, for faces without normals; `off` and 0: each face is flat |
//! | `mtllib`, `usemtl` | surfaces: `Kd`, `Ks`, `Ns`, `d` or `Tr`, `map_Kd` of the MTL file; `map_d` and the options of `map_Kd` are ignored with a warning |
//! | all others, including `l` and `p` | ignored |
//!
//! A backslash at the end of a line joins it to the next. LF, CR LF and CR end a line, which need not be UTF-8 and may
//! have up to 64 MiB. Each distinct triple of position, texture coordinates and normal used by a face becomes a vertex.
//! A face of n corners becomes n − 2 triangles, including those without area.
//!
//! A corner without a normal, or with one of length 0, gets the mean, weighted by angle, over faces at that position:
//! those of the same smoothing group; or, if the file has no groups, those that meet at no more than the crease angle
//! ([`Options::crease`]).
//!
//! Positions are read in f64. If their centre is more than 16 half extents from 0, as on maps, it is moved to 0 before
//! they are rounded to f32, and a warning says by how much ([`Loaded::origin`]).
//!
//! Two defects of scans are repaired in a closed model, each with a warning. Pairs of back-to-back triangles, with the
//! same three points, are removed where other faces continue at their edges; sheets with a rim of their own, such as
//! leaves, stay. Solids that are inside out are flipped, unless they are cavities in others, and so are their normals
//! if these point inward.
//!
//! A broken file is a [`ModelFileError`] that names file and line. A missing MTL file or texture is a warning, and
//! white, matt surfaces replace it.
//!
//! The `tobj` crate is not used for this (the tests compare with it): it reports no line, turns `l` into faces, gives
//! up at a comment in Latin-1, panics at `Kd 0.5`, does not say which corners had no normal nor which material was not
//! found, and takes 104 bytes per face.

pub(crate) mod line;
mod material;
mod statement;

use std::io::{self, BufRead};
use std::iter;
use std::path::Path;

use mode13h::mesh::Surface;
use mode13h::palette::Rgb;

use crate::model_file::colors::{of_faces, paint};
use crate::model_file::lists::Lists;
use crate::model_file::warnings::Warnings;
use crate::model_file::word::without_mark;
use crate::model_file::{Draft, Loaded, ModelFileError, Options, finish, warned};
use statement::Statements;

/// Reads a model from `reader`, like [`model_file::parse`](crate::model_file::parse), but with any extension. `path` is
/// used in errors, and MTL files are resolved relative to it: `library` is given their paths and returns their bytes.
/// Textures are not looked for.
///
/// ```
/// use mode13h_assets::model_file::obj;
/// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
/// let model = obj::parse(text.as_bytes(), "square.obj", none)?;
/// assert_eq!(model.mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = obj::parse("v 0 0 0\nf 1 2 3\n".as_bytes(), "broken.obj", none).unwrap_err();
/// assert_eq!(error.to_string(), "broken.obj:2: there is no vertex 2, only 1");
/// # Ok::<(), mode13h_assets::model_file::ModelFileError>(())
/// ```
///
/// # Errors
/// A broken file: see [`ModelFileErrorKind`](crate::model_file::ModelFileErrorKind).
pub fn parse(
    reader: impl BufRead,
    path: impl AsRef<Path>,
    library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
) -> Result<Loaded, ModelFileError> {
    parse_with(reader, path, library, &Options::default())
}

/// Reads a model with `options`, like [`parse`].
///
/// # Errors
/// Returns the errors of [`parse`].
pub fn parse_with(
    reader: impl BufRead,
    path: impl AsRef<Path>,
    mut library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    options: &Options,
) -> Result<Loaded, ModelFileError> {
    let path = path.as_ref();
    let mut libraries = Vec::new();
    let library = |path: &Path| {
        libraries.push(path.to_owned());
        library(path)
    };
    let draft = draft(reader, path, library)?;
    finish(draft, path, libraries, options).map(warned)
}

/// Reads a file and its MTL files.
pub(crate) fn draft(
    reader: impl BufRead,
    path: &Path,
    library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
) -> Result<Draft, ModelFileError> {
    let model = statement::read(reader, path)?;
    let mut warnings = Warnings::default();
    let surfaces: Vec<Surface> = material::surfaces(&model, path, library, &mut warnings)?;
    let Statements { lists, colored, colors, .. } = model;
    let mut draft = Draft { lists, surfaces, warnings, ..Draft::default() };
    let is_plain = |surface: &Surface| {
        let [red, green, blue] = surface.diffuse;
        surface.texture.is_none() && red == green && green == blue
    };
    let surface = only_surface(&draft.lists).filter(|surface| is_plain(&draft.surfaces[*surface]));
    match surface {
        _ if colored == 0 => {}
        Some(surface) if colors.len() == draft.lists.positions.len() => {
            let colors = of_faces(&draft.lists, &rgb(&colors)).into_iter().enumerate().collect::<Vec<_>>();
            let painted = paint(&mut draft, &colors, format!("{}#colours", path.display()));
            let own = &mut draft.surfaces[surface];
            own.texture = painted.texture;
            if own.name.is_empty() {
                own.name = painted.name;
            }
        }
        _ => draft.warnings.push(|| format!("{}:{colored}: vertex colours left out", path.display())),
    }
    Ok(draft)
}

/// The surface of all faces, if they share one.
fn only_surface(lists: &Lists) -> Option<usize> {
    let starts = iter::once((0, 0)).chain(lists.runs.iter().copied());
    let ends = lists.runs.iter().map(|(end, _)| *end).chain([lists.sizes.len()]);
    let mut used = starts.zip(ends).filter(|((start, _), end)| start < end).map(|((_, surface), _)| surface);
    let first = used.next()?;
    used.all(|surface| surface == first).then_some(first)
}

/// The colours of vertices, which are in 0 to 1, or in 0 to 255 if one of them is above 1 and all are whole numbers, or
/// one is above 16. Others above 1 are brighter than white.
fn rgb(colors: &[[f32; 3]]) -> Vec<Rgb> {
    let most = colors.as_flattened().iter().copied().fold(0.0, f32::max);
    let are_whole = || colors.as_flattened().iter().all(|channel| channel.fract() == 0.0);
    let full = if most > 16.0 || (most > 1.0 && are_whole()) { 255.0 } else { 1.0 };
    colors.iter().map(|color| Rgb::from_intensities(color.map(|channel| channel / full))).collect()
}

/// Returns whether the first line that is not a comment is an OBJ statement.
pub(crate) fn recognizes(bytes: &[u8]) -> bool {
    const STATEMENTS: [&[u8]; 9] = [b"v", b"vt", b"vn", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"];
    let bytes = without_mark(bytes);
    let words = bytes.split(|byte| matches!(byte, b'\n' | b'\r')).map(|line| line::keyword(line).0);
    words.filter(|word| !word.is_empty() && word[0] != b'#').take(1).any(|word| STATEMENTS.contains(&word))
}
