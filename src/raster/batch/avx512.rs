//! The rows of a tall triangle to bytes, eight rows at a time, in assembly: AVX-512's intrinsics came with Rust 1.89, and
//! this crate builds with 1.88.
//!
//! What `rows::lines` does for eight rows takes half the instructions here, and the rows go to the pixels without a list
//! between: 3,570 pixels in 90 rows take ??? ns where they took 444.

use core::arch::asm;
use core::mem::offset_of;

use super::rows::{Edges, Gathered, Group, Ints, LANES, MAGIC, Place, Row};
use super::sieve::Chosen;
use crate::raster::shade::RESEED;
use crate::raster::shading::Shading;

/// What the assembly reads and writes: of one triangle, and of eight of its rows.
#[repr(C, align(64))]
pub(super) struct Tall {
    /// Of eight rows: the address of the first pixel, ...
    at: [u64; LANES],
    /// ... the pixels, ...
    length: [u64; LANES],
    /// ... the first one's shade, twice in the lower half, ...
    paint: [u64; LANES],
    /// ... and its numerator.
    n: [f64; LANES],
    /// Sums over all rows so far, in eight parts.
    covered: [u64; LANES],
    spans: [u64; LANES],
    long: Edge,
    upper: Edge,
    lower: Edge,
    shade: Edge,
    /// Of the shade's numerator.
    per_column: f64,
    /// The same for 64 columns.
    per_piece: f64,
    /// The address of the first pixel of all, and the one after the last.
    begin: u64,
    end: u64,
    /// `end − begin`.
    size: u64,
    /// The address of the pixel in the first row from whose column columns are counted, less the bits of `MAGIC`.
    offset: u64,
    /// From one row to that eight further down.
    per_eight: u64,
    rows: u64,
    /// The first row of the lower edge.
    split: u64,
    /// What a length grows by, before this many bits of it are dropped, to give the pieces that start anew.
    round: u64,
    shift: u64,
    /// Not 0 if pieces after a row's first start anew.
    reseeds: u64,
    /// Twice the step, and twice that of 64 pixels.
    step: u32,
    step_64: u32,
}

/// `Edges` of one triangle.
#[repr(C)]
struct Edge {
    n: f64,
    /// Of eight rows.
    per_eight: f64,
    inverse: f64,
}

impl Edge {
    const NONE: Self = Self { n: 0.0, per_eight: 0.0, inverse: 0.0 };

    fn of(edges: &Edges, i: usize) -> Self {
        Self { n: edges.n[i], per_eight: edges.per_row[i] * LANES as f64, inverse: edges.inverse[i] }
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
            "vfmadd213pd zmm18, zmm22, qword ptr [{c} + 232]{{1to8}}",  // magic
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
            SIGN = const offset_of!(Constants, halves.sign),
            MAGNITUDE = const offset_of!(Constants, halves.magnitude),
            HALF = const offset_of!(Constants, halves.half),
            MINUS_HALF = const offset_of!(Constants, halves.minus_half),
            ONE = const offset_of!(Constants, halves.one),
            HALF_PIXEL = const offset_of!(Constants, halves.half_pixel),
            PIXEL = const offset_of!(Constants, halves.pixel),
            ZERO = const offset_of!(Constants, halves.zero),
            UNITS = const offset_of!(Constants, halves.units),
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

/// `rows::row`: row number `row` of eight triangles.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline]
pub(super) unsafe fn row(group: &Group, row: i32, pitch: i32, to: &mut Row) {
    // SAFETY: the caller has AVX-512 F, DQ and VL found. Read are `group` and `CONSTANTS`, written is `to`, eight numbers each at the
    // offsets of their fields. The stack is not used; flags and all registers written are given up.
    unsafe {
        asm!(
            "vpbroadcastd ymm26, {row:e}",
            "vpbroadcastd ymm27, {down:e}",
            "vcvtdq2pd  zmm16, ymm26",                                  // j
            "vbroadcastsd zmm31, qword ptr [{c} + 232]",                // magic
            "vmovupd    zmm17, [{g} + {LONG} + {PER_ROW}]",
            "vmovupd    zmm18, [{g} + {UPPER} + {PER_ROW}]",
            "vmovupd    zmm19, [{g} + {LOWER} + {PER_ROW}]",
            "vmovupd    zmm20, [{g} + {SHADE_PER_ROW}]",
            "vpcmpd     k1, ymm26, [{g} + {SPLIT}], 5",                 // not less
            "vfmadd213pd zmm17, zmm16, [{g} + {LONG} + {N}]",
            "vfmadd213pd zmm18, zmm16, [{g} + {UPPER} + {N}]",
            "vfmadd213pd zmm19, zmm16, [{g} + {LOWER} + {N}]",
            "vfmadd213pd zmm20, zmm16, [{g} + {SHADE_N}]",
            "vpcmpd     k2, ymm26, [{g} + {ROWS}], 1",                  // less
            "vfmadd132pd zmm17, zmm31, [{g} + {LONG} + {INVERSE}]",
            "vfmadd132pd zmm18, zmm31, [{g} + {UPPER} + {INVERSE}]",
            "vfmadd132pd zmm19, zmm31, [{g} + {LOWER} + {INVERSE}]",
            "vpaddd     ymm27, ymm27, [{g} + {AT}]",
            "vmovapd    zmm18{{k1}}, zmm19",                            // short
            "vminpd     zmm19, zmm17, zmm18",                           // left
            "vmaxpd     zmm17, zmm17, zmm18",                           // right
            "vsubpd     zmm18, zmm19, zmm31",                           // left's column
            "vpsubq     zmm17, zmm17, zmm19",
            "vpmovqd    ymm19, zmm19",
            "vpmovqd    ymm17{{k2}}{{z}}, zmm17",
            "vfmadd132pd zmm18, zmm20, [{g} + {PER_COLUMN}]",
            "vpaddd     ymm27, ymm27, ymm19",
            "vmovdqu32  [{to} + {TO_LENGTH}], ymm17",
            "vfmadd132pd zmm18, zmm31, [{g} + {SHADE_INVERSE}]",
            "vmovdqu32  [{to} + {TO_AT}], ymm27",
            "vpmovqw    xmm18, zmm18",
            "vpmovzxwd  ymm18, xmm18",
            "vpord      ymm18, ymm18, [{g} + {STEP}]",
            "vmovdqu32  [{to} + {TO_PAINT}], ymm18",
            g = in(reg) group,
            to = in(reg) to,
            c = in(reg) &raw const CONSTANTS,
            row = in(reg) row,
            down = in(reg) row.wrapping_mul(pitch),
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
            SPLIT = const offset_of!(Group, split),
            ROWS = const offset_of!(Group, rows),
            AT = const offset_of!(Group, at),
            STEP = const offset_of!(Group, step),
            TO_AT = const offset_of!(Row, at),
            TO_LENGTH = const offset_of!(Row, length),
            TO_PAINT = const offset_of!(Row, paint),
            out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm26") _,
            out("zmm27") _, out("zmm31") _, out("k1") _, out("k2") _,
            options(nostack),
        );
    }
}

#[repr(C, align(64))]
struct Constants {
    /// 0: the number of each even pixel of 64.
    even: [u16; 32],
    /// 64: eighths.
    eighths: [f64; LANES],
    /// 128: numbers.
    numbers: [u64; LANES],
    /// 192: both bytes of a 16-bit lane from its upper, for `vpshufb`.
    upper: [u8; 16],
    /// 208: the lowest 16 bits of 64, four times.
    lowest: [u8; 16],
    /// 224
    even_bytes: u64,
    /// 232
    magic: f64,
    /// 240
    eight: u64,
    halves: Halves,
}

/// What set-up adds and multiplies by.
#[repr(C)]
struct Halves {
    /// 0
    sign: u64,
    /// 8
    magnitude: u64,
    /// 16
    half: f64,
    /// 24
    minus_half: f64,
    /// 32
    one: f64,
    /// 40
    half_pixel: f64,
    /// 48
    pixel: f64,
    /// 56
    zero: f64,
    /// 64: 127, 128 and 255.
    units: [i32; 3],
}

static CONSTANTS: Constants = Constants {
    even: {
        let mut even = [0; 32];
        let mut j = 0;
        while j < 32 {
            even[j as usize] = 2 * j;
            j += 1;
        }
        even
    },
    eighths: [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875],
    numbers: [0, 1, 2, 3, 4, 5, 6, 7],
    upper: [1, 1, 3, 3, 5, 5, 7, 7, 9, 9, 11, 11, 13, 13, 15, 15],
    lowest: [0, 1, 0, 1, 0, 1, 0, 1, 8, 9, 8, 9, 8, 9, 8, 9],
    even_bytes: 0x5555_5555_5555_5555,
    magic: MAGIC,
    eight: 8,
    halves: Halves {
        sign: 1 << 63,
        magnitude: !(1 << 63),
        half: 0.5,
        minus_half: -0.5,
        one: 1.0,
        half_pixel: 128.0,
        pixel: 256.0,
        zero: 0.0,
        units: [127, 128, 255],
    },
};

impl Tall {
    pub(super) const fn new() -> Self {
        Self {
            at: [0; LANES],
            length: [0; LANES],
            paint: [0; LANES],
            n: [0.0; LANES],
            covered: [0; LANES],
            spans: [0; LANES],
            long: Edge::NONE,
            upper: Edge::NONE,
            lower: Edge::NONE,
            shade: Edge::NONE,
            per_column: 0.0,
            per_piece: 0.0,
            begin: 0,
            end: 0,
            size: 0,
            offset: 0,
            per_eight: 0,
            rows: 0,
            split: 0,
            round: 0,
            shift: 0,
            reseeds: 0,
            step: 0,
            step_64: 0,
        }
    }

    /// Spans, pieces of reseeded ones counted each, and pixels of all triangles that it has drawn.
    pub(super) fn drawn(&self) -> (u32, u32) {
        // Of at most 128 triangles of 256 × 256 pixels.
        (self.spans.iter().sum::<u64>() as u32, self.covered.iter().sum::<u64>() as u32)
    }

    /// Draws triangle `i` of a group.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true.
    #[inline]
    pub(super) unsafe fn draw(&mut self, group: &Group, i: usize, shading: Shading, place: Place, pixels: &mut [u8]) {
        // Rows of a triangle are at most 256.
        let Ok(rows @ 1..) = u64::try_from(group.rows[i]) else { return };
        let pixels = pixels.as_mut_ptr_range();
        (self.begin, self.end) = (pixels.start.addr() as u64, pixels.end.addr() as u64);
        self.size = self.end - self.begin;
        self.long = Edge::of(&group.long, i);
        self.upper = Edge::of(&group.upper, i);
        self.lower = Edge::of(&group.lower, i);
        let (per_row, inverse) = (group.per_row[i], group.inverse[i]);
        self.shade = Edge { n: group.n[i], per_eight: per_row * LANES as f64, inverse };
        self.per_column = group.per_column[i];
        self.per_piece = group.per_column[i] * f64::from(RESEED);
        // Not negative: the triangle lies inside the frame. If it were, its rows would lie outside and not be drawn.
        self.offset = self.begin.wrapping_add(i64::from(group.at[i]) as u64).wrapping_sub(MAGIC.to_bits());
        self.per_eight = LANES as u64 * u64::from(place.pitch);
        (self.rows, self.split) = (rows, i64::from(group.split[i]) as u64);
        // Of at most 256 pixels a row.
        let reseeds = shading == Shading::GouraudReseeded;
        (self.round, self.shift) = if reseeds { (RESEED as u64 - 1, RESEED.ilog2().into()) } else { (255, 8) };
        self.reseeds = reseeds.into();
        // Its upper half is the step.
        let step = (group.step[i] as u32) >> 16;
        self.step = step * 0x1_0001;
        self.step_64 = (step * 64 & 0xFFFF) * 0x1_0001;
        // SAFETY: the caller has AVX-512 F, BW, DQ, VL and BMI2 found. Read and written are `self` and `CONSTANTS` at the
        // offsets of their fields, and by masks and whole vectors pixels: of each row `length` bytes from `at` on,
        // where the length is 0 unless `length ≤ size`, `at ≥ begin` and `at ≤ end − length`, all without sign.
        // Rows of length 0 have the address `begin`, where a mask leaves all bytes. The stack is not used; flags and
        // all registers written are given up.
        unsafe {
            asm!(
                // Constants of the triangle.
                "vpbroadcastd zmm24, dword ptr [{t} + {STEP}]",
                "vpmullw    zmm29, zmm24, [{c}]",                       // even pixels, from the row's first
                "vpaddw     zmm28, zmm29, zmm24",                       // odd pixels
                "vbroadcastsd zmm31, qword ptr [{c} + 232]",            // magic
                "vbroadcasti32x4 zmm27, [{c} + 192]",                   // upper
                "vbroadcasti32x4 zmm30, [{c} + 208]",                   // lowest
                "vpbroadcastq zmm26, qword ptr [{t} + {END}]",
                "kmovq      k2, [{c} + 224]",                           // even_bytes
                "mov        {ones}, -1",
                // Numerators in the first eight rows.
                "vmovapd    zmm22, [{c} + 64]",                         // eighths
                "vmulpd     zmm16, zmm22, qword ptr [{t} + {LONG} + 8]{{1to8}}",
                "vmulpd     zmm17, zmm22, qword ptr [{t} + {UPPER} + 8]{{1to8}}",
                "vmulpd     zmm18, zmm22, qword ptr [{t} + {LOWER} + 8]{{1to8}}",
                "vmulpd     zmm19, zmm22, qword ptr [{t} + {SHADE} + 8]{{1to8}}",
                "vaddpd     zmm16, zmm16, qword ptr [{t} + {LONG}]{{1to8}}",
                "vaddpd     zmm17, zmm17, qword ptr [{t} + {UPPER}]{{1to8}}",
                "vaddpd     zmm18, zmm18, qword ptr [{t} + {LOWER}]{{1to8}}",
                "vaddpd     zmm19, zmm19, qword ptr [{t} + {SHADE}]{{1to8}}",
                "vmovdqa64  zmm20, [{c} + 128]",                        // numbers of the rows
                "vpmullq    zmm21, zmm20, qword ptr [{t} + {PITCH}]{{1to8}}",
                "vpsrlq     zmm21, zmm21, 3",
                "vpaddq     zmm21, zmm21, qword ptr [{t} + {OFFSET}]{{1to8}}",

                ".p2align   5",
                "2:",                                                   // eight rows
                "vmulpd     zmm22, zmm16, qword ptr [{t} + {LONG} + 16]{{1to8}}",
                "vmulpd     zmm23, zmm17, qword ptr [{t} + {UPPER} + 16]{{1to8}}",
                "vpcmpq     k1, zmm20, qword ptr [{t} + {SPLIT}]{{1to8}}, 5", // not less
                "vmulpd     zmm23{{k1}}, zmm18, qword ptr [{t} + {LOWER} + 16]{{1to8}}",
                "vaddpd     zmm22, zmm22, zmm31",                       // long
                "vaddpd     zmm23, zmm23, zmm31",                       // short
                "vminpd     zmm24, zmm22, zmm23",                       // left
                "vmaxpd     zmm22, zmm22, zmm23",                       // right
                "vpcmpq     k1, zmm20, qword ptr [{t} + {ROWS}]{{1to8}}, 1", // less
                "vpsubq     zmm22, zmm22, zmm24",                       // length
                "vpaddq     zmm23, zmm24, zmm21",                       // at
                "vpcmpuq    k1{{k1}}, zmm22, qword ptr [{t} + {SIZE}]{{1to8}}, 2", // not greater
                "vpsubq     zmm25, zmm26, zmm22",                       // end − length
                "vpcmpuq    k1{{k1}}, zmm23, qword ptr [{t} + {BEGIN}]{{1to8}}, 5", // not less
                "vpcmpuq    k1{{k1}}, zmm23, zmm25, 2",                 // not greater
                "vpbroadcastq zmm25, qword ptr [{t} + {BEGIN}]",
                "vmovdqa64  zmm22{{k1}}{{z}}, zmm22",
                "vmovdqa64  zmm25{{k1}}, zmm23",
                "vmovdqa64  [{t} + 64], zmm22",
                "vmovdqa64  [{t}], zmm25",
                "vsubpd     zmm24, zmm24, zmm31",                       // left's column
                "vfmadd132pd zmm24, zmm19, qword ptr [{t} + {PER_COLUMN}]{{1to8}}", // numerator
                "vmovapd    [{t} + 192], zmm24",
                "vfmadd132pd zmm24, zmm31, qword ptr [{t} + {SHADE} + 16]{{1to8}}",
                "vpshufb    zmm24, zmm24, zmm30",
                "vmovdqa64  [{t} + 128], zmm24",
                "vpaddq     zmm25, zmm22, [{t} + {COVERED}]",
                "vmovdqa64  [{t} + {COVERED}], zmm25",
                "vpaddq     zmm22, zmm22, qword ptr [{t} + {ROUND}]{{1to8}}",
                "vpsrlvq    zmm22, zmm22, qword ptr [{t} + {SHIFT}]{{1to8}}",
                "vpaddq     zmm22, zmm22, [{t} + {SPANS}]",
                "vmovdqa64  [{t} + {SPANS}], zmm22",
                "vaddpd     zmm16, zmm16, qword ptr [{t} + {LONG} + 8]{{1to8}}",
                "vaddpd     zmm17, zmm17, qword ptr [{t} + {UPPER} + 8]{{1to8}}",
                "vaddpd     zmm18, zmm18, qword ptr [{t} + {LOWER} + 8]{{1to8}}",
                "vaddpd     zmm19, zmm19, qword ptr [{t} + {SHADE} + 8]{{1to8}}",
                "vpaddq     zmm20, zmm20, qword ptr [{c} + 240]{{1to8}}",
                "vpaddq     zmm21, zmm21, qword ptr [{t} + {PITCH}]{{1to8}}",

                "mov        {j}, -8",
                ".p2align   5",
                "3:",                                                   // a row
                "mov        {length}, [{t} + 8*{j} + 128]",
                "mov        {at}, [{t} + 8*{j} + 64]",
                "vpbroadcastd zmm22, dword ptr [{t} + 8*{j} + 192]",
                "cmp        {length}, 32",
                "ja         5f",
                "bzhi       {mask:e}, {ones:e}, {length:e}",
                "vpaddw     ymm23, ymm22, ymm28",
                "vpaddw     ymm22, ymm22, ymm29",
                "kmovd      k1, {mask:e}",
                "vpshufb    ymm23{{k2}}, ymm22, ymm27",
                "vmovdqu8   [{at}]{{k1}}, ymm23",
                "inc        {j}",
                "jnz        3b",
                "sub        {rows}, 8",
                "ja         2b",
                "jmp        8f",
                ".p2align   5",
                "5:",
                "cmp        {length}, 64",
                "ja         5f",
                "4:",                                                   // its last 64 pixels or less
                "bzhi       {mask}, {ones}, {length}",
                "vpaddw     zmm23, zmm22, zmm28",                       // odd
                "vpaddw     zmm22, zmm22, zmm29",                       // even
                "vpshufb    zmm23{{k2}}, zmm22, zmm27",                 // and the upper bytes of even
                "kmovq      k1, {mask}",
                "vmovdqu8   [{at}]{{k1}}, zmm23",
                "inc        {j}",
                "jnz        3b",
                "sub        {rows}, 8",
                "ja         2b",
                "jmp        8f",

                "5:",                                                   // more than 64 pixels are left
                "vmovsd     xmm24, qword ptr [{t} + 8*{j} + 256]",
                "6:",
                "vpaddw     zmm23, zmm22, zmm28",
                "vpaddw     zmm25, zmm22, zmm29",
                "vpshufb    zmm23{{k2}}, zmm25, zmm27",
                "vmovdqu64  [{at}], zmm23",
                "add        {at}, 64",
                "sub        {length}, 64",
                "cmp        qword ptr [{t} + {RESEEDS}], 0",
                "je         7f",
                "vaddsd     xmm24, xmm24, qword ptr [{t} + {PER_PIECE}]",
                "vmovapd    xmm22, xmm24",
                "vfmadd132sd xmm22, xmm31, qword ptr [{t} + {SHADE} + 16]",
                "vpbroadcastw zmm22, xmm22",
                "cmp        {length}, 64",
                "ja         6b",
                "jmp        4b",
                "7:",                                                   // the ramp goes on
                "vpbroadcastd zmm25, dword ptr [{t} + {STEP_64}]",
                "vpaddw     zmm22, zmm22, zmm25",
                "cmp        {length}, 64",
                "ja         6b",
                "jmp        4b",
                "8:",
                t = in(reg) &raw mut *self,
                c = in(reg) &raw const CONSTANTS,
                rows = inout(reg) rows => _,
                j = out(reg) _,
                at = out(reg) _,
                length = out(reg) _,
                mask = out(reg) _,
                ones = out(reg) _,
                LONG = const offset_of!(Self, long),
                UPPER = const offset_of!(Self, upper),
                LOWER = const offset_of!(Self, lower),
                SHADE = const offset_of!(Self, shade),
                PER_COLUMN = const offset_of!(Self, per_column),
                PER_PIECE = const offset_of!(Self, per_piece),
                BEGIN = const offset_of!(Self, begin),
                END = const offset_of!(Self, end),
                SIZE = const offset_of!(Self, size),
                OFFSET = const offset_of!(Self, offset),
                PITCH = const offset_of!(Self, per_eight),
                ROWS = const offset_of!(Self, rows),
                SPLIT = const offset_of!(Self, split),
                COVERED = const offset_of!(Self, covered),
                SPANS = const offset_of!(Self, spans),
                ROUND = const offset_of!(Self, round),
                SHIFT = const offset_of!(Self, shift),
                RESEEDS = const offset_of!(Self, reseeds),
                STEP = const offset_of!(Self, step),
                STEP_64 = const offset_of!(Self, step_64),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
                out("zmm28") _, out("zmm29") _, out("zmm30") _, out("zmm31") _, out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }
}
