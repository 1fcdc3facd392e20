//! The explanation of a pixel compared with its frame, and with the definitions.

use crate::support::{scenes, shaded, triangles, within};
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::plan::FaceShading;
use mode13h::raster::{Frame, Interpolation, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::{Accuracy, HiddenSurfaces, Shading, VertexPath};
use mode13h_conformance::Random;
use mode13h_conformance::oracle::{self, Shades};
use mode13h_lab::explain::{
    self, Column, EdgeKind, ExplainError, Fate, Pixel, PixelStage, Progression, Registers, ShadeTrace, ShadedBy,
};
use mode13h_lab::truth::{Standard, Truth};

const SCREEN: Screen = Screen::MODE_13H;

fn frame(renderer: &mut Renderer, scene: &Scene) -> Vec<u8> {
    let mut bytes = vec![0; 64_000];
    let frame = Frame::new(&mut bytes, 320, 200, 320).expect("a frame");
    renderer.draw_frame(scene, frame, SCREEN.pixel_aspect).expect("a legal scene");
    bytes
}

fn explain(renderer: &mut Renderer, scene: &Scene, x: u32, y: u32) -> Pixel {
    explain::pixel(renderer, scene, SCREEN, x, y).expect("a pixel of a legal scene")
}

/// Pixels worth asking about: some anywhere, and some that show a face in the frame.
fn some_pixels(bytes: &[u8], background: u8, count: usize, random: &mut Random) -> Vec<(u32, u32)> {
    let covered: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i] != background).collect();
    (0..count)
        .map(|i| {
            let place = if i % 4 == 0 || covered.is_empty() {
                (random.unit() * bytes.len() as f64) as usize
            } else {
                covered[(random.unit() * covered.len() as f64) as usize]
            };
            (place as u32 % 320, place as u32 / 320)
        })
        .collect()
}

/// Checks that the explanation of the front face matches the definitions. Returns whether there was anything to check.
fn check_front(pixel: &Pixel, what: &str) -> bool {
    let Some((face, seen)) = pixel.front() else {
        assert_eq!(pixel.byte, pixel.background, "{what}");
        return false;
    };
    assert_eq!(seen.stages.last().and_then(|stage| stage.byte()), Some(pixel.byte), "{what}");
    let (x, y) = (pixel.x as i32, pixel.y as i32);
    let triangle = face.corners.each_ref().map(oracle::point);
    if seen.exact_cover {
        assert!(oracle::covers(triangle, oracle::centre(x, y)), "{what}");
        for (edge, (from, to)) in face.edges(pixel.x, pixel.y).iter().zip([(0, 1), (1, 2), (2, 0)]) {
            let value = oracle::edge(triangle[from], triangle[to], oracle::centre(x, y));
            assert_eq!(i128::from(edge.value), value, "{what}");
            assert!(value > 0 || (value == 0 && edge.kind.owns_ties()), "{what}");
        }
        assert_eq!(face.depth, oracle::depth_at(&face.corners, x, y), "{what}");
    }
    match (&seen.shaded_by, seen.accounts.as_slice(), seen.stages[0]) {
        (ShadedBy::Light { shades, .. }, [], PixelStage::Shade(byte)) => {
            assert_eq!((shades[0] + 128) >> 8, u16::from(byte), "{what}");
        }
        (ShadedBy::Light { shades, .. }, [], PixelStage::Channels(bytes)) => {
            assert_eq!(shades.map(|shade| (shade + 128) >> 8), bytes.map(u16::from), "{what}");
        }
        (ShadedBy::NormalTable, [_, _], PixelStage::Shade(_)) => {}
        (ShadedBy::Corners, [shade_trace], PixelStage::Shade(byte)) => {
            assert_eq!(shade_trace.byte, byte, "{what}");
            check_account(shade_trace, face, seen.exact_cover, x, y, what);
        }
        (ShadedBy::Corners, [red, green, blue], PixelStage::Channels(bytes)) => {
            assert_eq!([red.byte, green.byte, blue.byte], bytes, "{what}");
        }
        other => panic!("{what}: {other:?}"),
    }
    true
}

/// A fraction in lowest terms.
fn reduced(n: i128, d: i128) -> (i128, i128) {
    let (mut a, mut b) = (n.abs(), d);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    (n / a, d / a)
}

/// Checks an explanation of shades from corners against the definition of the shading.
fn check_account(shade_trace: &ShadeTrace, face: &explain::FaceHere, exact_cover: bool, x: i32, y: i32, what: &str) {
    let shades = Shades::of_vertices(&face.corners, face.interpolation);
    let byte = if exact_cover {
        let triangle = face.corners.each_ref().map(oracle::point);
        let row: Vec<i32> = (0..320).filter(|&x| oracle::covers(triangle, oracle::centre(x, y))).collect();
        shades.byte((row[0], row[row.len() - 1]), x, y, None)
    } else {
        let all = oracle::pixels(&face.corners, face.interpolation, 320, 200);
        all.iter().find(|pixel| (pixel.x, pixel.y) == (x, y)).expect("covered").byte
    };
    assert_eq!(shade_trace.byte, byte, "{what}");
    if let Some(exact) = shade_trace.exact {
        let right = oracle::exact_shade(&face.corners, face.interpolation, oracle::centre(x, y));
        assert_eq!(reduced(exact.numerator, exact.denominator), reduced(right.n, right.d), "{what}");
        if let Some((n, d)) = oracle::bound(face.interpolation, 320) {
            assert!(right.is_within(i128::from(shade_trace.byte) * 256, n, d), "{what}");
        }
    } else {
        assert!(matches!(shade_trace.way, Progression::Flat(_)), "{what}");
    }
    if let Progression::Accumulator(sums) = shade_trace.way {
        assert!(face.interpolation == Interpolation::GouraudVintage || sums.start_at + sums.steps == x, "{what}");
        assert_eq!(sums.sum() >> sums.fraction_bits, u32::from(shade_trace.byte), "{what}");
    }
}

/// An explanation ends with the frame's byte: every scene with every shading, at scattered pixels.
#[test]
fn an_account_ends_with_the_byte_of_the_frame() {
    let mut random = Random::new(0x5EED);
    let (mut with_face, mut all) = (0, 0);
    for (name, scene) in scenes::all() {
        for shading in Shading::ALL {
            let mut renderer = shaded(shading);
            let bytes = frame(&mut renderer, &scene);
            for (x, y) in some_pixels(&bytes, scene.background, 7, &mut random) {
                let what = format!("{name} by {shading} at ({x}, {y})");
                let pixel = explain(&mut renderer, &scene, x, y);
                assert_eq!(pixel.byte, bytes[y as usize * 320 + x as usize], "{what}:\n{pixel}");
                with_face += usize::from(check_front(&pixel, &what));
                all += 1;
                let text = pixel.to_string();
                assert!(text.lines().all(|line| line.chars().count() <= 100), "{what}:\n{text}");
                assert!(text.lines().count() <= 40, "{what}:\n{text}");
            }
        }
    }
    assert!(all > scenes::all().len() * 50 && with_face * 2 > all, "{with_face} of {all}");
}

/// Explanations end with the frame's byte for every hidden-surface method and both vertex paths, too.
#[test]
fn an_account_follows_the_way_to_hidden_surfaces() {
    let mut random = Random::new(0x5EED);
    let mut losers = 0;
    for (name, scene) in scenes::all() {
        for way in HiddenSurfaces::ALL {
            for path in VertexPath::ALL {
                let mut renderer = Renderer::new();
                renderer.settings.hidden_surfaces = Some(way);
                renderer.settings.vertex_path = Some(path);
                if random.unit() < 0.3 {
                    renderer.settings.accuracy = Some(Shading::GouraudVintage.into());
                }
                let bytes = frame(&mut renderer, &scene);
                for (x, y) in some_pixels(&bytes, scene.background, 9, &mut random) {
                    let pixel = explain(&mut renderer, &scene, x, y);
                    let what = format!("{name} by {way}, {path}, at ({x}, {y}):\n{pixel}");
                    assert_eq!(pixel.byte, bytes[y as usize * 320 + x as usize], "{what}");
                    let front = pixel.seen.first().map(|seen| &pixel.faces[seen.face]);
                    for loser in pixel.losers() {
                        losers += 1;
                        let tests =
                            matches!(pixel.hidden_surfaces, HiddenSurfaces::DepthBuffer | HiddenSurfaces::ScanLine);
                        let front = front.expect("what hides it").depth;
                        assert!(!tests || loser.depth <= front, "{what}");
                    }
                }
            }
        }
    }
    // The shipped scenes, which are files, provide most of the overlaps.
    assert!(losers > 300, "{losers}");
}

/// Frames drawn after an explanation are those drawn without it.
#[test]
fn an_account_leaves_the_renderer_as_it_was() {
    let mut scene = scenes::showing("torus");
    let (mut one, mut other) = (Renderer::new(), Renderer::new());
    for turn in 0..4 {
        scene.objects_mut()[0].angles = [0.3, 0.2 * f64::from(turn), 0.0].map(Angle::from_radians);
        explain(&mut one, &scene, 160, 100);
        assert!(frame(&mut one, &scene) == frame(&mut other, &scene));
        explain(&mut one, &scenes::showing("cube"), 160, 100);
    }
}

/// A square of two triangles with its corners on these pixels, seen straight on from a distance at which a unit is one
/// pixel down and 6/5 pixel across.
fn square(x: [f32; 2], y: [f32; 2]) -> Scene {
    let at = |x: f32, y: f32| Vec3::new((x - 160.0) / 1.2, 100.0 - y, 0.0);
    let corners = vec![at(x[0], y[0]), at(x[0], y[1]), at(x[1], y[1]), at(x[1], y[0])];
    let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("a square");
    let (eye, target, up) = (Vec3::new(0.0, 0.0, 100.0), Vec3::ZERO, Vec3::Y);
    let mut scene = Scene::new();
    scene.add(Object::new(mesh).named("square"));
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene.camera = Camera { eye, target, up, field_of_view: Angle::from_degrees(90.0), near: 1.0 };
    scene
}

/// Corners on whole pixels, so that the diagonal runs through centres: those belong to the right triangle, whose left
/// edge it is, and the other one reports that they are not its own. Every value is computed by hand.
#[test]
fn a_tie_on_a_shared_edge_is_the_left_edges() {
    let scene = square([100.0, 132.0], [60.0, 92.0]);
    let renderer = &mut Renderer::new();
    for k in 0..32 {
        let pixel = explain(renderer, &scene, 100 + k, 60 + k);
        assert_eq!(pixel.faces.len(), 2, "{pixel}");
        let (lower, upper) = (&pixel.faces[0], &pixel.faces[1]);
        assert_eq!((lower.triangle, lower.fate), (Some(0), Fate::NotItsEdge), "{pixel}");
        assert_eq!((upper.triangle, upper.fate), (Some(1), Fate::Seen), "{pixel}");
        // Clockwise from the upper left corner: right, down, and back along the diagonal.
        let corners = upper.corners.map(|corner| (corner.x().to_bits(), corner.y().to_bits()));
        assert_eq!(corners, [(100, 60), (132, 60), (132, 92)].map(|(x, y)| (x * 256, y * 256)));
        let edges = upper.edges(pixel.x, pixel.y);
        // 32 · 256 long, and k + ½ pixels below; 32 · 256, and 32 − k − ½ pixels to the left; on the diagonal.
        let (down, left) = (i64::from(k) * 256 + 128, i64::from(31 - k) * 256 + 128);
        assert_eq!(edges.map(|edge| edge.value), [8192 * down, 8192 * left, 0]);
        assert_eq!(edges.map(|edge| edge.kind), [EdgeKind::Top, EdgeKind::Right, EdgeKind::Left]);
        let tie = lower.edges(pixel.x, pixel.y).into_iter().find(|edge| edge.value == 0).expect("the diagonal");
        assert_eq!((tie.kind, tie.kind.owns_ties()), (EdgeKind::Right, false));
        // Full light on the default ramp.
        assert_eq!(pixel.byte, 255, "{pixel}");
    }
    // Just outside each side, where the upper and the left edge belong to the square, and just inside.
    for (x, y, is_in) in [(99, 70, false), (100, 70, true), (110, 59, false), (110, 60, true), (132, 70, false)] {
        assert_eq!(!explain(renderer, &scene, x, y).seen.is_empty(), is_in, "({x}, {y})");
    }
    // With corners on centres, one row and one column belong to the square, and the opposite ones do not.
    let scene = square([100.5, 132.5], [60.5, 92.5]);
    for (x, y, is_in) in [(100, 60, true), (110, 60, true), (100, 70, true), (132, 70, false), (110, 92, false)] {
        let pixel = explain(renderer, &scene, x, y);
        assert_eq!(!pixel.seen.is_empty(), is_in, "({x}, {y})");
        let fate = if is_in { Fate::Seen } else { Fate::NotItsEdge };
        assert!(pixel.faces.iter().any(|face| face.fate == fate), "{pixel}");
    }
}

/// Within a budget a face is described by what shaded it: light at the pixel, between pixels of its row, or at six
/// points.
#[test]
fn faces_within_a_budget_are_named_by_what_shaded_them() {
    let mut named = [0; 3];
    for (name, scene) in scenes::all() {
        let mut renderer = within(4.0);
        let bytes = frame(&mut renderer, &scene);
        for (x, y) in some_pixels(&bytes, scene.background, 8, &mut Random::named(&name)) {
            let pixel = explain(&mut renderer, &scene, x, y);
            let Some((_, seen)) = pixel.front() else { continue };
            let (which, word) = match seen.shaded_by {
                ShadedBy::Light { .. } => (0, "phong"),
                ShadedBy::BetweenLit { spacing, .. } => (1, FaceShading::PhongEvery(spacing).name()),
                ShadedBy::BetweenSix(_) => (2, "phong-quadratic"),
                _ => continue,
            };
            named[which] += 1;
            let words = format!("shading   {word}: chosen for this face by the budget of 4 shades");
            assert!(pixel.to_string().contains(&words), "{name}: {pixel}");
        }
    }
    assert!(named[0] > 0 && named[2] > 0, "{named:?}");
}

/// Faces with the same corners are each named by their own number, whichever of them is visible.
#[test]
fn faces_with_the_same_corners_keep_their_own_numbers() {
    let scene = square([100.0, 132.0], [60.0, 92.0]);
    let mesh = scene.objects()[0].mesh();
    let mut triangles = mesh.triangles().to_vec();
    triangles.extend_from_within(..);
    let mesh = Mesh::new(mesh.positions().to_vec(), triangles).expect("a square twice");
    let mut twice = scene.clone();
    twice.objects_mut()[0] = Object::new(mesh).named("square");
    for (way, fates) in [
        (HiddenSurfaces::DepthBuffer, [Fate::Seen, Fate::Behind]),
        (HiddenSurfaces::BackFaces, [Fate::PaintedOver, Fate::Seen]),
    ] {
        for max_error in [None, Some(4.0)] {
            let mut renderer = Renderer::new();
            renderer.settings.hidden_surfaces = Some(way);
            renderer.settings.accuracy = max_error.map(Accuracy::WithinError);
            // Below the diagonal.
            let pixel = explain(&mut renderer, &twice, 105, 80);
            let named: Vec<_> = pixel.faces.iter().map(|face| (face.triangle, face.fate)).collect();
            assert_eq!(named, [(Some(0), fates[0]), (Some(2), fates[1])], "{way}: {pixel}");
        }
    }
}

/// Every pixel of a long row, in which spans are reseeded, with every shading; and of two coincident objects, whose
/// depths are equal everywhere, with every hidden-surface method.
#[test]
fn every_pixel_of_a_long_row_and_of_equal_depths() {
    let mut scene = square([8.0, 312.0], [40.0, 160.0]);
    scene.add_light(Light::lamp([-60.0, 30.0, 40.0], 200.0));
    scene.remove_light(scene.light_ids()[0]);
    let mut twins = scene.clone();
    let mut twin = twins.objects()[0].clone().named("twin");
    twin.materials[0].diffuse *= 0.5;
    twins.add(twin);
    for shading in Shading::ALL {
        for way in HiddenSurfaces::ALL {
            let mut renderer = shaded(shading);
            renderer.settings.hidden_surfaces = Some(way);
            let bytes = frame(&mut renderer, &twins);
            for x in (0..320).step_by(5) {
                let pixel = explain(&mut renderer, &twins, x, 90);
                assert_eq!(pixel.byte, bytes[90 * 320 + x as usize], "{shading}, {way}:\n{pixel}");
            }
        }
        let mut renderer = shaded(shading);
        let bytes = frame(&mut renderer, &scene);
        let mut restarts = 0;
        for x in 0..320 {
            let pixel = explain(&mut renderer, &scene, x, 90);
            assert_eq!(pixel.byte, bytes[90 * 320 + x as usize], "{pixel}");
            check_front(&pixel, &format!("{shading} at {x}"));
            let shade_trace = pixel.front().and_then(|(_, seen)| seen.accounts.first().copied());
            if let Some(ShadeTrace { way: Progression::Accumulator(sums), .. }) = shade_trace {
                restarts += usize::from(sums.start_at != sums.first);
                assert!(shading != Shading::Gouraud88Reseeded || sums.steps < 64, "{pixel}");
            }
        }
        assert!(shading != Shading::Gouraud88Reseeded || restarts > 100, "{restarts}");
    }
}

/// The triangle named is the one that the truth finds, and the shade is as close to it as the shading promises.
#[test]
fn the_face_and_the_errors_are_those_against_the_truth() {
    let mut random = Random::named("explain truth");
    for (name, bound) in [("torus", 0.75), ("cone", 0.75), ("teapot", 0.75)] {
        let scene = scenes::showing(name);
        let truth = Truth::new(&scene, SCREEN).expect("legal").draw(Standard::Gouraud);
        let mut renderer = Renderer::new();
        let bytes = frame(&mut renderer, &scene);
        let mut compared = 0;
        for (x, y) in some_pixels(&bytes, scene.background, 200, &mut random) {
            let pixel = explain(&mut renderer, &scene, x, y);
            let (Some((face, seen)), Some(right)) = (pixel.front(), truth.at(x, y)) else { continue };
            if (Some(right.face.triangle), right.face.object) != (face.triangle, face.object) {
                // At most two that meet in depth at an edge.
                assert!(pixel.faces.iter().any(|other| other.triangle == Some(right.face.triangle)), "{pixel}");
                continue;
            }
            let gouraud = seen.against.iter().find(|a| a.standard == Standard::Gouraud).expect("a ramp of 256");
            assert_eq!(gouraud.shades[0], 255.0 * right.intensity[0]);
            // The shading's promise, the rounding of each corner's shade, and f32 before that.
            assert!(gouraud.error.abs() <= bound + 1.0 / 512.0 + 0.01, "{pixel}");
            compared += 1;
        }
        assert!(compared > 100, "{name}: {compared}");
    }
}

/// A row of the frame agrees with the explanations of its pixels.
#[test]
fn a_row_is_its_pixels() {
    let scene = scenes::showing("cone");
    let row = explain::row(Renderer::new(), &scene, SCREEN, 120).expect("a row");
    assert_eq!(row.columns.len(), 320);
    let mut renderer = Renderer::new();
    let mut with_face = 0;
    for (x, column) in (0..).zip(&row.columns) {
        let pixel = explain(&mut renderer, &scene, x, 120);
        let Some((face, seen)) = pixel.front() else {
            assert_eq!((column.face, column.drawn), (None, None));
            continue;
        };
        with_face += 1;
        assert_eq!(column.face.map(|face| (face.object, Some(face.triangle))), Some((face.object, face.triangle)));
        assert_eq!(column.drawn.map(|shade| PixelStage::Shade(shade as u8)), Some(seen.stages[0]));
        for against in &seen.against {
            let shades = if against.standard == Standard::Lit { column.lit } else { column.gouraud };
            // The mean of three equal values, and 255 times it, in another order: a few roundings of f64.
            let mean = against.shades.iter().sum::<f64>() / 3.0;
            assert!((shades.expect("the same face") - mean).abs() < 1e-12 * 255.0);
        }
    }
    assert!(with_face > 50);
    // The slope of 10, 30, 40 and nothing.
    let columns = [10.0, 30.0, 40.0].map(|drawn| Column { drawn: Some(drawn), ..Column::default() });
    let row = explain::Row { y: 0, columns: [columns.as_slice(), &[Column::default()]].concat() };
    assert_eq!(row.slope(|column| column.drawn), [None, Some(15.0), None, None]);
}

#[test]
fn what_is_not_in_the_frame_is_refused() {
    let scene = scenes::showing("cube");
    for (x, y) in [(320, 0), (0, 200), (u32::MAX, u32::MAX)] {
        let error = explain::pixel(&mut Renderer::new(), &scene, SCREEN, x, y).expect_err("outside");
        assert_eq!(error, ExplainError::OutsidePixel { x, y, width: 320, height: 200 });
        assert!(error.to_string().contains("320 x 200"));
    }
    let error = explain::row(Renderer::new(), &scene, SCREEN, 200).expect_err("outside");
    assert_eq!(error, ExplainError::OutsideRow { y: 200, height: 200 });
    let none = Screen { width: 0, ..SCREEN };
    assert_eq!(explain::pixel(&mut Renderer::new(), &scene, none, 0, 0).expect_err("none"), ExplainError::Screen);
}

/// The shadings whose loop has a running sum, and the number of fraction bits in it.
const LOOPS: [(Interpolation, u32); 4] = [
    (Interpolation::Gouraud88, 8),
    (Interpolation::Gouraud88Reseeded, 8),
    (Interpolation::Gouraud1616, 16),
    (Interpolation::GouraudVintage, 8),
];

/// Checks the registers at each drawn pixel of a row of a triangle: from one to the next the loop adds, and it starts
/// again in a new row or after 64 pixels. `drawn` has the row's bytes.
fn check_row(triangle: &[Vertex; 3], (interpolation, bits): (Interpolation, u32), y: u32, drawn: &[Option<u8>]) {
    let mask = if bits == 8 { 0xFFFF } else { 0xFF_FFFF };
    let what = format!("row {y} by {interpolation:?}: {triangle:?}");
    let at = |x: u32| Registers::at(x, y, triangle, (interpolation, interpolation.has_exact_cover()), 320);
    let mut last: Option<Registers> = None;
    let mut column = 0;
    for (x, drawn) in (0..).zip(drawn) {
        let Some(byte) = drawn else {
            assert!(last.is_none_or(|last| last.cx == 1), "{what}: the last count is 1");
            last = None;
            continue;
        };
        let registers = at(x).expect("a sum");
        assert_eq!((registers.edi, (registers.eax >> bits) as u8), (320 * y + x, *byte), "{what}: column {x}");
        match last.filter(|last| last.cx > 1) {
            Some(last) => {
                let sum = last.eax.wrapping_add(last.ebx) & mask;
                let now = (registers.eax & mask, registers.ebx, registers.cx);
                assert_eq!(now, (sum, last.ebx, last.cx - 1), "{what}: column {x}");
            }
            None => assert!(column % 64 == 0, "{what}: the loop starts in column {x}"),
        }
        column += 1;
        last = Some(registers);
    }
    // Beside the row there is nothing.
    let first = drawn.iter().position(Option::is_some).and_then(|first| first.checked_sub(1));
    let after = drawn.iter().rposition(Option::is_some).map(|last| last + 1);
    assert!([first, after].into_iter().flatten().all(|x| at(x as u32).is_none()), "{what}");
}

#[test]
fn registers_are_those_of_a_loop_that_writes_what_the_raster_does() {
    let mut random = Random::named("registers");
    let mut tried = [0; 4];
    for _ in 0..400 {
        let triangle = triangles::triangle(&mut random, 320, 200);
        for ((interpolation, bits), tried) in LOOPS.into_iter().zip(&mut tried) {
            let drawn = triangles::drawn(|empty| triangles::draw(&triangle, interpolation, 320, 200, None, empty));
            for (y, row) in (0..).zip(drawn.chunks(320)) {
                check_row(&triangle, (interpolation, bits), y, row);
            }
            *tried += drawn.iter().flatten().count();
        }
    }
    assert!(tried.into_iter().all(|pixels| pixels > 100_000), "{tried:?}");
}

#[test]
fn what_keeps_no_sum_has_no_registers() {
    let mut random = Random::named("no registers");
    let mut tried = 0;
    for _ in 0..100 {
        let triangle = triangles::triangle(&mut random, 320, 200);
        let drawn = triangles::draw(&triangle, Interpolation::Flat(9), 320, 200, None, 0);
        let Some(place) = drawn.iter().position(|byte| *byte == 9) else { continue };
        for interpolation in [Interpolation::Flat(9), Interpolation::GouraudHyperbolic, Interpolation::GouraudFloat] {
            let (x, y) = (place as u32 % 320, place as u32 / 320);
            assert_eq!(Registers::at(x, y, &triangle, (interpolation, true), 320), None);
        }
        tried += 1;
    }
    assert!(tried > 5, "{tried}");
}

/// The level of a texel is the one that was chosen: over far and near rows of a floor it rises with distance, and an
/// image without levels has none.
#[test]
fn the_level_of_a_texel_is_named() {
    let scene = scenes::floor("bricks", 24.0);
    let level = |mipmaps: bool, y: u32| {
        let mut renderer = Renderer::new();
        renderer.settings.mipmaps = Some(mipmaps);
        let bytes = frame(&mut renderer, &scene);
        let pixel = explain(&mut renderer, &scene, 160, y);
        assert_eq!(pixel.byte, bytes[y as usize * 320 + 160]);
        let (_, seen) = pixel.front().expect("the floor");
        let text = pixel.to_string();
        seen.stages.iter().find_map(|stage| match *stage {
            PixelStage::Texture { level, .. } => {
                assert_eq!(text.contains(" of level "), level.is_some(), "{text}");
                Some(level)
            }
            _ => None,
        })
    };
    let rows = [100, 120, 150, 199];
    let levels = rows.map(|y| level(true, y).expect("it has a texture").expect("it has levels"));
    assert!(levels.is_sorted_by(|far, near| far >= near) && levels[0] > levels[3], "{levels:?}");
    assert_eq!(rows.map(|y| level(false, y)), [Some(None); 4]);
}
