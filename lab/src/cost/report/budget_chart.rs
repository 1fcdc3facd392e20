//! Time against budget.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::chart::{Area, BETTER, BUDGETS, FAINT, INK, IntoPair, LETTERS, SHADINGS, along, name, range, svg, ticks};
use super::figures::{name_of, time_tick};
use super::labels::{Rectangle, places};
use crate::cost::Study;

/// The time for a frame against the accepted error, both logarithmic, as an SVG file of 860 × 400 pixels on white: the
/// budget, and beside it the cheapest single shading that keeps the same promise, where one does.
#[must_use]
pub fn budget_svg(study: &Study) -> String {
    svg((860, 400), |root| draw(study, root))
}

fn draw(study: &Study, root: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
    root.fill(&WHITE)?;
    let is_shown = |&(error, time): &(f64, f64)| error > 0.0 && error.is_finite() && time > 0.0 && time.is_finite();
    let budgets = study.budget.iter().map(|row| (row.max_error, row.per_frame.median));
    let budgets: Vec<(f64, f64)> = budgets.filter(is_shown).collect();
    let single = |row: &crate::cost::BudgetRow| {
        let at = (row.max_error, row.best_single?.median);
        is_shown(&at).then_some((at, name_of(row.best_single_shading?)))
    };
    let singles: Vec<((f64, f64), String)> = study.budget.iter().filter_map(single).collect();
    let across = range(budgets.iter().map(|at| at.0));
    let down = range(budgets.iter().map(|at| at.1).chain(singles.iter().map(|(at, _)| at.1)));
    let bounds: Vec<f64> = budgets.iter().map(|at| at.0).collect();
    let x = (across.0..across.1).log_scale().with_key_points(bounds);
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
        .x_label_formatter(&|bound| format!("{bound}"))
        .y_label_formatter(&|ns| time_tick(*ns))
        .x_desc(format!("budget: accepted error in shades of 1/255 (logarithmic); {BETTER}"))
        .y_desc("time for a frame (logarithmic)")
        .draw()?;
    chart.draw_series(LineSeries::new(budgets.iter().copied(), BUDGETS.stroke_width(2)))?;
    chart.draw_series(singles.iter().map(|(at, _)| Circle::new(*at, 5, SHADINGS.filled())))?;
    chart.draw_series(budgets.iter().map(|at| TriangleMarker::new(*at, 6, BUDGETS.filled())))?;

    let area = chart.plotting_area();
    let (left, right) = area.get_x_axis_pixel_range().into_pair();
    let (top, bottom) = area.get_y_axis_pixel_range().into_pair();
    let inner = Rectangle { left: left + 4, top: top + 2, right: right - 2, bottom: bottom - 4 };
    let named = singles.iter().map(|(at, text)| (area.map_coordinate(at), text.chars().count()));
    let named: Vec<((i32, i32), usize)> = named.collect();
    let line: Vec<(i32, i32)> = budgets.iter().map(|at| area.map_coordinate(at)).collect();
    let marks: Vec<(i32, i32)> = line.iter().copied().chain(named.iter().map(|&(at, _)| at)).collect();
    for (((_, text), &(at, _)), place) in
        singles.iter().zip(&named).zip(places(&named, &marks, &along(&line), LETTERS, inner))
    {
        name(root, text, at, place, SHADINGS)?;
    }

    let style = ("sans-serif", LETTERS).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    root.draw(&TriangleMarker::new((98, 18), 6, BUDGETS.filled()))?;
    root.draw(&Text::new("budget, face by face", (112, 18), style.clone()))?;
    root.draw(&Circle::new((280, 18), 5, SHADINGS.filled()))?;
    Ok(root.draw(&Text::new("cheapest single shading that keeps the same promise", (294, 18), style))?)
}
