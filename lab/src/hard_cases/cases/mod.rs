//! The table of cases, and what the functions that build them share.

mod clipping;
mod hidden;
mod light;
mod shades;
mod triangles;

use super::engine::{self, Triangle};
use super::face::{Corner, Face, Segment};
use super::panel::{Mark, Measure, Panel};
use super::{Case, Comparison};
use mode13h::palette::builtin;

/// Every case with a picture, in the order of the list of hard cases.
pub static CASES: &[Case] = &[
    Case {
        id: "R1",
        title: "triangles without area",
        sentence: "Three corners on one line, or in one point, own no pixel; a test of the edges alone draws the line.",
        wrong: "every centre on an edge counts as inside",
        right: "no area, no pixel",
        build: triangles::r1,
    },
    Case {
        id: "R2",
        title: "slivers",
        sentence: "Along a sliver the step of a single row has no bound: shades of 60 to 200 come out black and white.",
        wrong: "a step for each row, (Bs - As) / (Bx - Ax), wrapped in 8 bits",
        right: "exact starts and one step; every byte in range",
        build: shades::r2,
    },
    Case {
        id: "R3",
        title: "smaller than a pixel",
        sentence: "A speck of a face owns the one centre inside it, or none; drawn wherever it touches, it grows to a pixel and more.",
        wrong: "every pixel that a span touches",
        right: "a pixel only if its centre is inside",
        build: triangles::r3,
    },
    Case {
        id: "R4",
        title: "edges on pixel centres",
        sentence: "Where an edge runs through centres, only one of its two faces may have them; without a rule both draw them.",
        wrong: "no fill rule: inside or on any edge",
        right: "top and left edges own their centres, others not",
        build: triangles::r4,
    },
    Case {
        id: "R5",
        title: "shared edges",
        sentence: "Two neighbours walk one edge in opposite directions; if its slope is rounded they part, and leave holes and double pixels.",
        wrong: "the Hungarian tutorial's table, slopes cut to 1/16 pixel and added up row by row",
        right: "edges by quotient and remainder: no slope",
        build: triangles::r5,
    },
    Case {
        id: "R6",
        title: "the order of the corners",
        sentence: "The same triangle, its corners listed in two orders: the marks show what changes between them.",
        wrong: "edges and shades walked from the first corner on, slopes cut",
        right: "corners sorted first: the same bytes in any order",
        build: triangles::r6,
    },
    Case {
        id: "R7",
        title: "corners a hundred thousand pixels away",
        sentence: "A large face reaches far beyond the screen; in 16 bits its corners wrap round, and another face is drawn.",
        wrong: "coordinates in 16-bit words",
        right: "clipped to 4,096 pixels before it is drawn",
        build: clipping::r7,
    },
    Case {
        id: "R8",
        title: "drawing in bands",
        sentence: "One face drawn in four bands of rows (level lines): cut at the bands and rounded again, its edges break.",
        wrong: "the face cut at each band, new corners on whole pixels",
        right: "each band starts from the face as it is",
        build: triangles::r8,
    },
    Case {
        id: "R11",
        title: "moved by whole pixels",
        sentence: "The same face twice, the second a whole number of pixels further: the marks show where they differ.",
        wrong: "edges as lines x = m y + b from the frame's corner, m cut to 1/16",
        right: "edges from their own corners, exactly",
        build: triangles::r11,
    },
    Case {
        id: "R13",
        title: "rounding of the corners",
        sentence: "Fourteen blades of one width: with corners on whole pixels they leave their true edges, some thick, some thin.",
        wrong: "corners rounded to whole pixels",
        right: "corners rounded to 1/256 pixel, once",
        build: triangles::r13,
    },
    Case {
        id: "R14",
        title: "shades 0 and 255 at the corners",
        sentence: "Carried on to a centre beyond an edge, a shade passes 255 and comes out black, or passes 0 and comes out white.",
        wrong: "pixels beyond the edges, shades wrapped in 8 bits",
        right: "only centres inside: no shade beyond the corners'",
        build: shades::r14,
    },
    Case {
        id: "C1",
        title: "corners behind the eye",
        sentence: "A floor that runs on under the eye: projected, its corners behind the eye come out upside down in the sky.",
        wrong: "corners behind the eye divided by a negative w",
        right: "cut at the near plane first, shade across the cut kept",
        build: clipping::c1,
    },
    Case {
        id: "C2",
        title: "a corner passes the near plane",
        sentence: "The nearest strip of the floor has just passed the near plane with two corners: dropped, it leaves a gap.",
        wrong: "faces with a corner beyond the near plane are dropped",
        right: "only what lies beyond the plane is cut off",
        build: clipping::c2,
    },
    Case {
        id: "C3",
        title: "near : far = 1 : 10,000",
        sentence: "Two faces cross 5,000 times as far away as the near plane: 16 bits of depth put the crossing elsewhere.",
        wrong: "a depth buffer of 16 bits",
        right: "30 bits of depth",
        build: hidden::c3,
    },
    Case {
        id: "C5",
        title: "shades in perspective",
        sentence: "A floor, dark on its left and light on its right: linear on the screen, the shades leave the lines that run to the horizon and break along the diagonal.",
        wrong: "linear on the screen",
        right: "linear on the floor: weighted by 1/w, exactly",
        build: shades::c5,
    },
    Case {
        id: "N1",
        title: "a face without area in the average",
        sentence: "A face of no area at the right edge has the normal 0/0; in the average it blots out every face around its corners.",
        wrong: "its normal counts like the others': NaN, drawn as 0",
        right: "no area, no weight",
        build: light::n1,
    },
    Case {
        id: "N2",
        title: "normals that cancel",
        sentence: "A folded sheet with faces on both sides: the normals of a vertex add up to nothing, and so does its light.",
        wrong: "the sum of the normals as it is: zero, drawn as 0",
        right: "the vertex is split, each face keeps its own normal",
        build: light::n2,
    },
    Case {
        id: "N4",
        title: "light from behind a face",
        sentence: "A ball lit from the upper left: its other side faces away from the light, and a negative amount wraps to bright.",
        wrong: "n.l as it is, wrapped in 8 bits",
        right: "max(0, n.l): a light behind a face adds nothing",
        build: light::n4,
    },
    Case {
        id: "N5",
        title: "more light than white",
        sentence: "Two lamps on one ball add up to more than white in the middle: where the sum wraps, the brightest band is dark.",
        wrong: "bytes added up in 8 bits",
        right: "summed in full, then clamped once",
        build: light::n5,
    },
    Case {
        id: "N6",
        title: "the brightness of a rounded corner",
        sentence: "The corner of this rounded cube points at the light and must be its brightest spot; a mean that is not renormalised darkens it.",
        wrong: "the Hungarian tutorial's mean of normals, 0.58 long at a corner",
        right: "the sum renormalised",
        build: light::n6,
    },
    Case {
        id: "N8",
        title: "a quad turned on the screen",
        sentence: "A quad and the same quad turned by 90 degrees: marks show where the shade did not turn with it.",
        wrong: "shaded as a quad: along its edges, then along the row",
        right: "split into triangles, which do not care",
        build: shades::n8,
    },
    Case {
        id: "N9",
        title: "two faces that share an edge",
        sentence: "Shades rise and fall in waves along the shared edges; a row that starts with the edge's shade is ragged there.",
        wrong: "no sub-pixel correction: a row starts with the edge's shade",
        right: "starts at the pixel's centre; both planes agree",
        build: shades::n9,
    },
    Case {
        id: "D1",
        title: "faces that overlap cyclically",
        sentence: "Each of three bars lies over the next: no order of painting can show that.",
        wrong: "painter's order: the farthest first",
        right: "a depth for every pixel",
        build: hidden::d1,
    },
    Case {
        id: "D2",
        title: "faces that pass through each other",
        sentence: "Half of each face lies in front of the other; painted in order, one lies over the other throughout.",
        wrong: "painter's order: the farthest first",
        right: "a depth for every pixel",
        build: hidden::d2,
    },
    Case {
        id: "D3",
        title: "two faces in the same place",
        sentence: "The same three corners twice, named in two orders: the second face shows through where rounding lets it.",
        wrong: "depth in f32 from the first corner on",
        right: "one depth for the same corners: the first face wins",
        build: hidden::d3,
    },
];

/// Every pixel exact, with writes counted.
const EXACT: Measure = Measure { shades: 0, counts_writes: true, other_byte: Mark::Shade };

/// Compares the fault with the engine, which draws the faces.
fn against_engine(
    size: (usize, usize),
    faces: &[Face],
    measure: Measure,
    wrong: impl FnOnce(&mut Panel),
) -> Comparison {
    let right = engine::draw_faces(size, faces, !measure.counts_writes);
    Comparison {
        depth_tested: !measure.counts_writes,
        outline: edges(faces),
        palette: if measure.counts_writes { &builtin::GREY } else { &builtin::MATERIALS_4X64 },
        ..of_scene((right, engine::triangles(faces)), measure, wrong)
    }
}

/// Compares the engine with a fault that draws one face after another.
fn each_against_engine(
    size: (usize, usize),
    faces: &[Face],
    measure: Measure,
    wrong: fn(&mut Panel, &[Corner; 3]),
) -> Comparison {
    against_engine(size, faces, measure, |panel| faces.iter().for_each(|face| wrong(panel, &face.corners)))
}

/// Two drawings of faces without a depth buffer, in greys. Both are marked already.
fn in_greys(fault: Panel, right: Panel, faces: &[Face]) -> Comparison {
    let (triangles, outline) = (engine::triangles(faces), edges(faces));
    Comparison { fault, right, triangles, depth_tested: false, outline, palette: &builtin::GREY }
}

fn edges(faces: &[Face]) -> Vec<Segment> {
    faces.iter().flat_map(Face::edges).collect()
}

/// Compares the fault with the engine on a scene in greys.
fn of_scene(
    (right, triangles): (Panel, Vec<Triangle>),
    measure: Measure,
    wrong: impl FnOnce(&mut Panel),
) -> Comparison {
    let mut fault = Panel::new((right.width(), right.height()));
    wrong(&mut fault);
    fault.mark_against(&right, measure);
    let outline = engine::outline(&triangles);
    Comparison { fault, right, triangles, depth_tested: true, outline, palette: &builtin::GREY }
}
