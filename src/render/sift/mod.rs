//! Culling of many faces at a time, by the places of their corners alone: back faces and those that cover no pixel
//! centre. Most of a fine model's faces end here.

use super::lit::Place;
use crate::raster::Rect;
use crate::span::Kernel;

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "assembly for processors found only when the program runs")]
mod avx512;
pub(super) mod listed;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "code for processors found only when the program runs")]
mod x86;

/// Faces at a time.
pub(super) const MOST: usize = 64;

/// Culling by cover: the pixels that are drawn, and the kernel that decides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sieve {
    pub(super) clip: Rect,
    pub(super) kernel: Kernel,
}

/// Results for up to 64 faces: a bit for each, the first lowest.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Sifted {
    /// A corner needs clipping. The other bits of such a face are 0.
    pub(super) clipped: u64,
    /// Turned towards the eye.
    pub(super) front: u64,
    /// Back faces. A face that is neither has no area.
    pub(super) back: u64,
    /// A pixel centre of the clip rectangle lies in the face's box, its left and top sides included; and if the box has
    /// only 2 × 2, one of them in the face.
    pub(super) covers: u64,
}

impl Sieve {
    /// One for those that want to know all faces: its answer on pixel centres means nothing.
    pub(super) const EVERYTHING: Self = Self { clip: Rect { x0: 0, y0: 0, x1: 0, y1: 0 }, kernel: Kernel::PORTABLE };

    /// Culls up to 64 faces of these corners. The cover of pixels is found for those that have an area, and if it
    /// `culls`, only for those that are turned towards the eye.
    #[inline]
    pub(super) fn sift(&self, places: &[Place], triangles: &[[u32; 3]], culls: bool) -> Sifted {
        // Inside a frame, at most 4,096.
        let sides = [self.clip.x0, self.clip.y0, self.clip.x1, self.clip.y1].map(|side| side as i32);
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx512) = self.kernel.avx512() {
            return avx512::sift(avx512, places, triangles, sides, culls);
        }
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx2) = self.kernel.avx2() {
            return x86::sift(avx2, places, triangles, sides, culls);
        }
        let _ = self.kernel;
        sift(places, triangles, sides, culls)
    }
}

/// The definition: face by face.
fn sift(places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4], culls: bool) -> Sifted {
    let mut sifted = Sifted::default();
    for (at, triangle) in triangles.iter().enumerate().take(MOST) {
        sifted.add(at, triangle.map(|i| places[i as usize]), sides, culls);
    }
    sifted
}

impl Sifted {
    #[inline]
    fn add(&mut self, at: usize, corners: [Place; 3], [left, top, right, bottom]: [i32; 4], culls: bool) {
        if corners.iter().any(|corner| corner.needs_clipping()) {
            self.clipped |= 1 << at;
            return;
        }
        let [a, b, c] = corners.map(|corner| (corner.x(), corner.y()));
        // As `doubled_area`: in the guard band differences are at most 2²¹.
        let product = |p: i32, q: i32| i64::from(p) * i64::from(q);
        let area = product(b.0 - a.0, c.1 - a.1) - product(c.0 - a.0, b.1 - a.1);
        self.front |= u64::from(area < 0) << at;
        self.back |= u64::from(area > 0) << at;
        if area == 0 || (culls && area > 0) {
            return;
        }
        // `I24F8::first_centre`.
        let centres = |a: i32, b: i32, c: i32| ((a.min(b).min(c) + 127) >> 8, (a.max(b).max(c) + 127) >> 8);
        let ((column, end_column), (row, end_row)) = (centres(a.0, b.0, c.0), centres(a.1, b.1, c.1));
        let mut covers = (column.max(left) < end_column.min(right)) & (row.max(top) < end_row.min(bottom));
        if (end_column - column <= TINY_SIDE) & (end_row - row <= TINY_SIDE) {
            let from_first = |(x, y): (i32, i32)| (x - column * 256 - 128, y - row * 256 - 128);
            covers &= covers_one_of_four(from_first(a), from_first(b), from_first(c));
        }
        self.covers |= u64::from(covers) << at;
    }
}

/// The longer side, in pixels, of the box of a face whose pixels are looked at one by one.
const TINY_SIDE: i32 = 2;

/// Returns whether a triangle has one of four pixels: that at the origin, the next, and the two below. Its corners must
/// be less than 1,024 units away.
///
/// ```text
/// E(p) = (b − a) × (p − a)        of each edge; positive inside, or if counter-clockwise, negative
/// ```
///
/// A point on an edge lies inside if the edge is a left or a top one; for others E has to be one step more.
fn covers_one_of_four(a: (i32, i32), b: (i32, i32), c: (i32, i32)) -> bool {
    let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
    let (b, c) = if area < 0 { (c, b) } else { (b, c) };
    [(0, 0), (256, 0), (0, 256), (256, 256)].into_iter().any(|p| {
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
            let (dx, dy) = (to.0 - from.0, to.1 - from.1);
            let is_in = dy < 0 || (dy == 0 && dx > 0);
            dx * (p.1 - from.1) - dy * (p.0 - from.0) >= i32::from(!is_in)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::clip::doubled_area;
    use crate::raster::{Frame, Interpolation, Raster, Vertex};
    use proptest::prelude::*;

    const MAX_UNITS: i32 = Vertex::GUARD_BAND;

    fn place() -> impl Strategy<Value = Place> {
        let near = (-300_i32..9_000, -300_i32..9_000);
        let on_centres = (-2_i32..34, -2_i32..34).prop_map(|(x, y)| (x * 256 + 128, y * 256 + 128));
        let far = (-MAX_UNITS..=MAX_UNITS, -MAX_UNITS..=MAX_UNITS);
        let end = prop::sample::select(vec![-MAX_UNITS, MAX_UNITS, 0]);
        let ends = (end.clone(), end);
        let tiny = (2_000_i32..2_800, 2_000_i32..2_800);
        let on_halves = (15_i32..23, 15_i32..23).prop_map(|(x, y)| (x * 128, y * 128));
        let legal = prop_oneof![4 => near, 2 => on_centres, 8 => tiny, 8 => on_halves, 1 => far, 1 => ends]
            .prop_map(|(x, y)| Place::new(x, y));
        prop_oneof![30 => legal, 1 => Just(Place::NEEDS_CLIPPING)]
    }

    fn kernels() -> Vec<Kernel> {
        // Every level that the processor has, the lower ones too: `simd` alone is the highest.
        Kernel::available().collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Every kernel finds the sign of the raster's area of every face, and leaves out no face that the raster draws
        /// a pixel of.
        #[test]
        fn what_is_left_out_covers_nothing(
            culls: bool,
            places in prop::collection::vec(place(), 1..60),
            corners in prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>()), 0..=MOST),
            clip in prop_oneof![Just((0, 0, 32, 32)), (0_u32..20, 0_u32..20, 12_u32..=32, 12_u32..=32)],
        ) {
            let index = |i: u32| i % places.len() as u32;
            let triangles: Vec<[u32; 3]> = corners.iter().map(|&(a, b, c)| [index(a), index(b), index(c)]).collect();
            let clip = Rect { x0: clip.0, y0: clip.1, x1: clip.2, y1: clip.3 };
            let mut pixels = vec![0; 32 * 32];
            let frame = Frame::new(&mut pixels, 32, 32, 32).expect("a legal frame");
            let mut raster = Raster::new(frame).with_clip(clip);
            let clip = raster.clip();
            let all = kernels().into_iter().map(|kernel| Sieve { clip, kernel }.sift(&places, &triangles, culls));
            let all: Vec<Sifted> = all.collect();
            for sifted in &all {
                prop_assert_eq!(*sifted, all[0]);
            }
            for (i, triangle) in triangles.iter().enumerate() {
                let is = |bits: u64| bits >> i & 1 == 1;
                let Sifted { clipped, front, back, covers } = all[0];
                let corners = triangle.map(|i| places[i as usize]);
                prop_assert_eq!(is(clipped), corners.contains(&Place::NEEDS_CLIPPING));
                if is(clipped) {
                    prop_assert!(!is(front) && !is(back) && !is(covers));
                    continue;
                }
                let vertices = corners.map(|place| {
                    Vertex::new(I24F8::from_bits(place.x()), I24F8::from_bits(place.y()), U8F8::default(), 1).expect("legal")
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
                let centres = |units: fn(&Vertex) -> I24F8| {
                    let centres = vertices.each_ref().map(|v| units(v).first_centre());
                    centres.iter().max().zip(centres.iter().min()).map(|(max, min)| max - min)
                };
                let is_tiny = centres(Vertex::x) <= Some(TINY_SIDE) && centres(Vertex::y) <= Some(TINY_SIDE);
                if is_tiny && clip == (Rect { x0: 0, y0: 0, x1: 32, y1: 32 }) {
                    prop_assert_eq!(is(covers), drawn.covered > 0, "{:?}", vertices);
                    prop_assert!(!is(covers) || area != 0);
                }
            }
        }
    }
}
