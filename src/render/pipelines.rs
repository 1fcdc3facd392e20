//! Pixel pipelines of surfaces, assembled from the plan, the material and the tables.

use super::budget::limits;
use super::object::ObjectState;
use super::paint::SurfaceMaterial;
use super::pixel_light::PixelLight;
use super::tables::{Image, Tables};
use crate::light::{Blend, Material};
use crate::palette::{Palette, Ramp};
use crate::plan::FaceShading;
use crate::plan::stages::Dither;
use crate::plan::{ObjectPlan, Plan};
use crate::raster::effects::{PixelPipeline, ShadeSource, TextureStage};
use crate::raster::{DrawStats, Interpolation};
use crate::scene::Scene;
use crate::settings::{Mapping, Shading};
use crate::span::Kernel;
use crate::span::dither::Thresholds;
use crate::span::texture::Texels;

/// A single texel, for an image that changes nothing.
const ONE_TEXEL: [u8; 1] = [0];

/// The image of a surface, if one is on: its own, or the environment it mirrors.
fn image<'a>(plan: &ObjectPlan, material: &'a Material, paint: &SurfaceMaterial) -> Option<Image<'a>> {
    let (texture, has_levels) = if paint.texture_size.is_some() {
        (&material.texture, plan.stages().has_mipmaps())
    } else if paint.environment_size.is_some() {
        (&material.environment, false)
    } else {
        return None;
    };
    texture.as_ref().map(|texture| Image { texture, has_levels })
}

/// Makes the tables that a frame needs.
#[inline(never)]
pub(super) fn ensure_tables(
    tables: &mut Tables,
    scene: &Scene,
    palette: &Palette,
    plan: &Plan,
    states: &[ObjectState],
) {
    if !plan.objects().iter().any(|plan| plan.stages().needs_tables()) {
        return;
    }
    tables.use_palette(palette);
    for ((object, plan), state) in scene.objects().iter().zip(plan.objects()).zip(states) {
        if plan.stages().has_fog() {
            tables.ensure_fog(scene.fog.map(|fog| fog.color));
        }
        let channels = plan.stages().has_channels();
        if channels {
            tables.ensure_mix();
        }
        for (material, paint) in object.materials.iter().zip(state.paints()) {
            let image = image(plan, material, paint);
            if let Some(image) = image {
                tables.ensure_levels(image);
            }
            match image {
                Some(image) if channels => tables.ensure_channels(image),
                Some(image) => tables.ensure_shades(Some(image)),
                None if plan.stages().neutral_image => tables.ensure_shades(None),
                None => {}
            }
            if paint.blend != Blend::Opaque || plan.stages().neutral_blend {
                tables.ensure_blend(paint.blend);
            }
        }
    }
}

/// The surface and the shading that a pixel pipeline is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct PipelineKey {
    pub(super) object: usize,
    pub(super) surface: u16,
    pub(super) shading: FaceShading,
}

/// The pixel pipelines of a frame's surfaces.
#[derive(Clone, Copy)]
pub(super) struct Pipelines<'a> {
    pub(super) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    pub(super) states: &'a [ObjectState],
    pub(super) tables: &'a Tables,
    pub(super) kernel: Kernel,
}

impl Pipelines<'_> {
    fn paint(&self, object: usize, surface: u16) -> Option<&SurfaceMaterial> {
        self.states.get(object)?.paints().get(usize::from(surface))
    }

    /// The palette entries of a surface's shades.
    pub(super) fn ramp(&self, object: usize, surface: u16) -> Option<Ramp> {
        self.paint(object, surface).map(|paint| paint.ramp)
    }

    /// Passes the pixel pipeline of an object's surface to `draw`. A surface that does not exist is not drawn.
    pub(super) fn with(
        &self,
        PipelineKey { object, surface, shading }: PipelineKey,
        draw: impl FnOnce(&PixelPipeline<'_>) -> DrawStats,
    ) -> DrawStats {
        let (Some(plan), Some(state), Some(paint)) =
            (self.plan.objects().get(object), self.states.get(object), self.paint(object, surface))
        else {
            return DrawStats::default();
        };
        let Some(material) = self.scene.objects().get(object).and_then(|o| o.materials.get(usize::from(surface)))
        else {
            return DrawStats::default();
        };
        let light = PixelLight { lights: state.lights(plan), paint, kernel: self.kernel };
        let dither = plan.stages().dither;
        let channels = plan.stages().has_channels().then(|| self.tables.mix(dither != Dither::None));
        let image = image(plan, material, paint);
        let texture_look = match image {
            Some(image) => {
                let texture = image.texture;
                let texels = Texels::new(texture.texels(), texture.width_bits(), texture.height_bits()).ok();
                let tables =
                    if channels.is_some() { self.tables.channels(image) } else { self.tables.shades(Some(image)) };
                texels.zip(tables).map(|(texels, tables)| {
                    let mapping = if paint.texture_size.is_some() { plan.stages().mapping } else { Mapping::Affine };
                    TextureStage { texels, levels: self.tables.levels(image), mapping, tables }
                })
            }
            None if plan.stages().neutral_image && channels.is_none() => {
                let texels = Texels::new(&ONE_TEXEL, 0, 0).ok();
                texels.zip(self.tables.shades(None)).map(|(texels, tables)| TextureStage {
                    texels,
                    levels: None,
                    mapping: Mapping::Affine,
                    tables,
                })
            }
            None => None,
        };
        let blends = paint.blend != Blend::Opaque || plan.stages().neutral_blend;
        let look = PixelPipeline {
            source: source(plan, shading, channels.is_some(), state.normal_table(surface), &light),
            channels,
            dither: match dither {
                Dither::Neutral => {
                    let cut = shading.interpolation() == Interpolation::GouraudVintage && channels.is_none();
                    Some(if cut { Thresholds::ZEROS } else { Thresholds::HALVES })
                }
                Dither::By(pattern) => Some(pattern.thresholds()),
                Dither::None => None,
            },
            texture: texture_look,
            fog: if plan.stages().has_fog() { self.tables.fog(self.scene.fog.map(|fog| fog.color)) } else { None },
            blend: if blends { self.tables.blend(paint.blend) } else { None },
            keeps_depth: paint.blend == Blend::Opaque,
        };
        draw(&look)
    }
}

fn source<'a>(
    plan: &ObjectPlan,
    shading: FaceShading,
    channels: bool,
    table: Option<&'a [u8; 65_536]>,
    light: &'a PixelLight<'a>,
) -> ShadeSource<'a> {
    if plan.stages().lights_pixels() && shading.lights_pixels() {
        return match (shading, table) {
            (FaceShading::By(Shading::PhongTable), Some(table)) if !channels => ShadeSource::NormalTable(table),
            (FaceShading::By(_), _) => ShadeSource::Lit(light),
            (FaceShading::PhongEvery(spacing), _) => ShadeSource::LitEvery(spacing, light),
            (FaceShading::Quadratic, _) => ShadeSource::Curved(limits(light.paint, channels)),
        };
    }
    ShadeSource::Shaded(shading.interpolation())
}
