//! The four hidden-surface methods on whole scenes: which one is chosen, and that all of them give the same picture
//! where they are right.

use crate::support::scenes::frame_by;
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::{HiddenSurfaces, Shading, VertexPath};
use mode13h::vga::Vga;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

/// A bar with integer coordinates, so that its sides are exactly planar.
fn bar(centre: [i32; 3], along: [i32; 3], across: [i32; 3]) -> Mesh {
    let thick = [0, 0, 1];
    let positions = (0..8)
        .map(|corner| {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 1 } else { -1 };
            let at = |i: usize| (centre[i] + sign(0) * along[i] + sign(1) * across[i] + sign(2) * thick[i]) as f32;
            Vec3::new(at(0), at(1), at(2))
        })
        .collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::new(positions, triangles).expect("a box");
    assert!(mesh.is_convex(), "a bar is convex");
    mesh
}

/// Three bars that overlap in a cycle: each from behind the next at one end to in front of the third.
fn bars() -> Scene {
    let mut scene = Scene::new();
    for (centre, along, across) in [
        ([0, -5, 0], [12, 0, 6], [0, 2, 0]),
        ([4, 3, 0], [-6, 10, 6], [-2, -1, 0]),
        ([-4, 3, 0], [-6, -10, 6], [2, -1, 0]),
    ] {
        scene.add(Object::new(bar(centre, along, across)));
    }
    scene.camera = Camera::framing(Vec3::ZERO, 16.0);
    scene.add_light(Light::sun([0.3, 0.7, 1.0]));
    scene
}

fn picture(scene: &Scene, way: Option<HiddenSurfaces>) -> (Vec<u8>, HiddenSurfaces) {
    let mut renderer = Renderer::new();
    renderer.settings.hidden_surfaces = way;
    let (bytes, stats) = frame_by(&mut renderer, scene);
    (bytes, stats.hidden_surfaces)
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
            object.angles = [0.0, 0.0, f64::from(degrees).to_radians()].map(Angle::from_radians);
        }
        let (chosen, way) = picture(&scene, None);
        assert_eq!(way, HiddenSurfaces::DepthBuffer);
        assert_eq!(by(&scene, HiddenSurfaces::ScanLine), chosen);
        wrong += u32::from(by(&scene, HiddenSurfaces::PainterOrder) != chosen);
        tried.add(1);
    }
    assert_eq!(wrong, 72, "painter's order is wrong in every one of them");
}

/// Two objects so far away that all their depths are 1: their ranges are equal, not disjoint. With equal depths the
/// first submitted stays, which painting one over the other would not preserve.
#[test]
fn d3_objects_of_equal_depths_are_not_left_to_the_painter() {
    let mut tried = Tried::new("d3_objects_of_equal_depths_are_not_left_to_the_painter", 4);
    for distances in [[1.0, 1.3], [1.3, 1.0], [1.0, 1.0], [2.0, 1.2]] {
        let mut scene = Scene::new();
        scene.camera = Camera { eye: Vec3::ZERO, target: Vec3::NEG_Z, near: 0.25, ..Camera::default() };
        for (distance, diffuse) in distances.into_iter().zip([0.9, 0.4]) {
            let mut cube = Object::new(shapes::cube());
            (cube.position.z, cube.scale) = (-2e10 * distance, 1e9);
            cube.materials[0].diffuse = diffuse;
            scene.add(cube);
        }
        scene.add_light(Light::sun([0.2, 0.3, 1.0]));
        let (chosen, way) = picture(&scene, None);
        assert_eq!(way, HiddenSurfaces::DepthBuffer, "{distances:?}");
        let mut alone = Scene::clone(&scene);
        alone.objects_mut()[1].position.x = 1e12;
        let first = picture(&alone, None).0;
        let pixels = first.iter().filter(|&&byte| byte != 0).count();
        let kept = first.iter().zip(&chosen).filter(|(first, chosen)| **first != 0 && first == chosen).count();
        assert!(pixels > 20 && kept == pixels, "{distances:?}: {kept} of {pixels} pixels of the first");
        tried.add(1);
    }
}

/// Opaque faces of an object that also has glass hide one another as if they were an object of their own.
#[test]
fn opaque_faces_beside_glass_hide_each_other() {
    // Sheets across the view: near opaque ones, glass, far opaque ones; the far ones come last in the mesh.
    let sheets = [(2.0, 0), (-1.0, 1), (-2.0, 0)];
    let mesh = |with: &[u16]| {
        let (mut positions, mut triangles, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
        for &(z, surface) in sheets.iter().filter(|(_, surface)| with.contains(surface)) {
            let first = positions.len() as u32;
            let half = 1.0 - z / 4.0;
            positions
                .extend([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x * half, y, z)));
            triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|corner| first + corner)));
            surfaces.extend([surface; 2]);
        }
        let mesh = Mesh::new(positions, triangles).expect("sheets");
        mesh.with_surfaces(vec![Surface::default(); 2], surfaces).expect("two surfaces")
    };
    let scene = |meshes: &[Mesh]| {
        let mut scene = Scene::new();
        for mesh in meshes {
            let mut object = Object::new(mesh.clone());
            (object.materials[0].diffuse, object.materials[1].blend) = (0.4, Blend::Mix(100));
            scene.add(object);
        }
        scene.camera = Camera::framing(Vec3::ZERO, 4.0);
        scene.add_light(Light::sun([0.3, 0.7, 1.0]));
        scene
    };
    let (together, way) = picture(&scene(&[mesh(&[0, 1])]), None);
    assert_eq!(way, HiddenSurfaces::DepthBuffer);
    // The opaque ones as one object, and the glass as another.
    let mut apart = scene(&[mesh(&[0]), mesh(&[1])]);
    apart.objects_mut()[0].materials[1].blend = Blend::Opaque;
    assert_eq!(picture(&apart, None).1, HiddenSurfaces::DepthBuffer);
    assert!(together == picture(&apart, None).0);
    // Glass alone needs no depths.
    let mut glass = scene(&[mesh(&[0, 1])]);
    glass.objects_mut()[0].materials[0].blend = Blend::Add;
    assert_eq!(picture(&glass, None).1, HiddenSurfaces::BackFaces);
}

/// Number of triangles that cover each pixel, by the oracle.
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
    // So fine that faces near the silhouette flip when rounded, and overlap others.
    let fine = [shapes::sphere(128, 64), shapes::sphere(300, 20), shapes::cone(300, 1)].map(|mesh| (mesh, 60));
    for (mesh, poses) in shipped.into_iter().chain(fine) {
        for _ in 0..poses {
            let mut scene = crate::support::scenes::framed(mesh.clone());
            let object = &mut scene.objects_mut()[0];
            object.scale = (0.01_f64.powf(random.unit())) as f32;
            object.angles = [(); 3].map(|()| random.unit() * 6.3).map(Angle::from_radians);
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

/// Convex objects one behind another are drawn far to near; objects side by side are not.
#[test]
fn d4_painters_order_is_taken_for_convex_objects_that_are_apart() {
    let mut tried = Tried::new("d4_painters_order_is_taken_for_convex_objects_that_are_apart", 40);
    let mut random = Random::named("painter");
    let mut overlapping = 0;
    while tried.more() {
        let mut scene = Scene::new();
        scene.camera.field_of_view = Angle::from_radians(1.2);
        let eye = f64::from(scene.camera.eye.z);
        // No shape extends farther than √3 from its centre. Some are cut by the near plane.
        let mut z = eye - random.unit() * 2.0;
        let mut objects = Vec::new();
        for _ in 0..random.within(2, 6) {
            let mut object =
                Object::new(shapes::by_name(random.one_of(&["cube", "sphere", "cylinder"])).expect("listed"));
            let scale = 0.2 + random.unit();
            let reach = scale * 1.7321;
            object.scale = scale as f32;
            object.angles = [(); 3].map(|()| random.unit() * 6.3).map(Angle::from_radians);
            z -= reach;
            object.position = Vec3::new(random.unit() as f32 - 0.5, random.unit() as f32 - 0.5, z as f32);
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
        // One more object at the last one's depths, and painter's order no longer suffices.
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
    assert_eq!(error, "unknown hidden-surface method; there are back-faces, painter, depth-buffer, scan-line");
}

/// A renderer clears depths in one frame of three, and only where objects may be seen: bars that jump about, beyond the
/// screen's edges and through the near plane, an eye that moves, and shadings that change, give the bytes of a new
/// renderer.
#[test]
fn depths_of_earlier_frames_hide_nothing() {
    let mut random = Random::named("depths of earlier frames");
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    let mut scene = bars();
    let usual = scene.camera;
    let mut drawn = 0;
    for number in 0..400 {
        let mut place = |x, y, z| Vec3::from([x, y, z].map(|most: i64| random.within(-most, most) as f32));
        scene.camera.eye = usual.eye + place(5, 5, 20);
        let at = place(14, 14, 14);
        let degrees = random.within(0, 359) as f64;
        for object in scene.objects_mut() {
            // Far away it has lower depths than nearer ones of frames before it.
            object.position = at * Vec3::new(1.0, 1.0, random.one_of(&[1.0, 1.0, 20.0]));
            object.angles = [0.0, degrees.to_radians(), 0.0].map(Angle::from_radians);
        }
        let shading = (random.within(0, 1) == 0).then(|| random.one_of(&Shading::ALL));
        let path = (random.within(0, 7) == 0).then_some(VertexPath::Integer);
        // The bars are among the farthest that there are, as usual, or cut off where depths are greatest.
        let nearest = random.one_of(&[1e-8, usual.near, scene.camera.eye.z - 4.0]);
        // 16.16 has no room for the first.
        scene.camera.near = if path.is_some() { nearest.max(usual.near) } else { nearest };
        renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
        renderer.settings.accuracy = shading.map(Into::into);
        renderer.settings.vertex_path = path;
        let stats = renderer.draw(&scene, &mut vga).expect("a legal scene");
        let (alone, _) = frame_by(&mut renderer.with_same_settings(), &scene);
        assert!(vga.pixels() == alone, "frame {number}, {shading:?}, {path:?}");
        drawn += stats.raster.pixels;
    }
    assert!(drawn > 1_000_000, "{drawn}");
}
