//! Culling of many faces at a time, by the places of their corners alone: back faces and those that cover no pixel
//! centre. Most of a fine model's faces end here.

use super::lit::ScreenPos;
use crate::raster::Rect;
use crate::raster::batch::cull::Bounds;
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::Kernel;

pub(super) mod face_queue;

/// Faces at a time.
pub(super) const CHUNK: usize = 64;
/// Faces of a vector.
const LANES: usize = 8;

/// Culling by cover: the pixels that are drawn, and the kernel whose level decides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Culler {
    pub(super) clip: Rect,
    pub(super) kernel: Kernel,
}

/// Results for up to 64 faces: a bit for each, the first lowest.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct CullMasks {
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

impl Culler {
    /// One for those that want to know all faces: its answer on pixel centres means nothing.
    pub(super) const EVERYTHING: Self = Self { clip: Rect { x0: 0, y0: 0, x1: 0, y1: 0 }, kernel: Kernel::PORTABLE };

    /// Culls up to 64 faces of these corners. The cover of pixels is found for those that have an area, and if it
    /// `culls`, only for those that are turned towards the eye.
    ///
    /// # Panics
    /// If a face has a corner that is not in `places`.
    #[inline]
    pub(super) fn cull(&self, places: &[ScreenPos], triangles: &[[u32; 3]], culls: bool) -> CullMasks {
        cull(self.kernel.simd_level(), places, triangles, self.clip, culls)
    }
}

compiled_for_each_level! {
    fn cull[][](places: &[ScreenPos], triangles: &[[u32; 3]], clip: Rect, culls: bool) -> CullMasks = cull_by;
}

#[inline(always)]
fn cull_by<S: Lanes8>(s: S, places: &[ScreenPos], triangles: &[[u32; 3]], clip: Rect, culls: bool) -> CullMasks {
    let mut masks = CullMasks::default();
    let triangles = &triangles[..triangles.len().min(CHUNK)];
    let (eights, rest) = triangles.as_chunks::<LANES>();
    for (number, eight) in eights.iter().enumerate() {
        masks.add(LANES * number, u64::MAX, cull_eight(s, places, eight, clip, culls));
    }
    if let Some(&first) = rest.first() {
        let mut eight = [first; LANES];
        eight[..rest.len()].copy_from_slice(rest);
        let are_faces = (1 << rest.len()) - 1;
        masks.add(LANES * eights.len(), are_faces, cull_eight(s, places, &eight, clip, culls));
    }
    masks
}

/// Bits of eight faces: those that need clipping, the front, the back, and those that may cover a pixel.
#[inline(always)]
fn cull_eight<S: Lanes8>(
    s: S,
    places: &[ScreenPos],
    triangles: &[[u32; 3]; LANES],
    clip: Rect,
    culls: bool,
) -> [u32; 4] {
    let [a, b, c] = s.gather(places, triangles);
    let ([ax, ay], [bx, by], [cx, cy]) = (s.halves_of_i64(a), s.halves_of_i64(b), s.halves_of_i64(c));
    // The mark is the least number there is. Of such a face the other numbers mean nothing.
    let least = s.min_i32(s.min_i32(ax, bx), cx);
    let clipped = s.mask_bits(s.is_equal(least, s.all_i32(ScreenPos::BEYOND)));
    // Exact in f64: differences are at most 2²¹, products 2⁴².
    let (dx1, dy1) = (s.to_f64(s.sub_i32(bx, ax)), s.to_f64(s.sub_i32(by, ay)));
    let (dx2, dy2) = (s.to_f64(s.sub_i32(cx, ax)), s.to_f64(s.sub_i32(cy, ay)));
    let area = s.neg_mul_add(dx2, dy1, s.mul(dx1, dy2));
    let zero = s.all_f64(0.0);
    let front = s.mask_bits(s.is_less(area, zero)) & !clipped;
    let back = s.mask_bits(s.is_less(zero, area)) & !clipped;
    // Neighbours mostly turn the same way.
    let seen = if culls { front } else { front | back };
    if seen == 0 {
        return [clipped, front, back, 0];
    }
    let (x, y) = ([ax, bx, cx], [ay, by, cy]);
    let bounds = Bounds::of(s, x, y);
    // Eight bits.
    let covers = s.both(bounds.overlap(s, clip), s.mask_of_bits(seen as u8));
    [clipped, front, back, s.mask_bits(bounds.but_empty(s, covers, x, y))]
}

impl CullMasks {
    /// Puts in bits of up to eight faces, from number `first` on.
    #[inline(always)]
    fn add(&mut self, first: usize, are_faces: u64, found: [u32; 4]) {
        let [clipped, front, back, covers] = found;
        self.clipped |= (u64::from(clipped) & are_faces) << first;
        self.front |= (u64::from(front) & are_faces) << first;
        self.back |= (u64::from(back) & are_faces) << first;
        self.covers |= (u64::from(covers) & are_faces) << first;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::clip::doubled_area;
    use crate::raster::{Frame, Interpolation, Raster, Vertex};
    use proptest::prelude::*;

    const MAX_UNITS: i32 = Vertex::GUARD_BAND;

    fn place() -> impl Strategy<Value = ScreenPos> {
        let near = (-300_i32..9_000, -300_i32..9_000);
        let on_centres = (-2_i32..34, -2_i32..34).prop_map(|(x, y)| (x * 256 + 128, y * 256 + 128));
        let far = (-MAX_UNITS..=MAX_UNITS, -MAX_UNITS..=MAX_UNITS);
        let end = prop::sample::select(vec![-MAX_UNITS, MAX_UNITS, 0]);
        let ends = (end.clone(), end);
        let tiny = (2_000_i32..2_800, 2_000_i32..2_800);
        let on_halves = (15_i32..23, 15_i32..23).prop_map(|(x, y)| (x * 128, y * 128));
        let legal = prop_oneof![4 => near, 2 => on_centres, 8 => tiny, 8 => on_halves, 1 => far, 1 => ends]
            .prop_map(|(x, y)| ScreenPos::new(x, y));
        prop_oneof![30 => legal, 1 => Just(ScreenPos::NEEDS_CLIPPING)]
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
            corners in prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>()), 0..=CHUNK),
            clip in prop_oneof![Just((0, 0, 32, 32)), (0_u32..20, 0_u32..20, 12_u32..=32, 12_u32..=32)],
        ) {
            let index = |i: u32| i % places.len() as u32;
            let triangles: Vec<[u32; 3]> = corners.iter().map(|&(a, b, c)| [index(a), index(b), index(c)]).collect();
            let clip = Rect { x0: clip.0, y0: clip.1, x1: clip.2, y1: clip.3 };
            let mut pixels = vec![0; 32 * 32];
            let frame = Frame::new(&mut pixels, 32, 32, 32).expect("a legal frame");
            let mut raster = Raster::new(frame).with_clip(clip);
            let clip = raster.clip();
            let all = kernels().into_iter().map(|kernel| Culler { clip, kernel }.cull(&places, &triangles, culls));
            let all: Vec<CullMasks> = all.collect();
            for masks in &all {
                prop_assert_eq!(*masks, all[0]);
            }
            for (i, triangle) in triangles.iter().enumerate() {
                let is = |bits: u64| bits >> i & 1 == 1;
                let CullMasks { clipped, front, back, covers } = all[0];
                let corners = triangle.map(|i| places[i as usize]);
                prop_assert_eq!(is(clipped), corners.contains(&ScreenPos::NEEDS_CLIPPING));
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
                let is_tiny = centres(Vertex::x) <= Some(crate::raster::batch::cull::TINY_SIDE) && centres(Vertex::y) <= Some(crate::raster::batch::cull::TINY_SIDE);
                if is_tiny && clip == (Rect { x0: 0, y0: 0, x1: 32, y1: 32 }) {
                    prop_assert_eq!(is(covers), drawn.covered > 0, "{:?}", vertices);
                    prop_assert!(!is(covers) || area != 0);
                }
            }
        }
    }
}
