//! Times per frame, and the errors that they allow.

use maud::{Markup, html};

use super::figures::{asked, count, percent, shades, time};
use super::table::{Column, Table};
use crate::cost::{Study, TimeRow};

/// The table and its chart, for the page.
pub(super) fn section(study: &Study, chart: impl FnOnce() -> Markup) -> Markup {
    html! {
        @if !study.times.is_empty() { section {
            h2 { "The time for a frame" }
            p {
                "Given the time for a frame, each frame is drawn with the smallest error that fits, judging by the frames before it. "
                "The frames of the study are repeated over and over; those that try out every error are left out."
            }
            (chart())
            (table(study).html())
        } }
    }
}

/// The table of results for each time.
pub(super) fn table(study: &Study) -> Table {
    let columns = [
        Column::text("time given").brief(),
        Column::number("a frame took").brief(),
        Column::number("frames").brief(),
        Column::number("within 1.05 times it").brief(),
        Column::number("accepted error, mean").brief(),
        Column::number("greatest").brief(),
        Column::number("least budget that fits").brief(),
        Column::number("largest error").brief(),
    ];
    let row = |row: &TimeRow| {
        let fits = row.least_that_fits.map_or("none".to_string(), asked);
        let cells = [
            time(row.max_time),
            time(row.mean_time),
            count(row.frames),
            percent(row.within),
            shades(row.mean_error),
            shades(row.max_error),
            fits,
            shades(row.largest),
        ];
        cells.map(Into::into).to_vec()
    };
    Table::new(&columns, study.times.iter().map(row).collect())
        .note("Least budget that fits: judging by the times of the budgets above.")
}
