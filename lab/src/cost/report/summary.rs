//! A study in two sentences.

use super::figures::{at_most, counted_shades, ratio, time, without_zeros};
use crate::cost::{ShadingRow, Study};
use mode13h::settings::Shading;

/// Two largest errors that differ by less than this many shades look the same.
const NOTHING: f64 = 0.05;

/// A study in two sentences, whatever it found: how far the default loop is from exact and how fast it is compared with
/// the loop as printed, then what lighting every pixel gains and costs. Without the default or `gouraud-8.8`, it
/// compares the fastest of the other shadings with the nearest. Bounds are rounded up.
#[must_use]
pub fn summary(study: &Study) -> [String; 2] {
    let find = |shading: Shading| study.shadings.iter().find(|row| row.shading == shading);
    let Some(linear) = find(Shading::default()).or_else(|| find(Shading::Gouraud88)) else {
        return of_others(study);
    };
    [arithmetic(&study.input, linear, find(Shading::GouraudVintage)), model(linear, find(Shading::Phong))]
}

/// The numeric error of the default loop, and its time compared with the printed loop's.
fn arithmetic(input: &str, linear: &ShadingRow, printed: Option<&ShadingRow>) -> String {
    let error = match linear.error_gouraud.max {
        error if !error.is_finite() => "has an error that is not known".to_string(),
        0.0 => "is exact".to_string(),
        error => format!("is within {} of 255 shades of exact", at_most(error)),
    };
    let time = match printed {
        Some(printed) => speed(linear, printed, "the printed one"),
        None if linear.per_frame.median.is_finite() => format!("takes {} a frame", time(linear.per_frame.median)),
        None => "takes a time that is not known".to_string(),
    };
    let name = if linear.shading == Shading::default() { "the old loop, done right," } else { "the old loop" };
    format!("On {input} {name} {error} and {time}.")
}

/// Says how much light at every pixel reduces the error, and what it costs.
fn model(linear: &ShadingRow, phong: Option<&ShadingRow>) -> String {
    let left = linear.error_lit.max;
    let Some(phong) = phong else {
        return match left {
            left if left.is_finite() => {
                format!("It differs from light at every pixel by up to {}.", counted_shades(&at_most(left)))
            }
            _ => "How far it is from light at every pixel is not known.".to_string(),
        };
    };
    let rest = phong.error_lit.max;
    let price = match times(phong, linear) {
        None => "as long, as far as can be told".to_string(),
        Some(times) if times.is_finite() && times > 0.0 => format!("{} times as long", brief(times)),
        Some(_) => "a time that is not known".to_string(),
    };
    if !left.is_finite() || !rest.is_finite() {
        format!("What lighting every pixel gains is not known; it takes {price}.")
    } else if (rest - left).abs() <= NOTHING {
        format!("Lighting every pixel leaves the error at {} and takes {price}.", counted_shades(&at_most(rest)))
    } else {
        let (from, to) = (at_most(left), counted_shades(&at_most(rest)));
        format!("Lighting every pixel takes the error from {from} to {to} and {price}.")
    }
}

/// Without 8.8: the fastest and the nearest.
fn of_others(study: &Study) -> [String; 2] {
    let known =
        || study.shadings.iter().filter(|row| row.per_frame.median.is_finite() && row.error_lit.max.is_finite());
    let fastest = known().min_by(|a, b| a.per_frame.median.total_cmp(&b.per_frame.median));
    let nearest = known().min_by(|a, b| a.error_lit.max.total_cmp(&b.error_lit.max));
    let (Some(fastest), Some(nearest)) = (fastest, nearest) else {
        return [format!("On {} no shading was measured.", study.input), "So there is nothing to compare.".to_string()];
    };
    let first = format!(
        "On {} the fastest shading measured is {}: within {} of light at every pixel, in {} per frame.",
        study.input,
        fastest.shading,
        of_shades(fastest.error_lit.max),
        time(fastest.per_frame.median)
    );
    let second = if nearest.shading == fastest.shading {
        "No other shading measured is nearer.".to_string()
    } else {
        format!(
            "The nearest is {}: off by at most {}; it {}.",
            nearest.shading,
            of_shades(nearest.error_lit.max),
            slowness(nearest, fastest, "that")
        )
    };
    [first, second]
}

/// The ratio of the time of `row` to that of `other`; `None` if the difference is not measurable.
pub(super) fn times(row: &ShadingRow, other: &ShadingRow) -> Option<f64> {
    let tied = row.as_fast_as.contains(&other.shading) || other.as_fast_as.contains(&row.shading);
    (!tied).then_some(row.ratio / other.ratio)
}

/// How fast `row` is compared with `other`, which is called `name`.
fn speed(row: &ShadingRow, other: &ShadingRow, name: &str) -> String {
    match times(row, other) {
        None => format!("as fast as {name}, as far as can be told"),
        Some(times) if times > 0.0 && times < 1.0 => format!("{} times as fast as {name}", brief(1.0 / times)),
        Some(_) => slowness(row, other, name),
    }
}

/// How long `row` takes compared with `other`, which is called `name`.
fn slowness(row: &ShadingRow, other: &ShadingRow, name: &str) -> String {
    match times(row, other) {
        None => format!("takes as long as {name}, as far as can be told"),
        Some(times) if times.is_finite() && times > 0.0 => format!("takes {} times as long as {name}", brief(times)),
        Some(_) => "takes a time that is not known".to_string(),
    }
}

/// A ratio without trailing zeros.
pub(super) fn brief(times: f64) -> String {
    without_zeros(&ratio(times)).to_string()
}

fn of_shades(error: f64) -> String {
    counted_shades(&at_most(error))
}
