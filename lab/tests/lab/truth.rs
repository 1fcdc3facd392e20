//! The truth against pencil and paper: the eye at the origin looks along −z, and a unit at distance w is 32 / w pixels.

use std::f64::consts::{FRAC_PI_2, PI};

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::scene::{Camera, Object, Scene, UpAxis};
use mode13h_lab::truth::{Face, Screen, Standard, TruePixel, Truth, TruthError, TruthFrame};

/// A screen of square pixels.
fn screen(side: u32) -> Screen {
    Screen { width: side, height: side, pixel_aspect: (1, 1) }
}

fn camera(side: u32) -> Camera {
    let field_of_view = 2.0 * f64::atan(f64::from(side) / 64.0);
    // To the nearest f32: fx is 32 within 10⁻⁵.
    Camera {
        eye: Vec3::ZERO,
        target: Vec3::NEG_Z,
        up: Vec3::Y,
        field_of_view: Angle::from_radians((field_of_view as f32).into()),
        near: 1.0,
    }
}

/// A scene with one mesh in front of that camera that does not reflect ambient light.
fn scene(side: u32, mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    scene.camera = camera(side);
    let object = scene.add(Object::new(mesh));
    scene[object].materials[0] = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    scene
}

/// A square of side 2 at a distance, facing the eye.
fn square(w: f32) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    mesh(corners.map(|[x, y]| ([x, y, -w], [0.0, 0.0, 1.0])).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

fn mesh(corners: Vec<([f32; 3], [f32; 3])>, triangles: Vec<[u32; 3]>) -> Mesh {
    let (positions, normals) = corners.into_iter().map(|(p, n)| (Vec3::from(p), Vec3::from(n))).unzip();
    Mesh::with_normals(positions, normals, triangles).expect("a mesh")
}

fn draw(scene: &Scene, side: u32, standard: Standard) -> TruthFrame {
    Truth::new(scene, screen(side)).expect("a legal scene").draw(standard)
}

fn at(frame: &TruthFrame, x: u32, y: u32) -> TruePixel {
    *frame.at(x, y).unwrap_or_else(|| panic!("nothing at ({x}, {y})"))
}

/// Numbers come from f32, which has seven digits.
#[track_caller]
fn assert_close(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 1e-5, "{actual}, by hand {expected}");
}

#[test]
fn a_square_straight_before_the_eye() {
    let mut scene = scene(64, square(4.0));
    // Its edges are 8 pixels from the centre.
    scene.add_light(Light::sun([0.0, 3.0, 4.0]).with_intensity(0.5));
    scene.objects_mut()[0].materials[0].ambient = 0.1;
    for standard in Standard::ALL {
        let frame = draw(&scene, 64, standard);
        for y in 0..64 {
            for x in 0..64 {
                let inside = (24..40).contains(&x) && (24..40).contains(&y);
                assert_eq!(frame.at(x, y).is_some(), inside, "{standard}: ({x}, {y})");
                if let Some(pixel) = frame.at(x, y) {
                    assert_close(pixel.w, 4.0);
                    // 0.1 + 0.5 · 4/5.
                    pixel.intensity.iter().for_each(|&i| assert_close(i, 0.5));
                    assert_eq!(pixel.face.object, 0);
                    // The diagonal runs up to the right: it is the left edge of the lower right triangle.
                    let below = x + y >= 63;
                    assert_eq!(pixel.face.triangle, usize::from(!below), "{standard}: ({x}, {y})");
                }
            }
        }
        assert!(frame.at(64, 30).is_none() && frame.at(30, 64).is_none(), "outside of the frame");
    }
}

#[test]
fn centres_on_edges_belong_to_top_and_left_edges() {
    // With 65 pixels the centre is a pixel's centre, and so are the corners, 8 pixels from it.
    let frame = draw(&scene(65, square(4.0)), 65, Standard::Gouraud);
    for y in 0..65 {
        for x in 0..65 {
            let inside = (24..40).contains(&x) && (24..40).contains(&y);
            assert_eq!(frame.at(x, y).is_some(), inside, "({x}, {y})");
        }
    }
}

#[test]
fn vertices_are_rounded_to_the_nearest_unit() {
    // 8.0008 and 8.0024 pixels from the centre: 2,048.2 and 2,048.6 units.
    for (x, units) in [(1.0, 2_048), (1.0001, 2_048), (1.0003, 2_049)] {
        let corners = [[-x, -1.0, -4.0], [x, -1.0, -4.0], [0.0, x, -4.0]];
        let scene = scene(64, mesh(corners.map(|p| (p, [0.0, 0.0, 1.0])).to_vec(), vec![[0, 1, 2]]));
        let truth = Truth::new(&scene, screen(64)).expect("a legal scene");
        let triangles = truth.rounded_triangles(Face { object: 0, triangle: 0 });
        let (low, high) = (8_192 - units, 8_192 + units);
        assert_eq!(triangles, [[[low, 8_192 + 2_048], [high, 8_192 + 2_048], [8_192, low]]]);
        for (object, triangle) in [(0, 1), (1, 0)] {
            assert!(truth.rounded_triangles(Face { object, triangle }).is_empty(), "there is no such face");
        }
    }
}

#[test]
fn a_lamp_falls_off_and_shines_aslant() {
    let mut scene = scene(65, square(4.0));
    scene.add_light(Light::lamp([0.0, 0.0, -2.0], 4.0));
    // Below the lamp, at half its range: (1 − 4/16)².
    assert_close(at(&draw(&scene, 65, Standard::Lit), 32, 32).intensity[0], 0.5625);
    // One unit to the right the distance squared is 5, and the cosine is 2/√5.
    let right =
        Truth::new(&scene, screen(65)).expect("a legal scene").sampling(Face { object: 0, triangle: 0 }, 40.4999, 32.5);
    assert_close(right.expect("it is met").intensity[0], 2.0 / f64::sqrt(5.0) * (11.0 / 16.0) * (11.0 / 16.0));
    // At all four corners: 6, and 2/√6.
    let corner = 2.0 / f64::sqrt(6.0) * (10.0 / 16.0) * (10.0 / 16.0);
    for standard in [Standard::Gouraud, Standard::GouraudPerspective, Standard::GouraudUnrounded] {
        assert_close(at(&draw(&scene, 65, standard), 32, 32).intensity[0], corner);
    }
    // Out of range, behind the square, and in its plane, it lights nothing.
    for place in [[0.0, 0.0, 0.0], [0.0, 0.0, -5.0], [0.0, 0.0, -4.0]] {
        scene.lights_mut()[0] = Light::lamp(place, 4.0);
        assert_close(at(&draw(&scene, 65, Standard::Lit), 32, 32).intensity[0], 0.0);
    }
}

#[test]
fn a_highlight_straight_ahead() {
    let mut scene = scene(64, square(4.0));
    scene.add_light(Light::sun([0.0, 0.0, 2.0]));
    let shiny = Material { ambient: 0.0, diffuse: 0.0, specular: 0.5, shininess: 4.0, ..Material::default() };
    scene.objects_mut()[0].materials[0] = shiny;
    // The ray through the pixel to the right of and below the centre is at ±1/16, and its squared cosine to the normal
    // is 16 / (16 + 2/256).
    let squared = 2048.0 / 2049.0;
    assert_close(at(&draw(&scene, 64, Standard::Lit), 32, 32).intensity[0], 0.5 * squared * squared);
    // At a corner 16 / 18.
    let corner = 0.5 * (16.0 / 18.0) * (16.0 / 18.0);
    assert_close(at(&draw(&scene, 64, Standard::Gouraud), 32, 32).intensity[0], corner);
    // l = (0, 0.6, 0.8) is mirrored to r = (0, −0.6, 0.8). From (0, 1, −4) the eye is at v = (0, −1, 4) / √17.
    scene.lights_mut()[0] = Light::sun([0.0, 3.0, 4.0]);
    let along = (0.6 + 3.2) / f64::sqrt(17.0);
    let truth = Truth::new(&scene, screen(64)).expect("a legal scene");
    let top = truth.sampling(Face { object: 0, triangle: 1 }, 31.9999, 24.0001).expect("it is met");
    assert!((top.intensity[0] - 0.5 * along.powi(4)).abs() < 1e-4, "{top:?}");
    // A shininess of 0 gives no highlight, and one just above 0 gives full strength wherever there is any.
    for (shininess, expected) in [(0.0, 0.0), (1e-30, 0.5)] {
        scene.objects_mut()[0].materials[0].shininess = shininess;
        assert_close(at(&draw(&scene, 64, Standard::Lit), 32, 32).intensity[0], expected);
    }
}

/// A wall from w = 2 at the left to w = 6 at the right, 32 pixels wide, with cosines of 0.28 and 0.6.
fn tilted() -> Scene {
    let (left, right) = ([0.96, 0.0, 0.28], [0.8, 0.0, 0.6]);
    let corners = vec![
        ([-1.0, -0.5, -2.0], left),
        ([3.0, -1.5, -6.0], right),
        ([3.0, 1.5, -6.0], right),
        ([-1.0, 0.5, -2.0], left),
    ];
    let mut scene = scene(65, mesh(corners, vec![[0, 1, 2], [0, 2, 3]]));
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene
}

#[test]
fn the_middle_of_a_tilted_wall() {
    let scene = tilted();
    // Half-way on the screen, 1/w is (1/2 + 1/6) / 2; on the wall that is a quarter of the way.
    let normal = [0.75 * 0.96 + 0.25 * 0.8, 0.75 * 0.28 + 0.25 * 0.6];
    for (standard, intensity) in [
        (Standard::Gouraud, 0.44),
        (Standard::GouraudPerspective, 0.36),
        (Standard::GouraudUnrounded, 0.44),
        (Standard::Lit, normal[1] / f64::hypot(normal[0], normal[1])),
    ] {
        let middle = at(&draw(&scene, 65, standard), 32, 32);
        assert_close(middle.w, 3.0);
        assert_close(middle.intensity[0], intensity);
    }
}

/// A floor 1 below the eye, from w = 4, where it is fully lit, to w = −4, where it is lit at 0.6.
fn floor() -> Scene {
    let corners = vec![
        ([-4.0, -1.0, -4.0], [0.0, 1.0, 0.0]),
        ([0.0, -1.0, 4.0], [0.0, 0.6, 0.8]),
        ([4.0, -1.0, -4.0], [0.0, 1.0, 0.0]),
    ];
    let mut scene = scene(64, mesh(corners, vec![[0, 1, 2]]));
    scene.add_light(Light::sun([0.0, 1.0, 0.0]));
    scene
}

#[test]
fn a_face_that_runs_under_the_eye() {
    let scene = floor();
    let frames = Standard::ALL.map(|standard| draw(&scene, 64, standard));
    // At row 32 + 32/w; the far edge is row 40, the near plane the last.
    for row in 0..64 {
        assert!(frames.iter().all(|frame| frame.at(32, row).is_some() == (row >= 40)), "row {row}");
    }
    for row in [40, 51, 63] {
        let down = f64::from(row) + 0.5 - 32.0;
        let w = 32.0 / down;
        // From w = 4 to w = −4, clipped at w = 1, which is 3/8 of the way.
        let on_face = 1.0 - 0.4 * (4.0 - w) / 8.0;
        let cut = 1.0 - 0.4 * 3.0 / 8.0;
        // From 8 rows below the centre to 32.
        let on_screen = 1.0 + (cut - 1.0) * (down - 8.0) / 24.0;
        let t = (4.0 - w) / 8.0;
        let normal = [1.0 - 0.4 * t, 0.8 * t];
        let lit = normal[0] / f64::hypot(normal[0], normal[1]);
        for (frame, intensity) in frames.iter().zip([on_screen, on_face, on_screen, lit]) {
            assert_close(at(frame, 32, row).w, w);
            assert_close(at(frame, 32, row).intensity[0], intensity);
        }
    }
}

#[test]
fn the_nearest_face_is_seen_and_of_equal_ones_the_first() {
    for standard in Standard::ALL {
        for (first, second, seen) in [(4.0, 3.0, 1), (3.0, 4.0, 0), (4.0, 4.0, 0)] {
            let mut scene = scene(64, square(first));
            scene.add(Object::new(square(second)));
            let pixel = at(&draw(&scene, 64, standard), 30, 30);
            assert_eq!(pixel.face.object, seen, "{standard}: {first} before {second}");
            assert_close(pixel.w, f64::from(first.min(second)));
        }
    }
}

#[test]
fn backs_of_open_meshes_are_seen_from_their_side() {
    for standard in Standard::ALL {
        // Rotated by half a turn about y through the centre of the square.
        let mut scene = scene(64, square(4.0));
        scene.objects_mut()[0].pivot = Vec3::new(0.0, 0.0, -4.0);
        scene.objects_mut()[0].position = Vec3::new(0.0, 0.0, -4.0);
        scene.objects_mut()[0].angles = [0.0, PI, 0.0].map(Angle::from_radians);
        scene.add_light(Light::sun([0.0, 3.0, 4.0]));
        assert_close(at(&draw(&scene, 64, standard), 30, 30).intensity[0], 0.8);
        scene.lights_mut()[0] = Light::sun([0.0, 3.0, -4.0]);
        assert_close(at(&draw(&scene, 64, standard), 30, 30).intensity[0], 0.0);
        // A closed mesh has no visible backs, so nothing is seen from inside.
        let mut scene = self::scene(64, shapes::sphere(12, 6));
        scene.objects_mut()[0].scale = 50.0;
        assert!(draw(&scene, 64, standard).pixels.iter().all(Option::is_none));
    }
}

#[test]
fn turns_and_axes() {
    // Position of a triangle's corner (1, 2, 3) after a change.
    let corner = |change: fn(&mut Object)| {
        let points = [[0.3, -0.7, 0.2], [1.0, 0.5, -1.5], [1.0, 2.0, 3.0]].map(|p| (p, [0.0, 0.0, 1.0]));
        let mut scene = scene(64, mesh(points.to_vec(), vec![[0, 1, 2]]));
        scene.objects_mut()[0].position = Vec3::new(0.0, 0.0, -16.0);
        change(&mut scene.objects_mut()[0]);
        let truth = Truth::new(&scene, screen(64)).expect("a legal scene");
        truth.rounded_triangles(Face { object: 0, triangle: 0 })[0][2]
    };
    // 32 pixels per unit at w = 1, and 256 units per pixel.
    let units = |x: f64, y: f64, z: f64| [x, -y].map(|c| (256.0 * (32.0 + 32.0 * c / (16.0 - z))).round() as i64);
    assert_eq!(corner(|_| ()), units(1.0, 2.0, 3.0));
    assert_eq!(corner(|object| object.scale = 2.0), units(2.0, 4.0, 6.0));
    assert_eq!(corner(|object| object.pivot = Vec3::new(1.0, 0.0, 0.0)), units(0.0, 2.0, 3.0));
    assert_eq!(corner(|object| object.angles = [FRAC_PI_2, 0.0, 0.0].map(Angle::from_radians)), units(1.0, -3.0, 2.0));
    assert_eq!(corner(|object| object.angles = [0.0, FRAC_PI_2, 0.0].map(Angle::from_radians)), units(3.0, 2.0, -1.0));
    assert_eq!(corner(|object| object.angles = [0.0, 0.0, FRAC_PI_2].map(Angle::from_radians)), units(-2.0, 1.0, 3.0));
    // About z first: (−2, 1, 3); then about y: (3, 1, 2); then about x: (3, −2, 1).
    assert_eq!(corner(|object| object.angles = [FRAC_PI_2; 3].map(Angle::from_radians)), units(3.0, -2.0, 1.0));
    assert_eq!(corner(|object| object.up_axis = UpAxis::Z), units(1.0, 3.0, -2.0));
}

#[test]
fn channels_and_the_one_channel() {
    let mut scene = scene(64, square(4.0));
    scene.add_light(Light::sun([0.0, 0.0, 1.0]).with_color([1.0, 0.5, 0.0]).with_intensity(0.8));
    scene.add_light(Light::sun([0.0, 3.0, 4.0]).with_intensity(0.25));
    scene.objects_mut()[0].materials[0].color = [0.5, 1.0, 1.0];
    for standard in Standard::ALL {
        let [red, green, blue] = at(&draw(&scene, 64, standard), 30, 30).intensity;
        assert_close(red, 0.5 * (0.8 + 0.25 * 0.8));
        assert_close(green, 0.4 + 0.25 * 0.8);
        assert_close(blue, 0.25 * 0.8);
    }
    // A coloured light that is off leaves one channel, on which a grey material's own colour does not count. The sum is
    // clamped, not its parts: 3 − 2.5.
    scene.objects_mut()[0].materials[0].color = [0.5; 3];
    scene.lights_mut()[0] = Light::sun([0.0, 0.0, 1.0]).with_color([1.0, 0.5, 0.0]).with_intensity(0.0);
    scene.lights_mut()[1] = Light::sun([0.0, 0.0, 1.0]).with_intensity(3.0);
    assert_eq!(at(&draw(&scene, 64, Standard::Lit), 30, 30).intensity, [1.0; 3]);
    scene.add_light(Light::sun([0.0, 0.0, 1.0]).with_intensity(-2.5));
    at(&draw(&scene, 64, Standard::Lit), 30, 30).intensity.iter().for_each(|&i| assert_close(i, 0.5));
}

#[test]
fn what_is_wrong_is_refused() {
    let new = |scene: &Scene| Truth::new(scene, Screen::MODE_13H).map(|_| ());
    let mut scene = tilted();
    assert_eq!(new(&scene), Ok(()));
    scene.ambient = f32::NAN;
    assert_eq!(new(&scene), Err(TruthError::Ambient));
    let mut scene = tilted();
    scene.camera.target = scene.camera.eye;
    assert!(new(&scene).expect_err("it looks nowhere").to_string().starts_with("camera: "));
    let mut scene = tilted();
    scene.objects_mut()[0].scale = f32::INFINITY;
    assert!(matches!(new(&scene), Err(TruthError::Object { index: 0, .. })));
    let mut scene = tilted();
    scene.lights_mut()[0] = Light::sun([0.0; 3]);
    assert!(matches!(new(&scene), Err(TruthError::Light { index: 0, .. })));
    let scene = tilted();
    for (width, height, pixel_aspect) in [(4097, 1, (1, 1)), (1, u32::MAX, (1, 1)), (8, 8, (0, 1)), (8, 8, (1, 0))] {
        let refused = Truth::new(&scene, Screen { width, height, pixel_aspect });
        assert!(matches!(refused, Err(TruthError::Screen(_))), "{width} {height}");
    }
}
