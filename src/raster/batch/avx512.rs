//! The stages of a batch in assembly for AVX-512, whose intrinsics came with Rust 1.89, and this crate builds with 1.88.
//!
//! Half the instructions that `x86` takes, and eight triangles at a time with all that is known of them in registers: of
//! 2.7 pixels 14.7 ns a triangle, where it was 18.9. Only registers 16 to 31, so there is nothing to clear behind them.

use core::arch::asm;
use core::mem::offset_of;

use super::Batch;
use super::rows::{Edges, Gathered, Group, Ints, LANES, MAGIC, Place};
use super::sieve::Chosen;

pub(super) mod listed;
#[cfg(feature = "alloc")]
pub(super) mod numbered;
mod planes;
pub(super) mod sieve;
pub(super) mod tall;

/// Summands and factors of set-up.
#[repr(C)]
struct Constants {
    sign: u64,
    magnitude: u64,
    half: f64,
    minus_half: f64,
    one: f64,
    half_pixel: f64,
    pixel: f64,
    zero: f64,
    magic: f64,
    /// 127, 128 and 255.
    units: [i32; 3],
}

static CONSTANTS: Constants = Constants {
    sign: 1 << 63,
    magnitude: !(1 << 63),
    half: 0.5,
    minus_half: -0.5,
    one: 1.0,
    half_pixel: 128.0,
    pixel: 256.0,
    zero: 0.0,
    magic: MAGIC,
    units: [127, 128, 255],
};

/// Asks for the coordinates of a full batch, all at once: those kept from an earlier frame may lie in slow memory. (Of
/// triangles of 0.04 pixels 6.0 ns each in place of 7.3 from there, 4.2 in place of 4.1 from the second cache.)
#[inline(always)]
pub(super) fn fetch(batch: &Batch) {
    const NUMBERS: usize = 64 / size_of::<i32>();
    for line in 0..Batch::CAPACITY / NUMBERS {
        for numbers in batch.x.iter().chain(&batch.y) {
            let from = &raw const numbers[line * NUMBERS];
            // SAFETY: every x86-64 has the instruction; it fetches into the cache, and changes nothing.
            unsafe { asm!("prefetcht0 [{from}]", from = in(reg) from, options(nostack, preserves_flags, readonly)) };
        }
    }
}

/// `sieve::pack`.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline(always)]
pub(super) unsafe fn pack(eight: &Ints, to: &mut [Chosen; LANES]) -> usize {
    let count: u64;
    // SAFETY: the caller has AVX-512 F and VL and POPCNT found. Read are the eight numbers, written the eight places of 16
    // bits, of which any number makes a `Chosen`. The stack is not used; flags and all registers written are given up.
    unsafe {
        asm!(
            "vmovdqu32  ymm16, [{eight}]",
            "vptestmd   k1, ymm16, ymm16",
            "vpcompressd ymm16{{k1}}{{z}}, ymm16",
            "vpmovdw    xmm16, ymm16",
            "vmovdqu32  [{to}], xmm16",
            "kmovd      {count:e}, k1",
            "popcnt     {count:e}, {count:e}",
            eight = in(reg) eight,
            to = in(reg) to,
            count = out(reg) count,
            out("zmm16") _, out("k1") _,
            options(nostack),
        );
    }
    // At most eight.
    count as usize
}

/// `rows::set_up`, but for the columns.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline(always)]
pub(super) unsafe fn set_up(gathered: &Gathered, place: Place, group: &mut Group) {
    // As there.
    let (pitch, first_row) = (place.pitch as i32, place.first_row as i32);
    // SAFETY: the caller has AVX-512 F, DQ and VL found. Read are `gathered` and `CONSTANTS`, written is `group`, and of it
    // read what was written, eight numbers each at the offsets of their fields. The stack is not used; flags and all
    // registers written are given up.
    unsafe {
        asm!(
            "vmovdqu32  ymm16, [{x}]",
            "vmovdqu32  ymm17, [{x} + 32]",
            "vmovdqu32  ymm18, [{x} + 64]",
            "vmovdqu32  ymm19, [{y}]",
            "vmovdqu32  ymm20, [{y} + 32]",
            "vmovdqu32  ymm21, [{y} + 64]",
            // The box.
            "vpminsd    ymm22, ymm16, ymm17",
            "vpminsd    ymm23, ymm19, ymm20",
            "vpmaxsd    ymm24, ymm19, ymm20",
            "vpminsd    ymm22, ymm22, ymm18",
            "vpminsd    ymm23, ymm23, ymm21",
            "vpmaxsd    ymm24, ymm24, ymm21",
            "vpaddd     ymm22, ymm22, dword ptr [{c} + {UNITS}]{{1to8}}",
            "vpaddd     ymm23, ymm23, dword ptr [{c} + {UNITS}]{{1to8}}",
            "vpaddd     ymm24, ymm24, dword ptr [{c} + {UNITS}]{{1to8}}",
            "vpsrad     ymm22, ymm22, 8",                               // column
            "vpsrad     ymm23, ymm23, 8",                               // row
            "vpsrad     ymm24, ymm24, 8",
            "vpbroadcastd ymm26, {pitch:e}",
            "vpbroadcastd ymm27, {base:e}",
            "vpsubd     ymm24, ymm24, ymm23",                           // rows
            "vpmulld    ymm26, ymm26, ymm23",
            "vpaddd     ymm27, ymm27, ymm22",
            "vpaddd     ymm27, ymm27, ymm26",
            "vmovdqu32  [{g} + {COLUMN}], ymm22",
            "vmovdqu32  [{g} + {ROW}], ymm23",
            "vmovdqu32  [{g} + {ROWS}], ymm24",
            "vmovdqu32  [{g} + {AT}], ymm27",
            // Corners, counted from the centre of the box's first pixel.
            "vpslld     ymm22, ymm22, 8",
            "vpslld     ymm23, ymm23, 8",
            "vpaddd     ymm22, ymm22, dword ptr [{c} + {UNITS} + 4]{{1to8}}",
            "vpaddd     ymm23, ymm23, dword ptr [{c} + {UNITS} + 4]{{1to8}}",
            "vpsubd     ymm16, ymm16, ymm22",
            "vpsubd     ymm17, ymm17, ymm22",
            "vpsubd     ymm18, ymm18, ymm22",
            "vpsubd     ymm19, ymm19, ymm23",
            "vpsubd     ymm20, ymm20, ymm23",
            "vpsubd     ymm21, ymm21, ymm23",
            "vmovdqu32  ymm25, [{s}]",
            "vmovdqu32  ymm26, [{s} + 32]",
            "vmovdqu32  ymm27, [{s} + 64]",
            // Top, middle and bottom.
            "vpcmpd     k1, ymm20, ymm19, 1",                          // less
            "vpminsd    ymm22, ymm19, ymm20",
            "vpmaxsd    ymm20, ymm19, ymm20",
            "vmovdqa32  ymm19, ymm22",
            "vmovdqa32  ymm22, ymm16",
            "vmovdqa32  ymm23, ymm25",
            "vmovdqa32  ymm16{{k1}}, ymm17",
            "vmovdqa32  ymm25{{k1}}, ymm26",
            "vmovdqa32  ymm17{{k1}}, ymm22",
            "vmovdqa32  ymm26{{k1}}, ymm23",
            "vpcmpd     k1, ymm21, ymm20, 1",                          // less
            "vpminsd    ymm22, ymm20, ymm21",
            "vpmaxsd    ymm21, ymm20, ymm21",
            "vmovdqa32  ymm20, ymm22",
            "vmovdqa32  ymm22, ymm17",
            "vmovdqa32  ymm23, ymm26",
            "vmovdqa32  ymm17{{k1}}, ymm18",
            "vmovdqa32  ymm26{{k1}}, ymm27",
            "vmovdqa32  ymm18{{k1}}, ymm22",
            "vmovdqa32  ymm27{{k1}}, ymm23",
            "vpcmpd     k1, ymm20, ymm19, 1",                          // less
            "vpminsd    ymm22, ymm19, ymm20",
            "vpmaxsd    ymm20, ymm19, ymm20",
            "vmovdqa32  ymm19, ymm22",
            "vmovdqa32  ymm22, ymm16",
            "vmovdqa32  ymm23, ymm25",
            "vmovdqa32  ymm16{{k1}}, ymm17",
            "vmovdqa32  ymm25{{k1}}, ymm26",
            "vmovdqa32  ymm17{{k1}}, ymm22",
            "vmovdqa32  ymm26{{k1}}, ymm23",
            "vpaddd     ymm22, ymm20, dword ptr [{c} + {UNITS} + 8]{{1to8}}",
            "vpsrad     ymm22, ymm22, 8",
            "vmovdqu32  [{g} + {SPLIT}], ymm22",
            "vcvtdq2pd  zmm16, ymm16",
            "vcvtdq2pd  zmm17, ymm17",
            "vcvtdq2pd  zmm18, ymm18",
            "vcvtdq2pd  zmm19, ymm19",
            "vcvtdq2pd  zmm20, ymm20",
            "vcvtdq2pd  zmm21, ymm21",
            "vcvtdq2pd  zmm25, ymm25",
            "vcvtdq2pd  zmm26, ymm26",
            "vcvtdq2pd  zmm27, ymm27",
            "vbroadcastsd zmm30, qword ptr [{c} + {MINUS_HALF}]",
            "vbroadcastsd zmm31, qword ptr [{c} + {ONE}]",
            // Edges, as `rows::edge`.
            "vsubpd     zmm22, zmm18, zmm16",
            "vsubpd     zmm23, zmm21, zmm19",
            "vmovapd    zmm28, zmm23",
            "vfmadd132pd zmm28, zmm30, qword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
            "vfmadd231pd zmm28, zmm16, zmm23",
            "vfnmadd231pd zmm28, zmm22, zmm19",
            "vmovupd    [{g} + {LONG} + {N}], zmm28",
            "vmulpd     zmm28, zmm22, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vmovupd    [{g} + {LONG} + {PER_ROW}], zmm28",
            "vmulpd     zmm28, zmm23, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vdivpd     zmm28, zmm31, zmm28",
            "vmovupd    [{g} + {LONG} + {INVERSE}], zmm28",
            "vsubpd     zmm24, zmm17, zmm16",
            "vsubpd     zmm29, zmm20, zmm19",
            "vmovapd    zmm28, zmm29",
            "vfmadd132pd zmm28, zmm30, qword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
            "vfmadd231pd zmm28, zmm16, zmm29",
            "vfnmadd231pd zmm28, zmm24, zmm19",
            "vmovupd    [{g} + {UPPER} + {N}], zmm28",
            "vmulpd     zmm28, zmm24, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vmovupd    [{g} + {UPPER} + {PER_ROW}], zmm28",
            "vmulpd     zmm28, zmm29, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vdivpd     zmm28, zmm31, zmm28",
            "vmovupd    [{g} + {UPPER} + {INVERSE}], zmm28",
            "vsubpd     zmm18, zmm18, zmm17",
            "vsubpd     zmm21, zmm21, zmm20",
            "vmovapd    zmm28, zmm21",
            "vfmadd132pd zmm28, zmm30, qword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
            "vfmadd231pd zmm28, zmm17, zmm21",
            "vfnmadd231pd zmm28, zmm18, zmm20",
            "vmovupd    [{g} + {LOWER} + {N}], zmm28",
            "vmulpd     zmm28, zmm18, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vmovupd    [{g} + {LOWER} + {PER_ROW}], zmm28",
            "vmulpd     zmm28, zmm21, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vdivpd     zmm28, zmm31, zmm28",
            "vmovupd    [{g} + {LOWER} + {INVERSE}], zmm28",
            // The plane of shades: of any order of the corners it is the same.
            "vsubpd     zmm26, zmm26, zmm25",
            "vsubpd     zmm27, zmm27, zmm25",
            "vmulpd     zmm17, zmm24, zmm23",
            "vmulpd     zmm18, zmm26, zmm23",
            "vmulpd     zmm20, zmm27, zmm24",
            "vfnmadd231pd zmm17, zmm22, zmm29",                         // area, with a sign
            "vfnmadd231pd zmm18, zmm27, zmm29",                         // gx
            "vfnmadd231pd zmm20, zmm26, zmm22",                         // gy
            "vpandq     zmm21, zmm17, qword ptr [{c} + {SIGN}]{{1to8}}",
            "vpxorq     zmm17, zmm17, zmm21",
            "vpxorq     zmm18, zmm18, zmm21",
            "vpxorq     zmm20, zmm20, zmm21",
            "vmovapd    zmm21, zmm17",
            "vdivpd     zmm22, zmm31, zmm17",
            "vcmppd     k1, zmm18, qword ptr [{c} + {ZERO}]{{1to8}}, 1", // less: falls
            "vcmppd     k2, zmm17, qword ptr [{c} + {ZERO}]{{1to8}}, 4", // not equal
            "vfmadd132pd zmm21, zmm30, qword ptr [{c} + {HALF}]{{1to8}}", // half
            "vaddpd     zmm23, zmm25, qword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
            "vmulpd     zmm23, zmm23, zmm17",
            "vfnmadd231pd zmm23, zmm18, zmm16",
            "vfnmadd231pd zmm23, zmm20, zmm19",
            "vmulpd     zmm18, zmm18, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vmulpd     zmm20, zmm20, qword ptr [{c} + {PIXEL}]{{1to8}}",
            "vsubpd     zmm24, zmm23, zmm21",
            "vaddpd     zmm24{{k1}}, zmm23, zmm21",
            "vmovupd    [{g} + {PER_COLUMN}], zmm18",
            "vmovupd    [{g} + {SHADE_PER_ROW}], zmm20",
            "vmovupd    [{g} + {SHADE_N}], zmm24",
            "vmovupd    [{g} + {SHADE_INVERSE}], zmm22",
            "vpandq     zmm18, zmm18, qword ptr [{c} + {MAGNITUDE}]{{1to8}}",
            "vsubpd     zmm18, zmm18, zmm21",
            "vfmadd213pd zmm18, zmm22, qword ptr [{c} + {MAGIC}]{{1to8}}",  // magic
            "vpmovqd    ymm18, zmm18",
            "vpxord     ymm20, ymm20, ymm20",
            "vpsubd     ymm18{{k1}}, ymm20, ymm18",
            "vpslld     ymm18, ymm18, 16",
            "vmovdqu32  [{g} + {STEP}], ymm18",
            // Without an area no rows.
            "vmovdqu32  ymm19{{k2}}{{z}}, [{g} + {ROWS}]",
            "vmovdqu32  [{g} + {ROWS}], ymm19",
            g = in(reg) group,
            x = in(reg) &raw const gathered.x,
            y = in(reg) &raw const gathered.y,
            s = in(reg) &raw const gathered.shade,
            c = in(reg) &raw const CONSTANTS,
            pitch = in(reg) pitch,
            base = in(reg) first_row.wrapping_mul(pitch).wrapping_neg(),
            SIGN = const offset_of!(Constants, sign),
            MAGNITUDE = const offset_of!(Constants, magnitude),
            HALF = const offset_of!(Constants, half),
            MINUS_HALF = const offset_of!(Constants, minus_half),
            ONE = const offset_of!(Constants, one),
            HALF_PIXEL = const offset_of!(Constants, half_pixel),
            PIXEL = const offset_of!(Constants, pixel),
            ZERO = const offset_of!(Constants, zero),
            MAGIC = const offset_of!(Constants, magic),
            UNITS = const offset_of!(Constants, units),
            LONG = const offset_of!(Group, long),
            UPPER = const offset_of!(Group, upper),
            LOWER = const offset_of!(Group, lower),
            N = const offset_of!(Edges, n),
            PER_ROW = const offset_of!(Edges, per_row),
            INVERSE = const offset_of!(Edges, inverse),
            SHADE_N = const offset_of!(Group, n),
            SHADE_PER_ROW = const offset_of!(Group, per_row),
            SHADE_INVERSE = const offset_of!(Group, inverse),
            PER_COLUMN = const offset_of!(Group, per_column),
            COLUMN = const offset_of!(Group, column),
            ROW = const offset_of!(Group, row),
            SPLIT = const offset_of!(Group, split),
            ROWS = const offset_of!(Group, rows),
            AT = const offset_of!(Group, at),
            STEP = const offset_of!(Group, step),
            out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
            out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
            out("zmm28") _, out("zmm29") _, out("zmm30") _, out("zmm31") _, out("k1") _, out("k2") _,
            options(nostack),
        );
    }
}
