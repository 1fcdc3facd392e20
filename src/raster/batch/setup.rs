//! Set-up of eight triangles: edges, shade planes and depth planes from their corners.
//!
//! Coordinates are taken from the centre of the box's first pixel, so all numbers are small, and f64 holds every
//! numerator exactly. A quotient is a product with the divisor's reciprocal, and its floor is exact by a margin:
//! for integers n and d
//!
//! ```text
//! floor(n / d) = nearest((n + ½ − d/2) / d)
//! ```
//!
//! where what is rounded lies at least 1/(2d) from the middle between two integers. The reciprocal and the
//! product are each off by at most one part in 2⁵³: for a shade, below 2¹⁶, by 2⁻³⁶ together. A box of at most
//! 2¹⁸ pixels has 2³⁴ square units, and twice the area is no more, so the margin is at least 2⁻³⁵. A column is below 2¹⁰,
//! its divisor at most 2²⁸: margin 2⁻²⁹, off by 2⁻⁴². (n + ½ − d/2 is exact: a multiple of ½ below 2⁵². A gradient's
//! numerator is below 2¹⁶ times the box's height or width, so each of the terms of n, and n at any pixel of the
//! triangle, is below 2⁵⁰; and no more than three are ever in a sum.) A step has any size, but below 2⁴⁴ / d, so it is
//! off by less than 2⁻⁸ / d. The integer is found by adding 1.5 · 2⁵², which leaves it in the low bits. So there is no
//! correction, no branch, and the same result on every processor; a sum of a product that is rounded once, where the
//! level has FMA, is nearer than one that is rounded twice.
//!
//! Depth planes are those of [`DepthPlane`], whose gradients are
//!
//! ```text
//! g = floor((2²⁴·n + (A >> 1)) / A)        n: the numerator, A: twice the area
//! ```
//!
//! in two quotients of f64: for any integer q
//!
//! ```text
//! q = nearest(n / A), or beside it        r = n − q·A        g = 2²⁴·q + nearest(2²⁴·r / A), halves upward
//! ```
//!
//! (An odd A has no halves, and the half of it that is dropped changes no floor.) A small triangle's box is less
//! than 65 × 17 pixels, so A is below 2²⁶·¹² and |n| below 2⁴⁸: n, q·A and r are exact, and |r| is at most 0.52·A. The last
//! quotient is taken of 2²⁴·r + ¼, which is exact, too, so that what is rounded lies at least 1/(4A), more than 2⁻²⁸·¹², from
//! the middle between two integers. It is below 2²³·¹, and off by at most 2⁻⁵² of that: less than 2⁻²⁸·⁹.

use super::cull::ClassedIndex;
use super::{Batch, FrameLayout};
use crate::fixed::ROUND_MAGIC;
use crate::raster::depth::DepthPlane;
use crate::simd::Lanes8;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
use crate::span::LargeTriangle;

/// Triangles at a time, or rows of one.
pub(super) const LANES: usize = 8;

pub(super) type Floats = [f64; LANES];
pub(super) type Ints = [i32; LANES];

/// Corners of eight triangles. Lanes without a triangle hold any values.
pub(super) struct Corners8 {
    pub(super) x: [Ints; 3],
    pub(super) y: [Ints; 3],
    pub(super) shade: [Ints; 3],
    /// The bits of u32.
    pub(super) depth: [Ints; 3],
}

impl Corners8 {
    pub(super) const NONE: Self =
        Self { x: [[0; LANES]; 3], y: [[0; LANES]; 3], shade: [[0; LANES]; 3], depth: [[0; LANES]; 3] };

    /// Reads the first eight of these triangles, a [`ClassedIndex`] each, their depths only with `DEPTHS`.
    #[inline(always)]
    pub(super) fn gather<const DEPTHS: bool>(&mut self, batch: &Batch, triangles: &[u32]) {
        // Faces that were culled before are mostly all kept.
        if let Some([first, .., last]) = triangles.first_chunk::<LANES>()
            && ClassedIndex(*last).index() == ClassedIndex(*first).index() + LANES - 1
        {
            let first = ClassedIndex(*first).index().min(Batch::CAPACITY - LANES);
            let eight = first..first + LANES;
            for corner in 0..3 {
                self.x[corner].copy_from_slice(&batch.x[corner][eight.clone()]);
                self.y[corner].copy_from_slice(&batch.y[corner][eight.clone()]);
                for (to, &shade) in self.shade[corner].iter_mut().zip(&batch.shade[corner][eight.clone()]) {
                    *to = i32::from(shade);
                }
                if DEPTHS {
                    for (to, depth) in self.depth[corner].iter_mut().zip(&batch.depth[corner][eight.clone()]) {
                        *to = depth.cast_signed();
                    }
                }
            }
            return;
        }
        for (lane, &triangle) in triangles.iter().take(LANES).enumerate() {
            let at = ClassedIndex(triangle).index();
            for corner in 0..3 {
                self.x[corner][lane] = batch.x[corner][at];
                self.y[corner][lane] = batch.y[corner][at];
                self.shade[corner][lane] = i32::from(batch.shade[corner][at]);
                if DEPTHS {
                    self.depth[corner][lane] = batch.depth[corner][at].cast_signed();
                }
            }
        }
    }
}

/// An edge: the first pixel on it or right of it in row j is `nearest((n + j·per_row) · inverse)`.
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
        // x = (ax·dy + dx·(256·j − ay)) / (256·dy), rounded up: the floor of one unit less, plus one.
        // Along a row, where dy is 0, what comes out is not used.
        let n = s.mul_add(dy, s.all_f64(128.0), s.all_f64(-0.5));
        let n = s.mul_add(x, dy, n);
        s.put_f64s(s.neg_mul_add(dx, y, n), &mut self.n);
        let pixel = s.all_f64(256.0);
        s.put_f64s(s.mul(dx, pixel), &mut self.per_row);
        s.put_f64s(s.div(s.all_f64(1.0), s.mul(dy, pixel)), &mut self.inverse);
    }
}

/// Eight triangles, ready for their rows.
#[repr(C, align(64))]
pub(super) struct TriangleSetup8 {
    pub(super) long: Edges,
    pub(super) upper: Edges,
    pub(super) lower: Edges,
    /// Shades: `nearest((n + j·per_row + i·per_column) · inverse)`.
    pub(super) shade_n: Floats,
    pub(super) shade_per_row: Floats,
    pub(super) shade_per_column: Floats,
    pub(super) shade_inverse: Floats,
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
    /// In the upper half.
    pub(super) step: Ints,
}

impl TriangleSetup8 {
    pub(super) const NONE: Self = Self {
        long: Edges::NONE,
        upper: Edges::NONE,
        lower: Edges::NONE,
        shade_n: [0.0; LANES],
        shade_per_row: [0.0; LANES],
        shade_per_column: [0.0; LANES],
        shade_inverse: [0.0; LANES],
        z: [0; LANES],
        z_per_column: [0; LANES],
        z_per_row: [0; LANES],
        column: [0; LANES],
        row: [0; LANES],
        at: [0; LANES],
        cell: [0; LANES],
        rows: [0; LANES],
        split: [0; LANES],
        step: [0; LANES],
    };

    /// Puts the depth plane of triangle `i`, which is too large for eight at a time, in its place.
    pub(super) fn put_depth_plane(&mut self, i: usize, plane: &DepthPlane) {
        let (column, row) = (self.column[i], self.row[i]);
        let z = plane.fixed_at(column, row);
        self.z[i] = z << 8;
        self.z_per_column[i] = plane.step() << 8;
        self.z_per_row[i] = plane.fixed_at(column, row + 1).wrapping_sub(z) << 8;
    }

    /// Triangle `i` alone.
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    pub(super) fn large_triangle(&self, i: usize, layout: FrameLayout, reseeds: bool) -> LargeTriangle {
        let edge = |edges: &Edges| [edges.n[i], edges.per_row[i], edges.inverse[i]];
        LargeTriangle {
            long: edge(&self.long),
            upper: edge(&self.upper),
            lower: edge(&self.lower),
            shade: [self.shade_n[i], self.shade_per_row[i], self.shade_inverse[i]],
            per_column: self.shade_per_column[i],
            at: self.at[i],
            // At most 2¹⁶.
            pitch: layout.pitch as i32,
            rows: self.rows[i],
            split: self.split[i],
            // The upper half.
            step: (self.step[i] >> 16) as u16,
            reseeds,
        }
    }

    /// Sets up eight triangles of which no box has more than 2¹⁸ pixels; with `DEPTHS` the depth planes of small ones, too.
    #[inline(always)]
    pub(super) fn set_up<S: Lanes8, const DEPTHS: bool>(&mut self, s: S, corners: &Corners8, layout: FrameLayout) {
        let [ax, bx, cx] = [s.i32s(&corners.x[0]), s.i32s(&corners.x[1]), s.i32s(&corners.x[2])];
        let [ay, by, cy] = [s.i32s(&corners.y[0]), s.i32s(&corners.y[1]), s.i32s(&corners.y[2])];
        let top = s.min_i32(s.min_i32(ay, by), cy);
        let bottom = s.max_i32(s.max_i32(ay, by), cy);
        let column = first_centre(s, s.min_i32(s.min_i32(ax, bx), cx));
        let row = first_centre(s, top);
        let rows = s.sub_i32(first_centre(s, bottom), row);
        // A column and a row are below 4,096, the pitch is at most 2¹⁶.
        let down = s.sub_i32(row, s.all_i32(layout.first_row as i32));
        let (pitch, width) = (s.all_i32(layout.pitch as i32), s.all_i32(layout.width as i32));
        s.put_i32s(column, &mut self.column);
        s.put_i32s(row, &mut self.row);
        s.put_i32s(s.add_i32(s.mul_i32(down, pitch), column), &mut self.at);
        if DEPTHS {
            s.put_i32s(s.add_i32(s.mul_i32(down, width), column), &mut self.cell);
        }

        // Top, middle and bottom corner. Which of two at the same height comes first is of no matter here.
        let order = Order {
            first_is_a: s.is_equal(ay, top),
            first_is_b: s.is_equal(by, top),
            last_is_b: s.is_equal(by, bottom),
            last_is_c: s.is_equal(cy, bottom),
        };
        let half = s.all_i32(128);
        let left = s.add_i32(s.shl_i32(column, 8), half);
        let above = s.add_i32(s.shl_i32(row, 8), half);
        let [x0, x1, x2] = order.sort(s, [ax, bx, cx]);
        let [y0, y1, y2] = order.sort(s, [ay, by, cy]);
        let [s0, s1, s2] =
            order.sort(s, [s.i32s(&corners.shade[0]), s.i32s(&corners.shade[1]), s.i32s(&corners.shade[2])]);
        // From the first pixel's centre, within ±2²⁰.
        let (x0, x1, x2) = (s.sub_i32(x0, left), s.sub_i32(x1, left), s.sub_i32(x2, left));
        let (y0, y1, y2) = (s.sub_i32(y0, above), s.sub_i32(y1, above), s.sub_i32(y2, above));
        s.put_i32s(s.sar_i32(s.add_i32(y1, s.all_i32(255)), 8), &mut self.split);
        let (fx0, fx1, fx2) = (s.to_f64(x0), s.to_f64(x1), s.to_f64(x2));
        let (fy0, fy1, fy2) = (s.to_f64(y0), s.to_f64(y1), s.to_f64(y2));
        let (dx1, dy1) = (s.sub(fx1, fx0), s.sub(fy1, fy0));
        let (dx2, dy2) = (s.sub(fx2, fx0), s.sub(fy2, fy0));
        self.long.set_up(s, (fx0, fy0), (dx2, dy2));
        self.upper.set_up(s, (fx0, fy0), (dx1, dy1));
        self.lower.set_up(s, (fx1, fy1), (s.sub(fx2, fx1), s.sub(fy2, fy1)));

        // `SortedTriangle::gradient`.
        let signed = s.neg_mul_add(dx2, dy1, s.mul(dx1, dy2));
        let area = s.flip(signed, signed);
        let inverse = s.div(s.all_f64(1.0), area);
        let shade = s.to_f64(s0);
        let (ds1, ds2) = (s.to_f64(s.sub_i32(s1, s0)), s.to_f64(s.sub_i32(s2, s0)));
        // +0 and no −0: its sign chooses the rounding.
        let gx = s.add(s.flip(s.neg_mul_add(ds2, dy1, s.mul(ds1, dy2)), signed), s.all_f64(0.0));
        let gy = s.flip(s.neg_mul_add(ds1, dx2, s.mul(ds2, dx1)), signed);
        // `ShadePlane::start`: the floor, or the ceiling of falling shades, and half a shade.
        let half = s.mul_add(area, s.all_f64(0.5), s.all_f64(-0.5));
        let n = s.mul(s.add(shade, s.all_f64(128.0)), area);
        let n = s.neg_mul_add(gx, fx0, n);
        let n = s.neg_mul_add(gy, fy0, n);
        s.put_f64s(s.sub(n, s.flip(half, gx)), &mut self.shade_n);
        let pixel = s.all_f64(256.0);
        let per_column = s.mul(gx, pixel);
        s.put_f64s(per_column, &mut self.shade_per_column);
        s.put_f64s(s.mul(gy, pixel), &mut self.shade_per_row);
        s.put_f64s(inverse, &mut self.shade_inverse);
        // Toward zero. The wrap is meant, as in `ShadePlane`.
        let magic = s.all_f64(ROUND_MAGIC);
        let step = s.mul_add(s.sub(per_column, s.flip(half, gx)), inverse, magic);
        s.put_i32s(s.shl_i32(s.low_bits(step), 16), &mut self.step);
        // Without an area no rows.
        let has_area = s.is_less(s.all_f64(0.0), area);
        s.put_i32s(s.select_i32(has_area, rows, s.all_i32(0)), &mut self.rows);

        if DEPTHS {
            let [d0, d1, d2] =
                order.sort(s, [s.i32s(&corners.depth[0]), s.i32s(&corners.depth[1]), s.i32s(&corners.depth[2])]);
            let depth = s.unsigned_to_f64(d0);
            let (dd1, dd2) = (s.sub(s.unsigned_to_f64(d1), depth), s.sub(s.unsigned_to_f64(d2), depth));
            let nx = s.flip(s.neg_mul_add(dd2, dy1, s.mul(dd1, dy2)), signed);
            let ny = s.flip(s.neg_mul_add(dd1, dx2, s.mul(dd2, dx1)), signed);
            let gx = depth_gradient(s, nx, area, inverse);
            let gy = depth_gradient(s, ny, area, inverse);
            // The plane is that through the first corner by (y, x).
            let is_second = s.both(s.is_equal(y0, y1), s.is_greater(x0, x1));
            let (x, d) = (s.select_i32(is_second, x1, x0), s.select_i32(is_second, d1, d0));
            let z = s.add_i64(s.shl_i64(s.unsigned_to_i64(d), 24), s.all_i64(1 << 23));
            let z = s.sub_i64(z, s.mul_i64(gx, s.to_i64(x)));
            let z = s.sub_i64(z, s.mul_i64(gy, s.to_i64(y0)));
            s.put_i64s(s.shl_i64(z, 8), &mut self.z);
            s.put_i64s(s.shl_i64(gx, 16), &mut self.z_per_column);
            s.put_i64s(s.shl_i64(gy, 16), &mut self.z_per_row);
        }
    }
}

/// Which corners are the first and the last by height.
struct Order<S: Lanes8> {
    first_is_a: S::Mask,
    first_is_b: S::Mask,
    last_is_b: S::Mask,
    last_is_c: S::Mask,
}

impl<S: Lanes8> Order<S> {
    /// A number of each corner, in the order of heights.
    #[inline(always)]
    fn sort(&self, s: S, [a, b, c]: [S::I32; 3]) -> [S::I32; 3] {
        let first = s.select_i32(self.first_is_a, a, s.select_i32(self.first_is_b, b, c));
        let last = s.select_i32(self.last_is_c, c, s.select_i32(self.last_is_b, b, a));
        // What is left. Sums wrap.
        let middle = s.sub_i32(s.sub_i32(s.add_i32(s.add_i32(a, b), c), first), last);
        [first, middle, last]
    }
}

/// `I24F8::first_centre`, of coordinates of at most 2²⁰.
#[inline(always)]
pub(super) fn first_centre<S: Lanes8>(s: S, units: S::I32) -> S::I32 {
    s.sar_i32(s.add_i32(units, s.all_i32(127)), 8)
}

/// Gradients with 24 fraction bits from numerators, areas and the inverses of these; any number for a triangle without
/// area.
#[inline(always)]
fn depth_gradient<S: Lanes8>(s: S, n: S::F64, area: S::F64, inverse: S::F64) -> S::I64 {
    let magic = s.all_f64(ROUND_MAGIC);
    let integer = s.mul_add(n, inverse, magic);
    let rest = s.neg_mul_add(s.sub(integer, magic), area, n);
    let part = s.mul_add(s.mul_add(rest, s.all_f64(16_777_216.0), s.all_f64(0.25)), inverse, magic);
    // Of the first sum the bits of the magic number are shifted out. The wrap is meant: see `raster::depth`.
    s.add_i64(s.shl_i64(s.bits(integer), 24), s.sub_i64(s.bits(part), s.bits(magic)))
}
