//! A study for programs.

use std::collections::BTreeMap;

use mode13h_lab::cost::{BudgetRow, Claim, Errors, Nanoseconds, OptionRow, ShadingRow, Study, TimeRow};
use serde::Serialize;

use crate::output::SCHEMA;

#[derive(Serialize)]
pub(super) struct Json<'a> {
    schema: u32,
    input: &'a str,
    host: Host<'a>,
    kernel: &'a str,
    frames: usize,
    rounds: usize,
    shadings: Vec<JsonShading>,
    budget: Vec<JsonBudget>,
    times: Vec<JsonTime>,
    options: Vec<JsonOption<'a>>,
    claims: Vec<JsonClaim<'a>>,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Host<'a> {
    processor: &'a str,
    compiler: &'a str,
    flags: &'a str,
    clock: &'a str,
    clock_step_ns: f64,
}

#[derive(Serialize)]
struct JsonErrors {
    max: f64,
    mean: f64,
    rms: f64,
    off_by_one: f64,
    rms_of_blocks: f64,
}

impl From<Errors> for JsonErrors {
    fn from(errors: Errors) -> Self {
        let Errors { max, mean, rms, off_by_one, rms_of_blocks } = errors;
        Self { max, mean, rms, off_by_one, rms_of_blocks }
    }
}

/// Split of the time, in nanoseconds for a frame.
#[derive(Serialize)]
struct JsonSplit {
    plan: f64,
    vertices: f64,
    setup: f64,
    spans: f64,
    scan_out: f64,
}

#[derive(Serialize)]
struct JsonShading {
    shading: &'static str,
    ns_per_frame: f64,
    ns_per_frame_quartiles: [f64; 2],
    ns_per_pixel: f64,
    ns_per_triangle: f64,
    ratio: f64,
    ratio_interval: [f64; 2],
    split_ns: JsonSplit,
    instructions_per_frame: Option<u64>,
    error_gouraud: JsonErrors,
    error_lit: JsonErrors,
    error_palette: f64,
    cover_errors: u64,
    not_compared: f64,
    beyond_bound: Option<f64>,
    swim: f64,
    efficient: bool,
    as_fast_as: Vec<&'static str>,
}

#[derive(Serialize)]
struct JsonBudget {
    max_error: f64,
    within: f64,
    not_compared: f64,
    largest: f64,
    rms: f64,
    largest_patch: usize,
    swim: f64,
    ns_per_frame: f64,
    ns_per_frame_quartiles: [f64; 2],
    best_single_shading: Option<&'static str>,
    best_single_ns: Option<f64>,
    ratio: Option<f64>,
    ratio_interval: Option<[f64; 2]>,
    verdict: String,
    triangles: BTreeMap<&'static str, u64>,
}

#[derive(Serialize)]
struct JsonTime {
    max_time_ns: f64,
    frames: usize,
    mean_time_ns: f64,
    within: f64,
    mean_error: f64,
    max_error: f64,
    least_that_fits: Option<f64>,
    largest: f64,
}

impl From<&TimeRow> for JsonTime {
    fn from(row: &TimeRow) -> Self {
        let TimeRow { max_time, frames, mean_time, within, mean_error, max_error, least_that_fits, largest, .. } = *row;
        Self {
            max_time_ns: max_time,
            frames,
            mean_time_ns: mean_time,
            within,
            mean_error,
            max_error,
            least_that_fits,
            largest,
        }
    }
}

#[derive(Serialize)]
struct JsonOption<'a> {
    aspect: String,
    name: &'a str,
    ns_per_frame: f64,
    ns_per_frame_quartiles: [f64; 2],
    ratio: f64,
    ratio_interval: [f64; 2],
    error_gouraud_unrounded: JsonErrors,
    cover_errors: u64,
}

#[derive(Serialize)]
struct JsonClaim<'a> {
    claim: &'a str,
    measured: &'a str,
    verdict: &'static str,
}

fn quartiles(time: &Nanoseconds) -> [f64; 2] {
    [time.lower_quartile, time.upper_quartile]
}

fn interval((low, high): (f64, f64)) -> [f64; 2] {
    [low, high]
}

impl From<&ShadingRow> for JsonShading {
    fn from(row: &ShadingRow) -> Self {
        let split = row.split;
        Self {
            shading: row.shading.name(),
            ns_per_frame: row.per_frame.median,
            ns_per_frame_quartiles: quartiles(&row.per_frame),
            ns_per_pixel: row.per_pixel,
            ns_per_triangle: row.per_triangle,
            ratio: row.ratio,
            ratio_interval: interval(row.ratio_interval),
            split_ns: JsonSplit {
                plan: split.plan,
                vertices: split.vertices,
                setup: split.setup,
                spans: split.spans,
                scan_out: split.scan_out,
            },
            instructions_per_frame: row.instructions,
            error_gouraud: row.error_gouraud.into(),
            error_lit: row.error_lit.into(),
            error_palette: row.error_palette,
            cover_errors: row.cover_errors,
            not_compared: row.not_compared,
            beyond_bound: row.excess,
            swim: row.swim,
            efficient: row.efficient,
            as_fast_as: row.as_fast_as.iter().map(|shading| shading.name()).collect(),
        }
    }
}

impl From<&BudgetRow> for JsonBudget {
    fn from(row: &BudgetRow) -> Self {
        Self {
            max_error: row.max_error,
            within: row.within,
            not_compared: row.not_compared,
            largest: row.largest,
            rms: row.rms,
            largest_patch: row.patch,
            swim: row.swim,
            ns_per_frame: row.per_frame.median,
            ns_per_frame_quartiles: quartiles(&row.per_frame),
            best_single_shading: row.best_single_shading.map(|shading| shading.name()),
            best_single_ns: row.best_single.map(|time| time.median),
            ratio: row.ratio.map(|(ratio, _)| ratio),
            ratio_interval: row.ratio.map(|(_, of)| interval(of)),
            verdict: row.verdict(),
            triangles: row.triangles.iter().map(|(shading, triangles)| (shading.name(), *triangles)).collect(),
        }
    }
}

impl<'a> From<&'a OptionRow> for JsonOption<'a> {
    fn from(row: &'a OptionRow) -> Self {
        let (ratio, of) = row.ratio;
        Self {
            aspect: row.aspect.to_string(),
            name: &row.name,
            ns_per_frame: row.per_frame.median,
            ns_per_frame_quartiles: quartiles(&row.per_frame),
            ratio,
            ratio_interval: interval(of),
            error_gouraud_unrounded: row.error.into(),
            cover_errors: row.cover_errors,
        }
    }
}

impl<'a> From<&'a Claim> for JsonClaim<'a> {
    fn from(claim: &'a Claim) -> Self {
        Self { claim: &claim.claim, measured: &claim.measured, verdict: claim.verdict.name() }
    }
}

/// The study for programs.
pub(super) fn json<'a>(study: &'a Study, warnings: &'a [String]) -> Json<'a> {
    let host = &study.host;
    Json {
        schema: SCHEMA,
        input: &study.input,
        host: Host {
            processor: &host.processor,
            compiler: &host.compiler,
            flags: &host.flags,
            clock: &host.clock,
            clock_step_ns: host.clock_step,
        },
        kernel: &study.kernel,
        frames: study.frames,
        rounds: study.rounds,
        shadings: study.shadings.iter().map(JsonShading::from).collect(),
        budget: study.budget.iter().map(JsonBudget::from).collect(),
        times: study.times.iter().map(JsonTime::from).collect(),
        options: study.options.iter().map(JsonOption::from).collect(),
        claims: study.claims.iter().map(JsonClaim::from).collect(),
        warnings,
    }
}
