//! The budgets: what they promise, what they keep and what they cost.

use maud::{Markup, html};

use super::figures::{DASH, asked, count, name_of, percent, ratio, shades, time};
use super::table::{Cell, Column, Table, interval, quartiles};
use crate::cost::{BudgetRow, Study};
use mode13h::plan::FaceShading;

/// The tables and the chart, for the page.
pub(super) fn section(study: &Study, chart: impl FnOnce() -> Markup) -> Markup {
    html! {
        @if !study.budget.is_empty() { section {
            h2 { "The budget" }
            p {
                "Each face is drawn by the cheapest shading that stays within the accepted error, judging by a bound from normals, lights and vertices; "
                "times include this decision. The promise: every covered pixel is within the budget of lit. The aim: at most 5 % slower than the cheapest "
                "single shading with exact cover that keeps the same promise."
            }
            (chart())
            (table(study).html())
            @let shares = shares(study).html();
            @if !shares.0.is_empty() { h3 { "Which shading drew how many triangles" } (shares) }
        } }
    }
}

/// The table of each budget's errors and times.
pub(super) fn table(study: &Study) -> Table {
    let columns = [
        Column::text("budget, shades").brief(),
        Column::number("within it").brief(),
        Column::number("not compared").brief(),
        Column::number("largest error").brief(),
        Column::number("r.m.s."),
        Column::number("largest patch beyond, pixels"),
        Column::number("swim").brief(),
        Column::number("a frame").brief(),
        Column::number("quartiles"),
        Column::text("best single shading").brief(),
        Column::number("its time").brief(),
        Column::number("ratio").brief(),
        Column::number("95 % interval"),
        Column::text("verdict").brief(),
    ];
    let row = |row: &BudgetRow| -> Vec<Cell> {
        vec![
            asked(row.max_error).into(),
            percent(row.within).into(),
            percent(row.not_compared).into(),
            shades(row.largest).into(),
            shades(row.rms).into(),
            count(row.patch).into(),
            shades(row.swim).into(),
            time(row.per_frame.median).into(),
            quartiles(&row.per_frame),
            row.best_single_shading.map_or("none keeps it".to_string(), name_of).into(),
            row.best_single.map_or(DASH.to_string(), |best| time(best.median)).into(),
            row.ratio.map_or(DASH.to_string(), |(times, _)| ratio(times)).into(),
            row.ratio.map_or(DASH.into(), |(_, between)| interval(between)),
            row.verdict().into(),
        ]
    };
    Table::new(&columns, study.budget.iter().map(row).collect())
}

/// The table of how many triangles each shading drew.
fn shares(study: &Study) -> Table {
    let columns = [Column::text("budget, shades"), Column::text("triangles of all frames")];
    let rows = study.budget.iter().filter(|row| !row.triangles.is_empty());
    Table::new(&columns, rows.map(|row| vec![asked(row.max_error).into(), shared_out(row).into()]).collect())
}

fn shared_out(row: &BudgetRow) -> String {
    // Below 2⁵³.
    let sum = row.triangles.iter().map(|(_, triangles)| *triangles as f64).sum::<f64>();
    let part = |(shading, triangles): &(FaceShading, u64)| {
        format!("{shading} {} ({})", count(triangles), percent(*triangles as f64 / sum))
    };
    row.triangles.iter().map(part).collect::<Vec<_>>().join(" · ")
}
