//! Triangles by their numbers, of vertices that lie in arrays: those that survive culling are put into a batch at once.

use super::triangles::Batch;
use crate::fixed::U8F8;
use crate::raster::Interpolation;
use crate::span::Kernel;

/// Place of a vertex on the screen: x and y in 1/256 pixel, in the guard band; or that it needs clipping. It is one
/// number, so that it is read at once.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub(crate) struct ScreenPos(u64);

impl ScreenPos {
    /// The x of those that need clipping: far outside of the guard band.
    pub(crate) const BEYOND: i32 = i32::MIN;
    pub(crate) const NEEDS_CLIPPING: Self = Self::new(Self::BEYOND, 0);

    #[inline(always)]
    pub(crate) const fn new(x: i32, y: i32) -> Self {
        Self(x.cast_unsigned() as u64 | (y.cast_unsigned() as u64) << 32)
    }

    #[inline(always)]
    pub(crate) const fn x(self) -> i32 {
        // The lower half.
        self.0 as i32
    }

    #[inline(always)]
    pub(crate) const fn y(self) -> i32 {
        // The upper half.
        (self.0 >> 32) as i32
    }

    #[inline]
    pub(crate) const fn needs_clipping(self) -> bool {
        self.x() == Self::BEYOND
    }
}

/// x in the lower half, y in the upper.
impl From<ScreenPos> for u64 {
    #[inline(always)]
    fn from(pos: ScreenPos) -> Self {
        pos.0
    }
}

/// Vertices, and triangles of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IndexedTriangles<'a> {
    pub(crate) places: &'a [ScreenPos],
    pub(crate) depths: &'a [u32],
    /// Front and back.
    pub(crate) shades: &'a [[U8F8; 2]],
    pub(crate) triangles: &'a [[u32; 3]],
}

/// Beside a triangle's number: its back is seen.
pub(crate) const BACK_FACE: u32 = 1 << 31;

impl Batch {
    /// Holds these triangles, at most as many as it has room for, in place of all others. None of them needs clipping.
    pub(crate) fn refill(
        &mut self,
        from: &IndexedTriangles<'_>,
        numbers: &[u32],
        interpolation: Interpolation,
        kernel: Kernel,
    ) {
        let numbers = &numbers[..numbers.len().min(Self::CAPACITY)];
        self.interpolation[..numbers.len()].fill(interpolation);
        self.count = numbers.len();
        let _ = kernel;
        self.refill_one_by_one(from, numbers);
    }

    /// The definition.
    fn refill_one_by_one(&mut self, from: &IndexedTriangles<'_>, numbers: &[u32]) {
        // Cut to one length, so that a vertex's number is compared with it once.
        let vertices = from.places.len().min(from.depths.len()).min(from.shades.len());
        let (places, depths, shades) = (&from.places[..vertices], &from.depths[..vertices], &from.shades[..vertices]);
        for (at, &number) in numbers.iter().enumerate() {
            let side = usize::from(number & BACK_FACE != 0);
            let triangle = from.triangles[(number & !BACK_FACE) as usize];
            for (corner, vertex) in triangle.into_iter().enumerate() {
                let vertex = vertex as usize;
                let place = places[vertex];
                (self.x[corner][at], self.y[corner][at]) = (place.x(), place.y());
                self.shade[corner][at] = shades[vertex][side].to_bits();
                self.depth[corner][at] = depths[vertex];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    /// Returns the triangles of a batch.
    fn held(batch: &Batch) -> Vec<([[i32; 4]; 3], Interpolation)> {
        let corner = |at: usize, k: usize| {
            [batch.x[k][at], batch.y[k][at], i32::from(batch.shade[k][at]), batch.depth[k][at].cast_signed()]
        };
        (0..batch.len()).map(|at| ([0, 1, 2].map(|k| corner(at, k)), batch.interpolation[at])).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]
        /// Every kernel puts in the triangles of the definition, front or back, and no others.
        #[test]
        fn numbered_triangles_are_put_in_as_one_by_one(
            vertices in prop::collection::vec((any::<i32>(), any::<i32>(), any::<u32>(), any::<[u16; 2]>()), 1..50),
            corners in prop::collection::vec(any::<[u32; 3]>(), 1..90),
            numbers in prop::collection::vec((any::<u32>(), any::<bool>()), 0..=140),
        ) {
            let places: Vec<ScreenPos> = vertices.iter().map(|v| ScreenPos::new(v.0, v.1)).collect();
            let depths: Vec<u32> = vertices.iter().map(|v| v.2).collect();
            let shades: Vec<[U8F8; 2]> = vertices.iter().map(|v| v.3.map(U8F8::from_bits)).collect();
            let triangles: Vec<[u32; 3]> = corners.iter().map(|c| c.map(|i| i % vertices.len() as u32)).collect();
            let from = IndexedTriangles { places: &places, depths: &depths, shades: &shades, triangles: &triangles };
            let number = |&(n, turned): &(u32, bool)| (n % triangles.len() as u32) | if turned { BACK_FACE } else { 0 };
            let numbers: Vec<u32> = numbers.iter().map(number).collect();
            let most = numbers.len().min(Batch::CAPACITY);
            let mut expected = Batch::new();
            expected.refill(&from, &numbers, Interpolation::Gouraud, Kernel::PORTABLE);
            prop_assert_eq!(expected.len(), most);
            for (number, (corners, interpolation)) in numbers.iter().zip(held(&expected)) {
                let side = usize::from(number & BACK_FACE != 0);
                let triangle = triangles[(number & !BACK_FACE) as usize];
                let of = |i: u32| {
                    let (x, y, depth, shades) = vertices[i as usize];
                    [x, y, i32::from(shades[side]), depth.cast_signed()]
                };
                prop_assert_eq!((corners, interpolation), (triangle.map(of), Interpolation::Gouraud));
            }
            for kernel in Kernel::available() {
                let mut batch = Batch::new();
                batch.refill(&from, &numbers, Interpolation::Gouraud, kernel);
                prop_assert_eq!(held(&batch), held(&expected));
            }
        }
    }

    /// A number of nothing is refused as by the definition, whatever the processor.
    #[test]
    fn numbers_of_nothing_are_refused() {
        let places = [ScreenPos::new(1, 2); 5];
        let (depths, shades) = ([1; 5], [[U8F8::default(); 2]; 5]);
        let refused = |depths: &[u32], triangles: &[[u32; 3]], number: u32, lane: usize| {
            let mut numbers = [0; 40];
            numbers[lane] = number;
            let from = IndexedTriangles { places: &places, depths, shades: &shades, triangles };
            let put = |kernel| Batch::new().refill(&from, &numbers, Interpolation::Gouraud, kernel);
            let refused = |kernel| std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| put(kernel))).is_err();
            let all: Vec<bool> = Kernel::available().map(refused).collect();
            assert!(all.iter().all(|refused| *refused == all[0]), "{all:?}");
            all[0]
        };
        let good = [[0, 1, 2], [2, 3, 4]];
        for lane in [0, 15, 16, 39] {
            assert!(!refused(&depths, &good, 1, lane));
            assert!(refused(&depths, &good, 2, lane));
            assert!(refused(&depths, &good, !BACK_FACE, lane));
            for corner in 0..3 {
                let mut bad = good;
                bad[1][corner] = 5;
                assert!(refused(&depths, &bad, 1, lane));
                bad[1][corner] = u32::MAX;
                assert!(refused(&depths, &bad, 1, lane));
            }
            assert!(refused(&depths[..4], &good, 1, lane));
        }
    }
}
