//! Faults in shading: which byte a pixel gets.

use super::{centre, samples, wrapped};
use crate::hard_cases::face::Corner;
use crate::hard_cases::panel::Panel;

/// A row of a triangle: where its edges cross the row's centre, and the shades there.
#[derive(Clone, Copy)]
struct Row {
    left: (f64, f64),
    right: (f64, f64),
}

/// Finds where a convex polygon's edges cross the centre of row `y`; `None` if they do not.
fn row(corners: &[Corner], y: i32) -> Option<Row> {
    let yc = f64::from(y) + 0.5;
    let mut ends = Vec::new();
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if a.y.min(b.y) <= yc && yc < a.y.max(b.y) {
            let t = (yc - a.y) / (b.y - a.y);
            ends.push((a.x + (b.x - a.x) * t, a.shade + (b.shade - a.shade) * t));
        }
    }
    match ends[..] {
        [a, b] if a.0 <= b.0 => Some(Row { left: a, right: b }),
        [a, b] => Some(Row { left: b, right: a }),
        _ => None,
    }
}

/// Draws a triangle with the shades that `shade` makes of a row and of the distance to the row's first pixel.
fn along_rows(panel: &mut Panel, corners: &[Corner; 3], shade: impl Fn(Row, f64) -> f64) {
    let mut last = None;
    for sample in samples((panel.width(), panel.height()), corners) {
        let Some(row) = row(corners, sample.y) else { continue };
        let first = match last {
            Some((y, first)) if y == sample.y => first,
            _ => sample.x,
        };
        last = Some((sample.y, first));
        panel.write(sample.x, sample.y, wrapped(shade(row, f64::from(sample.x - first))));
    }
}

/// A separate step for every row, (Bs − As) / (Bx − Ax), which grows without bound as the row gets short, and the
/// Russian textbook's start with its missing As restored: As + (1 − frac(Ax))·step. That is the shade at the next whole
/// pixel, not at the next centre. The sums wrap in 8 bits.
pub(in crate::hard_cases) fn step_of_each_row(panel: &mut Panel, corners: &[Corner; 3]) {
    along_rows(panel, corners, |Row { left: (ax, a), right: (bx, b) }, along| {
        let step = (b - a) / (bx - ax);
        a + (1.0 - ax.fract()) * step + along * step
    });
}

/// No sub-pixel correction: a row's first pixel gets the shade at the edge, wherever in the pixel the edge is.
pub(in crate::hard_cases) fn start_at_the_edge(panel: &mut Panel, corners: &[Corner; 3]) {
    along_rows(panel, corners, |Row { left: (ax, a), right: (bx, b) }, along| a + along * (b - a) / (bx - ax));
}

/// Every pixel that a row touches, with the triangle's plane extrapolated beyond its edges: below 0 and above 255 the
/// byte wraps.
pub(in crate::hard_cases) fn carried_on_beyond_the_edges(panel: &mut Panel, corners: &[Corner; 3]) {
    for y in 0..panel.height() as i32 {
        let Some(Row { left: (ax, a), right: (bx, b) }) = row(corners, y) else { continue };
        for x in ax.floor() as i32..=bx.floor() as i32 {
            panel.write(x, y, wrapped(a + (centre(x, y).0 - ax) * (b - a) / (bx - ax)));
        }
    }
}
