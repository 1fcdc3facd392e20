//! Rows of short triangles: of eight triangles at once, put into the order of the list, or eight rows of one triangle
//! after the other.

use core::arch::asm;
use core::mem::offset_of;

use super::{CONSTANTS, Planes, SIXTEEN, Spans};
use crate::raster::batch::rows::{Edges, Group, LANES};

/// Order in which sixteen rows out of four times eight enter the span list: triangle by triangle.
#[repr(C, align(64))]
pub(super) struct Order {
    /// 0: which row of a triangle's eight: those of the first row are numbers 0 to 7, those of the second 8 to 15.
    from: [u32; SIXTEEN],
    /// 64: of which triangle, ...
    triangle: [u32; SIXTEEN],
    /// 128: ... and which of its rows.
    row: [u32; SIXTEEN],
}

impl Order {
    /// The order of `rows` rows of each triangle, from triangle `first` on.
    pub(super) const fn of(rows: u32, first: u32) -> Self {
        let mut order = Self { from: [0; SIXTEEN], triangle: [0; SIXTEEN], row: [0; SIXTEEN] };
        let mut i = 0;
        while i < SIXTEEN as u32 {
            let (triangle, row) = (first + i / rows, i % rows);
            order.from[i as usize] = row * LANES as u32 + triangle;
            (order.triangle[i as usize], order.row[i as usize]) = (triangle, row);
            i += 1;
        }
        order
    }
}

impl Spans {
    /// Lists up to eight rows from number `first` on of each of these triangles of a group: as `list`, but that nothing is left
    /// out.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true; the triangles are some of the eight, and there is room for
    /// eight times as many.
    #[inline(always)]
    pub(super) unsafe fn list_each(
        &mut self,
        group: &Group,
        (begin, end): (usize, usize),
        first: i32,
        planes: &Planes,
    ) {
        debug_assert!(begin < LANES && end <= LANES);
        // SAFETY: the caller has AVX-512 F, DQ and VL and POPCNT found. Read are `CONSTANTS`, and `group`, `planes` and `self` at
        // the offsets of their fields, of those that hold eight numbers those from `begin` to `end`, or that at `begin`. Written are, for each triangle,
        // eight numbers from number `count` on, which is at most eight more with each, and so below `CAPACITY + LANES`. The stack is
        // not used; flags and all registers written are given up.
        unsafe {
            asm!(
                "vpbroadcastd ymm26, {first:e}",
                "vpaddd     ymm26, ymm26, [{c} + 192]",                     // rows
                "vbroadcastsd zmm31, qword ptr [{c} + 224]",                // magic
                "vcvtdq2pd  zmm16, ymm26",                                  // j
                "vpmovsxdq  zmm30, ymm26",
                "vpmulld    ymm28, ymm26, dword ptr [{l} + {PITCH}]{{1to8}}",
                "vpmulld    ymm29, ymm26, dword ptr [{l} + {WIDTH}]{{1to8}}",
                "vpbroadcastd ymm27, dword ptr [{l} + {PIXELS}]",
                "vpbroadcastd ymm25, dword ptr [{l} + {CELLS}]",
                "vpbroadcastd ymm23, dword ptr [{c} + 236]",                // shade
                ".p2align   5",
                "2:",
                "vbroadcastsd zmm17, qword ptr [{g} + 8*{i} + {LONG} + {N}]",
                "vbroadcastsd zmm18, qword ptr [{g} + 8*{i} + {UPPER} + {N}]",
                "vbroadcastsd zmm19, qword ptr [{g} + 8*{i} + {LOWER} + {N}]",
                "vbroadcastsd zmm20, qword ptr [{g} + 8*{i} + {SHADE_N}]",
                "vpcmpd     k1, ymm26, dword ptr [{g} + 4*{i} + {SPLIT}]{{1to8}}, 5", // not less
                "vfmadd231pd zmm17, zmm16, qword ptr [{g} + 8*{i} + {LONG} + {PER_ROW}]{{1to8}}",
                "vfmadd231pd zmm18, zmm16, qword ptr [{g} + 8*{i} + {UPPER} + {PER_ROW}]{{1to8}}",
                "vfmadd231pd zmm19, zmm16, qword ptr [{g} + 8*{i} + {LOWER} + {PER_ROW}]{{1to8}}",
                "vfmadd231pd zmm20, zmm16, qword ptr [{g} + 8*{i} + {SHADE_PER_ROW}]{{1to8}}",
                "vpcmpd     k2, ymm26, dword ptr [{g} + 4*{i} + {ROWS}]{{1to8}}, 1", // less
                "vfmadd132pd zmm17, zmm31, qword ptr [{g} + 8*{i} + {LONG} + {INVERSE}]{{1to8}}",
                "vfmadd132pd zmm18, zmm31, qword ptr [{g} + 8*{i} + {UPPER} + {INVERSE}]{{1to8}}",
                "vfmadd132pd zmm19, zmm31, qword ptr [{g} + 8*{i} + {LOWER} + {INVERSE}]{{1to8}}",
                "vmovapd    zmm18{{k1}}, zmm19",                            // short
                "vminpd     zmm19, zmm17, zmm18",                           // left
                "vmaxpd     zmm17, zmm17, zmm18",                           // right
                "vsubpd     zmm18, zmm19, zmm31",                           // column
                "vpsubq     zmm21, zmm19, zmm31",                           // as a whole number
                "vpsubq     zmm17, zmm17, zmm19",
                "vfmadd132pd zmm18, zmm20, qword ptr [{g} + 8*{i} + {PER_COLUMN}]{{1to8}}",
                "vfmadd132pd zmm18, zmm31, qword ptr [{g} + 8*{i} + {SHADE_INVERSE}]{{1to8}}",
                "vpmovqd    ymm19, zmm21",
                "vpmovqd    ymm17, zmm17",                                  // length
                "vpmovqd    ymm18, zmm18",
                "vpaddd     ymm22, ymm28, dword ptr [{g} + 4*{i} + {AT}]{{1to8}}",
                "vpaddd     ymm24, ymm29, dword ptr [{l} + 4*{i} + {FIRST_CELL}]{{1to8}}",
                "vpternlogd ymm18, ymm23, dword ptr [{g} + 4*{i} + {STEP}]{{1to8}}, 0xEA", // shade | step
                "vpaddd     ymm22, ymm22, ymm19",                           // at
                "vpaddd     ymm24, ymm24, ymm19",                           // cell
                "vpxord     ymm20, ymm20, ymm20",
                "vpcmpd     k2{{k2}}, ymm17, ymm20, 6",                     // greater
                "vpsubd     ymm19, ymm27, ymm17",
                "vpsubd     ymm20, ymm25, ymm17",
                "vpcmpud    k2{{k2}}, ymm17, ymm27, 2",                     // not greater
                "vpcmpud    k2{{k2}}, ymm17, ymm25, 2",
                "vpcmpud    k2{{k2}}, ymm22, ymm19, 2",
                "vpcmpud    k2{{k2}}, ymm24, ymm20, 2",
                // Depths.
                "vpbroadcastq zmm20, qword ptr [{p} + 8*{i} + {DEPTH_PER_COLUMN}]",
                "vpmullq    zmm19, zmm30, qword ptr [{p} + 8*{i} + {DEPTH_PER_ROW}]{{1to8}}",
                "vpmullq    zmm21, zmm21, zmm20",
                "vpaddq     zmm19, zmm19, qword ptr [{p} + 8*{i} + {DEPTH}]{{1to8}}",
                "vpaddq     zmm21, zmm21, zmm19",
                "vpsllq     zmm20, zmm20, 8",
                "vpsllq     zmm21, zmm21, 8",
                "vpcompressd ymm22{{k2}}{{z}}, ymm22",
                "vpcompressd ymm24{{k2}}{{z}}, ymm24",
                "vpcompressd ymm17{{k2}}{{z}}, ymm17",
                "vpcompressd ymm18{{k2}}{{z}}, ymm18",
                "vpcompressq zmm21{{k2}}{{z}}, zmm21",
                "vmovdqu32  [{l} + 4*{count} + {LIST_AT}], ymm22",
                "vmovdqu32  [{l} + 4*{count} + {CELL}], ymm24",
                "vmovdqu32  [{l} + 4*{count} + {LENGTH}], ymm17",
                "vmovdqu32  [{l} + 4*{count} + {PAINT}], ymm18",
                "vmovdqu64  [{l} + 8*{count} + {Z}], zmm21",
                "vmovdqu64  [{l} + 8*{count} + {DZ}], zmm20",
                "vpaddd     ymm17, ymm17, [{l} + {COVERED}]",
                "vmovdqu32  [{l} + {COVERED}], ymm17",
                "kmovb      {more:e}, k2",
                "popcnt     {more:e}, {more:e}",
                "add        {count}, {more}",
                "inc        {i}",
                "cmp        {i}, {end}",
                "jb         2b",
                g = in(reg) group,
                p = in(reg) planes,
                l = in(reg) &raw mut *self,
                c = in(reg) &raw const CONSTANTS,
                i = inout(reg) begin => _,
                end = in(reg) end,
                first = in(reg) first,
                more = out(reg) _,
                count = inout(reg) self.count,
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
                DEPTH = const offset_of!(Planes, at),
                DEPTH_PER_COLUMN = const offset_of!(Planes, per_column),
                DEPTH_PER_ROW = const offset_of!(Planes, per_row),
                FIRST_CELL = const offset_of!(Self, first_cell),
                LIST_AT = const offset_of!(Self, at),
                CELL = const offset_of!(Self, cell),
                LENGTH = const offset_of!(Self, length),
                PAINT = const offset_of!(Self, paint),
                Z = const offset_of!(Self, z),
                DZ = const offset_of!(Self, dz),
                COVERED = const offset_of!(Self, covered),
                PIXELS = const offset_of!(Self, pixels),
                CELLS = const offset_of!(Self, cells),
                PITCH = const offset_of!(Self, pitch),
                WIDTH = const offset_of!(Self, width),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
                out("zmm28") _, out("zmm29") _, out("zmm30") _, out("zmm31") _, out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }

    /// Row number `row` of a group's triangles, which are so many.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true; `row` is below `FEW_ROWS`.
    #[inline(always)]
    pub(super) unsafe fn row(&mut self, group: &Group, triangles: usize, row: u32) {
        // SAFETY: the caller has AVX-512 F, BW, DQ and VL found. Read are `group` and `CONSTANTS` at the offsets of their
        // fields; written are eight numbers each of the fields that begin with `row`, from number 8·`row` on. The stack is
        // not used; flags and all registers written are given up.
        unsafe {
            asm!(
                "vpbroadcastd ymm26, {row:e}",
                "kmovd      k2, {mask:e}",
                "vcvtdq2pd  zmm16, ymm26",                                  // j
                "vbroadcastsd zmm31, qword ptr [{c} + 224]",                // magic
                "vmovupd    zmm17, [{g} + {LONG} + {PER_ROW}]",
                "vmovupd    zmm18, [{g} + {UPPER} + {PER_ROW}]",
                "vmovupd    zmm19, [{g} + {LOWER} + {PER_ROW}]",
                "vmovupd    zmm20, [{g} + {SHADE_PER_ROW}]",
                "vpcmpd     k1, ymm26, [{g} + {SPLIT}], 5",                 // not less
                "vfmadd213pd zmm17, zmm16, [{g} + {LONG} + {N}]",
                "vfmadd213pd zmm18, zmm16, [{g} + {UPPER} + {N}]",
                "vfmadd213pd zmm19, zmm16, [{g} + {LOWER} + {N}]",
                "vfmadd213pd zmm20, zmm16, [{g} + {SHADE_N}]",
                "vpcmpd     k2{{k2}}, ymm26, [{g} + {ROWS}], 1",            // less
                "vfmadd132pd zmm17, zmm31, [{g} + {LONG} + {INVERSE}]",
                "vfmadd132pd zmm18, zmm31, [{g} + {UPPER} + {INVERSE}]",
                "vfmadd132pd zmm19, zmm31, [{g} + {LOWER} + {INVERSE}]",
                "vpbroadcastd ymm27, {down:e}",
                "vmovapd    zmm18{{k1}}, zmm19",                            // short
                "vpaddd     ymm27, ymm27, [{g} + {AT}]",
                "vminpd     zmm19, zmm17, zmm18",                           // left
                "vmaxpd     zmm17, zmm17, zmm18",                           // right
                "vsubpd     zmm18, zmm19, zmm31",                           // column
                "vpsubq     zmm17, zmm17, zmm19",
                "vpmovqd    ymm19, zmm19",
                "vpmovqd    ymm17{{k2}}{{z}}, zmm17",
                "vfmadd132pd zmm18, zmm20, [{g} + {PER_COLUMN}]",
                "vpaddd     ymm27, ymm27, ymm19",
                "vmovdqu32  [{to} + {ROW_LENGTH}], ymm17",
                "vmovdqu32  [{to} + {ROW_COLUMN}], ymm19",
                "vfmadd132pd zmm18, zmm31, [{g} + {SHADE_INVERSE}]",
                "vmovdqu32  [{to} + {ROW_AT}], ymm27",
                "vpmovqw    xmm18, zmm18",
                "vpmovzxwd  ymm18, xmm18",
                "vpord      ymm18, ymm18, [{g} + {STEP}]",
                "vmovdqu32  [{to} + {ROW_PAINT}], ymm18",
                g = in(reg) group,
                to = in(reg) (&raw mut *self).cast::<u32>().wrapping_add(LANES * row as usize),
                c = in(reg) &raw const CONSTANTS,
                row = in(reg) row,
                mask = in(reg) (1_u32 << triangles.min(LANES)) - 1,
                down = in(reg) row.wrapping_mul(self.pitch),
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
                ROW_AT = const offset_of!(Self, row_at),
                ROW_LENGTH = const offset_of!(Self, row_length),
                ROW_PAINT = const offset_of!(Self, row_paint),
                ROW_COLUMN = const offset_of!(Self, row_column),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm26") _,
                out("zmm27") _, out("zmm31") _, out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }

    /// Lists sixteen rows in this order.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true; the rows have been written, and there is room for
    /// sixteen.
    #[inline(always)]
    pub(super) unsafe fn list_sixteen(&mut self, order: &Order, planes: Option<&Planes>) {
        let planes = planes.map_or(core::ptr::null(), |planes| &raw const *planes);
        // SAFETY: the caller has AVX-512 F, BW, DQ and VL and POPCNT found. Read are `order`, `planes` and `self` at the offsets
        // of their fields; written are sixteen numbers from number `count` on, and so below `CAPACITY + SIXTEEN`, of z and dz
        // eight and eight more from where the first end. Without `planes` nothing is read of them. The stack is not used;
        // flags and all registers written are given up.
        unsafe {
            asm!(
                "vmovdqa64  zmm16, [{o}]",
                "vmovdqa64  zmm17, [{l} + {ROW_AT}]",
                "vmovdqa64  zmm18, [{l} + {ROW_LENGTH}]",
                "vmovdqa64  zmm19, [{l} + {ROW_PAINT}]",
                "vpermt2d   zmm18, zmm16, [{l} + {ROW_LENGTH} + 64]",
                "vpermt2d   zmm17, zmm16, [{l} + {ROW_AT} + 64]",
                "vpermt2d   zmm19, zmm16, [{l} + {ROW_PAINT} + 64]",
                "vpxord     zmm22, zmm22, zmm22",
                "vpbroadcastd zmm21, dword ptr [{l} + {PIXELS}]",
                "vpcmpd     k1, zmm18, zmm22, 6",                           // greater
                "vpsubd     zmm22, zmm21, zmm18",
                "vpcmpud    k1{{k1}}, zmm18, zmm21, 2",                     // not greater
                "vpcmpud    k1{{k1}}, zmm17, zmm22, 2",
                "test       {p}, {p}",
                "jz         2f",
                // Depths.
                "vmovdqa64  zmm20, [{l} + {ROW_COLUMN}]",
                "vmovdqa64  zmm23, [{o} + 64]",                             // triangle
                "vmovdqa64  zmm24, [{o} + 128]",                            // row
                "vpermt2d   zmm20, zmm16, [{l} + {ROW_COLUMN} + 64]",
                "vpmulld    zmm21, zmm24, dword ptr [{l} + {WIDTH}]{{1to16}}",
                "vpermd     zmm22, zmm23, [{l} + {FIRST_CELL}]",
                "vpaddd     zmm21, zmm21, zmm20",
                "vpaddd     zmm21, zmm21, zmm22",                           // cell
                "vpbroadcastd zmm25, dword ptr [{l} + {CELLS}]",
                "vpsubd     zmm22, zmm25, zmm18",
                "vpcmpud    k1{{k1}}, zmm18, zmm25, 2",
                "vpcmpud    k1{{k1}}, zmm21, zmm22, 2",
                "vpmovzxdq  zmm25, ymm23",
                "vpmovzxdq  zmm26, ymm24",
                "vpmovzxdq  zmm27, ymm20",
                "vpermq     zmm28, zmm25, [{p} + {DEPTH_PER_COLUMN}]",
                "vpermq     zmm29, zmm25, [{p} + {DEPTH_PER_ROW}]",
                "vpermq     zmm30, zmm25, [{p} + {DEPTH}]",
                "vpmullq    zmm27, zmm27, zmm28",
                "vpmullq    zmm26, zmm26, zmm29",
                "vpaddq     zmm30, zmm30, zmm27",
                "vpaddq     zmm30, zmm30, zmm26",
                "vpsllq     zmm28, zmm28, 8",
                "vpsllq     zmm30, zmm30, 8",
                "vpcompressq zmm28{{k1}}{{z}}, zmm28",
                "vpcompressq zmm30{{k1}}{{z}}, zmm30",
                "vmovdqu64  [{l} + 8*{count} + {DZ}], zmm28",
                "vmovdqu64  [{l} + 8*{count} + {Z}], zmm30",
                "kmovb      {more:e}, k1",
                "popcnt     {more:e}, {more:e}",
                "add        {more}, {count}",
                "kshiftrw   k2, k1, 8",
                "vextracti64x4 ymm23, zmm23, 1",
                "vextracti64x4 ymm24, zmm24, 1",
                "vextracti64x4 ymm20, zmm20, 1",
                "vpmovzxdq  zmm25, ymm23",
                "vpmovzxdq  zmm26, ymm24",
                "vpmovzxdq  zmm27, ymm20",
                "vpermq     zmm28, zmm25, [{p} + {DEPTH_PER_COLUMN}]",
                "vpermq     zmm29, zmm25, [{p} + {DEPTH_PER_ROW}]",
                "vpermq     zmm30, zmm25, [{p} + {DEPTH}]",
                "vpmullq    zmm27, zmm27, zmm28",
                "vpmullq    zmm26, zmm26, zmm29",
                "vpaddq     zmm30, zmm30, zmm27",
                "vpaddq     zmm30, zmm30, zmm26",
                "vpsllq     zmm28, zmm28, 8",
                "vpsllq     zmm30, zmm30, 8",
                "vpcompressq zmm28{{k2}}{{z}}, zmm28",
                "vpcompressq zmm30{{k2}}{{z}}, zmm30",
                "vmovdqu64  [{l} + 8*{more} + {DZ}], zmm28",
                "vmovdqu64  [{l} + 8*{more} + {Z}], zmm30",
                "vpcompressd zmm21{{k1}}{{z}}, zmm21",
                "vmovdqu32  [{l} + 4*{count} + {CELL}], zmm21",
                "2:",
                "vpcompressd zmm17{{k1}}{{z}}, zmm17",
                "vpcompressd zmm18{{k1}}{{z}}, zmm18",
                "vpcompressd zmm19{{k1}}{{z}}, zmm19",
                "vmovdqu32  [{l} + 4*{count} + {LIST_AT}], zmm17",
                "vmovdqu32  [{l} + 4*{count} + {LENGTH}], zmm18",
                "vmovdqu32  [{l} + 4*{count} + {PAINT}], zmm19",
                "vpaddd     zmm18, zmm18, [{l} + {COVERED}]",
                "vmovdqa64  [{l} + {COVERED}], zmm18",
                "kmovw      {more:e}, k1",
                "popcnt     {more:e}, {more:e}",
                "add        {count}, {more}",
                o = in(reg) order,
                p = in(reg) planes,
                l = in(reg) &raw mut *self,
                more = out(reg) _,
                count = inout(reg) self.count,
                DEPTH = const offset_of!(Planes, at),
                DEPTH_PER_COLUMN = const offset_of!(Planes, per_column),
                DEPTH_PER_ROW = const offset_of!(Planes, per_row),
                ROW_AT = const offset_of!(Self, row_at),
                ROW_LENGTH = const offset_of!(Self, row_length),
                ROW_PAINT = const offset_of!(Self, row_paint),
                ROW_COLUMN = const offset_of!(Self, row_column),
                FIRST_CELL = const offset_of!(Self, first_cell),
                LIST_AT = const offset_of!(Self, at),
                CELL = const offset_of!(Self, cell),
                LENGTH = const offset_of!(Self, length),
                PAINT = const offset_of!(Self, paint),
                Z = const offset_of!(Self, z),
                DZ = const offset_of!(Self, dz),
                COVERED = const offset_of!(Self, covered),
                PIXELS = const offset_of!(Self, pixels),
                CELLS = const offset_of!(Self, cells),
                WIDTH = const offset_of!(Self, width),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
                out("zmm28") _, out("zmm29") _, out("zmm30") _, out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }
}
