//! Culls back faces and triangles that cover no pixel centre, many at a time, by corner positions
//! alone. Most triangles of a detailed model end here. The others are assigned the class by which
//! they are set up.

use super::columns::ScreenPos;
use super::fill_rule::{cover_none_of_four, first_centre_of_each};
use super::frame::Rect;
use super::pick::{CHUNK, MAX_AREA_4X4, MAX_COLUMNS, MAX_HEIGHT, MAX_ROWS, MAX_WIDTH, Pick};
use crate::fixed::HAS_F64;
use crate::lanes::{LANES, NUMBERS, each, three};
use crate::simd::{Lanes8, Packed, compiled_for_each_level};

/// The longest box side, in pixels, of a triangle whose pixels are tested one by one.
pub(crate) const TINY_SIDE: i32 = 2;

/// Results for up to 64 triangles, one bit each, the first lowest.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct CullMasks {
    /// A corner needs clipping. The other bits of such a triangle are 0.
    pub(crate) clipped: u64,
    /// All corners are nearer than the near plane. The other bits of such a triangle are 0.
    pub(crate) too_near: u64,
    /// Turned toward the eye.
    pub(crate) front: u64,
    /// Turned away from the eye. A triangle in neither mask has no area.
    pub(crate) back: u64,
    /// The triangle's box, left and top sides included, contains a pixel centre of the clip
    /// rectangle; and if the box is only 2 × 2 pixels, at least one of them lies in the triangle.
    pub(crate) covers: u64,
    /// The class; meaningless for triangles that cover nothing.
    pub(crate) large: u64,
    pub(crate) crosses: u64,
    pub(crate) unbatched: u64,
}

compiled_for_each_level! {
    /// Culls up to 64 triangles. Coverage is computed only for triangles with an area and, if it
    /// `culls`, only for those turned toward the eye.
    ///
    /// # Panics
    /// If a triangle has a corner that is not in `at`.
    pub(crate) fn cull[][](at: &[ScreenPos], triangles: &[[u32; 3]], clip: Rect, culls: bool) -> CullMasks = cull_by;
}

#[inline(always)]
fn cull_by<S: Lanes8>(s: S, at: &[ScreenPos], triangles: &[[u32; 3]], clip: Rect, culls: bool) -> CullMasks {
    // Without f64, so that a microcontroller's program contains no soft-float code.
    if !HAS_F64 {
        return cull_in_integers(triangles.iter().map(|corners| three(*corners, |corner| at[corner as usize])), culls);
    }
    let mut masks = CullMasks::default();
    let triangles = &triangles[..triangles.len().min(CHUNK)];
    let (eights, rest) = triangles.as_chunks::<LANES>();
    for (number, eight) in eights.iter().enumerate() {
        masks.add(LANES * number, u64::MAX, cull_eight(s, s.gather(at, eight), clip, culls));
    }
    if let Some(&first) = rest.first() {
        let mut eight = [first; LANES];
        eight[..rest.len()].copy_from_slice(rest);
        let are_triangles = (1 << rest.len()) - 1;
        masks.add(LANES * eights.len(), are_triangles, cull_eight(s, s.gather(at, &eight), clip, culls));
    }
    masks
}

/// The positions of one corner of triangles, eight at a time.
type Eights<'a> = &'a [[ScreenPos; LANES]];

compiled_for_each_level! {
    /// Culls up to 64 triangles, front and back, whose first, second and third corners are given in three arrays, eight
    /// triangles at a time.
    pub(super) fn cull_eights[][](at: [Eights<'_>; 3], clip: Rect) -> CullMasks = cull_eights_by;
}

#[inline(always)]
fn cull_eights_by<S: Lanes8>(s: S, [a, b, c]: [Eights<'_>; 3], clip: Rect) -> CullMasks {
    // As in `cull_by`.
    if !HAS_F64 {
        let (b, c) = (b.as_flattened(), c.as_flattened());
        return cull_in_integers(a.as_flattened().iter().zip(b).zip(c).map(|((a, b), c)| [*a, *b, *c]), false);
    }
    let mut masks = CullMasks::default();
    for (number, ((a, b), c)) in a.iter().zip(b).zip(c).take(CHUNK / LANES).enumerate() {
        let corners = [load(s, a), load(s, b), load(s, c)];
        masks.add(LANES * number, u64::MAX, cull_eight(s, corners, clip, false));
    }
    masks
}

#[inline(always)]
fn load<S: Lanes8>(s: S, at: &[ScreenPos; LANES]) -> S::I64 {
    s.load_i64(&each!(lane => u64::from(at[lane]).cast_signed()))
}

/// Culls up to 64 triangles by facing alone. Each visible one may cover something, and is drawn
/// individually.
fn cull_in_integers(triangles: impl Iterator<Item = [ScreenPos; 3]>, culls: bool) -> CullMasks {
    let mut masks = CullMasks::default();
    for (i, [a, b, c]) in triangles.take(CHUNK).enumerate() {
        if a.needs_clipping() || b.needs_clipping() || c.needs_clipping() {
            let is_too_near = a == b && b == c && a.y() == ScreenPos::TOO_NEAR_Y;
            masks.clipped |= u64::from(!is_too_near) << i;
            masks.too_near |= u64::from(is_too_near) << i;
            continue;
        }
        // At most 2²¹ each.
        let from_a = |p: ScreenPos| (i64::from(p.x() - a.x()), i64::from(p.y() - a.y()));
        let ((dx1, dy1), (dx2, dy2)) = (from_a(b), from_a(c));
        let area = dx1 * dy2 - dx2 * dy1;
        masks.front |= u64::from(area < 0) << i;
        masks.back |= u64::from(area > 0) << i;
    }
    masks.covers = if culls { masks.front } else { masks.front | masks.back };
    masks.unbatched = masks.covers;
    masks
}

/// The bits of eight triangles, in the order of the fields of [`CullMasks`].
#[inline(always)]
fn cull_eight<S: Lanes8>(s: S, [a, b, c]: [S::I64; 3], clip: Rect, culls: bool) -> [u32; 8] {
    let ([ax, ay], [bx, by], [cx, cy]) = (s.halves_of_i64(a), s.halves_of_i64(b), s.halves_of_i64(c));
    // A vertex that needs clipping has the smallest i32 as its x. The other values of its triangle are meaningless.
    let least = s.min_i32(s.min_i32(ax, bx), cx);
    let beyond = s.splat_i32(ScreenPos::BEYOND);
    let clipped = s.to_bitmask(s.is_equal(least, beyond));
    let mut too_near = 0;
    if clipped != 0 {
        let all_beyond = s.is_equal(s.max_i32(s.max_i32(ax, bx), cx), beyond);
        let least = s.min_i32(s.min_i32(ay, by), cy);
        too_near = s.to_bitmask(s.and(all_beyond, s.is_equal(least, s.splat_i32(ScreenPos::TOO_NEAR_Y))));
        if too_near == 0xFF {
            return [0, too_near, 0, 0, 0, 0, 0, 0];
        }
    }
    // Exact in f64: differences are at most 2²¹, products 2⁴².
    let (dx1, dy1) = (s.to_f64(s.sub_i32(bx, ax)), s.to_f64(s.sub_i32(by, ay)));
    let (dx2, dy2) = (s.to_f64(s.sub_i32(cx, ax)), s.to_f64(s.sub_i32(cy, ay)));
    let area = s.neg_mul_add(dx2, dy1, s.mul(dx1, dy2));
    let zero = s.splat_f64(0.0);
    let front = s.to_bitmask(s.is_less(area, zero)) & !clipped;
    let back = s.to_bitmask(s.is_less(zero, area)) & !clipped;
    // Neighbours usually face the same way.
    let seen = if culls { front } else { front | back };
    if seen == 0 {
        return [clipped & !too_near, too_near, front, back, 0, 0, 0, 0];
    }
    let (x, y) = ([ax, bx, cx], [ay, by, cy]);
    let bounds = Bounds::of(s, x, y);
    // Eight bits.
    let covers = s.and(bounds.overlap(s, clip), s.mask_from_bits(seen as u8));
    let covers = s.to_bitmask(bounds.but_empty(s, covers, x, y));
    let small = s.to_bitmask(bounds.are_small(s));
    let crosses = s.to_bitmask(bounds.cross(s, clip));
    // Neighbours are usually of similar size.
    let large = if covers & (!small | crosses) == 0 { 0xFF } else { s.to_bitmask(bounds.are_batched(s)) };
    let classes = [large & !small & !crosses, large & crosses, !large & 0xFF];
    [clipped & !too_near, too_near, front, back, covers, classes[0], classes[1], classes[2]]
}

impl CullMasks {
    /// Inserts the bits of up to eight triangles, the first at bit `first`.
    #[inline(always)]
    fn add(&mut self, first: usize, are_triangles: u64, found: [u32; 8]) {
        let [clipped, too_near, front, back, covers, large, crosses, unbatched] = found;
        self.clipped |= (u64::from(clipped) & are_triangles) << first;
        self.too_near |= (u64::from(too_near) & are_triangles) << first;
        self.front |= (u64::from(front) & are_triangles) << first;
        self.back |= (u64::from(back) & are_triangles) << first;
        self.covers |= (u64::from(covers) & are_triangles) << first;
        self.large |= (u64::from(large) & are_triangles) << first;
        self.crosses |= (u64::from(crosses) & are_triangles) << first;
        self.unbatched |= (u64::from(unbatched) & are_triangles) << first;
    }

    /// The pick of triangle `at` of the 64, whose index is `index`.
    #[cfg(feature = "alloc")]
    pub(crate) fn pick(&self, at: usize, index: usize, back: bool) -> u32 {
        let bit = |mask: u64, value: u32| if mask >> at & 1 == 1 { value } else { 0 };
        // Below `Pick::MAX_COUNT`.
        index as u32
            | bit(self.large, Pick::LARGE)
            | bit(self.crosses, Pick::CROSSES_CLIP)
            | bit(self.unbatched, Pick::UNBATCHED)
            | if back { Pick::BACK } else { 0 }
    }
}

/// A list of at most `N` − 8 picks.
pub(crate) type PickList<const N: usize> = Packed<N>;

compiled_for_each_level! {
    /// Appends to the list the triangles whose bits are set in `chosen`, of the 64 from index `first` on.
    // Never inlined: `.ci/off_is_free` compares two builds, and only one of them inlined it.
    #[inline(never)]
    pub(crate) fn pick[const N: usize][N](list: &mut PickList<N>, first: u32, masks: &CullMasks, chosen: u64) = pick_by;
}

#[inline(always)]
fn pick_by<S: Lanes8, const N: usize>(s: S, list: &mut PickList<N>, first: u32, masks: &CullMasks, chosen: u64) {
    let &CullMasks { back, large, crosses, unbatched, .. } = masks;
    let is_plain = (back | large | crosses | unbatched) & chosen == 0;
    for part in 0..LANES {
        // The low bytes.
        let of_part = (chosen >> (LANES * part)) as u8;
        if of_part == 0 {
            continue;
        }
        let mut picks = s.add_i32(s.splat_i32((first + (LANES * part) as u32).cast_signed()), s.load_i32(&NUMBERS));
        if !is_plain {
            picks = s.or_i32(picks, bit(s, back, part, Pick::BACK));
            picks = s.or_i32(picks, bit(s, large, part, Pick::LARGE));
            picks = s.or_i32(picks, bit(s, crosses, part, Pick::CROSSES_CLIP));
            picks = s.or_i32(picks, bit(s, unbatched, part, Pick::UNBATCHED));
        }
        list.append(s, s.mask_from_bits(of_part), picks);
    }
}

/// `value` in the lanes whose bits of this part are set, 0 in the others.
#[inline(always)]
fn bit<S: Lanes8>(s: S, bits: u64, part: usize, value: u32) -> S::I32 {
    // The low byte.
    let mask = s.mask_from_bits((bits >> (LANES * part)) as u8);
    s.select_i32(mask, s.splat_i32(value.cast_signed()), s.splat_i32(0))
}

/// The bounds of eight triangles: of their corners in 1/256 pixel, and the box of the pixel centres between them, with
/// exclusive ends.
struct Bounds<S: Lanes8> {
    x: [S::I32; 2],
    y: [S::I32; 2],
    columns: [S::I32; 2],
    rows: [S::I32; 2],
}

impl<S: Lanes8> Bounds<S> {
    #[inline(always)]
    fn of(s: S, x: [S::I32; 3], y: [S::I32; 3]) -> Self {
        let (x, y) = (ends(s, x), ends(s, y));
        let columns = [first_centre_of_each(s, x[0]), first_centre_of_each(s, x[1])];
        let rows = [first_centre_of_each(s, y[0]), first_centre_of_each(s, y[1])];
        Self { x, y, columns, rows }
    }

    /// Lanes whose box contains a pixel centre of the rectangle, which lies inside a frame.
    #[inline(always)]
    fn overlap(&self, s: S, clip: Rect) -> S::Mask {
        // Sides are at most 4,096.
        let side = |side: u32| s.splat_i32(side as i32);
        let first = s.max_i32(self.columns[0], side(clip.x0));
        let in_columns = s.is_greater(s.min_i32(self.columns[1], side(clip.x1)), first);
        let first = s.max_i32(self.rows[0], side(clip.y0));
        s.and(in_columns, s.is_greater(s.min_i32(self.rows[1], side(clip.y1)), first))
    }

    /// Lanes whose box does not lie inside the rectangle.
    #[inline(always)]
    fn cross(&self, s: S, clip: Rect) -> S::Mask {
        let side = |side: u32| s.splat_i32(side as i32);
        // Negative where a side is crossed.
        let left = s.sub_i32(self.columns[0], side(clip.x0));
        let right = s.sub_i32(side(clip.x1), self.columns[1]);
        let top = s.sub_i32(self.rows[0], side(clip.y0));
        let bottom = s.sub_i32(side(clip.y1), self.rows[1]);
        s.is_greater(s.splat_i32(0), s.or_i32(s.or_i32(left, right), s.or_i32(top, bottom)))
    }

    #[inline(always)]
    fn are_small(&self, s: S) -> S::Mask {
        let few_columns = s.is_greater(s.splat_i32(MAX_COLUMNS + 1), s.sub_i32(self.columns[1], self.columns[0]));
        s.and(few_columns, s.is_greater(s.splat_i32(MAX_ROWS + 1), s.sub_i32(self.rows[1], self.rows[0])))
    }

    /// Lanes whose triangle is small enough for set-up in f64.
    #[inline(always)]
    fn are_batched(&self, s: S) -> S::Mask {
        // Differences are at most 2²¹.
        let (width, height) = (s.sub_i32(self.x[1], self.x[0]), s.sub_i32(self.y[1], self.y[0]));
        let fours = |units: S::I32| s.shr_i32(s.add_i32(units, s.splat_i32(1_023)), 10);
        let squares = s.mul_i32(fours(width), fours(height));
        let sides =
            s.and(s.is_greater(s.splat_i32(MAX_WIDTH + 1), width), s.is_greater(s.splat_i32(MAX_HEIGHT + 1), height));
        s.and(sides, s.is_greater(s.splat_i32(MAX_AREA_4X4 + 1), squares))
    }

    /// Removes from `triangles` those found to cover no pixel: if a box has at most 2 × 2 pixels, one of them must lie
    /// in the triangle.
    #[inline(always)]
    fn but_empty(&self, s: S, triangles: S::Mask, x: [S::I32; 3], y: [S::I32; 3]) -> S::Mask {
        let end = s.splat_i32(TINY_SIDE + 1);
        let few_columns = s.is_greater(end, s.sub_i32(self.columns[1], self.columns[0]));
        let few_rows = s.is_greater(end, s.sub_i32(self.rows[1], self.rows[0]));
        let tiny = s.and(triangles, s.and(few_columns, few_rows));
        if s.to_bitmask(tiny) == 0 {
            return triangles;
        }
        let half = s.splat_i32(128);
        let left = s.add_i32(s.shl_i32(self.columns[0], 8), half);
        let top = s.add_i32(s.shl_i32(self.rows[0], 8), half);
        let [a, b, c] = [
            (s.sub_i32(x[0], left), s.sub_i32(y[0], top)),
            (s.sub_i32(x[1], left), s.sub_i32(y[1], top)),
            (s.sub_i32(x[2], left), s.sub_i32(y[2], top)),
        ];
        s.and_not(triangles, s.and(tiny, cover_none_of_four(s, a, b, c)))
    }
}

/// The minimum and the maximum.
#[inline(always)]
fn ends<S: Lanes8>(s: S, [a, b, c]: [S::I32; 3]) -> [S::I32; 2] {
    [s.min_i32(s.min_i32(a, b), c), s.max_i32(s.max_i32(a, b), c)]
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::clip::doubled_area;
    use crate::raster::fill_rule::first_centre;
    use crate::raster::{Frame, Interpolation, Raster, Vertex};
    use crate::span::Kernel;
    use alloc::vec::Vec;
    use proptest::prelude::*;

    const MAX_UNITS: i32 = Vertex::GUARD_BAND;

    fn position() -> impl Strategy<Value = ScreenPos> {
        let near = (-300_i32..9_000, -300_i32..9_000);
        let on_centres = (-2_i32..34, -2_i32..34).prop_map(|(x, y)| (x * 256 + 128, y * 256 + 128));
        let far = (-MAX_UNITS..=MAX_UNITS, -MAX_UNITS..=MAX_UNITS);
        let end = prop::sample::select(vec![-MAX_UNITS, MAX_UNITS, 0]);
        let ends = (end.clone(), end);
        let tiny = (2_000_i32..2_800, 2_000_i32..2_800);
        let on_halves = (15_i32..23, 15_i32..23).prop_map(|(x, y)| (x * 128, y * 128));
        let legal = prop_oneof![4 => near, 2 => on_centres, 8 => tiny, 8 => on_halves, 1 => far, 1 => ends]
            .prop_map(|(x, y)| ScreenPos::new(x, y));
        prop_oneof![30 => legal, 1 => Just(ScreenPos::NEEDS_CLIPPING), 6 => Just(ScreenPos::TOO_NEAR)]
    }

    fn kernels() -> Vec<Kernel> {
        // Every level that the processor has: `simd` alone would be only the highest.
        Kernel::available().collect()
    }

    /// Random triangles face the same way in integers as in the lanes.
    #[test]
    fn sides_in_integers_are_those_of_lanes() {
        let mut seed = 1_u64;
        let mut next = |most: i32| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as i32 % most
        };
        for _ in 0..200 {
            let at: Vec<ScreenPos> = (0..40)
                .map(|i| match i {
                    7 => ScreenPos::NEEDS_CLIPPING,
                    8..20 => ScreenPos::TOO_NEAR,
                    _ => ScreenPos::new(next(900), next(900)),
                })
                .collect();
            let triangles: Vec<[u32; 3]> = (0..CHUNK).map(|_| [0; 3].map(|_| next(40) as u32)).collect();
            for culls in [false, true] {
                let clip = Rect { x0: 0, y0: 0, x1: 320, y1: 200 };
                let lanes = cull(Kernel::PORTABLE.simd_level(), &at, &triangles, clip, culls);
                let corners = triangles.iter().map(|corners| corners.map(|i| at[i as usize]));
                let integers = cull_in_integers(corners, culls);
                let sides = |masks: &CullMasks| (masks.clipped, masks.too_near, masks.front, masks.back);
                assert_eq!(sides(&integers), sides(&lanes));
                assert_eq!(lanes.covers & !integers.covers, 0);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Every kernel finds the same sign of each face's area as the raster, and culls no face of
        /// which the raster draws a pixel.
        #[test]
        fn what_is_left_out_covers_nothing(
            culls: bool,
            positions in prop::collection::vec(position(), 1..60),
            corners in prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>()), 0..=CHUNK),
            clip in prop_oneof![Just((0, 0, 32, 32)), (0_u32..20, 0_u32..20, 12_u32..=32, 12_u32..=32)],
        ) {
            let index = |i: u32| i % positions.len() as u32;
            let triangles: Vec<[u32; 3]> = corners.iter().map(|&(a, b, c)| [index(a), index(b), index(c)]).collect();
            let clip = Rect { x0: clip.0, y0: clip.1, x1: clip.2, y1: clip.3 };
            let mut pixels = vec![0; 32 * 32];
            let frame = Frame::new(&mut pixels, 32, 32, 32).expect("a legal frame");
            let mut raster = Raster::new(frame).with_clip(clip);
            let clip = raster.clip();
            let all = kernels().into_iter().map(|kernel| cull(kernel.simd_level(), &positions, &triangles, clip, culls));
            let all: Vec<CullMasks> = all.collect();
            for masks in &all {
                prop_assert_eq!(*masks, all[0]);
            }
            for (i, triangle) in triangles.iter().enumerate() {
                let is = |bits: u64| bits >> i & 1 == 1;
                let CullMasks { clipped, too_near, front, back, covers, .. } = all[0];
                let corners = triangle.map(|i| positions[i as usize]);
                prop_assert_eq!(is(too_near), corners == [ScreenPos::TOO_NEAR; 3]);
                prop_assert_eq!(is(clipped), !is(too_near) && corners.iter().any(|corner| corner.needs_clipping()));
                if is(clipped) || is(too_near) {
                    prop_assert!(!is(front) && !is(back) && !is(covers));
                    continue;
                }
                let vertices = corners.map(|position| {
                    let (x, y) = (I24F8::from_bits(position.x()), I24F8::from_bits(position.y()));
                    Vertex::new(x, y, U8F8::default(), 1).expect("legal")
                });
                let area = doubled_area(&vertices);
                prop_assert_eq!((is(front), is(back)), (area < 0, area > 0));
                let drawn = raster.triangle(&vertices, Interpolation::Flat(1));
                if culls && area >= 0 {
                    prop_assert!(!is(covers));
                    continue;
                }
                if !is(covers) {
                    prop_assert_eq!(drawn, Default::default());
                }
                // The pixel centres between the corners, as a range with an exclusive end.
                let centres = |units: fn(&Vertex) -> I24F8| {
                    let [a, b, c] = vertices.each_ref().map(|v| first_centre(units(v)));
                    (a.min(b).min(c), a.max(b).max(c))
                };
                // A tiny triangle may cover only pixels beyond the frame.
                let is_tiny = |(first, end)| end - first <= TINY_SIDE && first >= 0 && end <= 32;
                let is_tiny = is_tiny(centres(Vertex::x)) && is_tiny(centres(Vertex::y));
                if is_tiny && clip == (Rect { x0: 0, y0: 0, x1: 32, y1: 32 }) {
                    prop_assert_eq!(is(covers), drawn.covered > 0, "{:?}", vertices);
                    prop_assert!(!is(covers) || area != 0);
                }
            }
        }
    }
}
