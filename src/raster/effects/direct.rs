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
    /// Texels of an image. `painted` looks them up in the pipeline's table, whatever the tint.
    Texture { image: (Image<'a>, Mapping), tint: DirectTint<'a>, painted: Painted<'a> },
}

/// How texels are tinted.
#[derive(Clone, Copy, Debug)]
pub(super) enum DirectTint<'a> {
    /// None: texels are shown as they are.
    None,
    /// One row of a table, for one shade.
    Row(&'a [u8; 256]),
    /// A table, for linear shades.
    Lit,
}

/// Returns whether a table row leaves every texel unchanged.
fn is_identity(row: &[u8; 256]) -> bool {
    // Comparing arrays would call `bcmp`, which the C library's archive does not ask its host for.
    row.iter().zip(0_u8..=255).fold(0, |differ, (&shown, texel)| differ | shown ^ texel) == 0
}

impl<'a> Direct<'a> {
    /// The direct form of a pipeline whose bytes before fog depend on nothing but an image and a linear shade.
    pub(super) fn of(pipeline: &PixelPipeline<'a>) -> Option<Self> {
        // A build for size has no loop for each tint: it stores texels, then looks them up.
        if IS_SMALL || pipeline.channels().is_some() {
            return None;
        }
        let is_linear = pipeline.dither().is_none()
            && matches!(pipeline.source, ShadeSource::Shaded(Interpolation::Gouraud | Interpolation::GouraudReseeded));
        let Some(stage) = pipeline.texture() else { return is_linear.then_some(Self::Shades) };
        if stage.mapping == Mapping::Every16 {
            return None;
        }
        let table = stage.tables[0];
        let (tint, flat) = match pipeline.source {
            ShadeSource::Shaded(Interpolation::Flat(shade)) => {
                let row = table.as_chunks::<256>().0.get(usize::from(shade))?;
                (if is_identity(row) { DirectTint::None } else { DirectTint::Row(row) }, Some(shade))
            }
            _ if is_linear => (DirectTint::Lit, None),
            _ => return None,
        };
        Some(Self::Texture { image: (Image::new(stage), stage.mapping), tint, painted: Painted { table, flat } })
    }
}
