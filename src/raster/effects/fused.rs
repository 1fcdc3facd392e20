//! One loop per span from start to frame, in place of stages: texture, light, fog, blending and the depth test.

use super::destination::{Destination, InFrame, Masked};
use super::direct::{Direct, DirectTint};
use super::pipeline::PixelPipeline;
use super::spans::Spans;
use super::texture::show_texture;
use crate::fixed::{IS_COMPACT, IS_SMALL};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::depth::Cells;
use crate::span::list::Target;
use crate::span::texture::{Blended, FirstPlace, Fogged, Painted, Texels, Tint, Untextured};

impl Direct<'_> {
    /// Draws the pixels of every span, fogged or blended as the pipeline says; if there are cells,
    /// only where they are nearer. Returns the number of nearer pixels, or `None` without drawing
    /// if there is no loop for this pipeline.
    pub(super) fn show(self, spans: &Spans<'_>, pipeline: &PixelPipeline<'_>, target: &mut Target<'_>) -> Option<u32> {
        let Target { pixels, cells, kernel } = target;
        let (fog, keeps) = (pipeline.fog(), pipeline.keeps_depth);
        match (cells, fog, pipeline.blend()) {
            (None, None, None) => self.show_in(spans, &mut InFrame(pixels), *kernel)?,
            (None, None, Some(blend)) if !IS_COMPACT => {
                self.show_blended(spans, blend, &mut InFrame(pixels), *kernel)?
            }
            (None, Some(fog), None) => {
                self.show_fogged(spans, fog, &mut Masked { pixels, cells: None, keeps, nearer: 0 }, *kernel)?;
            }
            (Some(Cells::U32(cells)), fog, None) => {
                let mut to = Masked { pixels, cells: Some(cells), keeps, nearer: 0 };
                self.show_nearer(spans, fog, &mut to, *kernel)?;
                return Some(to.nearer);
            }
            _ => return None,
        }
        Some(0)
    }

    /// Draws pixels where they are nearer than the cells.
    #[inline(never)]
    fn show_nearer(
        self,
        spans: &Spans<'_>,
        fog: Option<&[u8; 65_536]>,
        to: &mut Masked<'_>,
        kernel: Kernel,
    ) -> Option<()> {
        match fog {
            None => self.show_in(spans, to, kernel),
            Some(fog) => self.show_fogged(spans, fog, to, kernel),
        }
    }

    fn show_in(self, spans: &Spans<'_>, to: &mut impl Destination, kernel: Kernel) -> Option<()> {
        // Shades alone have kernels of their own.
        let Self::Texture { image, tint } = self else { return None };
        match tint {
            DirectTint::None => show_texture(spans, image, (), to, kernel),
            DirectTint::Row(row) => show_texture(spans, image, row, to, kernel),
            DirectTint::Lit(table) => show_texture(spans, image, Painted(table), to, kernel),
        }
        Some(())
    }

    #[inline(never)]
    fn show_fogged(self, spans: &Spans<'_>, fog: &[u8; 65_536], to: &mut Masked<'_>, kernel: Kernel) -> Option<()> {
        match self {
            // With narrow vectors, stages are 3 % faster.
            Self::Shades if !kernel.has_wide_lanes() => return None,
            Self::Shades => show_shades(kernel.simd_level(), spans, Fogged(Untextured, fog), to),
            Self::Texture { image, tint } => match tint {
                DirectTint::None => show_texture(spans, image, Fogged((), fog), to, kernel),
                DirectTint::Row(row) => show_texture(spans, image, Fogged(row, fog), to, kernel),
                DirectTint::Lit(table) => show_texture(spans, image, Fogged(Painted(table), fog), to, kernel),
            },
        }
        Some(())
    }

    fn show_blended(self, spans: &Spans<'_>, blend: &[u8; 65_536], to: &mut InFrame<'_>, kernel: Kernel) -> Option<()> {
        // Blending shades is 14 % faster in stages.
        let Self::Texture { image, tint } = self else { return None };
        match tint {
            DirectTint::None => show_texture(spans, image, Blended((), blend), to, kernel),
            DirectTint::Row(row) => show_texture(spans, image, Blended(row, blend), to, kernel),
            DirectTint::Lit(table) => show_texture(spans, image, Blended(Painted(table), blend), to, kernel),
        }
        Some(())
    }
}

compiled_for_each_level! {
    /// Draws the shades of every span, tinted.
    #[inline(never)]
    fn show_shades[T: Tint, D: Destination][T, D](spans: &Spans<'_>, tint: T, to: &mut D) = show_shades_by;
}

#[inline(always)]
fn show_shades_by<S: Lanes8, T: Tint, D: Destination>(s: S, spans: &Spans<'_>, tint: T, to: &mut D) {
    // A build for size has no such pipeline; here the compiler sees that.
    if IS_SMALL {
        return;
    }
    for i in 0..spans.count() {
        let (at, length, skipped) = to.span(spans, i);
        let along = &mut tint.begin(s, spans.values::<T>(i, skipped));
        to.show(s, (spans, i, 0), (at, length), (Texels::ONE, tint, along), FirstPlace(s));
    }
}
