//! Model files as scenes: mesh, textures, palette and framing in one call.

mod playback;
mod studio;

use core::error::Error;
use core::fmt;
use std::collections::HashMap;
use std::path::Path;

use crate::model_file::{self, Embedded, ModelFileError, Options, Rig};
use crate::texture;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::render::RenderError;
use mode13h::scene::{Camera, Object, Shared, UpAxis};
use mode13h::texture::Texture;

pub use playback::Playback;
pub use studio::{composed, studio};

/// The reason why a model file gives no scene.
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be read, or contains no model.
    File(ModelFileError),
    /// The model cannot be drawn.
    Scene(RenderError),
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

crate::errors::debug_as_display!(ModelError);

impl Error for ModelError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::File(error) => error.source(),
            Self::Scene(error) => error.source(),
        }
    }
}

/// A loaded model.
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// The mesh with its materials and textures, named after the file.
    pub object: Object,
    /// The parts that were ignored or repaired, one line each; a texture that cannot be read is ignored.
    pub warnings: Vec<String>,
    /// The axis that points up, if the format says so.
    pub up: Option<UpAxis>,
    /// The lights of the file, as in [`model_file::Loaded`].
    pub lights: Vec<Light>,
    /// The camera of the file.
    pub camera: Option<Camera>,
    /// The rig that moves them; see [`Playback`].
    pub rig: Option<Rig>,
}

/// Reads a model file, the files that it names, and its textures.
///
/// # Errors
///
/// [`ModelFileError`] with the file and the position in it.
pub fn load(path: impl AsRef<Path>, options: &Options) -> Result<Model, ModelFileError> {
    let path = path.as_ref();
    let loaded = model_file::load_with(path, options, |_, _| {})?;
    let (textures, of_textures) = textures(&loaded.mesh, &loaded.textures);
    let mut warnings = loaded.warnings;
    warnings.extend(of_textures);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let object = with_textures(Object::new(loaded.mesh.clone()).named(name.to_string()), &textures);
    let model_file::Loaded { up, lights, camera, rig, .. } = loaded;
    Ok(Model { object, warnings, up, lights, camera, rig })
}

/// The texture of each surface of a mesh: one that the model file contains, or a file, if the surface names one that
/// can be read and the mesh has texture coordinates. Returns warnings, one line each: about files that cannot be read,
/// and about parts of others that are ignored. A file named by several surfaces is read once.
#[must_use]
pub fn textures(mesh: &Mesh, embedded: &Embedded) -> (Vec<Option<Shared<Texture>>>, Vec<String>) {
    let mut read: HashMap<&str, Option<Shared<Texture>>> = HashMap::new();
    let mut warnings = Vec::new();
    let textures = mesh.surfaces().iter().map(|surface| {
        let path = surface.texture.as_deref().filter(|_| mesh.texcoords().is_some())?;
        if let Some(texture) = embedded.get(path) {
            return Some(Shared::clone(texture));
        }
        let texture = read.entry(path).or_insert_with(|| match texture::load_decoded(path.as_ref()) {
            Ok(decoded) => {
                warnings.extend(decoded.warning(path.as_ref()));
                Some(Shared::new(decoded.texture))
            }
            Err(error) => {
                warnings.push(std::format!("{error}; the material is drawn without this texture"));
                None
            }
        });
        texture.clone()
    });
    (textures.collect(), warnings)
}

/// Sets the textures of an object's surfaces, one for each surface.
#[must_use]
pub fn with_textures(mut object: Object, textures: &[Option<Shared<Texture>>]) -> Object {
    for (i, texture) in textures.iter().enumerate() {
        if let (Some(texture), Some(surface)) = (texture, object.mesh().surfaces().get(i)) {
            object.materials[i] = object.materials[i].clone().with_map(surface, texture);
        }
    }
    object
}
