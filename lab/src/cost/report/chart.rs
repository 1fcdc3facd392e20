//! Error against time.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::figures::{asked, name_of, time_tick};
use super::labels::{Rectangle, places};
use crate::cost::{ShadingRow, Study};
use mode13h::settings::Shading;

/// Smaller errors are drawn here: a logarithmic axis has no 0.
const FLOOR: f64 = 0.01;

pub(super) const INK: RGBColor = RGBColor(0x22, 0x26, 0x2b);
pub(super) const FAINT: RGBColor = RGBColor(0xdd, 0xe0, 0xe4);
pub(super) const SHADINGS: RGBColor = RGBColor(0x1f, 0x5f, 0xa8);
pub(super) const BUDGETS: RGBColor = RGBColor(0xc4, 0x4e, 0x12);
const BEATEN: RGBColor = RGBColor(0x8a, 0x90, 0x99);

/// Note on the axes of every chart here.
pub(super) const BETTER: &str = "better: down and left";

/// Height of the letters, in pixels.
pub(super) const LETTERS: i32 = 13;

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Error against time, both logarithmic, as an SVG file of 860 × 520 pixels on white. Each shading is a point of root
/// mean square error against `lit` and time per frame, the efficient ones filled and joined; each budget is one too.
#[must_use]
pub fn chart_svg(study: &Study) -> String {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, (860, 520)).into_drawing_area();
    let drawn = draw(study, &root).and_then(|()| Ok(root.present()?));
    drop(root);
    // Writing to a string cannot fail.
    if drawn.is_ok() { text } else { String::from("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>") }
}

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A point: its position, its name and its mark.
struct Point {
    at: (f64, f64),
    name: String,
    budget: bool,
    efficient: bool,
}

fn draw(study: &Study, root: &Area<'_>) -> Outcome {
    root.fill(&WHITE)?;
    let mut points = points(study);
    let (across, down) = (range(points.iter().map(|p| p.at.0)), range(points.iter().map(|p| p.at.1)));
    let x = (across.0..across.1).log_scale().with_key_points(ticks(across));
    let y = (down.0..down.1).log_scale().with_key_points(ticks(down));
    let mut chart = ChartBuilder::on(root)
        .margin(14)
        .margin_top(34)
        .x_label_area_size(48)
        .y_label_area_size(64)
        .build_cartesian_2d(x, y)?;
    let floored = points.iter().any(|point| point.at.1 <= FLOOR);
    let floor = if floored { format!("; below {FLOOR} drawn at {FLOOR}") } else { String::new() };
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(("sans-serif", LETTERS).into_font().color(&INK))
        .x_label_formatter(&|ns| time_tick(*ns))
        .y_label_formatter(&|error| asked(*error))
        .x_desc(format!("time for a frame (logarithmic); {BETTER}"))
        .y_desc(format!("error against lit, root mean square, in shades of 1/255 (logarithmic{floor})"))
        .draw()?;

    let mut efficient: Vec<(f64, f64)> = points.iter().filter(|p| p.efficient).map(|p| p.at).collect();
    efficient.sort_by(|a, b| a.0.total_cmp(&b.0));
    chart.draw_series(LineSeries::new(efficient.iter().copied(), SHADINGS.stroke_width(2)))?;
    // Shadings are drawn over budgets at the same position.
    for point in points.iter().filter(|p| p.budget).chain(points.iter().filter(|p| !p.budget)) {
        let (at, size) = (point.at, 5);
        let shape = if point.budget {
            TriangleMarker::new(at, size + 4, BUDGETS.filled()).into_dyn()
        } else if point.efficient {
            Circle::new(at, size, SHADINGS.filled()).into_dyn()
        } else {
            Circle::new(at, size - 1, BEATEN.stroke_width(2)).into_dyn()
        };
        chart.draw_series(std::iter::once(shape))?;
    }

    let area = chart.plotting_area();
    let pixel = |at: &(f64, f64)| area.map_coordinate(at);
    let (left, right) = ends(area.get_x_axis_pixel_range());
    let (top, bottom) = ends(area.get_y_axis_pixel_range());
    let inner = Rectangle { left: left + 4, top: top + 2, right: right - 2, bottom: bottom - 4 };
    let marks: Vec<(i32, i32)> = points.iter().map(|point| pixel(&point.at)).collect();
    join_budgets(&mut points, |point| pixel(&point.at));
    let named: Vec<((i32, i32), usize)> = points.iter().map(|p| (pixel(&p.at), p.name.chars().count())).collect();
    let joined: Vec<(i32, i32)> = efficient.iter().map(pixel).collect();
    for ((point, &(at, _)), place) in
        points.iter().zip(&named).zip(places(&named, &marks, &along(&joined), LETTERS, inner))
    {
        let color = if point.budget {
            BUDGETS
        } else if point.efficient {
            SHADINGS
        } else {
            INK
        };
        name(root, &point.name, at, place, color)?;
    }
    key(root, study.budget.is_empty())
}

fn points(study: &Study) -> Vec<Point> {
    let shading = |row: &ShadingRow| Point {
        at: (row.per_frame.median, row.error_lit.rms.max(FLOOR)),
        name: name_of(row.shading),
        budget: false,
        efficient: row.efficient,
    };
    let budgets = study.budget.iter().map(|row| Point {
        at: (row.per_frame.median, row.rms.max(FLOOR)),
        name: asked(row.max_error),
        budget: true,
        efficient: false,
    });
    // Efficient ones first, so that their names get the best positions.
    let mut points: Vec<Point> = study.shadings.iter().map(shading).chain(budgets).collect();
    points.retain(|p| p.at.0.is_finite() && p.at.1.is_finite() && p.at.0 > 0.0);
    points.sort_by_key(|p| (!p.efficient, p.budget));
    points
}

/// A point as `shared/chart.js` takes it: nanoseconds, an error, and its kind and name as JSON.
type JsonPoint = (f64, f64, String);

/// Points as JSON.
fn json(points: impl Iterator<Item = JsonPoint>) -> String {
    let shown = points.filter(|(ns, error, _)| ns.is_finite() && error.is_finite());
    let shown: Vec<String> =
        shown.map(|(ns, error, rest)| format!(r#"{{"ms":{},"error":{error},{rest}}}"#, ns / 1e6)).collect();
    format!("[{}]", shown.join(","))
}

/// A shading's mark. Names of shadings need no escaping.
fn shading_mark(shading: Shading, efficient: bool) -> String {
    format!(r#""kind":"shading","name":"{}","efficient":{efficient}"#, name_of(shading))
}

/// A budget's mark.
fn budget_mark(name: &str, budget: f64) -> String {
    format!(r#""kind":"budget","name":"{name}","budget":{budget}"#)
}

fn budget_name(row: &crate::cost::BudgetRow) -> String {
    format!("≤ {}", asked(row.max_error))
}

/// The points of [`chart_svg`].
pub(super) fn points_json(study: &Study) -> String {
    let shading =
        |row: &ShadingRow| (row.per_frame.median, row.error_lit.rms, shading_mark(row.shading, row.efficient));
    let budget =
        |row: &crate::cost::BudgetRow| (row.per_frame.median, row.rms, budget_mark(&budget_name(row), row.max_error));
    json(study.shadings.iter().map(shading).chain(study.budget.iter().map(budget)))
}

/// The points of the chart in the section on budgets.
pub(super) fn budget_points_json(study: &Study) -> String {
    let budget = |row: &crate::cost::BudgetRow| {
        (row.per_frame.median, row.max_error, budget_mark(&budget_name(row), row.max_error))
    };
    let single = |row: &crate::cost::BudgetRow| {
        Some((row.best_single?.median, row.max_error, shading_mark(row.best_single_shading?, false)))
    };
    json(study.budget.iter().map(budget).chain(study.budget.iter().filter_map(single)))
}

/// The points of the chart in the section on times.
pub(super) fn time_points_json(study: &Study) -> String {
    json(study.times.iter().map(|row| {
        let name = asked((100.0 * row.largest).round() / 100.0);
        (row.max_time, row.largest, budget_mark(&name, row.largest))
    }))
}

/// Budgets whose points cannot be distinguished by eye share one name.
fn join_budgets(points: &mut Vec<Point>, pixel: impl Fn(&Point) -> (i32, i32)) {
    let mut joined: Vec<Point> = Vec::new();
    for point in points.drain(..) {
        let (x, y) = pixel(&point);
        let meets = |other: &&mut Point| {
            let (left, top) = pixel(other);
            other.budget && point.budget && (x - left).abs() <= 8 && (y - top).abs() <= 8
        };
        match joined.iter_mut().find(meets) {
            Some(other) => other.name = format!("{}, {}", other.name, point.name),
            None => joined.push(point),
        }
    }
    for budget in joined.iter_mut().filter(|point| point.budget) {
        budget.name = format!("≤ {}", budget.name);
    }
    *points = joined;
}

/// A range with room for all points, from tick to tick.
pub(super) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if low > high { (0.1, 10.0) } else { (low / 1.4, high * 1.4) }
}

/// 1, 2 and 5 times each power of ten; if there are many powers, the powers alone.
pub(super) fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let steps: &[f64] = if high / low > 1e3 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    // Exponents that f64 can represent.
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let all = (first..=last).flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)));
    all.filter(|tick| (low..=high).contains(tick)).collect()
}

/// Points every few pixels along a line, for names to avoid.
pub(super) fn along(corners: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let between = |ends: &[(i32, i32)]| {
        let (from, to) = (ends[0], ends[1]);
        let steps = ((to.0 - from.0).abs().max((to.1 - from.1).abs()) / 4).max(1);
        (0..=steps).map(move |i| (from.0 + (to.0 - from.0) * i / steps, from.1 + (to.1 - from.1) * i / steps))
    };
    corners.windows(2).flat_map(between).collect()
}

/// A name at its position, with a line to its point if it is far away.
pub(super) fn name(root: &Area<'_>, text: &str, at: (i32, i32), place: Rectangle, color: RGBColor) -> Outcome {
    let middle = (place.top + place.bottom) / 2;
    let near = (at.0.clamp(place.left, place.right), at.1.clamp(place.top + 2, place.bottom - 2));
    let (dx, dy) = (near.0 - at.0, near.1 - at.1);
    if dx * dx + dy * dy > 15 * 15 {
        root.draw(&PathElement::new([at, near], color.mix(0.45).stroke_width(1)))?;
    }
    let (x, side) = if place.left >= at.0 {
        (place.left, HPos::Left)
    } else if place.right <= at.0 {
        (place.right, HPos::Right)
    } else {
        ((place.left + place.right) / 2, HPos::Center)
    };
    let style = ("sans-serif", LETTERS).into_font().color(&color).pos(Pos::new(side, VPos::Center));
    Ok(root.draw(&Text::new(text.to_string(), (x, middle), style))?)
}

/// Key to the marks, above the chart.
fn key(root: &Area<'_>, no_budget: bool) -> Outcome {
    let style = ("sans-serif", LETTERS).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    let y = 18;
    root.draw(&PathElement::new([(80, y), (104, y)], SHADINGS.stroke_width(2)))?;
    root.draw(&Circle::new((92, y), 5, SHADINGS.filled()))?;
    root.draw(&Text::new("efficient shadings: none as accurate is measurably faster", (112, y), style.clone()))?;
    root.draw(&Circle::new((440, y), 4, BEATEN.stroke_width(2)))?;
    root.draw(&Text::new("other shadings", (452, y), style.clone()))?;
    if !no_budget {
        root.draw(&TriangleMarker::new((560, y), 6, BUDGETS.filled()))?;
        root.draw(&Text::new("budgets: largest error accepted, in shades", (572, y), style))?;
    }
    Ok(())
}

/// Both ends of a range of pixels, the lower first.
fn ends(range: std::ops::Range<i32>) -> (i32, i32) {
    (range.start.min(range.end), range.start.max(range.end))
}
