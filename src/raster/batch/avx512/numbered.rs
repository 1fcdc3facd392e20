//! `Batch::refill`, sixteen triangles at a time.

use crate::simd::Avx512;
use core::arch::asm;

use super::super::Batch;
use super::super::numbered::{Numbered, TURNED};

/// Triangles at a time.
const LANES: usize = 16;
const _: () = assert!(Batch::CAPACITY / LANES * LANES == Batch::CAPACITY);

/// Numbers of the lower and the upper halves of pairs.
#[repr(C, align(64))]
struct Halves([[u32; LANES]; 2]);

static HALVES: Halves = {
    let mut halves = Halves([[0; LANES]; 2]);
    let mut i = 0;
    while i < LANES as u32 {
        (halves.0[0][i as usize], halves.0[1][i as usize]) = (2 * i, 2 * i + 1);
        i += 1;
    }
    halves
};

/// Returns whether all numbers were those of triangles and vertices; otherwise anything stands in the batch.
pub(in super::super) fn refill(_: Avx512, batch: &mut Batch, from: &Numbered<'_>, numbers: &[u32]) -> bool {
    // Offsets are signed, in numbers of four bytes.
    if from.triangles.len() >= (1 << 31) / 3 {
        return false;
    }
    let mut rest = numbers;
    let mut known = true;
    for at in (0..Batch::CAPACITY).step_by(LANES) {
        let Some((sixteen, others)) = rest.split_first_chunk() else { break };
        // SAFETY: the processor has AVX-512, says the token; `at` is a multiple of 16 below the capacity.
        known &= unsafe { put(batch, at, from, sixteen, LANES) };
        rest = others;
    }
    if !rest.is_empty() && rest.len() < LANES {
        let mut last = [0; LANES];
        last[..rest.len()].copy_from_slice(rest);
        // SAFETY: as above; less than the capacity came before.
        known &= unsafe { put(batch, numbers.len() - rest.len(), from, &last, rest.len()) };
    }
    known
}

/// Puts the first `lanes` of sixteen triangles into a batch, and anything behind them. Whether all numbers were right.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true; `at` and 16 are together no more than the capacity, and
/// there are less than 2³¹ / 3 triangles.
#[inline(always)]
unsafe fn put(batch: &mut Batch, at: usize, from: &Numbered<'_>, numbers: &[u32; LANES], lanes: usize) -> bool {
    debug_assert!(at + LANES <= Batch::CAPACITY);
    // What lies farther behind has no number here; both fit.
    let vertices = from.places.len().min(from.depths.len()).min(from.shades.len()).min(1 << 31) as u32;
    let wanted = (1_u32 << lanes) - 1;
    let known: u32;
    // Places, depths and shades are read by those numbers that are below the least count of these, triangles likewise: masks
    // leave out the others. The arrays of the batch's three corners follow each other.
    // SAFETY: the caller has AVX-512 F, BW, DQ and VL found. Read are `numbers`, `HALVES` and what is named above; written are
    // sixteen numbers from number `at` on, each, of places, shades and depths of the batch, which there are by the caller's
    // promise. The stack is not used; flags and all registers written are given up.
    unsafe {
        asm!(
            "vmovdqu32  zmm16, [{n}]",
            "kmovw      k1, {known:e}",
            "vpmovd2m   k4, zmm16",                                     // turned
            "vpandd     zmm16, zmm16, dword ptr [{number}]{{1to16}}",
            "vpbroadcastd zmm20, {triangles:e}",
            "vpbroadcastd zmm21, {vertices:e}",
            "vpcmpud    k1{{k1}}, zmm16, zmm20, 1",                     // less
            "vpaddd     zmm17, zmm16, zmm16",
            "vpaddd     zmm16, zmm16, zmm17",
            "kmovw      k2, k1",
            "kmovw      k3, k1",
            "kmovw      k5, k1",
            "vpxord     zmm17, zmm17, zmm17",
            "vpxord     zmm18, zmm18, zmm18",
            "vpxord     zmm19, zmm19, zmm19",
            "vpgatherdd zmm17{{k2}}, [{t} + 4*zmm16]",
            "vpgatherdd zmm18{{k3}}, [{t} + 4*zmm16 + 4]",
            "vpgatherdd zmm19{{k5}}, [{t} + 4*zmm16 + 8]",
            "vmovdqa64  zmm30, [{halves}]",
            "vmovdqa64  zmm31, [{halves} + 64]",
            "vpcmpud    k1{{k1}}, zmm17, zmm21, 1",
            "vpcmpud    k1{{k1}}, zmm18, zmm21, 1",
            "vpcmpud    k1{{k1}}, zmm19, zmm21, 1",
            "kshiftrw   k6, k1, 8",
            "vextracti64x4 ymm20, zmm17, 1",
            "vextracti64x4 ymm21, zmm18, 1",
            "vextracti64x4 ymm22, zmm19, 1",
            // The first corner.
            "kmovw      k2, k1",
            "kmovw      k3, k6",
            "kmovw      k5, k1",
            "vpxord     zmm23, zmm23, zmm23",
            "vpxord     zmm24, zmm24, zmm24",
            "vpxord     zmm25, zmm25, zmm25",
            "vpgatherdq zmm23{{k2}}, [{p} + 8*ymm17]",
            "vpgatherdq zmm24{{k3}}, [{p} + 8*ymm20]",
            "vpgatherdd zmm25{{k5}}, [{d} + 4*zmm17]",
            "kmovw      k2, k1",
            "vpxord     zmm26, zmm26, zmm26",
            "vpgatherdd zmm26{{k2}}, [{s} + 4*zmm17]",
            "vmovdqa64  zmm27, zmm23",
            "vpermt2d   zmm27, zmm30, zmm24",
            "vpermt2d   zmm23, zmm31, zmm24",
            "vpsrld     zmm26{{k4}}, zmm26, 16",
            "vmovdqu32  [{x}], zmm27",
            "vmovdqu32  [{y}], zmm23",
            "vmovdqu32  [{depth}], zmm25",
            "vpmovdw    [{shade}], zmm26",
            // The second.
            "kmovw      k2, k1",
            "kmovw      k3, k6",
            "kmovw      k5, k1",
            "vpxord     zmm23, zmm23, zmm23",
            "vpxord     zmm24, zmm24, zmm24",
            "vpxord     zmm25, zmm25, zmm25",
            "vpgatherdq zmm23{{k2}}, [{p} + 8*ymm18]",
            "vpgatherdq zmm24{{k3}}, [{p} + 8*ymm21]",
            "vpgatherdd zmm25{{k5}}, [{d} + 4*zmm18]",
            "kmovw      k2, k1",
            "vpxord     zmm26, zmm26, zmm26",
            "vpgatherdd zmm26{{k2}}, [{s} + 4*zmm18]",
            "vmovdqa64  zmm27, zmm23",
            "vpermt2d   zmm27, zmm30, zmm24",
            "vpermt2d   zmm23, zmm31, zmm24",
            "vpsrld     zmm26{{k4}}, zmm26, 16",
            "vmovdqu32  [{x} + {NEXT}], zmm27",
            "vmovdqu32  [{y} + {NEXT}], zmm23",
            "vmovdqu32  [{depth} + {NEXT}], zmm25",
            "vpmovdw    [{shade} + {NEXT} / 2], zmm26",
            // The third.
            "kmovw      k2, k1",
            "kmovw      k3, k6",
            "kmovw      k5, k1",
            "vpxord     zmm23, zmm23, zmm23",
            "vpxord     zmm24, zmm24, zmm24",
            "vpxord     zmm25, zmm25, zmm25",
            "vpgatherdq zmm23{{k2}}, [{p} + 8*ymm19]",
            "vpgatherdq zmm24{{k3}}, [{p} + 8*ymm22]",
            "vpgatherdd zmm25{{k5}}, [{d} + 4*zmm19]",
            "kmovw      k2, k1",
            "vpxord     zmm26, zmm26, zmm26",
            "vpgatherdd zmm26{{k2}}, [{s} + 4*zmm19]",
            "vmovdqa64  zmm27, zmm23",
            "vpermt2d   zmm27, zmm30, zmm24",
            "vpermt2d   zmm23, zmm31, zmm24",
            "vpsrld     zmm26{{k4}}, zmm26, 16",
            "vmovdqu32  [{x} + 2*{NEXT}], zmm27",
            "vmovdqu32  [{y} + 2*{NEXT}], zmm23",
            "vmovdqu32  [{depth} + 2*{NEXT}], zmm25",
            "vpmovdw    [{shade} + {NEXT}], zmm26",
            "kmovw      {known:e}, k1",
            n = in(reg) numbers,
            known = inout(reg) wanted => known,
            // Less than 2³¹.
            triangles = in(reg) from.triangles.len(),
            vertices = in(reg) vertices,
            number = in(reg) &const { !TURNED },
            halves = in(reg) &raw const HALVES,
            t = in(reg) from.triangles.as_ptr(),
            p = in(reg) from.places.as_ptr(),
            d = in(reg) from.depths.as_ptr(),
            s = in(reg) from.shades.as_ptr(),
            x = in(reg) (&raw mut batch.x).cast::<i32>().wrapping_add(at),
            y = in(reg) (&raw mut batch.y).cast::<i32>().wrapping_add(at),
            depth = in(reg) (&raw mut batch.depth).cast::<u32>().wrapping_add(at),
            shade = in(reg) (&raw mut batch.shade).cast::<u16>().wrapping_add(at),
            NEXT = const 4 * Batch::CAPACITY,
            out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
            out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
            out("zmm30") _, out("zmm31") _,
            out("k1") _, out("k2") _, out("k3") _, out("k4") _, out("k5") _, out("k6") _,
            options(nostack),
        );
    }
    known == wanted
}
