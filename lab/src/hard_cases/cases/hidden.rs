//! Hidden surfaces: C3, D1 to D3.

use super::against_engine;
use crate::hard_cases::Comparison;
use crate::hard_cases::face::{Corner, Face, at, flat, without_diagonals};
use crate::hard_cases::fault::depth;
use crate::hard_cases::panel::{Mark, Measure};

/// Faces hide each other: it matters which one has the pixel, not how many drew it.
const BY_DEPTH: Measure = Measure { shades: 0, counts_writes: false, other_byte: Mark::Face };

/// Bytes from three ramps of the palette: copper, steel and jade.
const COLORS: [u8; 3] = [44, 64 + 44, 128 + 44];

/// A quad with one byte.
fn quad([a, b, c, d]: [Corner; 4], color: u8) -> [Face; 2] {
    [flat([a, b, c], color), flat([a, c, d], color)]
}

/// A corner at this distance, in multiples of the near plane's.
fn far(x: f64, y: f64, w: f64) -> Corner {
    at(x, y, 0.0).deep(1.0 / w)
}

pub(super) fn c3() -> Comparison {
    let level = quad(
        [far(2.2, 3.3, 5000.0), far(27.8, 3.3, 5000.0), far(27.8, 22.7, 5000.0), far(2.2, 22.7, 5000.0)],
        COLORS[0],
    );
    // 1/w is linear on the screen.
    let leaning = |x: f64, y: f64| at(x, y, 0.0).deep(0.0002 + 0.000_002 * (x - 13.0) + 0.000_000_8 * (y - 13.0));
    let tilted = quad([leaning(5.6, 1.2), leaning(24.4, 1.2), leaning(24.4, 24.8), leaning(5.6, 24.8)], COLORS[1]);
    let faces = [level, tilted].concat();
    let mut comparison = against_engine((30, 26), &faces, BY_DEPTH, |panel| depth::buffer_of_16_bits(panel, &faces));
    comparison.outline = without_diagonals(&comparison.outline);
    let meeting = |y: f64| (13.0 - 0.4 * (y - 13.0), y);
    comparison.outline.push([meeting(3.3), meeting(22.7)]);
    comparison
}

pub(super) fn d1() -> Comparison {
    let (centre, reach, overhang, half) = ((15.1, 14.6), 8.2, 4.6, 2.1);
    let point = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 3.0 - 1.3);
        (centre.0 + reach * cos, centre.1 + reach * sin)
    };
    let bars = [0, 1, 2].map(|k| {
        let color = COLORS[k as usize];
        let (from, to) = (point(k), point(k + 1));
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = libm::hypot(dx, dy);
        let (dx, dy) = (dx / length, dy / length);
        // Far at its start, near at its end.
        let corner = |along: f64, across: f64| {
            at(from.0 + dx * along - dy * across, from.1 + dy * along + dx * across, 0.0)
                .deep(0.3 + 0.4 * (along + overhang) / (length + 2.0 * overhang))
                .rounded()
        };
        let end = length + overhang;
        quad([corner(-overhang, -half), corner(end, -half), corner(end, half), corner(-overhang, half)], color)
    });
    let faces = bars.concat();
    let mut comparison = against_engine((30, 28), &faces, BY_DEPTH, |panel| {
        depth::painters_order(panel, &bars.each_ref().map(|bar| &bar[..]));
    });
    comparison.outline = without_diagonals(&comparison.outline);
    comparison
}

pub(super) fn d2() -> Comparison {
    let corner = |x: f64, y: f64, depth: f64| at(x, y, 0.0).deep(depth).rounded();
    // The depth rises to the right on one and falls on the other; they meet at x = 15.
    let depth = |x: f64, sign: f64| 0.5 + sign * (x - 15.0) * 0.02;
    let first =
        quad([(2.3, 4.2), (27.6, 2.4), (27.6, 18.3), (2.3, 20.2)].map(|(x, y)| corner(x, y, depth(x, 1.0))), COLORS[0]);
    let second = quad(
        [(4.2, 7.3), (25.4, 8.9), (25.4, 24.6), (4.2, 23.1)].map(|(x, y)| corner(x, y, depth(x, -1.0))),
        COLORS[1],
    );
    let faces = [first, second].concat();
    let mut comparison =
        against_engine((30, 26), &faces, BY_DEPTH, |panel| depth::painters_order(panel, &[&first, &second]));
    comparison.outline = without_diagonals(&comparison.outline);
    comparison.outline.push([(15.0, 8.1), (15.0, 19.2)]);
    comparison
}

pub(super) fn d3() -> Comparison {
    let [a, b, c] = [at(2.3, 3.4, 0.0).deep(0.31), at(27.7, 9.2, 0.0).deep(0.77), at(8.4, 24.3, 0.0).deep(0.53)]
        .map(Corner::rounded);
    let faces = [flat([a, b, c], COLORS[0]), flat([b, c, a], COLORS[1])];
    against_engine((30, 27), &faces, BY_DEPTH, |panel| depth::rounded_from_the_first_corner(panel, &faces))
}
