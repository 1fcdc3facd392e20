//! The other choices, and the sources' claims.

use maud::{Markup, html};

use super::figures::{count, ratio, time};
use super::shadings::figures;
use super::table::{Cell, Column, Table, interval, quartiles};
use crate::cost::{Claim, Study};

/// The choices, grouped by aspect, for the page.
pub(super) fn options(study: &Study) -> Markup {
    html! {
        @if !study.options.is_empty() { section {
            h2 { "What else may be chosen" }
            p { "One choice at a time, everything else at its default. Ratios are to the first of each group; errors are against exact Gouraud shading over unrounded vertices." }
            (table(study).html())
        } }
    }
}

/// The choices.
pub(super) fn table(study: &Study) -> Table {
    let columns = [
        Column::text("aspect").brief(),
        Column::text("choice").brief(),
        Column::number("a frame").brief(),
        Column::number("quartiles"),
        Column::number("ratio").brief(),
        Column::number("95 % interval").brief(),
        Column::number("largest error").brief(),
        Column::number("mean"),
        Column::number("r.m.s.").brief(),
        Column::number("r.m.s. of 4 × 4"),
        Column::number("off by ≥ 1"),
        Column::number("cover errors, pixels").brief(),
    ];
    let mut rows = Vec::new();
    for (i, row) in study.options.iter().enumerate() {
        let is_first = i == 0 || study.options[i - 1].aspect != row.aspect;
        let mut cells: Vec<Cell> = vec![
            (if is_first { row.aspect.name() } else { "" }).into(),
            row.name.as_str().into(),
            time(row.per_frame.median).into(),
            quartiles(&row.per_frame),
            ratio(row.ratio.0).into(),
            interval(row.ratio.1),
        ];
        cells.extend(figures(&row.error));
        cells.push(count(row.cover_errors).into());
        rows.push(cells);
    }
    Table::new(&columns, rows)
}

/// The claims, each with what was measured, for the page.
pub(super) fn claims(study: &Study) -> Markup {
    html! {
        @if !study.claims.is_empty() { section {
            h2 { "What the sources claim" }
            div.wide { table.prose {
                thead { tr { th.text { "claim" } th.text { "measured here" } th.text { "verdict" } } }
                tbody { @for Claim { claim, measured, verdict } in &study.claims { tr {
                    td.text { (claim) } td.text { (measured) } td.text { (verdict.name()) }
                } } }
            } }
        } }
    }
}
