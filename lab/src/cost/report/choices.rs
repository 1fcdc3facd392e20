//! Other choices, and the sources' claims.

use maud::{Markup, html};

use super::figures::{count, interval, percent, ratio, shades, time};
use crate::cost::{Study, Verdict};

/// The options, grouped by aspect.
pub(super) fn options(study: &Study) -> Markup {
    html! {
        @if !study.options.is_empty() { section {
            h2 { "What else may be chosen" }
            p { "One choice at a time, all else as by default. Ratios are to the first of each group; errors are against exact Gouraud shading over unrounded vertices." }
            div.wide { table {
                thead { tr {
                    th { "" } th.text { "choice" } th { "a frame" } th { "quartiles" } th { "ratio" } th { "95 % interval" }
                    th { "largest error" } th { "mean" } th { "r.m.s." } th { "r.m.s. of 4 × 4" } th { "off by ≥ 1" } th { "cover errors, pixels" }
                } }
                tbody { @for (i, row) in study.options.iter().enumerate() {
                    @let first = i == 0 || study.options[i - 1].aspect != row.aspect;
                    tr.first[first] {
                        th scope="row" { @if first { (row.aspect) } }
                        td.text { (row.name) }
                        td { (time(row.per_frame.median)) }
                        td.soft { (time(row.per_frame.lower_quartile)) " – " (time(row.per_frame.upper_quartile)) }
                        td { (ratio(row.ratio.0)) } td.soft { (interval(row.ratio.1)) }
                        td { (shades(row.error.max)) } td { (shades(row.error.mean)) } td { (shades(row.error.rms)) }
                        td { (shades(row.error.rms_of_blocks)) } td { (percent(row.error.off_by_one)) } td { (count(row.cover_errors)) }
                    }
                } }
            } }
        } }
    }
}

/// The claims, each with what was measured.
pub(super) fn claims(study: &Study) -> Markup {
    html! {
        @if !study.claims.is_empty() { section {
            h2 { "What the sources claim" }
            div.wide { table.prose {
                thead { tr { th.text { "claim" } th.text { "measured here" } th.text { "verdict" } } }
                tbody { @for claim in &study.claims { tr {
                    td.text { (claim.claim) } td.text { (claim.measured) }
                    td.text { (match claim.verdict {
                        Verdict::Holds => "holds",
                        Verdict::HoldsInPart => "holds in part",
                        Verdict::DoesNotHold => "does not hold",
                    }) }
                } } }
            } }
        } }
    }
}
