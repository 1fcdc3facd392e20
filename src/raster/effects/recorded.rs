//! Records each span with the starts of its values, for tests.

use alloc::vec::Vec;

use super::listing::{EffectSpans, SpanData};
use super::spans::{Span, Spans};
use super::texture::exact_level;
use super::{Buffers, PixelPipeline};
use crate::mapping::Mapping;
use crate::raster::batches::draw_triangles;
use crate::raster::columns::PickedTriangles;
use crate::raster::frame::Rect;
use crate::raster::reference::texture::AffineLevel;
use crate::raster::rows::{Batches, Lane, Parts, RowEnds, Shades8};
use crate::raster::setup::{Corners8, FrameLayout, TriangleSetup8};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::depth::Cells;
use crate::span::list::SpanList;
use crate::span::target::Target;
use crate::span::texture::PerspectiveSums;

/// A span and the starts of its values.
pub(super) struct Recorded {
    /// The index of its pick.
    pub(super) pick: usize,
    pub(super) span: Span,
    /// The start and the step of each texture coordinate.
    pub(super) affine: [[u32; 2]; 2],
    pub(super) perspective: PerspectiveSums<f64>,
    /// The sums in f32, if quotients may be taken in f32.
    pub(super) singles: Option<PerspectiveSums<f32>>,
    pub(super) depth: [i64; 2],
    /// The levels of some pixels, if the image has any: those found for eight triangles, and those by definition.
    pub(super) levels: Vec<(Option<AffineLevel>, AffineLevel)>,
    /// The level of all of the face's pixels, if it is linear on the face and has only one.
    pub(super) single_level: Option<u32>,
}

/// The levels of span `i`, the last being `last`.
fn levels(spans: &Spans<'_>, i: usize, mapping: Option<Mapping>, last: u32) -> Vec<(Option<AffineLevel>, AffineLevel)> {
    if mapping == Some(Mapping::Affine) {
        return Vec::from([(Some(spans.affine_level(i)), spans.corners(&spans.span(i)).affine_texture(Some(last)).1)]);
    }
    let of = |level: u32| AffineLevel { level, ..AffineLevel::default() };
    let at = |k: i32| (spans.level(i, k, last).map(of), of(exact_level(spans, i, k, last)));
    (0..=spans.last(i).min(63)).step_by(5).map(at).collect()
}

struct Recorder<'a> {
    spans: EffectSpans<'a>,
    recorded: Vec<Recorded>,
}

impl Shades8 for Recorder<'_> {
    const IS_LINEAR: bool = false;

    fn batches(&mut self) -> Option<&mut Batches> {
        self.spans.batches()
    }

    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, corners: &Corners8, setup: &mut TriangleSetup8, of: (FrameLayout, bool)) {
        self.spans.set_up(s, corners, setup, of);
    }

    #[inline(always)]
    fn fill_of<S: Lanes8>(
        &mut self,
        s: S,
        lane: impl Lane<S>,
        setup: &TriangleSetup8,
        ends: &RowEnds<S>,
        parts: &Parts<S>,
    ) -> S::I32 {
        self.spans.fill_of(s, lane, setup, ends, parts)
    }

    fn draw<const DEPTHS: bool>(&mut self, list: &mut SpanList, _: &mut Target<'_>) {
        let (listed, mut first, mut offsets) = (&self.spans.listed, 0, [0; SpanList::CAPACITY + 1]);
        while first < list.count() {
            let spans = Spans::of(listed, list, first, &mut offsets);
            for i in 0..spans.count() {
                self.recorded.push(Recorded {
                    pick: listed.batches.first + spans.face(i),
                    span: spans.span(i),
                    affine: spans.affine_start(i),
                    perspective: spans.sums(i),
                    singles: spans.singles(i),
                    depth: [spans.depth(i).z, spans.depth(i).dz].map(|z| z >> 8),
                    levels: listed.levels().map_or_else(Vec::new, |(mapping, last)| levels(&spans, i, mapping, last)),
                    single_level: match listed.levels() {
                        None | Some((Some(Mapping::Affine), _)) => None,
                        Some(_) => spans.single_level(i),
                    },
                });
            }
            first += spans.count();
        }
        self.spans.clear(list, 0);
    }
}

compiled_for_each_level! {
    fn record_at_level[][](of: PickedTriangles<'_>, recorder: &mut Recorder<'_>, clip: Rect) -> u32 = record_by;
}

#[inline(always)]
fn record_by<S: Lanes8>(s: S, of: PickedTriangles<'_>, recorder: &mut Recorder<'_>, clip: Rect) -> u32 {
    // All rows share the same pixels.
    let layout = FrameLayout { first_row: 0, pitch: 0, width: 0, depth_base: 0 };
    let (mut pixels, mut cells) = ([0; 4_096], [0_u32; 4_096]);
    let target = &mut Target { pixels: &mut pixels, cells: Some(Cells::U32(&mut cells)), kernel: Kernel::PORTABLE };
    draw_triangles::<S, _, true>(s, of, (layout, clip), target, recorder, &mut { SpanList::NONE }).spans
}

/// The spans of faces, none of them unbatched, in a frame of 4,096 × 4,096 pixels.
pub(super) fn record(kernel: Kernel, triangles: PickedTriangles<'_>, pipeline: &PixelPipeline<'_>) -> Vec<Recorded> {
    let (mut data, mut buffers) = (SpanData::new(), Buffers::default());
    let spans = EffectSpans::new(triangles, pipeline, &mut data, &mut buffers);
    let mut recorder = Recorder { spans, recorded: Vec::new() };
    let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
    record_at_level(kernel.simd_level(), triangles, &mut recorder, clip);
    recorder.recorded
}
