//! Shadings of eight triangles other than a linear shade in 8.8: set-up, starts of rows, and the bytes of spans. Faces
//! with effects are shaded here, too, by a [`ShadedValues`] for the shade or for each channel.
//!
//! | shading | a row starts with | its bytes |
//! |---|---|---|
//! | 16.16 | the shade of [`fixed16`](super::reference::fixed16) | sums of 32 bits |
//! | perspective-correct | numerator and divisor of [`hyperbolic`](super::reference::hyperbolic) in f64 | quotients, exact where they cannot decide |
//! | in f32 | numerator and divisor of [`float`](super::reference::float) | quotients |
//!
//! # 16.16 in two quotients
//!
//! With N the numerator of a shade in 1/256, half a shade included, A twice the area, and h = A/2 − ½ with the sign of
//! the shade's change, the start is N · 256 / A, rounded down, or up where shades fall. The set-up of linear shades has
//! M = N − h, and
//!
//! ```text
//! q = nearest(M / A)        r = M − q·A        256·q + nearest((256·r + 255·h) / A)
//! ```
//!
//! since 256·N − h = 256·(M + h) − h. M is a multiple of ½ below 2⁵², and so is q·A, so r is exact; it is at most
//! 0.51·A, and 256·r + 255·h is below 2⁴³ and exact too. The last quotient is below 2⁹, so it is off by 2⁻⁴³, and the
//! argument of the rounding is at least 1/(2A) ≥ 2⁻³⁶ from the middle between two integers. A step is found in the same
//! way, toward zero.
//!
//! # Perspective-correct shades
//!
//! Numerator and divisor are linear on the screen, so each has a plane in f64. Quotients are below 2²⁴. By
//! [`Basis::conditions`] they are off by less than a quarter of a unit where X is at most 2¹⁹; other triangles get a
//! numerator of 0, whose estimates decide nothing.
//!
//! Bytes in f32 depend on the order in which three products are added: corners by height, and at equal heights the left
//! one first. The order of the first two does not change their sum. No product is fused with a sum. The changes per
//! pixel are exact sums: for a small triangle, whose differences of y are at most 2¹², in 64 bits, as products of
//! depths and shades are below 2⁴⁸. Larger ones are set up by [`FloatPlane`].

use super::columns::PickedTriangles;
use super::interpolation::Interpolation;
use super::reference::cover::SortedTriangle;
#[cfg(feature = "alloc")]
use super::reference::float::FloatPlane;
use super::reference::hyperbolic::HyperbolicPlane;
use super::rows::{Batches, Lane, Parts, RowEnds, Shades8, numerator_at};
use super::setup::{Basis, Corners8, Floats, FrameLayout, Ints, TriangleSetup8, ValuePlanes8, ends};
use crate::fixed::{HAS_F64, IS_SMALL, ROUND_MAGIC};
use crate::lanes::{LANES, NUMBERS, three};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::PIECE;
use crate::span::fixed16::fill_16_16_blocks;
#[cfg(feature = "alloc")]
use crate::span::fixed16::shades_16_16;
#[cfg(feature = "alloc")]
use crate::span::float::{fill_float_blocks, float_shades};
#[cfg(feature = "alloc")]
use crate::span::hyperbolic::estimated_shades;
use crate::span::hyperbolic::fill_estimated_blocks;
use crate::span::list::{Span, SpanList};
use crate::span::records::{RecordColumns, Records, SpanBytes};
use crate::span::target::{Target, Written};

/// Shadings that are set up and filled here.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Fixed16,
    Hyperbolic,
    #[cfg(feature = "alloc")]
    Float,
}

impl Kind {
    pub(super) fn of(interpolation: Interpolation) -> Option<Self> {
        match interpolation {
            Interpolation::Gouraud1616 => Some(Self::Fixed16),
            Interpolation::GouraudHyperbolic => Some(Self::Hyperbolic),
            #[cfg(feature = "alloc")]
            Interpolation::GouraudFloat if !IS_SMALL => Some(Self::Float),
            _ => None,
        }
    }
}

/// Changes along the rows of eight triangles, and their shades' range.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Steps8 {
    /// Perspective-correct: changes of the numerator and of the divisor per pixel.
    sums: [Floats; 2],
    /// In 16.16, the steps. In f32, the bits of the same changes, and of the least and the greatest shade.
    words: [Ints; 4],
}

/// One value of the corners of triangles: its planes over the eight that are being set up, and what the spans of those
/// in all batches are filled with.
#[derive(Clone, Debug)]
pub(super) struct ShadedValues {
    /// True if values are truncated, not rounded to bytes.
    pub(super) is_truncated: bool,
    planes: Planes8,
    steps: [Steps8; Batches::COUNT],
    /// 16.16: shade and step. In f32, the index of the first pixel, relative to the pixel where the sums are. The second
    /// number is free for the other two shadings: a plain span has its triangle there.
    numbers: RecordColumns<i32, 2>,
    /// Numerator and divisor.
    sums: RecordColumns<i64, 2>,
}

/// Planes of a value over eight triangles.
#[derive(Clone, Debug)]
struct Planes8 {
    /// 16.16: 255·h, and A.
    fraction: Floats,
    area: Floats,
    /// Perspective-correct: numerator and divisor, each at the box's first pixel and its change per row.
    sums: [[Floats; 2]; 2],
    /// In f32: the weight of each corner, by height: its value at the box's first pixel, and its changes per row and
    /// column.
    weights: [[Floats; 3]; 3],
    /// Each corner's depth times its value, and its depth.
    values: [[Floats; 2]; 3],
}

impl Default for ShadedValues {
    fn default() -> Self {
        let floats = [0.0; LANES];
        let (sums, weights, values) = ([[floats; 2]; 2], [[floats; 3]; 3], [[floats; 2]; 3]);
        let steps = Steps8 { sums: [floats; 2], words: [[0; LANES]; 4] };
        Self {
            is_truncated: false,
            planes: Planes8 { fraction: floats, area: floats, sums, weights, values },
            steps: [steps; Batches::COUNT],
            numbers: RecordColumns::new(),
            sums: RecordColumns::new(),
        }
    }
}

/// Memory for listed spans: the shades of their triangles, and their bytes. Within an error budget a torus is drawn in
/// some seventy runs; clearing this for each would take 0.9 % of a frame's instructions.
#[derive(Debug)]
pub(crate) struct ShadedData {
    shades: ShadedValues,
    bytes: SpanBytes,
}

impl Default for ShadedData {
    fn default() -> Self {
        Self { shades: ShadedValues::default(), bytes: SpanBytes::NONE }
    }
}

/// Triangles whose spans may be listed.
struct ShadedFaces<'a> {
    of: PickedTriangles<'a>,
    layout: FrameLayout,
    batches: Batches,
}

impl ShadedFaces<'_> {
    fn triangle(&self, face: usize) -> SortedTriangle {
        SortedTriangle::new(&self.of.vertices(self.batches.first + face))
    }

    /// Computes the perspective-correct bytes of a span, which estimates cannot decide, in exact arithmetic.
    #[cold]
    #[inline(never)]
    fn exact_bytes(&self, span: Span, face: usize, bytes: &mut Bytes) {
        let triangle = self.triangle(face);
        let plane = HyperbolicPlane::of_values(&triangle, triangle.shades());
        let FrameLayout { first_row, pitch, .. } = self.layout;
        // In a frame: below 4,096.
        let (x, y) = ((span.at % pitch) as i32, (first_row + span.at / pitch) as i32);
        plane.fill(x, y, &mut bytes[..(span.length as usize).min(PIECE)]);
    }
}

/// Triangles, and the shades of those whose spans are listed.
pub(super) struct Shaded8<'a> {
    kind: Kind,
    listed: ShadedFaces<'a>,
    data: &'a mut ShadedData,
}

impl<'a> Shaded8<'a> {
    #[inline(always)]
    pub(super) fn new(kind: Kind, of: PickedTriangles<'a>, layout: FrameLayout, data: &'a mut ShadedData) -> Self {
        Self { kind, listed: ShadedFaces { of, layout, batches: Batches::NONE }, data }
    }

    /// Fills the spans of a list, and writes them.
    #[inline(always)]
    fn draw_by<S: Lanes8>(&mut self, s: S, kind: Kind, list: &mut SpanList, target: &mut Target<'_>) {
        let (count, mut first, mut nearer) = (list.count(), 0, 0);
        let ShadedData { shades, bytes: all_bytes } = &mut *self.data;
        let depths = list.depths();
        while first < count {
            let end = count.min(first + SpanBytes::COUNT);
            for k in first..end {
                let span = list.span(k);
                let record = span.fill as usize;
                let face = shades.numbers.of(record, 1).cast_unsigned() as usize;
                let bytes = all_bytes.of_mut(k - first);
                // The span's bytes, followed by arbitrary ones to fill blocks of eight.
                if !shades.fill_blocks(s, kind, (face, record), (&mut bytes[..], span.length as usize)) {
                    self.listed.exact_bytes(span, face, bytes);
                }
            }
            let of = (
                #[inline(always)]
                |k| {
                    let Span { at, length, .. } = list.span(k);
                    Written { at, bytes: all_bytes.of(k - first), length: length as usize }
                },
                #[inline(always)]
                |k| depths.of(k),
            );
            nearer += target.write_each(s, first..end, of, true);
            first = end;
        }
        list.clear(nearer);
    }
}

impl ShadedValues {
    /// Sets up eight triangles of this batch, given the values of their corners and, for 16.16, their linear planes.
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(
        &mut self,
        s: S,
        (kind, batch): (Kind, usize),
        basis: &Basis<S>,
        (corners, values): (&Corners8, &[Ints; 3]),
        linear: &ValuePlanes8,
    ) {
        match kind {
            Kind::Fixed16 => self.set_up_16_16(s, batch, basis, linear),
            Kind::Hyperbolic => self.set_up_hyperbolic(s, batch, basis, (corners, values)),
            #[cfg(feature = "alloc")]
            Kind::Float => self.set_up_float(s, batch, basis, (corners, values)),
        }
    }

    #[inline(always)]
    fn set_up_16_16<S: Lanes8>(&mut self, s: S, batch: usize, basis: &Basis<S>, linear: &ValuePlanes8) {
        let magic = s.splat_f64(ROUND_MAGIC);
        let per_column = s.load_f64(&linear.per_column);
        let half = s.xor_sign(s.mul_add(basis.area, s.splat_f64(0.5), s.splat_f64(-0.5)), per_column);
        let fraction = s.mul(half, s.splat_f64(255.0));
        s.store_f64(fraction, &mut self.planes.fraction);
        s.store_f64(basis.area, &mut self.planes.area);
        let step = sum_16_16(s, s.sub(per_column, half), (basis.area, basis.inverse), fraction, magic);
        s.store_i32(step, &mut self.steps[batch].words[0]);
    }

    #[inline(always)]
    fn set_up_hyperbolic<S: Lanes8>(
        &mut self,
        s: S,
        batch: usize,
        basis: &Basis<S>,
        (corners, values): (&Corners8, &[Ints; 3]),
    ) {
        let [a, b, c] = basis.order.load(s, values);
        let depths = basis.depths(s, corners);
        // 2¹⁶ times a byte with its half, if it is rounded, and a bit more if it is the same everywhere: see
        // `HyperbolicPlane::estimates`.
        let is_flat = s.and(s.is_equal(a, b), s.is_equal(b, c));
        let half = if self.is_truncated { 0.0 } else { 128.0 };
        let half = s.select(is_flat, s.splat_f64(half + 0.5), s.splat_f64(half));
        let numerators = three(
            [(a, depths[0]), (b, depths[1]), (c, depths[2])],
            #[inline(always)]
            |(shade, depth)| s.mul(s.mul(s.add(s.to_f64(shade), half), s.splat_f64(256.0)), depth),
        );
        let [spread, least] = basis.conditions(s, ends(s, depths));
        let is_sure = s.is_less(spread, s.mul(least, s.splat_f64(524_288.0)));
        let (zero, one) = (s.splat_f64(0.0), s.splat_f64(1.0));
        let steps = &mut self.steps[batch];
        for (i, (sums, unsure)) in [(numerators, zero), (depths, one)].into_iter().enumerate() {
            let [at_first, per_row, per_column] = basis.plane(s, sums);
            s.store_f64(s.select(is_sure, at_first, unsure), &mut self.planes.sums[i][0]);
            s.store_f64(s.select(is_sure, per_row, zero), &mut self.planes.sums[i][1]);
            s.store_f64(s.select(is_sure, per_column, zero), &mut steps.sums[i]);
        }
    }

    #[inline(always)]
    fn set_up_float<S: Lanes8>(
        &mut self,
        s: S,
        batch: usize,
        basis: &Basis<S>,
        (corners, values): (&Corners8, &[Ints; 3]),
    ) {
        let shades = basis.order.load(s, values);
        let depths = basis.depths(s, corners);
        let [(change_a, weights_a), (change_b, weights_b), (change_c, weights_c)] = three(
            [0, 1, 2],
            #[inline(always)]
            |corner| basis.weight(s, corner),
        );
        let (changes, mut weights) = ([change_a, change_b, change_c], [weights_a, weights_b, weights_c]);
        let mut values = three(
            [0, 1, 2],
            #[inline(always)]
            |corner: usize| [s.mul(s.to_f64(shades[corner]), depths[corner]), depths[corner]],
        );
        let [first, second, third] = values;
        // If the last two corners are at the same height, the left one comes first.
        let is_last_second =
            s.and_not(s.is_less(basis.third[0], basis.second[0]), s.is_less(basis.second[1], basis.third[1]));
        swap_where(s, is_last_second, &mut weights);
        swap_where(s, is_last_second, &mut values);
        // Stored once: the compiler would store a swap in memory with `vmaskmovpd`, which takes 20 cycles on AMD
        // processors.
        for corner in 0..3 {
            for (i, to) in self.planes.weights[corner].iter_mut().enumerate() {
                s.store_f64(weights[corner][i], to);
            }
            for (i, to) in self.planes.values[corner].iter_mut().enumerate() {
                s.store_f64(values[corner][i], to);
            }
        }
        let steps = &mut self.steps[batch];
        let [dn, dd, least, greatest] = &mut steps.words;
        for (i, (unit, steps)) in [(1.0, dn), (256.0, dd)].into_iter().enumerate() {
            // Whole numbers below 2⁴⁸ and 2¹², exact in sums with the magic number.
            let mut exact = [0; LANES];
            s.store_i64(
                s.add_i64(
                    s.add_i64(product(s, changes[0], first[i]), product(s, changes[1], second[i])),
                    product(s, changes[2], third[i]),
                ),
                &mut exact,
            );
            // 2⁸ for a pixel's width, and for shades 2⁻⁸ for their unit: no rounding but the first.
            for (step, exact) in steps.iter_mut().zip(exact) {
                *step = (exact as f32 * unit).to_bits().cast_signed();
            }
        }
        let [a, b, c] = shades;
        for (shades, to) in [(s.min_i32(s.min_i32(a, b), c), least), (s.max_i32(s.max_i32(a, b), c), greatest)] {
            let mut units = [0; LANES];
            s.store_i32(shades, &mut units);
            for (single, units) in to.iter_mut().zip(units) {
                *single = (units as f32 / 256.0).to_bits().cast_signed();
            }
        }
    }

    /// The exact steps in f32 of a triangle too large for 64-bit sums, given its values by height.
    #[cfg(feature = "alloc")]
    pub(super) fn set_up_large(&mut self, face: usize, triangle: &SortedTriangle, values: [i64; 3]) {
        let (batch, lane) = Batches::of_face(face);
        let steps = FloatPlane::of_values(triangle, values).steps;
        for (to, step) in self.steps[batch].words.iter_mut().zip(steps) {
            to[lane] = step.to_bits().cast_signed();
        }
    }

    /// Stores what the spans of rows are filled with in eight records from this one on. The spans begin at columns `at`,
    /// not before the row's first pixel.
    #[inline(always)]
    pub(super) fn begin_spans<S: Lanes8>(
        &mut self,
        s: S,
        lane: impl Lane<S>,
        (kind, batch, record): (Kind, usize, usize),
        linear: (&ValuePlanes8, &Floats),
        (j, parts, at): (S::F64, &Parts<S>, S::F64),
    ) {
        let magic = s.splat_f64(ROUND_MAGIC);
        let Self { planes, steps, numbers, sums, .. } = self;
        let steps = &steps[batch];
        if kind == Kind::Fixed16 {
            let (linear, inverse) = linear;
            let n = numerator_at(s, lane, linear, j, parts.row);
            let quotient = (lane.load_f64(s, &planes.area), lane.load_f64(s, inverse));
            let start = sum_16_16(s, n, quotient, lane.load_f64(s, &planes.fraction), magic);
            let skipped = s.sub_i32(s.low_bits(at), s.low_bits(parts.row));
            let step = lane.load_i32(s, &steps.words[0]);
            s.store_i32(s.add_i32(start, s.mul_i32(step, skipped)), numbers.eight(record, 0));
            s.store_i32(step, numbers.eight(record, 1));
            return;
        }
        if kind == Kind::Hyperbolic {
            let columns = s.sub(at, magic);
            for (i, [at_first, per_row]) in planes.sums.iter().enumerate() {
                let at_row = s.mul_add(lane.load_f64(s, per_row), j, lane.load_f64(s, at_first));
                let sum = s.mul_add(lane.load_f64(s, &steps.sums[i]), columns, at_row);
                s.store_i64(s.bits(sum), sums.eight(record, i));
            }
            return;
        }
        // A step of zero is not −0.
        let falls = s.is_greater(s.splat_i32(0), lane.load_i32(s, &steps.words[1]));
        let exact = s.select(falls, s.sub(parts.end, s.splat_f64(1.0)), parts.row);
        s.store_i32(s.sub_i32(s.low_bits(at), s.low_bits(exact)), numbers.eight(record, 0));
        let columns = s.sub(exact, magic);
        let mut totals = [s.splat_f64(0.0); 2];
        for (weights, values) in planes.weights.iter().zip(&planes.values) {
            // Whole numbers: exact.
            let weight = s.mul_add(lane.load_f64(s, &weights[1]), j, lane.load_f64(s, &weights[0]));
            let weight = s.mul_add(lane.load_f64(s, &weights[2]), columns, weight);
            for (i, total) in totals.iter_mut().enumerate() {
                // Rounded twice at every level.
                *total = s.add(*total, s.mul(weight, lane.load_f64(s, &values[i])));
            }
        }
        for (i, total) in totals.into_iter().enumerate() {
            s.store_i64(s.bits(total), sums.eight(record, i));
        }
    }

    /// Fills the span of a face and a record, in whole blocks of eight: bytes after its length are arbitrary. Returns
    /// false where an estimate cannot decide a byte.
    #[inline(always)]
    pub(super) fn fill_blocks<S: Lanes8>(
        &self,
        s: S,
        kind: Kind,
        (face, record): (usize, usize),
        row: (&mut [u8], usize),
    ) -> bool {
        match kind {
            Kind::Fixed16 => {
                let [start, step] = self.start_16_16(record);
                fill_16_16_blocks(s, row, start.cast_signed(), step.cast_signed());
                true
            }
            Kind::Hyperbolic => {
                let [n, d] = self.estimates(face, record);
                fill_estimated_blocks(s, row, n, d)
            }
            #[cfg(feature = "alloc")]
            Kind::Float => {
                let (first, [n, d, range]) = self.singles(face, record);
                fill_float_blocks(row, first, n, d, range);
                true
            }
        }
    }

    /// Fills `shades` with the span of a face and a record, truncated in 8.8. Returns false where an estimate cannot
    /// decide a shade.
    #[cfg(feature = "alloc")]
    pub(super) fn shades(&self, kind: Kind, (face, record): (usize, usize), shades: &mut [u16]) -> bool {
        match kind {
            Kind::Fixed16 => {
                let [start, step] = self.start_16_16(record);
                shades_16_16(shades, start, step);
                true
            }
            Kind::Hyperbolic => {
                let [n, d] = self.estimates(face, record);
                estimated_shades(shades, n, d)
            }
            Kind::Float => {
                let (first, [n, d, range]) = self.singles(face, record);
                float_shades(shades, first, n, d, range);
                true
            }
        }
    }

    /// Shade and step of a span.
    #[inline(always)]
    fn start_16_16(&self, record: usize) -> [u32; 2] {
        [0, 1].map(|i| self.numbers.of(record, i).cast_unsigned())
    }

    /// Numerator and divisor of a span, each with its change per pixel.
    #[inline(always)]
    fn estimates(&self, face: usize, record: usize) -> [[f64; 2]; 2] {
        let (batch, lane) = Batches::of_face(face);
        let steps = &self.steps[batch].sums;
        [0, 1].map(|i| [f64::from_bits(self.sums.of(record, i).cast_unsigned()), steps[i][lane]])
    }

    /// The index of a span's first pixel; numerator and divisor, each with its change per pixel, and the range of shades.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    fn singles(&self, face: usize, record: usize) -> (i32, [[f32; 2]; 3]) {
        let (batch, lane) = Batches::of_face(face);
        let [n, d] = [0, 1].map(|i| f64::from_bits(self.sums.of(record, i).cast_unsigned()));
        let [dn, dd, least, greatest] =
            self.steps[batch].words.each_ref().map(|of| f32::from_bits(of[lane].cast_unsigned()));
        // Rounded once: dividing by 256 changes no bit.
        (self.numbers.of(record, 0), [[(n / 256.0) as f32, dn], [d as f32, dd], [least, greatest]])
    }
}

/// `256·q + nearest((256·r + 255·h) / A)`, modulo 2³²: see the module's documentation.
#[inline(always)]
fn sum_16_16<S: Lanes8>(s: S, n: S::F64, (area, inverse): (S::F64, S::F64), fraction: S::F64, magic: S::F64) -> S::I32 {
    let whole = s.mul_add(n, inverse, magic);
    let rest = s.neg_mul_add(s.sub(whole, magic), area, n);
    let part = s.mul_add(s.mul_add(rest, s.splat_f64(256.0), fraction), inverse, magic);
    s.add_i32(s.shl_i32(s.low_bits(whole), 8), s.low_bits(part))
}

/// Swaps the values of the second and the third corner in the lanes that are set.
#[inline(always)]
fn swap_where<S: Lanes8, const N: usize>(s: S, lanes: S::Mask, [_, second, third]: &mut [[S::F64; N]; 3]) {
    for i in 0..N {
        let [a, b] = [second[i], third[i]];
        second[i] = s.select(lanes, b, a);
        third[i] = s.select(lanes, a, b);
    }
}

/// The product of whole numbers.
#[inline(always)]
fn product<S: Lanes8>(s: S, a: S::F64, b: S::F64) -> S::I64 {
    let magic = s.splat_f64(ROUND_MAGIC);
    let whole = |value: S::F64| s.sub_i64(s.bits(s.add(value, magic)), s.bits(magic));
    s.mul_i64(whole(a), whole(b))
}

impl Shades8 for Shaded8<'_> {
    const IS_LINEAR: bool = false;

    #[inline(always)]
    fn batches(&mut self) -> Option<&mut Batches> {
        Some(&mut self.listed.batches)
    }

    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, corners: &Corners8, setup: &mut TriangleSetup8, of: (FrameLayout, bool)) {
        s.apart(
            #[inline(always)]
            move || {
                let basis = &setup.set_up(s, corners, of, self.kind == Kind::Fixed16);
                let of_batch = (self.kind, self.listed.batches.current());
                self.data.shades.set_up(s, of_batch, basis, (corners, &corners.shade), &setup.shade);
            },
        );
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
        let Self { kind, listed: ShadedFaces { batches, .. }, data } = self;
        let (kind, record) = (*kind, batches.records.begin());
        let linear = (&setup.shade, &setup.inverse);
        data.shades.begin_spans(s, lane, (kind, batches.current(), record), linear, (ends.j, parts, parts.start));
        if kind != Kind::Fixed16 {
            s.store_i32(batches.faces(s, lane), data.shades.numbers.eight(record, 1));
        }
        // At most 255.
        s.add_i32(s.splat_i32(record as i32), s.load_i32(&NUMBERS))
    }

    #[inline(never)]
    fn set_up_large(&mut self, i: usize) {
        #[cfg(feature = "alloc")]
        if self.kind == Kind::Float {
            let face = self.listed.batches.current() * LANES + i;
            let triangle = self.listed.triangle(face);
            self.data.shades.set_up_large(face, &triangle, triangle.shades());
        }
        let _ = i;
    }

    #[inline(always)]
    fn draw<const DEPTHS: bool>(&mut self, list: &mut SpanList, target: &mut Target<'_>) {
        draw_listed(target.kernel.simd_level(), self, list, target);
    }
}

compiled_for_each_level! {
    /// [`Shades8::draw`], compiled once for all its calls.
    #[inline(never)]
    fn draw_listed[][](shades: &mut Shaded8<'_>, list: &mut SpanList, target: &mut Target<'_>) = draw_listed_by;
}

#[inline(always)]
fn draw_listed_by<S: Lanes8>(s: S, shades: &mut Shaded8<'_>, list: &mut SpanList, target: &mut Target<'_>) {
    // As in `draw_triangles`.
    if !HAS_F64 {
        return;
    }
    shades.listed.batches.records = Records::NONE;
    match shades.kind {
        Kind::Fixed16 => {
            let numbers = &shades.data.shades.numbers;
            let number = |record: u32, i: usize| numbers.of(record as usize, i).cast_unsigned();
            let of_span = |record: u32| (number(record, 0), number(record, 1));
            let nearer = target.kernel.fill_spans_16_16(target.pixels, &mut target.cells, list, of_span);
            list.clear(nearer);
        }
        // The kind is a constant of each loop.
        Kind::Hyperbolic => shades.draw_by(s, Kind::Hyperbolic, list, target),
        #[cfg(feature = "alloc")]
        Kind::Float => shades.draw_by(s, Kind::Float, list, target),
    }
}

type Bytes = [u8; PIECE];
