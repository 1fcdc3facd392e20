//! Hidden surfaces: depth buffer against scan-line, byte for byte, on all input; painter's order and
//! back faces where they are right; depth order against exact rationals.

mod support;

use mode13h::fixed::U8F8;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::cover::Ordered;
use mode13h::raster::scan_line::{EdgePair, Lists, Scratch, ScratchError};
use mode13h::raster::shade::ShadePlane;
use mode13h::raster::{DepthBuffer, Drawn, Frame, Raster, Rect, Shading, Vertex};
use mode13h::render::{HiddenSurfaces, Renderer, Screen};
use mode13h::scene::{Object, Scene};
use mode13h::vga::Vga;
use support::oracle;
use support::random::Random;
use support::triangles::{triangle, vertex};
use support::tried::Tried;

type Face = ([Vertex; 3], Shading);

/// A frame, drawn into by one method; with what the raster counted.
#[derive(Clone, Copy)]
struct Sheet {
    width: u32,
    height: u32,
    clip: Rect,
    /// Rows of a band.
    rows_each: u32,
}

impl Sheet {
    const EMPTY: u8 = 3;

    fn new(width: u32, height: u32) -> Self {
        Self { width, height, clip: Rect { x0: 0, y0: 0, x1: width, y1: height }, rows_each: height }
    }

    fn draw(self, mut paint: impl FnMut(Raster<'_>) -> Drawn) -> (Vec<u8>, Drawn) {
        // Bytes between the rows, and after them, must stay.
        let pitch = self.width as usize + 3;
        let mut bytes = vec![Self::EMPTY; pitch * self.height as usize];
        let mut drawn = Drawn::default();
        let mut frame = Frame::new(&mut bytes, self.width, self.height, pitch).expect("legal");
        for band in frame.bands(self.rows_each) {
            drawn += paint(Raster::new(band).with_clip(self.clip));
        }
        for row in bytes.chunks(pitch) {
            assert_eq!(row[self.width as usize..], [Self::EMPTY; 3], "bytes between the rows stay");
        }
        (bytes, drawn)
    }

    fn depth_buffer(self, faces: &[Face]) -> (Vec<u8>, Drawn) {
        let mut depths: Vec<u32> = Vec::new();
        self.draw(|raster| in_turn(raster.with_cleared_depth(&mut depths), faces))
    }

    fn scan_line(self, lists: &mut Lists, faces: &[Face]) -> (Vec<u8>, Drawn) {
        self.draw(|mut raster| raster.scan_line(faces, lists.scratch(faces.len())).expect("room enough"))
    }
}

fn in_turn(mut raster: Raster<'_>, faces: &[Face]) -> Drawn {
    let mut drawn = Drawn::default();
    for (vertices, shading) in faces {
        drawn += raster.triangle(vertices, *shading);
    }
    drawn
}

/// Both methods, whole, clipped and in bands.
fn check(random: &mut Random, lists: &mut Lists, width: u32, height: u32, faces: &[Face]) {
    let whole = Sheet::new(width, height);
    let mut ends = |size: u32| {
        let (a, b) = (random.within(0, size.into()) as u32, random.within(0, size.into()) as u32);
        (a.min(b), a.max(b))
    };
    let ((x0, x1), (y0, y1)) = (ends(width), ends(height));
    let clip = Rect { x0, y0, x1, y1 };
    let rows_each = random.within(1, height.into()) as u32;
    for sheet in [whole, Sheet { clip, ..whole }, Sheet { rows_each, ..whole }, Sheet { clip, rows_each, ..whole }] {
        let (by_depth, depth_drawn) = sheet.depth_buffer(faces);
        let (by_line, line_drawn) = sheet.scan_line(lists, faces);
        if by_depth != by_line {
            let (sheet, faces) = shrink(sheet, lists, faces);
            let at =
                sheet.depth_buffer(&faces).0.iter().zip(&sheet.scan_line(lists, &faces).0).position(|(a, b)| a != b);
            panic!(
                "byte {at:?}, {} × {}, {:?}, bands of {}: {faces:?}",
                sheet.width, sheet.height, sheet.clip, sheet.rows_each
            );
        }
        assert_eq!(line_drawn.covered, depth_drawn.covered);
        // Each pixel once: those that the depth buffer holds something for.
        let mut depths: Vec<u32> = Vec::new();
        let mut shown = 0;
        sheet.draw(|raster| {
            let drawn = in_turn(raster.with_cleared_depth(&mut depths), faces);
            shown += depths.iter().filter(|depth| **depth > 0).count();
            drawn
        });
        assert_eq!(line_drawn.pixels as usize, shown, "each pixel is written once");
    }
}

/// The smallest case that still fails, by leaving out one face after another.
fn shrink(sheet: Sheet, lists: &mut Lists, faces: &[Face]) -> (Sheet, Vec<Face>) {
    let mut faces = faces.to_vec();
    let mut i = 0;
    while i < faces.len() {
        let mut fewer = faces.clone();
        fewer.remove(i);
        if sheet.depth_buffer(&fewer).0 == sheet.scan_line(lists, &fewer).0 {
            i += 1;
        } else {
            faces = fewer;
        }
    }
    (sheet, faces)
}

fn with_depths(vertices: [Vertex; 3], mut depth: impl FnMut() -> i64) -> [Vertex; 3] {
    vertices.map(|v| vertex(v.x().to_bits().into(), v.y().to_bits().into(), v.shade().to_bits().into(), depth()))
}

fn soups(at_least: u64) {
    let mut tried = Tried::new("d_soups", at_least);
    let mut random = Random::named("d soups");
    let mut lists = Lists::default();
    while tried.more() {
        let (width, height) = random.one_of(&[(96, 24), (200, 40), (17, 60), (320, 20), (1, 9), (70, 1)]);
        let mut faces: Vec<Face> = Vec::new();
        // Depths of all sizes; few and near to each other, so that many are equal; up to the greatest; one for all.
        let kind = random.within(0, 4);
        for _ in 0..random.log_uniform(7) {
            let mut vertices = triangle(&mut random, width.into(), height.into());
            match kind {
                0 => {}
                1 => vertices = with_depths(vertices, || random.within(0, 4)),
                2 => vertices = with_depths(vertices, || random.one_of(&[0, 1, 0xFFFF_FFFF, 0xFFFF_FFFE, 1 << 30])),
                3 => vertices = with_depths(vertices, || 1000 + random.log_uniform(5) as i64),
                _ => vertices = with_depths(vertices, || 7),
            }
            let shading =
                random.one_of(&[Shading::GouraudReseeded, Shading::Gouraud, Shading::Flat(0), Shading::Flat(200)]);
            faces.push((vertices, shading));
            if random.within(0, 5) == 0 {
                // Again, and turned round, in other shades.
                let [a, b, c] = vertices.map(|v| v.with_shade(U8F8::from_shade(77)));
                faces.push((random.one_of(&[[a, b, c], [c, b, a]]), shading));
            }
        }
        check(&mut random, &mut lists, width, height, &faces);
    }
}

#[test]
fn d_soups() {
    soups(1500);
}

#[test]
#[ignore = "the long run: 300,000 soups"]
fn d_long_soups() {
    soups(300_000);
}

#[test]
fn too_little_memory_is_refused_before_anything_is_drawn() {
    let face = ([vertex(0, 0, 0, 9), vertex(999, 0, 0, 9), vertex(0, 999, 0, 9)], Shading::Flat(1));
    let faces = [face; 4];
    for (list, pairs, room) in [(12, 3, 3), (11, 4, 3), (0, 9, 0)] {
        let (mut list, mut pairs) = (vec![0; list], vec![EdgePair::default(); pairs]);
        let (bytes, _) = Sheet::new(8, 8).draw(|mut raster| {
            let refused = raster.scan_line(&faces, Scratch::new(&mut list, &mut pairs));
            assert_eq!(refused, Err(ScratchError { faces: 4, room }));
            Drawn::default()
        });
        assert!(bytes.iter().all(|byte| *byte == Sheet::EMPTY));
    }
}

// Depth order against exact planes.

const WIDTH: u32 = 96;
const HEIGHT: u32 = 24;
const SHEET: (u32, u32) = (WIDTH, HEIGHT);

/// A corner: x and y in 1/256 pixel, and near / w in units of 10⁻⁸, from 10⁴ (far) to 10⁸ (near).
type Corner = (i64, i64, i64);
const NEAR: i64 = 100_000_000;
const FAR: i64 = 10_000;

fn face(corners: [Corner; 3], index: u8) -> Face {
    // round(2³⁰ · near / w).
    let depth = |m: i64| ((m << 31) + NEAR) / (2 * NEAR);
    (corners.map(|(x, y, m)| vertex(x, y, 0, depth(m))), Shading::Flat(index))
}

/// Draws the faces with indices 10, 11 … by depth buffer and by scan-line. Wherever a face's plane is in
/// front of another's by more than 2⁻¹⁴ of the greater, the other must not be seen. Returns how many
/// pairs that decided, and the picture.
fn check_order(lists: &mut Lists, corners: &[[Corner; 3]]) -> (u64, Vec<u8>) {
    let faces: Vec<Face> = corners.iter().zip(10..).map(|(corners, index)| face(*corners, index)).collect();
    let sheet = Sheet::new(SHEET.0, SHEET.1);
    let (picture, _) = sheet.depth_buffer(&faces);
    assert_eq!(sheet.scan_line(lists, &faces).0, picture, "{corners:?}");
    let mut decided = 0;
    for y in 0..HEIGHT as i32 {
        for x in 0..WIDTH as i32 {
            let centre = oracle::centre(x, y);
            let depth = |corners: &[Corner; 3]| {
                let points = corners.map(|(x, y, _)| (i128::from(x), i128::from(y)));
                oracle::covers(points, centre)
                    .then(|| oracle::interpolate(points, corners.map(|(_, _, m)| i128::from(m)), centre))
            };
            let seen = picture[y as usize * (WIDTH as usize + 3) + x as usize];
            let Some(seen) = corners.get(usize::from(seen).wrapping_sub(10)) else {
                assert!(corners.iter().all(|corners| depth(corners).is_none()), "({x}, {y}) of {corners:?}");
                continue;
            };
            let front = depth(seen).expect("a face is seen where it is");
            for other in corners.iter().filter_map(depth) {
                // Over the common denominator.
                let (front, other) = (front.n * other.d, other.n * front.d);
                let apart = (front - other).abs() << 14 > front.max(other);
                assert!(!apart || front > other, "({x}, {y}) of {corners:?}");
                decided += u64::from(apart);
            }
        }
    }
    (decided, picture)
}

fn flat_place(random: &mut Random) -> (i64, i64) {
    (random.within(-2000, i64::from(WIDTH) * 256 + 2000), random.within(-2000, i64::from(HEIGHT) * 256 + 2000))
}

/// From far to near, all sizes alike.
fn inverse_w(random: &mut Random) -> i64 {
    ((FAR as f64 * (NEAR as f64 / FAR as f64).powf(random.unit())) as i64).clamp(FAR, NEAR)
}

#[test]
fn c3_near_to_far_is_1_to_10_000() {
    let mut tried = Tried::new("c3_near_to_far_is_1_to_10_000", 400);
    let mut random = Random::named("c3");
    let mut lists = Lists::default();
    let mut decided = 0;
    while tried.more() {
        let mut corners = Vec::new();
        for _ in 0..3 {
            let triangle = [(); 3].map(|()| {
                let (x, y) = flat_place(&mut random);
                (x, y, inverse_w(&mut random))
            });
            corners.push(triangle);
            // The same again, hardly nearer or farther; twice the bound, and half of it.
            let share = random.one_of(&[1 << 10, 1 << 12, 1 << 13, 1 << 15]);
            let sign = random.one_of(&[1, -1]);
            corners.push(triangle.map(|(x, y, m)| (x, y, (m + sign * m / share).clamp(FAR / 2, NEAR))));
        }
        decided += check_order(&mut lists, &corners).0;
    }
    assert!(decided > 100_000, "{decided}");
}

/// Three long faces, each over the next at one end and under the third at the other.
fn circle(random: &mut Random) -> [[Corner; 3]; 3] {
    let (x, y) = (random.within(0, 4000), random.within(0, 300));
    let (far, near) = (random.within(FAR, 3 * FAR), random.within(40 * FAR, 300 * FAR));
    // The corners of a triangle; each face reaches from beyond one to beyond the next.
    let corners = [(6_000 + x, 300 + y), (16_000 + x, 2_500 + y), (5_000 + x, 5_300 + y)];
    [0, 1, 2].map(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let along = (to.0 - from.0, to.1 - from.1);
        let (start, end) = ((from.0 - along.0 / 3, from.1 - along.1 / 3), (to.0 + along.0 / 3, to.1 + along.1 / 3));
        let across = (-along.1 / 5, along.0 / 5);
        [
            (start.0 - across.0, start.1 - across.1, far),
            (start.0 + across.0, start.1 + across.1, far),
            (end.0, end.1, near),
        ]
    })
}

#[test]
fn d1_three_faces_in_a_circle() {
    let mut tried = Tried::new("d1_three_faces_in_a_circle", 100);
    let mut random = Random::named("d1");
    let mut lists = Lists::default();
    let mut decided = 0;
    while tried.more() {
        let mut corners = circle(&mut random);
        if random.within(0, 1) == 0 {
            corners.reverse();
        }
        let (pairs, right) = check_order(&mut lists, &corners);
        decided += pairs;
        // No order at all is right without a depth for every pixel.
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let faces = order.map(|i| face(corners[i], 10 + i as u8));
            let (painted, _) = Sheet::new(SHEET.0, SHEET.1).draw(|raster| in_turn(raster, &faces));
            assert_ne!(painted, right, "{order:?} of {corners:?}");
        }
    }
    assert!(decided > 1000, "{decided}");
}

/// A bar of which all coordinates are whole numbers, so that its sides are exactly plane.
fn bar(centre: [i32; 3], along: [i32; 3], across: [i32; 3]) -> Mesh {
    let thick = [0, 0, 1];
    let positions = (0..8)
        .map(|corner| {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 1 } else { -1 };
            let at = |i: usize| (centre[i] + sign(0) * along[i] + sign(1) * across[i] + sign(2) * thick[i]) as f32;
            mode13h::glam::Vec3::new(at(0), at(1), at(2))
        })
        .collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::new(positions, triangles).expect("a box");
    assert!(mesh.is_convex(), "a bar is convex");
    mesh
}

/// Three bars that overlap in a circle: each from behind the next, at one end, to before the third.
fn bars() -> Scene {
    let mut scene = Scene::new();
    for (centre, along, across) in [
        ([0, -5, 0], [12, 0, 6], [0, 2, 0]),
        ([4, 3, 0], [-6, 10, 6], [-2, -1, 0]),
        ([-4, 3, 0], [-6, -10, 6], [2, -1, 0]),
    ] {
        scene.add(Object::new(bar(centre, along, across)));
    }
    scene.camera = mode13h::scene::Camera::framing(mode13h::glam::Vec3::ZERO, 16.0);
    scene.add_light(mode13h::light::Light::sun([0.3, 0.7, 1.0]));
    scene
}

fn picture(scene: &Scene, way: Option<HiddenSurfaces>) -> (Vec<u8>, HiddenSurfaces) {
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    renderer.set_hidden_surfaces(way);
    let stats = renderer.draw(scene, &mut vga).expect("a legal scene");
    (vga.pixels().to_vec(), stats.hidden_surfaces)
}

fn by(scene: &Scene, way: HiddenSurfaces) -> Vec<u8> {
    let (picture, taken) = picture(scene, Some(way));
    assert_eq!(taken, way);
    picture
}

#[test]
fn d1_bars_in_a_circle_are_never_left_to_the_painter() {
    let mut tried = Tried::new("d1_bars_in_a_circle_are_never_left_to_the_painter", 72);
    let mut scene = bars();
    let mut wrong = 0;
    for degrees in (0..360).step_by(5) {
        for object in scene.objects_mut() {
            object.set_angles([0.0, 0.0, f64::from(degrees).to_radians()]);
        }
        let (chosen, way) = picture(&scene, None);
        assert_eq!(way, HiddenSurfaces::DepthBuffer);
        assert_eq!(by(&scene, HiddenSurfaces::ScanLine), chosen);
        wrong += u32::from(by(&scene, HiddenSurfaces::PainterOrder) != chosen);
        tried.add(1);
    }
    assert_eq!(wrong, 72, "painter's order is wrong in every one of them");
}

#[test]
fn d2_faces_that_pass_through_each_other() {
    let mut tried = Tried::new("d2_faces_that_pass_through_each_other", 300);
    let mut random = Random::named("d2");
    let mut lists = Lists::default();
    let mut both = 0;
    while tried.more() {
        let mut corners = Vec::new();
        // Two faces over nearly the same ground, near on one side the one, on the other the other.
        let ground = [(); 3].map(|()| flat_place(&mut random));
        let (a, b) = (inverse_w(&mut random), inverse_w(&mut random));
        for m in [[a, b, (a + b) / 2], [b, a, (a + b) / 2]] {
            corners.push([0, 1, 2].map(|i| {
                let (x, y) = ground[i];
                (x + random.within(-300, 300), y + random.within(-300, 300), m[i])
            }));
        }
        let (_, picture) = check_order(&mut lists, &corners);
        both += u32::from([10, 11].iter().all(|index| picture.contains(index)));
    }
    assert!(both > 100, "both faces are seen in {both} of them");
}

#[test]
fn d3_the_first_submitted_of_equals_wins() {
    let mut tried = Tried::new("d3_the_first_submitted_of_equals_wins", 600);
    let mut random = Random::named("d3");
    let mut lists = Lists::default();
    let sheet = Sheet::new(SHEET.0, SHEET.1);
    let mut pixels = 0;
    while tried.more() {
        let [a, b, c] = triangle(&mut random, WIDTH.into(), HEIGHT.into());
        // The same three vertices, and triangles of one constant depth.
        let constant = random.within(1, u32::MAX.into());
        let of_one_depth = |v: [Vertex; 3]| with_depths(v, || constant);
        let mut other = || of_one_depth(triangle(&mut random, WIDTH.into(), HEIGHT.into()));
        let constants = [other(), other(), other()];
        for triangles in [[[a, b, c], [c, a, b], [b, a, c]], constants] {
            let faces: Vec<Face> = triangles.iter().zip(10..).map(|(v, index)| (*v, Shading::Flat(index))).collect();
            // Drawn from the last to the first without any depth: the first is on top.
            let reversed: Vec<Face> = faces.iter().rev().copied().collect();
            let (right, _) = sheet.draw(|raster| in_turn(raster, &reversed));
            assert_eq!(sheet.depth_buffer(&faces).0, right, "{faces:?}");
            assert_eq!(sheet.scan_line(&mut lists, &faces).0, right, "{faces:?}");
            let (narrow, _) = sheet.draw(|raster| narrow_in_turn(raster, &faces));
            assert_eq!(narrow, right, "u16 cells, {faces:?}");
            pixels += right.iter().filter(|byte| **byte >= 10).count();
        }
        // Other faces in one plane: the depth is a whole number at every vertex, the same function of the
        // place. What wins there is rounding; it is the same in both.
        let (dx, dy) = (random.within(-9, 9), random.within(-9, 9));
        let soup: Vec<Face> = (0..6)
            .map(|index| {
                let v = triangle(&mut random, WIDTH.into(), HEIGHT.into()).map(|v| {
                    let (x, y) = (i64::from(v.x().to_bits()), i64::from(v.y().to_bits()));
                    vertex(x, y, 0, (1 << 26) + dx * x + dy * y)
                });
                (v, Shading::Flat(10 + index))
            })
            .collect();
        assert_eq!(sheet.depth_buffer(&soup).0, sheet.scan_line(&mut lists, &soup).0, "{soup:?}");
    }
    assert!(pixels > 10_000, "{pixels}");
}

/// With a u16 depth buffer.
fn narrow_in_turn(raster: Raster<'_>, faces: &[Face]) -> Drawn {
    let mut depths: Vec<u16> = Vec::new();
    let mut raster = raster.with_cleared_depth(&mut depths);
    let mut drawn = Drawn::default();
    for (vertices, shading) in faces {
        drawn += raster.triangle(vertices, *shading);
    }
    drawn
}

#[test]
fn d_u16_cells_hold_the_upper_bits_rounded_up() {
    let mut tried = Tried::new("d_u16_cells_hold_the_upper_bits_rounded_up", 500);
    let mut random = Random::named("d u16");
    let (width, height) = (WIDTH as i32, HEIGHT as i32);
    let mut ties = 0;
    while tried.more() {
        let near = random.one_of(&[1 << 14, 1 << 20, 1 << 30, u32::MAX.into()]);
        let faces: Vec<Face> = (0..8)
            .map(|_| {
                let vertices = triangle(&mut random, width.into(), height.into());
                (with_depths(vertices, || random.within(0, near)), Shading::GouraudReseeded)
            })
            .collect();
        let (mut bytes, mut cells) = (vec![0; (WIDTH * HEIGHT) as usize], vec![0_u128; (WIDTH * HEIGHT) as usize]);
        for (vertices, _) in &faces {
            for oracle::Pixel { x, y, byte } in oracle::gouraud(vertices, width, height, 64) {
                let place = (y * width + x) as usize;
                let cell = u128::from(oracle::depth_at(vertices, x, y)).div_ceil(16_384).min(65_535);
                if cell > cells[place] {
                    (cells[place], bytes[place]) = (cell, byte);
                } else {
                    ties += u32::from(cell == cells[place] && cell > 0);
                }
            }
        }
        let (mut drawn, mut depths) = (vec![0; bytes.len()], vec![9_u16; bytes.len()]);
        let frame = Frame::new(&mut drawn, WIDTH, HEIGHT, WIDTH as usize).expect("legal");
        let mut depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
        depth.clear();
        let mut raster = Raster::new(frame).with_depth(depth);
        for (vertices, shading) in &faces {
            raster.triangle(vertices, *shading);
        }
        assert_eq!(drawn, bytes, "{faces:?}");
        assert!(depths.iter().zip(&cells).all(|(is, should)| u128::from(*is) == *should), "{faces:?}");
    }
    assert!(ties > 1000, "{ties}");
}

// Scenes.

/// Of each pixel, how many triangles cover it, by the oracle.
fn covers(scene: &Scene) -> Vec<u32> {
    let (width, height) = (Vga::WIDTH as i32, Vga::HEIGHT as i32);
    let mut counts = vec![0; (width * height) as usize];
    let count = |vertices: &[Vertex; 3], _| {
        let points = vertices.each_ref().map(oracle::point);
        let range = |of: fn(&oracle::Point) -> i128, size: i32| {
            let (low, high) = points.iter().map(of).fold((i128::MAX, i128::MIN), |(l, h), c| (l.min(c), h.max(c)));
            (low >> 8).clamp(0, size.into()) as i32..((high >> 8) + 1).clamp(0, size.into()) as i32
        };
        for y in range(|p| p.1, height) {
            for x in range(|p| p.0, width) {
                counts[(y * width + x) as usize] += u32::from(oracle::covers(points, oracle::centre(x, y)));
            }
        }
    };
    Renderer::new().for_each_triangle(scene, Screen::MODE_13H, count).expect("a legal scene");
    counts
}

#[test]
fn d4_all_four_methods_on_convex_meshes() {
    let mut tried = Tried::new("d4_all_four_methods_on_convex_meshes", 4 * 30 + 3 * 60);
    let mut random = Random::named("d4");
    let (mut doubly, mut covered, mut differ) = (0, 0, 0);
    let shipped = ["cube", "sphere", "cylinder", "cone"].map(|name| (shapes::by_name(name).expect("listed"), 30));
    // So fine that faces near the outline turn over when they are rounded, and cover what others do.
    let fine = [shapes::sphere(128, 64), shapes::sphere(300, 20), shapes::cone(300, 1)].map(|mesh| (mesh, 60));
    for (mesh, poses) in shipped.into_iter().chain(fine) {
        for _ in 0..poses {
            let mut scene = Scene::showing(mesh.clone());
            let object = &mut scene.objects_mut()[0];
            object.scale = (0.01_f64.powf(random.unit())) as f32;
            object.set_angles([(); 3].map(|()| random.unit() * 6.3));
            object.position.x = random.unit() as f32;
            let counts = covers(&scene);
            let (first, way) = picture(&scene, None);
            assert_eq!(way, HiddenSurfaces::BackFaces, "it is convex");
            let others = [HiddenSurfaces::PainterOrder, HiddenSurfaces::DepthBuffer, HiddenSurfaces::ScanLine]
                .map(|way| by(&scene, way));
            assert_eq!(others[1], others[2], "depth buffer and scan-line agree everywhere");
            for (place, count) in counts.iter().enumerate() {
                covered += u32::from(*count > 0);
                doubly += u32::from(*count > 1);
                let same = others.iter().all(|other| other[place] == first[place]);
                differ += u32::from(!same);
                assert!(same || *count > 1, "pixel {place}");
            }
            tried.add(1);
        }
    }
    println!("d4: of {covered} pixels {doubly} are covered by two front faces, and {differ} differ");
    assert!(covered > 100_000, "{covered}");
}

/// Convex objects one behind the other, drawn far to near; what lies side by side is not.
#[test]
fn d4_painters_order_is_taken_for_convex_objects_that_are_apart() {
    let mut tried = Tried::new("d4_painters_order_is_taken_for_convex_objects_that_are_apart", 40);
    let mut random = Random::named("painter");
    let mut overlapping = 0;
    while tried.more() {
        let mut scene = Scene::new();
        scene.camera.field_of_view = 1.2;
        let eye = f64::from(scene.camera.eye.z);
        // No shape reaches farther than √3 from its middle. Some are cut by the near plane.
        let mut z = eye - random.unit() * 2.0;
        let mut objects = Vec::new();
        for _ in 0..random.within(2, 6) {
            let mut object =
                Object::new(shapes::by_name(random.one_of(&["cube", "sphere", "cylinder"])).expect("listed"));
            let scale = 0.2 + random.unit();
            let reach = scale * 1.7321;
            object.scale = scale as f32;
            object.set_angles([(); 3].map(|()| random.unit() * 6.3));
            z -= reach;
            object.position =
                mode13h::glam::Vec3::new(random.unit() as f32 - 0.5, random.unit() as f32 - 0.5, z as f32);
            z -= reach + 0.001 + random.unit();
            objects.insert(random.within(0, objects.len() as i64) as usize, object);
        }
        let mut once = vec![true; Vga::WIDTH * Vga::HEIGHT];
        let mut objects_at = vec![0; once.len()];
        for object in &objects {
            let mut alone = scene.clone();
            alone.add(object.clone());
            for (place, count) in covers(&alone).into_iter().enumerate() {
                once[place] &= count <= 1;
                objects_at[place] += u32::from(count > 0);
            }
        }
        for object in objects {
            scene.add(object);
        }
        overlapping += objects_at.iter().filter(|objects| **objects > 1).count();
        let (chosen, way) = picture(&scene, None);
        assert_eq!(way, HiddenSurfaces::PainterOrder);
        let by_depth = by(&scene, HiddenSurfaces::DepthBuffer);
        assert_eq!(by(&scene, HiddenSurfaces::ScanLine), by_depth);
        for (place, once) in once.iter().enumerate() {
            assert!(!once || chosen[place] == by_depth[place], "pixel {place}");
        }
        // Another in the depths of the last: no more.
        let mut beside = scene.objects()[0].clone();
        beside.position.x += 3.0;
        scene.add(beside);
        assert_eq!(picture(&scene, None).1, HiddenSurfaces::DepthBuffer);
    }
    assert!(overlapping > 10_000, "objects hide each other: {overlapping}");
}

#[test]
fn ways_are_typed_by_name() {
    for way in HiddenSurfaces::ALL {
        assert_eq!(way.name().parse(), Ok(way));
        assert_eq!(way.to_string(), way.name());
    }
    let error = "z-buffer".parse::<HiddenSurfaces>().expect_err("no such name").to_string();
    assert_eq!(error, "unknown way to hidden surfaces; there are back-faces, painter, depth-buffer, scan-line");
}

/// S1 says that the intensity has jumps at face borders (slip 5). With shared vertices it has not: along
/// the common edge the planes of both faces are within the rounding of a shade.
#[test]
fn n9_slip_5_two_faces_agree_along_their_edge() {
    let mut tried = Tried::new("n9_slip_5_two_faces_agree_along_their_edge", 3000);
    let mut random = Random::named("n9");
    let mut centres = 0;
    while tried.more() {
        // An edge through pixel centres: from one to another, and those on the way.
        let (parts, dx, dy) = (random.within(1, 12), random.within(-12, 12), random.within(-12, 12));
        let (x, y) = (random.within(0, 200), random.within(0, 100));
        let shade = |random: &mut Random| random.within(0, 0xFF00);
        let ends =
            [0, parts].map(|k| vertex((x + k * dx) * 256 + 128, (y + k * dy) * 256 + 128, shade(&mut random), 1));
        let sides = [1, -1].map(|side| {
            // On either side of the edge, anywhere.
            let (along, off) = (random.within(-20_000, 20_000), side * random.log_uniform(14) as i64);
            let third = vertex(
                x * 256 + along * dx / 12 - off * dy,
                y * 256 + along * dy / 12 + off * dx,
                shade(&mut random),
                1,
            );
            [ends[0], ends[1], third]
        });
        let [Some(one), Some(two)] = sides.map(|vertices| {
            let ordered = Ordered::new(&vertices);
            (ordered.doubled_area != 0).then(|| ShadePlane::new(&ordered))
        }) else {
            continue;
        };
        for k in 0..=parts {
            let (x, y) = ((x + k * dx) as i32, (y + k * dy) as i32);
            // Exactly, the two are equal; each start is rounded by less than 1/256 shade.
            let shades = ends.map(|v| i64::from(v.shade().to_bits()));
            let exact = (shades[0] * (parts - k) + shades[1] * k) as f64 / parts as f64 + 128.0;
            for start in [one.start(x, y), two.start(x, y)] {
                assert!((f64::from(start) - exact).abs() < 1.0, "{start} for {exact} at ({x}, {y}) of {sides:?}");
            }
            centres += 1;
        }
    }
    assert!(centres > 10_000, "{centres}");
}

/// `MODE13H_MODEL=model.obj cargo test --release --test hidden_surfaces a_model`: a full turn at 1°.
#[test]
fn a_model_of_your_own() {
    let Ok(path) = std::env::var("MODE13H_MODEL") else {
        println!("MODE13H_MODEL names no model: none tried");
        return;
    };
    #[cfg(feature = "obj")]
    {
        let mut tried = Tried::new("hidden_a_model_of_your_own", 360);
        let mut scene = Scene::showing(mode13h::mesh::obj::load(&path).expect("a model").mesh);
        for degrees in 0..360 {
            scene.objects_mut()[0].set_angles([0.2, f64::from(degrees).to_radians(), 0.0]);
            assert_eq!(by(&scene, HiddenSurfaces::DepthBuffer), by(&scene, HiddenSurfaces::ScanLine), "{degrees}°");
            tried.add(1);
        }
    }
}
