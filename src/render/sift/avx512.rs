//! Sixteen faces at a time in assembly for AVX-512.

use crate::simd::Avx512;
use core::arch::asm;
use core::mem::offset_of;

use super::listed::{BEYOND, Listed};
use super::{MOST, Sifted, TINY_SIDE};
use crate::raster::batch::indexed::{Place, TURNED};

/// Faces at a time.
const LANES: usize = 16;

#[repr(C, align(64))]
struct Constants {
    /// Places of the corners of the first eight faces in two vectors; those of the last eight, in the two vectors from
    /// the second on.
    first: [[u32; LANES]; 3],
    last: [[u32; LANES]; 3],
    /// The lower and the upper halves of two vectors of pairs.
    even: [u32; LANES],
    odd: [u32; LANES],
    beyond: i32,
    /// 127, 128, 2
    before_centre: i32,
    half: i32,
    looked_at: i32,
    /// 2¹⁵ − 1
    most: i32,
    minus_one: i32,
    /// Pairs of 16 bits, the lower first: 0 and 256, and −256 and 0.
    right: u32,
    down: u32,
}

static CONSTANTS: Constants = {
    let mut constants = Constants {
        first: [[0; LANES]; 3],
        last: [[0; LANES]; 3],
        even: [0; LANES],
        odd: [0; LANES],
        beyond: Place::BEYOND,
        before_centre: 127,
        half: 128,
        looked_at: TINY_SIDE,
        most: i16::MAX as i32,
        minus_one: -1,
        right: 0x0100_0000,
        down: 0x0000_FF00,
    };
    let mut i = 0;
    while i < LANES as u32 {
        let lane = i as usize;
        (constants.even[lane], constants.odd[lane]) = (2 * i, 2 * i + 1);
        let mut corner = 0;
        while corner < 3 && i < 8 {
            constants.first[corner as usize][lane] = 3 * i + corner;
            constants.last[corner as usize][lane] = 3 * i + corner + 8;
            corner += 1;
        }
        i += 1;
    }
    constants
};

pub(super) fn sift(_: Avx512, places: &[Place], triangles: &[[u32; 3]], sides: [i32; 4], culls: bool) -> Sifted {
    let mut sifted = Sifted::default();
    let triangles = &triangles[..triangles.len().min(MOST)];
    let (sixteens, rest) = triangles.as_chunks::<LANES>();
    for (number, sixteen) in sixteens.iter().enumerate() {
        // SAFETY: the processor has AVX-512, says the token.
        let Some(found) = (unsafe { sift_sixteen(places, sixteen, &sides, culls) }) else {
            return super::sift(places, triangles, sides, culls);
        };
        let all = [&mut sifted.clipped, &mut sifted.front, &mut sifted.back, &mut sifted.covers];
        for (all, bits) in all.into_iter().zip(found) {
            *all |= u64::from(bits) << (LANES * number);
        }
    }
    for (i, triangle) in rest.iter().enumerate() {
        sifted.add(LANES * sixteens.len() + i, triangle.map(|i| places[i as usize]), sides, culls);
    }
    sifted
}

/// `Sifted::add` of sixteen faces: those that need clipping, the front, the back, and those that cover a pixel centre; unless
/// one of their numbers is none of a place.
///
/// ```text
/// F(p) = −E(p) = (dx, dy) · (ay − py, px − ax)        in 16 bits a number; inside below 0, or at 0 if the edge is a left or top one
/// ```
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline(always)]
unsafe fn sift_sixteen(
    places: &[Place],
    triangles: &[[u32; 3]; LANES],
    sides: &[i32; 4],
    culls: bool,
) -> Option<[u16; 4]> {
    // Places that are farther behind have no number here; as numbers are signed where they are taken for offsets.
    let count = places.len().min(1 << 31) as u32;
    let both: u32 = if culls { 0 } else { 0xFFFF };
    let (clipped, front, back, covers, known): (u32, u32, u32, u32, u32);
    // SAFETY: the caller has AVX-512 F, BW, DQ and VL found. Read are the 48 numbers of `triangles`, `sides`, `CONSTANTS` at the
    // offsets of its fields, and `places` by those numbers, if all of them are below `count`. Nothing is written. The stack
    // is not used; flags and all registers written are given up.
    unsafe {
        asm!(
            "vmovdqu32  zmm16, [{t}]",
            "vmovdqu32  zmm17, [{t} + 64]",
            "vmovdqu32  zmm18, [{t} + 128]",
            "vpbroadcastd zmm19, {count:e}",
            "vpcmpud    k1, zmm16, zmm19, 1",                           // less
            "vpcmpud    k1{{k1}}, zmm17, zmm19, 1",
            "vpcmpud    k1{{k1}}, zmm18, zmm19, 1",
            "kmovw      {known:e}, k1",
            "cmp        {known:e}, 0xFFFF",
            "jne        3f",
            // The corners' places, eight faces at a time.
            "vmovdqa64  zmm19, [{c} + {FIRST}]",
            "vmovdqa64  zmm20, [{c} + {FIRST} + 64]",
            "vmovdqa64  zmm21, [{c} + {FIRST} + 128]",
            "vmovdqa64  zmm22, [{c} + {LAST}]",
            "vmovdqa64  zmm23, [{c} + {LAST} + 64]",
            "vmovdqa64  zmm24, [{c} + {LAST} + 128]",
            "vpermi2d   zmm19, zmm16, zmm17",
            "vpermi2d   zmm20, zmm16, zmm17",
            "vpermi2d   zmm21, zmm16, zmm17",
            "vpermi2d   zmm22, zmm17, zmm18",
            "vpermi2d   zmm23, zmm17, zmm18",
            "vpermi2d   zmm24, zmm17, zmm18",
            "kxnorw     k1, k1, k1",
            "kxnorw     k2, k2, k2",
            "kxnorw     k3, k3, k3",
            "kxnorw     k4, k4, k4",
            "kxnorw     k5, k5, k5",
            "kxnorw     k6, k6, k6",
            "vpxord     zmm25, zmm25, zmm25",
            "vpxord     zmm26, zmm26, zmm26",
            "vpxord     zmm27, zmm27, zmm27",
            "vpxord     zmm28, zmm28, zmm28",
            "vpxord     zmm29, zmm29, zmm29",
            "vpxord     zmm30, zmm30, zmm30",
            "vpgatherdq zmm25{{k1}}, [{places} + 8*ymm19]",
            "vpgatherdq zmm26{{k2}}, [{places} + 8*ymm20]",
            "vpgatherdq zmm27{{k3}}, [{places} + 8*ymm21]",
            "vpgatherdq zmm28{{k4}}, [{places} + 8*ymm22]",
            "vpgatherdq zmm29{{k5}}, [{places} + 8*ymm23]",
            "vpgatherdq zmm30{{k6}}, [{places} + 8*ymm24]",
            // Which way they are turned.
            "vpsubd     zmm16, zmm26, zmm25",
            "vpsubd     zmm17, zmm27, zmm25",
            "vpsubd     zmm20, zmm29, zmm28",
            "vpsubd     zmm21, zmm30, zmm28",
            "vpsrlq     zmm18, zmm17, 32",
            "vpsrlq     zmm19, zmm16, 32",
            "vpsrlq     zmm22, zmm21, 32",
            "vpsrlq     zmm23, zmm20, 32",
            "vpmuldq    zmm16, zmm16, zmm18",                           // dx1·dy2
            "vpmuldq    zmm17, zmm17, zmm19",                           // dx2·dy1
            "vpmuldq    zmm20, zmm20, zmm22",
            "vpmuldq    zmm21, zmm21, zmm23",
            "vpcmpq     k1, zmm16, zmm17, 1",                           // less
            "vpcmpq     k2, zmm16, zmm17, 6",                           // greater
            "vpcmpq     k3, zmm20, zmm21, 1",
            "vpcmpq     k4, zmm20, zmm21, 6",
            "kunpckbw   k1, k3, k1",                                    // front
            "kunpckbw   k2, k4, k2",                                    // back
            // x and y of the corners, sixteen faces each.
            "vmovdqa64  zmm31, [{c} + {EVEN}]",
            "vmovdqa64  zmm24, [{c} + {ODD}]",
            "vmovdqa64  zmm16, zmm25",
            "vmovdqa64  zmm17, zmm26",
            "vmovdqa64  zmm18, zmm27",
            "vpermt2d   zmm16, zmm31, zmm28",
            "vpermt2d   zmm17, zmm31, zmm29",
            "vpermt2d   zmm18, zmm31, zmm30",
            "vpminsd    zmm19, zmm16, zmm17",
            "vpminsd    zmm19, zmm19, zmm18",                           // low x
            "vpcmpeqd   k3, zmm19, dword ptr [{c} + {BEYOND}]{{1to16}}",
            "kandnw     k1, k3, k1",
            "kandnw     k2, k3, k2",
            "kmovw      k5, {both:e}",
            "kandw      k4, k2, k5",
            "korw       k4, k4, k1",                                    // seen
            "kortestw   k4, k4",
            // Neighbours mostly turn the same way.
            "jz         2f",
            "vpermt2d   zmm25, zmm24, zmm28",
            "vpermt2d   zmm26, zmm24, zmm29",
            "vpermt2d   zmm27, zmm24, zmm30",
            "vpmaxsd    zmm20, zmm16, zmm17",
            "vpminsd    zmm21, zmm25, zmm26",
            "vpmaxsd    zmm22, zmm25, zmm26",
            "vpmaxsd    zmm20, zmm20, zmm18",                           // high x
            "vpminsd    zmm21, zmm21, zmm27",                           // low y
            "vpmaxsd    zmm22, zmm22, zmm27",                           // high y
            // The box's pixel centres.
            "vpbroadcastd zmm31, dword ptr [{c} + {BEFORE_CENTRE}]",
            "vpaddd     zmm19, zmm19, zmm31",
            "vpaddd     zmm20, zmm20, zmm31",
            "vpaddd     zmm21, zmm21, zmm31",
            "vpaddd     zmm22, zmm22, zmm31",
            "vpsrad     zmm19, zmm19, 8",
            "vpsrad     zmm20, zmm20, 8",
            "vpsrad     zmm21, zmm21, 8",
            "vpsrad     zmm22, zmm22, 8",
            "vpmaxsd    zmm23, zmm19, dword ptr [{sides}]{{1to16}}",
            "vpminsd    zmm24, zmm20, dword ptr [{sides} + 8]{{1to16}}",
            "vpmaxsd    zmm28, zmm21, dword ptr [{sides} + 4]{{1to16}}",
            "vpminsd    zmm29, zmm22, dword ptr [{sides} + 12]{{1to16}}",
            "vpcmpd     k4{{k4}}, zmm24, zmm23, 6",                     // greater
            "vpcmpd     k4{{k4}}, zmm29, zmm28, 6",
            "vpsubd     zmm20, zmm20, zmm19",
            "vpsubd     zmm22, zmm22, zmm21",
            "vpcmpd     k5{{k4}}, zmm20, dword ptr [{c} + {LOOKED_AT}]{{1to16}}, 2", // not greater
            "vpcmpd     k5{{k5}}, zmm22, dword ptr [{c} + {LOOKED_AT}]{{1to16}}, 2",
            "kortestw   k5, k5",
            "jz         2f",
            // Corners from the first centre: (x, y), and turned by a quarter (y, −x), in 16 bits each.
            "vpbroadcastd zmm31, dword ptr [{c} + {HALF}]",
            "vpslld     zmm19, zmm19, 8",
            "vpslld     zmm21, zmm21, 8",
            "vpaddd     zmm19, zmm19, zmm31",
            "vpaddd     zmm21, zmm21, zmm31",
            "mov        {known:e}, 0xAAAAAAAA",
            "kmovd      k6, {known:e}",
            "vpsubd     zmm20, zmm16, zmm19",
            "vpsubd     zmm22, zmm25, zmm21",
            "vpsubd     zmm23, zmm19, zmm16",
            "vpslld     zmm24, zmm22, 16",
            "vpslld     zmm23, zmm23, 16",
            "vpblendmw  zmm16{{k6}}, zmm20, zmm24",
            "vpblendmw  zmm25{{k6}}, zmm22, zmm23",
            "vpsubd     zmm28, zmm17, zmm19",
            "vpsubd     zmm29, zmm26, zmm21",
            "vpsubd     zmm30, zmm19, zmm17",
            "vpslld     zmm31, zmm29, 16",
            "vpslld     zmm30, zmm30, 16",
            "vpblendmw  zmm17{{k6}}, zmm28, zmm31",
            "vpblendmw  zmm26{{k6}}, zmm29, zmm30",
            "vpsubd     zmm20, zmm18, zmm19",
            "vpsubd     zmm22, zmm27, zmm21",
            "vpsubd     zmm23, zmm19, zmm18",
            "vpslld     zmm24, zmm22, 16",
            "vpslld     zmm23, zmm23, 16",
            "vpblendmw  zmm18{{k6}}, zmm20, zmm24",
            "vpblendmw  zmm27{{k6}}, zmm22, zmm23",
            // Of the front the last two corners are exchanged.
            "vpblendmd  zmm28{{k1}}, zmm17, zmm18",
            "vpblendmd  zmm29{{k1}}, zmm18, zmm17",
            "vpblendmd  zmm30{{k1}}, zmm26, zmm27",
            "vpblendmd  zmm31{{k1}}, zmm27, zmm26",
            // Edges, and F at the first centre, one less where 0 is inside.
            "vpsubw     zmm17, zmm28, zmm16",
            "vpsubw     zmm18, zmm29, zmm28",
            "vpsubw     zmm19, zmm16, zmm29",
            "vpmaddwd   zmm20, zmm17, zmm25",
            "vpmaddwd   zmm21, zmm18, zmm30",
            "vpmaddwd   zmm22, zmm19, zmm31",
            "vpbroadcastd zmm16, dword ptr [{c} + {MAX_RIGHT}]",
            "vpbroadcastd zmm23, dword ptr [{c} + {MINUS_ONE}]",
            // Up, or level and to the right.
            "vpcmpd     k6, zmm17, zmm16, 2",
            "vpaddd     zmm20{{k6}}, zmm20, zmm23",
            "vpcmpd     k6, zmm18, zmm16, 2",
            "vpaddd     zmm21{{k6}}, zmm21, zmm23",
            "vpcmpd     k6, zmm19, zmm16, 2",
            "vpaddd     zmm22{{k6}}, zmm22, zmm23",
            "vpbroadcastd zmm26, dword ptr [{c} + {RIGHT}]",
            "vpbroadcastd zmm27, dword ptr [{c} + {DOWN}]",
            "vpmaddwd   zmm23, zmm17, zmm26",
            "vpmaddwd   zmm24, zmm18, zmm26",
            "vpmaddwd   zmm25, zmm19, zmm26",
            "vpmaddwd   zmm28, zmm17, zmm27",
            "vpmaddwd   zmm29, zmm18, zmm27",
            "vpmaddwd   zmm30, zmm19, zmm27",
            "vmovdqa64  zmm31, zmm20",
            "vpternlogd zmm31, zmm21, zmm22, 0x80",                     // all three
            "vpaddd     zmm23, zmm23, zmm20",
            "vpaddd     zmm24, zmm24, zmm21",
            "vpaddd     zmm25, zmm25, zmm22",
            "vmovdqa64  zmm16, zmm23",
            "vpternlogd zmm16, zmm24, zmm25, 0x80",
            "vpaddd     zmm20, zmm20, zmm28",
            "vpaddd     zmm21, zmm21, zmm29",
            "vpaddd     zmm22, zmm22, zmm30",
            "vpternlogd zmm20, zmm21, zmm22, 0x80",
            "vpaddd     zmm23, zmm23, zmm28",
            "vpaddd     zmm24, zmm24, zmm29",
            "vpaddd     zmm25, zmm25, zmm30",
            "vpternlogd zmm23, zmm24, zmm25, 0x80",
            "vpternlogd zmm31, zmm16, zmm20, 0xFE",                     // any of three
            "vpord      zmm31, zmm31, zmm23",
            "vpmovd2m   k6, zmm31",
            "kandnw     k5, k6, k5",
            "kandnw     k4, k5, k4",
            "2:",
            "mov        {known:e}, 0xFFFF",
            "kmovw      {clipped:e}, k3",
            "kmovw      {front:e}, k1",
            "kmovw      {back:e}, k2",
            "kmovw      {covers:e}, k4",
            "3:",
            t = in(reg) triangles,
            c = in(reg) &raw const CONSTANTS,
            places = in(reg) places.as_ptr(),
            sides = in(reg) sides,
            count = in(reg) count,
            both = in(reg) both,
            known = out(reg) known,
            clipped = out(reg) clipped,
            front = out(reg) front,
            back = out(reg) back,
            covers = out(reg) covers,
            FIRST = const offset_of!(Constants, first),
            LAST = const offset_of!(Constants, last),
            EVEN = const offset_of!(Constants, even),
            ODD = const offset_of!(Constants, odd),
            BEYOND = const offset_of!(Constants, beyond),
            BEFORE_CENTRE = const offset_of!(Constants, before_centre),
            HALF = const offset_of!(Constants, half),
            LOOKED_AT = const offset_of!(Constants, looked_at),
            MAX_RIGHT = const offset_of!(Constants, most),
            MINUS_ONE = const offset_of!(Constants, minus_one),
            RIGHT = const offset_of!(Constants, right),
            DOWN = const offset_of!(Constants, down),
            out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
            out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm27") _,
            out("zmm28") _, out("zmm29") _, out("zmm30") _, out("zmm31") _,
            out("k1") _, out("k2") _, out("k3") _, out("k4") _, out("k5") _, out("k6") _,
            options(nostack, readonly),
        );
    }
    // Masks of sixteen bits. Where numbers are wrong they mean nothing.
    (known == 0xFFFF).then_some([clipped as u16, front as u16, back as u16, covers as u16])
}

/// `Listed::add`.
#[inline(always)]
pub(super) fn list(_: Avx512, listed: &mut Listed, first: u32, chosen: u64, turned: u64) {
    for part in 0..(MOST / LANES) as u32 {
        let bits = |all: u64| (all >> (LANES as u32 * part)) as u16;
        if bits(chosen) == 0 {
            continue;
        }
        let Some(to) = listed.numbers.get_mut(listed.count..).and_then(|rest| rest.first_chunk_mut()) else { return };
        // SAFETY: the processor has AVX-512, says the token.
        listed.count += unsafe { list_sixteen(to, first + LANES as u32 * part, bits(chosen), bits(turned)) };
    }
}

/// Writes the numbers of those of sixteen faces whose bits are set, one after the other, and anything behind them. Says how
/// many they are.
///
/// # Safety
/// Only for a processor for which `span::simd::avx512::found` is true.
#[inline(always)]
unsafe fn list_sixteen(to: &mut [u32; BEYOND], first: u32, chosen: u16, turned: u16) -> usize {
    const { assert!(BEYOND == LANES) };
    // SAFETY: the caller has AVX-512 F found. Read is `NUMBERS`, written are the sixteen numbers of `to`. The stack is not
    // used; all registers written are given up.
    unsafe {
        asm!(
            "kmovw      k1, {chosen:e}",
            "kmovw      k2, {turned:e}",
            "vpbroadcastd zmm16, {first:e}",
            "vpaddd     zmm16, zmm16, [{numbers}]",
            "vpord      zmm16{{k2}}, zmm16, dword ptr [{side}]{{1to16}}",
            "vpcompressd zmm16{{k1}}{{z}}, zmm16",
            "vmovdqu32  [{to}], zmm16",
            chosen = in(reg) u32::from(chosen),
            turned = in(reg) u32::from(turned),
            first = in(reg) first,
            numbers = in(reg) &raw const NUMBERS,
            side = in(reg) &const { TURNED },
            to = in(reg) to,
            out("zmm16") _, out("k1") _, out("k2") _,
            options(nostack, preserves_flags),
        );
    }
    // At most sixteen.
    chosen.count_ones() as usize
}

#[repr(C, align(64))]
struct Numbers([u32; LANES]);

static NUMBERS: Numbers = Numbers([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
