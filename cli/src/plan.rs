//! `mode13h plan`: what a scene needs, object by object, and why.

use std::ffi::OsString;
use std::time::Duration;

use clap::Args;
use mode13h::plan::{Effect, Plan, Row};
use mode13h::render::{Renderer, Stats};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h_lab::lines::lines;
use serde::Serialize;

use crate::effect_cost::EffectCost;
use crate::failure::Failure;
use crate::options::{Drawing, Moment, ShadingOptions};
use crate::turntable::Pose;
use crate::{input, output};

/// Time from one frame to the next, in seconds: animations have 35 frames a second.
const STEP: f64 = 1.0 / 35.0;

/// Time for measuring all prices together, and the least and most for one.
const TIME: Duration = Duration::from_secs(6);
const TIME_OF_ONE: (Duration, Duration) = (Duration::from_millis(5), Duration::from_millis(100));

#[derive(Args)]
pub(crate) struct Options {
    #[arg(help = input::HELP, long_help = input::long_help())]
    input: OsString,
    /// Measure what each effect costs, or would cost if it were on
    #[arg(long)]
    measure: bool,
    /// Print the plan as JSON
    ///
    /// Identical in every run, except for what --measure adds.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    moment: Moment,
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    shading: ShadingOptions,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { input, json, measure, moment, drawing, shading } = options;
    let kernel = drawing.kernel()?;
    let input = drawing.input(input)?;
    let name = input.name().to_string();
    let mut stage = drawing.stage(input)?;
    let at = moment.of_picture(&stage.scene);
    let frames = [at - STEP, at].map(|seconds| {
        stage.show(seconds, Pose::FIRST);
        stage.scene.clone()
    });

    let (mut renderer, mut vga) = (shading.renderer(drawing, kernel), Vga::new());
    shading.settle(&mut renderer, &frames[1])?;
    let alike = renderer.with_same_settings();
    let mut draw = |scene: &Scene| renderer.draw(scene, &mut vga).map_err(Failure::from);
    draw(&frames[0])?;
    let stats = draw(&frames[1])?;
    let rows = renderer.rows(&frames[1]);

    let effects = rows.len().max(1);
    let of_one = (TIME / u32::try_from(effects).unwrap_or(u32::MAX)).clamp(TIME_OF_ONE.0, TIME_OF_ONE.1);
    let meter = EffectCost { renderer: || alike.with_same_settings(), frames: &frames, time: of_one };
    let prices = if *measure { Some(prices(&meter, &rows)?) } else { None };
    if *json {
        return output::print_json(&as_json(&name, renderer.plan().near_needed(), &rows, prices.as_deref()));
    }
    let plan = renderer.plan();
    let head = Head { name: &name, at, plan, stats: &stats, planning: meter.plan()? };
    let frame = if *measure { Some(meter.frame()?) } else { None };
    output::print(&(head.text(&rows, frame) + &tables(&rows, prices.as_deref())))
}

/// The price of each row, in nanoseconds a frame.
fn prices<Make: Fn() -> Renderer>(meter: &EffectCost<'_, Make>, rows: &[Row]) -> Result<Vec<Option<u64>>, Failure> {
    let bar = output::bar(rows.len() as u64, "{bar:40} {pos}/{len} effects measured");
    let mut prices: Vec<Option<u64>> = Vec::with_capacity(rows.len());
    for row in rows {
        // Effects that apply to all objects are measured once.
        let of_all = matches!(row.effect, Effect::HiddenSurfaces | Effect::PaletteAnimation);
        let measured = rows.iter().zip(&prices).find(|(other, _)| of_all && other.effect == row.effect);
        prices.push(match measured {
            Some((_, price)) => *price,
            None => meter.price(row.index, row.effect, row.on)?,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(prices)
}

#[derive(Serialize)]
struct Json<'a> {
    schema: u32,
    input: &'a str,
    /// The smallest near distance at which depths are precise enough, if the camera's is smaller still.
    near_needed: Option<f32>,
    objects: Vec<JsonObject<'a>>,
}

#[derive(Serialize)]
struct JsonObject<'a> {
    object: &'a str,
    effects: Vec<JsonEffect<'a>>,
}

#[derive(Serialize)]
struct JsonEffect<'a> {
    effect: &'static str,
    on: bool,
    choice: &'static str,
    reason: &'a str,
    /// The price, only if asked for; then null if it cannot be measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    ns_per_frame: Option<Option<u64>>,
}

fn as_json<'a>(
    name: &'a str,
    near_needed: Option<f32>,
    rows: &'a [Row],
    prices: Option<&'a [Option<u64>]>,
) -> Json<'a> {
    let objects = rows.chunk_by(|a, b| a.index == b.index).scan(0, |first, rows| {
        let prices = prices.map(|prices| &prices[*first..][..rows.len()]);
        *first += rows.len();
        let effects = rows.iter().enumerate().map(|(i, row)| JsonEffect {
            effect: row.effect.name(),
            on: row.on,
            choice: row.choice,
            reason: &row.reason,
            ns_per_frame: prices.map(|prices| prices[i]),
        });
        Some(JsonObject { object: &rows[0].object, effects: effects.collect() })
    });
    Json { schema: output::SCHEMA, input: name, near_needed, objects: objects.collect() }
}

/// Facts about all objects.
struct Head<'a> {
    name: &'a str,
    at: f64,
    plan: &'a Plan,
    stats: &'a Stats,
    /// Time of making the plan, in nanoseconds.
    planning: f64,
}

impl Head<'_> {
    fn text(&self, rows: &[Row], frame: Option<f64>) -> String {
        let Head { name, at, plan, stats, planning } = self;
        let objects = plan.objects().len();
        let of = if objects == 1 { "1 object".to_string() } else { format!("{objects} objects") };
        let mut text = format!("{name} at {at} s, 1/35 s after the frame before it: {of}\n");
        let hidden = rows.iter().find(|row| row.effect == Effect::HiddenSurfaces);
        let reason = hidden.map(|row| format!(" ({})", row.reason)).unwrap_or_default();
        let Stats { shading, vertex_path, kernel, hidden_surfaces, .. } = stats;
        let mut paragraph = |line: &str| text.push_str(&wrapped(line, 0, WIDTH));
        let shading = match stats.max_error {
            Some(shades) => format!("within {shades} shades"),
            None => shading.to_string(),
        };
        paragraph(&format!(
            "all: {shading}, {vertex_path} vertices, kernel {kernel}, hidden surfaces by {hidden_surfaces}{reason}"
        ));
        if !stats.redrawn {
            paragraph("nothing changed since the previous frame, so this one is not redrawn");
        }
        if let Some(near) = plan.near_needed() {
            paragraph(&near_warning(near));
        }
        let each = if objects > 1 { format!(", {:.0} ns/object", planning / objects as f64) } else { String::new() };
        paragraph(&format!("making the plan takes {planning:.0} ns{each} (median)"));
        if let Some(frame) = frame {
            paragraph(&format!("drawing the frame takes {frame:.0} ns, redrawn even if nothing changed"));
            paragraph(
                "ns: how much longer the frame takes with the effect on this object alone; in brackets, what an effect \
                 that is off would cost; 0: lost in the noise. Hidden surfaces and palette animation are measured \
                 for all objects together",
            );
        }
        text
    }
}

/// The warning about a camera whose near distance is too small for depths. Three digits, rounded up, are enough.
fn near_warning(needed: f32) -> String {
    let needed = f64::from(needed);
    let unit = 10_f64.powf(needed.log10().floor() - 2.0);
    format!(
        "the near distance is less than a millionth of the farthest one: depths are too coarse in the distance, and the \
         error budget does not hold there; set it to at least {:.2e}",
        (needed / unit).ceil() * unit
    )
}

/// Columns of text.
const WIDTH: usize = 100;

/// Objects that share a table, by name, and its contents: decisions, each with its text.
type Group<'a> = (Vec<String>, Vec<(&'a Row, String)>);

/// A table for each object. If there are several and nothing was measured, rows common to all come first, and objects
/// whose other rows are equal share a table.
fn tables(rows: &[Row], prices: Option<&[Option<u64>]>) -> String {
    let priced: Vec<(&Row, String)> = rows
        .iter()
        .enumerate()
        .map(|(i, row)| match prices.map(|prices| prices[i]) {
            Some(Some(price)) if row.on => (row, price.to_string()),
            Some(Some(price)) => (row, format!("({price})")),
            Some(None) => (row, "-".to_string()),
            None => (row, String::new()),
        })
        .collect();
    let widest = |of: &dyn Fn(&(&Row, String)) -> usize| priced.iter().map(of).max().unwrap_or_default();
    let widths = [
        widest(&|(row, _)| row.effect.name().len()),
        widest(&|(row, _)| row.choice.len()),
        widest(&|(_, price)| price.len()),
    ];
    let objects: Vec<&[(&Row, String)]> = priced.chunk_by(|(a, _), (b, _)| a.index == b.index).collect();
    let said = |row: &Row| (row.effect, row.on, row.choice, row.reason.clone());
    let common: Vec<(&Row, String)> = match objects.as_slice() {
        [first, rest @ ..] if !rest.is_empty() && prices.is_none() => {
            let same =
                |(row, _): &&(&Row, String)| rest.iter().all(|of| of.iter().any(|(other, _)| said(row) == said(other)));
            first.iter().filter(same).cloned().collect()
        }
        _ => Vec::new(),
    };
    let mut text = String::new();
    if !common.is_empty() {
        text += &table("all objects", &common, widths);
    }
    // Several objects may have the same name.
    let heading = |row: &Row| match objects.iter().filter(|object| object[0].0.object == row.object).count() {
        1 => row.object.clone(),
        _ => format!("{} (object {})", row.object, row.index),
    };
    let is_common = |row: &Row| common.iter().any(|(other, _)| row.effect == other.effect);
    let mut groups: Vec<Group<'_>> = Vec::new();
    for object in &objects {
        let rest: Vec<(&Row, String)> = object.iter().filter(|(row, _)| !is_common(row)).cloned().collect();
        let name = heading(object[0].0);
        let same =
            |of: &[(&Row, String)]| of.iter().map(|(row, _)| said(row)).eq(rest.iter().map(|(row, _)| said(row)));
        match groups.iter_mut().find(|(_, of)| prices.is_none() && same(of)) {
            Some((names, _)) => names.push(name),
            None => groups.push((vec![name], rest)),
        }
    }
    for (names, rows) in groups.iter().filter(|(_, rows)| !rows.is_empty()) {
        text += &table(&names.join(", "), rows, widths);
    }
    text
}

/// A table whose columns, except the last, have these widths.
fn table(heading: &str, rows: &[(&Row, String)], [effect, choice, price]: [usize; 3]) -> String {
    let columns = |name: &str, on: &str, of: &str, ns: &str| {
        let mut line = format!("  {name:effect$}  {on:3}");
        if choice > 0 {
            line += &format!("  {of:choice$}");
        }
        if price > 0 {
            line += &format!("  {ns:>price$}");
        }
        line + "  "
    };
    let mut text = format!("\n{}", wrapped(heading, 0, WIDTH));
    for (row, price) in rows {
        let columns = columns(row.effect.name(), if row.on { "on" } else { "off" }, row.choice, price);
        text += &columns;
        text += &wrapped(&row.reason, columns.chars().count(), WIDTH);
    }
    text
}

/// Wraps words into lines that end before `width`. All begin at `indent`; the first follows the text already there.
fn wrapped(words: &str, indent: usize, width: usize) -> String {
    lines(words, width - indent).join(&format!("\n{}", " ".repeat(indent))) + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_wrapped_where_their_column_begins() {
        assert_eq!(wrapped("one two three", 0, 100), "one two three\n");
        assert_eq!(wrapped("one two three", 0, 7), "one two\nthree\n");
        assert_eq!(wrapped("one two three", 2, 9), "one two\n  three\n");
        assert_eq!(wrapped("unbreakable one", 0, 4), "unbreakable\none\n");
        assert_eq!(wrapped("", 5, 9), "\n");
    }
}
