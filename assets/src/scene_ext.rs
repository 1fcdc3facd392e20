//! File-reading methods for scenes.

use std::io::{self, BufRead};
use std::path::Path;

use mode13h::scene::Scene;

use crate::auto_palette;
use crate::model::{self, Model, ModelError, studio};
use crate::model_file::Options;
use crate::scene_file::{self, Loaded, SceneError};

/// Methods of [`Scene`] that read files.
///
/// To read a scene file from a path, call [`scene_file::load`].
pub trait SceneExt: Sized {
    /// Makes a scene that shows a model file with its materials and textures, centred, turning once per
    /// [loop](Scene::duration) as described at [`showing`](Scene::showing). A coloured model gets a palette made for
    /// it; a grey one is drawn in greys.
    ///
    /// The model has no light and no background. It is lit by a key light, a weaker fill from the other side and
    /// ambient light, which add up to full light: a face towards the eye shows 93 % of its Kd, or of its image, in
    /// which case a grey Kd is ignored. The background is the darkest grey, or otherwise a blue, that stands out from
    /// everything visible over a turn. y points up, except in an STL file and for a sheet that faces along z, where z
    /// does. A low model is tilted until it fills the picture's height as well as its width.
    ///
    /// The second value contains the warnings, one line each: parts of the model that were ignored or repaired, and
    /// textures that could not be read.
    ///
    /// ```no_run
    /// use mode13h::export;
    /// use mode13h::render::Renderer;
    /// use mode13h::scene::Scene;
    /// use mode13h::vga::Vga;
    /// use mode13h_assets::SceneExt;
    ///
    /// let (scene, warnings) = Scene::from_model("crate.obj")?;
    /// warnings.iter().for_each(|warning| eprintln!("{warning}"));
    /// let mut vga = Vga::new();
    /// Renderer::new().draw(&scene, &mut vga)?;
    /// export::png(&vga, "crate.png")?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ModelError`] with the file and the line, or with the part that cannot be drawn.
    fn from_model(path: impl AsRef<Path>) -> Result<(Self, Vec<String>), ModelError>;

    /// Makes a scene from the text of a file. `path` is used in errors; `open` is given the path of each file that the
    /// scene names, joined to the folder of `path`.
    ///
    /// # Errors
    /// A `SceneError` with line, column and key: see [`SceneErrorKind`](scene_file::SceneErrorKind).
    fn from_toml(
        text: &str,
        path: impl AsRef<Path>,
        open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
    ) -> Result<Loaded, SceneError>;

    /// Makes a scene from the bytes of a file. Otherwise like [`from_toml`](Self::from_toml).
    ///
    /// # Errors
    /// Those of [`from_toml`](Self::from_toml), and bytes that are not text.
    fn from_toml_bytes(
        bytes: &[u8],
        path: impl AsRef<Path>,
        open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
    ) -> Result<Loaded, SceneError>;
}

impl SceneExt for Scene {
    fn from_model(path: impl AsRef<Path>) -> Result<(Self, Vec<String>), ModelError> {
        let Model { object, warnings, up, .. } = model::load(path, &Options::default()).map_err(ModelError::File)?;
        let has_colors = object.has_colors();
        let mut scene = studio(object, up).map_err(ModelError::Scene)?;
        if has_colors {
            auto_palette::of_scene(&scene).map_err(ModelError::Scene)?.apply(&mut scene);
        }
        Ok((scene, warnings))
    }

    fn from_toml(
        text: &str,
        path: impl AsRef<Path>,
        open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
    ) -> Result<Loaded, SceneError> {
        scene_file::parse(text, path.as_ref(), open)
    }

    fn from_toml_bytes(
        bytes: &[u8],
        path: impl AsRef<Path>,
        open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
    ) -> Result<Loaded, SceneError> {
        scene_file::parse_bytes(bytes, path.as_ref(), open)
    }
}
