//! Instruction-set levels as values. A token exists only if the processor has its level, so code
//! that takes one needs no other proof.
//!
//! The span kernels, in `crate::span::simd`, use the intrinsics of a level themselves. Everything else is written once,
//! over [`Lanes8`] or plain arrays of eight lanes, and compiled for each level by `compiled_for_each_level!`.

#![cfg_attr(
    any(simd_x86_64, simd_neon, simd_wasm),
    expect(unsafe_code, reason = "vectors, for processors found only when the program runs; loads at masked indices")
)]

mod lanes;
mod packed;
mod portable;
#[cfg(feature = "alloc")]
mod singles;
#[cfg(test)]
mod tests;
#[cfg(any(simd_x86_64, simd_neon, simd_wasm))]
mod wide128;

#[cfg(simd_x86_64)]
mod avx2;
#[cfg(simd_x86_64)]
mod avx512;
#[cfg(simd_neon)]
mod neon;
#[cfg(simd_x86_64)]
mod sse2;
#[cfg(simd_wasm)]
mod wasm;

#[cfg(simd_x86_64)]
pub(crate) use lanes::FIRST_LANES;
pub(crate) use lanes::{Lanes8, copy_block};
pub(crate) use packed::Packed;
pub(crate) use portable::Portable;
#[cfg(feature = "alloc")]
pub(crate) use singles::F32Lanes8;

#[cfg(simd_neon)]
pub(crate) const NEON: wide128::Wide128<neon::Neon> = wide128::Wide128(neon::Neon);
#[cfg(simd_x86_64)]
pub(crate) const SSE2: wide128::Wide128<sse2::Sse2> = wide128::Wide128(sse2::Sse2);
#[cfg(simd_wasm)]
pub(crate) const SIMD128: wide128::Wide128<wasm::Simd128> = wide128::Wide128(wasm::Simd128);

/// The level that every processor of the target has.
#[cfg(simd_neon)]
pub(crate) use NEON as BASELINE;
#[cfg(not(any(simd_x86_64, simd_neon, simd_wasm)))]
pub(crate) use Portable as BASELINE;
#[cfg(simd_wasm)]
pub(crate) use SIMD128 as BASELINE;
#[cfg(simd_x86_64)]
pub(crate) use SSE2 as BASELINE;

/// Eight 16-bit words from two numbers.
#[cfg(simd_x86_64)]
#[inline(always)]
const fn words_of([low, high]: [i64; 2]) -> [u16; 8] {
    // Shifts, so that the words do not go through memory.
    [
        low as u16,
        (low >> 16) as u16,
        (low >> 32) as u16,
        (low >> 48) as u16,
        high as u16,
        (high >> 16) as u16,
        (high >> 32) as u16,
        (high >> 48) as u16,
    ]
}

/// A level that a kernel may use.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Level {
    /// The instructions that every processor has.
    Portable,
    /// Assembly for x86-64.
    #[cfg(asm_x86_64)]
    X86_64,
    /// Assembly for 32-bit x86.
    #[cfg(asm_i686)]
    I686,
    /// Plain arrays that the compiler vectorises.
    #[cfg(feature = "simd")]
    Arrays,
    /// The instructions that every x86-64 has.
    #[cfg(simd_x86_64)]
    Sse2,
    /// 64-bit ARM, all of which has NEON.
    #[cfg(simd_neon)]
    Neon,
    /// WebAssembly with 128-bit vectors, known at compile time.
    #[cfg(simd_wasm)]
    Wasm,
    /// See [`Avx2`].
    #[cfg(simd_x86_64)]
    Avx2(Avx2),
    /// See [`Avx512`].
    #[cfg(simd_x86_64)]
    Avx512(Avx512),
}

impl Level {
    /// The level's name, as in `--stats` and in records.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(asm_x86_64)]
            Self::X86_64 => "x86-64",
            #[cfg(asm_i686)]
            Self::I686 => "i686",
            #[cfg(feature = "simd")]
            Self::Arrays => "arrays",
            #[cfg(simd_x86_64)]
            Self::Sse2 => "sse2",
            #[cfg(simd_neon)]
            Self::Neon => "neon",
            #[cfg(simd_wasm)]
            Self::Wasm => "wasm",
            #[cfg(simd_x86_64)]
            Self::Avx2(_) => "avx2",
            #[cfg(simd_x86_64)]
            Self::Avx512(_) => "avx512",
        }
    }

    /// The proof of AVX2, if this level includes it.
    #[cfg(simd_x86_64)]
    #[inline]
    pub(crate) const fn avx2(self) -> Option<Avx2> {
        match self {
            Self::Avx2(avx2) | Self::Avx512(Avx512(avx2)) => Some(avx2),
            _ => None,
        }
    }

    /// The proof of AVX-512, if this level has it.
    #[cfg(simd_x86_64)]
    #[inline]
    pub(crate) const fn avx512(self) -> Option<Avx512> {
        match self {
            Self::Avx512(avx512) => Some(avx512),
            _ => None,
        }
    }
}

/// Proof that the processor has AVX2, FMA and POPCNT. (Nearly all processors with AVX2 have the others.)
#[cfg(simd_x86_64)]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Avx2(());

#[cfg(simd_x86_64)]
impl Avx2 {
    /// The proof, if the processor has all three.
    pub(crate) fn find() -> Option<Self> {
        #[cfg(feature = "std")]
        let found = std::arch::is_x86_feature_detected!("avx2")
            && std::arch::is_x86_feature_detected!("fma")
            && std::arch::is_x86_feature_detected!("popcnt");
        #[cfg(not(feature = "std"))]
        let found = cfg!(all(target_feature = "avx2", target_feature = "fma", target_feature = "popcnt"));
        found.then_some(Self(()))
    }
}

/// Proof that the processor has AVX-512 F, BW, DQ and VL, BMI2, and everything that [`Avx2`] proves.
#[cfg(simd_x86_64)]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Avx512(Avx2);

#[cfg(simd_x86_64)]
impl Avx512 {
    /// The proof, if the processor has all of them.
    pub(crate) fn find() -> Option<Self> {
        #[cfg(feature = "std")]
        let found = std::arch::is_x86_feature_detected!("avx512f")
            && std::arch::is_x86_feature_detected!("avx512bw")
            && std::arch::is_x86_feature_detected!("avx512dq")
            && std::arch::is_x86_feature_detected!("avx512vl")
            && std::arch::is_x86_feature_detected!("bmi2");
        #[cfg(not(feature = "std"))]
        let found = cfg!(all(
            target_feature = "avx512f",
            target_feature = "avx512bw",
            target_feature = "avx512dq",
            target_feature = "avx512vl",
            target_feature = "bmi2"
        ));
        Avx2::find().filter(|_| found).map(Self)
    }
}

/// Defines a function that dispatches to one copy for each level. Each copy calls a function generic over [`Lanes8`],
/// which is inlined and so compiled for that level.
///
/// `fn name[parameters][their names](arguments) -> result = generic;` defines a function whose first argument is the
/// level.
///
/// `… = generic, up to AVX2;` has no copy for AVX-512, where it would hardly be faster: such processors run the one for
/// AVX2.
///
/// `fn name[parameters][their names](kernel: Kernel, arguments) -> result { body }` is compiled only for AVX2 and for
/// the target's baseline. Functions that the body calls must be inlined. (It takes a body rather than a closure,
/// because a closure of 3,000 instructions was not inlined, and so was compiled for the baseline alone.)
macro_rules! compiled_for_each_level {
    ($(#[$attribute:meta])* $visibility:vis fn $name:ident [$($parameters:tt)*] [$($names:tt)*]
        ($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? = $generic:ident;) => {
        $(#[$attribute])*
        #[cfg_attr(
            simd_x86_64,
            expect(unsafe_code, reason = "code for processors found only when the program runs")
        )]
        $visibility fn $name<$($parameters)*>(level: crate::simd::Level, $($argument: $type),*) $(-> $result)? {
            #[cfg(simd_x86_64)]
            if let crate::simd::Level::Avx512(lanes) = level {
                #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi2,popcnt,avx2,fma")]
                fn avx512<$($parameters)*>(lanes: crate::simd::Avx512, $($argument: $type),*) $(-> $result)? {
                    $generic::<_, $($names)*>(lanes, $($argument),*)
                }
                // SAFETY: the token proves that the processor has AVX-512.
                return unsafe { avx512::<$($names)*>(lanes, $($argument),*) };
            }
            crate::simd::compiled_for_each_level! {
                #[inline(always)]
                fn narrower[$($parameters)*][$($names)*]($($argument: $type),*) $(-> $result)?
                    = $generic, up to AVX2;
            }
            narrower::<$($names)*>(level, $($argument),*)
        }
    };
    ($(#[$attribute:meta])* $visibility:vis fn $name:ident [$($parameters:tt)*] [$($names:tt)*]
        ($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? = $generic:ident, up to AVX2;) => {
        $(#[$attribute])*
        #[cfg_attr(
            simd_x86_64,
            expect(unsafe_code, reason = "code for processors found only when the program runs")
        )]
        $visibility fn $name<$($parameters)*>(level: crate::simd::Level, $($argument: $type),*) $(-> $result)? {
            #[cfg(simd_x86_64)]
            if let Some(lanes) = level.avx2() {
                #[target_feature(enable = "avx2,fma,popcnt")]
                fn avx2<$($parameters)*>(lanes: crate::simd::Avx2, $($argument: $type),*) $(-> $result)? {
                    $generic::<_, $($names)*>(lanes, $($argument),*)
                }
                // SAFETY: the token proves that the processor has AVX2, FMA and POPCNT.
                return unsafe { avx2::<$($names)*>(lanes, $($argument),*) };
            }
            let _ = level;
            $generic::<_, $($names)*>(crate::simd::BASELINE, $($argument),*)
        }
    };
    ($(#[$attribute:meta])* $visibility:vis fn $name:ident [$($parameters:tt)*] [$($names:tt)*]
        ($kernel:ident: $kind:ty, $($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? { $body:expr }) => {
        $(#[$attribute])*
        #[cfg_attr(
            simd_x86_64,
            expect(unsafe_code, reason = "code for processors found only when the program runs")
        )]
        $visibility fn $name<$($parameters)*>($kernel: $kind, $($argument: $type),*) $(-> $result)? {
            #[cfg(simd_x86_64)]
            if let Some(crate::simd::Avx2 { .. }) = $kernel.avx2() {
                #[target_feature(enable = "avx2")]
                fn avx2<$($parameters)*>($($argument: $type),*) $(-> $result)? {
                    $body
                }
                // SAFETY: the token proves that the processor has AVX2.
                return unsafe { avx2::<$($names)*>($($argument),*) };
            }
            let _ = $kernel;
            $body
        }
    };
}
pub(crate) use compiled_for_each_level;
