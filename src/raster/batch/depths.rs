//! The depth planes of eight small triangles at a time.
//!
//! Those of [`DepthPlane`](crate::raster::depth::DepthPlane), whose gradients are
//!
//! ```text
//! g = floor((2²⁴·n + (A >> 1)) / A)        n: the numerator, A: twice the area
//! ```
//!
//! in two quotients of f64: for any whole q
//!
//! ```text
//! q = nearest(n / A), or beside it        r = n − q·A        g = 2²⁴·q + nearest(2²⁴·r / A), halves upward
//! ```
//!
//! (An odd A has no halves, and the half of it that is dropped changes no floor.) A small triangle's box is less
//! than 65 × 17 pixels, so A is below 2²⁶·¹² and |n| below 2⁴⁸: n, q·A and r are exact, and |r| is at most 0.52·A. The last
//! quotient is taken of 2²⁴·r + ¼, which is exact, too, so that what is rounded lies at least 1/(4A), more than 2⁻²⁸·¹², from
//! the middle between two whole numbers. It is below 2²³·¹, and off by at most 2⁻⁵² of that: less than 2⁻²⁸·⁹.

use super::rows::{Floats, Gathered, Group, LANES, MAGIC, Place};
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
use crate::raster::depth::DepthPlane;
use crate::span::list::Depths;

/// Depths of eight triangles, with 24 fraction bits, modulo 2⁶⁴.
pub(super) struct Planes {
    /// At the first pixel of the box, the half included.
    pub(super) at: [i64; LANES],
    pub(super) per_column: [i64; LANES],
    pub(super) per_row: [i64; LANES],
}

impl Planes {
    /// Puts that of triangle `i` of a group, which is worked out alone, in its place.
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    pub(super) fn put(&mut self, i: usize, group: &Group, plane: &DepthPlane) {
        let (column, row) = (group.column[i], group.row[i]);
        self.at[i] = plane.fixed_at(column, row);
        self.per_column[i] = plane.step();
        self.per_row[i] = plane.fixed_at(column, row + 1).wrapping_sub(self.at[i]);
    }

    /// The planes of the small triangles of a group that is set up.
    #[inline(always)]
    pub(super) fn of(gathered: &Gathered, group: &Group) -> Self {
        let Gathered { x, y, depth, .. } = gathered;
        let mut planes = Self { at: [0; LANES], per_column: [0; LANES], per_row: [0; LANES] };
        let (mut gx, mut gy) = ([0; LANES], [0; LANES]);
        let (mut area, mut nx, mut ny): (Floats, Floats, Floats) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let (dx1, dy1) = (f64::from(x[1][i] - x[0][i]), f64::from(y[1][i] - y[0][i]));
            let (dx2, dy2) = (f64::from(x[2][i] - x[0][i]), f64::from(y[2][i] - y[0][i]));
            let d = f64::from(depth[0][i]);
            let (dd1, dd2) = (f64::from(depth[1][i]) - d, f64::from(depth[2][i]) - d);
            let signed = dx1 * dy2 - dx2 * dy1;
            let sign = if signed < 0.0 { -1.0 } else { 1.0 };
            area[i] = signed * sign;
            nx[i] = (dd1 * dy2 - dd2 * dy1) * sign;
            ny[i] = (dd2 * dx1 - dd1 * dx2) * sign;
        }
        gradients(&nx, &area, &group.inverse, &mut gx);
        gradients(&ny, &area, &group.inverse, &mut gy);
        let (mut right, mut down, mut of_first) = ([0; LANES], [0; LANES], [0_u32; LANES]);
        for i in 0..LANES {
            // The first corner by (y, x), in masks: −1 or 0.
            let (mut fx, mut fy, mut d) = (x[0][i], y[0][i], depth[0][i].cast_signed());
            for corner in 1..3 {
                let (cx, cy) = (x[corner][i], y[corner][i]);
                let is_before = -i32::from(cy < fy) | (-i32::from(cy == fy) & -i32::from(cx < fx));
                fx ^= (fx ^ cx) & is_before;
                fy ^= (fy ^ cy) & is_before;
                d ^= (d ^ depth[corner][i].cast_signed()) & is_before;
            }
            right[i] = group.column[i] * 256 + 128 - fx;
            down[i] = group.row[i] * 256 + 128 - fy;
            of_first[i] = d.cast_unsigned();
        }
        for i in 0..LANES {
            let sum = (i64::from(of_first[i]) << 24) + (1 << 23);
            let (right, down) = (i64::from(right[i]), i64::from(down[i]));
            planes.at[i] = sum.wrapping_add(gx[i].wrapping_mul(right)).wrapping_add(gy[i].wrapping_mul(down));
            (planes.per_column[i], planes.per_row[i]) = (gx[i] << 8, gy[i] << 8);
        }
        planes
    }

    /// Down the rows of triangle `i`, from the box's first.
    #[inline(always)]
    pub(super) fn walk(&self, i: usize, group: &Group, place: Place, width: u32) -> Walk {
        // Offsets of a frame's pixels are below 2²⁸, columns and rows below 4,096.
        let width = width as i32;
        Walk {
            z: self.at[i],
            pixel: group.at[i],
            cell: (group.row[i] - place.first_row as i32) * width + group.column[i],
            per_column: self.per_column[i],
            per_row: self.per_row[i],
            pitch: place.pitch as i32,
            width,
        }
    }
}

/// The depth at the box's first column in a row, and where that lies.
pub(super) struct Walk {
    z: i64,
    pixel: i32,
    cell: i32,
    per_column: i64,
    per_row: i64,
    pitch: i32,
    width: i32,
}

impl Walk {
    /// The depths of a span of this row that starts at this offset in the frame.
    #[inline(always)]
    pub(super) fn at(&self, pixel: i32) -> Depths {
        let column = pixel.wrapping_sub(self.pixel);
        Depths {
            at: self.cell.wrapping_add(column) as u32,
            z: self.z.wrapping_add(self.per_column.wrapping_mul(i64::from(column))),
            dz: self.per_column,
        }
    }

    /// Steps to the next row.
    #[inline(always)]
    pub(super) fn down(&mut self) {
        self.z = self.z.wrapping_add(self.per_row);
        self.pixel = self.pixel.wrapping_add(self.pitch);
        self.cell = self.cell.wrapping_add(self.width);
    }
}

/// Gradients from numerators, areas and the inverses of these; any number for a triangle without area.
#[inline(always)]
fn gradients(numerators: &Floats, areas: &Floats, inverses: &Floats, gradients: &mut [i64; LANES]) {
    for i in 0..LANES {
        let (n, area, inverse) = (numerators[i], areas[i], inverses[i]);
        let whole = n * inverse + MAGIC;
        let rest = n - (whole - MAGIC) * area;
        let part = (rest * 16_777_216.0 + 0.25) * inverse + MAGIC;
        let bits = |sum: f64| sum.to_bits().wrapping_sub(MAGIC.to_bits()).cast_signed();
        // The wrap is meant: see `raster::depth`.
        gradients[i] = (bits(whole) << 24).wrapping_add(bits(part));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::rows::{MAX_COLUMNS, MAX_ROWS, Spans, set_up};
    use super::*;
    use crate::raster::depth::DepthPlane;

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
        /// Depths and steps are those of the plane that is worked out in integers, to the bit.
        #[test]
        fn eight_planes_are_each_its_own(triangles in prop::collection::vec(triangle(), LANES), width in 1_u32..=4_096) {
            let mut gathered = Gathered { x: [[0; LANES]; 3], y: [[0; LANES]; 3], shade: [[0; LANES]; 3], depth: [[0; LANES]; 3] };
            for (lane, corners) in triangles.iter().enumerate() {
                for (corner, &(x, y, d)) in corners.iter().enumerate() {
                    (gathered.x[corner][lane], gathered.y[corner][lane], gathered.depth[corner][lane]) = (x, y, d);
                }
            }
            let place = Place { first_row: 3, pitch: width + 5, depth_width: Some(width) };
            let mut spans = Spans::new(&mut []);
            set_up::<false>(&gathered, place, &mut spans.group);
            let group = &spans.group;
            let planes = Planes::of(&gathered, group);
            for (lane, corners) in triangles.into_iter().enumerate() {
                let [a, b, c] = corners.map(|(x, y, _)| (i64::from(x), i64::from(y)));
                if (b.0 - a.0) * (c.1 - a.1) == (c.0 - a.0) * (b.1 - a.1) {
                    continue;
                }
                let plane = DepthPlane::of_corners(corners);
                let mut walk = planes.walk(lane, group, place, width);
                let mut pixel = group.at[lane];
                for row in 0..=MAX_ROWS {
                    for column in [0, 1, 17, MAX_COLUMNS] {
                        let depths = walk.at(pixel.wrapping_add(column));
                        prop_assert_eq!(depths.z, plane.fixed_at(group.column[lane] + column, group.row[lane] + row));
                        prop_assert_eq!(depths.dz, plane.step());
                        let at = (group.row[lane] + row - 3) * width as i32 + group.column[lane] + column;
                        prop_assert_eq!(depths.at, at as u32);
                    }
                    walk.down();
                    pixel = pixel.wrapping_add(place.pitch as i32);
                }
            }
        }
    }
}
