//! Faults in coverage: which pixels a triangle owns.

use super::{centre, paint, side, wrapped};
use crate::hard_cases::face::{Corner, gouraud};
use crate::hard_cases::panel::Panel;

/// No fill rule: every pixel whose centre is inside **or on any edge**. All three edges of a triangle without area lie
/// on the same line.
pub(in crate::hard_cases) fn no_fill_rule(panel: &mut Panel, corners: &[Corner; 3]) {
    let [a, b, c] = *corners;
    let area = side(a, b, (c.x, c.y));
    let bounds = |of: fn(&Corner) -> f64| {
        corners.iter().fold((f64::MAX, f64::MIN), |(low, high), corner| (low.min(of(corner)), high.max(of(corner))))
    };
    let ((left, right), (top, bottom)) = (bounds(|c| c.x), bounds(|c| c.y));
    for y in 0..panel.height() as i32 {
        for x in 0..panel.width() as i32 {
            let p = centre(x, y);
            let doubled = [side(b, c, p), side(c, a, p), side(a, b, p)];
            let inside = doubled.iter().all(|d| *d >= 0.0) || doubled.iter().all(|d| *d <= 0.0);
            if inside && (left..=right).contains(&p.0) && (top..=bottom).contains(&p.1) {
                let shade = match area {
                    0.0 => a.shade,
                    _ => (doubled[0] * a.shade + doubled[1] * b.shade + doubled[2] * c.shade) / area,
                };
                panel.write(x, y, wrapped(shade));
            }
        }
    }
}

/// Every pixel that a span touches, from the one that contains its left end to the one that contains its right end, and
/// every row that the triangle touches: at least one pixel, however small the triangle.
pub(in crate::hard_cases) fn every_pixel_touched(panel: &mut Panel, corners: &[Corner; 3]) {
    let rows = corners.iter().fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c.y), high.max(c.y)));
    for y in rows.0.floor() as i32..=rows.1.floor() as i32 {
        // The part of the triangle within the row, from each edge's two ends clipped to the row.
        let (mut left, mut right) = (f64::MAX, f64::MIN);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
            let (low, high) = (a.y.min(b.y).max(f64::from(y)), a.y.max(b.y).min(f64::from(y) + 1.0));
            if low > high {
                continue;
            }
            for cut in [low, high] {
                let x = if a.y == b.y { a.x } else { a.x + (b.x - a.x) * (cut - a.y) / (b.y - a.y) };
                (left, right) = (left.min(x), right.max(x));
            }
        }
        for x in left.floor() as i32..=right.floor() as i32 {
            panel.write(x, y, wrapped(corners[0].shade));
        }
    }
}

/// One row of the Hungarian tutorial's table: where two edges cross it, and the shades there.
#[derive(Clone, Copy, Default)]
struct TableRow {
    ends: [(i32, i32); 2],
    count: usize,
}

/// Fraction of a pixel that a row's slope is truncated to. In 8.8 the fault shows only after a few hundred rows, and a
/// picture has about thirty.
const SLOPE: f64 = 16.0;

/// The Hungarian tutorial's table with truncated slopes: every edge is walked from its first corner to its second with
/// one addition per row, so the slope's error is added every row too. A neighbour walks the same edge in the other
/// direction and ends up at other positions.
pub(in crate::hard_cases) fn cut_slopes(panel: &mut Panel, corners: &[Corner; 3]) {
    let mut table = vec![TableRow::default(); panel.height()];
    let first_centre = |coordinate: f64| (coordinate - 0.5).ceil() as i32;
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
        let (first, end) = (first_centre(a.y.min(b.y)), first_centre(a.y.max(b.y)));
        let mut rows: Vec<i32> = (first..end).collect();
        if a.y > b.y {
            rows.reverse();
        }
        let Some(&begin) = rows.first() else { continue };
        // Truncates toward zero, in 1/256 pixel. Shades are in 8.8.
        let slope = |from: f64, to: f64, parts: f64| ((to - from) / (b.y - a.y) * parts).trunc() / parts * 256.0;
        let (dx, ds) = (slope(a.x, b.x, SLOPE) as i32, slope(a.shade, b.shade, 256.0) as i32);
        let ahead = f64::from(begin) + 0.5 - a.y;
        let start = |from: f64, step: i32| (from * 256.0 + ahead * f64::from(step)).floor() as i32;
        let (mut x, mut shade) = (start(a.x, dx), start(a.shade, ds));
        let sign = if a.y > b.y { -1 } else { 1 };
        for row in rows {
            if let Some(row) = usize::try_from(row).ok().and_then(|row| table.get_mut(row))
                && let Some(end) = row.ends.get_mut(row.count)
            {
                *end = (x, shade);
                row.count += 1;
            }
            (x, shade) = (x + sign * dx, shade + sign * ds);
        }
    }
    for (y, row) in table.iter().enumerate().filter(|(_, row)| row.count == 2) {
        let (left, right) = (row.ends[0].min(row.ends[1]), row.ends[0].max(row.ends[1]));
        let step = (right.1 - left.1) * 256 / (right.0 - left.0).max(1);
        // ceil(x − ½), in 1/256 pixel.
        for x in (left.0 + 127) >> 8..(right.0 + 127) >> 8 {
            let shade = left.1 + (step * (x * 256 + 128 - left.0)) / 256;
            panel.write(x, y as i32, ((shade + 128) >> 8) as u8);
        }
    }
}

/// Each edge is a line x = m·y + b from the frame's own corner with m truncated, so the error grows down the frame.
pub(in crate::hard_cases) fn lines_from_the_corner(panel: &mut Panel, corners: &[Corner; 3]) {
    for y in 0..panel.height() as i32 {
        let yc = f64::from(y) + 0.5;
        let mut ends = Vec::new();
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
            if a.y.min(b.y) <= yc && yc < a.y.max(b.y) {
                let slope = (b.x - a.x) / (b.y - a.y);
                let m = (slope * SLOPE).trunc() / SLOPE;
                let at_top = ((a.x - slope * a.y) * 256.0).floor() / 256.0;
                ends.push(at_top + m * yc);
            }
        }
        if let [a, b] = ends[..] {
            for x in (a.min(b) - 0.5).ceil() as i32..(a.max(b) - 0.5).ceil() as i32 {
                panel.write(x, y, wrapped(corners[0].shade));
            }
        }
    }
}

/// A corner rounded to whole pixels, which is what all five sources do.
pub(in crate::hard_cases) fn on_whole_pixel(corner: Corner) -> Corner {
    Corner { x: (corner.x + 0.5).floor(), y: (corner.y + 0.5).floor(), ..corner }
}

/// Draws in bands by cutting the face itself: where it crosses from one band into the next it gets new corners, rounded
/// to whole pixels.
pub(in crate::hard_cases) fn cut_at_bands(panel: &mut Panel, corners: &[Corner; 3], rows_each: usize) {
    for first in (0..panel.height()).step_by(rows_each) {
        let (top, bottom) = (first as f64, (first + rows_each) as f64);
        let upper = cut(corners, |corner| corner.y - top);
        let polygon = cut(&upper, |corner| bottom - corner.y);
        let polygon: Vec<Corner> = polygon
            .into_iter()
            .map(|corner| if corner.y == top || corner.y == bottom { on_whole_pixel(corner) } else { corner })
            .collect();
        for i in 2..polygon.len() {
            paint(panel, &[gouraud([polygon[0], polygon[i - 1], polygon[i]])]);
        }
    }
}

/// The part of a convex polygon where `distance` is not negative (Sutherland and Hodgman 1974).
fn cut(polygon: &[Corner], distance: impl Fn(&Corner) -> f64) -> Vec<Corner> {
    let mut kept = Vec::new();
    for (i, b) in polygon.iter().enumerate() {
        let a = &polygon[(i + polygon.len() - 1) % polygon.len()];
        let (da, db) = (distance(a), distance(b));
        if (da < 0.0) != (db < 0.0) {
            let between = |from: f64, to: f64| from + (to - from) * da / (da - db);
            // Band boundaries are whole rows, so the cut's y is exact.
            kept.push(Corner {
                x: between(a.x, b.x),
                y: between(a.y, b.y).round(),
                shade: between(a.shade, b.shade),
                ..*a
            });
        }
        if db >= 0.0 {
            kept.push(*b);
        }
    }
    kept
}

/// Whole-pixel coordinates in the 16-bit words of the time, which wrap beyond ±32,768.
pub(in crate::hard_cases) fn words_of_16_bits(corners: &[Corner; 3]) -> [Corner; 3] {
    let word = |pixels: f64| f64::from((pixels + 0.5).floor() as i64 as i16);
    corners.map(|corner| Corner { x: word(corner.x), y: word(corner.y), ..corner })
}
