//! A study in two sentences.

use super::figures::{at_most, counted_shades, ratio, time};
use crate::cost::{ShadingRow, Study};
use mode13h::render::Shading;

/// Below this many shades a difference between two largest errors is none that anyone sees.
const NOTHING: f64 = 0.05;

/// Summary of a study in two sentences, whatever it found: the cost and the error of 8.8 arithmetic, and the part of
/// the rest that light at every pixel removes. If there is no 8.8, the fastest and the nearest of the other shadings.
/// Bounds are rounded up.
#[must_use]
pub fn summary(study: &Study) -> [String; 2] {
    let find = |shading: Shading| study.shadings.iter().find(|row| row.shading == shading);
    let Some(linear) = find(Shading::Gouraud88).or_else(|| find(Shading::Gouraud88Reseeded)) else {
        return of_others(study);
    };
    [arithmetic(&study.input, linear, find(Shading::GouraudVintage)), model(linear, find(Shading::Phong))]
}

/// The numeric error of linear shades, and their price against the loop of the period.
fn arithmetic(input: &str, linear: &ShadingRow, period: Option<&ShadingRow>) -> String {
    let error = match linear.error_gouraud.max {
        error if !error.is_finite() => "has an error that is not known".to_string(),
        0.0 => "is exact".to_string(),
        error => format!("is within {} of 255 shades of exact Gouraud shading", at_most(error)),
    };
    let price = match period {
        Some(period) => takes(linear, period, "the loop as it was printed"),
        None if linear.per_frame.median.is_finite() => format!("takes {} a frame", time(linear.per_frame.median)),
        None => "takes a time that is not known".to_string(),
    };
    let name = if linear.shading == Shading::Gouraud88 { "old loop, done right," } else { "old loop, reseeded," };
    format!("On {input} the {name} {error} and {price}.")
}

/// The error of the model, and what removing it costs.
fn model(linear: &ShadingRow, phong: Option<&ShadingRow>) -> String {
    let left = linear.error_lit.max;
    let Some(phong) = phong else {
        return match left {
            left if left.is_finite() => format!("Against light at every pixel it is off by up to {}.", of_shades(left)),
            _ => "How far it is from light at every pixel is not known.".to_string(),
        };
    };
    let rest = phong.error_lit.max;
    let price = takes(phong, linear, "the old loop");
    if !left.is_finite() || !rest.is_finite() {
        format!("How far either is from light at every pixel is not known; lighting every pixel {price}.")
    } else if left <= NOTHING {
        format!("Lighting every pixel has no error to remove; it {price}.")
    } else if rest >= left + NOTHING {
        format!(
            "Lighting every pixel is no nearer, off by up to {} against {}, and {price}.",
            of_shades(rest),
            at_most(left)
        )
    } else if rest > left - NOTHING {
        format!("Lighting every pixel leaves the error at {} and {price}.", of_shades(left))
    } else {
        format!("Lighting every pixel takes the error from {} to {} and {price}.", at_most(left), of_shades(rest))
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
        "On {} the fastest shading measured is {}: off from light at every pixel by at most {}, in {} a frame.",
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
            takes(nearest, fastest, "that")
        )
    };
    [first, second]
}

/// Compares the time of `row` with that of `other`, called `name`.
fn takes(row: &ShadingRow, other: &ShadingRow, name: &str) -> String {
    let times = row.ratio / other.ratio;
    if row.as_fast_as.contains(&other.shading) || other.as_fast_as.contains(&row.shading) {
        format!("takes as long as {name}, as far as can be told")
    } else if !times.is_finite() || times <= 0.0 {
        "takes a time that is not known".to_string()
    } else {
        format!("takes {} times as long as {name}", ratio(times))
    }
}

fn of_shades(error: f64) -> String {
    counted_shades(&at_most(error))
}
