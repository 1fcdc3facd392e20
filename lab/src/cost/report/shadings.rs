//! The shadings: times, errors, pictures.

use maud::{Markup, html};

use super::figures::{at_most, count, list, name_of, percent, ratio, shades, three_digits, time};
use super::pictures;
use super::table::{self, Cell, Table, interval, quartiles};
use crate::cost::error_levels::{ALL as LEVELS, NOT_TAKEN};
use crate::cost::{Errors, ShadingRow, Split, Study, ties};
use mode13h::settings::Shading;

type Column = table::Column<ShadingRow>;

/// A part of a frame's time: its name, its CSS class, and the field it shows.
type Part = (&'static str, &'static str, fn(&Split) -> f64);

const PARTS: [Part; 5] = [
    ("plan", "s0", |split| split.plan),
    ("vertices", "s1", |split| split.vertices),
    ("set-up", "s2", |split| split.setup),
    ("spans", "s3", |split| split.spans),
    ("scan-out", "s4", |split| split.scan_out),
];

/// Times and errors of every shading, for the page.
pub(super) fn tables(study: &Study) -> Markup {
    html! {
        section {
            h2 { "The shadings" }
            @if study.shadings.is_empty() { p { "No shading was measured." } } @else {
                h3 { "Time" }
                (times(study).html())
                p.key {
                    @for (name, class, _) in PARTS { span { i.swatch.(class) {} " " (name) } }
                    span { "A frame’s time excludes scan-out to the screen’s colours; the bars show it." }
                }
                (ties_list(study))
                h3 { "Error, in shades" }
                (errors(study).html())
            }
        }
    }
}

/// The times.
pub(super) fn times(study: &Study) -> Table {
    let columns = [
        Column::text("shading", |row| name(row, true)).brief(),
        Column::number("a frame", |row| time(row.per_frame.median)).brief(),
        Column::number("quartiles", |row| quartiles(&row.per_frame)),
        Column::number("a pixel", |row| format!("{} ns", three_digits(row.per_pixel))),
        Column::number("a triangle", |row| time(row.per_triangle)),
        Column::number("ratio to gouraud-8.8", |row| ratio(row.ratio)).brief(),
        Column::number("95 % interval", |row| interval(row.ratio_interval)).brief(),
        Column::number("instructions a frame", |row| row.instructions.map_or(String::new(), count)).brief(),
        Column::text("where it goes", |row| bar(&row.split)),
    ];
    Table::new(columns, &study.shadings)
        .note("★ efficient: no shading is as near to lit (root mean square) and faster, as far as the times show.")
}

/// A shading's name, marked if it is the default and, if asked for, if it is efficient.
fn name(row: &ShadingRow, marks_efficient: bool) -> Cell {
    let star = if marks_efficient && row.efficient { " ★" } else { "" };
    let default = if row.shading == Shading::default() { " (default)" } else { "" };
    let shown = html! { (row.shading) span.mark { (star) } span.default { (default) } };
    Cell::shown(format!("{}{star}{default}", row.shading), shown)
}

/// The parts of the time as a stacked bar.
fn bar(split: &Split) -> Cell {
    let parts = PARTS.map(|(name, class, of)| (name, class, of(split)));
    let sum: f64 = parts.iter().map(|(.., ns)| ns).filter(|ns| ns.is_finite() && **ns > 0.0).sum();
    if sum <= 0.0 {
        return "".into();
    }
    let told = parts.map(|(name, _, ns)| format!("{name} {}", time(ns))).join(", ");
    let bar = html! {
        span.bar role="img" title=(told) aria-label=(told) {
            @for (_, class, ns) in parts { @if ns.is_finite() && ns > 0.0 {
                i.(class) style=(format!("width:{:.2}%", ns / sum * 100.0)) {}
            } }
        }
        span.told { (told) }
    };
    Cell::shown(told.clone(), bar)
}

/// The sentence on shadings with no measurable difference in time, and the list of them.
pub(super) fn tied(study: &Study) -> Option<(&'static str, Vec<String>)> {
    let pairs = |(one, others): &(Shading, Vec<Shading>)| {
        let each = if others.len() > 1 { "each of " } else { "" };
        format!("{one} and {each}{}", list(others))
    };
    let tied: Vec<String> = ties(study).iter().map(pairs).collect();
    let says =
        "No measurable difference in time, as the intervals of their ratios contain 1; their order means nothing:";
    (!tied.is_empty()).then_some((says, tied))
}

fn ties_list(study: &Study) -> Markup {
    html! {
        @if let Some((says, tied)) = tied(study) {
            div.warning { p { (says) } ul { @for tied in tied { li { (tied) } } } }
        } @else if study.shadings.len() > 1 {
            p { "All shadings differ measurably in time." }
        }
    }
}

/// The errors.
pub(super) fn errors(study: &Study) -> Table {
    let mut columns = vec![Column::text("shading", |row| name(row, false)).brief()];
    let gouraud = figures("largest", |row: &ShadingRow| row.error_gouraud);
    columns.extend(gouraud.map(|column| column.under("against gouraud")));
    columns.extend(figures("largest", |row: &ShadingRow| row.error_lit).map(|column| column.under("against lit")));
    columns.extend([
        Column::number("palette adds", |row| shades(row.error_palette)),
        Column::number("swim", |row| shades(row.swim)).brief(),
        Column::number("cover errors", |row| count(row.cover_errors)).brief(),
        Column::number("not compared", |row| percent(row.not_compared)).brief(),
    ]);
    Table::new(columns, &study.shadings)
        .note("Against gouraud: what the arithmetic is off by. Against lit: what the technique is off by.")
        .note("½ is the best that rounding to 256 steps can do.")
        .page_note("R.m.s. of 4 × 4: of the means over blocks, where dither earns its keep.")
        .page_note("Palette adds: what the nearest entry of the scene’s ramp or palette is off by, at most.")
        .note("Swim: how much errors change from one frame to the next over a turn of 0.25°, r.m.s.; the eye sees it as crawling.")
        .note("Cover errors: pixels over all frames that show a different face than they should, with vertices rounded the same way.")
        .note("Not compared: the share of covered pixels that show another face than lit does; no error is taken there.")
}

/// The columns of a row's errors; `largest` is the heading of the first.
pub(super) fn figures<Row: 'static>(largest: &'static str, of: fn(&Row) -> Errors) -> [table::Column<Row>; 5] {
    type Column<Row> = table::Column<Row>;
    [
        Column::number(largest, move |row| shades(of(row).max)).brief(),
        Column::number("mean", move |row| shades(of(row).mean)),
        Column::number("r.m.s.", move |row| shades(of(row).rms)).brief(),
        Column::number("r.m.s. of 4 × 4", move |row| shades(of(row).rms_of_blocks)),
        Column::number("off by ≥ 1", move |row| percent(of(row).off_by_one)),
    ]
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
                strong { (name_of(row.shading)) }
                " off by " (at_most(row.error_lit.max)) " at most over all frames, " (shades(row.error_lit.rms)) " r.m.s.; "
                (time(row.per_frame.median))
            }
        }
    }
}
