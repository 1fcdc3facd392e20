//! Pipelines whose pixels need no stage before fog and blending: one loop per span draws them.

use super::pipeline::{Image, PixelPipeline, ShadeSource};
use crate::fixed::IS_SMALL;
use crate::mapping::Mapping;
use crate::raster::interpolation::Interpolation;
use crate::span::texture::Painted;

/// How one loop per span draws the pixels of faces, with no buffer in between.
#[derive(Clone, Copy, Debug)]
pub(super) enum Direct<'a> {
    /// Linear shades, to be fogged.
    Shades,
    /// Texels of an image, looked up in the pipeline's table unless that would leave them as they are.
    Texture { image: (Image<'a>, Mapping), painted: Painted<'a>, is_plain: bool },
}

/// Returns whether a table row leaves every texel unchanged.
fn is_identity(row: &[u8; 256]) -> bool {
    // Comparing arrays would call `bcmp`, which the C library's archive does not require its host to provide.
    let (mut texels, mut differ) = (u64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7]), 0);
    for eight in row.as_chunks().0 {
        differ |= u64::from_le_bytes(*eight) ^ texels;
        // The last sum overflows from the highest byte.
        texels = texels.wrapping_add(0x0808_0808_0808_0808);
    }
    differ == 0
}

impl<'a> Direct<'a> {
    /// The direct form of a pipeline whose bytes before fog depend on nothing but an image and a linear shade.
    pub(super) fn of(pipeline: &PixelPipeline<'a>) -> Option<Self> {
        // Every stage is named, so that a new one cannot be skipped here by oversight.
        let PixelPipeline { source: _, channels: _, dither: _, texture: _, fog: _, blend: _, keeps_depth: _ } =
            pipeline;
        // A build for size has no loop for each tint: it stores texels, then looks them up.
        if IS_SMALL || pipeline.channels().is_some() {
            return None;
        }
        let is_linear = pipeline.dither().is_none()
            && matches!(
                pipeline.source,
                ShadeSource::Shaded(Interpolation::Gouraud88 | Interpolation::Gouraud88Reseeded)
            );
        let Some(stage) = pipeline.texture() else { return is_linear.then_some(Self::Shades) };
        if stage.mapping == Mapping::Every16 {
            return None;
        }
        let table = stage.tables[0];
        let (flat, is_plain) = match pipeline.source {
            ShadeSource::Shaded(Interpolation::Flat(shade)) => {
                (Some(shade), is_identity(table.as_chunks().0.get(usize::from(shade))?))
            }
            _ if is_linear => (None, false),
            _ => return None,
        };
        Some(Self::Texture { image: (Image::new(stage), stage.mapping), painted: Painted { table, flat }, is_plain })
    }
}
