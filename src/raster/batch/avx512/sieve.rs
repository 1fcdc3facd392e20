//! Culling of triangles that were culled before, sixteen at a time: `sieve::sieve_by`.

use core::arch::asm;

use super::super::Batch;
use super::super::rows::{MAX_ACROSS, MAX_AREA_4X4, MAX_COLUMNS, MAX_DOWN, MAX_ROWS};
use super::super::sieve::{Chosen, Kept};
use crate::raster::frame::Rect;

/// Triangles at a time.
pub(in super::super) const LANES: usize = 16;
const _: () = assert!(Batch::CAPACITY / LANES * LANES == Batch::CAPACITY);

/// Keeps the triangles that have a pixel centre in their box and inside `clip`.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline(always)]
pub(in super::super) unsafe fn sieve(batch: &Batch, clip: Rect, kept: &mut Kept) {
    // Inside a frame, at most 4,096.
    let sides = [clip.x0, clip.y0, clip.x1, clip.y1].map(|side| side as i32);
    let mut count = 0;
    for first in (0..batch.count.min(Batch::CAPACITY)).step_by(LANES) {
        let lanes = (batch.count - first).min(LANES);
        let Some(to) = kept.triangles.get_mut(count..).and_then(|rest| rest.first_chunk_mut()) else { break };
        // SAFETY: by the caller's promise; `first` is a multiple of 16 below the capacity.
        count += unsafe { sieve_sixteen(batch, first, lanes, &sides, to) };
    }
    kept.count = count;
}

/// Writes the classes of those of sixteen triangles that are kept one after the other, and anything behind them.
/// Returns their number.
///
/// # Safety
/// See `sieve`; `first` and 16 are together no more than the capacity.
#[inline(always)]
unsafe fn sieve_sixteen(
    batch: &Batch,
    first: usize,
    lanes: usize,
    sides: &[i32; 4],
    to: &mut [Chosen; LANES],
) -> usize {
    debug_assert!(first + LANES <= Batch::CAPACITY && lanes <= LANES);
    let kept: u32;
    // SAFETY: the caller has AVX-512 F found. Read are sixteen numbers from number `first` on of the places of each of the three
    // corners, which follow each other, `sides` and `CONSTANTS`; written are the sixteen places of `to`, of which any
    // number makes a `Chosen`. The stack is not used; all registers written are given up.
    unsafe {
        asm!(
            "vmovdqu32  zmm16, [{x}]",
            "vmovdqu32  zmm18, [{y}]",
            "vpmaxsd    zmm17, zmm16, [{x} + {NEXT}]",
            "vpmaxsd    zmm19, zmm18, [{y} + {NEXT}]",
            "vpminsd    zmm16, zmm16, [{x} + {NEXT}]",
            "vpminsd    zmm18, zmm18, [{y} + {NEXT}]",
            "vpmaxsd    zmm17, zmm17, [{x} + 2*{NEXT}]",
            "vpmaxsd    zmm19, zmm19, [{y} + 2*{NEXT}]",
            "vpminsd    zmm16, zmm16, [{x} + 2*{NEXT}]",
            "vpminsd    zmm18, zmm18, [{y} + 2*{NEXT}]",
            "vpsubd     zmm20, zmm17, zmm16",                           // across
            "vpsubd     zmm21, zmm19, zmm18",                           // down
            "vpbroadcastd zmm22, dword ptr [{c}]",                      // 127
            "vpaddd     zmm16, zmm16, zmm22",
            "vpaddd     zmm17, zmm17, zmm22",
            "vpaddd     zmm18, zmm18, zmm22",
            "vpaddd     zmm19, zmm19, zmm22",
            "vpsrad     zmm16, zmm16, 8",                               // column
            "vpsrad     zmm17, zmm17, 8",                               // end column
            "vpsrad     zmm18, zmm18, 8",                               // row
            "vpsrad     zmm19, zmm19, 8",                               // end row
            "vpbroadcastd zmm22, dword ptr [{sides}]",
            "vpbroadcastd zmm23, dword ptr [{sides} + 4]",
            "vpbroadcastd zmm24, dword ptr [{sides} + 8]",
            "vpbroadcastd zmm25, dword ptr [{sides} + 12]",
            // Kept: the box overlaps.
            "kmovw      k1, {mask:e}",
            "vpmaxsd    zmm26, zmm16, zmm22",
            "vpminsd    zmm27, zmm17, zmm24",
            "vpmaxsd    zmm28, zmm18, zmm23",
            "vpminsd    zmm29, zmm19, zmm25",
            "vpcmpd     k1{{k1}}, zmm26, zmm27, 1",                     // less
            "vpcmpd     k1{{k1}}, zmm28, zmm29, 1",
            // It lies inside.
            "vpcmpd     k2, zmm16, zmm22, 5",                           // not less
            "vpcmpd     k2{{k2}}, zmm17, zmm24, 2",                     // not greater
            "vpcmpd     k2{{k2}}, zmm18, zmm23, 5",
            "vpcmpd     k2{{k2}}, zmm19, zmm25, 2",
            // It is small.
            "vpsubd     zmm17, zmm17, zmm16",
            "vpsubd     zmm19, zmm19, zmm18",
            "vpcmpd     k3{{k2}}, zmm17, dword ptr [{c} + 4]{{1to16}}, 2",
            "vpcmpd     k3{{k3}}, zmm19, dword ptr [{c} + 8]{{1to16}}, 2",
            // It is no larger than `Large` allows.
            "vpbroadcastd zmm22, dword ptr [{c} + 12]",                 // 1,023
            "vpcmpd     k4, zmm20, dword ptr [{c} + 16]{{1to16}}, 2",
            "vpcmpd     k4{{k4}}, zmm21, dword ptr [{c} + 20]{{1to16}}, 2",
            "vpaddd     zmm20, zmm20, zmm22",
            "vpaddd     zmm21, zmm21, zmm22",
            "vpsrad     zmm20, zmm20, 10",
            "vpsrad     zmm21, zmm21, 10",
            "vpmulld    zmm20, zmm20, zmm21",
            "vpcmpd     k4{{k4}}, zmm20, dword ptr [{c} + 24]{{1to16}}, 2",
            // Another; less one for each of inside and not large, and small; more one if outside and not large.
            "vpbroadcastd zmm23, dword ptr [{c} + 28]",                 // one above the number
            "vpbroadcastd zmm24, {first:e}",
            "vpaddd     zmm24, zmm24, [{c} + 64]",
            "kandw      k5, k2, k4",
            "kandnw     k4, k2, k4",
            "vpsubd     zmm24{{k5}}, zmm24, zmm23",
            "vpsubd     zmm24{{k3}}, zmm24, zmm23",
            "vpaddd     zmm24{{k4}}, zmm24, zmm23",
            "vpcompressd zmm24{{k1}}{{z}}, zmm24",
            "kmovw      {mask:e}, k1",
            "vpmovdw    [{to}], zmm24",
            x = in(reg) (&raw const batch.x).cast::<i32>().wrapping_add(first),
            y = in(reg) (&raw const batch.y).cast::<i32>().wrapping_add(first),
            sides = in(reg) sides,
            c = in(reg) &raw const CONSTANTS,
            to = in(reg) to,
            // Below 128.
            first = in(reg) first as u32,
            mask = inout(reg) (1_u32 << lanes) - 1 => kept,
            NEXT = const 4 * Batch::CAPACITY,
            out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
            out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
            out("zmm28") _, out("zmm29") _, out("k1") _, out("k2") _, out("k3") _, out("k4") _, out("k5") _,
            options(nostack, preserves_flags),
        );
    }
    // At most sixteen.
    kept.count_ones() as usize
}

#[repr(C, align(64))]
struct Constants {
    numbers: [i32; LANES],
    /// Classes of the other triangles, with their numbers.
    others: [i32; LANES],
}

static CONSTANTS: Constants = {
    let mut constants = Constants { numbers: [0; LANES], others: [0; LANES] };
    let numbers = [127, MAX_COLUMNS, MAX_ROWS, 1_023, MAX_ACROSS, MAX_DOWN, MAX_AREA_4X4, 1 << 8];
    let mut i = 0;
    while i < LANES {
        if i < numbers.len() {
            constants.numbers[i] = numbers[i];
        }
        constants.others[i] = 3 << 8 | i as i32; // below 16
        i += 1;
    }
    constants
};

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::super::super::sieve;
    use super::*;
    use crate::fixed::{I24F8, U8F8};
    use crate::raster::{Interpolation, Vertex};
    use crate::span::Kernel;

    fn corner() -> impl Strategy<Value = (i32, i32)> {
        let most = Vertex::GUARD_BAND;
        let near = (-6_000_i32..90_000, -6_000_i32..60_000);
        let on_sides = (0_i32..30, 0_i32..30).prop_map(|(x, y)| (x * 4_096 + 128, y * 2_048 + 129));
        let far = (-most..=most, -most..=most);
        prop_oneof![4 => near, 3 => on_sides, 1 => far]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Kept are those that the definition keeps, and become what it says.
        #[test]
        fn sifted_triangles_are_kept_as_by_the_definition(
            triangles in prop::collection::vec(
                (corner(), prop::array::uniform2((-9_000_i32..9_000, -5_000_i32..5_000)), prop::array::uniform2(corner()), any::<bool>()),
                0..=Batch::CAPACITY,
            ),
            clip in prop_oneof![Just((0, 0, 320, 200)), (0_u32..200, 0_u32..100, 100_u32..=320, 50_u32..=200)],
        ) {
            if Kernel::by_name("simd-avx512").is_err() {
                return Ok(());
            }
            let mut batch = Batch { is_sifted: true, ..Batch::new() };
            for ((x, y), beside, others, is_large) in triangles {
                let near = beside.map(|(dx, dy)| (x + dx, y + dy));
                let [b, c] = if is_large { others } else { near };
                let corners = [(x, y), b, c].map(|(x, y)| {
                    let [x, y] = [x, y].map(|c| I24F8::from_bits(c.clamp(-Vertex::GUARD_BAND, Vertex::GUARD_BAND)));
                    Vertex::new(x, y, U8F8::default(), 1).expect("legal")
                });
                prop_assert!(batch.push(&corners, Interpolation::Gouraud));
            }
            let clip = Rect { x0: clip.0, y0: clip.1, x1: clip.2, y1: clip.3 };
            let (mut kept, mut expected) = (Kept::new(), Kept::new());
            sieve::sieve(&batch, clip, &mut expected);
            // SAFETY: the kernel above is there.
            unsafe { sieve(&batch, clip, &mut kept) };
            let of = |kept: &Kept| kept.triangles().iter().map(|chosen| (chosen.number(), chosen.kind())).collect::<Vec<_>>();
            prop_assert_eq!(of(&kept), of(&expected));
        }
    }
}
