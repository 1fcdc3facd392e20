//! Coverage: R1, R3 to R6, R8, R11, R13.

use super::{EXACT, against_engine, each_against_engine, in_greys};
use crate::hard_cases::Comparison;
use crate::hard_cases::engine;
use crate::hard_cases::face::{Corner, Face, at, gouraud, without_diagonals};
use crate::hard_cases::fault::{cover, paint};
use crate::hard_cases::panel::{Measure, Panel};

/// A face with one shade at all three corners.
fn plain(points: [(f64, f64); 3], shade: f64) -> Face {
    gouraud(points.map(|(x, y)| at(x, y, shade)))
}

pub(super) fn r1() -> Comparison {
    let line = |a: (f64, f64), b: (f64, f64)| plain([a, b, ((a.0 + b.0) / 2.0, (a.1 + b.1) / 2.0)], 200.0);
    let faces = [
        line((2.5, 2.5), (12.5, 12.5)),
        line((14.5, 3.5), (27.5, 3.5)),
        line((3.5, 10.5), (3.5, 18.5)),
        line((9.5, 18.5), (27.5, 9.5)),
        plain([(20.5, 17.5); 3], 200.0),
        line((17.5, 6.5), (25.5, 6.5)),
    ];
    each_against_engine((30, 21), &faces, EXACT, cover::no_fill_rule)
}

pub(super) fn r3() -> Comparison {
    let mut faces = Vec::new();
    for row in 0..6_u32 {
        for column in 0..7_u32 {
            // Placed somewhere within its own 4 × 4 pixels and rotated, by two sequences without a pattern.
            let number = f64::from(row * 7 + column);
            let (u, v) = ((number * 0.618_034).fract(), (number * 0.414_214).fract());
            let (x, y) = (f64::from(column) * 4.0 + 2.0 + 1.4 * u, f64::from(row) * 4.0 + 1.8 + 1.4 * v);
            let reach = 0.25 + 0.35 * v;
            let corner = |turn: f64| {
                let (sin, cos) = libm::sincos(number + turn * std::f64::consts::TAU / 3.0);
                at(x + reach * cos, y + reach * sin, 220.0).rounded()
            };
            faces.push(gouraud([corner(0.0), corner(1.0), corner(2.0)]));
        }
    }
    each_against_engine((30, 25), &faces, EXACT, cover::every_pixel_touched)
}

pub(super) fn r4() -> Comparison {
    let (left, middle, right) = (3.5, 15.5, 27.5);
    let (top, bottom) = (2.5, 14.5);
    let faces = [
        plain([(left, top), (middle, top), (left, bottom)], 80.0),
        plain([(middle, top), (middle, bottom), (left, bottom)], 120.0),
        plain([(middle, top), (right, top), (right, bottom)], 160.0),
        plain([(middle, top), (right, bottom), (middle, bottom)], 200.0),
        plain([(left, bottom), (middle, bottom), (15.5, 20.5)], 160.0),
        plain([(middle, bottom), (right, bottom), (15.5, 20.5)], 100.0),
    ];
    each_against_engine((31, 23), &faces, EXACT, cover::no_fill_rule)
}

pub(super) fn r5() -> Comparison {
    const RIM: usize = 18;
    let hub = (14.3, 12.6);
    let rim = |i: usize| {
        let angle = (i % RIM) as f64 * std::f64::consts::TAU / RIM as f64 + 0.1;
        let reach = if i.is_multiple_of(2) { 12.2 } else { 10.9 };
        (hub.0 + reach * 1.08 * libm::cos(angle), hub.1 + reach * libm::sin(angle))
    };
    let faces: Vec<Face> = (0..RIM)
        .map(|i| {
            let face = plain([hub, rim(i), rim(i + 1)], if i.is_multiple_of(2) { 110.0 } else { 180.0 });
            gouraud(face.corners.map(Corner::rounded))
        })
        .collect();
    each_against_engine((29, 25), &faces, EXACT, cover::cut_slopes)
}

pub(super) fn r6() -> Comparison {
    let size = (30, 25);
    let orders = |[a, b, c]: [Corner; 3]| [[a, b, c], [c, b, a]];
    let triangles = [
        [at(1.3, 1.2, 40.0), at(27.6, 9.7, 230.0), at(6.1, 23.8, 120.0)].map(Corner::rounded),
        [at(28.9, 10.6, 230.0), at(28.4, 23.4, 60.0), at(9.2, 23.9, 120.0)].map(Corner::rounded),
    ];
    let drawn = |order: usize| {
        let mut panel = Panel::new(size);
        triangles.iter().for_each(|corners| cover::cut_slopes(&mut panel, &orders(*corners)[order]));
        panel
    };
    let faces = |order: usize| triangles.map(|corners| gouraud(orders(corners)[order]));
    let (mut fault, mut right) = (drawn(0), engine::draw_faces(size, &faces(0), false));
    // Smaller errors are invisible and would be marked everywhere.
    fault.mark_against(&drawn(1), Measure { shades: 5, ..EXACT });
    right.mark_against(&engine::draw_faces(size, &faces(1), false), EXACT);
    in_greys(fault, right, &faces(0))
}

pub(super) fn r8() -> Comparison {
    let face = gouraud([at(2.2, 1.3, 30.0), at(28.6, 10.4, 240.0), at(8.7, 26.8, 140.0)].map(Corner::rounded));
    const ROWS: usize = 7;
    let measure = Measure { shades: 1, ..EXACT };
    let mut comparison = against_engine((30, 28), &[face], measure, |panel| {
        cover::cut_at_bands(panel, &face.corners, ROWS);
    });
    let mut right = engine::draw_in_bands((30, 28), &comparison.triangles, ROWS);
    right.mark_against(&comparison.right, EXACT);
    comparison.right = right;
    // The boundaries of the bands.
    let bands = (1..4).map(|band| (ROWS * band) as f64);
    comparison.outline.extend(bands.map(|y| [(0.0, y), (30.0, y)]));
    comparison
}

pub(super) fn r11() -> Comparison {
    const RIGHT: usize = 15;
    const DOWN: usize = 14;
    let size = (31, 28);
    let first: Vec<Face> = (0..6)
        .map(|i| {
            let point = |i: u32| {
                let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 6.0 + 0.35);
                at(7.3 + 6.4 * cos, 7.2 + 6.4 * sin, 0.0).rounded()
            };
            let shade = if i % 2 == 0 { 110.0 } else { 180.0 };
            gouraud([at(7.3, 7.2, 0.0).rounded(), point(i), point(i + 1)].map(|corner| Corner { shade, ..corner }))
        })
        .collect();
    let moved = |face: &Face| gouraud(face.corners.map(|corner| corner.moved(RIGHT as f64, DOWN as f64)));
    let both: Vec<Face> = first.iter().copied().chain(first.iter().map(moved)).collect();
    // The first picture, twice.
    let twice = |panel: &Panel| {
        let mut twice = panel.clone();
        for y in 0..size.1 {
            for x in 0..size.0 {
                for _ in 0..panel.writes()[y * size.0 + x] {
                    let byte = panel.pixels()[y * size.0 + x];
                    twice.write((x + RIGHT) as i32, (y + DOWN) as i32, byte);
                }
            }
        }
        twice
    };
    let drawn = |faces: &[Face]| {
        let mut panel = Panel::new(size);
        faces.iter().for_each(|face| cover::lines_from_the_corner(&mut panel, &face.corners));
        panel
    };
    let (mut fault, mut right) = (drawn(&both), engine::draw_faces(size, &both, false));
    fault.mark_against(&twice(&drawn(&first)), EXACT);
    right.mark_against(&twice(&engine::draw_faces(size, &first, false)), EXACT);
    in_greys(fault, right, &both)
}

pub(super) fn r13() -> Comparison {
    const BLADES: u32 = 14;
    let hub = (15.2, 14.1);
    let blade = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / f64::from(BLADES) + 0.11);
        let corner =
            |along: f64, across: f64| at(hub.0 + along * cos - across * sin, hub.1 + along * sin + across * cos, 200.0);
        let [a, b, c, d] = [corner(4.6, -0.65), corner(13.2, -0.65), corner(13.2, 0.65), corner(4.6, 0.65)];
        [gouraud([a, b, c]), gouraud([a, c, d])]
    };
    let faces: Vec<Face> = (0..BLADES).flat_map(blade).collect();
    let mut comparison = against_engine((30, 28), &faces, EXACT, |panel| {
        faces.iter().for_each(|face| paint(panel, &[gouraud(face.corners.map(cover::on_whole_pixel))]));
    });
    comparison.outline = without_diagonals(&comparison.outline);
    comparison
}
