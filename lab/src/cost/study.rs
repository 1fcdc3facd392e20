//! Results of a study, in numbers. Times are in nanoseconds, errors in shades of 1/255 of full intensity.
//!
//! With the feature `serde` everything can be serialized: a time with its quartiles is an object, a ratio with its
//! interval a list `[ratio, [low, high]]`, and anything that has a name is written as that name.

use mode13h::plan::FaceShading;
use mode13h::settings::Shading;

/// The cost of accuracy on one scene or model.
#[derive(Clone, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Study {
    /// Name of the input that was measured.
    pub input: String,
    /// The machine and the program.
    pub host: Host,
    /// The name of the span kernel that drew.
    pub kernel: String,
    /// Frames per round.
    pub frames: usize,
    /// Rounds that were measured, each of all shadings in shuffled order.
    pub rounds: usize,
    /// One row per shading, in the order of [`Shading::ALL`].
    pub shadings: Vec<ShadingRow>,
    /// One row per budget, largest error first.
    pub budget: Vec<BudgetRow>,
    /// One row per time, shortest first.
    pub times: Vec<TimeRow>,
    /// Other choices, grouped by aspect.
    pub options: Vec<OptionRow>,
    /// The sources' claims.
    pub claims: Vec<Claim>,
}

/// The machine and the program of a study.
#[derive(Clone, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Host {
    /// The processor's name, as it reports itself.
    pub processor: String,
    /// The compiler and its version.
    pub compiler: String,
    /// Profile, target and features that the program was built with.
    pub flags: String,
    /// The clock that times were read from.
    pub clock: String,
    /// The clock's step, as measured.
    #[cfg_attr(feature = "serde", serde(rename = "clock_step_ns"))]
    pub clock_step: f64,
}

/// A time over many samples.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Nanoseconds {
    /// The median.
    pub median: f64,
    /// A quarter of the samples are below it.
    pub lower_quartile: f64,
    /// A quarter of the samples are above it.
    pub upper_quartile: f64,
}

/// A frame's time split into parts; medians.
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
    /// The root mean square of the means of blocks of 4 × 4 pixels.
    pub rms_of_blocks: f64,
}

/// One shading.
#[derive(Clone, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ShadingRow {
    /// The shading.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub shading: Shading,
    /// Time per frame, without scan-out.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// Time per pixel written.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_pixel"))]
    pub per_pixel: f64,
    /// Time per triangle drawn.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_triangle"))]
    pub per_triangle: f64,
    /// The time as a ratio to that of `gouraud-8.8`.
    pub ratio: f64,
    /// The ratio's 95 % bootstrap interval.
    pub ratio_interval: (f64, f64),
    /// The time, split into parts.
    #[cfg_attr(feature = "serde", serde(rename = "split_ns"))]
    pub split: Split,
    /// Instructions per frame, if they were counted.
    #[cfg_attr(feature = "serde", serde(rename = "instructions_per_frame"))]
    pub instructions: Option<u64>,
    /// Error against `gouraud`.
    pub error_gouraud: Errors,
    /// Error against `lit`.
    pub error_lit: Errors,
    /// Largest error that the nearest entry of the scene's own ramp or palette adds.
    pub error_palette: f64,
    /// Pixels that show the wrong face, over all frames, with the truth's vertices rounded as ours are.
    pub cover_errors: u64,
    /// Share of the covered pixels that were not compared with `lit` because they show another face, 0 to 1.
    pub not_compared: f64,
    /// How far the worst pixel exceeds the shading's bound, in shades, negative if none does. Only shadings that are
    /// linear on the screen have one, and only if the plan states how far linear shades are off.
    #[cfg_attr(feature = "serde", serde(rename = "beyond_bound"))]
    pub excess: Option<f64>,
    /// Change of the errors from one frame to the next, root mean square.
    pub swim: f64,
    /// True if no other shading is as near to `lit` and measurably faster.
    pub efficient: bool,
    /// Shadings whose time cannot be distinguished from this one's.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::shadings"))]
    pub as_fast_as: Vec<Shading>,
    /// The first frame: indices of a ramp of 256 greys, row-major.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub picture: Vec<u8>,
    /// The first frame's error against `lit` at each pixel; NaN where none was measured.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub error_map: Vec<f32>,
}

/// One budget.
#[derive(Clone, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct BudgetRow {
    /// Error that is accepted, in shades.
    pub max_error: f64,
    /// Share of covered pixels that differ from `lit` by at most this error, 0 to 1.
    pub within: f64,
    /// Share of the covered pixels that were not compared with `lit` because they show another face, 0 to 1.
    pub not_compared: f64,
    /// The largest error.
    pub largest: f64,
    /// The root mean square of the errors.
    pub rms: f64,
    /// Number of pixels in the largest connected patch beyond the budget.
    #[cfg_attr(feature = "serde", serde(rename = "largest_patch"))]
    pub patch: usize,
    /// Change of the errors from one frame to the next, root mean square, including the effect of choices that differ
    /// between the two.
    pub swim: f64,
    /// Time per frame.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// The cheapest shading with exact coverage that keeps every pixel within the budget, if there is one.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::maybe"))]
    pub best_single_shading: Option<Shading>,
    /// The time per frame of `best_single_shading`, measured alongside the budget's.
    #[cfg_attr(feature = "serde", serde(rename = "best_single_ns"))]
    pub best_single: Option<Nanoseconds>,
    /// The ratio of the budget's time to that, with its 95 % interval.
    pub ratio: Option<(f64, (f64, f64))>,
    /// Triangles of all frames that each shading drew; shadings that drew none are left out.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::triangles"))]
    pub triangles: Vec<(FaceShading, u64)>,
}

/// One time per frame, for which the renderer chose the errors.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct TimeRow {
    /// The time allowed per frame.
    #[cfg_attr(feature = "serde", serde(rename = "max_time_ns"))]
    pub max_time: f64,
    /// Frames drawn, not counting those used to try out the errors.
    pub frames: usize,
    /// The mean time of these frames.
    #[cfg_attr(feature = "serde", serde(rename = "mean_time_ns"))]
    pub mean_time: f64,
    /// The share of these frames within 1.05 times `max_time`, 0 to 1.
    pub within: f64,
    /// The mean of the errors accepted.
    pub mean_error: f64,
    /// The largest error accepted.
    pub max_error: f64,
    /// The smallest of [`BUDGETS`](super::BUDGETS) whose time per frame, measured alongside the shadings', is within
    /// `max_time`, if there is one.
    pub least_that_fits: Option<f64>,
    /// The largest error of these frames against `lit`, except at pixels where rounded vertices shift the light itself.
    pub largest: f64,
}

/// Aspects of drawing other than the shading.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[non_exhaustive]
pub enum Aspect {
    /// f32 or 16.16.
    VertexPath,
    /// Rounding of projected vertices.
    VertexRounding,
    /// The span kernel.
    Kernel,
    /// Dither or none. Errors are on a ramp of 32 entries, which are 8.2 shades apart; times are with the scene's own
    /// palette.
    Dither,
    /// The hidden-surface method.
    HiddenSurfaces,
    /// Each shading with the portable kernel.
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

/// One choice of an aspect, with defaults for everything else.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OptionRow {
    /// The aspect chosen.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub aspect: Aspect,
    /// Its name.
    pub name: String,
    /// Time per frame.
    #[cfg_attr(feature = "serde", serde(rename = "ns_per_frame"))]
    pub per_frame: Nanoseconds,
    /// The ratio of the time to that of the aspect's first row, with its 95 % interval.
    pub ratio: (f64, (f64, f64)),
    /// Error against `gouraud-unrounded`.
    #[cfg_attr(feature = "serde", serde(rename = "error_gouraud_unrounded"))]
    pub error: Errors,
    /// Pixels that show the wrong face, with the truth's vertices unrounded.
    pub cover_errors: u64,
}

/// The verdict of the measurements on a claim.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The claim holds.
    Holds,
    /// The claim holds within limits that the text names.
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

/// A claim made by an old text, and what was measured.
#[derive(Clone, PartialEq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Claim {
    /// The claim.
    pub claim: String,
    /// The measurement, with figures.
    pub measured: String,
    /// The verdict.
    #[cfg_attr(feature = "serde", serde(serialize_with = "json::text"))]
    pub verdict: Verdict,
}

/// Serializers for fields that are written by name.
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
