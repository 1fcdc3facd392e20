//! Pipelines whose texels need no stage before them: one loop per span shows them.

use super::pipeline::{PixelPipeline, ShadeSource};
use crate::fixed::IS_SMALL;
use crate::mapping::Mapping;
use crate::raster::interpolation::Interpolation;
use crate::span::texture::Texels;

/// How the texels of faces are shown by one loop per span, with no buffer between.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectTexture<'a> {
    pub(super) image: Texels<'a>,
    pub(super) is_perspective: bool,
    pub(super) tint: DirectTint<'a>,
}

/// How the texels are tinted.
#[derive(Clone, Copy, Debug)]
pub(super) enum DirectTint<'a> {
    /// None: texels are shown as they are.
    None,
    /// One row of a table, for one shade.
    Row(&'a [u8; 256]),
    /// A table, for linear shades.
    Lit(&'a [u8; 65_536]),
}

impl<'a> DirectTexture<'a> {
    /// The direct texture of a pipeline whose bytes before fog depend on nothing but an image and a linear shade.
    pub(super) fn of(pipeline: &PixelPipeline<'a>) -> Option<Self> {
        // A build for size has no loop for each tint: it finds the places of texels, and then looks these up.
        let stage = pipeline.texture().filter(|_| !IS_SMALL)?;
        let table = stage.tables[0];
        let is_plain =
            pipeline.levels().is_none() && pipeline.channels().is_none() && stage.mapping != Mapping::Every16;
        let tint = match pipeline.source {
            ShadeSource::Shaded(Interpolation::Flat(shade)) => {
                let row = table.as_chunks::<256>().0.get(usize::from(shade))?;
                let is_identity = row.iter().zip(0..=255).all(|(byte, texel)| *byte == texel);
                if is_identity { DirectTint::None } else { DirectTint::Row(row) }
            }
            ShadeSource::Shaded(Interpolation::Gouraud | Interpolation::GouraudReseeded)
                if pipeline.dither().is_none() =>
            {
                DirectTint::Lit(table)
            }
            _ => return None,
        };
        is_plain.then_some(Self { image: stage.texels, is_perspective: stage.mapping == Mapping::Perspective, tint })
    }
}
