//! Shadings of eight triangles other than a linear shade in 8.8: set-up, starts of rows, and the bytes of spans.
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
use super::setup::{Basis, Corners8, Floats, FrameLayout, Ints, TriangleSetup8, ends};
use crate::fixed::{HAS_F64, ROUND_MAGIC};
use crate::lanes::{LANES, NUMBERS, three};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::PIECE;
#[cfg(feature = "alloc")]
use crate::span::float::fill_float_blocks;
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
            Interpolation::GouraudFloat => Some(Self::Float),
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

/// Memory for listed spans: the steps of their triangles, their records and their bytes. Within an error budget a torus
/// is drawn in some seventy runs; clearing this for each would take 0.9 % of a frame's instructions.
#[derive(Debug)]
pub(crate) struct ShadedData {
    steps: [Steps8; Batches::COUNT],
    /// 16.16: shade and step. Otherwise the triangle, among those whose steps are stored; in f32 with the index of the
    /// first pixel, relative to the pixel where the sums are, in the upper half.
    numbers: RecordColumns<i32, 2>,
    /// Numerator and divisor.
    sums: RecordColumns<i64, 2>,
    bytes: SpanBytes,
}

impl Default for ShadedData {
    fn default() -> Self {
        let steps = Steps8 { sums: [[0.0; LANES]; 2], words: [[0; LANES]; 4] };
        let (numbers, sums, bytes) = (RecordColumns::new(), RecordColumns::new(), SpanBytes::NONE);
        Self { steps: [steps; Batches::COUNT], numbers, sums, bytes }
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
    fn exact_bytes(&self, span: Span, face: u32, bytes: &mut Bytes) {
        let triangle = self.triangle(face as usize);
        let plane = HyperbolicPlane::of_values(&triangle, triangle.shades());
        let FrameLayout { first_row, pitch, .. } = self.layout;
        // In a frame: below 4,096.
        let (x, y) = ((span.at % pitch) as i32, (first_row + span.at / pitch) as i32);
        plane.fill(x, y, &mut bytes[..(span.length as usize).min(PIECE)]);
    }
}

/// Triangles, the planes of eight of them, and the steps of those whose spans are listed.
pub(super) struct Shaded8<'a> {
    kind: Kind,
    listed: ShadedFaces<'a>,
    data: &'a mut ShadedData,
    /// 16.16: 255·h, and A.
    fraction: Floats,
    area: Floats,
    /// Perspective-correct: numerator and divisor, each at the box's first pixel and its change per row.
    planes: [[Floats; 2]; 2],
    /// In f32: the weight of each corner, by height: its value at the box's first pixel, and its changes per row and
    /// column.
    weights: [[Floats; 3]; 3],
    /// Each corner's depth times its shade, and its depth.
    values: [[Floats; 2]; 3],
}

impl<'a> Shaded8<'a> {
    #[inline(always)]
    pub(super) fn new(kind: Kind, of: PickedTriangles<'a>, layout: FrameLayout, data: &'a mut ShadedData) -> Self {
        let floats = [0.0; LANES];
        Self {
            kind,
            listed: ShadedFaces { of, layout, batches: Batches::NONE },
            data,
            fraction: floats,
            area: floats,
            planes: [[floats; 2]; 2],
            weights: [[floats; 3]; 3],
            values: [[floats; 2]; 3],
        }
    }

    #[inline(always)]
    fn set_up_16_16<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, setup: &TriangleSetup8) {
        let magic = s.splat_f64(ROUND_MAGIC);
        let per_column = s.load_f64(&setup.shade.per_column);
        let half = s.xor_sign(s.mul_add(basis.area, s.splat_f64(0.5), s.splat_f64(-0.5)), per_column);
        let fraction = s.mul(half, s.splat_f64(255.0));
        s.store_f64(fraction, &mut self.fraction);
        s.store_f64(basis.area, &mut self.area);
        let step = sum_16_16(s, s.sub(per_column, half), (basis.area, basis.inverse), fraction, magic);
        s.store_i32(step, &mut self.data.steps[self.listed.batches.current()].words[0]);
    }

    #[inline(always)]
    fn set_up_hyperbolic<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &Corners8) {
        let [a, b, c] = basis.order.load(s, &corners.shade);
        let depths = basis.depths(s, corners);
        // 2¹⁶ times a byte with its half, and a bit more if it is the same everywhere: see
        // `HyperbolicPlane::estimates`.
        let is_flat = s.and(s.is_equal(a, b), s.is_equal(b, c));
        let half = s.select(is_flat, s.splat_f64(128.5), s.splat_f64(128.0));
        let numerators = three(
            [(a, depths[0]), (b, depths[1]), (c, depths[2])],
            #[inline(always)]
            |(shade, depth)| s.mul(s.mul(s.add(s.to_f64(shade), half), s.splat_f64(256.0)), depth),
        );
        let [spread, least] = basis.conditions(s, ends(s, depths));
        let is_sure = s.is_less(spread, s.mul(least, s.splat_f64(524_288.0)));
        let (zero, one) = (s.splat_f64(0.0), s.splat_f64(1.0));
        let steps = &mut self.data.steps[self.listed.batches.current()];
        for (i, (values, unsure)) in [(numerators, zero), (depths, one)].into_iter().enumerate() {
            let [at_first, per_row, per_column] = basis.plane(s, values);
            s.store_f64(s.select(is_sure, at_first, unsure), &mut self.planes[i][0]);
            s.store_f64(s.select(is_sure, per_row, zero), &mut self.planes[i][1]);
            s.store_f64(s.select(is_sure, per_column, zero), &mut steps.sums[i]);
        }
    }

    #[inline(always)]
    fn set_up_float<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &Corners8) {
        let shades = basis.order.load(s, &corners.shade);
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
            for (i, to) in self.weights[corner].iter_mut().enumerate() {
                s.store_f64(weights[corner][i], to);
            }
            for (i, to) in self.values[corner].iter_mut().enumerate() {
                s.store_f64(values[corner][i], to);
            }
        }
        let steps = &mut self.data.steps[self.listed.batches.current()];
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

    #[inline(always)]
    fn draw_by<S: Lanes8, const IS_ESTIMATE: bool>(&mut self, s: S, list: &mut SpanList, target: &mut Target<'_>) {
        let (count, mut first, mut nearer) = (list.count(), 0, 0);
        let ShadedData { steps, numbers, sums: starts, bytes: all_bytes } = &mut *self.data;
        let depths = list.depths();
        while first < count {
            let end = count.min(first + SpanBytes::COUNT);
            for k in first..end {
                let span = list.span(k);
                let record = span.fill as usize;
                let face = numbers.of(record, 0).cast_unsigned();
                let sum = |i: usize| f64::from_bits(starts.of(record, i).cast_unsigned());
                let [n, d] = [sum(0), sum(1)];
                let bytes = all_bytes.of_mut(k - first);
                // The span's bytes, followed by arbitrary ones to fill blocks of eight.
                let row = (&mut bytes[..], span.length as usize);
                // The lowest six bits, in f32 too.
                let (batch, lane) = Batches::of_face(face as usize);
                if IS_ESTIMATE {
                    let [dn, dd] = &steps[batch].sums;
                    if !fill_estimated_blocks(s, row, [n, dn[lane]], [d, dd[lane]]) {
                        self.listed.exact_bytes(span, face, bytes);
                    }
                } else {
                    #[cfg(feature = "alloc")]
                    {
                        let mut singles = [0.0; 4];
                        for (single, bits) in singles.iter_mut().zip(&steps[batch].words) {
                            *single = f32::from_bits(bits[lane].cast_unsigned());
                        }
                        let [dn, dd, least, greatest] = singles;
                        // Rounded once: dividing by 256 changes no bit.
                        let (n_and_step, d_and_step) = ([(n / 256.0) as f32, dn], [d as f32, dd]);
                        // The index of the first pixel, relative to the pixel where the sums are.
                        let first = face.cast_signed() >> 16;
                        fill_float_blocks(row, first, n_and_step, d_and_step, [least, greatest]);
                    }
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
                match self.kind {
                    Kind::Fixed16 => self.set_up_16_16(s, basis, setup),
                    Kind::Hyperbolic => self.set_up_hyperbolic(s, basis, corners),
                    #[cfg(feature = "alloc")]
                    Kind::Float => self.set_up_float(s, basis, corners),
                }
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
        let (j, magic) = (ends.j, s.splat_f64(ROUND_MAGIC));
        let record = self.listed.batches.records.begin();
        // At most 255.
        let records = s.add_i32(s.splat_i32(record as i32), s.load_i32(&NUMBERS));
        // Below 64.
        let face = self.listed.batches.faces(s, lane);
        let ShadedData { steps, numbers, sums: starts, .. } = &mut *self.data;
        let steps = &steps[self.listed.batches.current()];
        if self.kind == Kind::Fixed16 {
            let n = numerator_at(s, lane, &setup.shade, j, parts.row);
            let quotient = (lane.load_f64(s, &self.area), lane.load_f64(s, &setup.inverse));
            let start = sum_16_16(s, n, quotient, lane.load_f64(s, &self.fraction), magic);
            let skipped = s.sub_i32(s.low_bits(parts.start), s.low_bits(parts.row));
            let step = lane.load_i32(s, &steps.words[0]);
            s.store_i32(s.add_i32(start, s.mul_i32(step, skipped)), numbers.eight(record, 0));
            s.store_i32(step, numbers.eight(record, 1));
            return records;
        }
        if self.kind == Kind::Hyperbolic {
            let columns = s.sub(parts.start, magic);
            s.store_i32(face, numbers.eight(record, 0));
            for (i, [at_first, per_row]) in self.planes.iter().enumerate() {
                let at_row = s.mul_add(lane.load_f64(s, per_row), j, lane.load_f64(s, at_first));
                let sum = s.mul_add(lane.load_f64(s, &steps.sums[i]), columns, at_row);
                s.store_i64(s.bits(sum), starts.eight(record, i));
            }
            return records;
        }
        // A step of zero is not −0.
        let falls = s.is_greater(s.splat_i32(0), lane.load_i32(s, &steps.words[1]));
        let at = s.select(falls, s.sub(parts.end, s.splat_f64(1.0)), parts.row);
        let first = s.sub_i32(s.low_bits(parts.start), s.low_bits(at));
        s.store_i32(s.or_i32(face, s.shl_i32(first, 16)), numbers.eight(record, 0));
        let columns = s.sub(at, magic);
        let mut sums = [s.splat_f64(0.0); 2];
        for (weights, values) in self.weights.iter().zip(&self.values) {
            // Whole numbers: exact.
            let weight = s.mul_add(lane.load_f64(s, &weights[1]), j, lane.load_f64(s, &weights[0]));
            let weight = s.mul_add(lane.load_f64(s, &weights[2]), columns, weight);
            for (i, sum) in sums.iter_mut().enumerate() {
                // Rounded twice at every level.
                *sum = s.add(*sum, s.mul(weight, lane.load_f64(s, &values[i])));
            }
        }
        for (i, sum) in sums.into_iter().enumerate() {
            s.store_i64(s.bits(sum), starts.eight(record, i));
        }
        records
    }

    /// The exact steps in f32 of a triangle too large for 64-bit sums.
    #[inline(never)]
    fn set_up_large(&mut self, i: usize) {
        #[cfg(feature = "alloc")]
        if self.kind == Kind::Float {
            let triangle = self.listed.triangle(self.listed.batches.current() * LANES + i);
            let steps = FloatPlane::of_values(&triangle, triangle.shades()).steps;
            for (to, step) in self.data.steps[self.listed.batches.current()].words.iter_mut().zip(steps) {
                to[i % LANES] = step.to_bits().cast_signed();
            }
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
            let numbers = &shades.data.numbers;
            let number = |record: u32, i: usize| numbers.of(record as usize, i).cast_unsigned();
            let of_span = |record: u32| (number(record, 0), number(record, 1));
            let nearer = target.kernel.fill_spans_16_16(target.pixels, &mut target.cells, list, of_span);
            list.clear(nearer);
        }
        Kind::Hyperbolic => shades.draw_by::<S, true>(s, list, target),
        #[cfg(feature = "alloc")]
        Kind::Float => shades.draw_by::<S, false>(s, list, target),
    }
}

type Bytes = [u8; PIECE];
