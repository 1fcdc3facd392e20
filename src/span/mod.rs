//! The span: a row of pixels whose shade changes by the same step from each to the next.
//!
//! ```text
//! fill(row, shade, step)        row[k] = ((shade + k·step) mod 65,536) >> 8
//! ```
//!
//! That and nothing else, for every `k` below `row.len()`, whatever the length; an empty row is left alone. `shade` and
//! `step` are 8.8 fixed point; a falling ramp is a step in two's complement.
//!
//! Every kernel gives the same bytes for **all** inputs, or it is wrong. That costs the fast ones nothing: the sum
//! wraps at 65,536, so lane `k` may start at `shade + k·step` and still be exact.
//!
//! | kernel | what | where |
//! |---|---|---|
//! | `portable` | the loop in Rust; the specification | everywhere |
//! | `asm` | the loop, five instructions per pixel | x86-64 and 32-bit x86, feature `asm` |
//! | `asm-unrolled` | the same, eight pixels per iteration | x86-64, feature `asm` |
//! | `simd` | the best of the levels below | feature `simd` |
//! | `simd-arrays` | plain arrays, which the compiler vectorises | everywhere, feature `simd` |
//! | `simd-sse2` | 16 pixels per iteration | x86-64, feature `simd` |
//! | `simd-neon` | 16 pixels per iteration | 64-bit ARM, feature `simd` |
//! | `simd-wasm` | 16 pixels per iteration | WebAssembly built with `simd128`, feature `simd` |
//! | `simd-avx2` | 32 pixels per iteration | x86-64 with AVX2 and feature `simd` |
//! | `simd-avx512` | 64 pixels per iteration | x86-64 with AVX-512 BW, BMI2 and feature `simd` |
//!
//! `simd` can be restricted to one of its levels, for tests and measurements. With `std` the processor's features are
//! detected at run time; without it, the compiler's target features count.

// Other loops over short rows of bytes draw what a span alone cannot. Each has a portable specification; where a
// faster version is worth its code, the loop with the plain name uses it, and the specification is beside it as
// `…_portable`.
//
// | loop | what |
// |---|---|
// | `fixed16::fill_16_16` | the span in 16.16 |
// | `hyperbolic::fill_quotients` | perspective-correct shades |
// | `float::fill_float` | the same in f32 |
// | `dither::fill_dithered` | the span with ordered dither |
// | `texture` | rows of texels |
// | `lookup` | shades of texels, fog, transparency, Phong's table: one byte from two |
// | `channels::mix_cube`, `channels::mix_nearest` | red, green and blue to an index, with dither |
// | `depth::fill_nearer`, `depth::copy_nearer`, `depth::copy_nearer_keep_depth` | with a depth test |
// | `list` | a list of spans, as in batches |
// | `lit::interpolate` | writes no pixels: normals and positions for Phong shading |
// | `curve::curve` | writes no pixels: shades on a parabola |

use core::fmt;
use core::hash::{Hash, Hasher};
use core::str::FromStr;

use self::depth::Cells;
use crate::names::{KERNELS, UnknownName};
use crate::simd::Level;
#[cfg(simd_x86_64)]
use crate::simd::{Avx2, Avx512};

pub(crate) mod channels;
pub(crate) mod curve;
pub(crate) mod depth;
pub(crate) mod depth_test;
pub(crate) mod dither;
pub(crate) mod fixed16;
pub(crate) mod float;
pub(crate) mod hyperbolic;
pub(crate) mod list;
#[cfg(feature = "internals")]
pub(crate) mod listed;
pub(crate) mod lit;
pub(crate) mod lookup;
mod portable;
pub(crate) mod records;
#[cfg(feature = "simd")]
#[cfg_attr(
    any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32"),
    allow(unsafe_code, reason = "vector stores, and code for processors found only when the program runs")
)]
mod simd;
pub(crate) mod target;
pub(crate) mod texture;
mod thresholds;
#[cfg(any(asm_x86_64, asm_i686))]
#[expect(unsafe_code, reason = "the assembly's only door")]
mod x86;

pub(crate) use lookup::lookup;
#[cfg(feature = "alloc")]
pub(crate) use lookup::lookup_row;

/// The maximum length of a piece of a row. Rows with effects, and all whose shades are reseeded, are split into pieces.
pub(crate) const PIECE: usize = 64;

/// The bare assembly entries, for the tests that call them with garbage in their registers and read their instructions.
/// Not part of the interface.
#[cfg(any(asm_x86_64, asm_i686))]
#[cfg(feature = "internals")]
pub(crate) mod entry {
    pub use super::x86::entry::*;
}

/// The signature of every kernel: `row` (any length), `shade` and `step` in 8.8.
type Fill = fn(row: &mut [u8], shade: u16, step: u16);

/// A loop that fills spans and that this machine can run.
///
/// A kernel can only be obtained from the constructors here, which never return one that the processor cannot run.
///
/// ```
/// use mode13h::span::Kernel;
///
/// let mut row = [0; 4];
/// Kernel::default().fill(&mut row, 0x1080, 0x0100); // from 16.5, up by 1 a pixel
/// assert_eq!(row, [0x10, 0x11, 0x12, 0x13]);
///
/// Kernel::default().fill(&mut row, 0x0100, 0xFF80); // from 1, down by ½: wraps below 0
/// assert_eq!(row, [0x01, 0x00, 0x00, 0xFF]);
/// ```
#[derive(Clone, Copy)]
pub struct Kernel {
    name: &'static str,
    level: Level,
    /// Uses only features that every processor of the target has. Levels that need others hold a proof that this
    /// processor has them, and have functions of their own.
    fill: Fill,
}

/// The level that a kernel draws with, and its function.
type Found = (Level, Fill);

/// A kernel's name, and the function that finds it: it returns `None` where the machine or the build lacks the kernel.
type Entry = (&'static str, fn() -> Option<Found>);

/// A function that finds a kernel where its condition holds.
macro_rules! found {
    ($($condition:meta => $found:expr),*) => {
        || {
            $(#[cfg($condition)]
            return $found;)*
            #[cfg(not(any($($condition),*)))]
            None
        }
    };
}

/// Every kernel, portable first. Those of `simd` are in order of speed, the fastest last.
static LISTED: [Entry; KERNELS] = [
    ("portable", || Some((Level::Portable, portable::fill))),
    ("asm", found!(asm_x86_64 => Some((Level::X86_64, x86::fill)), asm_i686 => Some((Level::I686, x86::fill)))),
    ("asm-unrolled", found!(asm_x86_64 => Some((Level::X86_64, x86::fill_unrolled)))),
    ("simd", find_simd),
    ("simd-arrays", found!(feature = "simd" => Some((Level::Arrays, simd::arrays::fill)))),
    ("simd-sse2", found!(simd_x86_64 => Some((Level::Sse2, simd::sse2::fill)))),
    ("simd-neon", found!(simd_neon => Some((Level::Neon, simd::neon::fill)))),
    ("simd-wasm", found!(simd_wasm => Some((Level::Wasm, simd::wasm::fill)))),
    ("simd-avx2", found!(simd_x86_64 => Avx2::find().map(|avx2| (Level::Avx2(avx2), simd::sse2::fill as Fill)))),
    (
        "simd-avx512",
        found!(simd_x86_64 => Avx512::find().map(|avx512| (Level::Avx512(avx512), simd::sse2::fill as Fill))),
    ),
];

/// The fastest level.
fn find_simd() -> Option<Found> {
    let levels = LISTED.iter().rev().take_while(|(name, _)| *name != "simd");
    levels.copied().find_map(|(_, find)| find())
}

fn kernel((name, find): Entry) -> Option<Kernel> {
    find().map(|(level, fill)| Kernel { name, level, fill })
}

impl Kernel {
    /// The specification, in Rust.
    pub const PORTABLE: Self = Self { name: "portable", level: Level::Portable, fill: portable::fill };

    /// The kernels that this machine and this build have, `portable` first.
    ///
    /// `simd` is one of the `simd-…` levels, under the name by which programs ask for the best.
    pub fn available() -> impl Iterator<Item = Self> + Clone {
        LISTED.iter().copied().filter_map(kernel)
    }

    /// The kernel's name in the table, such as `simd`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// The name of the level that it draws with: for `simd` the chosen one, such as `avx2`.
    #[must_use]
    pub const fn level(self) -> &'static str {
        self.level.name()
    }

    /// Writes `row[k] = ((shade + k·step) mod 65,536) >> 8` for every `k` below `row.len()`.
    ///
    /// `shade` is the first pixel's shade, `step` the change per pixel, both in 8.8.
    #[inline]
    pub fn fill(self, row: &mut [u8], shade: u16, step: u16) {
        match self.level {
            #[cfg(simd_x86_64)]
            Level::Avx2(avx2) => simd::avx2::fill(avx2, row, shade, step),
            #[cfg(simd_x86_64)]
            Level::Avx512(avx512) => simd::avx512::fill(avx512, row, shade, step),
            _ => (self.fill)(row, shade, step),
        }
    }

    /// Writes like [`fill`](Self::fill), but only the first `length` pixels of a row at least that long. The rest does
    /// not change.
    #[inline]
    pub(crate) fn fill_first(self, length: usize, row: &mut [u8], shade: u16, step: u16) {
        // Usually short, with an unpredictable length: trailing bytes are rewritten unchanged, by code that is inlined.
        #[cfg(simd_x86_64)]
        if length <= 16
            && matches!(self.level, Level::Sse2 | Level::Avx2(_))
            && let Some(row) = row.first_chunk_mut()
        {
            return simd::sse2::fill_first(length, row, shade, step);
        }
        if let Some(row) = row.get_mut(..length) {
            self.fill(row, shade, step);
        }
    }

    /// Fills every span, in order, as [`fill`](Self::fill) does.
    #[inline]
    fn fill_spans(self, pixels: &mut [u8], spans: &list::SpanList) {
        match self.level {
            Level::Portable => spans.each(pixels, portable::fill),
            #[cfg(feature = "simd")]
            Level::Arrays => spans.each(pixels, simd::arrays::fill),
            #[cfg(simd_x86_64)]
            Level::Sse2 => simd::sse2::fill_spans(pixels, spans),
            #[cfg(simd_x86_64)]
            Level::Avx2(avx2) => simd::avx2::fill_spans(avx2, pixels, spans),
            #[cfg(simd_x86_64)]
            Level::Avx512(avx512) => simd::avx512::fill_spans(avx512, pixels, spans),
            #[cfg(simd_neon)]
            Level::Neon => spans.each(pixels, simd::neon::fill),
            #[cfg(simd_wasm)]
            Level::Wasm => spans.each(pixels, simd::wasm::fill),
            #[cfg(any(asm_x86_64, asm_i686))]
            _ => spans.each(pixels, |row, shade, step| self.fill(row, shade, step)),
        }
    }

    /// Fills every span, in order, with the depth test of [`depth::fill_nearer`]. Returns the number of pixels written.
    #[inline]
    fn fill_spans_nearer(self, pixels: &mut [u8], cells: &mut Cells<'_>, spans: &list::SpanList) -> u32 {
        #[cfg(simd_x86_64)]
        if let (Some(avx2), Cells::U32(cells)) = (self.avx2(), &mut *cells) {
            return match self.level.avx512() {
                Some(avx512) => simd::avx512::fill_spans_nearer::<false>(avx512, pixels, cells, spans, |_| (0, 0)),
                None => simd::nearer::fill_spans(avx2, pixels, cells, spans),
            };
        }
        match cells {
            Cells::U16(cells) => spans.each_nearer(pixels, cells),
            Cells::U32(cells) => spans.each_nearer(pixels, cells),
        }
    }

    /// Fills every span, in order, with shades in 16.16; if there are cells, only where they are nearer. `shades`
    /// returns the first shade and the step of a span, given its fill. Returns the number of pixels that were nearer.
    #[inline(always)]
    pub(crate) fn fill_spans_16_16(
        self,
        pixels: &mut [u8],
        cells: &mut Option<Cells<'_>>,
        spans: &list::SpanList,
        shades: impl Fn(u32) -> (u32, u32),
    ) -> u32 {
        #[cfg(simd_x86_64)]
        if let (Some(avx2), Some(Cells::U32(cells))) = (self.avx2(), &mut *cells) {
            return match self.level.avx512() {
                Some(avx512) => simd::avx512::fill_spans_nearer::<true>(avx512, pixels, cells, spans, shades),
                None => simd::nearer::fill_spans_16_16(avx2, pixels, cells, spans, shades),
            };
        }
        match cells {
            None => {
                for list::Span { at, length, fill } in spans.spans() {
                    // No overflow: both are below 2³¹.
                    if let Some(row) = pixels.get_mut(at as usize..at as usize + length as usize) {
                        let (start, step) = shades(fill);
                        fixed16::fill_16_16(row, start, step);
                    }
                }
                0
            }
            Some(Cells::U16(cells)) => nearer_16_16(pixels, cells, spans, shades),
            Some(Cells::U32(cells)) => nearer_16_16(pixels, cells, spans, shades),
        }
    }

    /// Copies the first `length` bytes to a row that is at least that long. The rest of the row does
    /// not change.
    #[inline(always)]
    pub(crate) fn copy(self, length: usize, row: &mut [u8], bytes: &[u8]) {
        // Usually short, with an unpredictable length: trailing bytes are rewritten unchanged.
        if (1..=8).contains(&length)
            && let (Some(row), Some(bytes)) = (row.first_chunk_mut(), bytes.first_chunk())
        {
            let mask = !(u64::MAX << 1 << (8 * length - 1));
            *row = (u64::from_le_bytes(*bytes) & mask | u64::from_le_bytes(*row) & !mask).to_le_bytes();
        } else if let (Some(row), Some(bytes)) = (row.get_mut(..length), bytes.get(..length)) {
            // Calling the C library's copy takes as long as dozens of pixels.
            let blocks = bytes.as_chunks::<8>().0;
            for (to, from) in row.as_chunks_mut::<8>().0.iter_mut().zip(blocks) {
                *to = *from;
            }
            match (row.last_chunk_mut::<8>(), bytes.last_chunk::<8>()) {
                (Some(to), Some(from)) => *to = *from,
                // At the frame's end.
                _ => row.copy_from_slice(bytes),
            }
        }
    }

    /// The level that this kernel draws with.
    #[inline]
    pub(crate) const fn simd_level(self) -> Level {
        self.level
    }

    /// The proof that the processor has AVX2, if this kernel may use it.
    #[cfg(simd_x86_64)]
    #[inline]
    pub(crate) fn avx2(self) -> Option<Avx2> {
        self.level.avx2()
    }
}

/// Fills every span of a list with shades in 16.16 where they are nearer. Returns the number of pixels written.
fn nearer_16_16<D: depth::Cell>(
    pixels: &mut [u8],
    cells: &mut [D],
    spans: &list::SpanList,
    shades: impl Fn(u32) -> (u32, u32),
) -> u32 {
    spans.each_tested(pixels, cells, |fill, row, cells, [z, dz]| {
        let (start, step) = shades(fill);
        depth::fill_nearer_16_16(row, cells, [start, step], z, dz)
    })
}

/// The name, and for `simd` the level in brackets.
impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name {
            "simd" => write!(f, "simd ({})", self.level.name()),
            name => f.write_str(name),
        }
    }
}

/// The kernel with a name, as [`Kernel::name`] returns it. [`UnknownName`] if no kernel has it, or if this machine or
/// build lacks that kernel.
impl FromStr for Kernel {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        let listed = LISTED.iter().copied().find(|(listed, _)| *listed == name);
        listed.and_then(kernel).ok_or_else(|| {
            UnknownName::kernel(listed.map(|(name, _)| name), LISTED.map(|listed| kernel(listed).map(Kernel::name)))
        })
    }
}

/// The fastest kernel of this machine and this build. It costs a few loads: the processor's features are detected once
/// per program.
impl Default for Kernel {
    fn default() -> Self {
        // Not the assembly: the compiler vectorises the portable loop, and that is faster at every length.
        match find_simd() {
            Some((level, fill)) => Self { name: "simd", level, fill },
            None => Self::PORTABLE,
        }
    }
}

/// Two kernels are equal if they have the same name and draw with the same level.
impl PartialEq for Kernel {
    fn eq(&self, other: &Self) -> bool {
        (self.name, self.level) == (other.name, other.level)
    }
}

impl Eq for Kernel {}

impl Hash for Kernel {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.name, self.level).hash(state);
    }
}

impl fmt::Debug for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Kernel({self})")
    }
}
