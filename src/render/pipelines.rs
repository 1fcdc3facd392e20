//! Pixel pipelines of surfaces, assembled from the plan, the material and the tables.

use super::Cache;
use super::budget::limits;
use super::picker::Look;
use super::pixel_light::PixelLight;
use super::surface_material::SurfaceMaterial;
use super::tables::Image;
use crate::light::{Blend, Material};
use crate::palette::Palette;
use crate::plan::stages::Dither;
use crate::plan::{FaceShading, ObjectPlan};
use crate::raster::Interpolation;
use crate::raster::effects::{PixelPipeline, ShadeSource, TextureStage};
use crate::scene::Scene;
use crate::settings::{Mapping, Shading};
use crate::span::Kernel;
use crate::span::dither::Thresholds;
use crate::span::texture::Texels;

/// The image of a surface, if one is on: its own, or the environment it mirrors.
fn image<'a>(plan: &ObjectPlan, own: &'a Material, material: &SurfaceMaterial) -> Option<Image<'a>> {
    let (texture, has_levels) = if material.texture_size.is_some() {
        (&own.texture, plan.stages().has_mipmaps())
    } else if material.environment_size.is_some() {
        (&own.environment, false)
    } else {
        return None;
    };
    texture.as_ref().map(|texture| Image { texture, has_levels })
}

/// Makes the tables that a frame needs.
#[inline(never)]
pub(super) fn ensure_tables(cache: &mut Cache, scene: &Scene, palette: &Palette) {
    let Cache { tables, plan, states, .. } = cache;
    if !plan.objects().iter().any(|plan| plan.stages().needs_tables()) {
        return;
    }
    tables.use_palette(palette);
    for ((object, plan), state) in scene.objects().iter().zip(plan.objects()).zip(&*states) {
        if plan.stages().has_fog() {
            tables.ensure_fog(scene.fog.map(|fog| fog.color));
        }
        let channels = plan.stages().has_channels();
        if channels {
            tables.ensure_mix();
        }
        for (own, material) in object.materials.iter().zip(&state.materials) {
            let image = image(plan, own, material);
            if image.is_some() || plan.stages().neutral_image {
                tables.ensure_shades(image, channels);
            }
            if material.blend != Blend::Opaque || plan.stages().neutral_blend {
                tables.ensure_blend(material.blend);
            }
        }
    }
}

/// The pixel pipelines of a frame's surfaces.
#[derive(Clone, Copy)]
pub(super) struct Pipelines<'a> {
    pub(super) scene: &'a Scene,
    pub(super) cache: &'a Cache,
    pub(super) kernel: Kernel,
}

impl Pipelines<'_> {
    /// Passes the pixel pipeline of faces of an object to `draw`.
    pub(super) fn with<T>(
        &self,
        object: usize,
        Look { surface, shading, .. }: Look,
        draw: impl FnOnce(&PixelPipeline<'_>) -> T,
    ) -> T {
        let Cache { plan, states, tables, .. } = self.cache;
        let (plan, state) = (&plan.objects[object], &states[object]);
        let own = &self.scene.objects()[object].materials[usize::from(surface)];
        let material = &state.materials[usize::from(surface)];
        let light = PixelLight { lights: state.lights(plan), material, kernel: self.kernel };
        let dither = plan.stages().dither;
        let channels = plan.stages().has_channels().then(|| tables.mix(dither != Dither::None));
        let image = image(plan, own, material);
        let texels = match image {
            Some(Image { texture, .. }) => {
                Texels::new(texture.texels(), texture.width_bits(), texture.height_bits()).ok()
            }
            None if plan.stages().neutral_image && channels.is_none() => Some(Texels::ONE),
            None => None,
        };
        let texture =
            texels.zip(tables.shades(image, channels.is_some())).map(|(texels, tables_of_image)| TextureStage {
                texels,
                levels: image.and_then(|image| tables.levels(image)),
                mapping: if material.texture_size.is_some() { plan.stages().mapping } else { Mapping::Affine },
                tables: tables_of_image,
            });
        let blends = material.blend != Blend::Opaque || plan.stages().neutral_blend;
        let lights_pixels = plan.stages().lights_pixels() && shading.lights_pixels();
        let source = match (shading, state.normal_table(surface)) {
            _ if !lights_pixels => ShadeSource::Shaded(shading.interpolation()),
            (FaceShading::By(Shading::PhongTable), Some(table)) if channels.is_none() => {
                ShadeSource::NormalTable(table)
            }
            (FaceShading::By(_), _) => ShadeSource::Lit(&light),
            (FaceShading::PhongEvery(spacing), _) => ShadeSource::LitEvery(spacing, &light),
            (FaceShading::Quadratic, _) => ShadeSource::Curved(limits(material, channels.is_some())),
        };
        draw(&PixelPipeline {
            source,
            channels,
            dither: match dither {
                Dither::Neutral => {
                    let cut = shading.interpolation() == Interpolation::GouraudVintage && channels.is_none();
                    Some(if cut { Thresholds::ZEROS } else { Thresholds::HALVES })
                }
                Dither::By(pattern) => Some(pattern.thresholds()),
                Dither::None => None,
            },
            texture,
            fog: if plan.stages().has_fog() { tables.fog() } else { None },
            blend: if blends { tables.blend(material.blend) } else { None },
            keeps_depth: material.blend == Blend::Opaque,
        })
    }
}
