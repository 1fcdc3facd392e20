//! Light, background and framing for a model that has none.

use std::collections::BTreeSet;

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::Rgb;
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Object, Scene, Shared, UpAxis};
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::auto_palette;
use mode13h_assets::model::{studio, with_textures};

use crate::support::tried::Tried;

const WIDTH: usize = 320;
const HEIGHT: usize = 200;
/// The edges of nine tenths of the picture: first and last column, first and last row.
const FRAME: [usize; 4] = [16, 303, 10, 189];

/// A model in the studio, in the colours that a model file gets.
fn shown(object: Object, up: Option<UpAxis>) -> Scene {
    colored(studio(object, up).expect("a model"))
}

fn colored(mut scene: Scene) -> Scene {
    if scene.objects()[0].has_colors() {
        auto_palette::of_scene(&scene).expect("a scene").apply(&mut scene);
    }
    scene
}

/// The mesh in a single material with this Kd.
fn of_color(mesh: Mesh, diffuse: [f32; 3]) -> Object {
    let faces = mesh.triangles().len();
    Object::new(mesh.with_surfaces(vec![Surface { diffuse, ..Surface::default() }], vec![0; faces]).expect("a surface"))
}

/// A square of side 2 that faces along z.
fn sheet() -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let positions = corners.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
    let texcoords = corners.iter().map(|[x, y]| Vec2::new(*x, *y) * 0.5 + 0.5).collect();
    Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh").with_texcoords(texcoords).expect("as many")
}

/// A box around the origin.
fn block(size: [f32; 3]) -> Mesh {
    let cube = shapes::cube();
    let reach = cube.positions().iter().fold(Vec3::ZERO, |most, p| most.max(p.abs()));
    let positions = cube.positions().iter().map(|&p| p / reach * Vec3::from_array(size) / 2.0).collect();
    Mesh::new(positions, cube.triangles().to_vec()).expect("a mesh")
}

/// The colour of each pixel of a frame; `None` where the background is visible. Drawn over two backgrounds: a pixel
/// that shows both is not covered.
fn pixels(scene: &Scene) -> Vec<Option<Rgb>> {
    let (mut scene, mut renderer) = (scene.clone(), Renderer::new());
    let mut draw = |background: u8| {
        let mut vga = Vga::new();
        scene.background = background;
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        let palette = vga.palette();
        (vga.pixels().to_vec(), palette)
    };
    let (first, palette) = draw(0);
    let (second, _) = draw(255);
    let color = |(a, b): (u8, u8)| (!(a == 0 && b == 255)).then(|| palette[a]);
    first.into_iter().zip(second).map(color).collect()
}

/// First and last covered column, first and last covered row.
fn reach(pixels: &[Option<Rgb>]) -> [usize; 4] {
    let covered = || pixels.iter().enumerate().filter(|(_, pixel)| pixel.is_some()).map(|(i, _)| i);
    let [columns, rows] =
        [covered().map(|i| i % WIDTH).collect(), covered().map(|i| i / WIDTH).collect::<BTreeSet<_>>()];
    [columns.first(), columns.last(), rows.first(), rows.last()].map(|edge| *edge.expect("something is covered"))
}

fn medians(pixels: &[Option<Rgb>]) -> [f64; 3] {
    [|c: Rgb| c.r, |c: Rgb| c.g, |c: Rgb| c.b].map(|channel| {
        let mut values: Vec<u8> = pixels.iter().flatten().map(|color| channel(*color)).collect();
        values.sort_unstable();
        f64::from(values[values.len() / 2])
    })
}

/// The light on a surface that faces the eye: 2/5 is ambient, 3/5 comes from a key and a fill light at right angles,
/// four to one, which add up to 1 where their sum is greatest.
fn front() -> f64 {
    let unit = |[x, y, z]: [f64; 3]| z / (x * x + y * y + z * z).sqrt();
    let (key, fill) = (unit([0.4, 0.6, 1.0]), unit([-1.0, 0.0, 0.4]));
    0.4 + 0.6 * (key + 0.25 * fill) / (1.0_f64 + 0.25 * 0.25).sqrt()
}

/// A square that faces the eye is Kd times the light there; with an image it is the image in that light, whatever grey
/// Kd an exporter put beside it.
///
/// The shade is rounded down to an entry of a ramp or a level of a texture's table, and colours to the card's 64
/// levels, half a level each: with a ramp of all 254 entries, or a table of 64 levels, a step is at most 4. That makes
/// 4 + 2 + 2.
#[test]
fn a_surface_that_faces_the_eye_shows_its_colour() {
    const OFF: f64 = 8.0;
    let mut tried = Tried::new("a_surface_that_faces_the_eye_shows_its_colour", 6);
    let yellow = Shared::new(Texture::plain(Rgb::new(255, 216, 0)));
    for (diffuse, image, expected) in [
        ([0.64; 3], None, [0.64 * 255.0; 3]),
        ([1.0; 3], None, [255.0; 3]),
        ([0.64, 0.2, 0.0], None, [0.64 * 255.0, 0.2 * 255.0, 0.0]),
        ([0.64; 3], Some(&yellow), [255.0, 216.0, 0.0]),
        ([0.1; 3], Some(&yellow), [255.0, 216.0, 0.0]),
        ([0.0; 3], Some(&yellow), [255.0, 216.0, 0.0]),
    ] {
        let object = with_textures(of_color(sheet(), diffuse), &[image.map(Shared::clone)]);
        let mut scene = studio(object, Some(UpAxis::Y)).expect("a model");
        scene.objects_mut()[0].angles = [Angle::default(); 3];
        scene.motions.clear();
        let medians = medians(&pixels(&colored(scene)));
        for (median, expected) in medians.into_iter().zip(expected) {
            let off = (median - expected * front()).abs();
            assert!(off <= OFF, "{diffuse:?}, {image:?}: {medians:?} for {expected}");
            tried.worst("shades off", off);
        }
        tried.add(1);
    }
    // A ball shows its colour over most of its visible area. From far away the median of the light over its disc is
    // 0.81, summed on a grid; from nearby less of the dark rim is visible.
    let [median, ..] = medians(&pixels(&shown(of_color(shapes::sphere(64, 32), [0.64; 3]), None)));
    assert!((0.81 * 0.64 * 255.0 - OFF..=0.64 * 255.0).contains(&median), "{median}");
}

/// Two images keep the ratio of their Kd, and objects without an image keep their own.
#[test]
fn images_are_exposed_together() {
    let mesh = sheet()
        .with_surfaces([0.32, 0.64].map(|kd| Surface { diffuse: [kd; 3], ..Surface::default() }).into(), vec![0, 1]);
    let white = || Some(Shared::new(Texture::plain(Rgb::WHITE)));
    let full = |images: &[Option<Shared<Texture>>]| {
        let object = with_textures(Object::new(mesh.clone().expect("two surfaces")), images);
        let scene = studio(object, None).expect("a model");
        let full: Vec<f32> = scene.objects()[0].materials.iter().map(|m| m.ambient + m.diffuse).collect();
        [full[0], full[1]]
    };
    let near = |a: [f32; 2], b: [f32; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near(full(&[white(), white()]), [0.5, 1.0]));
    assert!(near(full(&[white(), None]), [1.0, 0.64]));
    assert!(near(full(&[None, None]), [0.32, 0.64]));
}

/// Black and white, in a palette of greys and in one that has a blue, stand out from the background at any moment: by
/// 80 in the RGB cube, minus the next of the card's 64 levels, 4 on each channel, to which a ramp may round a shade.
#[test]
fn black_and_white_stand_out_from_the_background() {
    let mut tried = Tried::new("black_and_white_stand_out_from_the_background", 5 * 12);
    let ball = shapes::sphere(32, 16);
    let halves = |colors: [[f32; 3]; 2]| {
        let surfaces = colors.map(|diffuse| Surface { diffuse, ..Surface::default() }).into();
        let numbers = (0..ball.triangles().len()).map(|i| (i % 2) as u16).collect();
        Object::new(ball.clone().with_surfaces(surfaces, numbers).expect("two surfaces"))
    };
    let board = Texture::from_rgb(2, 2, &[Rgb::BLACK, Rgb::WHITE, Rgb::WHITE, Rgb::BLACK]).expect("an image");
    for (what, object) in [
        ("black", of_color(ball.clone(), [0.0; 3])),
        ("white", of_color(ball.clone(), [1.0; 3])),
        ("both", halves([[0.0; 3], [1.0; 3]])),
        ("a dark red and white", halves([[0.1, 0.0, 0.0], [1.0; 3]])),
        ("an image", with_textures(of_color(ball.clone(), [1.0; 3]), &[Some(Shared::new(board))])),
    ] {
        let mut scene = shown(object, None);
        let palette = scene.palette.clone().expect("a palette");
        let background = palette[scene.background];
        for step in 0..12 {
            scene.set_time(scene.duration * f64::from(step) / 12.0);
            for color in pixels(&scene).into_iter().flatten().collect::<BTreeSet<_>>() {
                let distance = f64::from(color.distance_squared(background)).sqrt();
                assert!(distance >= 80.0 - 4.0 * 3.0_f64.sqrt(), "{what}: {color:?} on {background:?}");
            }
            tried.add(1);
        }
    }
}

/// A sheet that faces along z, like terrain with z up, is laid on its back, and is visible at any moment of its turn.
///
/// A piece dA of a plane at distance n from the eye covers f·dA·n / z³ of the picture, where f is the product of both
/// focal lengths and z its depth: at least the square's area times that at its far corner. Pixel centres miss half a
/// pixel along the outline, which is at most as long as the picture's.
#[test]
fn a_sheet_on_its_back_is_seen_from_all_sides() {
    for mesh in [sheet(), flipped(sheet())] {
        let mut scene = shown(of_color(mesh, [0.8; 3]), None);
        assert_eq!(scene.objects()[0].up_axis, UpAxis::Z);
        let Camera { eye, field_of_view, .. } = scene.camera;
        let (sine, cosine) = scene.objects()[0].angles[0].to_radians().sin_cos();
        let half = (field_of_view.to_radians() / 2.0).tan();
        let focal = (100.0 / half) * (160.0 / (half * 4.0 / 3.0));
        let from_plane = f64::from(eye.z) * sine + f64::from(eye.y) * cosine;
        let depth = f64::from(eye.z) + 2.0_f64.sqrt() * cosine;
        let least = focal * 4.0 * from_plane / depth.powi(3) - (WIDTH + HEIGHT) as f64;
        assert!(least > (WIDTH * HEIGHT) as f64 / 8.0, "{least}");
        for step in 0..24 {
            scene.set_time(scene.duration * f64::from(step) / 24.0);
            let covered = pixels(&scene).iter().flatten().count() as f64;
            assert!(covered >= least, "{step}: {covered} of {least}");
        }
    }
    // A closed model, or one that faces elsewhere, stays upright; and explicit requests are honoured.
    for mesh in [block([2.0, 2.0, 0.1]), shapes::wall(1, 1), shapes::teapot(4)] {
        let is_sheet = mesh.triangles().len() == 2;
        let up = studio(Object::new(mesh), None).expect("a model").objects()[0].up_axis;
        assert_eq!(up, if is_sheet { UpAxis::Z } else { UpAxis::Y });
    }
    assert_eq!(shown(of_color(sheet(), [0.8; 3]), Some(UpAxis::Y)).objects()[0].up_axis, UpAxis::Y);
}

/// A sheet that faces along x shows its front first, and is not seen edge-on.
#[test]
fn a_sheet_that_looks_sideways_shows_its_front() {
    // A permutation of the axes, so the front stays the front: it faces along x.
    let sheet = sheet();
    let positions = sheet.positions().iter().map(|p| Vec3::new(p.z, p.x, p.y)).collect();
    let sideways = Mesh::new(positions, sheet.triangles().to_vec()).expect("a mesh");
    for (mesh, front) in [(sideways.clone(), Vec3::X), (flipped(sideways), -Vec3::X)] {
        let scene = studio(Object::new(mesh), None).expect("a model");
        let object = &scene.objects()[0];
        // Apart from the tilt it faces the eye.
        let Vec3 { x, z, .. } = object.rotation() * front;
        assert!(x.abs() < 1e-6 && z > 0.0, "{front}: {x} {z}");
        let covered = pixels(&scene).iter().flatten().count();
        assert!(covered > WIDTH * HEIGHT / 4, "{front}: {covered}");
    }
}

/// The mesh with its other side out.
fn flipped(mesh: Mesh) -> Mesh {
    let triangles = mesh.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Mesh::new(mesh.positions().to_vec(), triangles).expect("a mesh")
}

/// Over a turn a model reaches the frame of nine tenths on both sides, or above and below, and never exceeds it; a low
/// one on both sides. A model that does not move does so in its picture.
///
/// The hull at 72 angles may fall short of its farthest by 1 − cos(π / 72) of 144 pixels, 0.14; a pixel is covered
/// where its centre is. So the outermost column is the frame's or the next one inward. If the frame runs through a
/// centre, f32 rounding may make it the next one outward.
#[test]
fn a_model_fills_the_picture_and_is_in_its_middle() {
    let mut tried = Tried::new("a_model_fills_the_picture_and_is_in_its_middle", 6 * 72);
    let within_one = |a: usize, b: usize| a.abs_diff(b) <= 1;
    // Whether it is in the middle, and whether it fills the width and the height.
    let is_centred = |at: [usize; 4]| within_one(at[0], WIDTH - 1 - at[1]) && within_one(at[2], HEIGHT - 1 - at[3]);
    let fills = |at: [usize; 4]| [0, 2].map(|i| within_one(at[i], FRAME[i]) && within_one(at[i + 1], FRAME[i + 1]));
    for (size, is_low) in [
        ([4.0, 0.3, 4.0], true),
        ([6.0, 0.5, 1.0], true),
        ([1.0, 0.2, 0.9], true),
        ([2.0, 1.0, 5.0], true),
        ([1.0, 4.0, 1.0], false),
        ([1.0, 1.0, 1.0], false),
    ] {
        let mut scene = shown(of_color(block(size), [0.8; 3]), None);
        let mut over_turn = [WIDTH, 0, HEIGHT, 0];
        for step in 0..72 {
            scene.set_time(scene.duration * f64::from(step) / 72.0);
            let [left, right, top, bottom] = reach(&pixels(&scene));
            over_turn =
                [over_turn[0].min(left), over_turn[1].max(right), over_turn[2].min(top), over_turn[3].max(bottom)];
            let mut still = scene.clone();
            still.camera = Camera::framing_still(&scene.objects()[0]);
            let at = reach(&pixels(&still));
            assert!(is_centred(at) && fills(at).contains(&true), "{size:?} at {step}: {at:?}");
            tried.add(1);
        }
        let at = over_turn;
        let [wide, high] = fills(at);
        assert!(is_centred(at) && if is_low { wide } else { wide || high }, "{size:?}: {at:?}");
        assert!(at[0] + 1 >= FRAME[0] && at[2] + 1 >= FRAME[2], "{size:?}: {at:?}");
    }
}
