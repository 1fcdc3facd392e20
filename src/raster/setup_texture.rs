//! Texture coordinates of eight small triangles: planes from their corners, and the starts of their rows.
//!
//! Coordinates that are linear on the screen are set up like shades, with the quotients of [`setup`](super::setup).
//! Where a triangle's coordinates differ by less than 2²², 64 texels, gradients are below 2³⁹, no sum of terms reaches
//! 2⁵², and f64 holds all multiples of ½ below that. A quotient is below 2²² and off by 2⁻³⁰, its margin at least
//! 2⁻²⁷·¹². Where corners are farther apart, or a triangle is larger, each number is split into an integer and a
//! remainder below the area of at most 2³⁴: with columns below 2¹⁰ and rows below 2¹², sums of remainders stay below
//! 2⁴⁷, quotients below 2¹³, so they are off by less than 2⁻³⁷, with a margin of 2⁻³⁵.
//!
//! Coordinates that are linear on the face are quotients of two values, each with a plane in f64; [`Basis::conditions`]
//! gives their accuracy. With Q the greatest coordinate and Q·X up to 2⁴³ they are off by less than 0.2; other
//! triangles get a divisor below 0, which decides nothing. A triangle's coordinates are relative to the texel of a
//! corner, its base, so that f32 resolves them if the other corners are near.

use super::columns::{PickedTriangles, eight_corners};
use super::pick::Pick;
use super::reference::cover::SortedTriangle;
use super::reference::level;
use super::reference::quotient::Divisor;
use super::reference::texture::{AffineLevel, AffinePlane, PerspectiveTexture, depth};
use super::rows::Lane;
use super::setup::{Basis, Corners8, Floats, Ints, ends};
use crate::fixed::{HAS_F64, ROUND_MAGIC};
use crate::lanes::{LANES, each};
use crate::simd::Lanes8;
use crate::span::texture::{PerspectiveSums, singles_margin};

/// Texture coordinates u and v of each corner of up to eight triangles, in texels with 16 fraction bits; 0 in lanes
/// without a triangle.
#[inline(always)]
pub(super) fn texture_of_corners(&PickedTriangles { triangles, picks }: &PickedTriangles<'_>) -> [[Ints; 3]; 2] {
    let mut gathered = [[[0; LANES]; 3]; 2];
    let column = triangles.columns.effects.texture;
    if let Some(texture) = triangles.consecutive(&picks).and_then(|first| eight_corners(column, first)) {
        for corner in 0..3 {
            for lane in 0..LANES {
                (gathered[0][corner][lane], gathered[1][corner][lane]) = texture[corner][lane].into();
            }
        }
        return gathered;
    }
    for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
        let indices = triangles.indices[Pick(pick).index()];
        for (corner, vertex) in indices.into_iter().enumerate() {
            let [u, v] = column[vertex as usize];
            (gathered[0][corner][lane], gathered[1][corner][lane]) = (u, v);
        }
    }
    gathered
}

/// Planes of coordinates that are linear on the screen, of eight triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct AffinePlanes8 {
    n: [Floats; 2],
    per_row: [Floats; 2],
    per_column: [Floats; 2],
    inverse: Floats,
    /// The coordinate of the first corner by height, or the integer at the first pixel of a split triangle.
    first: [Ints; 2],
    /// True if any of the eight triangles is split. Otherwise the integers below are not read.
    is_split: bool,
    /// The integers per row and per column, 0 for triangles that are not split.
    whole_per_row: [Ints; 2],
    whole_per_column: [Ints; 2],
    /// Change per pixel, where a row has more than one.
    step: [Ints; 2],
    /// The level of each triangle, if the image has levels.
    level: Ints,
    /// A bit for each triangle whose u, or v, falls along a row.
    falls: [u32; 2],
}

impl AffinePlanes8 {
    /// The difference between two corners' coordinates from which on eight faces are not set up at once.
    const TOO_FAR: i32 = 1 << 22;

    /// Sets up eight triangles, with levels up to the last if the image has any. Returns a bit for each small one whose
    /// corners' coordinates are close enough together. The others have to be [split](Self::split).
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(
        &mut self,
        s: S,
        basis: &Basis<S>,
        coordinates: &[[Ints; 3]; 2],
        last: Option<u32>,
    ) -> u32 {
        s.store_f64(basis.inverse, &mut self.inverse);
        self.is_split = false;
        let mut fits = u32::MAX;
        let [x, y] = basis.first;
        let (pixel, magic, zero) = (s.splat_f64(256.0), s.splat_f64(ROUND_MAGIC), s.splat_f64(0.0));
        let mut gradients = [[zero; 2]; 2];
        for (i, [a, b, c]) in coordinates.iter().enumerate() {
            let corners = [s.load_i32(a), s.load_i32(b), s.load_i32(c)];
            let [a, b, c] = corners;
            // Modulo 2³²: a difference of 2³¹ or more is negative.
            let range = s.sub_i32(s.max_i32(s.max_i32(a, b), c), s.min_i32(s.min_i32(a, b), c));
            let is_near =
                s.and_not(s.is_greater(s.splat_i32(Self::TOO_FAR), range), s.is_greater(s.splat_i32(0), range));
            fits &= s.to_bitmask(is_near);
            let [first, second, third] = basis.order.sort(s, corners);
            s.store_i32(first, &mut self.first[i]);
            let differences = [s.to_f64(s.sub_i32(second, first)), s.to_f64(s.sub_i32(third, first))];
            let [gx, gy] = basis.gradient(s, differences);
            // +0, not −0: its sign chooses the rounding.
            let gx = s.add(gx, zero);
            gradients[i] = [gx, gy];
            // `AffinePlane::start`: the floor, or the ceiling where coordinates fall.
            let half = s.xor_sign(s.mul_add(basis.area, s.splat_f64(0.5), s.splat_f64(-0.5)), gx);
            let n = s.neg_mul_add(gx, x, s.neg_mul_add(gy, y, zero));
            s.store_f64(s.sub(n, half), &mut self.n[i]);
            s.store_f64(s.mul(gy, pixel), &mut self.per_row[i]);
            let per_column = s.mul(gx, pixel);
            s.store_f64(per_column, &mut self.per_column[i]);
            // Toward zero.
            let step = s.mul_add(s.sub(per_column, half), basis.inverse, magic);
            s.store_i32(s.low_bits(step), &mut self.step[i]);
        }
        if let Some(last) = last {
            self.set_up_levels(s, basis.area, gradients, last);
        }
        fits
    }

    /// [`level::of_face`] of eight triangles: all values are whole numbers below 2⁵².
    #[inline(always)]
    fn set_up_levels<S: Lanes8>(&mut self, s: S, area: S::F64, [u, v]: [[S::F64; 2]; 2], last: u32) {
        let longest = s.max(doubled(s, u[0], v[0]), doubled(s, u[1], v[1]));
        // `level::choose`: 64 · 256 times a gradient is a step, and 181 · 2¹⁶ the longest one of level 0.
        let mut most = s.mul(area, s.splat_f64(724.0));
        let mut level = s.splat_i32(0);
        for _ in 0..last {
            level = s.select_i32(s.is_less(most, longest), s.add_i32(level, s.splat_i32(1)), level);
            most = s.add(most, most);
        }
        s.store_i32(level, &mut self.level);
        let zero = s.splat_f64(0.0);
        self.falls = [s.to_bitmask(s.is_less(u[0], zero)), s.to_bitmask(s.is_less(v[0], zero))];
    }

    /// Sets the level of triangle 0.
    pub(super) fn set_level(&mut self, AffineLevel { level, falls }: AffineLevel) {
        self.level[0] = level.cast_signed();
        self.falls = falls.map(u32::from);
    }

    /// The level of triangle `lane`.
    #[inline(always)]
    pub(super) fn level(&self, lane: usize) -> AffineLevel {
        let lane = lane % LANES;
        AffineLevel { level: self.level[lane].cast_unsigned(), falls: self.falls.map(|falls| falls >> lane & 1 != 0) }
    }

    /// Splits the numbers of triangle `lane`, given the coordinates of its corners, and the first pixel of its box.
    #[cold]
    #[inline(never)]
    pub(super) fn split(
        &mut self,
        lane: usize,
        triangle: &SortedTriangle,
        coordinates: [[i32; 3]; 2],
        pixel: [i32; 2],
        last: Option<u32>,
    ) {
        if !self.is_split {
            (self.whole_per_row, self.whole_per_column) = ([[0; LANES]; 2], [[0; LANES]; 2]);
            self.is_split = true;
        }
        let (lane, area) = (lane % LANES, Divisor::new(triangle.area()));
        let planes = coordinates.map(|coordinates| AffinePlane::new(triangle, area, coordinates));
        if let Some(last) = last {
            let AffineLevel { level, falls } = level::of_face(&planes, area.get(), last);
            // At most 8.
            self.level[lane] = level as i32;
            for (bits, falls) in self.falls.iter_mut().zip(falls) {
                *bits = *bits & !(1 << lane) | u32::from(falls) << lane;
            }
        }
        for (i, plane) in planes.into_iter().enumerate() {
            let [first, per_column, per_row] = plane.parts(pixel);
            (self.first[i][lane], self.whole_per_row[i][lane]) = (first.0, per_row.0);
            self.whole_per_column[i][lane] = per_column.0;
            // All below 2⁵³. The quotient's floor is the integer nearest to the quotient − ½ + 1 / (2·area).
            self.n[i][lane] = first.1 as f64 - (area.get() as f64 * 0.5 - 0.5);
            (self.per_row[i][lane], self.per_column[i][lane]) = (per_row.1 as f64, per_column.1 as f64);
            // Modulo 2³².
            self.step[i][lane] = plane.step as i32;
        }
    }

    /// The coordinates, u and v, of each lane at these columns of rows `j`, and the columns and rows as integers.
    #[inline(always)]
    pub(super) fn starts<S: Lanes8>(
        &self,
        s: S,
        lane: impl Lane<S>,
        (j, columns): (S::F64, S::F64),
        [column, row]: [S::I32; 2],
    ) -> [S::I32; 2] {
        let i = s.sub(columns, s.splat_f64(ROUND_MAGIC));
        let inverse = lane.load_f64(s, &self.inverse);
        let mut starts = [s.splat_i32(0); 2];
        for (of, start) in starts.iter_mut().enumerate() {
            let n = s.mul_add(lane.load_f64(s, &self.per_row[of]), j, lane.load_f64(s, &self.n[of]));
            let n = s.mul_add(lane.load_f64(s, &self.per_column[of]), i, n);
            // The low bits; the sum is modulo 2³².
            let change = s.low_bits(s.mul_add(n, inverse, s.splat_f64(ROUND_MAGIC)));
            *start = s.add_i32(change, lane.load_i32(s, &self.first[of]));
            if self.is_split {
                let per_column = s.mul_i32(lane.load_i32(s, &self.whole_per_column[of]), column);
                let per_row = s.mul_i32(lane.load_i32(s, &self.whole_per_row[of]), row);
                *start = s.add_i32(*start, s.add_i32(per_column, per_row));
            }
        }
        starts
    }

    /// Changes per pixel, in each lane.
    #[inline(always)]
    pub(super) fn steps<S: Lanes8>(&self, s: S, lane: impl Lane<S>) -> [S::I32; 2] {
        [lane.load_i32(s, &self.step[0]), lane.load_i32(s, &self.step[1])]
    }
}

/// Twice the length of a step, as in [`level`].
#[inline(always)]
fn doubled<S: Lanes8>(s: S, u: S::F64, v: S::F64) -> S::F64 {
    let (u, v) = (s.xor_sign(u, u), s.xor_sign(v, v));
    s.add(s.add(u, v), s.max(u, v))
}

/// The least n, from 0 on, for which a length, at least 0, is at most 2ⁿ units. From 0 on, f64 are in the order of
/// their bits read as integers, and the bits of 2ⁿ units are n · 2⁵² more than those of one; so no division is needed.
#[inline(always)]
fn level_of<S: Lanes8>(s: S, length: S::F64, unit: S::F64) -> S::I32 {
    let more = s.sub_i64(s.bits(length), s.bits(unit));
    let [_, upper] = s.halves_of_i64(s.add_i64(more, s.splat_i64((1 << 52) - 1)));
    s.max_i32(s.shr_i32(upper, 20), s.splat_i32(0))
}

/// Twice the length of a step of triangle `lane`, times the square of the divisor, given two numerators with their
/// divisor, and the changes of the planes.
#[inline(always)]
fn step_of<S: Lanes8>(s: S, lane: usize, [u, v, d]: [S::F64; 3], steps: &[Floats; 3]) -> S::F64 {
    let (du, dv, dd) = (s.splat_f64(steps[0][lane]), s.splat_f64(steps[1][lane]), s.splat_f64(steps[2][lane]));
    doubled(s, s.neg_mul_add(u, dd, s.mul(du, d)), s.neg_mul_add(v, dd, s.mul(dv, d)))
}

/// Bounds of twice the length of a step, given u, v and 1 of the corners, times their depths, and the changes of the
/// planes: the least and the greatest, times the square of the depth.
#[inline(always)]
fn steps_of_corners<S: Lanes8>(s: S, values: &[[S::F64; 3]; 3], steps: &[Floats; 3]) -> [S::F64; 2] {
    let zero = s.splat_f64(0.0);
    let (mut shortest, mut longest) = ([zero; 2], [zero; 2]);
    let of_depth = s.load_f64(&steps[2]);
    for i in 0..2 {
        let step = s.load_f64(&steps[i]);
        let mut corners = [zero; 3];
        for corner in 0..3 {
            corners[corner] = s.neg_mul_add(values[i][corner], of_depth, s.mul(step, values[2][corner]));
        }
        let [least, greatest] = ends(s, corners);
        longest[i] = s.max(greatest, s.sub(zero, least));
        // 0 if signs differ.
        shortest[i] = s.max(s.max(least, s.sub(zero, greatest)), zero);
    }
    [doubled(s, shortest[0], shortest[1]), doubled(s, longest[0], longest[1])]
}

/// Coordinates that are linear on the face, of eight triangles: planes of u, v and 1, each times the depth and the
/// area.
#[derive(Clone, Debug, Default)]
pub(super) struct PerspectivePlanes8 {
    /// At the box's first pixel.
    first: [Floats; 3],
    /// Change per pixel.
    step: [Floats; 3],
    /// The base of u and v: what has been subtracted from the corners' coordinates, a whole number of texels.
    base: [Ints; 2],
    /// How far quotients in f32 may be off, or 0 where they may not be taken: see [`singles_margin`].
    margin: Ints,
    /// The steps rounded to f32.
    single_step: [[f32; LANES]; 3],
    /// Change per row.
    row_step: [Floats; 3],
    /// A bit for each triangle whose levels may be estimated, see [`level`](Self::level).
    fits_levels: u32,
    /// The level of each triangle that has a single one, otherwise −1.
    single_level: Ints,
}

impl PerspectivePlanes8 {
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(
        &mut self,
        s: S,
        basis: &Basis<S>,
        corners: &Corners8,
        coordinates: &[[Ints; 3]; 2],
        last: Option<u32>,
    ) {
        let depths = basis.depths(s, corners);
        let ([u, v], range) = self.rebase(s, basis, coordinates);
        let ends = ends(s, depths);
        let [spread, least] = basis.conditions(s, ends);
        let spread = s.mul(s.add(range, s.splat_f64(65_536.0)), spread);
        let is_sure = s.is_less(spread, s.mul(least, s.splat_f64(8_796_093_022_208.0)));
        let margin = s.select_i32(is_sure, singles_margin(s, range, ends), s.splat_i32(0));
        s.store_i32(margin, &mut self.margin);
        let mut values = [u, v, depths];
        for of_corners in &mut values[..2] {
            for corner in 0..3 {
                of_corners[corner] = s.mul(of_corners[corner], depths[corner]);
            }
        }
        let (zero, negative) = (s.splat_f64(0.0), s.splat_f64(-1.0));
        for (i, &of_corners) in values.iter().enumerate() {
            let [mut first, mut per_row, mut per_column] = basis.plane(s, of_corners);
            if i == 2 {
                first = s.select(is_sure, first, negative);
                (per_row, per_column) = (s.select(is_sure, per_row, zero), s.select(is_sure, per_column, zero));
            }
            s.store_f64(first, &mut self.first[i]);
            s.store_f64(per_row, &mut self.row_step[i]);
            s.store_f64(per_column, &mut self.step[i]);
            let step = &self.step[i];
            self.single_step[i] = each!(lane => step[lane] as f32);
        }
        if let Some(last) = last {
            let [width, height] = basis.sides(s);
            self.set_up_levels(s, (spread, least), (s.add(width, height), ends));
            self.set_up_single_levels(s, (basis.area, &values), ends, last);
        }
    }

    /// The sorted corners' coordinates relative to the triangle's base, and the greatest difference
    /// between two. No coordinate exceeds that difference plus a texel.
    ///
    /// A coordinate that all corners share is moved to the middle of its texel, which is in the same texel of every
    /// level. Many models give a face one point of a colour atlas, often on the border of a texel, where no
    /// quotient could decide.
    #[inline(always)]
    fn rebase<S: Lanes8>(
        &mut self,
        s: S,
        basis: &Basis<S>,
        coordinates: &[[Ints; 3]; 2],
    ) -> ([[S::F64; 3]; 2], S::F64) {
        let zero = s.splat_f64(0.0);
        let (mut rebased, mut greatest) = ([[zero; 3]; 2], zero);
        for (i, [a, b, c]) in coordinates.iter().enumerate() {
            let [a, b, c] = basis.order.sort(s, [s.load_i32(a), s.load_i32(b), s.load_i32(c)]);
            let base = s.and_i32(a, s.splat_i32(!0xFFFF));
            s.store_i32(base, &mut self.base[i]);
            let (is_shared, middle) = (s.and(s.is_equal(a, b), s.is_equal(a, c)), s.or_i32(base, s.splat_i32(0x8000)));
            let [a, b, c] = [a, b, c].map(|coordinate| s.select_i32(is_shared, middle, coordinate));
            // Differences of i32 are exact in f64.
            let (base, a, b, c) = (s.to_f64(base), s.to_f64(a), s.to_f64(b), s.to_f64(c));
            greatest = s.max(greatest, s.sub(s.max(s.max(a, b), c), s.min(s.min(a, b), c)));
            rebased[i] = [s.sub(a, base), s.sub(b, base), s.sub(c, base)];
        }
        (rebased, greatest)
    }

    /// The values of the planes at these columns of rows `j`.
    #[inline(always)]
    pub(super) fn starts<S: Lanes8>(&self, s: S, lane: impl Lane<S>, j: S::F64, columns: S::F64) -> [S::F64; 3] {
        let column = s.sub(columns, s.splat_f64(ROUND_MAGIC));
        let mut starts = [s.splat_f64(0.0); 3];
        for (i, start) in starts.iter_mut().enumerate() {
            let at_row = s.mul_add(lane.load_f64(s, &self.row_step[i]), j, lane.load_f64(s, &self.first[i]));
            *start = s.mul_add(lane.load_f64(s, &self.step[i]), column, at_row);
        }
        starts
    }

    /// Finds where [`level`](Self::level) is accurate, given Q·W·H times the greatest depth and A times the least
    /// (their quotient is Q·X), W + H, and both depths.
    #[inline(always)]
    fn set_up_levels<S: Lanes8>(
        &mut self,
        s: S,
        (spread, level): (S::F64, S::F64),
        (sides, [least, greatest]): (S::F64, [S::F64; 2]),
    ) {
        // A·least·κ.
        let changes = s.mul(s.mul(sides, s.splat_f64(512.0)), greatest);
        let most = s.mul(s.mul(level, level), s.splat_f64(17_592_186_044_416.0));
        let is_accurate = s.is_less(s.mul(spread, changes), most);
        self.fits_levels = s.to_bitmask(s.and(is_accurate, s.is_less(s.splat_f64(65_536.0), least)));
    }

    /// Finds the triangles all of whose pixels have the same level, from bounds of the quotient of
    /// [`level`](Self::level) over a whole triangle. Levels beyond the last count as the last.
    ///
    /// At a corner D is A times its depth d, so ∂N/∂x · D − N · ∂D/∂x is A · (∂N/∂x · d − u · d · ∂D/∂x). This, its
    /// counterpart by rows, and D are linear on the triangle. So each lies between its values at the corners, and G /
    /// D² between the least G over the greatest D² and the greatest G over the least D².
    ///
    /// Depths differ by a factor of at most 2, so the greatest D² is at most 4 times any other: where the level is
    /// above 0, G, which is off by less than 1.2 · D², and the square of the depth are together off by less than 2⁻¹⁴
    /// of themselves.
    #[inline(always)]
    fn set_up_single_levels<S: Lanes8>(
        &mut self,
        s: S,
        (area, values): (S::F64, &[[S::F64; 3]; 3]),
        [least, greatest]: [S::F64; 2],
        last: u32,
    ) {
        let [shortest_across, longest_across] = steps_of_corners(s, values, &self.step);
        let [shortest_down, longest_down] = steps_of_corners(s, values, &self.row_step);
        let unit = s.mul(area, s.splat_f64(185_344.0));
        let off = 1.0 / 8_192.0;
        let shortest = s.mul(s.max(shortest_across, shortest_down), s.splat_f64(1.0 - off));
        let longest = s.mul(s.max(longest_across, longest_down), s.splat_f64(1.0 + off));
        // At most 8.
        let last = s.splat_i32(last as i32);
        let low = s.min_i32(level_of(s, shortest, s.mul(unit, s.mul(greatest, greatest))), last);
        let high = s.min_i32(level_of(s, longest, s.mul(unit, s.mul(least, least))), last);
        let is_single = s.and_not(s.is_equal(low, high), s.is_less(s.add(least, least), greatest));
        // Eight bits.
        let is_single = s.and(is_single, s.mask_from_bits((self.fits_levels & 0xFF) as u8));
        s.store_i32(s.select_i32(is_single, low, s.splat_i32(-1)), &mut self.single_level);
    }

    /// The level of all pixels of triangle `lane`, if it has only one.
    #[inline(always)]
    pub(super) fn single_level(&self, lane: usize) -> Option<u32> {
        u32::try_from(self.single_level[lane % LANES]).ok()
    }

    /// The levels of a texture at pixels `k` of a span of triangle `lane`, from the sums at its first, or −1 where an
    /// estimate cannot decide.
    ///
    /// With N and D the sums, ∂u/∂x = (∂N/∂x · D − N · ∂D/∂x) / D². So the level is the least n at which twice the
    /// length of the longer step, G / D², is at most 2ⁿ · 2 · 181/128 texels: G / (185,344 · D²) ≤ 2ⁿ.
    ///
    /// [`LevelPlane`](super::reference::level::LevelPlane) takes the depth D / A in whole sixteenths, which are at
    /// least 2²⁰ where depths are at least 2¹⁶: its square is off by 2⁻¹⁹ of itself. With Q the greatest coordinate
    /// from the base on, and κ = (magnitudes of the weights' changes) · (greatest depth) / (A · least depth), the
    /// changes of N and D are at most Q·κ·D and κ·D. By [`Basis::conditions`], in units of 2⁻⁵¹, N is off by 26·Q·X·D,
    /// D by 26·X·D, and their changes by 1.75·Q·κ·D and 1.75·κ·D; so with the roundings here, G, the sum of three
    /// differences of two products, is off by less than 3 · (52·X + 6) · Q·κ·D², or 174·X·Q·κ·D². Where Q·X·κ is up to
    /// 2⁴⁴ that is 1.4 · D², 2⁻¹⁷ of the least G above level 0. So the quotient is off by less than 2⁻¹⁶ of itself, or
    /// below 1.
    ///
    /// For a triangle [alone](Self::set_up_alone), whose sums are those of exact weights, 3 · (5κ + 192κ²) · Q takes
    /// the place of 174·X·Q·κ: 64 steps are off by 64 times as much as one.
    #[inline(always)]
    pub(super) fn levels<S: Lanes8>(&self, s: S, lane: usize, sums: [f64; 3], k: S::I32, last: u32) -> S::I32 {
        let lane = lane % LANES;
        if self.fits_levels >> lane & 1 == 0 {
            return s.splat_i32(-1);
        }
        let (u, v, d) = (s.splat_f64(sums[0]), s.splat_f64(sums[1]), s.splat_f64(sums[2]));
        let across = step_of(s, lane, [u, v, d], &self.step);
        let (k, step) = (s.to_f64(k), &self.step);
        let u = s.mul_add(k, s.splat_f64(step[0][lane]), u);
        let v = s.mul_add(k, s.splat_f64(step[1][lane]), v);
        let d = s.mul_add(k, s.splat_f64(step[2][lane]), d);
        let down = step_of(s, lane, [u, v, d], &self.row_step);
        let (length, unit) = (s.max(across, down), s.mul(s.mul(s.splat_f64(185_344.0), d), d));
        let (off, last) = (1.0 / 65_536.0, s.splat_i32(last as i32)); // at most 8
        let least = s.min_i32(level_of(s, s.mul(length, s.splat_f64(1.0 - off)), unit), last);
        let most = s.min_i32(level_of(s, s.mul(length, s.splat_f64(1.0 + off)), unit), last);
        s.select_i32(s.is_equal(least, most), least, s.splat_i32(-1))
    }

    /// Sets up a single triangle, number 0, with these coordinates, u and v, at its corners. Its base is 0.
    pub(super) fn set_up_alone(
        &mut self,
        triangle: &SortedTriangle,
        coordinates: &[[i32; 3]; 2],
        texture: &PerspectiveTexture,
    ) {
        let [steps, row_steps] = texture.steps;
        for i in 0..3 {
            (self.step[i][0], self.row_step[i][0]) = (steps[i], row_steps[i]);
        }
        (self.base, self.margin[0], self.single_level[0]) = ([[0; LANES]; 2], 0, -1);
        // Q·κ·(1 + κ) < 2⁴².
        let greatest_of = |most: u32, coordinate: &i32| most.max(coordinate.unsigned_abs());
        let q = f64::from(coordinates.as_flattened().iter().fold(0, greatest_of)) + 65_536.0;
        let depths = [0, 1, 2].map(|corner| depth(triangle, corner));
        let (least, greatest) = (depths.into_iter().fold(i64::MAX, i64::min), depths.into_iter().fold(0, i64::max));
        let (a, b) = (triangle.area() as f64 * least as f64, texture.sides() * greatest as f64);
        let is_accurate = q * b * (a + b) < a * a * 4_398_046_511_104.0;
        self.fits_levels = u32::from(HAS_F64 && is_accurate && least > 65_536);
    }

    /// The sums along a span of triangle `lane`, from those at its first pixel.
    #[inline(always)]
    pub(super) fn sums(&self, lane: usize, [u, v, d]: [f64; 3]) -> PerspectiveSums<f64> {
        let (lane, [du, dv, dd]) = (lane % LANES, &self.step);
        let base = [self.base[0][lane], self.base[1][lane]];
        PerspectiveSums { numerators: [[u, du[lane]], [v, dv[lane]]], divisors: [d, dd[lane]], base, margin: 0 }
    }

    /// The sums rounded to f32, if quotients may be taken in f32: see [`singles_margin`].
    #[inline(always)]
    pub(super) fn singles(&self, lane: usize, sums: impl FnOnce() -> [f32; 3]) -> Option<PerspectiveSums<f32>> {
        let lane = lane % LANES;
        let margin = self.margin[lane];
        if margin == 0 {
            return None;
        }
        let ([u, v, d], [du, dv, dd]) = (sums(), &self.single_step);
        let base = [self.base[0][lane], self.base[1][lane]];
        Some(PerspectiveSums { numerators: [[u, du[lane]], [v, dv[lane]]], divisors: [d, dd[lane]], base, margin })
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::simd::Portable;

    /// A length of exactly 2ⁿ units has level n, and the next greater f64 the level after it.
    #[test]
    fn a_level_ends_at_its_power_of_two() {
        let level = |length: f64, unit: f64| level_of(Portable, [length; LANES], [unit; LANES])[0];
        for unit in [1.0, 1.5, 185_344.0, 3e20, 1.0_f64.next_down(), 2.0_f64.next_down()] {
            assert_eq!((level(0.0, unit), level(unit / 1_024.0, unit)), (0, 0));
            for n in 0..12 {
                let most = unit * f64::from(1 << n);
                assert_eq!([most.next_down(), most, most.next_up()].map(|l| level(l, unit)), [n, n, n + 1], "{unit}");
            }
        }
    }
}
