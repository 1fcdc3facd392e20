//! `Planes::of` in half the instructions.

use core::arch::asm;
use core::mem::offset_of;

use super::super::depths::Planes;
use super::super::rows::{Gathered, Group, LANES, MAGIC};

#[repr(C, align(64))]
struct Constants {
    sign: u64,
    magic: f64,
    /// 2²⁴
    scale: f64,
    quarter: f64,
    /// 2²³
    half: u64,
    /// 128
    half_pixel: u32,
}

static CONSTANTS: Constants =
    Constants { sign: 1 << 63, magic: MAGIC, scale: 16_777_216.0, quarter: 0.25, half: 1 << 23, half_pixel: 128 };

impl Planes {
    pub(in super::super) const NONE: Self = Self { at: [0; LANES], per_column: [0; LANES], per_row: [0; LANES] };

    /// Computes in place what [`of`](Self::of) returns.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true.
    #[inline(always)]
    pub(in super::super) unsafe fn renew(&mut self, gathered: &Gathered, group: &Group) {
        // SAFETY: the caller has AVX-512 F, DQ and VL found. Read are `gathered`, `group` and `CONSTANTS`, written is `self`,
        // eight numbers each at the offsets of their fields. The stack is not used; flags and all registers written
        // are given up.
        unsafe {
            asm!(
                "vmovdqu32  ymm16, [{x}]",
                "vmovdqu32  ymm19, [{y}]",
                "vmovdqu32  ymm22, [{d}]",
                "vmovdqu32  ymm17, [{x} + 32]",
                "vmovdqu32  ymm20, [{y} + 32]",
                "vmovdqu32  ymm23, [{d} + 32]",
                "vmovdqu32  ymm18, [{x} + 64]",
                "vmovdqu32  ymm21, [{y} + 64]",
                "vmovdqu32  ymm24, [{d} + 64]",
                // From the first corner.
                "vpsubd     ymm25, ymm17, ymm16",
                "vpsubd     ymm26, ymm20, ymm19",
                "vpsubd     ymm27, ymm18, ymm16",
                "vpsubd     ymm28, ymm21, ymm19",
                "vcvtdq2pd  zmm25, ymm25",                                  // dx1
                "vcvtdq2pd  zmm26, ymm26",                                  // dy1
                "vcvtdq2pd  zmm27, ymm27",                                  // dx2
                "vcvtdq2pd  zmm28, ymm28",                                  // dy2
                "vcvtudq2pd zmm29, ymm22",
                "vcvtudq2pd zmm30, ymm23",
                "vcvtudq2pd zmm31, ymm24",
                "vsubpd     zmm30, zmm30, zmm29",                           // dd1
                "vsubpd     zmm31, zmm31, zmm29",                           // dd2
                // The first by (y, x): less, or equal and less.
                "vpcmpd     k1, ymm20, ymm19, 1",
                "vpcmpeqd   k2, ymm20, ymm19",
                "vpcmpd     k2{{k2}}, ymm17, ymm16, 1",
                "korb       k1, k1, k2",
                "vmovdqa32  ymm16{{k1}}, ymm17",
                "vmovdqa32  ymm19{{k1}}, ymm20",
                "vmovdqa32  ymm22{{k1}}, ymm23",
                "vpcmpd     k1, ymm21, ymm19, 1",
                "vpcmpeqd   k2, ymm21, ymm19",
                "vpcmpd     k2{{k2}}, ymm18, ymm16, 1",
                "korb       k1, k1, k2",
                "vmovdqa32  ymm16{{k1}}, ymm18",
                "vmovdqa32  ymm19{{k1}}, ymm21",
                "vmovdqa32  ymm22{{k1}}, ymm24",
                // Twice the area, and the gradients' numerators.
                "vmulpd     zmm17, zmm25, zmm28",
                "vmulpd     zmm18, zmm30, zmm28",
                "vmulpd     zmm20, zmm31, zmm25",
                "vfnmadd231pd zmm17, zmm27, zmm26",
                "vfnmadd231pd zmm18, zmm31, zmm26",                         // nx
                "vfnmadd231pd zmm20, zmm30, zmm27",                         // ny
                "vpandq     zmm21, zmm17, qword ptr [{c} + {SIGN}]{{1to8}}",
                "vpxorq     zmm17, zmm17, zmm21",
                "vpxorq     zmm18, zmm18, zmm21",
                "vpxorq     zmm20, zmm20, zmm21",
                // Gradients: whole, rest, and the rest's part.
                "vmovupd    zmm26, [{g} + {SHADE_INVERSE}]",
                "vbroadcastsd zmm27, qword ptr [{c} + {MAGIC}]",
                "vbroadcastsd zmm28, qword ptr [{c} + {SCALE}]",
                "vbroadcastsd zmm29, qword ptr [{c} + {QUARTER}]",
                "vmovapd    zmm21, zmm18",
                "vmovapd    zmm23, zmm20",
                "vfmadd213pd zmm21, zmm26, zmm27",
                "vfmadd213pd zmm23, zmm26, zmm27",
                "vsubpd     zmm24, zmm21, zmm27",
                "vsubpd     zmm25, zmm23, zmm27",
                "vfnmadd231pd zmm18, zmm24, zmm17",
                "vfnmadd231pd zmm20, zmm25, zmm17",
                "vfmadd213pd zmm18, zmm28, zmm29",
                "vfmadd213pd zmm20, zmm28, zmm29",
                "vfmadd213pd zmm18, zmm26, zmm27",
                "vfmadd213pd zmm20, zmm26, zmm27",
                "vpsllq     zmm21, zmm21, 24",
                "vpsllq     zmm23, zmm23, 24",
                "vpsubq     zmm18, zmm18, zmm27",
                "vpsubq     zmm20, zmm20, zmm27",
                "vpaddq     zmm18, zmm18, zmm21",                           // gx
                "vpaddq     zmm20, zmm20, zmm23",                           // gy
                // At the centre of the box's first pixel.
                "vmovdqu32  ymm21, [{g} + {COLUMN}]",
                "vmovdqu32  ymm23, [{g} + {ROW}]",
                "vpslld     ymm21, ymm21, 8",
                "vpslld     ymm23, ymm23, 8",
                "vpaddd     ymm21, ymm21, dword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
                "vpaddd     ymm23, ymm23, dword ptr [{c} + {HALF_PIXEL}]{{1to8}}",
                "vpsubd     ymm21, ymm21, ymm16",                           // right
                "vpsubd     ymm23, ymm23, ymm19",                           // down
                "vpmovsxdq  zmm21, ymm21",
                "vpmovsxdq  zmm23, ymm23",
                "vpmovzxdq  zmm22, ymm22",
                "vpmullq    zmm21, zmm21, zmm18",
                "vpmullq    zmm23, zmm23, zmm20",
                "vpsllq     zmm22, zmm22, 24",
                "vpaddq     zmm22, zmm22, qword ptr [{c} + {HALF}]{{1to8}}",
                "vpsllq     zmm18, zmm18, 8",
                "vpsllq     zmm20, zmm20, 8",
                "vmovdqu64  [{p} + {PER_COLUMN}], zmm18",
                "vpaddq     zmm22, zmm22, zmm21",
                "vmovdqu64  [{p} + {PER_ROW}], zmm20",
                "vpaddq     zmm22, zmm22, zmm23",
                "vmovdqu64  [{p} + {AT}], zmm22",
                x = in(reg) &raw const gathered.x,
                y = in(reg) &raw const gathered.y,
                d = in(reg) &raw const gathered.depth,
                g = in(reg) group,
                c = in(reg) &raw const CONSTANTS,
                p = in(reg) &raw mut *self,
                SIGN = const offset_of!(Constants, sign),
                MAGIC = const offset_of!(Constants, magic),
                SCALE = const offset_of!(Constants, scale),
                QUARTER = const offset_of!(Constants, quarter),
                HALF = const offset_of!(Constants, half),
                HALF_PIXEL = const offset_of!(Constants, half_pixel),
                SHADE_INVERSE = const offset_of!(Group, inverse),
                COLUMN = const offset_of!(Group, column),
                ROW = const offset_of!(Group, row),
                PER_COLUMN = const offset_of!(Self, per_column),
                PER_ROW = const offset_of!(Self, per_row),
                AT = const offset_of!(Self, at),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
                out("zmm28") _, out("zmm29") _, out("zmm30") _, out("zmm31") _, out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::rows::Place;
    use super::super::set_up;
    use super::*;
    use crate::span::Kernel;

    #[test]
    fn planes_in_assembly_are_the_others() {
        if Kernel::by_name("simd-avx512").is_err() {
            return;
        }
        let mut state = 1_u64;
        let mut random = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 31) % (most + 1)
        };
        let mut compared = 0;
        for round in 0..50_000 {
            // Small ones, up to 64 x 16 pixels, and some whose corners lie at the same height.
            let (width, height) = [(16_384, 4_096), (600, 600), (40, 40), (16_384, 3), (3, 4_096)][round % 5];
            let mut corners = |most: u64| [0; 3].map(|_| [0; LANES].map(|_: i32| 9_000 + random(most) as i32));
            let (x, y) = (corners(width), corners(height));
            let depth = [0; 3].map(|_| [0; LANES].map(|_: i32| random(u64::from(u32::MAX)) as u32));
            let gathered = Gathered { x, y, shade: [[0; LANES]; 3], depth };
            let place = Place { first_row: 0, pitch: 320, depth_width: Some(320) };
            let (mut group, mut planes) = (Group::NONE, Planes::NONE);
            // SAFETY: the kernel above is there.
            unsafe {
                set_up(&gathered, place, &mut group);
                planes.renew(&gathered, &group);
            }
            let expected = Planes::of(&gathered, &group);
            for i in (0..LANES).filter(|&i| group.rows[i] > 0) {
                let of = |planes: &Planes| (planes.at[i], planes.per_column[i], planes.per_row[i]);
                assert_eq!(of(&planes), of(&expected), "{:?}", (x, y, depth, i));
                compared += 1;
            }
        }
        assert!(compared > 200_000, "{compared}");
    }
}
