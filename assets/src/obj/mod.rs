//! Models from Wavefront OBJ files, with their MTL files.
//!
//! | statement | read as |
//! |---|---|
//! | `v x y z` | a position; a weight behind it is left alone, a colour left out with a warning |
//! | `vt u v`, `vn x y z` | texture coordinates (`v` is 0 if left out), a normal |
//! | `f`, with `v`, `v/vt`, `v//vn`, `v/vt/vn` | a face of three corners or more, fewer are left out with a warning; negative indices count back from the last; an index may name what comes later in the file |
//! | `s` | a smoothing group, for faces without normals; `off` and 0: each face is flat |
//! | `mtllib`, `usemtl` | surfaces: `Kd`, `Ks`, `Ns`, `d` or `Tr`, `map_Kd` of the MTL file; `map_d` and the options of `map_Kd` are left out with a warning |
//! | all others, `l` and `p` among them | left alone |
//!
//! A backslash at the end of a line joins it to the next. LF, CR LF and CR end a line, which need not be UTF-8 and may
//! be of any length. Each different triple of position, texture coordinates and normal that a face uses becomes a
//! vertex. A face of n corners becomes n − 2 triangles, those without area among them.
//!
//! A corner without a normal, or with one of length 0, gets the mean by angle over faces at that position: those of the
//! same smoothing group; or, if the file names no group, those that meet at no more than the crease angle
//! ([`Options::crease`]).
//!
//! Positions are read in f64. If their middle is more than 16 half extents from 0, as on maps, it is moved to 0 before they
//! are rounded to f32, and a warning says by how much ([`Loaded::origin`]).
//!
//! Two faults of scans are mended in a model that is closed, each with a warning. Pairs of triangles back to back, of the
//! same three points, are left out where other faces go on at their edges; sheets with a rim of their own, as leaves, stay.
//! Bodies that are inside out are turned round, unless they are cavities in others; their normals too, if these look
//! inward.
//!
//! A broken file is an [`ObjError`] that names file and line. A missing MTL file or texture is a
//! warning, and white, matt surfaces take its place.
//!
//! The `tobj` crate is not used for this (the tests read with it, and compare): it names no line,
//! turns `l` into faces, gives up at a comment in Latin-1, panics at `Kd 0.5`, does not say which
//! corners had no normal nor which material was not found, and keeps 104 bytes for each face.

mod error;
mod gather;
mod line;
mod material;
mod polygon;
mod progress;
mod statement;
mod warnings;

use mode13h::Angle;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use mode13h::mesh::Mesh;

pub use error::{ObjError, ObjErrorKind};
use progress::Counted;
use warnings::Warnings;

/// A model and the warnings of its reading.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Loaded {
    /// The model.
    pub mesh: Mesh,
    /// The warnings, one line each, with the file and the line in it: the first hundred, and the number of further
    /// ones.
    pub warnings: Vec<String>,
    /// The files that were read or looked for: the model's own if it was loaded from one, MTL files, and textures that
    /// the materials name. Some may not exist.
    pub files: Vec<PathBuf>,
    /// The point of the file that is 0 in the mesh: the middle of a model far from 0, 0 of all others.
    pub origin: [f64; 3],
}

/// The options for reading a model.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Options {
    /// The crease angle for corners without a normal: faces whose normals differ by more have an edge between them.
    /// 180° is smooth everywhere, 0 flat; values beyond count as these. With `None` the smoothing groups of the file
    /// hold, and without groups 40°; but a scan, whose sharp edges end anywhere, is smooth everywhere.
    pub crease: Option<Angle>,
}

/// Reads an OBJ file and the MTL files that it names. Textures are only tested for existence.
///
/// # Errors
/// A file that cannot be read, or that is broken: see [`ObjErrorKind`].
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, ObjError> {
    load_with(path, &Options::default(), |_, _| {})
}

/// Reads a file with `options`, as [`load`] does. It tells `progress` how many bytes of the OBJ file have been read,
/// and how long the file is: after every 64 KiB or so, and at the end. Making a mesh of it then takes about as long
/// again. A pipe or a device has the length 0; a file that grows meanwhile may be read beyond the length that it had.
///
/// # Errors
/// Those of [`load`].
pub fn load_with(
    path: impl AsRef<Path>,
    options: &Options,
    progress: impl FnMut(u64, u64),
) -> Result<Loaded, ObjError> {
    let path = path.as_ref();
    let failed = |error: io::Error| ObjError::of_file(path, ObjErrorKind::Read(error));
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if metadata.is_dir() {
        return Err(ObjError::of_file(path, ObjErrorKind::Directory));
    }
    let file = Counted::new(file, metadata.len(), progress);
    let Parsed { mut mesh, mut warnings, libraries, origin } =
        read(BufReader::with_capacity(1 << 16, file), path, library_file, options)?;
    let files = [path.to_owned()].into_iter().chain(libraries).chain(textures(&mesh)).collect();
    for surface in mesh.surfaces_mut() {
        if let Some(texture) = surface.texture.take_if(|texture| !Path::new(texture).is_file()) {
            let name = &surface.name;
            warnings.push(|| format!("{texture}: no such texture; material {name} is drawn without it"));
        }
    }
    Ok(Loaded { mesh, warnings: warnings.into_lines(), files, origin })
}

/// The textures that a model's materials name.
fn textures(mesh: &Mesh) -> impl Iterator<Item = PathBuf> {
    mesh.surfaces().iter().filter_map(|surface| surface.texture.as_ref().map(PathBuf::from))
}

/// Reads the bytes of an MTL file. Only ordinary files are accepted: a model may name a device that never ends.
fn library_file(path: &Path) -> io::Result<Vec<u8>> {
    match fs::metadata(path)?.is_file() {
        true => fs::read(path),
        false => Err(io::Error::new(io::ErrorKind::InvalidInput, "not a file")),
    }
}

/// Reads a model from `reader`. Errors call it `path`, and MTL files are looked for beside that: `library` is given
/// their paths and returns their bytes. Textures are not looked for.
///
/// ```
/// use mode13h_assets::obj;
/// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
/// let model = obj::parse(text.as_bytes(), "square.obj", none)?;
/// assert_eq!(model.mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = obj::parse("v 0 0 0\nf 1 2 3\n".as_bytes(), "broken.obj", none).unwrap_err();
/// assert_eq!(error.to_string(), "broken.obj:2: there is no vertex 2, only 1");
/// # Ok::<(), obj::ObjError>(())
/// ```
///
/// # Errors
/// Those of [`load`].
pub fn parse(
    reader: impl BufRead,
    path: impl AsRef<Path>,
    library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
) -> Result<Loaded, ObjError> {
    parse_with(reader, path, library, &Options::default())
}

/// Reads a model with `options`, as [`parse`] does.
///
/// # Errors
/// Those of [`load`].
pub fn parse_with(
    reader: impl BufRead,
    path: impl AsRef<Path>,
    library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    options: &Options,
) -> Result<Loaded, ObjError> {
    let Parsed { mesh, warnings, libraries, origin } = read(reader, path.as_ref(), library, options)?;
    let files = libraries.into_iter().chain(textures(&mesh)).collect();
    Ok(Loaded { mesh, warnings: warnings.into_lines(), files, origin })
}

/// A model of which no texture was looked for.
struct Parsed {
    mesh: Mesh,
    warnings: Warnings,
    /// The paths that the caller was asked for.
    libraries: Vec<PathBuf>,
    origin: [f64; 3],
}

fn read(
    reader: impl BufRead,
    path: &Path,
    mut library: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    options: &Options,
) -> Result<Parsed, ObjError> {
    let mut warnings = Warnings::default();
    let mut libraries = Vec::new();
    let library = |path: &Path| {
        libraries.push(path.to_owned());
        library(path)
    };
    let model = statement::read(reader, path)?;
    let surfaces = material::surfaces(&model, path, library, &mut warnings)?;
    let shown = path.display();
    match model.short {
        None => {}
        Some((line, 1)) => warnings.push(|| format!("{shown}:{line}: left out a face of fewer than 3 corners")),
        Some((line, count)) => {
            warnings.push(|| format!("{shown}:{line}: left out {count} faces of fewer than 3 corners, the first here"));
        }
    }
    if model.colored > 0 {
        warnings.push(|| format!("{shown}:{}: colours of vertices left out", model.colored));
    }
    let origin = model.middle.unwrap_or_default();
    if let Some([x, y, z]) = model.middle {
        warnings.push(|| format!("{shown}: lies far from 0; its middle, {x} {y} {z}, is now at 0"));
    }
    let (mesh, mended) = gather::mesh(model, surfaces, options.crease).map_err(|(line, kind)| ObjError {
        path: path.to_owned(),
        line,
        kind,
    })?;
    let path = path.display();
    match mended.pairs {
        0 => {}
        1 => warnings.push(|| format!("{path}: left out two faces back to back")),
        pairs => warnings.push(|| format!("{path}: left out {pairs} pairs of faces back to back")),
    }
    match mended.turned {
        0 => {}
        1 => warnings.push(|| format!("{path}: turned round a body that was inside out")),
        turned => warnings.push(|| format!("{path}: turned round {turned} bodies that were inside out")),
    }
    Ok(Parsed { mesh, warnings, libraries, origin })
}
