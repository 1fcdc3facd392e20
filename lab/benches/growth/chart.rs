//! The series as charts: the time for a frame, or for a triangle, against what grows, both logarithmic.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::series::Series;

const SIZE: (u32, u32) = (1200, 420);
const COLORS: [RGBColor; 2] = [RGBColor(0x1f, 0x5f, 0xa8), RGBColor(0xc4, 0x4e, 0x12)];
const INK: RGBColor = RGBColor(0x22, 0x26, 0x2b);
const FAINT: RGBColor = RGBColor(0xdd, 0xe0, 0xe4);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Three charts side by side, as an SVG file.
pub(crate) fn svg(all: &[Series]) -> String {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        if let Err(error) = draw(&root, all).and_then(|()| Ok(root.present()?)) {
            println!("chart: {error}");
        }
    }
    text
}

fn draw(root: &Area<'_>, all: &[Series]) -> Outcome {
    root.fill(&WHITE)?;
    let areas = root.split_evenly((1, 3));
    let titles = [("time for a frame", "faces"), ("time for a triangle", "pixels"), ("time for a frame", "lights")];
    for ((area, series), (time, of)) in areas.iter().zip([&all[..2], &all[2..3], &all[3..]]).zip(titles) {
        panel(area, series, time, of)?;
    }
    Ok(())
}

fn panel(area: &Area<'_>, all: &[Series], time: &str, of: &str) -> Outcome {
    let points = || all.iter().flat_map(Series::points);
    let range = |of: fn((f64, f64)) -> f64| {
        let (least, most) = points().map(of).fold((f64::MAX, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        least / 1.5..most * 1.5
    };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_top(44)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(range(|point| point.0).log_scale(), range(|point| point.1).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(("sans-serif", 13).into_font().color(&INK))
        .x_labels(6)
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|ns| duration(*ns))
        .x_desc(of)
        .y_desc(time)
        .draw()?;
    for (i, (series, color)) in (0..).zip(all.iter().zip(COLORS)) {
        chart.draw_series(LineSeries::new(series.points(), color.stroke_width(2)))?;
        chart.draw_series(series.points().into_iter().map(|at| Circle::new(at, 4, color.filled())))?;
        let exponent = series.exponent(0.0).map_or(String::new(), |e| format!(", exponent {e:.2}"));
        let style = ("sans-serif", 13).into_font().color(&color);
        area.draw_text(&format!("{}{exponent}", series.title), &style, (80, 8 + 16 * i))?;
    }
    Ok(())
}

/// A whole number with its unit, as 10k.
fn short(x: f64) -> String {
    if x >= 1e6 {
        format!("{}M", x / 1e6)
    } else if x >= 1e4 {
        format!("{}k", x / 1e3)
    } else {
        format!("{x}")
    }
}

fn duration(ns: f64) -> String {
    if ns >= 1e6 {
        format!("{} ms", ns / 1e6)
    } else if ns >= 1e3 {
        format!("{} us", ns / 1e3)
    } else {
        format!("{ns} ns")
    }
}
