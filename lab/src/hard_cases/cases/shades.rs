//! Shades: R2, R14, C5, N8, N9.

use super::{EXACT, against_engine, each_against_engine, in_greys};
use crate::hard_cases::Comparison;
use crate::hard_cases::engine;
use crate::hard_cases::face::{Corner, Face, at, gouraud};
use crate::hard_cases::fault::{paint, shade};
use crate::hard_cases::panel::{Measure, Panel};
use mode13h::raster::Interpolation;

/// A byte may be one shade off through the engine's own rounding.
const ROUNDED: Measure = Measure { shades: 1, ..EXACT };

pub(super) fn r2() -> Comparison {
    let sliver = |a: (f64, f64), b: (f64, f64), width: f64| {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let across = width / libm::hypot(dx, dy);
        let middle = ((a.0 + b.0) / 2.0 - dy * across, (a.1 + b.1) / 2.0 + dx * across);
        gouraud([at(a.0, a.1, 60.0), at(b.0, b.1, 60.0), at(middle.0, middle.1, 200.0)].map(Corner::rounded))
    };
    let faces: Vec<Face> = (0..9)
        .map(|i| {
            let (i, slope) = (f64::from(i), 0.05 + 0.095 * f64::from(i));
            let (top, length) = (1.2 + 2.2 * i, 28.0_f64.min((23.6 - 2.2 * i) / slope));
            sliver((1.0, top), (1.0 + length, top + slope * length), 0.3)
        })
        .collect();
    each_against_engine((30, 26), &faces, ROUNDED, shade::step_of_each_row)
}

pub(super) fn r14() -> Comparison {
    let faces = [
        gouraud([at(2.4, 2.3, 255.0), at(13.8, 4.2, 0.0), at(5.3, 23.6, 255.0)].map(Corner::rounded)),
        gouraud([at(16.2, 2.4, 0.0), at(28.7, 12.1, 255.0), at(17.9, 23.7, 0.0)].map(Corner::rounded)),
    ];
    each_against_engine((31, 26), &faces, ROUNDED, shade::carried_on_beyond_the_edges)
}

pub(super) fn c5() -> Comparison {
    // The horizon is at y = 3; the floor is 22 units of 1/w below it and 28 wide.
    let on_floor = |across: f64, w: f64| (15.0 + 14.0 * across / w, 3.0 + 22.0 / w);
    let corner = |across: f64, w: f64| {
        let (x, y) = on_floor(across, w);
        at(x, y, 125.0 + 110.0 * across).deep(1.0 / w).rounded()
    };
    let [a, b, c, d] = [corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, 6.0), corner(-1.0, 6.0)];
    let faces = [[a, b, c], [a, c, d]]
        .map(|corners| Face { interpolation: Interpolation::GouraudHyperbolic, ..gouraud(corners) });
    let mut comparison = against_engine((30, 26), &faces, Measure { shades: 4, ..EXACT }, |panel| paint(panel, &faces));
    // Lines of one shade.
    comparison.outline.extend([-0.6, -0.2, 0.2, 0.6].map(|across| [on_floor(across, 1.0), on_floor(across, 6.0)]));
    comparison
}

/// Side, in pixels, of the square in which N8's quad lies and turns.
const BOX: usize = 17;

pub(super) fn n8() -> Comparison {
    let size = (2 * BOX, BOX);
    let quad = [at(1.3, 5.2, 20.0), at(10.6, 0.9, 240.0), at(15.7, 12.4, 30.0), at(4.2, 16.1, 250.0)];
    let quad = quad.map(Corner::rounded);
    // A quarter turn within the box, then across to the box beside it.
    let turned = quad.map(|c| Corner { x: BOX as f64 - c.y, y: c.x, ..c }.moved(BOX as f64, 0.0));
    let split = |[a, b, c, d]: [Corner; 4]| [gouraud([a, b, c]), gouraud([a, c, d])];
    let faces: Vec<Face> = [quad, turned].into_iter().flat_map(split).collect();
    let [quad_vertices, turned_vertices] = [quad, turned].map(|q| q.map(|corner| corner.vertex()));
    let mut fault = engine::draw_by_table(size, &[&quad_vertices, &turned_vertices]);
    let mut right = engine::draw_faces(size, &faces, false);
    // The left half, and beside it the same half turned.
    let beside = |panel: &Panel| {
        let mut beside = Panel::new(size);
        for y in 0..BOX {
            for x in 0..BOX {
                if let Some(byte) = panel.get(x, y) {
                    beside.write(x as i32, y as i32, byte);
                    beside.write((BOX + BOX - 1 - y) as i32, x as i32, byte);
                }
            }
        }
        beside
    };
    for panel in [&mut fault, &mut right] {
        let due = beside(panel);
        // Rows that were columns start elsewhere, so shades may differ by one either way.
        panel.mark_against(&due, Measure { shades: 2, ..EXACT });
    }
    let outline =
        [quad, turned].iter().flat_map(|q| (0..4).map(|i| [i, (i + 1) % 4].map(|k| (q[k].x, q[k].y)))).collect();
    Comparison { outline, ..in_greys(fault, right, &faces) }
}

pub(super) fn n9() -> Comparison {
    // Ribs from the upper to the lower edge, alternately dark and light.
    let ribs = [(1.2, 3.6), (9.1, 6.2), (12.4, 16.9), (23.6, 18.1)];
    let mut faces: Vec<Face> = Vec::new();
    for (i, pair) in ribs.windows(2).enumerate() {
        let shade = |i: usize| if i.is_multiple_of(2) { 15.0 } else { 240.0 };
        let (top, bottom) = (|k: usize| at(pair[k].0, 1.3, shade(i + k)), |k: usize| at(pair[k].1, 24.6, shade(i + k)));
        let (a, b, c, d) = (top(0), top(1), bottom(1), bottom(0));
        faces.extend([[a, b, c], [a, c, d]].map(|corners| gouraud(corners.map(Corner::rounded))));
    }
    let measure = Measure { shades: 16, ..EXACT };
    each_against_engine((25, 26), &faces, measure, shade::start_at_the_edge)
}
