//! Set-up of eight triangles: edges, shade planes and depth planes from their corners.
//!
//! Coordinates are relative to the centre of the box's first pixel, so all numbers are small, and f64 holds every
//! numerator exactly. A quotient is a product with the divisor's reciprocal, and its floor is exact by a margin: for
//! integers n and d
//!
//! ```text
//! floor(n / d) = nearest((n + ½ − d/2) / d)
//! ```
//!
//! where the argument of the rounding is at least 1/(2d) from the middle between two integers. The reciprocal and the
//! product are each off by at most one part in 2⁵³: for a shade, below 2¹⁶, by 2⁻³⁶ together. A box of at most 2¹⁸
//! pixels has 2³⁴ square units, and twice the area is no more, so the margin is at least 2⁻³⁵. A column is below 2¹⁰
//! and its divisor at most 2²⁸: the margin is 2⁻²⁹, the error 2⁻⁴². (n + ½ − d/2 is exact: a multiple of ½ below 2⁵². A
//! gradient's numerator is below 2¹⁶ times the box's height or width, so each term of n, and n at any pixel of the
//! triangle, is below 2⁵⁰; and no sum has more than three of them.) A step may have any size, but is below 2⁴⁴ / d, so
//! it is off by less than 2⁻⁸ / d. The integer is found by adding 1.5 · 2⁵², which leaves it in the low bits. So there
//! is no correction, no branch, and the same result on every processor; where the level has FMA, a sum with a product
//! is rounded once, which is more accurate than rounding twice.
//!
//! Depth planes are those of [`DepthPlane`], whose gradients are
//!
//! ```text
//! g = floor((2²⁴·n + (A >> 1)) / A)        n: the numerator, A: twice the area
//! ```
//!
//! in two f64 quotients: for any integer q
//!
//! ```text
//! q = nearest(n / A), or a neighbour      r = n − q·A        g = 2²⁴·q + nearest(2²⁴·r / A), halves upward
//! ```
//!
//! (With an odd A there are no ties, and the half that A >> 1 drops changes no floor.) A small triangle's box is less
//! than 65 × 17 pixels, so A is below 2²⁶·¹² and |n| below 2⁴⁸: n, q·A and r are exact, and |r| is at most 0.52·A. The
//! last quotient is taken of 2²⁴·r + ¼, which is exact too, so that the argument of the rounding is at least 1/(4A),
//! more than 2⁻²⁸·¹², from the middle between two integers. The quotient is below 2²³·¹, and off by at most 2⁻⁵² of
//! that: less than 2⁻²⁸·⁹.

use super::columns::{Columns, PickedTriangles, Triangles, eight_corners};
use super::fill_rule::first_centre_of_each;
use super::pick::Pick;
use super::reference::depth::DepthPlane;
use crate::fixed::ROUND_MAGIC;
use crate::lanes::{LANES, three};
use crate::simd::Lanes8;

/// The layout of a frame's pixels.
#[derive(Clone, Copy)]
pub(super) struct FrameLayout {
    /// The row whose pixels come first.
    pub(super) first_row: u32,
    /// The number of pixels from one row to the next, at most 2¹⁶.
    pub(super) pitch: u32,
    /// The number of cells of the depth buffer from one row to the next.
    pub(super) width: u32,
    /// The depth buffer's [base](super::depth::DepthBuffer), or 0.
    pub(super) depth_base: u32,
}

pub(super) type Floats = [f64; LANES];
pub(super) type Ints = [i32; LANES];

/// The corners of eight triangles. Lanes without a triangle hold arbitrary values.
pub(super) struct Corners8 {
    /// A [`ScreenPos`](super::columns::ScreenPos) each.
    at: [[i64; LANES]; 3],
    pub(super) shade: [Ints; 3],
    /// Depths: the bits of a `u32` each.
    pub(super) depth: [Ints; 3],
}

impl Corners8 {
    pub(super) const NONE: Self = Self { at: [[0; LANES]; 3], shade: [[0; LANES]; 3], depth: [[0; LANES]; 3] };

    /// Reads the first eight of these triangles, with depths only if `DEPTHS`.
    #[inline(always)]
    pub(super) fn gather<const DEPTHS: bool>(&mut self, &PickedTriangles { triangles, picks }: &PickedTriangles<'_>) {
        let Columns { at, depth, shade, .. } = triangles.columns;
        // Sliced to one length, so that a vertex's index is bounds-checked once.
        let vertices = at.len().min(depth.len()).min(shade.len());
        let (at, depth, shade) = (&at[..vertices], &depth[..vertices], &shade[..vertices]);
        let are_flat = !picks.flat.is_empty();
        if let Some(first) = triangles.consecutive(&picks)
            && !are_flat
            && self.load(triangles, first).is_some()
        {
            return;
        }
        for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
            let pick = Pick(pick);
            let indices = triangles.indices[pick.index()];
            for (corner, vertex) in indices.into_iter().enumerate() {
                let vertex = vertex as usize;
                self.at[corner][lane] = u64::from(at[vertex]).cast_signed();
                if !are_flat {
                    self.shade[corner][lane] = i32::from(shade[vertex][pick.side()].to_bits());
                }
                if DEPTHS {
                    self.depth[corner][lane] = depth[vertex].cast_signed();
                }
            }
        }
        for (lane, flat) in picks.flat.iter().take(LANES).enumerate() {
            for shades in &mut self.shade {
                shades[lane] = i32::from(flat[0].to_bits());
            }
        }
    }

    /// Reads eight consecutive triangles, all seen from the front, from these indices of corners on.
    #[inline(always)]
    fn load(&mut self, triangles: &Triangles<'_>, first: [usize; 3]) -> Option<()> {
        let Columns { at, depth, shade, .. } = triangles.columns;
        let (at, depth) = (eight_corners(at, first)?, eight_corners(depth, first)?);
        let shade = eight_corners(shade, first)?;
        for corner in 0..3 {
            for lane in 0..LANES {
                self.at[corner][lane] = u64::from(at[corner][lane]).cast_signed();
                self.shade[corner][lane] = i32::from(shade[corner][lane][0].to_bits());
                self.depth[corner][lane] = depth[corner][lane].cast_signed();
            }
        }
        Some(())
    }
}

/// An edge: the first pixel on it or right of it in row j is `nearest((n + j·per_row) · inverse)`.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Edges {
    pub(super) n: Floats,
    pub(super) per_row: Floats,
    pub(super) inverse: Floats,
}

impl Edges {
    const NONE: Self = Self { n: [0.0; LANES], per_row: [0.0; LANES], inverse: [0.0; LANES] };

    /// Sets up the edges from `(x, y)` over `(dx, dy)`.
    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, (x, y): (S::F64, S::F64), (dx, dy): (S::F64, S::F64)) {
        // x = (ax·dy + dx·(256·j − ay)) / (256·dy), rounded up: the floor of one unit less, plus one. For a horizontal
        // edge, where dy is 0, the result is not used.
        let n = s.mul_add(dy, s.splat_f64(128.0), s.splat_f64(-0.5));
        let n = s.mul_add(x, dy, n);
        s.store_f64(s.neg_mul_add(dx, y, n), &mut self.n);
        let pixel = s.splat_f64(256.0);
        s.store_f64(s.mul(dx, pixel), &mut self.per_row);
        s.store_f64(s.div(s.splat_f64(1.0), s.mul(dy, pixel)), &mut self.inverse);
    }
}

/// Planes of a value of 0 to 0xFF00 over eight triangles: `nearest((n + j·per_row + i·per_column) · inverse)` at column
/// i of row j, the half included, with the inverse of the triangle's set-up.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct ValuePlanes8 {
    pub(super) n: Floats,
    pub(super) per_row: Floats,
    pub(super) per_column: Floats,
    /// Change per pixel, in the upper half.
    pub(super) step: Ints,
}

impl ValuePlanes8 {
    pub(super) const NONE: Self =
        Self { n: [0.0; LANES], per_row: [0.0; LANES], per_column: [0.0; LANES], step: [0; LANES] };

    /// Sets up the planes of these values at the corners.
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &[Ints; 3]) {
        let [v0, v1, v2] = basis.order.load(s, corners);
        let ([x, y], area) = (basis.first, basis.area);
        let value = s.to_f64(v0);
        let [gx, gy] = basis.gradient(s, [s.to_f64(s.sub_i32(v1, v0)), s.to_f64(s.sub_i32(v2, v0))]);
        // +0, not −0: its sign chooses the rounding.
        let gx = s.add(gx, s.splat_f64(0.0));
        // `ShadePlane::start`: the floor, or the ceiling of falling values, plus half a shade.
        let half = s.mul_add(area, s.splat_f64(0.5), s.splat_f64(-0.5));
        let n = s.mul(s.add(value, s.splat_f64(128.0)), area);
        let n = s.neg_mul_add(gx, x, n);
        let n = s.neg_mul_add(gy, y, n);
        s.store_f64(s.sub(n, s.xor_sign(half, gx)), &mut self.n);
        let pixel = s.splat_f64(256.0);
        let per_column = s.mul(gx, pixel);
        s.store_f64(per_column, &mut self.per_column);
        s.store_f64(s.mul(gy, pixel), &mut self.per_row);
        // Toward zero. The sum wraps, as in `ShadePlane`.
        let step = s.mul_add(s.sub(per_column, s.xor_sign(half, gx)), basis.inverse, s.splat_f64(ROUND_MAGIC));
        s.store_i32(s.shl_i32(s.low_bits(step), 16), &mut self.step);
    }
}

/// Eight triangles, ready for their rows.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleSetup8 {
    pub(super) long: Edges,
    pub(super) upper: Edges,
    pub(super) lower: Edges,
    pub(super) shade: ValuePlanes8,
    /// The reciprocal of twice the area.
    pub(super) inverse: Floats,
    /// Depth at the box's first pixel, with 32 fraction bits modulo 2⁶⁴, the half included.
    pub(super) z: [i64; LANES],
    pub(super) z_per_column: [i64; LANES],
    pub(super) z_per_row: [i64; LANES],
    /// The box's first pixel, and its offset.
    pub(super) column: Ints,
    pub(super) row: Ints,
    pub(super) at: Ints,
    /// The offset of its first cell.
    pub(super) cell: Ints,
    pub(super) rows: Ints,
    /// The first row of the lower edge.
    pub(super) split: Ints,
}

impl TriangleSetup8 {
    pub(super) const NONE: Self = Self {
        long: Edges::NONE,
        upper: Edges::NONE,
        lower: Edges::NONE,
        shade: ValuePlanes8::NONE,
        inverse: [0.0; LANES],
        z: [0; LANES],
        z_per_column: [0; LANES],
        z_per_row: [0; LANES],
        column: [0; LANES],
        row: [0; LANES],
        at: [0; LANES],
        cell: [0; LANES],
        rows: [0; LANES],
        split: [0; LANES],
    };

    /// Stores the depth plane of triangle `i`, which is too large for the eight-lane set-up.
    pub(super) fn put_depth_plane(&mut self, i: usize, plane: &DepthPlane) {
        let (column, row) = (self.column[i], self.row[i]);
        let z = plane.fixed_at(column, row);
        self.z[i] = z << 8;
        self.z_per_column[i] = plane.step() << 8;
        self.z_per_row[i] = plane.fixed_at(column, row + 1).wrapping_sub(z) << 8;
    }

    /// Sets up eight triangles whose boxes have at most 2¹⁸ pixels; on request also the depth planes of small ones, and
    /// the planes of linear shades. Returns the basis for setting up other planes.
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8>(
        &mut self,
        s: S,
        corners: &Corners8,
        (layout, has_depths): (FrameLayout, bool),
        has_planes: bool,
    ) -> Basis<S> {
        let [ax, ay] = s.halves_of_i64(s.load_i64(&corners.at[0]));
        let [bx, by] = s.halves_of_i64(s.load_i64(&corners.at[1]));
        let [cx, cy] = s.halves_of_i64(s.load_i64(&corners.at[2]));
        // The box that culling found, recomputed in eight operations for eight triangles. To pass it on, culling would
        // have to pack three more lists, and these would have to be gathered here.
        let top = s.min_i32(s.min_i32(ay, by), cy);
        let bottom = s.max_i32(s.max_i32(ay, by), cy);
        let column = first_centre_of_each(s, s.min_i32(s.min_i32(ax, bx), cx));
        let row = first_centre_of_each(s, top);
        let rows = s.sub_i32(first_centre_of_each(s, bottom), row);
        // A column and a row are below 4,096, the pitch is at most 2¹⁶.
        let down = s.sub_i32(row, s.splat_i32(layout.first_row as i32));
        let (pitch, width) = (s.splat_i32(layout.pitch as i32), s.splat_i32(layout.width as i32));
        s.store_i32(column, &mut self.column);
        s.store_i32(row, &mut self.row);
        s.store_i32(s.add_i32(s.mul_i32(down, pitch), column), &mut self.at);
        if has_depths {
            s.store_i32(s.add_i32(s.mul_i32(down, width), column), &mut self.cell);
        }

        // Top, middle and bottom corner. Ties may go either way here.
        let order = Order {
            first_is_a: s.is_equal(ay, top),
            first_is_b: s.is_equal(by, top),
            last_is_b: s.is_equal(by, bottom),
            last_is_c: s.is_equal(cy, bottom),
        };
        let half = s.splat_i32(128);
        let left = s.add_i32(s.shl_i32(column, 8), half);
        let above = s.add_i32(s.shl_i32(row, 8), half);
        let [x0, x1, x2] = order.sort(s, [ax, bx, cx]);
        let [y0, y1, y2] = order.sort(s, [ay, by, cy]);
        // Relative to the first pixel's centre, within ±2²⁰.
        let (x0, x1, x2) = (s.sub_i32(x0, left), s.sub_i32(x1, left), s.sub_i32(x2, left));
        let (y0, y1, y2) = (s.sub_i32(y0, above), s.sub_i32(y1, above), s.sub_i32(y2, above));
        s.store_i32(s.shr_i32(s.add_i32(y1, s.splat_i32(255)), 8), &mut self.split);
        let (fx0, fx1, fx2) = (s.to_f64(x0), s.to_f64(x1), s.to_f64(x2));
        let (fy0, fy1, fy2) = (s.to_f64(y0), s.to_f64(y1), s.to_f64(y2));
        let (dx1, dy1) = (s.sub(fx1, fx0), s.sub(fy1, fy0));
        let (dx2, dy2) = (s.sub(fx2, fx0), s.sub(fy2, fy0));
        self.long.set_up(s, (fx0, fy0), (dx2, dy2));
        self.upper.set_up(s, (fx0, fy0), (dx1, dy1));
        self.lower.set_up(s, (fx1, fy1), (s.sub(fx2, fx1), s.sub(fy2, fy1)));

        let signed = s.neg_mul_add(dx2, dy1, s.mul(dx1, dy2));
        let area = s.xor_sign(signed, signed);
        let inverse = s.div(s.splat_f64(1.0), area);
        let basis = Basis { order, first: [fx0, fy0], second: [dx1, dy1], third: [dx2, dy2], signed, area, inverse };
        if has_planes {
            self.shade.set_up(s, &basis, &corners.shade);
        }
        s.store_f64(inverse, &mut self.inverse);
        // Triangles without area have no rows.
        let has_area = s.is_less(s.splat_f64(0.0), area);
        s.store_i32(s.select_i32(has_area, rows, s.splat_i32(0)), &mut self.rows);

        if has_depths {
            let [d0, d1, d2] = basis.order.load(s, &corners.depth);
            let depth = s.unsigned_to_f64(d0);
            let (dd1, dd2) = (s.sub(s.unsigned_to_f64(d1), depth), s.sub(s.unsigned_to_f64(d2), depth));
            let [nx, ny] = basis.gradient(s, [dd1, dd2]);
            let gx = depth_gradient(s, nx, area, inverse);
            let gy = depth_gradient(s, ny, area, inverse);
            // The plane goes through the first corner by (y, x).
            let is_second = s.and(s.is_equal(y0, y1), s.is_greater(x0, x1));
            let (x, d) = (s.select_i32(is_second, x1, x0), s.select_i32(is_second, d1, d0));
            let moved = (i64::from(layout.depth_base) << 24) + (1 << 23);
            let z = s.add_i64(s.shl_i64(s.unsigned_to_i64(d), 24), s.splat_i64(moved));
            let z = s.sub_i64(z, s.mul_i64(gx, s.to_i64(x)));
            let z = s.sub_i64(z, s.mul_i64(gy, s.to_i64(y0)));
            s.store_i64(s.shl_i64(z, 8), &mut self.z);
            s.store_i64(s.shl_i64(gx, 16), &mut self.z_per_column);
            s.store_i64(s.shl_i64(gy, 16), &mut self.z_per_row);
        }
        basis
    }
}

/// The basis for setting up planes over eight triangles. All values except the last are integers.
pub(super) struct Basis<S: Lanes8> {
    pub(super) order: Order<S>,
    /// The first corner by height, relative to the centre of the box's first pixel.
    pub(super) first: [S::F64; 2],
    /// The other corners, relative to the first.
    pub(super) second: [S::F64; 2],
    pub(super) third: [S::F64; 2],
    /// Twice the area, negative if the second corner lies left of the edge from the first to the third.
    pub(super) signed: S::F64,
    pub(super) area: S::F64,
    pub(super) inverse: S::F64,
}

impl<S: Lanes8> Basis<S> {
    /// `SortedTriangle::gradient` of a value, from its differences between the first corner and the second and the
    /// third.
    #[inline(always)]
    pub(super) fn gradient(&self, s: S, [d1, d2]: [S::F64; 2]) -> [S::F64; 2] {
        let ([dx1, dy1], [dx2, dy2]) = (self.second, self.third);
        let gx = s.xor_sign(s.neg_mul_add(d2, dy1, s.mul(d1, dy2)), self.signed);
        [gx, s.xor_sign(s.neg_mul_add(d1, dx2, s.mul(d2, dx1)), self.signed)]
    }

    /// The planes of a value times the area, given at the corners by height: at the box's first pixel, and its changes
    /// per row and per column. Products and sums are rounded: see [`conditions`](Self::conditions).
    #[inline(always)]
    pub(super) fn plane(&self, s: S, [a, b, c]: [S::F64; 3]) -> [S::F64; 3] {
        let ([x, y], pixel) = (self.first, s.splat_f64(256.0));
        let [gx, gy] = self.gradient(s, [s.sub(b, a), s.sub(c, a)]);
        let at_first = s.neg_mul_add(gy, y, s.neg_mul_add(gx, x, s.mul(a, self.area)));
        [at_first, s.mul(gy, pixel), s.mul(gx, pixel)]
    }

    /// How accurate [planes](Self::plane) are. For a value of up to V at the corners, each rounded once, a box of W × H
    /// units, ε = 2⁻⁵³, and B = W·H·V, in units of εB:
    ///
    /// | | magnitude | off by |
    /// |---|---:|---:|
    /// | change over the box's width, or its height: two products of differences, and a sum | 2 | 14 |
    /// | at the first pixel: a corner's value times the area, less a change over its column and one over its row | 5 | 42 |
    /// | with rows added | 7 | 65 |
    /// | with columns added up to a span's start, and from there to a pixel: no more than the box has | 9 | 101 |
    ///
    /// Let Q bound a quotient of two such sums, where the divisor sums depths from v to V. The numerator's B is then at
    /// most Q times the divisor's, and the divisor at a pixel at least the area A times v. So with X = W·H·V / (A·v)
    /// the quotient is off by 202·ε·Q·X for each unit of Q's. Returns numerator and denominator of X, given the depths.
    #[inline(always)]
    pub(super) fn conditions(&self, s: S, [least, greatest]: [S::F64; 2]) -> [S::F64; 2] {
        let [width, height] = self.sides(s);
        [s.mul(s.mul(width, height), greatest), s.mul(self.area, least)]
    }

    /// Width and height of the box.
    #[inline(always)]
    pub(super) fn sides(&self, s: S) -> [S::F64; 2] {
        let ([dx1, _], [dx2, height], zero) = (self.second, self.third, s.splat_f64(0.0));
        [s.sub(s.max(s.max(dx1, dx2), zero), s.min(s.min(dx1, dx2), zero)), height]
    }

    /// Depths of the corners, by height; each counts as at least 1.
    #[inline(always)]
    pub(super) fn depths(&self, s: S, corners: &Corners8) -> [S::F64; 3] {
        three(
            self.order.load(s, &corners.depth),
            #[inline(always)]
            |depth| s.max(s.unsigned_to_f64(depth), s.splat_f64(1.0)),
        )
    }

    /// Change of a corner's weight per 1/256 pixel; then its weight at the box's first pixel, with
    /// its change per row and per column. All are exact whole numbers. Corners are numbered by
    /// height.
    #[inline(always)]
    pub(super) fn weight(&self, s: S, corner: usize) -> (S::F64, [S::F64; 3]) {
        let ([x, y], pixel, zero) = (self.first, s.splat_f64(256.0), s.splat_f64(0.0));
        let (one, minus_one) = (s.splat_f64(1.0), s.splat_f64(-1.0));
        // The weight at the second and at the third corner, less that at the first, in units of the area.
        let differences = [[minus_one, minus_one], [one, zero], [zero, one]];
        let [gx, gy] = self.gradient(s, differences[corner % 3]);
        let at_first = if corner == 0 { self.area } else { zero };
        let n = s.neg_mul_add(gx, x, s.neg_mul_add(gy, y, at_first));
        (gx, [n, s.mul(gy, pixel), s.mul(gx, pixel)])
    }
}

/// Which corners are the first and the last by height.
pub(super) struct Order<S: Lanes8> {
    first_is_a: S::Mask,
    first_is_b: S::Mask,
    last_is_b: S::Mask,
    last_is_c: S::Mask,
}

impl<S: Lanes8> Order<S> {
    /// The values of corners, in the order of heights.
    #[inline(always)]
    pub(super) fn load(&self, s: S, [a, b, c]: &[Ints; 3]) -> [S::I32; 3] {
        self.sort(s, [s.load_i32(a), s.load_i32(b), s.load_i32(c)])
    }

    /// A value of each corner, in the order of heights.
    #[inline(always)]
    pub(super) fn sort(&self, s: S, [a, b, c]: [S::I32; 3]) -> [S::I32; 3] {
        let first = s.select_i32(self.first_is_a, a, s.select_i32(self.first_is_b, b, c));
        let last = s.select_i32(self.last_is_c, c, s.select_i32(self.last_is_b, b, a));
        // The remaining one. Sums wrap.
        let middle = s.sub_i32(s.sub_i32(s.add_i32(s.add_i32(a, b), c), first), last);
        [first, middle, last]
    }
}

/// The least and the greatest of three.
#[inline(always)]
pub(super) fn ends<S: Lanes8>(s: S, [a, b, c]: [S::F64; 3]) -> [S::F64; 2] {
    [s.min(s.min(a, b), c), s.max(s.max(a, b), c)]
}

/// Gradients with 24 fraction bits from numerators, areas and their inverses; arbitrary for a triangle without area.
#[inline(always)]
fn depth_gradient<S: Lanes8>(s: S, n: S::F64, area: S::F64, inverse: S::F64) -> S::I64 {
    let magic = s.splat_f64(ROUND_MAGIC);
    let integer = s.mul_add(n, inverse, magic);
    let rest = s.neg_mul_add(s.sub(integer, magic), area, n);
    let part = s.mul_add(s.mul_add(rest, s.splat_f64(16_777_216.0), s.splat_f64(0.25)), inverse, magic);
    // The magic number's bits are shifted out of the first sum. Wrapping is intended: see `reference::depth`.
    s.add_i64(s.shl_i64(s.bits(integer), 24), s.sub_i64(s.bits(part), s.bits(magic)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::pick::{MAX_COLUMNS, MAX_ROWS};
    use super::super::reference::cover::SortedTriangle;
    use super::super::vertex::Vertex;
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::columns::ScreenPos;
    use crate::simd::compiled_for_each_level;
    use crate::span::Kernel;

    fn depth() -> impl Strategy<Value = u32> {
        let end = prop::sample::select(&[0, 1, 1 << 30, u32::MAX - 1, u32::MAX][..]);
        let near = (1_u32 << 29)..(1 << 29) + 5_000;
        prop_oneof![3 => any::<u32>(), 6 => near, 2 => 1_u32..1 << 30, 1 => end]
    }

    /// A corner within a box of this many units.
    fn corner(width: i32, height: i32) -> BoxedStrategy<(i32, i32, u32)> {
        let at = |most: i32| prop_oneof![4 => 0..=most, 1 => Just(0), 1 => Just(most)];
        (at(width), at(height), depth()).boxed()
    }

    fn triangle() -> BoxedStrategy<[(i32, i32, u32); 3]> {
        let (width, height) = (MAX_COLUMNS * 256, MAX_ROWS * 256);
        let sizes = prop_oneof![2 => Just((width, height)), 2 => Just((600, 600)), 2 => Just((40, 40)), 1 => Just((3, 3)),
            1 => Just((width, 4)), 1 => Just((4, height))];
        let corners = sizes.prop_flat_map(|(w, h)| [corner(w, h), corner(w, h), corner(w, h)]);
        let place = (-(1_i32 << 20)..=(1 << 20) - width, -(1_i32 << 20)..=(1 << 20) - height);
        let place = prop_oneof![3 => (0_i32..50_000, 0_i32..30_000), 1 => place];
        (corners, place).prop_map(|(corners, (left, top))| corners.map(|(x, y, d)| (left + x, top + y, d))).boxed()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// Depths and steps equal those of the plane computed in integers, to the bit, at every level.
        #[test]
        fn eight_planes_are_each_its_own(triangles in prop::collection::vec(triangle(), LANES), width in 1_u32..=4_096, depth_base in prop_oneof![Just(0), any::<u32>()]) {
            let mut corners = Corners8::NONE;
            for (lane, of_triangle) in triangles.iter().enumerate() {
                for (corner, &(x, y, d)) in of_triangle.iter().enumerate() {
                    corners.at[corner][lane] = u64::from(ScreenPos::new(x, y)).cast_signed();
                    corners.depth[corner][lane] = d.cast_signed();
                }
            }
            let layout = FrameLayout { first_row: 3, pitch: width + 5, width, depth_base };
            for kernel in Kernel::available() {
                let mut setup = TriangleSetup8::NONE;
                set_up(kernel.simd_level(), &mut setup, &corners, layout);
                for (lane, corners) in triangles.iter().enumerate() {
                    let [a, b, c] = corners.map(|(x, y, _)| (i64::from(x), i64::from(y)));
                    if (b.0 - a.0) * (c.1 - a.1) == (c.0 - a.0) * (b.1 - a.1) {
                        prop_assert_eq!(setup.rows[lane], 0);
                        continue;
                    }
                    let vertices = corners.map(|(x, y, depth)| {
                        Vertex::of_projected(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::default(), depth)
                    });
                    let plane = DepthPlane::new(&SortedTriangle::new(&vertices)).raised_by(depth_base);
                    let (column, row) = (setup.column[lane], setup.row[lane]);
                    prop_assert_eq!(setup.cell[lane], (row - 3) * width as i32 + column);
                    for j in 0..=MAX_ROWS {
                        for i in [0, 1, 17, MAX_COLUMNS] {
                            let z = setup.z[lane]
                                .wrapping_add(setup.z_per_column[lane].wrapping_mul(i.into()))
                                .wrapping_add(setup.z_per_row[lane].wrapping_mul(j.into()));
                            prop_assert_eq!(z, plane.fixed_at(column + i, row + j) << 8);
                        }
                    }
                    prop_assert_eq!(setup.z_per_column[lane], plane.step() << 8);
                }
            }
        }
    }

    compiled_for_each_level! {
        fn set_up[][](setup: &mut TriangleSetup8, corners: &Corners8, layout: FrameLayout) = set_up_by;
    }

    #[inline(always)]
    fn set_up_by<S: Lanes8>(s: S, setup: &mut TriangleSetup8, corners: &Corners8, layout: FrameLayout) {
        setup.set_up(s, corners, (layout, true), true);
    }
}
