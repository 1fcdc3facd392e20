//! What reads a file, as methods of a scene.

use std::io::{self, BufRead};
use std::path::Path;

use mode13h::scene::Scene;

use crate::auto_palette;
use crate::model::{self, Model, ModelError, studio};
use crate::model_file::Options;
use crate::scene_file::{self, Loaded, SceneError};

/// Scenes from files: methods of [`Scene`].
pub trait SceneExt: Sized {
    /// Makes a scene that shows a model file with its materials and textures, in the middle of the picture, turning
    /// once in a [round](Scene::duration) as [`showing`](Scene::showing) says. A model with colours gets a palette made
    /// for them; a grey one is drawn in greys.
    ///
    /// The model brings no light and no background. It is lit by a key light, a weaker fill from the other side and
    /// ambient light, which are full light together: a face towards the eye shows 93 % of its Kd, or of its image,
    /// beside which a grey Kd does not count. The background is the darkest grey, or else a blue, that stands out from
    /// all that is seen over a turn. y points up, but z does in an STL file and for a sheet that looks along z. A low model is tilted until
    /// it fills the picture's height as well as its width.
    ///
    /// The second value are the warnings, one line each: parts of the model that were left out or mended, and textures that
    /// could not be read.
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

    /// Makes a scene of the text of a file. Errors call it `path`; `open` is given the path of each file that the scene
    /// names, joined to the folder of `path`.
    ///
    /// # Errors
    /// A `SceneError` with line, column and key: see [`SceneErrorKind`](scene_file::SceneErrorKind).
    fn from_toml(
        text: &str,
        path: impl AsRef<Path>,
        open: impl FnMut(&Path) -> io::Result<Box<dyn BufRead>>,
    ) -> Result<Loaded, SceneError>;

    /// Makes a scene of the bytes of a file. Otherwise like [`from_toml`](Self::from_toml).
    ///
    /// # Errors
    /// Those of [`from_toml`](Self::from_toml), and bytes that are no text.
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
