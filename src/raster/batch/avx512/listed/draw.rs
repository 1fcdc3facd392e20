//! The list to pixels, sixteen a turn.

use core::arch::asm;
use core::mem::offset_of;

use super::{CONSTANTS, Spans};

impl Spans {
    /// Draws the span list, and empties it.
    ///
    /// # Safety
    /// See `add`; `pixels` and `cells` are those of which it was told.
    #[inline(always)]
    pub(in crate::raster::batch) unsafe fn draw(&mut self, with_depths: bool, pixels: &mut [u8], cells: &mut [u32]) {
        debug_assert!(self.pixels as usize <= pixels.len() && self.cells as usize <= cells.len());
        if self.count == 0 {
            return;
        }
        // SAFETY: by the caller's promise; there is a span.
        unsafe {
            if with_depths {
                self.draw_nearer(pixels.as_mut_ptr(), cells.as_mut_ptr());
            } else {
                self.draw_all(pixels.as_mut_ptr());
            }
        }
        // At most 2⁷ at a time; the sum is meant modulo 2³², as `DrawStats`.
        self.drawn = self.drawn.wrapping_add(self.count as u32);
        self.count = 0;
    }

    /// # Safety
    /// See `draw`; there is a span.
    #[inline(always)]
    unsafe fn draw_all(&self, pixels: *mut u8) {
        // SAFETY: the caller has AVX-512 F, BW, DQ, VL and BMI2 found. Read are the first `count` numbers of the list, which
        // `list` has written, and `CONSTANTS`. Written are, by masks, of each span `length` pixels from number `at` on,
        // all of which lie inside the pixels: `list` keeps no others. The stack is not used; flags and all registers
        // written are given up.
        unsafe {
            asm!(
                "vmovdqa64  zmm22, [{c}]",                                  // even
                ".p2align   5",
                "2:",
                "mov        {at:e}, [{l} + 4*{k} + {AT}]",
                "mov        {length:e}, [{l} + 4*{k} + {LENGTH}]",
                "add        {at}, {pixels}",
                "cmp        {length:e}, 16",
                "ja         3f",
                "vpbroadcastw xmm16, word ptr [{l} + 4*{k} + {PAINT} + 2]", // step
                "vpbroadcastw xmm17, word ptr [{l} + 4*{k} + {PAINT}]",
                "bzhi       {length:e}, {ones:e}, {length:e}",
                "vpmullw    xmm18, xmm16, xmm22",
                "vpaddw     xmm18, xmm18, xmm17",                           // even
                "kmovd      k1, {length:e}",
                "vpaddw     xmm19, xmm18, xmm16",                           // odd
                "vpsrlw     xmm18, xmm18, 8",
                "vpternlogd xmm18, xmm19, dword ptr [{c} + 232]{{1to4}}, 0xF8", // even >> 8 | odd & 0xFF00
                "vmovdqu8   [{at}]{{k1}}, xmm18",
                "inc        {k}",
                "cmp        {k}, {count}",
                "jb         2b",
                "jmp        4f",
                "3:",
                "vpbroadcastw zmm16, word ptr [{l} + 4*{k} + {PAINT} + 2]",
                "vpbroadcastw zmm17, word ptr [{l} + 4*{k} + {PAINT}]",
                "vpmullw    zmm18, zmm16, zmm22",
                "vpaddw     zmm18, zmm18, zmm17",
                "cmp        {length:e}, 64",
                "jbe        6f",
                "vpsllw     zmm20, zmm16, 6",
                "5:",                                                       // more than 64 are left
                "vpaddw     zmm19, zmm18, zmm16",
                "vpsrlw     zmm17, zmm18, 8",
                "vpternlogd zmm17, zmm19, dword ptr [{c} + 232]{{1to16}}, 0xF8",
                "vmovdqu64  [{at}], zmm17",
                "vpaddw     zmm18, zmm18, zmm20",
                "add        {at}, 64",
                "sub        {length:e}, 64",
                "cmp        {length:e}, 64",
                "ja         5b",
                "6:",
                "bzhi       {length}, {ones}, {length}",
                "kmovq      k1, {length}",
                "vpaddw     zmm19, zmm18, zmm16",
                "vpsrlw     zmm18, zmm18, 8",
                "vpternlogd zmm18, zmm19, dword ptr [{c} + 232]{{1to16}}, 0xF8",
                "vmovdqu8   [{at}]{{k1}}, zmm18",
                "inc        {k}",
                "cmp        {k}, {count}",
                "jb         2b",
                "4:",
                l = in(reg) self,
                c = in(reg) &raw const CONSTANTS,
                pixels = in(reg) pixels,
                count = in(reg) self.count,
                k = inout(reg) 0_u64 => _,
                ones = in(reg) u64::MAX,
                at = out(reg) _,
                length = out(reg) _,
                AT = const offset_of!(Self, at),
                LENGTH = const offset_of!(Self, length),
                PAINT = const offset_of!(Self, paint),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _,
                out("zmm22") _, out("k1") _,
                options(nostack),
            );
        }
    }

    /// # Safety
    /// See `draw`; there is a span.
    #[inline(always)]
    unsafe fn draw_nearer(&mut self, pixels: *mut u8, cells: *mut u32) {
        let nearer: u64;
        // SAFETY: the caller has AVX-512 F, BW, DQ, VL, BMI2 and POPCNT found. Read are the first `count` numbers of the list,
        // which `list` has written, and `CONSTANTS`. Written are, in sixteens and by masks, of each span `length` pixels from
        // number `at` on, and as many cells from number `cell` on, which are read before; all of these lie inside the
        // pixels and cells: `list` keeps no others. The stack is not used; flags and all registers written are given up.
        unsafe {
            asm!(
                "vmovdqa64  zmm29, [{c} + 64]",                             // numbers
                "vmovdqa64  zmm30, [{c} + 128]",                            // upper
                "vmovdqa64  xmm28, [{c}]",                                  // even
                "vpbroadcastd xmm31, dword ptr [{c} + 232]",                // odd_bytes
                "vmovdqa64  ymm27, [{c} + 256]",                            // numbered
                ".p2align   5",
                "2:",
                "mov        {at:e}, [{l} + 4*{k} + {AT}]",
                "mov        {cell:e}, [{l} + 4*{k} + {CELL}]",
                "mov        {length:e}, [{l} + 4*{k} + {LENGTH}]",
                "vpbroadcastq zmm16, qword ptr [{l} + 8*{k} + {DZ}]",
                "add        {at}, {pixels}",
                "lea        {cell}, [{cells} + 4*{cell}]",
                "vpmullq    zmm17, zmm16, zmm29",
                "vpaddq     zmm17, zmm17, qword ptr [{l} + 8*{k} + {Z}]{{1to8}}",
                "cmp        {length:e}, 8",
                "ja         7f",
                // Eight cells: with sixteen nearly every access is one to two lines of the cache.
                "bzhi       {length:e}, {ones:e}, {length:e}",
                "vpermd     zmm24, zmm30, zmm17",
                "kmovd      k1, {length:e}",
                "vmovdqu32  ymm23{{k1}}{{z}}, [{cell}]",
                "vpbroadcastd ymm21, dword ptr [{l} + 4*{k} + {PAINT}]",
                "vpmaddwd   ymm21, ymm21, ymm27",                           // shade + j·step
                "vpcmpud    k1{{k1}}, ymm24, ymm23, 6",
                "vpsrld     ymm21, ymm21, 8",
                "vmovdqu32  [{cell}]{{k1}}, ymm24",
                "vpmovdb    [{at}]{{k1}}, ymm21",
                "kmovd      {length:e}, k1",
                "popcnt     {length:e}, {length:e}",
                "add        {nearer}, {length}",
                "inc        {k}",
                "cmp        {k}, {count}",
                "jb         2b",
                "jmp        6f",
                "7:",
                "vpbroadcastw xmm19, word ptr [{l} + 4*{k} + {PAINT}]",
                "vpbroadcastw xmm20, word ptr [{l} + 4*{k} + {PAINT} + 2]", // step
                "vpsllq     zmm18, zmm16, 3",
                "vpmullw    xmm21, xmm20, xmm28",
                "vpaddw     xmm21, xmm21, xmm19",                           // even
                "vpaddw     xmm22, xmm21, xmm20",                           // odd
                "vpaddq     zmm18, zmm18, zmm17",
                "cmp        {length:e}, 16",
                "ja         4f",
                "3:",                                                       // the last 1 to 16
                "bzhi       {length:e}, {ones:e}, {length:e}",
                "kmovd      k1, {length:e}",
                "vmovdqu32  zmm23{{k1}}{{z}}, [{cell}]",
                "vmovdqa64  zmm24, zmm17",
                "vpermt2d   zmm24, zmm30, zmm18",
                "vpsrlw     xmm21, xmm21, 8",
                "vpternlogd xmm21, xmm22, xmm31, 0xF8",                     // even >> 8 | odd & 0xFF00
                "vpcmpud    k1{{k1}}, zmm24, zmm23, 6",                     // greater
                "vmovdqu32  [{cell}]{{k1}}, zmm24",
                "vmovdqu8   [{at}]{{k1}}, xmm21",
                "kmovd      {length:e}, k1",
                "popcnt     {length:e}, {length:e}",
                "add        {nearer}, {length}",
                "inc        {k}",
                "cmp        {k}, {count}",
                "jb         2b",
                "jmp        6f",
                "4:",
                "vpsllq     zmm16, zmm16, 4",
                "vpsllw     xmm20, xmm20, 4",
                ".p2align   5",
                "5:",                                                       // more than 16 are left
                "vmovdqa64  zmm24, zmm17",
                "vpermt2d   zmm24, zmm30, zmm18",
                "vpsrlw     xmm26, xmm21, 8",
                "vpternlogd xmm26, xmm22, xmm31, 0xF8",
                "vpcmpud    k1, zmm24, [{cell}], 6",
                "vmovdqu32  [{cell}]{{k1}}, zmm24",
                "vmovdqu8   [{at}]{{k1}}, xmm26",
                "vpaddq     zmm17, zmm17, zmm16",
                "vpaddq     zmm18, zmm18, zmm16",
                "vpaddw     xmm21, xmm21, xmm20",
                "vpaddw     xmm22, xmm22, xmm20",
                "kmovd      {mask:e}, k1",
                "popcnt     {mask:e}, {mask:e}",
                "add        {nearer}, {mask}",
                "add        {at}, 16",
                "add        {cell}, 64",
                "sub        {length:e}, 16",
                "cmp        {length:e}, 16",
                "ja         5b",
                "jmp        3b",
                "6:",
                l = in(reg) &raw const *self,
                c = in(reg) &raw const CONSTANTS,
                pixels = in(reg) pixels,
                cells = in(reg) cells,
                count = in(reg) self.count,
                k = inout(reg) 0_u64 => _,
                ones = in(reg) u64::MAX,
                nearer = inout(reg) 0_u64 => nearer,
                at = out(reg) _,
                cell = out(reg) _,
                length = out(reg) _,
                mask = out(reg) _,
                AT = const offset_of!(Self, at),
                CELL = const offset_of!(Self, cell),
                LENGTH = const offset_of!(Self, length),
                PAINT = const offset_of!(Self, paint),
                Z = const offset_of!(Self, z),
                DZ = const offset_of!(Self, dz),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _, out("zmm28") _,
                out("zmm29") _, out("zmm30") _, out("zmm31") _, out("k1") _,
                options(nostack),
            );
        }
        // At most 2⁷ spans of 1,024 pixels.
        self.nearer = self.nearer.wrapping_add(nearer as u32);
    }
}
