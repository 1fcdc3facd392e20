//! The budgets: what they promise, what they keep, what they cost.

use maud::{Markup, html};

use super::figures::{asked, count, interval, percent, ratio, shades, time};
use crate::cost::{BudgetRow, Study};

/// The share of covered pixels that must be within the budget.
const PROMISE: f64 = 1.0;

/// Greatest time of a budget, in times of the best single shading.
const LIMIT: f64 = 1.05;

/// The table and its chart.
pub(super) fn section(study: &Study, chart: impl FnOnce() -> Markup) -> Markup {
    html! {
        @if !study.budget.is_empty() { section {
            h2 { "The budget" }
            p {
                "Given how many shades of error are accepted, each face is drawn by the cheapest shading that keeps to it, by a bound from normals, lights and vertices; "
                "the time to decide is in the time. The promise: every covered pixel within the budget of lit, and at most 5 % slower than the cheapest "
                "single shading with exact cover that keeps the same promise."
            }
            (chart())
            div.wide { table {
                thead { tr {
                    th { "budget, shades" } th { "within it" } th { "largest error" } th { "r.m.s." } th { "largest patch beyond, pixels" } th { "swim" } th { "a frame" } th { "quartiles" }
                    th.text { "best single shading" } th { "its time" } th { "ratio" } th { "95 % interval" } th.text { "verdict" }
                } }
                tbody { @for row in &study.budget { (line(row)) } }
            } }
            h3 { "Which shading drew how many triangles" }
            div.wide { table {
                thead { tr { th { "budget, shades" } th.text { "triangles of all frames" } } }
                tbody { @for row in &study.budget { tr {
                    th scope="row" { (asked(row.max_error)) }
                    td.text { (shared_out(row)) }
                } } }
            } }
        } }
    }
}

fn line(row: &BudgetRow) -> Markup {
    html! { tr {
        th scope="row" { (asked(row.max_error)) }
        td { (percent(row.within)) } td { (shades(row.largest)) } td { (shades(row.rms)) } td { (count(row.patch)) } td { (shades(row.swim)) }
        td { (time(row.per_frame.median)) }
        td.soft { (time(row.per_frame.lower_quartile)) " – " (time(row.per_frame.upper_quartile)) }
        @match (row.best_single_shading, row.best_single) {
            (Some(shading), Some(best)) => { td.text { (shading) } td { (time(best.median)) } },
            (Some(shading), None) => { td.text { (shading) } td { "–" } },
            (None, _) => { td.text { "none keeps it" } td { "–" } },
        }
        @match row.ratio {
            Some((times, between)) => { td { (ratio(times)) } td.soft { (interval(between)) } },
            None => { td { "–" } td { "–" } },
        }
        td.text.verdict { (verdict(row)) }
    } }
}

/// Verdict on the promise of accuracy and on the limit of time.
pub(super) fn verdict(row: &BudgetRow) -> String {
    let accuracy = if row.within >= PROMISE { "accuracy kept" } else { "accuracy not kept" };
    let time = match (row.best_single_shading, row.ratio) {
        (None, _) => "no single shading keeps it, so the time limit is void",
        (Some(_), Some((times, _))) if times <= LIMIT => "time limit kept",
        (Some(_), Some((times, (low, _)))) if times > LIMIT && low <= LIMIT => {
            "time limit not kept, by no more than chance may do"
        }
        (Some(_), Some((times, _))) if times > LIMIT => "time limit not kept",
        _ => "time limit not measured",
    };
    format!("{accuracy}; {time}")
}

fn shared_out(row: &BudgetRow) -> String {
    // Below 2⁵³.
    let sum = row.triangles.iter().map(|(_, triangles)| *triangles as f64).sum::<f64>();
    let part = |(shading, triangles): &(mode13h::render::FaceShading, u64)| {
        format!("{shading} {} ({})", count(triangles), percent(*triangles as f64 / sum))
    };
    if row.triangles.is_empty() {
        "–".to_string()
    } else {
        row.triangles.iter().map(part).collect::<Vec<_>>().join(" · ")
    }
}
