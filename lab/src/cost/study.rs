//! Results of a study, in numbers. Times are in nanoseconds, errors in shades of 1/255 of full intensity.
//!
//! With the feature `serde` all of it can be serialized: a time with its quartiles is an object, a ratio with its interval a
//! list `[ratio, [low, high]]`, and what has a name is that name.

use alloc::string::String;
use alloc::vec::Vec;

use mode13h::plan::FaceShading;
use mode13h::settings::Shading;

/// The cost of accuracy on one scene or model.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Study {
    /// Name of the input that was measured.
    pub input: String,
    /// The machine and the program.
    pub host: Host,
    /// The name of the span kernel that drew.
    pub kernel: String,
    /// Frames in a round.
    pub frames: usize,
    /// Rounds that were measured, each of all shadings in shuffled order.
    pub rounds: usize,
    /// A shading each, in the order of [`Shading::ALL`].
    pub shadings: Vec<ShadingRow>,
    /// A budget each, the greatest error first.
    pub budget: Vec<BudgetRow>,
    /// A time each, the shortest first.
    pub times: Vec<TimeRow>,
    /// Other choices, grouped by aspect.
    pub options: Vec<OptionRow>,
    /// Claims of the sources.
    pub claims: Vec<Claim>,
}

/// Machine and programs of a study.
#[derive(Clone, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Host {
    /// The processor's name, as it says itself.
    pub processor: String,
    /// The compiler and its version.
    pub compiler: String,
    /// Profile, target and features that the program was built with.
    pub flags: String,
    /// The clock that times were read from.
    pub clock: String,
    /// Length of a step of it, as measured.
    #[cfg_attr(feature = "serde", serde(rename = "clock_step_ns"))]
    pub clock_step: f64,
}

/// A time over many samples.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Nanoseconds {
    /// The median.
    pub median: f64,
    /// A quarter of the samples are less.
    pub lower_quartile: f64,
    /// A quarter of the samples are more.
    pub upper_quartile: f64,
}

/// Split of a frame's time into parts; medians.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Split {
    /// Deciding which effects are on.
    pub plan: f64,
    /// Transforming, projecting and lighting vertices.
    pub vertices: f64,
    /// Set-up: from three vertices to the ends of spans and their first shades.
    pub setup: f64,
    /// The pixel loops.
    pub spans: f64,
    /// Scan-out: from indices to red, green and blue.
    pub scan_out: f64,
}

/// Errors of frames against a standard of truth.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Errors {
    /// The largest.
    pub max: f64,
    /// The mean.
    pub mean: f64,
    /// The root mean square.
    pub rms: f64,
    /// The share of pixels off by one shade or more, 0 to 1.
    pub off_by_one: f64,
    /// The root mean square of the means over blocks of 4 × 4 pixels.
    pub rms_of_blocks: f64,
}

/// One shading.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ShadingRow {
    /// The shading.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub shading: Shading,
    /// Time for a frame, scan-out left out.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// Time for a pixel written.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_pixel"))]
    pub per_pixel: f64,
    /// Time for a triangle drawn.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_triangle"))]
    pub per_triangle: f64,
    /// The time as a ratio to that of `gouraud-8.8`.
    pub ratio: f64,
    /// Its 95 % interval, by bootstrap.
    pub ratio_interval: (f64, f64),
    /// Split of the time.
    #[cfg_attr(feature = "serde", serde(rename = "split_ns"))]
    pub split: Split,
    /// Instructions for a frame, where they were counted.
    #[cfg_attr(feature = "serde", serde(rename = "instructions_per_frame"))]
    pub instructions: Option<u64>,
    /// Against `gouraud`.
    pub error_gouraud: Errors,
    /// Against `lit`.
    pub error_lit: Errors,
    /// Error that the nearest entry of the scene's own ramp or palette adds, at most.
    pub error_palette: f64,
    /// Pixels that show another face than they should, over all frames, vertices rounded alike.
    pub cover_errors: u64,
    /// The share of the covered pixels that was not compared with `lit`, 0 to 1, as another face was seen there.
    pub not_compared: f64,
    /// Shades by which the worst pixel is beyond the shading's bound, negative if none is. Shadings that are linear on the
    /// screen have one, where the plan states how far linear shades are off.
    #[cfg_attr(feature = "serde", serde(rename = "beyond_bound"))]
    pub excess: Option<f64>,
    /// Change of errors from a frame to the next, root mean square.
    pub swim: f64,
    /// True if no other shading is as near to `lit` and measurably faster.
    pub efficient: bool,
    /// Shadings whose time cannot be told from this one's.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::shadings"))]
    pub as_fast_as: Vec<Shading>,
    /// The first frame: indices of a ramp of 256 greys, row-major.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub picture: Vec<u8>,
    /// Its error against `lit` at each pixel; NaN where none was taken.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub error_map: Vec<f32>,
}

/// One budget.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct BudgetRow {
    /// Shades of error that are accepted.
    pub max_error: f64,
    /// The share of covered pixels within it, against `lit`, 0 to 1.
    pub within: f64,
    /// The share of the covered pixels that was not compared with `lit`, 0 to 1, as another face was seen there.
    pub not_compared: f64,
    /// The largest error.
    pub largest: f64,
    /// The root mean square of the errors.
    pub rms: f64,
    /// The pixels of the largest connected patch beyond it.
    #[cfg_attr(feature = "serde", serde(rename = "largest_patch"))]
    pub patch: usize,
    /// Change of errors from a frame to the next, root mean square: what choices that change with the frame add is seen here.
    pub swim: f64,
    /// Time for a frame.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// The cheapest shading with exact cover that keeps every pixel within; none may.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::maybe"))]
    pub best_single_shading: Option<Shading>,
    /// Its time for a frame, measured beside the budget's.
    #[cfg_attr(feature = "serde", serde(rename = "best_single_ns"))]
    pub best_single: Option<Nanoseconds>,
    /// The budget's time as a ratio to that, and the ratio's 95 % interval.
    pub ratio: Option<(f64, (f64, f64))>,
    /// Triangles of all frames that each shading drew, those of none left out.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::triangles"))]
    pub triangles: Vec<(FaceShading, u64)>,
}

/// One time for a frame, by which the renderer chose the errors.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct TimeRow {
    /// The time for a frame.
    #[cfg_attr(feature = "serde", serde(rename = "max_time_ns"))]
    pub max_time: f64,
    /// Frames that were drawn, those left out in which the errors were tried.
    pub frames: usize,
    /// The mean time of these.
    #[cfg_attr(feature = "serde", serde(rename = "mean_time_ns"))]
    pub mean_time: f64,
    /// The share of these within 1.05 times `max_time`, 0 to 1.
    pub within: f64,
    /// The mean of the errors that were accepted.
    pub mean_error: f64,
    /// The greatest of them.
    pub max_error: f64,
    /// The least of [`BUDGETS`](super::BUDGETS) whose time for a frame, measured beside the shadings', is within
    /// `max_time`; none may be.
    pub least_that_fits: Option<f64>,
    /// The largest error of these frames against `lit`, except at pixels where rounded vertices shift the light itself.
    pub largest: f64,
}

/// Aspects that may be chosen beside the shading.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[non_exhaustive]
pub enum Aspect {
    /// f32 or 16.16.
    VertexPath,
    /// Rounding of projected vertices.
    VertexRounding,
    /// The span kernel.
    Kernel,
    /// Dither or none. Errors are those on a ramp of 32 entries, which stand for shades 8.2 apart; times those in the
    /// scene's own palette.
    Dither,
    /// The way to visible surfaces.
    HiddenSurfaces,
    /// Each shading by the portable kernel.
    PortableShading,
}

impl Aspect {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::VertexPath => "arithmetic",
            Self::VertexRounding => "vertex rounding",
            Self::Kernel => "kernel",
            Self::Dither => "dither",
            Self::HiddenSurfaces => "hidden surfaces",
            Self::PortableShading => "shading, portable kernel",
        }
    }
}

impl core::fmt::Display for Aspect {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// One choice of an aspect, all else as by default.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OptionRow {
    /// The aspect chosen.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub aspect: Aspect,
    /// Its name.
    pub name: String,
    /// Time for a frame.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// The time as a ratio to that of the aspect's first row, and its 95 % interval.
    pub ratio: (f64, (f64, f64)),
    /// Against `gouraud-unrounded`.
    #[cfg_attr(feature = "serde", serde(rename = "error_gouraud_unrounded"))]
    pub error: Errors,
    /// Pixels that show another face than they should, vertices unrounded.
    pub cover_errors: u64,
}

/// Verdict of measuring on a claim.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The claim holds.
    Holds,
    /// The claim holds within limits, which the text names.
    HoldsInPart,
    /// The claim does not hold.
    DoesNotHold,
}

impl Verdict {
    /// The verdict in words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsInPart => "holds in part",
            Self::DoesNotHold => "does not hold",
        }
    }
}

impl core::fmt::Display for Verdict {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// A claim that an old text makes, and what was measured.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Claim {
    /// The claim.
    pub claim: String,
    /// Result of measuring, with figures.
    pub measured: String,
    /// The verdict.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub verdict: Verdict,
}

/// Fields that are written by name.
#[cfg(feature = "serde")]
mod json {
    use core::fmt::Display;

    use serde::Serializer;

    use super::{FaceShading, Shading};

    pub(super) fn text<S: Serializer>(named: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(named)
    }

    pub(super) fn maybe<S: Serializer>(shading: &Option<Shading>, serializer: S) -> Result<S::Ok, S::Error> {
        serde::Serialize::serialize(&shading.map(Shading::name), serializer)
    }

    pub(super) fn shadings<S: Serializer>(shadings: &[Shading], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(shadings.iter().map(|shading| shading.name()))
    }

    pub(super) fn triangles<S: Serializer>(of: &[(FaceShading, u64)], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(of.iter().map(|(shading, triangles)| (shading.name(), triangles)))
    }
}
