//! Surfaces and textures of materials, by the rules given in the parent module.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Cursor};
use std::path::Path;

use ::gltf::Material;
use ::gltf::material::AlphaMode;
use ::gltf::texture::{Info, WrappingMode};
use mode13h::mesh::Surface;
use mode13h::scene::Shared;
use mode13h::texture::Texture;

use super::LeftOut;
use super::accessor::Buffers;
use crate::model_file::Embedded;
use crate::texture::{Decoded, decode_all};

/// How a texture is placed: `KHR_texture_transform`, and the wrapping modes of its sampler.
#[derive(Clone, Copy)]
pub(super) struct Mapping {
    /// The set of texture coordinates.
    pub(super) set: u32,
    offset: [f64; 2],
    scale: [f64; 2],
    rotation: f64,
    /// Whether the sampler clamps to the edge in u and in v; otherwise the texture repeats.
    clamps: [bool; 2],
}

/// How far beyond 0 to 1 coordinates may be before they count as outside: sixteen rounding errors of an f32 near 1, as
/// exporters that scale or move coordinates accumulate a few. In the largest texture that is 1/4096 texel: invisible.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

impl Mapping {
    const NONE: Self = Self { set: 0, offset: [0.0; 2], scale: [1.0; 2], rotation: 0.0, clamps: [false; 2] };

    fn of(info: &Info<'_>) -> Self {
        let set = info.tex_coord();
        let sampler = info.texture().sampler();
        let clamps = [sampler.wrap_s(), sampler.wrap_t()].map(|mode| mode == WrappingMode::ClampToEdge);
        let Some(transform) = info.texture_transform() else { return Self { set, clamps, ..Self::NONE } };
        Self {
            set: transform.tex_coord().unwrap_or(set),
            offset: transform.offset().map(f64::from),
            scale: transform.scale().map(f64::from),
            rotation: transform.rotation().into(),
            clamps,
        }
    }

    /// Scales the pair, rotates it counter-clockwise as seen with v down, and translates it.
    pub(super) fn apply(self, pair: [f64; 2]) -> [f64; 2] {
        let [u, v] = [0, 1].map(|i| pair[i] * self.scale[i]);
        let (sin, cos) = (libm::sin(self.rotation), libm::cos(self.rotation));
        [cos * u + sin * v + self.offset[0], cos * v - sin * u + self.offset[1]]
    }

    /// Returns whether a placed pair is where the texture should be clamped.
    pub(super) fn is_clamped(self, pair: [f64; 2]) -> bool {
        pair.iter().zip(self.clamps).any(|(c, clamps)| clamps && (*c < -ROUNDING || *c > 1.0 + ROUNDING))
    }
}

/// How the diffuse colour of a material follows from its base colour.
#[derive(Clone, Copy)]
pub(super) struct Shade {
    /// The factor of the base colour, linear.
    factor: [f64; 3],
    /// How much of the base colour is diffuse.
    share: f64,
    /// The emission, in sRGB, which is added.
    emission: [f64; 3],
}

impl Shade {
    /// The diffuse colour, in sRGB, where the base colour is multiplied by the linear `color`.
    pub(super) fn diffuse(&self, color: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|i| {
            let base = encoded(color[i] * self.factor[i]);
            (base * self.share + self.emission[i]).min(1.0) as f32
        })
    }
}

/// The surfaces of the materials in use.
pub(super) struct Materials<'a> {
    path: &'a Path,
    buffers: &'a Buffers,
    /// Reads a picture in a separate file, by its path.
    file: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    pub(super) surfaces: Vec<Surface>,
    /// The painted copy of each surface that has one: the same material with the colours of faces.
    pub(super) painted: HashMap<usize, usize>,
    pub(super) textures: Embedded,
    pub(super) left_out: LeftOut,
    /// Whether some surface should be fully transparent. It is drawn opaque.
    pub(super) has_unseen: bool,
    known: HashMap<Option<usize>, (usize, Mapping, Shade)>,
    /// The images read so far: the texture, and whether some of it was not opaque.
    images: HashMap<usize, Option<(Shared<Texture>, bool)>>,
}

/// The exponent at which a highlight is no more than a point.
const MAX_SHININESS: f64 = 1000.0;

impl<'a> Materials<'a> {
    pub(super) fn new(
        path: &'a Path,
        buffers: &'a Buffers,
        file: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    ) -> Self {
        Self {
            path,
            buffers,
            file,
            surfaces: Vec::new(),
            painted: HashMap::new(),
            textures: Embedded::new(),
            left_out: LeftOut::new(),
            has_unseen: false,
            known: HashMap::new(),
            images: HashMap::new(),
        }
    }

    fn leave_out(&mut self, what: &'static str) {
        self.left_out.insert(what);
    }

    /// The index of a material's surface, how its texture is placed, and its shade.
    pub(super) fn surface(&mut self, material: &Material<'_>) -> (usize, Mapping, Shade) {
        if let Some(known) = self.known.get(&material.index()) {
            return *known;
        }
        let made = self.made(material);
        self.known.insert(material.index(), made);
        made
    }

    /// The surface with the material of another, for faces with colours of their own. It has no texture yet.
    pub(super) fn painted(&mut self, surface: usize) -> usize {
        let Self { surfaces, painted, .. } = self;
        *painted.entry(surface).or_insert_with(|| {
            surfaces.push(Surface { diffuse: [1.0; 3], ..surfaces[surface].clone() });
            surfaces.len() - 1
        })
    }

    fn made(&mut self, material: &Material<'_>) -> (usize, Mapping, Shade) {
        let pbr = material.pbr_metallic_roughness();
        let [red, green, blue, alpha] = pbr.base_color_factor();
        let factor = [red, green, blue].map(f64::from);
        let base = factor.map(encoded);
        let (mut metallic, mut roughness) = (f64::from(pbr.metallic_factor()), f64::from(pbr.roughness_factor()));
        if let Some(info) = pbr.metallic_roughness_texture() {
            match self.means(&info) {
                Some([_, rough, metal]) => (metallic, roughness) = (metallic * metal, roughness * rough),
                None => self.leave_out("metallic-roughness textures that cannot be read"),
            }
        }
        let (metallic, roughness) = (metallic.clamp(0.0, 1.0), roughness.clamp(0.0, 1.0));
        let share = 1.0 - metallic * (1.0 - roughness) / 2.0;
        let mut shade = Shade { factor, share, emission: [0.0; 3] };
        let mut specular = base.map(|b| (1.0 - roughness) * ((1.0 - metallic) * encoded(0.04) + metallic * b));
        let mut shininess = (2.0 / (roughness * roughness * roughness * roughness) - 2.0).clamp(0.0, MAX_SHININESS);
        if material.unlit() {
            (shade.share, specular, shininess) = (1.0, [0.0; 3], 0.0);
            self.leave_out("unlit shading");
        }
        let mut image = pbr.base_color_texture();
        let emission = material.emissive_factor().map(|channel| encoded(channel.into()));
        if emission != [0.0; 3] {
            match material.emissive_texture() {
                None => shade.emission = emission,
                Some(emissive) if image.is_none() && base == [0.0; 3] => {
                    (shade.emission, image) = (emission, Some(emissive));
                }
                Some(_) => self.leave_out("emissive textures"),
            }
        }
        if material.normal_texture().is_some() {
            self.leave_out("normal maps");
        }
        if material.occlusion_texture().is_some() {
            self.leave_out("occlusion maps");
        }
        let is_opaque = material.alpha_mode() == AlphaMode::Opaque;
        let mut surface = Surface {
            name: material.name().unwrap_or_default().to_owned(),
            diffuse: shade.diffuse([1.0; 3]),
            specular: specular.map(|channel| channel as f32),
            shininess: shininess as f32,
            ..Surface::default()
        };
        if material.alpha_mode() == AlphaMode::Blend {
            self.has_unseen |= alpha <= 0.0;
            if alpha > 0.0 && alpha < 1.0 {
                surface.opacity = alpha;
            }
        }
        let mut mapping = Mapping::NONE;
        if let Some(info) = &image {
            mapping = Mapping::of(info);
            surface.texture = self.texture(info, is_opaque);
            let sampler = info.texture().sampler();
            if [sampler.wrap_s(), sampler.wrap_t()].contains(&WrappingMode::MirroredRepeat) {
                self.leave_out("mirrored textures");
            }
        }
        self.surfaces.push(surface);
        (self.surfaces.len() - 1, mapping, shade)
    }

    /// The name of a texture: that of a file, or of an image inside the model file.
    fn texture(&mut self, info: &Info<'_>, is_opaque: bool) -> Option<String> {
        let Some(source) = info.texture().source() else {
            self.leave_out("textures in unsupported formats");
            return None;
        };
        let buffers = self.buffers;
        if let Some(Err(path)) = buffers.image(source.index()) {
            return Some(path.to_owned());
        }
        let Some((texture, was_transparent)) = self.image(source.index()) else {
            self.leave_out("textures in unsupported formats");
            return None;
        };
        if was_transparent && !is_opaque {
            self.leave_out("texture transparency");
        }
        let name = format!("{}#{}", self.path.display(), source.index());
        self.textures.insert(name.clone(), texture);
        Some(name)
    }

    /// The texture of an image, inside the file or separate, and whether some of it was not opaque.
    fn image(&mut self, index: usize) -> Option<(Shared<Texture>, bool)> {
        let buffers = self.buffers;
        let file = &mut self.file;
        let read = || {
            let bytes = match buffers.image(index)? {
                Ok(bytes) => Cow::Borrowed(bytes),
                Err(path) => Cow::Owned(file(Path::new(path)).ok()?),
            };
            let Decoded { texture, was_transparent, .. } = decode_all(Cursor::new(bytes)).ok()?;
            Some((Shared::new(texture), was_transparent))
        };
        self.images.entry(index).or_insert_with(read).clone()
    }

    /// The channel means of a texture. `None` if it cannot be read.
    fn means(&mut self, info: &Info<'_>) -> Option<[f64; 3]> {
        let (texture, _) = self.image(info.texture().source()?.index())?;
        let (mut sums, mut count) = ([0.0; 3], 0.0);
        for (color, texels) in texture.colors().iter().zip(texture.histogram()) {
            let texels = f64::from(texels);
            let channels = [color.r, color.g, color.b];
            sums.iter_mut().zip(channels).for_each(|(sum, channel)| *sum += f64::from(channel) * texels);
            count += 255.0 * texels;
        }
        Some(sums.map(|sum| sum / count))
    }
}

/// Encodes a share of light, 0 to 1, as sRGB.
pub(super) fn encoded(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}
