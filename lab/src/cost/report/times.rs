//! The times for a frame: the errors that they allow.

use maud::{Markup, html};

use super::figures::{count, percent, shades, time};
use crate::cost::{Study, TimeRow};

/// The table and its chart.
pub(super) fn section(study: &Study, chart: impl FnOnce() -> Markup) -> Markup {
    html! {
        @if !study.times.is_empty() { section {
            h2 { "The time for a frame" }
            p {
                "Given the time for a frame, each frame is drawn within the least error that fits, by the times of the frames before it. "
                "The frames of the study follow each other round and round; those in which every error is tried are left out."
            }
            (chart())
            div.wide { table {
                thead { tr {
                    th { "time" } th { "frames" } th { "within 1.05 times it" } th { "accepted error, mean" } th { "greatest" } th { "largest error" }
                } }
                tbody { @for row in &study.times { (line(row)) } }
            } }
        } }
    }
}

fn line(row: &TimeRow) -> Markup {
    html! { tr {
        th scope="row" { (time(row.max_time)) }
        td { (count(row.frames)) } td { (percent(row.within)) } td { (shades(row.mean_error)) } td { (shades(row.max_error)) } td { (shades(row.largest)) }
    } }
}
