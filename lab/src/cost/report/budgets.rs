//! The budgets: what they promise, what they keep and what they cost.

use maud::{Markup, html};

use super::figures::{DASH, asked, count, name_of, percent, ratio, shades, time};
use super::table::{self, Table, interval, quartiles};
use crate::cost::{BudgetRow, Study};
use mode13h::plan::FaceShading;

type Column = table::Column<BudgetRow>;

/// The tables and the chart, for the page.
pub(super) fn section(study: &Study, chart: impl FnOnce() -> Markup) -> Markup {
    html! {
        @if !study.budget.is_empty() { section {
            h2 { "The budget" }
            p {
                "Each face is drawn by the cheapest shading that stays within the accepted error, judging by a bound from normals, lights and vertices; "
                "times include this decision. The promise: every covered pixel is within the budget of lit. The aim: at most 5 % slower than the cheapest "
                "single shading with exact coverage that keeps the same promise."
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
        Column::text("budget, shades", |row| asked(row.max_error)).brief(),
        Column::number("within it", |row| percent(row.within)).brief(),
        Column::number("not compared", |row| percent(row.not_compared)).brief(),
        Column::number("largest error", |row| shades(row.largest)).brief(),
        Column::number("r.m.s.", |row| shades(row.rms)),
        Column::number("largest patch beyond, pixels", |row| count(row.patch)),
        Column::number("swim", |row| shades(row.swim)).brief(),
        Column::number("a frame", |row| time(row.per_frame.median)).brief(),
        Column::number("quartiles", |row| quartiles(&row.per_frame)),
        Column::text("best single shading", |row| row.best_single_shading.map_or("none keeps it".into(), name_of))
            .brief(),
        Column::number("its time", |row| row.best_single.map_or(DASH.into(), |best| time(best.median))).brief(),
        Column::number("ratio", |row| row.ratio.map_or(DASH.into(), |(times, _)| ratio(times))).brief(),
        Column::number("95 % interval", |row| row.ratio.map_or(DASH.into(), |(_, between)| interval(between))),
        Column::text("verdict", BudgetRow::verdict).brief(),
    ];
    Table::new(columns, &study.budget)
}

/// The table of how many triangles each shading drew.
fn shares(study: &Study) -> Table {
    let columns = [
        Column::text("budget, shades", |row| asked(row.max_error)),
        Column::text("triangles of all frames", shared_out),
    ];
    let rows: Vec<BudgetRow> = study.budget.iter().filter(|row| !row.triangles.is_empty()).cloned().collect();
    Table::new(columns, &rows)
}

fn shared_out(row: &BudgetRow) -> String {
    // Below 2⁵³.
    let sum = row.triangles.iter().map(|(_, triangles)| *triangles as f64).sum::<f64>();
    let part = |(shading, triangles): &(FaceShading, u64)| {
        format!("{shading} {} ({})", count(triangles), percent(*triangles as f64 / sum))
    };
    row.triangles.iter().map(part).collect::<Vec<_>>().join(" · ")
}
