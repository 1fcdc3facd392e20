//! Models from files: all formats share the code that turns a reader's lists into a mesh.
//!
//! | format | module | read |
//! |---|---|---|
//! | Wavefront OBJ with MTL | [`obj`] | positions, texture coordinates, normals, smoothing groups, materials |
//! | STL, text and binary | `stl` | triangles; corners at the same position are one vertex |
//! | PLY, text and both binaries | `ply` | faces of any size, strips, normals, texture coordinates, colours |
//! | glTF 2.0, `.gltf` and `.glb` (feature `gltf`) | `gltf` | the scene as one mesh: materials, textures inside the file or separate, colours; lights, a camera, animations |
//!
//! The file name's extension determines the format, with or without `.gz` after it. Without a known extension the
//! contents decide. Gzipped files are unpacked, whatever their name.
//!
//! Whatever the format, the same code splits faces, fills in missing normals, recentres a model far from 0, repairs
//! scans and locates errors; [`obj`] describes it. Only a model that moves is not repaired.

mod colors;
mod error;
mod gather;
#[cfg(feature = "gltf")]
mod gltf;
pub(crate) mod lists;
pub mod obj;
mod ply;
mod polygon;
mod progress;
mod rig;
mod stl;
pub(crate) mod tokens;
pub(crate) mod warnings;
mod word;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::bufread::GzDecoder;
use mode13h::Angle;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, Surface};
use mode13h::scene::{Camera, Shared, UpAxis};
use mode13h::texture::Texture;

pub(crate) use colors::paint;
pub use error::{ModelFileError, ModelFileErrorKind, Place};
use lists::Lists;
use progress::Counted;
pub use rig::{Clip, Pose, Rig, UnknownClip};
use rig::{Nodes, Staged};
use warnings::Warnings;

/// A model and the warnings from reading it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Loaded {
    /// The model.
    pub mesh: Mesh,
    /// The textures that the file itself contains, by the names that the mesh's surfaces use.
    pub textures: Embedded,
    /// The axis that points up, if the format says so: z for STL, y for glTF.
    pub up: Option<UpAxis>,
    /// The warnings, one line each, with the file and the line in it: the first hundred, and the number of further
    /// ones.
    pub warnings: Vec<String>,
    /// The files that were read or looked for: the model file itself if it was loaded from one, those that it names,
    /// and textures that the materials name. Some may not exist.
    pub files: Vec<PathBuf>,
    /// The point in the file that is 0 in the mesh: the centre of a model far from 0, otherwise 0.
    pub origin: [f64; 3],
    /// The lights of the file, in the mesh's coordinates, exposed so that together they give full light in its middle.
    pub lights: Vec<Light>,
    /// The first camera of the file, in the mesh's coordinates.
    pub camera: Option<Camera>,
    /// The rig that moves the mesh, the lights and the camera, if they move. All of these are at rest.
    pub rig: Option<Rig>,
}

/// Textures inside a model file, by the name in [`Surface::texture`].
pub type Embedded = BTreeMap<String, Shared<Texture>>;

/// Options for reading a model.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Options {
    /// The crease angle for corners without a normal: faces whose normals differ by more have a sharp edge between
    /// them. 180° is smooth everywhere, 0 flat; values beyond these are clamped. With `None` the smoothing groups of
    /// the file decide, and without groups 40°, except that a scan, whose sharp edges end anywhere, is smooth
    /// everywhere.
    pub crease: Option<Angle>,
}

/// A model file format.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// STL, text or binary.
    Stl,
    /// PLY, text or binary.
    Ply,
    /// glTF 2.0, JSON or binary.
    #[cfg(feature = "gltf")]
    Gltf,
}

impl Format {
    /// All formats, with their extensions.
    pub const ALL: &'static [(Self, &'static [&'static str])] = &[
        (Self::Obj, &["obj"]),
        (Self::Stl, &["stl"]),
        (Self::Ply, &["ply"]),
        #[cfg(feature = "gltf")]
        (Self::Gltf, &["gltf", "glb"]),
    ];

    /// The format for a file's extension, with or without `.gz` after it.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let unpacked = path.file_stem().filter(|_| has_extension(path, "gz")).map(Path::new);
        let path = unpacked.unwrap_or(path);
        let has = |extensions: &[&str]| extensions.iter().any(|extension| has_extension(path, extension));
        Self::ALL.iter().find(|(_, extensions)| has(extensions)).map(|&(format, _)| format)
    }

    /// The format of a file's contents, judging by its beginning and its length.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        #[cfg(feature = "gltf")]
        if gltf::recognizes(bytes) {
            return Some(Self::Gltf);
        }
        if ply::recognizes(bytes) {
            Some(Self::Ply)
        } else if stl::recognizes(bytes) {
            Some(Self::Stl)
        } else if obj::recognizes(bytes) {
            Some(Self::Obj)
        } else {
            None
        }
    }

    /// The extensions of all formats, listed for a sentence: `.obj, .stl, .ply, .gltf and .glb`.
    #[must_use]
    pub fn extensions() -> String {
        let all: Vec<String> =
            Self::ALL.iter().flat_map(|(_, extensions)| *extensions).map(|e| format!(".{e}")).collect();
        match all.as_slice() {
            [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
            all => all.join(", "),
        }
    }
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Reads a model and the files that it names. Textures outside it are only tested for existence, except that those of
/// metallic factor and roughness are read for their means.
///
/// # Errors
/// A file that cannot be read, or that is broken: see [`ModelFileErrorKind`].
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, ModelFileError> {
    load_with(path, &Options::default(), |_, _| {})
}

/// Reads a file with `options`, like [`load`]. Calls `progress` with the number of bytes of the model file read so far
/// and its length: about every 64 KiB, and at the end. Making a mesh from it then takes about as long again. A pipe or
/// a device has length 0; a file that grows meanwhile may be read beyond its original length.
///
/// # Errors
/// Returns the errors of [`load`].
pub fn load_with(
    path: impl AsRef<Path>,
    options: &Options,
    progress: impl FnMut(u64, u64),
) -> Result<Loaded, ModelFileError> {
    let path = path.as_ref();
    let failed = |error: io::Error| ModelFileError::of_file(path, ModelFileErrorKind::Read(error));
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if metadata.is_dir() {
        return Err(ModelFileError::of_file(path, ModelFileErrorKind::Directory));
    }
    let file = BufReader::with_capacity(1 << 16, Counted::new(file, metadata.len(), progress));
    let (mut loaded, mut warnings) = read(file, path, read_named, options)?;
    loaded.files.insert(0, path.to_owned());
    for surface in loaded.mesh.surfaces_mut() {
        let is_missing = |texture: &mut String| !loaded.textures.contains_key(texture) && !Path::new(texture).is_file();
        if let Some(texture) = surface.texture.take_if(is_missing) {
            let name =
                if surface.name.is_empty() { String::new() } else { format!(" {}", word::shown_name(&surface.name)) };
            warnings.push(|| format!("{texture}: no such texture; the material{name} is drawn without it"));
        }
    }
    Ok(warned((loaded, warnings)))
}

/// Reads a model from `reader`. `path` is used in errors, its extension determines the format, and the files that the
/// model names are resolved relative to it: `file` is given their paths and returns their bytes. Textures outside the
/// file are not looked for, except those of metallic factor and roughness. Contents in no known format are read as OBJ.
///
/// ```
/// use mode13h_assets::model_file;
/// let text = "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
/// let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
/// let model = model_file::parse(text.as_bytes(), "standard input", none, &model_file::Options::default())?;
/// assert_eq!(model.mesh.triangles(), [[0, 1, 2]]);
/// # Ok::<(), model_file::ModelFileError>(())
/// ```
///
/// # Errors
/// Returns the errors of [`load`].
pub fn parse(
    reader: impl BufRead,
    path: impl AsRef<Path>,
    file: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    options: &Options,
) -> Result<Loaded, ModelFileError> {
    read(reader, path.as_ref(), file, options).map(warned)
}

/// The model with its warnings.
pub(crate) fn warned((loaded, warnings): (Loaded, Warnings)) -> Loaded {
    Loaded { warnings: warnings.into_lines(), ..loaded }
}

/// The textures that a model's materials name and its file does not contain.
fn outside(mesh: &Mesh, textures: &Embedded) -> Vec<PathBuf> {
    let named = mesh.surfaces().iter().filter_map(|surface| surface.texture.as_ref());
    named.filter(|name| !textures.contains_key(*name)).map(PathBuf::from).collect()
}

/// Opens a file that a model or a scene names. Only regular files are accepted: it might name a device that never ends.
///
/// # Errors
/// The system's errors, and one for a path to anything but a regular file.
pub fn open_named(path: &Path) -> io::Result<Box<dyn BufRead>> {
    match fs::metadata(path)?.is_file() {
        true => Ok(Box::new(BufReader::with_capacity(1 << 16, File::open(path)?))),
        false => Err(io::Error::new(io::ErrorKind::InvalidInput, "not a file")),
    }
}

/// Reads a file like [`open_named`].
///
/// # Errors
/// The errors of [`open_named`], and of reading.
pub fn read_named(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_named(path)?.read_to_end(&mut bytes).map(|_| bytes)
}

/// Unpacks the bytes if they begin like a gzip file, otherwise passes them through.
///
/// # Errors
/// The reader's.
pub fn unpacked<'r>(mut reader: impl BufRead + 'r) -> io::Result<Box<dyn BufRead + 'r>> {
    let is_packed = reader.fill_buf()?.starts_with(&[0x1F, 0x8B]);
    Ok(if is_packed { Box::new(BufReader::new(Members(Some(GzDecoder::new(reader))))) } else { Box::new(reader) })
}

/// The contents of a gzipped file: those of its members, one after another. Zeros after the last, which pad a tape
/// block, are ignored, as in `gzip`.
struct Members<R>(Option<GzDecoder<R>>);

impl<R: BufRead> Read for Members<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while let Some(member) = &mut self.0 {
            let length = member.read(buffer)?;
            if length > 0 || buffer.is_empty() {
                return Ok(length);
            }
            let is_last = member.get_mut().fill_buf()?.first().is_none_or(|byte| *byte == 0);
            self.0 = self.0.take().filter(|_| !is_last).map(|member| GzDecoder::new(member.into_inner()));
        }
        Ok(0)
    }
}

/// A model as its format's reader produces it, before faces are split and repaired.
#[derive(Default)]
pub(crate) struct Draft {
    pub(crate) lists: Lists,
    /// The surfaces used by the lists' runs. Empty if there is only an unnamed one.
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) textures: Embedded,
    pub(crate) up: Option<UpAxis>,
    pub(crate) warnings: Warnings,
    pub(crate) nodes: Nodes,
}

fn read(
    reader: impl BufRead,
    path: &Path,
    mut file: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    options: &Options,
) -> Result<(Loaded, Warnings), ModelFileError> {
    let failed = |error: io::Error| ModelFileError::of_file(path, ModelFileErrorKind::Read(error));
    let mut named = Vec::new();
    let file = |path: &Path| {
        named.push(path.to_owned());
        file(path)
    };
    let mut reader = unpacked(reader).map_err(failed)?;
    let format = Format::of_path(path);
    let draft = if format == Some(Format::Obj) {
        obj::draft(reader, path, file)?
    } else {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).map_err(failed)?;
        match format.or_else(|| Format::of_bytes(&bytes)).unwrap_or(Format::Obj) {
            Format::Obj => obj::draft(&bytes[..], path, file)?,
            Format::Stl => stl::draft(&bytes, path)?,
            Format::Ply => ply::draft(&bytes, path)?,
            #[cfg(feature = "gltf")]
            Format::Gltf => gltf::draft(&bytes, path, file)?,
        }
    };
    finish(draft, path, named, options)
}

/// Makes the mesh from what a format's reader produced; `named` are the files that the caller was asked for. The
/// warnings are returned separately, so that the caller can add some.
pub(crate) fn finish(
    draft: Draft,
    path: &Path,
    named: Vec<PathBuf>,
    options: &Options,
) -> Result<(Loaded, Warnings), ModelFileError> {
    let Draft { mut lists, mut surfaces, textures, up, mut warnings, nodes } = draft;
    let shown = path.display();
    let place = |place: Place| match place {
        Place::Line(line) => format!("{shown}:{line}"),
        Place::Offset(offset) => format!("{shown}: byte {offset}"),
    };
    match lists.short {
        None => {}
        Some((first, 1)) => warnings.push(|| format!("{}: left out a face of fewer than 3 corners", place(first))),
        Some((first, count)) => {
            warnings
                .push(|| format!("{}: left out {count} faces of fewer than 3 corners, the first here", place(first)));
        }
    }
    if lists.sizes.is_empty() {
        return Err(ModelFileError::of_file(path, ModelFileErrorKind::NoFaces));
    }
    let middle = lists::far_middle(&lists.positions, &lists.corners);
    if let Some([x, y, z]) = middle {
        warnings.push(|| format!("{shown}: lies far from the origin; its centre, {x} {y} {z}, was moved there"));
    }
    // In place, since a file may have many.
    let positions = core::mem::take(&mut lists.positions).into_iter().map(|p| p.narrow(middle)).collect();
    if surfaces.is_empty() {
        surfaces.push(Surface::default());
    }
    let moves = !nodes.clips.is_empty();
    let corners: Vec<u32> =
        if moves { lists.corners.iter().map(|corner| corner.position).collect() } else { Vec::new() };
    let (mesh, mended) = gather::mesh(lists, positions, surfaces, options.crease, moves).map_err(|(line, kind)| {
        ModelFileError { path: path.to_owned(), place: line.map(Place::Line), kind } //
    })?;
    match mended.pairs {
        0 => {}
        1 => warnings.push(|| format!("{shown}: left out two faces back to back")),
        pairs => warnings.push(|| format!("{shown}: left out {pairs} pairs of faces back to back")),
    }
    match mended.turned {
        0 => {}
        1 => warnings.push(|| format!("{shown}: flipped a solid that was inside out")),
        turned => warnings.push(|| format!("{shown}: flipped {turned} solids that were inside out")),
    }
    let origin = middle.unwrap_or_default();
    let Staged { lights, camera, rig } = nodes.stage(&mesh, &corners, origin);
    let files = named.into_iter().chain(outside(&mesh, &textures)).collect();
    Ok((Loaded { mesh, textures, up, warnings: Vec::new(), files, origin, lights, camera, rig }, warnings))
}
