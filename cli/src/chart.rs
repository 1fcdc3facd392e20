//! A row's intensity and its slope as a chart: in an SVG file, or as text.

use std::error::Error;
use std::ops::Range;
use std::path::Path;

use mode13h::export::{ExportError, write_atomically};
use mode13h_lab::explain::{Column, Row};
use plotters::coord::Shift;
use plotters::prelude::*;

/// Curve of a value along a row: its name, its colour, and its height at a pixel.
type Curve = (&'static str, RGBColor, fn(&Column) -> Option<f64>);

/// Curves in drawing order: later ones lie over earlier ones.
const CURVES: [Curve; 3] = [
    ("lit (the model at every pixel)", RGBColor(217, 95, 2), |column| column.lit),
    ("gouraud (linear, exact)", RGBColor(27, 120, 180), |column| column.gouraud),
    ("drawn (dots)", RGBColor(20, 20, 20), |column| column.drawn),
];

/// Writes the chart: the intensity above, its slope below.
pub(crate) fn svg(title: &str, row: &Row, path: &Path) -> Result<(), ExportError> {
    let mut text = String::new();
    let drawn = draw(title, row, SVGBackend::with_string(&mut text, (960, 640)).into_drawing_area());
    write_atomically(path, |out| {
        drawn.map_err(|error| std::io::Error::other(error.to_string()))?;
        out.write_all(text.as_bytes())
    })
}

fn draw(title: &str, row: &Row, area: DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Box<dyn Error>> {
    area.fill(&WHITE)?;
    let area = area.titled(title, ("sans-serif", 20))?;
    let (above, below) = area.split_vertically(350);
    let columns = shown(row);
    let intensity: Vec<Vec<Option<f64>>> =
        CURVES.iter().map(|(_, _, of)| row.columns.iter().map(of).collect()).collect();
    let slopes: Vec<Vec<Option<f64>>> = CURVES.iter().map(|(_, _, of)| row.slope(of)).collect();
    panel(&above, "intensity, shades of 255", &columns, &intensity, false)?;
    panel(&below, "slope, shades per pixel (cut off at steps)", &columns, &slopes, true)?;
    Ok(area.present()?)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    label: &str,
    columns: &Range<usize>,
    curves: &[Vec<Option<f64>>],
    is_lower: bool,
) -> Result<(), Box<dyn Error>> {
    let (low, high) = span(curves, columns, is_lower);
    let (left, right) = (columns.start as f64 - 0.5, columns.end as f64 - 0.5);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(if is_lower { 36 } else { 20 })
        .y_label_area_size(56)
        .build_cartesian_2d(left..right, low..high)?;
    let mut mesh = chart.configure_mesh();
    mesh.y_desc(label).light_line_style(WHITE).bold_line_style(RGBColor(225, 225, 225));
    mesh.x_labels(12)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.4}").trim_end_matches('0').trim_end_matches('.').to_string());
    if is_lower {
        mesh.x_desc("column");
    }
    mesh.draw()?;
    for ((name, color, _), values) in CURVES.iter().zip(curves) {
        // Slopes of drawn bytes jump by halves, so they are faint, behind the true ones.
        let is_drawn = name.starts_with("drawn");
        let style = if is_drawn && is_lower {
            color.mix(0.25).stroke_width(1)
        } else {
            color.stroke_width(if is_drawn { 1 } else { 2 })
        };
        // Points beyond the panel are drawn along its edge.
        let runs = runs(values, columns).into_iter().map(|run| run.into_iter().map(|(x, y)| (x, y.clamp(low, high))));
        let mut is_named = false;
        for run in runs {
            if is_drawn && !is_lower {
                // Each byte is a dot.
                let dots = chart.draw_series(run.map(|at| Circle::new(at, 2, color.filled())))?;
                if !is_named {
                    is_named = true;
                    dots.label(*name).legend(|(x, y)| Circle::new((x + 10, y), 2, color.filled()));
                }
                continue;
            }
            let series = chart.draw_series(LineSeries::new(run, style))?;
            if !is_named {
                is_named = true;
                series.label(*name).legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
            }
        }
    }
    if !is_lower {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerMiddle)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .draw()?;
    }
    Ok(())
}

/// The columns with something in them, and a few more.
fn shown(row: &Row) -> Range<usize> {
    let has = |column: &Column| CURVES.iter().any(|(_, _, of)| of(column).is_some());
    let first = row.columns.iter().position(has);
    let last = row.columns.iter().rposition(has);
    match (first, last) {
        (Some(first), Some(last)) => first.saturating_sub(4)..(last + 5).min(row.columns.len()),
        _ => 0..row.columns.len(),
    }
}

/// Range from the smallest to the largest value, with some margin; 0 to 1 if there is none. Slopes are huge where the
/// intensity itself has a step, so theirs covers the middle 80 % of the values, and as much again on both sides.
fn span(curves: &[Vec<Option<f64>>], columns: &Range<usize>, are_slopes: bool) -> (f64, f64) {
    let mut values: Vec<f64> = curves.iter().flat_map(|curve| &curve[columns.clone()]).copied().flatten().collect();
    values.sort_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (values.first(), values.last()) else { return (0.0, 1.0) };
    if !are_slopes {
        let room = ((high - low) * 0.06).max(0.5);
        return (low - room, high + room);
    }
    let tenth = values.len() / 10;
    let (inner_low, inner_high) = (values[tenth], values[values.len() - 1 - tenth]);
    let room = (inner_high - inner_low).max(0.5);
    (low.max(inner_low - room) - 0.1 * room, high.min(inner_high + room) + 0.1 * room)
}

/// The stretches without a gap.
fn runs(values: &[Option<f64>], columns: &Range<usize>) -> Vec<Vec<(f64, f64)>> {
    let points: Vec<Option<(f64, f64)>> =
        columns.clone().map(|x| values.get(x).copied().flatten().map(|value| (x as f64, value))).collect();
    let runs = points.split(Option::is_none).filter(|run| !run.is_empty());
    runs.map(|run| run.iter().copied().flatten().collect()).collect()
}

/// Characters across, and lines of the two panels.
const ACROSS: usize = 90;
const LINES: [usize; 2] = [15, 9];

/// Draws a row's chart as text. Above, `#` is the drawn intensity, and `o` is `lit` where that differs; below, `=` is
/// the slope of exact `gouraud` and `o` that of `lit`.
pub(crate) fn text(title: &str, row: &Row) -> String {
    let mut text = format!("{title}\n");
    let columns = shown(row);
    if row.columns.iter().all(|column| column.drawn.is_none() && column.lit.is_none()) {
        return text + "nothing but background\n";
    }
    let of = |of: fn(&Column) -> Option<f64>| -> Vec<Option<f64>> { row.columns.iter().map(of).collect() };
    text += "\nintensity in shades of 255: # drawn, o lit at every pixel\n";
    text += &plot(&columns, [('o', of(|c| c.lit)), ('#', of(|c| c.drawn))], LINES[0], false);
    text += "\nslope in shades per pixel, cut off at steps: = linear between the corners, o lit at every pixel\n";
    text += &plot(&columns, [('o', row.slope(|c| c.lit)), ('=', row.slope(|c| c.gouraud))], LINES[1], true);
    text + &bands(row)
}

fn plot(columns: &Range<usize>, curves: [(char, Vec<Option<f64>>); 2], lines: usize, are_slopes: bool) -> String {
    let values = curves.each_ref().map(|(_, values)| values.clone());
    let (low, high) = span(&values, columns, are_slopes);
    let across = columns.len().min(ACROSS);
    let mut grid = vec![vec![' '; across]; lines];
    for (mark, values) in &curves {
        for (i, x) in columns.clone().enumerate() {
            if let Some(value) = values[x].map(|value| value.clamp(low, high)) {
                // Within the grid: from 0 to lines − 1.
                let line = ((high - value) / (high - low) * (lines as f64 - 1.0)).round() as usize;
                grid[line.min(lines - 1)][i * across / columns.len()] = *mark;
            }
        }
    }
    let mut text = String::new();
    for (i, line) in grid.iter().enumerate() {
        let value = high - (high - low) * i as f64 / (lines as f64 - 1.0);
        let label = if i % 2 == 0 { format!("{value:8.2}") } else { " ".repeat(8) };
        text += &format!("{label} |{}", line.iter().collect::<String>());
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    let right = format!("{}", columns.end.saturating_sub(1));
    let gap = across.saturating_sub(columns.start.to_string().len());
    text + &format!("{} +{}\n{}{}{right:>gap$}\n", " ".repeat(8), "-".repeat(across), " ".repeat(10), columns.start)
}

/// Describes the largest jumps in the slope of linear shades from one face to the next.
fn bands(row: &Row) -> String {
    let columns = &row.columns;
    let slope = |a: usize, b: usize| {
        let (a, b) = (columns.get(a)?, columns.get(b)?);
        if a.face == b.face { Some(b.gouraud? - a.gouraud?) } else { None }
    };
    let mut jumps: Vec<(usize, f64, f64)> = (1..columns.len())
        .filter(|&x| columns[x - 1].face != columns[x].face)
        .filter_map(|x| Some((x, slope(x.checked_sub(2)?, x - 1)?, slope(x, x + 1)?)))
        .collect();
    jumps.sort_by(|a, b| (b.2 - b.1).abs().total_cmp(&(a.2 - a.1).abs()));
    jumps.truncate(4);
    jumps.retain(|(_, before, after)| (after - before).abs() > 0.05);
    if jumps.is_empty() {
        return String::new();
    }
    let mut text = String::from("\nMach bands: the eye sees a line where the slope jumps, most clearly at column\n");
    for (x, before, after) in jumps {
        text += &format!("{x:>10}  from {before:+.2} to {after:+.2} shades per pixel\n");
    }
    text
}
