//! The files that a scene names: models, palettes, textures; each read once.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Cursor, Read};
use std::path::{Path, PathBuf};

use mode13h::Angle;
use mode13h::mesh::Mesh;
use mode13h::palette::{Palette, builtin};
use mode13h::scene::{Shared, UpAxis};
use mode13h::texture::Texture;
use toml::Spanned;

use super::SceneErrorKind;
use super::error::Fault;
use super::value::FileName;
use crate::model_file::{self, Format, Options, Rig};
use crate::palette_file::{self, LONGEST_PICTURE};
use crate::texture::{self, LoadError, LoadErrorKind};

/// The caller's function for opening files.
pub(super) type Open<'a> = dyn FnMut(&Path) -> io::Result<Box<dyn BufRead>> + 'a;

/// A model loaded for a scene.
#[derive(Clone)]
pub(super) struct NamedModel {
    pub(super) mesh: Shared<Mesh>,
    /// The point in its file that is 0 in the mesh.
    pub(super) origin: [f64; 3],
    /// The axis that points up, if its format says so.
    pub(super) up: Option<UpAxis>,
    /// The rig that moves it, if it moves.
    pub(super) rig: Option<Shared<Rig>>,
}

/// The files that a scene names, resolved relative to its folder.
pub(super) struct Named<'a> {
    folder: &'a Path,
    open: &'a mut Open<'a>,
    /// The models, by the file and the bits of the requested crease angle.
    models: BTreeMap<(PathBuf, Option<u64>), NamedModel>,
    textures: BTreeMap<PathBuf, Shared<Texture>>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Named<'a> {
    pub(super) fn new(scene: &'a Path, open: &'a mut Open<'a>) -> Self {
        let folder = scene.parent().unwrap_or(Path::new(""));
        Self { folder, open, models: BTreeMap::new(), textures: BTreeMap::new(), warnings: Vec::new() }
    }

    /// Loads a model, with a crease angle if one is requested.
    pub(super) fn model(&mut self, name: &Spanned<FileName>, crease: Option<Angle>) -> Result<NamedModel, Fault> {
        let path = self.folder.join(&name.get_ref().0);
        let key = (path.clone(), crease.map(|crease| crease.to_radians().to_bits()));
        if let Some(known) = self.models.get(&key) {
            return Ok(known.clone());
        }
        if Format::of_path(&path).is_none() {
            let known = Format::extensions();
            return Err(Fault::value(name.span(), format!("not a model that can be read: models are {known} files")));
        }
        let file = self.opened(&path, name)?;
        let open = &mut *self.open;
        let library = |path: &Path| {
            let mut bytes = Vec::new();
            open(path)?.read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        let loaded = model_file::parse(file, &path, library, &Options { crease })
            .map_err(|error| Fault::of(name.span(), SceneErrorKind::Model(error)))?;
        self.warnings.extend(loaded.warnings);
        self.textures.extend(loaded.textures.into_iter().map(|(name, texture)| (PathBuf::from(name), texture)));
        let (mesh, rig) = (Shared::new(loaded.mesh), loaded.rig.map(Shared::new));
        let model = NamedModel { mesh, origin: loaded.origin, up: loaded.up, rig };
        self.models.insert(key, model.clone());
        Ok(model)
    }

    /// Loads a palette: a built-in one, a file, or that of an indexed picture.
    pub(super) fn palette(&mut self, name: &Spanned<FileName>) -> Result<Palette, Fault> {
        if let Some(builtin) = builtin::by_name(&name.get_ref().0) {
            return Ok(builtin.palette.clone());
        }
        let path = self.folder.join(&name.get_ref().0);
        let bytes = self.bytes(&path, name)?;
        palette_file::of_bytes(&name.get_ref().0, &bytes).map_err(|kind| {
            let kind = match kind {
                palette_file::LoadErrorKind::Read(error) => SceneErrorKind::File { path, error },
                palette_file::LoadErrorKind::Palette(error) => SceneErrorKind::Palette { path, error },
                palette_file::LoadErrorKind::Picture(kind) => SceneErrorKind::Texture(LoadError { path, kind }),
            };
            Fault::of(name.span(), kind)
        })
    }

    /// Loads a texture: a built-in one, or the picture in a file.
    pub(super) fn texture(&mut self, name: &Spanned<FileName>) -> Result<Shared<Texture>, Fault> {
        let path = self.folder.join(&name.get_ref().0);
        if let Some(known) = self.textures.get(&path) {
            return Ok(known.clone());
        }
        let texture = match name.get_ref().0.parse() {
            Ok(builtin) => builtin,
            Err(_) => {
                let bytes = self.bytes(&path, name)?;
                let decoded = texture::decode_all(Cursor::new(bytes)).map_err(|kind| {
                    Fault::of(name.span(), SceneErrorKind::Texture(LoadError { path: path.clone(), kind }))
                })?;
                self.warnings.extend(decoded.warning(&path));
                decoded.texture
            }
        };
        let texture = Shared::new(texture);
        self.textures.insert(path, texture.clone());
        Ok(texture)
    }

    /// Loads a texture that a model's material names: from the model's own file, or relative to the working directory
    /// or the model's folder, depending on how the model was read. A missing or broken one is a warning.
    pub(super) fn texture_of_model(&mut self, path: &str, material: &str) -> Option<Shared<Texture>> {
        let path = PathBuf::from(path);
        if let Some(known) = self.textures.get(&path) {
            return Some(known.clone());
        }
        let mut bytes = Vec::new();
        let read = (self.open)(&path).and_then(|file| file.take(LONGEST_PICTURE).read_to_end(&mut bytes));
        let decoded = read.map_err(LoadErrorKind::Read).and_then(|_| texture::decode_all(Cursor::new(bytes)));
        match decoded {
            Ok(decoded) => {
                self.warnings.extend(decoded.warning(&path));
                let texture = Shared::new(decoded.texture);
                self.textures.insert(path, texture.clone());
                Some(texture)
            }
            Err(what) => {
                let path = path.display();
                self.warnings.push(std::format!("{path}: {what}; material {material} is drawn without it"));
                None
            }
        }
    }

    fn bytes(&mut self, path: &Path, name: &Spanned<FileName>) -> Result<Vec<u8>, Fault> {
        let file = self.opened(path, name)?;
        let mut bytes = Vec::new();
        match file.take(LONGEST_PICTURE).read_to_end(&mut bytes) {
            Ok(_) => Ok(bytes),
            Err(error) => Err(not_read(path, name, error)),
        }
    }

    fn opened(&mut self, path: &Path, name: &Spanned<FileName>) -> Result<Box<dyn BufRead>, Fault> {
        (self.open)(path).map_err(|error| not_read(path, name, error))
    }
}

fn not_read(path: &Path, name: &Spanned<FileName>, error: io::Error) -> Fault {
    Fault::of(name.span(), SceneErrorKind::File { path: path.to_owned(), error })
}
