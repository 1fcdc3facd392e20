//! Times per frame, and the errors that they allow.

use maud::{Markup, html};

use super::figures::{asked, count, percent, shades, time};
use super::table::{self, Table};
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
    type Column = table::Column<TimeRow>;
    let columns = [
        Column::text("time given", |row| time(row.max_time)).brief(),
        Column::number("a frame took", |row| time(row.mean_time)).brief(),
        Column::number("frames", |row| count(row.frames)).brief(),
        Column::number("within 1.05 times it", |row| percent(row.within)).brief(),
        Column::number("accepted error, mean", |row| shades(row.mean_error)).brief(),
        Column::number("greatest", |row| shades(row.max_error)).brief(),
        Column::number("least budget that fits", |row| row.least_that_fits.map_or("none".into(), asked)).brief(),
        Column::number("largest error", |row| shades(row.largest)).brief(),
    ];
    Table::new(columns, &study.times).note("Least budget that fits: judging by the times of the budgets above.")
}
