//! Error against a time that is given.

use plotters::prelude::*;

use super::chart::{Area, BETTER, BUDGETS, FAINT, INK, IntoPair, LETTERS, along, name, range, svg, ticks};
use super::figures::{asked, time_tick};
use super::labels::{Rectangle, places};
use crate::cost::Study;

/// The largest error against the time that was given for a frame, both logarithmic, as an SVG file of 860 × 400 pixels on
/// white.
#[must_use]
pub fn time_svg(study: &Study) -> String {
    svg((860, 400), |root| draw(study, root))
}

fn draw(study: &Study, root: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
    root.fill(&WHITE)?;
    let is_shown = |&(time, error): &(f64, f64)| time > 0.0 && time.is_finite() && error > 0.0 && error.is_finite();
    let points: Vec<(f64, f64)> = study.times.iter().map(|row| (row.max_time, row.largest)).filter(is_shown).collect();
    let (across, down) = (range(points.iter().map(|at| at.0)), range(points.iter().map(|at| at.1)));
    let x = (across.0..across.1).log_scale().with_key_points(ticks(across));
    let y = (down.0..down.1).log_scale().with_key_points(ticks(down));
    let mut chart = ChartBuilder::on(root)
        .margin(14)
        .margin_top(34)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(("sans-serif", LETTERS).into_font().color(&INK))
        .x_label_formatter(&|ns| time_tick(*ns))
        .y_label_formatter(&|error| asked(*error))
        .x_desc(format!("time that is given for a frame (logarithmic); {BETTER}"))
        .y_desc("largest error against lit, in shades of 1/255 (logarithmic)")
        .draw()?;
    chart.draw_series(LineSeries::new(points.iter().copied(), BUDGETS.stroke_width(2)))?;
    chart.draw_series(points.iter().map(|at| TriangleMarker::new(*at, 6, BUDGETS.filled())))?;

    let area = chart.plotting_area();
    let (left, right) = area.get_x_axis_pixel_range().into_pair();
    let (top, bottom) = area.get_y_axis_pixel_range().into_pair();
    let inner = Rectangle { left: left + 4, top: top + 2, right: right - 2, bottom: bottom - 4 };
    let words: Vec<String> = points.iter().map(|at| asked((100.0 * at.1).round() / 100.0)).collect();
    let marks: Vec<(i32, i32)> = points.iter().map(|at| area.map_coordinate(at)).collect();
    let named: Vec<((i32, i32), usize)> =
        marks.iter().zip(&words).map(|(at, text)| (*at, text.chars().count())).collect();
    for ((text, &(at, _)), place) in
        words.iter().zip(&named).zip(places(&named, &marks, &along(&marks), LETTERS, inner))
    {
        name(root, text, at, place, BUDGETS)?;
    }
    Ok(())
}
