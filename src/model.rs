//! A model file as a scene: mesh, textures, palette and framing by one call.

mod studio;

use core::error::Error;
use core::fmt;
use std::collections::HashMap;
use std::path::Path;
use std::string::{String, ToString};
use std::vec::Vec;

use crate::auto_palette;
use crate::mesh::Mesh;
use crate::mesh::obj::{self, ObjError};
use crate::render::RenderError;
use crate::scene::{Object, Scene, Shared};
use crate::texture::{self, Texture};

pub use studio::studio;

/// An error of a model file that gave no scene.
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be read, or holds no model.
    Obj(ObjError),
    /// The model cannot be drawn.
    Scene(RenderError),
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obj(error) => error.fmt(f),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

crate::errors::debug_as_display!(ModelError);

impl Error for ModelError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Obj(error) => Some(error),
            Self::Scene(error) => Some(error),
        }
    }
}

/// A model as it was read.
#[derive(Debug)]
#[non_exhaustive]
#[doc(hidden)]
pub struct Model {
    /// The mesh with its materials and textures, under the file's name.
    pub object: Object,
    /// The parts that were left out or mended, one line each; a texture that cannot be read is left out.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file, its MTL files and its textures.
///
/// # Errors
///
/// [`ObjError`] with the file and the line.
#[doc(hidden)]
pub fn load(path: impl AsRef<Path>, options: &obj::Options) -> Result<Model, ObjError> {
    let path = path.as_ref();
    let loaded = obj::load_with(path, options, |_, _| {})?;
    let (textures, of_textures) = textures(&loaded.mesh);
    let mut warnings = loaded.warnings;
    warnings.extend(of_textures);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let object = with_textures(Object::new(loaded.mesh).named(name.to_string()), &textures);
    Ok(Model { object, warnings })
}

/// Reads the texture of each surface of a mesh, if the surface names one that can be read and the mesh has texture
/// coordinates. Returns warnings, one line each: of files that cannot be read, and of what is left out of others. A file
/// that several surfaces name is read once.
#[must_use]
#[doc(hidden)]
pub fn textures(mesh: &Mesh) -> (Vec<Option<Shared<Texture>>>, Vec<String>) {
    let mut read: HashMap<&str, Option<Shared<Texture>>> = HashMap::new();
    let mut warnings = Vec::new();
    let textures = mesh.surfaces().iter().map(|surface| {
        let path = surface.texture.as_deref().filter(|_| mesh.texcoords().is_some())?;
        let texture = read.entry(path).or_insert_with(|| match texture::load_decoded(path.as_ref()) {
            Ok(decoded) => {
                warnings.extend(decoded.warning(path.as_ref()));
                Some(Shared::new(decoded.texture))
            }
            Err(error) => {
                warnings.push(std::format!("{error}; drawn without it"));
                None
            }
        });
        texture.clone()
    });
    (textures.collect(), warnings)
}

/// Gives an object's surfaces these textures, one for each surface.
#[must_use]
#[doc(hidden)]
pub fn with_textures(mut object: Object, textures: &[Option<Shared<Texture>>]) -> Object {
    for (i, texture) in textures.iter().enumerate() {
        if let (Some(texture), Some(surface)) = (texture, object.mesh().surfaces().get(i)) {
            object.materials[i] = object.materials[i].clone().with_map(surface, texture);
        }
    }
    object
}

impl Object {
    /// Returns whether any of its surfaces has a colour of its own: a texture, or a diffuse colour that is not grey.
    #[must_use]
    #[doc(hidden)]
    pub fn has_colors(&self) -> bool {
        let is_colored = |[red, green, blue]: [f32; 3]| red != green || green != blue;
        self.mesh().surfaces().iter().any(|surface| is_colored(surface.diffuse))
            || self.materials.iter().any(|material| material.texture.is_some())
    }
}

impl Scene {
    /// Makes a scene that shows a model file with its materials and textures, in the middle of the picture, turning
    /// once in a [round](Self::duration) as [`showing`](Self::showing) says. A model with colours gets a palette made
    /// for them; a grey one is drawn in greys.
    ///
    /// The model brings no light and no background. It is lit by a key light, a weaker fill from the other side and
    /// ambient light, which are full light together: a face towards the eye shows 93 % of its Kd, or of its image,
    /// beside which a grey Kd does not count. The background is the darkest grey, or else a blue, that stands out from
    /// all that is seen over a turn. y points up, but z does for a sheet that looks along z. A low model is tilted until
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
    pub fn from_model(path: impl AsRef<Path>) -> Result<(Self, Vec<String>), ModelError> {
        let Model { object, warnings } = load(path, &obj::Options::default()).map_err(ModelError::Obj)?;
        let has_colors = object.has_colors();
        let mut scene = studio(object, None).map_err(ModelError::Scene)?;
        if has_colors {
            auto_palette::of_scene(&scene).map_err(ModelError::Scene)?.apply(&mut scene);
        }
        Ok((scene, warnings))
    }
}
