//! The shadings: times, errors, pictures.

use maud::{Markup, html};

use super::figures::{at_most, count, interval, list, percent, ratio, shades, three_digits, time};
use super::pictures;
use crate::cost::error_levels::{ALL as LEVELS, NOT_TAKEN};
use crate::cost::{Errors, ShadingRow, Split, Study};
use mode13h::render::Shading;

/// A part of a frame's time: its name, its class in the style, and which it is.
type Part = (&'static str, &'static str, fn(&Split) -> f64);

const PARTS: [Part; 5] = [
    ("plan", "s0", |split| split.plan),
    ("vertices", "s1", |split| split.vertices),
    ("set-up", "s2", |split| split.setup),
    ("spans", "s3", |split| split.spans),
    ("scan-out", "s4", |split| split.scan_out),
];

/// Times and errors of every shading.
pub(super) fn tables(study: &Study) -> Markup {
    html! {
        section {
            h2 { "The shadings" }
            @if study.shadings.is_empty() { p { "No shading was measured." } } @else {
                (times(study))
                (ties(study))
                (errors(study))
            }
        }
    }
}

fn times(study: &Study) -> Markup {
    let counted = study.shadings.iter().any(|row| row.instructions.is_some());
    html! {
        h3 { "Time" }
        div.wide { table {
            thead { tr {
                th { "shading" } th { "a frame" } th { "quartiles" } th { "a pixel" } th { "a triangle" }
                th { "ratio to gouraud-8.8" } th { "95 % interval" }
                @if counted { th { "instructions a frame" } }
                th { "where it goes" }
            } }
            tbody { @for row in &study.shadings { tr {
                th scope="row" { (row.shading) @if row.efficient { " " span.mark title="no shading is both as near to lit and told to be faster" { "★" } } }
                td { (time(row.per_frame.median)) }
                td.soft { (time(row.per_frame.lower_quartile)) " – " (time(row.per_frame.upper_quartile)) }
                td { (three_digits(row.per_pixel)) " ns" }
                td { (time(row.per_triangle)) }
                td { (ratio(row.ratio)) }
                td.soft { (interval(row.ratio_interval)) }
                @if counted { td { (row.instructions.map_or("–".to_string(), count)) } }
                td.bars { (bar(&row.split)) }
            } } }
        } }
        p.key {
            span { span.mark { "★" } " efficient: no shading is as near to lit (root mean square) and faster, as far as times can be told apart" }
            @for (name, class, _) in PARTS { span { i.swatch.(class) {} " " (name) } }
            span { "A frame’s time leaves scan-out to the screen’s colours out; the bars show it." }
        }
    }
}

/// The parts of the time as a stacked bar.
fn bar(split: &Split) -> Markup {
    let parts = PARTS.map(|(name, class, of)| (name, class, of(split)));
    let sum: f64 = parts.iter().map(|(.., ns)| ns).filter(|ns| ns.is_finite() && **ns > 0.0).sum();
    let told = parts.map(|(name, _, ns)| format!("{name} {}", time(ns))).join(", ");
    html! {
        @if sum > 0.0 {
            span.bar role="img" title=(told) aria-label=(told) {
                @for (_, class, ns) in parts { @if ns.is_finite() && ns > 0.0 {
                    i.(class) style=(format!("width:{:.2}%", ns / sum * 100.0)) {}
                } }
            }
            span.told { (told) }
        } @else { "–" }
    }
}

/// Shadings that cannot be told apart, each pair once: with the first of the two in the table.
fn ties(study: &Study) -> Markup {
    let mut tied: Vec<(Shading, Vec<Shading>)> = Vec::new();
    for row in &study.shadings {
        let is_listed =
            |other: &Shading| tied.iter().any(|(first, with)| first == other && with.contains(&row.shading));
        let others: Vec<Shading> = row.as_fast_as.iter().copied().filter(|other| !is_listed(other)).collect();
        if !others.is_empty() {
            tied.push((row.shading, others));
        }
    }
    html! {
        @if !tied.is_empty() {
            div.warning {
                p { strong { "Cannot be told apart by their times" } ", as the intervals of their ratios contain 1; their order means nothing:" }
                ul { @for (shading, others) in &tied { li { (shading) " and " (list(others)) } } }
            }
        } @else if study.shadings.len() > 1 {
            p { "The times of all shadings can be told apart." }
        }
    }
}

fn errors(study: &Study) -> Markup {
    html! {
        h3 { "Error, in shades" }
        div.wide { table {
            thead {
                tr {
                    th rowspan="2" { "shading" }
                    th.group colspan="5" { "against gouraud: the arithmetic" }
                    th.group colspan="5" { "against lit: the technique" }
                    th rowspan="2" { "palette adds" } th rowspan="2" { "swim" } th rowspan="2" { "cover errors, pixels" }
                }
                tr { @for _ in 0..2 { th.group { "largest" } th { "mean" } th { "r.m.s." } th { "r.m.s. of 4 × 4" } th { "off by ≥ 1" } } }
            }
            tbody { @for row in &study.shadings { tr {
                th scope="row" { (row.shading) }
                (figures(&row.error_gouraud))
                (figures(&row.error_lit))
                td { (shades(row.error_palette)) } td { (shades(row.swim)) } td { (count(row.cover_errors)) }
            } } }
        } }
        p.key {
            span { "½ is the best that rounding to 256 steps can do." }
            span { "r.m.s. of 4 × 4: of the means over blocks, where dither earns its keep." }
            span { "Palette adds: what the nearest entry of the scene’s ramp or palette is off by, at most." }
            span { "Swim: how much errors change from a frame to the next over a turn of 0.25°, r.m.s.; the eye sees it as crawling." }
            span { "Cover errors: pixels that show another face than they should, over all frames; in these no error of shade is taken." }
        }
    }
}

fn figures(errors: &Errors) -> Markup {
    html! {
        td.group { (shades(errors.max)) } td { (shades(errors.mean)) } td { (shades(errors.rms)) }
        td { (shades(errors.rms_of_blocks)) } td { (percent(errors.off_by_one)) }
    }
}

/// Every shading's frame, and its error map under it.
pub(super) fn pictures(study: &Study) -> Markup {
    html! {
        @if !study.shadings.is_empty() { section {
            h2 { "Frames and their errors" }
            p { "The first frame, in 256 greys, left of the divider; its error against lit, right of it." }
            p.key {
                @for level in LEVELS { span { (swatch(level.color)) " " (level.label) } }
                span { "shades" }
                span { (swatch(NOT_TAKEN)) " none taken: background, or another face than there should be" }
            }
            div.gallery { @for row in &study.shadings { (pair(row)) } }
        } }
    }
}

fn swatch(color: u32) -> Markup {
    html! { i.swatch style=(format!("background:#{color:06x}")) {} }
}

fn pair(row: &ShadingRow) -> Markup {
    let (frame, map) = (pictures::frame(&row.picture), pictures::error_map(&row.error_map));
    html! {
        figure {
            @match (frame, map) {
                (Some(frame), Some(map)) => {
                    div.pair data-label=(format!("{}: how much of the frame, how much of its error map", row.shading)) {
                        img src=(map) width="320" height="240" alt=(format!("error map of {}", row.shading));
                        img.over src=(frame) width="320" height="240" alt=(format!("frame of {}", row.shading));
                    }
                },
                _ => p.none { "no picture" },
            }
            figcaption {
                strong { (row.shading) }
                " off by " (at_most(row.error_lit.max)) " at most over all frames, " (shades(row.error_lit.rms)) " r.m.s.; "
                (time(row.per_frame.median))
            }
        }
    }
}
