//! The fill rule, as pictures. A dot is a pixel left untouched; each pixel may be drawn once.

use crate::support::display::Display;
use crate::support::tried::Tried;

#[test]
fn r4_a_square_of_two_triangles_on_pixel_centres() {
    let mut tried = Tried::new("r4_a_square_of_two_triangles_on_pixel_centres", 1);
    tried.add(1);
    // Corners at (1.5, 1.5) and (4.5, 3.5): the left and top edges own their centres, the right and
    // bottom edges don't.
    Display::new(6, 5)
        .draw('#', [(1.5, 1.5), (4.5, 1.5), (1.5, 3.5)])
        .draw('o', [(4.5, 1.5), (4.5, 3.5), (1.5, 3.5)])
        .assert_pattern(&[
            "......", //
            ".###..", ".##o..", "......", "......",
        ]);
}

#[test]
fn r4_a_fan_round_a_centre() {
    let mut tried = Tried::new("r4_a_fan_round_a_centre", 1);
    tried.add(1);
    // Eight triangles around (3.5, 3.5) with every corner on a pixel centre: the middle pixel belongs to d, where it is
    // on a top edge and on a left one.
    let ring = [(0.5, 0.5), (3.5, 0.5), (6.5, 0.5), (6.5, 3.5), (6.5, 6.5), (3.5, 6.5), (0.5, 6.5), (0.5, 3.5)];
    let mut display = Display::new(7, 7);
    for (i, mark) in ('a'..='h').enumerate() {
        display.draw(mark, [(3.5, 3.5), ring[i], ring[(i + 1) % 8]]);
    }
    display.assert_pattern(&[
        "aaabbb.", //
        "haabbc.", "hhabcc.", "gggddd.", "ggfedd.", "gffeed.", ".......",
    ]);
}

#[test]
fn r3_between_pixel_centres() {
    let mut tried = Tried::new("r3_between_pixel_centres", 1);
    tried.add(1);
    Display::new(3, 3).draw('#', [(0.6, 0.6), (1.4, 0.6), (1.0, 1.4)]).assert_pattern(&["...", "...", "..."]);
    Display::new(3, 3).draw('#', [(1.4, 1.4), (1.7, 1.4), (1.5, 1.7)]).assert_pattern(&["...", ".#.", "..."]);
}

#[test]
fn r1_no_area() {
    let mut tried = Tried::new("r1_no_area", 1);
    tried.add(1);
    Display::new(4, 4)
        .draw('a', [(1.5, 1.5), (1.5, 1.5), (1.5, 1.5)])
        .draw('b', [(0.5, 0.5), (3.5, 3.5), (1.5, 1.5)])
        .draw('c', [(0.5, 1.5), (3.5, 1.5), (2.5, 1.5)])
        .draw('d', [(1.5, 0.5), (1.5, 3.5), (1.5, 0.5)])
        .assert_pattern(&["....", "....", "....", "...."]);
}

#[test]
#[should_panic(expected = "is drawn twice, by a and by b")]
fn the_display_fails_on_overdraw() {
    let triangle = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)];
    Display::new(4, 4).draw('a', triangle).draw('b', triangle);
}
