//! Operations on eight lanes of numbers, with which the batches are written once for all levels.
//!
//! A token that implements [`Lanes8`] proves that the processor has its level. Each operation works lane by lane. Lanes
//! 0 to 7 are in the order of the arrays they are loaded from.

use crate::lanes::each;

/// Methods that are inlined, one to a line where they fit.
macro_rules! inlined {
    ($(fn $name:ident($self:ident $(, $argument:tt: $type:ty)*) $(-> $result:ty)? $body:block)*) => {
        $(
            #[inline(always)]
            fn $name($self $(, $argument: $type)*) $(-> $result)? $body
        )*
    };
}
pub(super) use inlined;

/// Applies [`inlined!`] to the intrinsics of a level, whose token is `self`.
#[cfg(any(simd_x86_64, simd_neon, simd_wasm))]
macro_rules! intrinsics {
    ($(fn $name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)? $body:block)*) => {
        $(
            #[inline(always)]
            fn $name(self, $($argument: $type),*) $(-> $result)? {
                // SAFETY: `self` proves that the processor has the instructions. Loads and stores go to whole arrays,
                // and require no alignment.
                unsafe { $body }
            }
        )*
    };
}
#[cfg(any(simd_x86_64, simd_neon, simd_wasm))]
pub(super) use intrinsics;

/// Operations on eight lanes of f64, i32 and i64, and on masks of eight lanes.
///
/// All methods except [`apart`](Self::apart) are inlined into a function that is compiled for the level: see
/// `compiled_for_each_level!`.
///
/// # Safety invariant
/// Every implementation computes what is said here: [`SpanList`](crate::span::list::SpanList) relies on it to admit
/// spans, and [`bytes_at`](Self::bytes_at) and [`look_up`](Self::look_up) to load bytes.
pub(crate) trait Lanes8: Copy {
    /// Eight f64.
    type F64: Copy;
    /// Eight i32. All sums, differences and products wrap.
    type I32: Copy;
    /// Eight i64, or eight u64. All sums and products wrap.
    type I64: Copy;
    /// Eight booleans.
    type Mask: Copy;

    /// Calls a part of a function that is better not inlined: because it would be compiled several times, or because it
    /// is rare and would slow down the code around it. If the closure is `#[inline(always)]`, it is compiled for this
    /// level; what it captures by reference has to be in memory.
    #[inline(always)]
    fn apart<R>(self, part: impl FnOnce() -> R) -> R {
        #[inline(never)]
        fn call<R>(part: impl FnOnce() -> R) -> R {
            part()
        }
        call(part)
    }

    fn load_f64(self, from: &[f64; 8]) -> Self::F64;
    fn splat_f64(self, value: f64) -> Self::F64;
    fn store_f64(self, from: Self::F64, to: &mut [f64; 8]);
    fn add(self, a: Self::F64, b: Self::F64) -> Self::F64;
    fn sub(self, a: Self::F64, b: Self::F64) -> Self::F64;
    fn mul(self, a: Self::F64, b: Self::F64) -> Self::F64;
    fn div(self, a: Self::F64, b: Self::F64) -> Self::F64;
    /// `a·b + c`. It is rounded once if the level has FMA, otherwise twice: callers allow for both.
    fn mul_add(self, a: Self::F64, b: Self::F64, c: Self::F64) -> Self::F64;
    /// `c − a·b`, rounded like [`mul_add`](Self::mul_add).
    fn neg_mul_add(self, a: Self::F64, b: Self::F64, c: Self::F64) -> Self::F64;
    /// The smaller one. Neither is NaN, and zeros have the same sign.
    fn min(self, a: Self::F64, b: Self::F64) -> Self::F64;
    /// The greater one. Neither is NaN, and zeros have the same sign.
    fn max(self, a: Self::F64, b: Self::F64) -> Self::F64;
    /// `a`, negated where the sign bit of `sign` is set.
    fn xor_sign(self, a: Self::F64, sign: Self::F64) -> Self::F64;
    fn is_less(self, a: Self::F64, b: Self::F64) -> Self::Mask;
    /// `a` where the mask is set, otherwise `b`.
    fn select(self, mask: Self::Mask, a: Self::F64, b: Self::F64) -> Self::F64;
    fn to_f64(self, from: Self::I32) -> Self::F64;
    /// Converts the lanes, read as u32.
    fn unsigned_to_f64(self, from: Self::I32) -> Self::F64;
    /// The lower halves of the bits.
    fn low_bits(self, from: Self::F64) -> Self::I32;
    fn bits(self, from: Self::F64) -> Self::I64;

    fn load_i32(self, from: &[i32; 8]) -> Self::I32;
    fn splat_i32(self, value: i32) -> Self::I32;
    /// `low` in lanes 0 to 3, `high` in lanes 4 to 7.
    #[inline(always)]
    fn halves_i32(self, [low, high]: [i32; 2]) -> Self::I32 {
        self.load_i32(&[low, low, low, low, high, high, high, high])
    }
    fn store_i32(self, from: Self::I32, to: &mut [i32; 8]);
    /// The lowest byte of each lane.
    #[inline(always)]
    fn low_bytes(self, from: Self::I32) -> [u8; 8] {
        let mut lanes = [0; 8];
        self.store_i32(from, &mut lanes);
        each!(lane => lanes[lane] as u8)
    }
    /// The lower half of each lane. Where the level can, it is extracted from the vector rather than passed through
    /// memory, because each may be an index.
    #[inline(always)]
    fn low_words(self, from: Self::I32) -> [u16; 8] {
        let mut lanes = [0; 8];
        self.store_i32(from, &mut lanes);
        each!(lane => lanes[lane] as u16)
    }
    /// Lanes from 0 to 0xFFFF as indices, moved to registers in the fastest way.
    #[inline(always)]
    fn to_indices(self, from: Self::I32) -> [usize; 8] {
        let words = self.low_words(from);
        each!(lane => usize::from(words[lane]))
    }
    /// The bytes at these indices of at most 65,536 bytes: `from[index & (from.len() - 1)]`, or 0 if there are none.
    #[inline(always)]
    fn bytes_at(self, from: &[u8], at: Self::I32) -> [u8; 8] {
        if from.is_empty() {
            return [0; 8];
        }
        // At most 0xFFFF.
        let last = (from.len() - 1).min(0xFFFF);
        let at = self.to_indices(self.and_i32(at, self.splat_i32(last as i32)));
        // SAFETY: an index masked with the last one is not above it.
        #[cfg(any(simd_x86_64, simd_neon, simd_wasm))]
        return unsafe { each!(lane => *from.get_unchecked(at[lane])) };
        #[cfg(not(any(simd_x86_64, simd_neon, simd_wasm)))]
        each!(lane => from[at[lane] & last])
    }
    /// The bytes of a table in these columns of the rows given by the second lowest byte of each lane.
    #[inline(always)]
    fn look_up(self, table: &[u8; 65_536], rows: Self::I32, columns: [u8; 8]) -> [u8; 8] {
        let rows = self.to_indices(self.and_i32(rows, self.splat_i32(0xFF00)));
        // SAFETY: a row masked with 0xFF00 and a column are at most 0xFFFF together.
        #[cfg(any(simd_x86_64, simd_neon, simd_wasm))]
        return unsafe { each!(lane => *table.get_unchecked(rows[lane] | usize::from(columns[lane]))) };
        #[cfg(not(any(simd_x86_64, simd_neon, simd_wasm)))]
        each!(lane => table[(rows[lane] | usize::from(columns[lane])) & 0xFFFF])
    }
    /// These bytes, each of which may be loaded by an index, to be written at once: joined in a vector where the level
    /// can.
    #[inline(always)]
    fn join_bytes(self, bytes: [u8; 8]) -> [u8; 8] {
        bytes
    }
    fn add_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn sub_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn mul_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn min_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn max_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn and_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn or_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    fn xor_i32(self, a: Self::I32, b: Self::I32) -> Self::I32;
    /// Shifts left by a constant.
    fn shl_i32(self, a: Self::I32, by: i32) -> Self::I32;
    /// Arithmetic right shift by a constant.
    fn shr_i32(self, a: Self::I32, by: i32) -> Self::I32;
    fn is_greater(self, a: Self::I32, b: Self::I32) -> Self::Mask;
    fn is_equal(self, a: Self::I32, b: Self::I32) -> Self::Mask;
    fn select_i32(self, mask: Self::Mask, a: Self::I32, b: Self::I32) -> Self::I32;
    /// Interleaves the lanes: lanes 0 of both, lanes 1 of both, and so on. Returns the first eight and the last eight.
    fn interleave_i32(self, a: Self::I32, b: Self::I32) -> [Self::I32; 2];

    fn load_i64(self, from: &[i64; 8]) -> Self::I64;
    fn splat_i64(self, value: i64) -> Self::I64;
    /// `low` in lanes 0 to 3, `high` in lanes 4 to 7.
    fn halves_i64(self, low: i64, high: i64) -> Self::I64;
    fn store_i64(self, from: Self::I64, to: &mut [i64; 8]);
    fn add_i64(self, a: Self::I64, b: Self::I64) -> Self::I64;
    fn sub_i64(self, a: Self::I64, b: Self::I64) -> Self::I64;
    fn mul_i64(self, a: Self::I64, b: Self::I64) -> Self::I64;
    /// The lower halves of `a`, taken as u32, times `b`.
    fn mul_low_i64(self, a: Self::I64, b: Self::I64) -> Self::I64;
    /// Shifts left by a constant.
    fn shl_i64(self, a: Self::I64, by: i32) -> Self::I64;
    fn to_i64(self, from: Self::I32) -> Self::I64;
    /// Converts the lanes, read as u32.
    fn unsigned_to_i64(self, from: Self::I32) -> Self::I64;
    /// The lower and the upper halves.
    fn halves_of_i64(self, from: Self::I64) -> [Self::I32; 2];
    /// Interleaves like [`interleave_i32`](Self::interleave_i32).
    fn interleave_i64(self, a: Self::I64, b: Self::I64) -> [Self::I64; 2];

    /// Reads `from[rows[lane][column]]` for each of three columns.
    ///
    /// # Panics
    /// If one of them is out of bounds.
    #[inline(always)]
    fn gather<T: Copy + Into<u64>>(self, from: &[T], rows: &[[u32; 3]; 8]) -> [Self::I64; 3] {
        let mut lanes = [[0; 8]; 3];
        for (lane, row) in rows.iter().enumerate() {
            let [a, b, c] = *row;
            lanes[0][lane] = from[a as usize].into().cast_signed();
            lanes[1][lane] = from[b as usize].into().cast_signed();
            lanes[2][lane] = from[c as usize].into().cast_signed();
        }
        let [a, b, c] = &lanes;
        [self.load_i64(a), self.load_i64(b), self.load_i64(c)]
    }

    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// `a` and not `b`.
    fn and_not(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// A bit for each lane, lane 0 lowest.
    fn to_bitmask(self, mask: Self::Mask) -> u32;
    /// The mask with these bits.
    fn mask_from_bits(self, bits: u8) -> Self::Mask;
    /// Packs the lanes set in the mask at the front, in order; the rest is arbitrary.
    #[inline(always)]
    fn compress_i32<const N: usize>(self, mask: Self::Mask, from: [Self::I32; N], to: [&mut [u32; 8]; N]) {
        let mut lanes = [[0; 8]; N];
        for (i, lanes) in lanes.iter_mut().enumerate() {
            self.store_i32(from[i], lanes);
        }
        compress(self.to_bitmask(mask), &lanes, to, i32::cast_unsigned);
    }
    /// Packs like [`compress_i32`](Self::compress_i32), for 64-bit lanes.
    #[inline(always)]
    fn compress_i64<const N: usize>(self, mask: Self::Mask, from: [Self::I64; N], to: [&mut [i64; 8]; N]) {
        let mut lanes = [[0; 8]; N];
        for (i, lanes) in lanes.iter_mut().enumerate() {
            self.store_i64(from[i], lanes);
        }
        compress(self.to_bitmask(mask), &lanes, to, |lane| lane);
    }

    /// Tests the depths of four pixels, of which only the first `count` are compared with their cells. Returns a byte
    /// for each, the first lowest: 0 if its depth is greater than the cell, otherwise 255. If `keeps`, greater depths
    /// are stored. `depths` are the first depth and the change per pixel, with the integer part in the upper half.
    #[inline(always)]
    fn test_four(self, cells: &mut [u32; 4], depths: [i64; 2], count: usize, keeps: bool) -> u32 {
        // The lower half.
        test_depths(cells, depths, count, keeps) as u32
    }
    /// Tests like [`test_four`](Self::test_four), for eight pixels.
    #[inline(always)]
    fn test_eight(self, cells: &mut [u32; 8], depths: [i64; 2], count: usize, keeps: bool) -> u64 {
        test_depths(cells, depths, count, keeps)
    }
    /// Tests like [`test_four`](Self::test_four), for four pixels if that is enough, otherwise eight.
    #[inline(always)]
    fn test_block(self, cells: &mut [u32; 8], depths: [i64; 2], count: usize, keeps: bool) -> u64 {
        match cells.first_chunk_mut() {
            Some(four) if count <= 4 => {
                u64::from(u32::MAX) << 32 | u64::from(self.test_four(four, depths, count, keeps))
            }
            _ => self.test_eight(cells, depths, count, keeps),
        }
    }
    /// Copies the first `count` of eight bytes to those pixels whose depths are greater than their cells; depths are as
    /// in [`test_four`](Self::test_four). Returns the number of these pixels.
    #[inline(always)]
    fn copy_nearer(
        self,
        (pixels, cells): (&mut [u8; 8], &mut [u32; 8]),
        (bytes, count): ([u8; 8], usize),
        depths: [i64; 2],
        keeps: bool,
    ) -> u32 {
        let stays = self.test_block(cells, depths, count, keeps);
        copy_block(pixels, bytes, stays);
        stays.count_zeros() / 8
    }
}

/// Copies eight bytes, except to the pixels that the mask leaves unchanged.
#[inline(always)]
pub(crate) fn copy_block(block: &mut [u8; 8], new: [u8; 8], stays: u64) {
    if stays >> 32 == u64::from(u32::MAX) {
        // Four are written at once: bytes just stored are then less often reloaded in different pieces.
        if let (Some(four), Some(new)) = (block.first_chunk_mut(), new.first_chunk()) {
            // The lower half.
            let stay = stays as u32;
            *four = (u32::from_le_bytes(*new) & !stay | u32::from_le_bytes(*four) & stay).to_le_bytes();
        }
    } else {
        *block = (u64::from_le_bytes(new) & !stays | u64::from_le_bytes(*block) & stays).to_le_bytes();
    }
}

/// Compresses lane by lane, for levels without such an instruction.
#[inline(always)]
fn compress<T: Copy, U, const N: usize>(bits: u32, from: &[[T; 8]; N], mut to: [&mut [U; 8]; N], cast: fn(T) -> U) {
    let (mut count, mut lane) = (0, 0);
    while lane < 8 {
        for (i, to) in to.iter_mut().enumerate() {
            // At most seven come before it.
            to[count % 8] = cast(from[i][lane]);
        }
        count += (bits >> lane & 1) as usize;
        lane += 1;
    }
}

/// Tests depths pixel by pixel; on most levels this is as fast as in vectors.
// Not inlined where size matters, see `fixed::IS_COMPACT`.
#[cfg_attr(any(mode13h_small, target_family = "wasm"), inline(never))]
#[cfg_attr(not(any(mode13h_small, target_family = "wasm")), inline(always))]
fn test_depths<const N: usize>(cells: &mut [u32; N], [mut z, dz]: [i64; 2], count: usize, keeps: bool) -> u64 {
    let (mut stays, mut k) = (u64::MAX, 0);
    while k < N && k < count {
        // The upper half.
        let depth = (z >> 32) as u32;
        if depth > cells[k] {
            if keeps {
                cells[k] = depth;
            }
            stays &= !(0xFF << (8 * k));
        }
        z = z.wrapping_add(dz);
        k += 1;
    }
    stays
}

/// Masks of sixteen lanes, by the number of lanes at the front that are set.
///
/// Masks are loaded from here, not computed by a comparison. From a comparison the compiler would
/// infer that the cleared lanes are stored as they were read, and would store the others with
/// `vpmaskmovd`, which takes 20 cycles on AMD processors.
#[cfg(simd_x86_64)]
pub(crate) static FIRST_LANES: [[i32; 16]; 17] = {
    let mut masks = [[0; 16]; 17];
    let mut count = 0;
    while count <= 16 {
        let mut lane = 0;
        while lane < count {
            masks[count][lane] = -1;
            lane += 1;
        }
        count += 1;
    }
    masks
};
