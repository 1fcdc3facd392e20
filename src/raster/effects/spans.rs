//! Spans as the stages see them: many at a time, their pixels concatenated in buffers.

use core::ops::Range;

use super::listing::{FaceCorners, ListedFaces, Mark, SpanData};
use crate::lanes::LANES;
use crate::raster::columns::Value;
use crate::raster::interpolation::Interpolation;
use crate::raster::reference::cover::Row;
use crate::raster::reference::level::LevelPlane;
use crate::raster::reference::texture::{AffineLevel, PerspectiveTexture};
use crate::raster::row_shader::{RowShader, to_bytes};
use crate::raster::shaded::{Kind, ShadedValues};
#[cfg(test)]
use crate::simd::Portable;
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::dither::{ThresholdRow, Thresholds, fill_dithered};
use crate::span::list::{self, SpanDepths, SpanList};
use crate::span::target::SpanDepth;
use crate::span::texture::{PerspectiveSums, SpanValues, Tint};
use crate::span::{Kernel, PIECE};

/// The maximum number of pixels that pass through the stages together, and room for writing them eight at a time.
pub(super) const PIXELS: usize = 4_096;
pub(super) const ROOM: usize = PIXELS + LANES;

/// Spans that pass through the stages together; their pixels are concatenated.
pub(super) struct Spans<'a> {
    listed: &'a ListedFaces<'a>,
    data: &'a SpanData,
    list: &'a SpanList,
    depths: SpanDepths<'a>,
    /// Index of the first in the list.
    first: usize,
    count: usize,
    /// Where the pixels of each begin, and at the end their total; zeros where no buffer holds them.
    pixels: &'a Offsets,
}

/// Memory for the offsets of the spans' pixels.
pub(super) type Offsets = [u32; SpanList::CAPACITY + 1];

static NO_OFFSETS: Offsets = [0; SpanList::CAPACITY + 1];

/// A span that passes through the stages.
#[derive(Clone, Copy)]
pub(super) struct Span {
    mark: Mark,
    /// The column and the row of its first pixel, which the clip rectangle may hide.
    pub(super) x: i32,
    pub(super) y: i32,
    /// The index of its first pixel among those of all spans.
    pub(super) first: usize,
    /// Number of its pixels, hidden ones included: 1 to 64.
    pub(super) len: usize,
    /// How many of its first pixels are hidden by the clip rectangle.
    skipped: u32,
}

/// How many of a span's first pixels are hidden by the clip rectangle: at most 63.
#[inline(always)]
fn skipped(span: list::Span) -> u32 {
    span.fill >> 8
}

impl Span {
    /// The span's pixels among those of all spans.
    #[inline(always)]
    pub(super) fn pixels(&self) -> Range<usize> {
        self.first..self.first + self.len
    }

    /// The column of its first pixel.
    #[inline(always)]
    pub(super) fn column(&self) -> usize {
        // Not negative: it lies inside the frame.
        self.x as usize
    }

    /// The thresholds of its row.
    #[inline(always)]
    pub(super) fn thresholds(&self, of: Thresholds) -> &'static ThresholdRow {
        // Not negative: it lies inside the frame.
        of.row(self.y as usize)
    }

    /// The row's last pixel inside the frame, whatever the clip rectangle, relative to the span's first.
    #[inline(always)]
    pub(super) fn last(&self) -> i32 {
        self.mark.last()
    }

    /// The span's row.
    pub(super) fn row(&self) -> Row {
        let origin = self.x - self.mark.before();
        // At most 64.
        let (x0, x1) = (self.x + self.skipped as i32, self.x + self.len as i32);
        Row { y: self.y, origin, x0, x1, last: self.x + self.last() }
    }
}

impl<'a> Spans<'a> {
    /// Takes as many spans from index `first` on as can pass through the stages together.
    #[inline]
    pub(super) fn of(listed: &'a ListedFaces<'_>, list: &'a SpanList, first: usize, offsets: &'a mut Offsets) -> Self {
        let (mut count, mut end) = (0, 0);
        offsets[0] = 0;
        for k in first..list.count() {
            // At most 64.
            end += list.span(k).length + skipped(list.span(k));
            if end as usize > PIXELS {
                break;
            }
            count += 1;
            // No more than the list has.
            offsets[count] = end;
        }
        Self { listed, data: &*listed.data, list, depths: list.depths(), first, count, pixels: offsets }
    }

    /// Takes all spans of a list, for a stage that needs no offsets into a buffer.
    #[inline]
    pub(super) fn all(listed: &'a ListedFaces<'_>, list: &'a SpanList) -> Self {
        let (depths, count) = (list.depths(), list.count());
        Self { listed, data: &*listed.data, list, depths, first: 0, count, pixels: &NO_OFFSETS }
    }

    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Number of pixels of all spans.
    #[inline(always)]
    pub(super) fn pixels(&self) -> usize {
        self.pixels[self.count] as usize
    }

    /// The index of the record of span `i`.
    #[inline(always)]
    fn record(&self, i: usize) -> usize {
        (self.list.span(self.first + i).fill & 0xFF) as usize
    }

    /// The mark of span `i`.
    #[inline(always)]
    fn mark(&self, i: usize) -> Mark {
        let record = self.record(i);
        Mark([0, 1].map(|i| self.data.numbers.of(record, i).cast_unsigned()))
    }

    /// The face of span `i`, among those whose planes are stored.
    #[inline(always)]
    pub(super) fn face(&self, i: usize) -> usize {
        self.mark(i).face()
    }

    /// Span `i` of these.
    #[inline(always)]
    pub(super) fn span(&self, i: usize) -> Span {
        let mark = self.mark(i);
        let (planes, lane) = self.data.planes(mark.face());
        let [column, row] = mark.position();
        let span = self.list.span(self.first + i);
        let (skipped, first) = (skipped(span), self.pixels[i] as usize);
        let (x, y, len) = (planes.column[lane] + column, planes.row[lane] + row, (span.length + skipped) as usize);
        Span { mark, x, y, first, len, skipped }
    }

    /// Where the pixels of span `i` begin among those of all, and how many it has.
    #[inline(always)]
    pub(super) fn range(&self, i: usize) -> (usize, usize) {
        let (first, end) = (self.pixels[i] as usize, self.pixels[i + 1] as usize);
        (first, end - first)
    }

    /// All spans.
    #[inline(always)]
    pub(super) fn iter(&self) -> impl Iterator<Item = Span> {
        (0..self.count).map(|i| self.span(i))
    }

    /// The index after the last span of the face that span `i` belongs to.
    #[inline(always)]
    pub(super) fn end_of_face(&self, i: usize) -> usize {
        let (of, mut end) = (self.face(i), i + 1);
        while end < self.count && self.face(end) == of {
            end += 1;
        }
        end
    }

    /// The shader of the face of span `i`.
    #[inline(never)]
    fn shader(&self, i: usize, Shaded { value, interpolation, .. }: Shaded) -> RowShader {
        let face = self.corners(&self.span(i));
        let values = match value {
            None => face.triangle.shades(),
            Some(value) => face.value(value),
        };
        RowShader::of_values(&face.triangle, values, interpolation)
    }

    /// Fills a span whose bytes estimates cannot decide.
    #[cold]
    #[inline(never)]
    fn fill_exactly(&self, i: usize, shaded: Shaded, out: &mut [u8]) {
        let (span, shader) = (self.span(i), self.shader(i, shaded));
        let thresholds = shaded.dither.map(|dither| span.thresholds(dither));
        shader.piece(&span.row(), span.x, &mut out[span.pixels()], thresholds, Kernel::PORTABLE);
    }

    /// Fills spans with a shader for each face: one that is walked, or that covers pixels of its own.
    #[inline(never)]
    fn fill_by_shader(&self, shaded: Shaded, out: &mut [u8], kernel: Kernel) {
        let mut i = 0;
        while i < self.count {
            let (end, shader) = (self.end_of_face(i), self.shader(i, shaded));
            for i in i..end {
                let span = self.span(i);
                let thresholds = shaded.dither.map(|dither| span.thresholds(dither));
                shader.piece(&span.row(), span.x, &mut out[span.pixels()], thresholds, kernel);
            }
            i = end;
        }
    }

    /// The face of a span, and its corners' values.
    #[inline(never)]
    pub(super) fn corners(&self, span: &Span) -> FaceCorners<'a> {
        self.listed.corners(span.mark.face())
    }

    /// The texture coordinates of the face of span `i`, linear on it, and their levels, by their definitions.
    pub(super) fn exact_texture(&self, i: usize) -> (PerspectiveTexture, Option<LevelPlane>) {
        self.listed.exact_texture(self.face(i))
    }

    /// The first shade of span `i`, with the step in the upper half.
    #[inline(always)]
    pub(super) fn first_shade(&self, i: usize) -> u32 {
        self.data.numbers.of(self.record(i), 2).cast_unsigned()
    }

    /// The linear values of span `i` that this tint reads.
    #[inline(always)]
    pub(super) fn values<T: Tint>(&self, i: usize, skipped: u32) -> SpanValues {
        let fog = if T::HAS_FOG { self.value(Value::Fog, i) } else { 0 };
        SpanValues { shade: self.first_shade(i), fog, skipped }
    }

    /// The start of a value of span `i`, with the step in the upper half.
    #[inline(always)]
    pub(super) fn value(&self, value: Value, i: usize) -> u32 {
        self.data.numbers.of(self.record(i), 3 + value.slot()).cast_unsigned()
    }

    /// u and v at the first pixel of span `i`, and their change per pixel, where the texture is linear on the screen.
    #[inline(always)]
    pub(super) fn affine_start(&self, i: usize) -> [[u32; 2]; 2] {
        let record = self.record(i);
        let of = |k: usize| self.data.coordinates.of(record, k).cast_unsigned();
        [[of(0), of(1)], [of(2), of(3)]]
    }

    /// The level of the face of span `i`, where the texture is linear on the screen.
    #[inline(always)]
    pub(super) fn affine_level(&self, i: usize) -> AffineLevel {
        let (planes, lane) = self.data.planes(self.face(i));
        planes.affine.level(lane)
    }

    /// The sums along span `i`, where the texture is linear on the face.
    #[inline(always)]
    pub(super) fn sums(&self, i: usize) -> PerspectiveSums<f64> {
        let (planes, lane) = self.data.planes(self.face(i));
        planes.perspective.sums(lane, self.data.sums(self.record(i)))
    }

    /// The level of the image in the face of span `i`, whose texture is linear on it, if it has only one.
    #[inline(always)]
    pub(super) fn single_level(&self, i: usize) -> Option<u32> {
        let (planes, lane) = self.data.planes(self.face(i));
        planes.perspective.single_level(lane)
    }

    /// The levels of the image at pixels `k` of span `i`, whose texture is linear on the face, or −1 where an estimate
    /// cannot decide.
    #[inline(always)]
    pub(super) fn levels<S: Lanes8>(&self, s: S, i: usize, k: S::I32, last: u32) -> S::I32 {
        let (planes, lane) = self.data.planes(self.face(i));
        planes.perspective.levels(s, lane, self.data.sums(self.record(i)), k, last)
    }

    /// The level at pixel `k` of span `i`, if an estimate decides it.
    #[cfg(test)]
    pub(super) fn level(&self, i: usize, k: i32, last: u32) -> Option<u32> {
        let [level, ..] = self.levels(Portable, i, [k; LANES], last);
        u32::try_from(level).ok()
    }

    /// The row's last pixel inside the frame, from the first one of span `i`.
    #[inline(always)]
    pub(super) fn last(&self, i: usize) -> i32 {
        self.mark(i).last()
    }

    /// [`sums`](Self::sums) in f32, if the quotients along span `i` may be taken in f32.
    #[inline(always)]
    pub(super) fn singles(&self, i: usize) -> Option<PerspectiveSums<f32>> {
        let (planes, lane) = self.data.planes(self.face(i));
        planes.perspective.singles(lane, || self.data.single_sums(self.record(i)))
    }

    /// Runs one stage: for every face, `plane` sets up its values from its corners, top to bottom;
    /// for every span, `fill` computes its part of `out` from them.
    #[inline(always)]
    pub(super) fn each<P, T>(
        &self,
        out: &mut [T],
        plane: impl Fn(&FaceCorners<'_>) -> P,
        mut fill: impl FnMut(&P, &Span, &mut [T]),
    ) {
        let mut i = 0;
        while i < self.count {
            let end = self.end_of_face(i);
            let plane = plane(&self.corners(&self.span(i)));
            while i < end {
                let span = self.span(i);
                fill(&plane, &span, &mut out[span.pixels()]);
                i += 1;
            }
        }
    }

    /// Runs a stage of shades, or of another value.
    pub(super) fn fill(&self, shaded: Shaded, out: &mut [u8], kernel: Kernel) {
        match shaded.interpolation {
            Interpolation::Flat(index) => out[..self.pixels()].fill(index),
            Interpolation::Gouraud88 | Interpolation::Gouraud88Reseeded => {
                fill_linear_at_best(kernel, kernel, self, shaded, out);
            }
            _ => match self.listed.shaded(shaded.value) {
                Some(values) => fill_shaded(kernel.simd_level(), self, values, shaded, out),
                None => self.fill_by_shader(shaded, out, kernel),
            },
        }
    }

    /// Where the drawn pixels of span `i` lie in the frame, how many there are, and how many of its first pixels are
    /// hidden by the clip rectangle.
    #[inline(always)]
    pub(super) fn in_frame(&self, i: usize) -> (usize, usize, u32) {
        let k = self.first + i;
        let span = self.list.span(k);
        (span.at as usize, span.length as usize, skipped(span))
    }

    /// Where the drawn pixels of span `i` are among those of all spans, and the span.
    #[inline(always)]
    pub(super) fn drawn(&self, i: usize) -> (usize, list::Span) {
        let span = self.list.span(self.first + i);
        ((self.pixels[i] + skipped(span)) as usize, span)
    }

    /// The depth of the first drawn pixel of span `i`.
    #[inline(always)]
    pub(super) fn depth(&self, i: usize) -> SpanDepth {
        self.depths.of(self.first + i)
    }
}

/// A shade or another corner value that is turned into bytes.
#[derive(Clone, Copy)]
pub(super) struct Shaded {
    /// `None` for the shade.
    pub(super) value: Option<Value>,
    pub(super) interpolation: Interpolation,
    pub(super) dither: Option<Thresholds>,
}

impl Shaded {
    /// A value that is reseeded with every span.
    pub(super) fn linear(value: Value) -> Self {
        Self { value: Some(value), interpolation: Interpolation::Gouraud88Reseeded, dither: None }
    }
}

compiled_for_each_level! {
    /// Fills spans with values that were set up for eight faces.
    #[inline(never)]
    fn fill_shaded[][](spans: &Spans<'_>, values: (Kind, &ShadedValues), shaded: Shaded, out: &mut [u8])
        = fill_shaded_at, up to AVX2;
}

#[inline(always)]
fn fill_shaded_at<S: Lanes8>(
    s: S,
    spans: &Spans<'_>,
    (kind, values): (Kind, &ShadedValues),
    shaded: Shaded,
    out: &mut [u8],
) {
    if let Some(dither) = shaded.dither {
        for i in 0..spans.count() {
            let span = spans.span(i);
            let mut shades = [0; PIECE];
            let shades = &mut shades[..span.len];
            match values.shades(kind, (spans.face(i), spans.record(i)), shades) {
                true => to_bytes(shades, span.thresholds(dither), span.column(), &mut out[span.pixels()]),
                false => spans.fill_exactly(i, shaded, out),
            }
        }
        return;
    }
    // The kind is a constant of each loop.
    match kind {
        Kind::Fixed16 => fill_blocks_of(s, spans, (Kind::Fixed16, values), shaded, out),
        Kind::Hyperbolic => fill_blocks_of(s, spans, (Kind::Hyperbolic, values), shaded, out),
        Kind::Float => fill_blocks_of(s, spans, (Kind::Float, values), shaded, out),
    }
}
#[inline(always)]
fn fill_blocks_of<S: Lanes8>(
    s: S,
    spans: &Spans<'_>,
    (kind, values): (Kind, &ShadedValues),
    shaded: Shaded,
    out: &mut [u8],
) {
    for i in 0..spans.count() {
        let (first, len) = spans.range(i);
        if !values.fill_blocks(s, kind, (spans.face(i), spans.record(i)), (&mut out[first..], len)) {
            spans.fill_exactly(i, shaded, out);
        }
    }
}

compiled_for_each_level! {
    #[inline(never)]
    fn fill_linear_at_best[][](level: Kernel, kernel: Kernel, spans: &Spans<'_>, shaded: Shaded, out: &mut [u8]) {
        fill_linear(kernel, spans, shaded, out)
    }
}

#[inline(always)]
fn fill_linear(kernel: Kernel, spans: &Spans<'_>, Shaded { value, dither, .. }: Shaded, out: &mut [u8]) {
    match (value, dither) {
        (None, None) => fill_plain(kernel, spans, |i| spans.first_shade(i), out),
        (Some(value), None) => fill_plain(kernel, spans, |i| spans.value(value, i), out),
        (_, Some(thresholds)) => {
            for i in 0..spans.count() {
                let shade = value.map_or_else(|| spans.first_shade(i), |value| spans.value(value, i));
                // The start in the lower half, the step in the upper.
                let (start, step) = (shade as u16, (shade >> 16) as u16);
                let span = spans.span(i);
                let row = span.thresholds(thresholds);
                fill_dithered(&mut out[span.pixels()], start.wrapping_sub(128), step, row, span.column());
            }
        }
    }
}

#[inline(always)]
fn fill_plain(kernel: Kernel, spans: &Spans<'_>, shade: impl Fn(usize) -> u32, out: &mut [u8]) {
    for i in 0..spans.count() {
        let shade = shade(i);
        // The start in the lower half, the step in the upper.
        let (start, step) = (shade as u16, (shade >> 16) as u16);
        let (first, len) = spans.range(i);
        if len > LONG {
            kernel.fill(&mut out[first..first + len], start, step);
        } else {
            fill_blocks(&mut out[first..], len, start, step);
        }
    }
}

/// Spans longer than this are filled by the kernel.
const LONG: usize = 20;

/// Fills the first `n` bytes with linear shades, and up to seven more, for which there is room.
#[inline(always)]
fn fill_blocks(bytes: &mut [u8], n: usize, start: u16, step: u16) {
    let mut shade = start;
    let blocks = n.div_ceil(LANES);
    let Some(bytes) = bytes.get_mut(..blocks * LANES) else { return };
    for block in bytes.as_chunks_mut::<LANES>().0 {
        for (byte, k) in block.iter_mut().zip(0_u16..) {
            *byte = (shade.wrapping_add(step.wrapping_mul(k)) >> 8) as u8;
        }
        shade = shade.wrapping_add(step.wrapping_mul(LANES as u16));
    }
}
