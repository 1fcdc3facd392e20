//! Whole frames against the oracle: the triangles passed to the raster, drawn again in i128, pixel by pixel, must give
//! the same bytes.
//!
//! `MODE13H_MODEL=model.obj cargo test --test render frames` tries a model of your own as well.

use crate::support::judged::{Expected, by_the_oracle};
use crate::support::scenes::{frame_by, shaded};
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Object, Scene};
use mode13h::settings::{HiddenSurfaces, Shading};
use mode13h::span::Kernel;
use mode13h::vga::Vga;

const WIDTH: i32 = Vga::WIDTH as i32;
const HEIGHT: i32 = Vga::HEIGHT as i32;

/// Draws the scene twice, once with the oracle; returns the number of pixels that are not background.
fn check(scene: &Scene, shading: Shading) -> usize {
    let mut renderer = shaded(shading);
    let Expected { triangles, bytes: expected, counts } = by_the_oracle(&mut renderer, scene, Screen::MODE_13H);
    let off_screen = triangles.iter().filter(|(vertices, _)| is_off_screen(vertices)).count() as u64;
    for kernel in Kernel::available() {
        renderer.kernel = kernel;
        let (bytes, stats) = frame_by(&mut renderer, scene);
        let differs = bytes.iter().zip(&expected).position(|(is, should)| is != should);
        assert_eq!(differs, None, "kernel {}", kernel.name());
        assert_eq!(stats.kernel, kernel.name());
        // Of clipped faces, those that are off the screen are not passed to the raster.
        let most_left_out = if stats.clipped == 0 { 0 } else { off_screen };
        let left_out = triangles.len() as u64 - stats.drawn;
        assert!(left_out <= most_left_out, "{left_out} of at most {most_left_out}");
        assert_eq!(stats.raster.covered, counts.iter().sum::<u32>());
    }
    counts.into_iter().filter(|&times| times > 0).count()
}

/// Returns whether all corners lie beyond one side of the screen.
fn is_off_screen(vertices: &[Vertex; 3]) -> bool {
    let all = |beyond: fn(&Vertex) -> bool| vertices.iter().all(beyond);
    all(|v| v.x().to_bits() < 0)
        || all(|v| v.x().to_bits() > WIDTH << 8)
        || all(|v| v.y().to_bits() < 0)
        || all(|v| v.y().to_bits() > HEIGHT << 8)
}

fn turned(mesh: Mesh, degrees: f64) -> Scene {
    let mut scene = crate::support::scenes::framed(mesh);
    scene.objects_mut()[0].angles = [0.4, degrees.to_radians(), 0.1].map(Angle::from_radians);
    scene
}

#[test]
fn every_shape_on_every_shading_is_the_oracles_frame() {
    let mut tried = Tried::new("every_shape_on_every_shading_is_the_oracles_frame", 7 * 8);
    for name in shapes::NAMES {
        for shading in Shading::ALL.into_iter().filter(|shading| !shading.lights_pixels()) {
            let pixels = check(&turned(shapes::by_name(name).expect("listed"), 33.0), shading);
            assert!(pixels > 5000, "{name} is in the picture: {pixels} pixels");
            tried.add(1);
        }
    }
}

/// All shades half a step below the next, so that estimated quotients cannot decide a single pixel. There are more
/// faces than are listed at a time.
#[test]
fn many_faces_whose_every_quotient_is_a_whole_number_are_the_oracles() {
    let mut tried = Tried::new("many_faces_whose_every_quotient_is_a_whole_number_are_the_oracles", 2);
    for shading in [Shading::GouraudHyperbolic, Shading::GouraudFloat] {
        let mut scene = turned(shapes::sphere(48, 24), 20.0);
        scene.ambient = 64.5 / 255.0;
        for material in &mut scene.objects_mut()[0].materials {
            (material.ambient, material.diffuse) = (1.0, 0.0);
        }
        assert!(check(&scene, shading) > 5000);
        tried.add(1);
    }
}

#[test]
fn close_up_the_clipped_frame_is_the_oracles() {
    let mut tried = Tried::new("close_up_the_clipped_frame_is_the_oracles", 12);
    for step in 0..12_u8 {
        // From in front of the torus to inside it, faces pass the near plane and the guard band.
        let mut scene = turned(shapes::torus(24, 12), f64::from(step) * 10.0);
        scene.camera.near = 0.3;
        scene.camera.eye.z = 1.4 - 0.1 * f32::from(step);
        scene.camera.target.z = scene.camera.eye.z - 1.0;
        let mut renderer = Renderer::new();
        let stats = renderer.for_each_triangle(&scene, Screen::MODE_13H, |_, _| ()).expect("a legal scene");
        assert!(step < 6 || stats.clipped > 0, "faces are clipped: {stats}");
        check(&scene, Shading::Gouraud88Reseeded);
        tried.add(1);
    }
}

#[test]
fn a_model_of_your_own() {
    let Ok(path) = std::env::var("MODE13H_MODEL") else {
        println!("MODE13H_MODEL names no model: none tried");
        return;
    };
    let mut tried = Tried::new("a_model_of_your_own", 4);
    let mesh = mode13h_assets::model_file::load(&path).expect("a model").mesh;
    for quarter in 0..4 {
        let pixels = check(&turned(mesh.clone(), f64::from(quarter) * 90.0), Shading::Gouraud88Reseeded);
        assert!(pixels > 1000, "{path} is in the picture: {pixels} pixels");
        tried.add(1);
    }
}

/// A closed convex object seen from outside: its front faces cover the whole silhouette without holes or overlaps, so
/// the depth buffer has nothing to decide.
#[test]
fn d4_back_faces_alone_give_the_depth_buffers_frame() {
    let mut tried = Tried::new("d4_back_faces_alone_give_the_depth_buffers_frame", 3 * 12);
    for name in ["cube", "sphere", "cylinder"] {
        for step in 0..12 {
            let mut alone = turned(shapes::by_name(name).expect("listed"), f64::from(step) * 30.0);
            let mut renderer = Renderer::new();
            let (first, stats) = frame_by(&mut renderer, &alone);
            assert_eq!(stats.hidden_surfaces, HiddenSurfaces::BackFaces, "{name}");
            let covered = stats.raster.covered;
            // A speck far outside the picture makes it two objects.
            let mut speck = mode13h::scene::Object::new(shapes::cube());
            speck.position.x = 50.0;
            alone.add(speck);
            let (second, stats) = frame_by(&mut renderer, &alone);
            assert_eq!(stats.hidden_surfaces, HiddenSurfaces::DepthBuffer);
            assert_eq!(first, second, "{name}");
            assert_eq!(stats.raster.pixels, covered, "{name}: no pixel is covered by two front faces");
            tried.add(1);
        }
    }
}

/// A clipped face that comes exactly where the list of faces drawn together is full.
#[test]
fn a_face_in_parts_is_whole_where_the_list_is_full() {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let mut face = |corners: [[f32; 3]; 3]| {
        let first = positions.len() as u32;
        positions.extend(corners.map(Vec3::from_array));
        triangles.push([first, first + 1, first + 2]);
    };
    // Nine times 64 faces, of which the last extends behind the eye.
    for i in 0..575_u16 {
        let (x, y) = (f32::from(i % 24) / 12.0 - 1.0, f32::from(i / 24) / 12.0 - 1.0);
        face([[x, y, 0.0], [x + 0.08, y, 0.0], [x, y + 0.08, 0.0]]);
    }
    face([[-0.3, -0.3, 0.5], [0.3, -0.3, 0.5], [0.0, 0.2, 10.0]]);
    let mut scene = Scene::new();
    scene.camera.eye = Vec3::new(0.0, 0.0, 3.0);
    scene.add(Object::new(Mesh::new(positions, triangles).expect("a mesh")));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let stats = Renderer::new().draw(&scene, &mut Vga::new()).expect("a legal scene");
    assert_eq!((stats.faces, stats.clipped), (576, 1));
    assert!(stats.drawn > 576, "{} are drawn", stats.drawn);
    assert!(check(&scene, Shading::default()) > 10_000);
}
