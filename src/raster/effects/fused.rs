//! One loop per span from start to frame, in place of stages: texture, light, fog, blending and the depth test.

use super::destination::{Destination, InFrame, Masked};
use super::direct::Direct;
use super::pipeline::{Image, PixelPipeline};
use super::spans::Spans;
use super::texture::{show_mipmaps, show_texture};
use crate::fixed::{IS_COMPACT, IS_SMALL};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::depth::Cells;
use crate::span::target::Target;
use crate::span::texture::{Blended, FirstOffset, Fogged, FoggedShades, Texels, Tint};

impl Direct<'_> {
    /// Draws the pixels of every span, fogged or blended as the pipeline says; if there are cells,
    /// only where they are nearer. Returns the number of nearer pixels, or `None` without drawing
    /// if there is no loop for this pipeline.
    pub(super) fn show(self, spans: &Spans<'_>, pipeline: &PixelPipeline<'_>, target: &mut Target<'_>) -> Option<u32> {
        let Target { pixels, cells, kernel } = target;
        let (fog, has_few_loops) = (pipeline.fog(), self.has_few_loops());
        let cells = match (cells, pipeline.blend()) {
            (None, None) if fog.is_none() && !has_few_loops => {
                self.show_in(spans, &mut InFrame(pixels), *kernel)?;
                return Some(0);
            }
            (None, Some(blend)) if fog.is_none() && !has_few_loops && !IS_COMPACT => {
                self.show_blended(spans, blend, &mut InFrame(pixels), *kernel)?;
                return Some(0);
            }
            (None, None) => None,
            (Some(Cells::U32(cells)), None) => Some(&mut **cells),
            _ => return None,
        };
        let has_cells = cells.is_some();
        let to = &mut Masked { pixels, cells, keeps: pipeline.keeps_depth, nearer: 0 };
        match fog {
            _ if has_few_loops => self.show_mipmaps(spans, fog, to, *kernel),
            None => self.show_nearer(spans, to, *kernel),
            Some(fog) => self.show_fogged(spans, fog, to, *kernel),
        }?;
        Some(if has_cells { to.nearer } else { 0 })
    }

    /// Draws pixels where they are nearer than the cells.
    #[inline(never)]
    fn show_nearer(self, spans: &Spans<'_>, to: &mut Masked<'_>, kernel: Kernel) -> Option<()> {
        self.show_in(spans, to, kernel)
    }

    fn show_in(self, spans: &Spans<'_>, to: &mut impl Destination, kernel: Kernel) -> Option<()> {
        // Shades alone have kernels of their own.
        let Self::Texture { image, painted, is_plain } = self else { return None };
        match is_plain {
            true => show_texture(spans, image, (), to, kernel),
            false => show_texture(spans, image, painted, to, kernel),
        }
        Some(())
    }

    #[inline(never)]
    fn show_fogged(self, spans: &Spans<'_>, fog: &[u8; 65_536], to: &mut Masked<'_>, kernel: Kernel) -> Option<()> {
        match self {
            Self::Shades => show_shades(kernel.simd_level(), spans, FoggedShades(fog), to),
            Self::Texture { image, painted, .. } => show_texture(spans, image, Fogged(painted, fog), to, kernel),
        }
        Some(())
    }

    fn show_blended(self, spans: &Spans<'_>, blend: &[u8; 65_536], to: &mut InFrame<'_>, kernel: Kernel) -> Option<()> {
        match self {
            // Blending shades is 14 % faster in stages.
            Self::Shades => return None,
            Self::Texture { image, is_plain: true, .. } => show_texture(spans, image, Blended((), blend), to, kernel),
            Self::Texture { image, painted, .. } => show_texture(spans, image, Blended(painted, blend), to, kernel),
        }
        Some(())
    }

    /// Returns whether the image has mipmap levels. Their loops take the longest to compile, so there are only three,
    /// each for several kinds of pipeline. A build for size has no other loops.
    fn has_few_loops(self) -> bool {
        matches!(self, Self::Texture { image: (Image { levels: Some(_), .. }, _), .. } if !IS_COMPACT)
    }

    fn show_mipmaps(
        self,
        spans: &Spans<'_>,
        fog: Option<&[u8; 65_536]>,
        to: &mut Masked<'_>,
        kernel: Kernel,
    ) -> Option<()> {
        let Self::Texture { image, painted, is_plain } = self else { return None };
        match (is_plain, fog) {
            (true, None) => show_mipmaps(spans, image, (), to, kernel),
            (false, None) => show_mipmaps(spans, image, painted, to, kernel),
            (_, Some(fog)) => show_mipmaps(spans, image, Fogged(painted, fog), to, kernel),
        }
        Some(())
    }
}

compiled_for_each_level! {
    /// Draws the shades of every span, tinted.
    #[inline(never)]
    fn show_shades[T: Tint, D: Destination][T, D](spans: &Spans<'_>, tint: T, to: &mut D) = show_shades_by, up to AVX2;
}

#[inline(always)]
fn show_shades_by<S: Lanes8, T: Tint, D: Destination>(s: S, spans: &Spans<'_>, tint: T, to: &mut D) {
    // A build for size has no such pipeline; this tells the compiler so.
    if IS_SMALL {
        return;
    }
    for i in 0..spans.count() {
        let Some(pixels) = to.begin(s, spans, i) else { continue };
        let along = &mut tint.begin(s, spans.values::<T>(i, pixels.skipped));
        to.show(s, (spans, i, 0), pixels, (Texels::ONE, tint, along), FirstOffset(s));
    }
}
