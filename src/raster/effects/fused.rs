//! One loop per span from start to frame, in place of stages: texture, light, fog, blending and the depth test.

use super::destination::{Destination, InFrame, WhereNearer};
use super::direct::{Direct, DirectTint};
use super::pipeline::PixelPipeline;
use super::spans::Spans;
use super::texture::show_texture;
use crate::fixed::IS_SMALL;
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::depth::Cells;
use crate::span::list::Target;
use crate::span::texture::{Blended, Fogged, Painted, StoredPlaces, Texels, Tint, Untextured};

impl Direct<'_> {
    /// Shows the pixels of every span in the frame, fogged and blended as the pipeline says; if there are cells, only
    /// where they are nearer. Returns the number of nearer pixels; `None`, with nothing shown, if there is no loop for
    /// this pipeline.
    pub(super) fn show(self, spans: &Spans<'_>, pipeline: &PixelPipeline<'_>, target: &mut Target<'_>) -> Option<u32> {
        let Target { pixels, cells, kernel } = target;
        match (cells, pipeline.fog(), pipeline.blend()) {
            (None, fog, None) => self.show_in(spans, fog, &mut InFrame(pixels), *kernel),
            (None, None, Some(blend)) => self.show_blended(spans, blend, &mut InFrame(pixels), *kernel),
            (Some(Cells::U32(cells)), ..) => return self.show_nearer(spans, pipeline, (pixels, cells), *kernel),
            _ => None,
        }?;
        Some(0)
    }

    /// [`show`](Self::show) where pixels are nearer than the cells.
    #[inline(never)]
    fn show_nearer(
        self,
        spans: &Spans<'_>,
        pipeline: &PixelPipeline<'_>,
        (pixels, cells): (&mut [u8], &mut [u32]),
        kernel: Kernel,
    ) -> Option<u32> {
        let mut to = WhereNearer { pixels, cells, keeps: pipeline.keeps_depth, nearer: 0 };
        match (pipeline.fog(), pipeline.blend()) {
            (fog, None) => self.show_in(spans, fog, &mut to, kernel)?,
            (None, Some(blend)) => self.show_blended(spans, blend, &mut to, kernel)?,
            _ => return None,
        }
        Some(to.nearer)
    }

    fn show_in(
        self,
        spans: &Spans<'_>,
        fog: Option<&[u8; 65_536]>,
        to: &mut impl Destination,
        kernel: Kernel,
    ) -> Option<()> {
        let (image, tint) = match self {
            Self::Shades => {
                // Shades alone have kernels of their own. With narrow vectors stages are 3 % faster.
                let fog = fog.filter(|_| kernel.has_wide_lanes())?;
                show_shades(kernel.simd_level(), spans, Fogged(Untextured, fog), to);
                return Some(());
            }
            Self::Texture { image, is_perspective, tint } => ((image, is_perspective), tint),
        };
        match (tint, fog) {
            (DirectTint::None, None) => show_texture(spans, image, (), to, kernel),
            (DirectTint::Row(row), None) => show_texture(spans, image, row, to, kernel),
            (DirectTint::Lit(table), None) => show_texture(spans, image, Painted(table), to, kernel),
            (DirectTint::None, Some(fog)) => show_texture(spans, image, Fogged((), fog), to, kernel),
            (DirectTint::Row(row), Some(fog)) => show_texture(spans, image, Fogged(row, fog), to, kernel),
            (DirectTint::Lit(table), Some(fog)) => {
                show_texture(spans, image, Fogged(Painted(table), fog), to, kernel);
            }
        }
        Some(())
    }

    fn show_blended(
        self,
        spans: &Spans<'_>,
        blend: &[u8; 65_536],
        to: &mut impl Destination,
        kernel: Kernel,
    ) -> Option<()> {
        // Shades are blended 14 % faster in stages.
        let Self::Texture { image, is_perspective, tint } = self else { return None };
        let image = (image, is_perspective);
        match tint {
            DirectTint::None => show_texture(spans, image, Blended((), blend), to, kernel),
            DirectTint::Row(row) => show_texture(spans, image, Blended(row, blend), to, kernel),
            DirectTint::Lit(table) => show_texture(spans, image, Blended(Painted(table), blend), to, kernel),
        }
        Some(())
    }
}

compiled_for_each_level! {
    /// Shows the shades of every span, tinted.
    #[inline(never)]
    fn show_shades[T: Tint, D: Destination][T, D](spans: &Spans<'_>, tint: T, to: &mut D) = show_shades_by;
}

#[inline(always)]
fn show_shades_by<S: Lanes8, T: Tint, D: Destination>(s: S, spans: &Spans<'_>, tint: T, to: &mut D) {
    // There is none; here the compiler sees that.
    if IS_SMALL {
        return;
    }
    for i in 0..spans.count() {
        let (at, length, skipped) = to.span(spans, i);
        let along = &mut tint.begin(s, spans.values::<T>(i, skipped));
        to.show(s, (spans, i), (at, length), (Texels::ONE, tint, along), StoredPlaces(s, &[]));
    }
}
