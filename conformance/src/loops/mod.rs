//! Every pixel loop against its definition.
//!
//! A check takes a loop as a function, in any of its forms, and draws a row of each length and alignment with it: every
//! byte must match the definition, and no byte next to the row may change. Tests also run the checks on deliberately
//! wrong loops to ensure that they are caught.
//!
//! | module | loops |
//! |---|---|
//! | [`spans`] | `fill`, `fill_16_16`, `fill_quotients`, `fill_float`, `fill_dithered` |
//! | [`texels`] | `fill_affine`, `fill_perspective`, `lookup` |
//! | [`channels`] | `mix_cube`, `mix_nearest` |
//! | [`depth`] | `fill_nearer`, `copy_nearer`, `copy_nearer_keep_depth`, lists of spans; cells of 32 and of 16 bits |
//! | [`light`] | `interpolate`, `numerators` and `divide`, `curve`: these write no pixels |
//!
//! ```
//! use mode13h_conformance::loops::{self, Cases};
//!
//! for outcome in loops::all(Cases::quick(13)).take(3) {
//!     assert_eq!(outcome.wrong, None);
//! }
//! ```

pub mod canvas;
pub mod channels;
pub mod depth;
pub mod light;
pub mod spans;
pub mod texels;

use alloc::string::String;
use core::fmt;

use mode13h::internals::span::channels::{mix_cube, mix_cube_portable, mix_nearest};
use mode13h::internals::span::curve::curve;
use mode13h::internals::span::depth::{copy_nearer, copy_nearer_keep_depth, fill_nearer};
use mode13h::internals::span::dither::{fill_dithered, fill_dithered_portable};
use mode13h::internals::span::fixed16::fill_16_16;
use mode13h::internals::span::float::fill_float;
use mode13h::internals::span::hyperbolic::fill_quotients;
use mode13h::internals::span::listed;
use mode13h::internals::span::lit::{interpolate, interpolate_at};
use mode13h::internals::span::lookup;
use mode13h::internals::span::texture::{fill_affine, fill_perspective};
use mode13h::span::Kernel;

use crate::Random;

/// The cases that a loop is run on; the same seed gives the same cases on every machine.
#[derive(Clone, Copy, Debug)]
pub struct Cases {
    seed: u64,
    is_full: bool,
}

/// Outcome of a check: the number of cases, or what was wrong with the first that failed.
pub type Checked = Result<u64, String>;

type Check = fn(Cases) -> Checked;
type CheckKernel = fn(Cases, Kernel) -> Checked;

impl Cases {
    /// A tenth of all cases: every length of a screen row, at a few alignments. All loops with all kernels take about a
    /// second.
    #[must_use]
    pub const fn quick(seed: u64) -> Self {
        Self { seed, is_full: false }
    }

    /// Every length of a screen row at every alignment, and 2,000 longer ones.
    #[must_use]
    pub const fn full(seed: u64) -> Self {
        Self { seed, is_full: true }
    }

    /// Picks `quick` or `full`, the number of cases for either amount.
    const fn of(self, quick: usize, full: usize) -> usize {
        if self.is_full { full } else { quick }
    }

    /// The random generator of a stream.
    fn random(self, stream: &str) -> Random {
        Random::seeded(self.seed, stream)
    }
}

/// A loop in one of its forms, and the outcome of its check.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Outcome {
    /// The loop, such as `fill_dithered`.
    pub name: &'static str,
    /// The kernel that drew, if the loop has a form for each.
    pub kernel: Option<Kernel>,
    /// Number of cases; 0 if one was wrong.
    pub cases: u64,
    /// The first wrong case and what was wrong, in one line.
    pub wrong: Option<String>,
}

/// The loop and the kernel.
impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)?;
        self.kernel.map_or(Ok(()), |kernel| write!(f, " by {kernel}"))
    }
}

/// Loops that do not depend on the kernel, in both forms: the specification, and the one this build draws with.
const LOOPS: [(&str, Check); 16] = [
    ("fill_16_16", |cases| spans::check_16_16(cases, fill_16_16)),
    ("fill_quotients", |cases| spans::check_quotients(cases, fill_quotients)),
    ("fill_float", |cases| spans::check_float(cases, fill_float)),
    ("fill_dithered_portable", |cases| spans::check_dithered(cases, fill_dithered_portable)),
    ("fill_dithered", |cases| spans::check_dithered(cases, fill_dithered)),
    ("fill_affine", |cases| texels::check_affine(cases, fill_affine)),
    ("fill_perspective", |cases| texels::check_perspective(cases, fill_perspective)),
    ("lookup", |cases| texels::check_lookup(cases, lookup)),
    ("mix_cube_portable", |cases| channels::check_cube(cases, mix_cube_portable)),
    ("mix_cube", |cases| channels::check_cube(cases, mix_cube)),
    ("mix_nearest", |cases| channels::check_nearest(cases, mix_nearest)),
    ("fill_nearer, u32", |cases| depth::check_fill::<u32>(cases, fill_nearer)),
    ("fill_nearer, u16", |cases| depth::check_fill::<u16>(cases, fill_nearer)),
    ("copy_nearer and copy_nearer_keep_depth, u32", check_copies::<u32>),
    ("copy_nearer and copy_nearer_keep_depth, u16", check_copies::<u16>),
    ("interpolate and curve", |cases| {
        Ok(light::check_interpolate(cases, interpolate)?
            + light::check_curve(cases, |shades, parabola, least, most| {
                curve(Kernel::PORTABLE, shades, parabola, least, most)
            })?)
    }),
];

fn check_copies<D: depth::NaiveCell>(cases: Cases) -> Checked {
    let kept = depth::check_copy::<D>(cases, true, |length, row, cells, bytes, z, dz| {
        copy_nearer(row, cells, &bytes[..length.min(bytes.len())], z, dz)
    })?;
    let stay = depth::check_copy::<D>(cases, false, |length, row, cells, bytes, z, dz| {
        copy_nearer_keep_depth(row, cells, &bytes[..length.min(bytes.len())], z, dz)
    })?;
    Ok(kept + stay)
}

/// Loops that have a separate form for each kernel.
const BY_KERNEL: [(&str, CheckKernel); 10] = [
    ("fill", |cases, kernel| spans::check_fill(cases, |row, shade, step| kernel.fill(row, shade, step))),
    ("listed::write_nearer, u32, depths are kept", copy::<u32, true>),
    ("listed::write_nearer, u32, depths stay", copy::<u32, false>),
    ("listed::write_nearer, u16, depths are kept", copy::<u16, true>),
    ("listed::write_nearer, u16, depths stay", copy::<u16, false>),
    ("listed::fill", |cases, kernel| depth::check_list(cases, |pixels, spans| listed::fill(kernel, pixels, spans))),
    ("listed::fill_where_nearer, u32", list_nearer::<u32>),
    ("listed::fill_where_nearer, u16", list_nearer::<u16>),
    ("interpolate_at", |cases, kernel| {
        light::check_interpolate_at(cases, |places, a, da, d, dd| interpolate_at(kernel, places, a, da, d, dd))
    }),
    ("curve", |cases, kernel| {
        light::check_curve(cases, |shades, parabola, least, most| curve(kernel, shades, parabola, least, most))
    }),
];

fn copy<D: depth::NaiveCell, const KEEPS: bool>(cases: Cases, kernel: Kernel) -> Checked {
    depth::check_copy::<D>(cases, KEEPS, |length, row, cells, bytes, z, dz| {
        listed::write_nearer(kernel, (row, cells), (bytes, length), KEEPS, [z, dz])
    })
}

fn list_nearer<D: depth::NaiveCell>(cases: Cases, kernel: Kernel) -> Checked {
    depth::check_list_nearer::<D>(cases, |pixels, cells, spans, depths| {
        listed::fill_where_nearer(kernel, pixels, cells, spans, depths)
    })
}

/// Checks every loop, in the form that this machine draws with and with each of its kernels; one loop per step of the
/// iterator.
pub fn all(cases: Cases) -> impl Iterator<Item = Outcome> {
    let loops = LOOPS.into_iter().map(move |(name, check)| (name, None, check(cases)));
    let by_kernels = Kernel::available().flat_map(move |kernel| {
        BY_KERNEL.into_iter().map(move |(name, check)| (name, Some(kernel), check(cases, kernel)))
    });
    loops.chain(by_kernels).map(|(name, kernel, checked)| match checked {
        Ok(cases) => Outcome { name, kernel, cases, wrong: None },
        Err(wrong) => Outcome { name, kernel, cases: 0, wrong: Some(wrong) },
    })
}
