//! The other choices, and the sources' claims.

use maud::{Markup, html};

use super::figures::{count, ratio, time};
use super::shadings::figures;
use super::table::{self, Table, interval, quartiles};
use crate::cost::{Claim, OptionRow, Study};

/// The choices, grouped by aspect, for the page.
pub(super) fn options(study: &Study) -> Markup {
    html! {
        @if !study.options.is_empty() { section {
            h2 { "The other choices" }
            p { "One choice at a time, everything else as above. Ratios are to the first of each group; errors are against exact Gouraud shading over unrounded vertices." }
            (table(study).html())
        } }
    }
}

/// The choices.
pub(super) fn table(study: &Study) -> Table {
    type Column = table::Column<(bool, OptionRow)>;
    let mut columns = vec![
        Column::text("aspect", |(is_first, row)| if *is_first { row.aspect.name() } else { "" }).brief(),
        Column::text("choice", |(_, row)| row.name.clone()).brief(),
        Column::number("a frame", |(_, row)| time(row.per_frame.median)).brief(),
        Column::number("quartiles", |(_, row)| quartiles(&row.per_frame)),
        Column::number("ratio", |(_, row)| ratio(row.ratio.0)).brief(),
        Column::number("95 % interval", |(_, row)| interval(row.ratio.1)).brief(),
    ];
    columns.extend(figures("largest error", |(_, row): &(_, OptionRow)| row.error));
    columns.push(Column::number("cover errors, pixels", |(_, row)| count(row.cover_errors)).brief());
    let by_aspect = study.options.chunk_by(|a, b| a.aspect == b.aspect);
    let rows = by_aspect.flat_map(|rows| (0..).zip(rows).map(|(i, row)| (i == 0, row.clone())));
    Table::new(columns, &rows.collect::<Vec<_>>())
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
