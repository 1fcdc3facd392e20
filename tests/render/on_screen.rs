//! What games need from a picture: where a point is in it, and what was there before.

use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::fixed::I24F8;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::Rgb;
use mode13h::plan::{Effect, Reason};
use mode13h::raster::{Frame, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Fog, Object, Scene};
use mode13h::settings::{Accuracy, HiddenSurfaces, Settings, Shading, VertexPath};
use mode13h::vga::Vga;
use mode13h_conformance::Random;

const SCREEN: Screen = Screen { width: 400, height: 300, pixel_aspect: (1, 1) };
const SIZE: usize = 400 * 300;

/// A frame full of `fill` once the scene is drawn.
fn draw(scene: &Scene, fill: u8, clears: bool, way: Option<HiddenSurfaces>) -> Vec<u8> {
    let mut renderer = Renderer::new();
    renderer.settings.hidden_surfaces = way;
    let mut bytes = vec![fill; SIZE];
    let frame = Frame::new(&mut bytes, SCREEN.width, SCREEN.height, 400).expect("legal");
    let drawn = match clears {
        true => renderer.draw_frame(scene, frame, SCREEN.pixel_aspect),
        false => renderer.draw_over(scene, frame, SCREEN.pixel_aspect),
    };
    drawn.expect("drawn");
    bytes
}

/// Leaving out objects that are out of sight changes no byte: a renderer that is kept draws the same frames as a new one
/// that transforms every object.
#[test]
fn objects_leave_sight_and_come_back() {
    let mut random = Random::named("out of sight");
    let mut tried = Tried::new("objects_leave_sight_and_come_back", 2_400);
    let accuracies = [Shading::Flat, Shading::Phong, Shading::GouraudVintage, Shading::GouraudTessellated];
    let mut settings = vec![Settings::default(); 3];
    settings[1].accuracy = Some(Accuracy::WithinError(2.0));
    settings[2].vertex_path = Some(VertexPath::Integer);
    settings.extend(accuracies.map(|shading| Settings { accuracy: Some(shading.into()), ..Settings::default() }));
    settings.extend(HiddenSurfaces::ALL.map(|way| Settings { hidden_surfaces: Some(way), ..Settings::default() }));
    let scales = [0.4, 0.4, 0.05, 3.0, 200.0];
    let (mut unseen, mut seen, mut still) = (0, 0, 0);
    for number in 0..240 {
        let settings = settings[number % settings.len()];
        let mut scene = Scene::new();
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        if number % 3 == 0 {
            scene.add_light(Light::lamp([1.0, 1.0, 1.0], 4.0));
        }
        if number % 5 == 0 {
            scene.fog = Some(Fog { color: Rgb::new(90, 90, 90), start: 2.0, end: 9.0 });
        }
        let mut number_within = |from: i64, to: i64| random.within(from, to) as f32 / 100.0;
        let mut point = |reach: i64| Vec3::from([0; 3].map(|_| number_within(-reach, reach)));
        for kind in 0..9 {
            let mesh = [shapes::cube(), shapes::torus(9, 6), shapes::sphere(9, 6)][kind % 3].clone();
            let id = scene.add(Object::new(mesh).at(point(600)).scaled(scales[kind * number % 5]));
            if kind == 4 && number % 4 == 0 {
                scene[id].materials[0].blend = Blend::Mix(128);
            }
        }
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        renderer.settings = settings;
        let (mut eye, mut target) = (point(500), point(500));
        for frame in 0..10 {
            // Look elsewhere, go elsewhere, move something, or change nothing.
            match frame % 5 {
                0 | 1 => target = point(500),
                2 => eye = point(500),
                3 => scene.objects_mut()[frame % 9].position = point(600),
                _ => {}
            }
            let near = if number % 7 == 0 { 0.01 } else { 0.5 };
            scene.camera = Camera { eye, target, near, ..Camera::default() };
            let stats = renderer.draw(&scene, &mut vga).expect("a legal scene");
            let mut new = renderer.with_same_settings();
            new.force(Effect::Transform, Some(true));
            let (expected, _) = crate::support::scenes::frame_by(&mut new, &scene);
            assert!(vga.pixels() == expected, "scene {number}, frame {frame}, {settings:?}");
            for plan in renderer.plan().objects() {
                match plan[Effect::Transform].reason {
                    Reason::OutOfSight => unseen += 1,
                    _ => seen += 1,
                }
            }
            still += u64::from(!stats.redrawn);
            tried.add(1);
        }
    }
    assert!(unseen > 4_000 && seen > 4_000 && still > 150, "{unseen} {seen} {still}");
}

/// A small sphere is drawn around the point that its centre projects to.
#[test]
fn a_point_is_where_it_is_drawn() {
    let mut random = Random::named("on screen");
    let mut number = |from: i64, to: i64| random.within(from, to) as f32 / 100.0;
    let (mut seen, mut hidden) = (0, 0);
    for _ in 0..300 {
        let mut point = || Vec3::new(number(-300, 300), number(-300, 300), number(-300, 300));
        let at = point();
        let mut scene = Scene::new();
        scene.add(Object::new(shapes::sphere(12, 8)).at(at).scaled(0.05));
        scene.camera = Camera { eye: point() * 2.0, target: point(), ..Camera::default() };
        // Pixels that are the same over black and over white were drawn.
        let [dark, bright] = [0, 255].map(|fill| draw(&scene, fill, false, None));
        let drawn = (0..SIZE).filter(|&at| dark[at] == bright[at]);
        let pixels: Vec<(f32, f32)> = drawn.map(|at| ((at % 400) as f32, (at / 400) as f32)).collect();
        let Some([x, y, distance]) = scene.camera.project(at, SCREEN) else {
            // Its near half may still be visible.
            hidden += 1;
            continue;
        };
        let straight = (at - scene.camera.eye).dot((scene.camera.target - scene.camera.eye).normalize());
        assert!((distance - straight).abs() <= 1e-4 * distance.abs(), "{distance} for {straight}");
        if !(20.0..380.0).contains(&x) || !(20.0..280.0).contains(&y) || distance < 2.0 {
            continue;
        }
        // x and y are rounded to 2⁻¹⁶ pixel, of which there are 400 in a unit at distance 1; eye and point to 2⁻²².
        let towards = (at - scene.camera.eye).normalize();
        for screen in [SCREEN, Screen::MODE_13H] {
            let [x, y, _] = scene.camera.project(at, screen).expect("in front");
            let ray = scene.camera.ray([x, y], screen).expect("a valid camera");
            assert!((ray - towards).length() < 2e-6, "{ray} for {towards}");
        }
        // At most 10 pixels across, with centres within the ball's silhouette.
        let count = pixels.len() as f32;
        let mean = pixels.iter().fold((0.0, 0.0), |sum, at| (sum.0 + at.0 / count, sum.1 + at.1 / count));
        assert!(count > 3.0, "nothing at ({x}, {y})");
        assert!((mean.0 + 0.5 - x).abs() < 1.0 && (mean.1 + 0.5 - y).abs() < 1.0, "{mean:?} for ({x}, {y})");
        seen += 1;
    }
    assert!(seen > 60 && hidden > 5, "{seen} seen, {hidden} hidden");
}

/// A point of a mesh is drawn where its place in the scene projects to, whatever moves the object and its parents.
#[test]
fn a_point_of_a_mesh_is_drawn_at_its_place_in_the_scene() {
    let mut random = Random::named("points of meshes");
    let mut number = |from: i64, to: i64| random.within(from, to) as f32 / 100.0;
    let mut drawn = 0;
    for _ in 0..300 {
        let mut point = |size: i64| Vec3::new(number(-size, size), number(-size, size), number(-size, size));
        let corners = [point(100), point(100), point(100)];
        let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("legal");
        // Each is the parent of the next.
        let (mut scene, mut ids) = (Scene::new(), Vec::new());
        for _ in 0..3 {
            let mut object = Object::new(mesh.clone()).at(point(200)).scaled(0.5 + point(75).x.abs());
            object.pivot = point(100);
            object.angles = point(300).to_array().map(|angle| Angle::from_radians(angle.into()));
            object.parent = ids.last().copied();
            ids.push(scene.add(object));
        }
        scene.camera.eye = Vec3::new(0.0, 0.0, 40.0);
        let place = |id, corner| scene.camera.project(scene.to_world(id, corner)?, SCREEN);
        let places: Vec<_> =
            ids.into_iter().map(|id| corners.map(|corner| place(id, corner).expect("in front"))).collect();
        let mut see = |vertices: &[Vertex; 3], _| {
            // Half of 1/256 pixel, and f32 at up to 512 pixels.
            let is_near = |c: I24F8, place: f32| (c.to_bits() as f32 / 256.0 - place).abs() < 0.0021;
            let is_at = |(vertex, [x, y, _]): (&Vertex, &[f32; 3])| is_near(vertex.x(), *x) && is_near(vertex.y(), *y);
            let found = places.iter().filter(|places| vertices.iter().zip(*places).all(is_at)).count();
            assert_eq!(found, 1, "{vertices:?} is at none of {places:?}");
            drawn += 1;
        };
        Renderer::new().for_each_triangle(&scene, SCREEN, &mut see).expect("drawn");
    }
    assert!(drawn > 700, "{drawn} drawn");
}

/// Pixels that a scene draws do not depend on what was there; all others are unchanged.
#[test]
fn drawing_over_changes_what_is_drawn_and_no_more() {
    let mut scene = Scene::showing(shapes::torus(24, 12));
    scene.background = 1;
    for way in
        [None, Some(HiddenSurfaces::PainterOrder), Some(HiddenSurfaces::ScanLine), Some(HiddenSurfaces::BackFaces)]
    {
        let [dark, bright] = [0, 255].map(|fill| draw(&scene, fill, false, way));
        let cleared = draw(&scene, 9, true, way);
        let mut drawn = 0;
        for (at, (&a, &b)) in dark.iter().zip(&bright).enumerate() {
            if (a, b) == (0, 255) {
                assert_eq!(cleared[at], scene.background, "{way:?}");
            } else {
                assert_eq!((a, b), (cleared[at], cleared[at]), "{way:?}");
                drawn += 1;
            }
        }
        assert!(drawn > 5_000, "{way:?}: {drawn}");
    }
}
