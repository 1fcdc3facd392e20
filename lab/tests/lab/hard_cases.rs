//! The pictures of hard cases: the right side agrees with the engine and the oracle, the wrong side differs, and the
//! program writes what the library draws.

use std::path::PathBuf;

use crate::support::picture::Png;
use crate::support::tried::Tried;
use mode13h::palette::Rgb;
use mode13h::raster::{Frame, Raster, Vertex};
use mode13h_conformance::oracle;
use mode13h_lab::hard_cases::{CASES, Case, Comparison, Mark, Panel, by_id};

/// Draws the triangles that a case reports, with the raster's own calls.
fn by_the_raster(comparison: &Comparison) -> Vec<u8> {
    let (width, height) = (comparison.right.width(), comparison.right.height());
    let mut bytes = vec![0; width * height];
    let mut depths: Vec<u32> = Vec::new();
    let frame = Frame::new(&mut bytes, width as u32, height as u32, width).expect("a legal frame");
    let raster = Raster::new(frame);
    let mut raster = if comparison.depth_tested { raster.with_cleared_depth(&mut depths) } else { raster };
    for (vertices, interpolation) in &comparison.triangles {
        raster.triangle(vertices, *interpolation);
    }
    bytes
}

/// The oracle's result for them: the bytes, and how many triangles own each pixel.
fn by_the_oracle(comparison: &Comparison) -> (Vec<u8>, Vec<u8>) {
    let (width, height) = (comparison.right.width(), comparison.right.height());
    let (mut bytes, mut owners) = (vec![0; width * height], vec![0; width * height]);
    let mut depths = vec![0; width * height];
    for (vertices, interpolation) in &comparison.triangles {
        for pixel in oracle::pixels(vertices, *interpolation, width as i32, height as i32) {
            let at = pixel.y as usize * width + pixel.x as usize;
            owners[at] += 1;
            let depth = oracle::depth_at(vertices, pixel.x, pixel.y);
            if !comparison.depth_tested || depth > depths[at] {
                (bytes[at], depths[at]) = (pixel.byte, depth);
            }
        }
    }
    (bytes, owners)
}

/// Checks that a panel's marks describe how every pixel's byte and writes differ from the other panel's.
fn assert_marks_tell_the_truth(case: &Case, fault: &Panel, right: &Panel) {
    for (at, mark) in fault.marks().iter().enumerate() {
        let (drawn, due) = (fault.writes()[at], right.writes()[at]);
        let same = (drawn > 0) == (due > 0) && fault.pixels()[at] == right.pixels()[at];
        let true_of_it = match mark {
            Some(Mark::LeftOut) => drawn == 0 && due > 0,
            Some(Mark::Outside) => drawn > 0 && due == 0,
            Some(Mark::Twice) => drawn > due && due > 0,
            Some(_) => drawn > 0 && due > 0 && !same,
            None => (drawn > 0) == (due > 0),
        };
        assert!(true_of_it, "{}: pixel {at} is marked {mark:?}", case.id);
    }
}

/// Cases whose panels are compared with themselves, rotated, moved or in another order.
const AGAINST_THEMSELVES: [&str; 3] = ["R6", "R11", "N8"];

#[test]
fn show_every_right_side_is_the_engines_and_the_oracles() {
    let mut tried = Tried::new("show_every_right_side_is_the_engines_and_the_oracles", 24);
    for case in CASES {
        let comparison = case.draw();
        let right = &comparison.right;
        assert_eq!(right.pixels(), by_the_raster(&comparison), "{}: the raster's own call", case.id);
        let (bytes, owners) = by_the_oracle(&comparison);
        assert_eq!(right.pixels(), bytes, "{}: the oracle", case.id);
        if comparison.depth_tested {
            let drawn = |counts: &[u8]| counts.iter().map(|count| *count > 0).collect::<Vec<bool>>();
            assert_eq!(drawn(right.writes()), drawn(&owners), "{}", case.id);
        } else {
            assert_eq!(right.writes(), owners, "{}: writes", case.id);
        }
        assert!(right.marks().iter().all(Option::is_none), "{}: the right side is marked", case.id);
        tried.add(1);
    }
}

#[test]
fn show_every_wrong_side_is_wrong_and_says_where() {
    let mut tried = Tried::new("show_every_wrong_side_is_wrong_and_says_where", 24);
    for case in CASES {
        let Comparison { fault, right, .. } = case.draw();
        assert_ne!(fault, right, "{}", case.id);
        let marked: usize = Mark::ALL.iter().map(|mark| fault.count(*mark)).sum();
        assert!(marked >= 10, "{}: only {marked} pixels to see", case.id);
        if !AGAINST_THEMSELVES.contains(&case.id) {
            assert_ne!((fault.pixels(), fault.writes()), (right.pixels(), right.writes()), "{}", case.id);
            assert_marks_tell_the_truth(case, &fault, &right);
        }
        tried.add(1);
    }
}

#[test]
fn show_shades_stay_in_the_range_of_their_triangle_on_the_right_alone() {
    let mut tried = Tried::new("show_shades_stay_in_the_range_of_their_triangle_on_the_right_alone", 2);
    for id in ["R2", "R14"] {
        let Comparison { fault, right, triangles, .. } = by_id(id).expect("a case").draw();
        let shades = triangles.iter().flat_map(|(vertices, _)| vertices).map(Vertex::shade);
        let (least, most) =
            shades.fold((255, 0), |(low, high), shade| (low.min(shade.nearest()), high.max(shade.nearest())));
        let beyond = |panel: &Panel| {
            let drawn = panel.pixels().iter().zip(panel.writes()).filter(|(_, writes)| **writes > 0);
            drawn.filter(|(byte, _)| !(least..=most).contains(*byte)).count()
        };
        assert_eq!(beyond(&right), 0, "{id}");
        // Bytes only span 0 to 255, so what wraps there is also outside the triangle.
        assert!(beyond(&fault) > 5 || fault.count(Mark::Outside) > 5, "{id}: {}", beyond(&fault));
        tried.add(1);
    }
}

#[test]
fn show_r5_has_holes_and_double_pixels_on_the_left_alone() {
    let Comparison { fault, right, .. } = by_id("R5").expect("a case").draw();
    assert!(fault.count(Mark::LeftOut) > 5 && fault.count(Mark::Twice) > 5);
    assert_eq!(right.writes().iter().max(), Some(&1));
}

#[test]
fn show_ids_are_known_once_and_in_any_letters() {
    let mut tried = Tried::new("show_ids_are_known_once_and_in_any_letters", 24);
    for (i, case) in CASES.iter().enumerate() {
        assert!(CASES[..i].iter().all(|other| other.id != case.id && other.sentence != case.sentence), "{}", case.id);
        assert_eq!(by_id(&case.id.to_lowercase()).map(|case| case.id), Some(case.id));
        for words in [case.title, case.sentence, case.wrong, case.right] {
            assert!(!words.is_empty() && !words.contains('\n'), "{}: {words}", case.id);
            // The characters that the pictures' font has.
            assert!(words.chars().all(|c| (' '..='~').contains(&c)), "{}: {words}", case.id);
        }
        tried.add(1);
    }
    for unknown in ["", "R", "R99", "S4", "R5 ", "ß"] {
        assert!(by_id(unknown).is_none(), "{unknown}");
    }
}

fn kept(case: &Case) -> PathBuf {
    crate::support::workspace::root().join(format!("tests/pictures/{}.png", case.id.to_lowercase()))
}

#[test]
fn show_the_list_of_hard_cases_shows_every_picture_with_its_sentence() {
    let mut tried = Tried::new("show_the_list_of_hard_cases_shows_every_picture_with_its_sentence", 24);
    let list = crate::support::workspace::root().join("tests/HARD_CASES.md");
    let list = std::fs::read_to_string(list).expect("tests/HARD_CASES.md");
    // Its lines are wrapped.
    let list = list.split_whitespace().collect::<Vec<_>>().join(" ");
    for Case { id, title, sentence, .. } in CASES {
        let head = format!("### {id}: {title} {sentence} ![");
        let section = list.split(&head).nth(1).unwrap_or_else(|| panic!("{id}: no section {head}"));
        let picture = format!("](pictures/{}.png)", id.to_lowercase());
        let section = section.split(" ### ").next().unwrap_or_default();
        assert!(section.trim_end().ends_with(&picture), "{id}: no picture");
        tried.add(1);
    }
}

/// `MODE13H_PICTURES=write` regenerates them and always fails, so that such a run never passes.
#[test]
fn show_the_pictures_of_the_list_are_those_that_are_drawn() {
    let mut tried = Tried::new("show_the_pictures_of_the_list_are_those_that_are_drawn", 24);
    let write = std::env::var_os("MODE13H_PICTURES").is_some_and(|value| value == "write");
    for case in CASES {
        let png = case.png().expect("memory");
        if write {
            std::fs::write(kept(case), &png).expect("written");
        }
        let there = std::fs::read(kept(case)).unwrap_or_else(|error| panic!("{}: {error}", kept(case).display()));
        assert!(Png::decode(&there) == Png::decode(&png), "{}: another picture than {}", case.id, kept(case).display());
        assert!(there.len() <= 20 * 1024, "{}: {} bytes", case.id, there.len());
        tried.add(1);
    }
    assert!(!write, "pictures written: look at them, then run without MODE13H_PICTURES");
}

#[test]
fn show_pixels_are_16_times_enlarged_and_have_their_colour() {
    let case = by_id("R14").expect("a case");
    let comparison = case.draw();
    let png = Png::decode(&case.png().expect("memory"));
    let ([width, height], colors) = ([png.size.0, png.size.1].map(|side| side as usize), png.colors());
    let right = &comparison.right;
    let at = |x: usize, y: usize| colors[y * width + x];
    let left = width - 16 - right.width() * 16;
    let empty = Rgb::new(0x1B, 0x25, 0x47);
    // The panel's top: the first row of cells.
    let top = (0..height).find(|y| at(left + 3, y + 3) == empty).expect("a panel") + 3 - 1;
    let mut seen = 0;
    for y in 0..right.height() {
        for x in 0..right.width() {
            // Beside the dot and away from the corner; a line may cross there, on pixels of an edge.
            let around: Vec<Rgb> = [(3, 3), (12, 3), (3, 12), (12, 12), (5, 11)]
                .map(|(dx, dy)| at(left + 16 * x + dx, top + 16 * y + dy))
                .to_vec();
            let due = match right.writes()[y * right.width() + x] {
                0 => empty,
                _ => comparison.palette.on_dac()[right.pixels()[y * right.width() + x]],
            };
            assert!(around.iter().filter(|color| **color == due).count() >= 2, "({x}, {y}): {around:?}, not {due:?}");
            seen += 1;
        }
    }
    assert!(seen > 500);
}
