//! Scenes as TOML files. `assets/scenes/README.md` lists their tables and keys.
//!
//! ```
//! use mode13h::scene::Scene;
//! use mode13h_assets::SceneExt;
//!
//! let text = "
//!     palette = 'copper'
//!     objects = [{ shape = 'torus', spin = 1 }]
//!     lights = [{ sun = [0.4, 0.6, 1] }]
//! ";
//! let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
//! let mut scene = Scene::from_toml(text, "torus.toml", no_files)?.scene;
//! scene.set_time(scene.duration / 4.0);
//! assert_eq!(scene.objects()[0].angles[1].to_degrees(), 90.0);
//!
//! let error = Scene::from_toml("objects = [{ shap = 'torus' }]", "torus.toml", no_files).unwrap_err();
//! assert!(error.to_string().starts_with("torus.toml:1:14: key `objects[0].shap`: unknown key; known are name, shape"));
//! # Ok::<(), mode13h_assets::scene_file::SceneError>(())
//! ```
//!
//! Reading is bounded: a file of at most [`LONGEST`] bytes, shapes of at most [`MAX_TRIANGLES`] together. A scene
//! names models, textures and palettes; never another scene.

// | file | what |
// |---|---|
// | `layout` | the tables and keys |
// | `value` | numbers, vectors, colours and names with their ranges |
// | `shape` | the shapes with their subdivisions |
// | `build` | from the layout to a `Scene` |
// | `object`, `material`, `motion`, `camera` | the parts of it |
// | `named` | the files that a scene names |
// | `names` | the short name of the default shading |
// | `error`, `place` | what is wrong, in which line and column, of which key |

mod build;
mod camera;
mod error;
mod layout;
mod limits;
mod material;
mod motion;
mod named;
mod names;
mod object;
mod place;
mod shape;
mod value;

use std::fs::File;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::de::Deserializer;

use crate::look::Look;
use crate::model::Playback;
use crate::model_file::open_named;
use build::Builder;
use error::{Fault, not_a_scene, not_toml};
pub use error::{SceneError, SceneErrorKind};
use layout::SceneLayout;
pub use limits::{LONGEST, MAX_TRIANGLES};
use mode13h::scene::Scene;
pub use names::{GOURAUD, in_full};
pub use place::Place;

/// A scene and the warnings from reading it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Loaded {
    /// The scene, at time 0.
    pub scene: Scene,
    /// The look that the scene asks for, already applied. If that makes the scene prefer an automatic palette, its colours
    /// are still to be [rounded](Look::rounded).
    pub look: Option<Look>,
    /// The scene before the look was applied, if it has one.
    pub without_look: Option<Scene>,
    /// The warnings, one line each, with a file and the position in it.
    pub warnings: Vec<String>,
    /// The files that were read or looked for: the scene file itself if it was loaded from one, and the models, MTL
    /// files, textures and palettes that it names. Some may not exist.
    pub files: Vec<PathBuf>,
    /// The models in it that move by themselves. The scene has them at rest; [`Playback::show`] moves them.
    pub playbacks: Vec<Playback>,
}

/// Reads a scene file. The files that it names are resolved relative to its folder.
///
/// # Errors
/// A file that cannot be read, or that is broken: see [`SceneErrorKind`].
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    let path = path.as_ref();
    let failed = |kind| SceneError { path: path.to_owned(), place: None, key: None, kind: Box::new(kind) };
    let mut file = File::open(path).map_err(|error| failed(SceneErrorKind::Read(error)))?;
    let mut bytes = Vec::new();
    // One byte more than allowed, to detect a longer file.
    file.by_ref().take(LONGEST as u64 + 1).read_to_end(&mut bytes).map_err(|error| {
        failed(if error.kind() == io::ErrorKind::IsADirectory {
            SceneErrorKind::Directory
        } else {
            SceneErrorKind::Read(error)
        })
    })?;
    let mut loaded = parse_bytes(&bytes, path, open_named)?;
    loaded.files.push(path.to_owned());
    Ok(loaded)
}

/// Makes a scene from the text of a file.
pub(crate) fn parse(
    text: &str,
    path: &Path,
    open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
) -> Result<Loaded, SceneError> {
    read(text, path, open).map_err(|fault| fault.locate(path, text))
}

/// Makes a scene from the bytes of a file.
pub(crate) fn parse_bytes(
    bytes: &[u8],
    path: &Path,
    open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
) -> Result<Loaded, SceneError> {
    if bytes.len() > LONGEST {
        // Its last character may be cut.
        return Err(Fault { span: None, kind: SceneErrorKind::TooLong }.locate(path, ""));
    }
    match str::from_utf8(bytes) {
        Ok(text) => parse(text, path, open),
        Err(error) => {
            // The text is valid up to there.
            let text = str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            let place = Some(Place::of(text, text.len()));
            Err(SceneError { path: path.to_owned(), place, key: None, kind: Box::new(SceneErrorKind::NotText) })
        }
    }
}

fn read(text: &str, path: &Path, mut open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>) -> Result<Loaded, Fault> {
    if text.len() > LONGEST {
        return Err(Fault { span: None, kind: SceneErrorKind::TooLong });
    }
    let document = Deserializer::parse(text).map_err(|error| not_toml(&error))?;
    let layout = SceneLayout::deserialize(document).map_err(|error| not_a_scene(&error))?;
    let mut files = Vec::new();
    let mut open = |path: &Path| {
        files.push(path.to_owned());
        open(path)
    };
    let mut loaded = Builder::new(path, &mut open).scene(&layout)?;
    // Includes those that are not looked for because no face has texture coordinates.
    let surfaces = loaded.scene.objects().iter().flat_map(|object| object.mesh().surfaces());
    files.extend(surfaces.filter_map(|surface| surface.texture.as_ref().map(PathBuf::from)));
    loaded.files = files;
    Ok(loaded)
}
