//! glTF: lights, cameras, animations and skins, against answers worked out by hand.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::io;
use std::path::Path;

use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::vga::Vga;
use mode13h_assets::SceneExt;
use mode13h_assets::auto_palette::{self, AutomaticPalette, Entries};
use mode13h_assets::model::{Playback, composed};
use mode13h_assets::model_file::{Loaded, Rig};

use crate::gltf_files::{Gltf, points_of};
use crate::model_files::{loaded, refused};
use crate::support::tried::Tried;

/// A turn by an angle about an axis, as a file has it: x, y, z, w.
fn turn([x, y, z]: [f64; 3], angle: f64) -> [f32; 4] {
    let (sine, cosine) = (angle / 2.0).sin_cos();
    [x * sine, y * sine, z * sine, cosine].map(|c| c as f32)
}

fn list(numbers: &[f32]) -> String {
    let all: Vec<String> = numbers.iter().map(f32::to_string).collect();
    format!("[{}]", all.join(","))
}

/// A file with a shape in nodes[0].
fn with_shape(shape: &Mesh) -> Gltf {
    let (positions, indices) = points_of(shape);
    let mut file = Gltf::default();
    let (position, index) = (file.floats(&positions), file.indices(&indices, 5125));
    file.mesh(&format!("\"POSITION\":{position}"), &format!(",\"indices\":{index}"));
    file.add("nodes", "{\"mesh\":0}");
    file
}

/// Adds lights, each in a node of its own.
fn with_lights(mut file: Gltf, lights: &[(&str, &str)]) -> Gltf {
    let mut all = Vec::new();
    for (index, (light, place)) in lights.iter().enumerate() {
        all.push(format!("{{{light}}}"));
        file.add("nodes", format!("{{{place}\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":{index}}}}}}}"));
    }
    file.more += &format!(",\"extensions\":{{\"KHR_lights_punctual\":{{\"lights\":[{}]}}}}", all.join(","));
    file
}

fn are_near(a: Vec3, b: [f64; 3], most: f64) -> bool {
    a.to_array().iter().zip(b).all(|(a, b)| (f64::from(*a) - b).abs() <= most)
}

/// The light of a lamp at a distance, by the engine's formula.
fn lamp_at(light: &Light, distance: f64) -> f64 {
    let Light::Lamp { intensity, range, .. } = *light else { panic!("{light:?}") };
    let left = (1.0 - (distance / f64::from(range)).powi(2)).max(0.0);
    f64::from(intensity) * left * left
}

/// Two white lamps and a sun around a cube: in its middle their light has the ratios given in the file, adds up to full
/// light, and falls off with the inverse square.
#[test]
fn lights_have_the_files_ratios_where_the_model_is() {
    let down = list(&turn([1.0, 0.0, 0.0], -FRAC_PI_2));
    let file = with_lights(
        with_shape(&shapes::cube()),
        &[
            ("\"type\":\"point\",\"intensity\":3200", "\"translation\":[0,16,0],"),
            (
                "\"type\":\"spot\",\"intensity\":400,\"color\":[1,0,0],\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}",
                "\"translation\":[0,0,8],",
            ),
            ("\"type\":\"directional\",\"intensity\":2.5", &format!("\"rotation\":{down},\"scale\":[2,2,2],")),
            ("\"type\":\"point\",\"intensity\":0", ""),
        ],
    );
    let Loaded { lights, warnings, camera, rig, .. } = loaded(file.glb(), "a.glb");
    assert_eq!(warnings, ["a.glb: left out: lights that emit no light"]);
    assert!(camera.is_none() && rig.is_none());
    let [lamp, spot, sun] = *lights.as_slice() else { panic!("{lights:?}") };
    // 3200/16², 400/8², and 2.5; red counts 0.299.
    let full = 12.5 + 6.25 * 0.299 + 2.5;
    let (shares, distances) = ([12.5, 6.25].map(|share| share / full), [16.0, 8.0]);
    for ((light, share), distance) in [lamp, spot].iter().zip(shares).zip(distances) {
        // Some roundings to f32.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * b;
        assert!(near(lamp_at(light, distance), share), "{light:?} {share}");
        // The slope of the inverse square is −2/d of the value; a short step is off by the square of its length.
        let step = distance / 1024.0;
        let slope = (lamp_at(light, distance + step) - lamp_at(light, distance - step)) / (2.0 * step);
        assert!((slope / (-2.0 * share / distance) - 1.0).abs() < 1e-4, "{light:?} {slope}");
    }
    assert!((f64::from(sun.intensity()) - 2.5 / full).abs() < 1e-6, "{sun:?}");
    let Light::Sun { direction, .. } = sun else { panic!("{sun:?}") };
    assert!(are_near(direction, [0.0, 1.0, 0.0], 1e-6), "it shines along −z, turned down: {direction}");
    let Light::Lamp { position, cone: Some(cone), color, .. } = spot else { panic!("{spot:?}") };
    assert_eq!((position, color, cone.direction), (Vec3::new(0.0, 0.0, 8.0), [1.0, 0.0, 0.0], Vec3::NEG_Z));
    assert_eq!([cone.inner, cone.outer].map(|angle| angle.to_radians()), [0.25, 0.5]);
}

/// A lamp inside a model or beside it reaches all of it, unless the file limits it.
#[test]
fn lamps_reach_the_whole_model() {
    let radius = f64::from(shapes::cube().bounds().radius);
    for (place, limit, expected) in [
        ("0,0,0", "", radius),
        ("0,1,0", "", 1.0 + radius),
        ("0,1,0", ",\"range\":1.5", 1.5),
        ("0,8,0", ",\"range\":99", 8.0 * 3_f64.sqrt()),
    ] {
        let light = format!("\"type\":\"point\"{limit}");
        let file = with_lights(with_shape(&shapes::cube()), &[(&light, &format!("\"translation\":[{place}],"))]);
        let lights = loaded(file.glb(), "a.glb").lights;
        let [Light::Lamp { range, .. }] = *lights.as_slice() else { panic!("{lights:?}") };
        assert!((f64::from(range) - expected).abs() < 1e-5, "{place} {limit}: {range}, not {expected}");
    }
}

#[test]
fn the_first_camera_in_perspective_is_the_camera() {
    let mut file = with_shape(&shapes::cube());
    file.add("cameras", "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"zfar\":9,\"znear\":1}}");
    file.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.75,\"znear\":0.25}}");
    file.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,\"znear\":0.5}}");
    file.add("nodes", "{\"camera\":0}");
    // Behind the cube and looking along z, rolled by a half turn.
    file.add("nodes", "{\"camera\":1,\"matrix\":[2,0,0,0,0,-2,0,0,0,0,-2,0,3,0,-8,1]}");
    file.add("nodes", "{\"camera\":2}");
    let Loaded { camera, warnings, .. } = loaded(file.glb(), "a.glb");
    let camera = camera.expect("a camera");
    assert_eq!(warnings, ["a.glb: left out: orthographic cameras"]);
    assert_eq!((camera.eye, camera.up, camera.near), (Vec3::new(3.0, 0.0, -8.0), Vec3::NEG_Y, 0.25));
    assert_eq!(camera.target, Vec3::new(3.0, 0.0, 0.0), "as far as the middle of the cube");
    assert_eq!(camera.field_of_view.to_radians(), 0.75);
    // The renderer accepts it and the file's lights.
    let scene = composed(Object::new(shapes::cube()), &[], Some(camera)).expect("a scene");
    assert_eq!((scene.camera, scene.lights().len()), (camera, 2));
    let Light::Sun { direction: key, .. } = scene.lights()[0] else { panic!("{:?}", scene.lights()) };
    assert!(key.dot(camera.eye - camera.target) > 0.0, "it comes from behind the eye");
}

/// Adds an animation of one property of a node.
fn animate(file: &mut Gltf, node: usize, path: &str, interpolation: &str, times: &[f32], values: usize) {
    let bytes: Vec<u8> = times.iter().flat_map(|time| time.to_le_bytes()).collect();
    let input = file.accessor(&bytes, 5126, times.len(), "SCALAR", "");
    file.add(
        "animations",
        format!(
            "{{\"name\":\"{path}\",\"samplers\":[{{\"input\":{input},\"output\":{values},\"interpolation\":\"{interpolation}\"}}],\
             \"channels\":[{{\"sampler\":0,\"target\":{{\"node\":{node},\"path\":\"{path}\"}}}}]}}"
        ),
    );
}

fn rig(loaded: &Loaded) -> &Rig {
    loaded.rig.as_ref().expect("it moves")
}

fn placed(loaded: &Loaded, clip: usize, seconds: f64) -> Vec<Vec3> {
    rig(loaded).pose(&loaded.mesh, clip, seconds).mesh.positions().to_vec()
}

/// A node and everything below it turn evenly about y by a right angle, compared with sine and cosine in f64. Each
/// number of the file's quaternions is an f32, off by 2⁻²⁵, and positions are below 4 and rounded to f32.
#[test]
fn a_node_turns_evenly_and_takes_its_children_along() {
    let mut file = with_shape(&shapes::cube());
    file.lists.get_mut("nodes").unwrap()[0] = "{\"mesh\":0,\"translation\":[2,0,0]}".into();
    file.add("nodes", "{\"children\":[0]}");
    let values = [turn([0.0, 1.0, 0.0], 0.0), turn([0.0, 1.0, 0.0], FRAC_PI_2).map(|c| -c)];
    let values = file.floats(&values);
    animate(&mut file, 1, "rotation", "LINEAR", &[0.5, 2.5], values);
    let model = loaded(file.glb(), "a.glb");
    let [clip] = rig(&model).clips() else { panic!("{:?}", rig(&model).clips()) };
    assert_eq!((clip.name(), clip.duration()), ("rotation", 2.5));
    assert_eq!(placed(&model, 0, 0.0), model.mesh.positions());
    let mut tried = Tried::new("a_node_turns_evenly_and_takes_its_children_along", 100);
    for step in -40..=80_i32 {
        let seconds = f64::from(step) / 16.0;
        // It begins again at its end.
        let angle = ((seconds.rem_euclid(2.5) - 0.5) / 2.0).clamp(0.0, 1.0) * FRAC_PI_2;
        let (sine, cosine) = angle.sin_cos();
        for (at_rest, now) in model.mesh.positions().iter().zip(placed(&model, 0, seconds)) {
            let [x, y, z] = at_rest.to_array().map(f64::from);
            let expected = [cosine * x + sine * z, y, cosine * z - sine * x];
            assert!(are_near(now, expected, 2f64.powi(-21)), "{seconds}: {now}, not {expected:?}");
        }
        tried.add(1);
    }
}

/// Steps, lines and splines of translation and scale, each by its formula, in one file.
#[test]
fn each_interpolation_follows_its_formula() {
    let mut file = with_shape(&shapes::cube());
    let two = file.floats(&[[1.0, 2.0, 3.0], [5.0, -2.0, 3.0]]);
    // In-tangent, value, out-tangent of each key.
    let spline: [[f32; 3]; 6] =
        [[9.0, 9.0, 9.0], [0.0, 0.0, 0.0], [1.0, 0.0, 4.0], [0.5, -2.0, 0.0], [2.0, 1.0, 0.0], [9.0, 9.0, 9.0]];
    let six = file.floats(&spline);
    animate(&mut file, 0, "translation", "STEP", &[0.0, 2.0], two);
    animate(&mut file, 0, "scale", "LINEAR", &[0.0, 2.0], two);
    animate(&mut file, 0, "translation", "CUBICSPLINE", &[1.0, 3.0], six);
    let model = loaded(file.glb(), "a.glb");
    assert_eq!(
        rig(&model).clips().iter().map(|clip| clip.name()).collect::<Vec<_>>(),
        ["translation", "scale", "translation"]
    );
    let corner = model.mesh.positions()[0];
    assert_eq!(placed(&model, 0, 1.9)[0], corner + Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(placed(&model, 1, 0.5)[0], corner * Vec3::new(2.0, 1.0, 3.0));
    for step in 0..32_i32 {
        let t = f64::from(step) / 32.0;
        let expected = [0, 1, 2].map(|i| {
            let (from, out, into, to): (f64, f64, f64, f64) =
                (spline[1][i].into(), spline[2][i].into(), spline[3][i].into(), spline[4][i].into());
            f64::from(corner[i])
                + (2.0 * t.powi(3) - 3.0 * t.powi(2) + 1.0) * from
                + 2.0 * (t.powi(3) - 2.0 * t.powi(2) + t) * out
                + (3.0 * t.powi(2) - 2.0 * t.powi(3)) * to
                + 2.0 * (t.powi(3) - t.powi(2)) * into
        });
        // Below 8, and rounded once.
        assert!(are_near(placed(&model, 2, 1.0 + 2.0 * t)[0], expected, 2f64.powi(-22)), "{t}");
    }
}

/// A sheet of three rows at the heights 0, 1 and 2, in the plane z = 0, on two joints: the lower at 0, the upper at the height
/// 1. The lower row hangs on the lower joint, the upper on the upper one, and the middle on both.
fn bar(joints: &str, weights: &[u8], component: u32, more: &str) -> Gltf {
    let mut file = Gltf::default();
    let rows = [0.0, 1.0, 2.0].map(|y| [[-0.5, y, 0.0], [0.5, y, 0.0]]);
    let positions = file.floats(rows.as_flattened());
    let normals = file.floats(&[[0.0, 0.0, 1.0]; 6]);
    let indices = file.indices(&[0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4], 5123);
    let names: Vec<u8> = match joints {
        "u8" => [[0, 1, 0, 0]; 6].as_flattened().to_vec(),
        _ => [[0_u16, 1, 0, 0]; 6].as_flattened().iter().flat_map(|name| name.to_le_bytes()).collect(),
    };
    let names = file.accessor(&names, if joints == "u8" { 5121 } else { 5123 }, 6, "VEC4", "");
    let weights = file.accessor(weights, component, 6, "VEC4", more);
    // By columns; the upper joint's is a move down by 1.
    let before: [[f32; 16]; 2] =
        [0.0, -1.0].map(|y| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, y, 0.0, 1.0]);
    let bytes: Vec<u8> = before.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
    let before = file.accessor(&bytes, 5126, 2, "MAT4", "");
    let attributes =
        format!("\"POSITION\":{positions},\"NORMAL\":{normals},\"JOINTS_0\":{names},\"WEIGHTS_0\":{weights}");
    file.mesh(&attributes, &format!(",\"indices\":{indices}"));
    file.add("skins", format!("{{\"joints\":[1,2],\"inverseBindMatrices\":{before}}}"));
    // Where a skinned mesh's node stands does not matter.
    file.add("nodes", "{\"mesh\":0,\"skin\":0,\"translation\":[7,7,7]}");
    file.add("nodes", "{\"children\":[2]}");
    file.add("nodes", "{\"translation\":[0,1,0]}");
    file
}

const HALVES: [[f32; 4]; 6] = {
    let (lower, middle, upper) = ([1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]);
    [lower, lower, middle, middle, upper, upper]
};

fn half_weights() -> Vec<u8> {
    HALVES.as_flattened().iter().flat_map(|weight| weight.to_le_bytes()).collect()
}

/// The upper joint turns by a right angle about z, to the left: (x, y) above it goes to (−(y − 1), 1 + x), and the
/// middle row is half-way between there and where it was. When it turns about x, toward the eye, normals turn too.
#[test]
fn a_bar_on_two_joints_bends() {
    let as_u8: Vec<u8> =
        [[255, 0, 0, 0], [255, 0, 0, 0], [51, 51, 0, 0], [9, 9, 0, 0], [0, 255, 0, 0], [0, 3, 0, 0]].concat();
    let as_u16: Vec<u8> = HALVES.as_flattened().iter().flat_map(|w| ((w * 65534.0) as u16).to_le_bytes()).collect();
    let normalized = ",\"normalized\":true";
    for (joints, weights, component, more) in [
        ("u8", half_weights(), 5126, ""),
        ("u16", half_weights(), 5126, ""),
        ("u8", as_u8, 5121, normalized),
        ("u16", as_u16, 5123, normalized),
    ] {
        let mut file = bar(joints, &weights, component, more);
        let aside = file.floats(&[turn([0.0, 0.0, 1.0], 0.0), turn([0.0, 0.0, 1.0], FRAC_PI_2)]);
        let ahead = file.floats(&[turn([1.0, 0.0, 0.0], 0.0), turn([1.0, 0.0, 0.0], FRAC_PI_2)]);
        for values in [aside, ahead] {
            animate(&mut file, 2, "rotation", "LINEAR", &[0.0, 1.0], values);
        }
        // Two clips of four seconds, bent from the first on.
        let model = loaded(file.glb(), "a.glb");
        assert_eq!(model.warnings, [""; 0]);
        let order: Vec<usize> = model.mesh.positions().iter().map(|p| (2.0 * p.y + p.x + 0.5) as usize).collect();
        let at_rest = |vertex: usize| model.mesh.positions()[vertex].to_array().map(f64::from);
        for step in 0..16 {
            let seconds = f64::from(step) / 16.0;
            let (sine, cosine) = (seconds * FRAC_PI_2).sin_cos();
            for clip in 0..2 {
                let pose = rig(&model).pose(&model.mesh, clip, seconds).mesh;
                for (vertex, &place) in order.iter().enumerate() {
                    let [x, y, z] = at_rest(vertex);
                    let weight = [0.0, 0.5, 1.0][place / 2];
                    let above = y - 1.0;
                    // Positions, and (0, 0, 1), where the upper joint puts them.
                    let (moved, normal) = match clip {
                        0 => ([cosine * x - sine * above, 1.0 + sine * x + cosine * above, z], [0.0, 0.0, 1.0]),
                        _ => ([x, 1.0 + cosine * above, sine * above], [0.0, -sine, cosine]),
                    };
                    let expected = [0, 1, 2].map(|i| (1.0 - weight) * [x, y, z][i] + weight * moved[i]);
                    let (found, found_normal) = (pose.positions()[vertex], pose.normals()[vertex]);
                    assert!(are_near(found, expected, 1e-6), "{clip} {seconds} {vertex}: {found}");
                    // A blend of two rotations about x by w shrinks by one factor along y and z, so its normals go with it.
                    let normal = [0, 1, 2].map(|i| (1.0 - weight) * [0.0, 0.0, 1.0][i] + weight * normal[i]);
                    let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
                    let normal = normal.map(|c| c / length);
                    assert!(are_near(found_normal, normal, 1e-6), "{clip} {seconds} {vertex}: {found_normal}");
                }
                assert_eq!((pose.triangles(), pose.surfaces()), (model.mesh.triangles(), model.mesh.surfaces()));
            }
        }
    }
}

/// Without an animation a skinned mesh is where its joints put it at rest.
#[test]
fn a_skinned_mesh_at_rest_is_where_its_joints_are() {
    let mut file = bar("u8", &half_weights(), 5126, "");
    let quarter = list(&turn([0.0, 0.0, 1.0], FRAC_PI_2));
    file.lists.get_mut("nodes").unwrap()[2] = format!("{{\"translation\":[0,1,0],\"rotation\":{quarter}}}");
    let model = loaded(file.glb(), "a.glb");
    assert!(model.rig.is_none() && model.warnings.is_empty());
    let last = model.mesh.positions().iter().fold(Vec3::ZERO, |last, p| if p.x < last.x { *p } else { last });
    assert!(are_near(last, [-1.0, 1.5, 0.0], 1e-6) || are_near(last, [-1.0, 0.5, 0.0], 1e-6), "{last}");
}

/// Normals that the file does not give move with the faces that they were computed from.
#[test]
fn normals_that_were_found_move_too() {
    let mut file = with_shape(&shapes::torus(12, 6));
    let values = file.floats(&[[1.0, 1.0, 1.0], [1.0, 3.0, 0.5]]);
    animate(&mut file, 0, "scale", "LINEAR", &[0.0, 1.0], values);
    let model = loaded(file.glb(), "a.glb");
    let pose = rig(&model).pose(&model.mesh, 0, 0.5).mesh;
    for (at_rest, now) in model.mesh.normals().iter().zip(pose.normals()) {
        // By the inverse of the scale, (1, 2, 0.75).
        let expected = Vec3::new(at_rest.x, at_rest.y / 2.0, at_rest.z / 0.75).normalize();
        assert!((*now - expected).length() < 1e-6, "{now} {expected}");
    }
}

/// A node that an animation turns inside out shows both sides, with normals that face the eye; turned back, it is as
/// before.
#[test]
fn a_mirrored_pose_is_not_drawn_from_its_inside() {
    for (at_rest, sign) in [("", 1.0), (",\"scale\":[-1,1,1]", -1.0)] {
        let mut file = with_shape(&shapes::cube());
        file.lists.get_mut("nodes").unwrap()[0] = format!("{{\"mesh\":0{at_rest}}}");
        let values = file.floats(&[[sign, 1.0, 1.0], [-sign, 1.0, 1.0], [sign, 1.0, 1.0]]);
        animate(&mut file, 0, "scale", "STEP", &[0.0, 1.0, 2.0], values);
        let model = loaded(file.glb(), "a.glb");
        assert!(model.mesh.is_convex() && model.mesh.is_outward());
        let [before, mirrored] = [0.5, 1.5].map(|seconds| rig(&model).pose(&model.mesh, 0, seconds).mesh);
        assert_eq!(before, model.mesh);
        assert!(mirrored.is_closed() && !mirrored.is_outward() && !mirrored.is_convex());
        // Faces and normals point to the same side.
        for &[a, b, c] in mirrored.triangles() {
            let [p, q, r] = [a, b, c].map(|i| mirrored.positions()[i as usize]);
            assert!((q - p).cross(r - p).dot(mirrored.normals()[a as usize]) > 0.0);
        }
    }
}

/// One renderer that follows a bending body, forwards and back, draws each pose as a new renderer does; a time that is
/// already shown changes nothing.
#[test]
fn a_body_that_bends_is_drawn_as_a_new_one() {
    let mut file = with_shape(&shapes::torus(12, 8));
    let values = file.floats(&[turn([0.0, 1.0, 0.0], 0.0), turn([0.0, 1.0, 0.0], FRAC_PI_4)]);
    animate(&mut file, 0, "rotation", "LINEAR", &[0.0, 1.0], values);
    let model = loaded(file.glb(), "a.glb");
    let rig = rig(&model).clone();
    let mut scene = Scene::showing(model.mesh.clone());
    let object = scene.object_ids()[0];
    let few = shapes::cube();
    assert!(rig.pose(&few, 0, 0.5).mesh == few, "a mesh that is not the rig's");
    let mut playback = Playback::new(rig, 0, &scene, object).expect("an object");
    let at_rest = scene.clone();
    let (mut renderer, mut vga) = (Renderer::new(), Box::new(Vga::new()));
    let mut pictures = Vec::new();
    for seconds in [0.0, 0.25, 0.5, 0.25, 0.0] {
        playback.show(&mut scene, seconds);
        let changed = |renderer: &mut Renderer| {
            let plan = renderer.make_plan(&scene, Screen::MODE_13H).expect("a plan");
            plan.objects()[0].is_on(Effect::Transform)
        };
        assert!(changed(&mut renderer), "{seconds}");
        renderer.draw(&scene, &mut vga).expect("a scene");
        playback.show(&mut scene, seconds);
        assert!(!renderer.make_plan(&scene, Screen::MODE_13H).expect("a plan").objects()[0].is_on(Effect::Transform));
        // Another scene does not show that time yet.
        let mut other = at_rest.clone();
        playback.show(&mut other, seconds);
        assert!(other[object].mesh().positions() == scene[object].mesh().positions(), "{seconds}");
        let mut fresh = Box::new(Vga::new());
        Renderer::new().draw(&scene, &mut fresh).expect("a scene");
        assert!(vga.pixels() == fresh.pixels(), "{seconds}");
        pictures.push(vga.pixels().to_vec());
    }
    assert!(pictures[0] == pictures[4] && pictures[1] == pictures[3]);
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
}

/// Two spheres, red and green; the second grows from one size to another in one second.
fn growing(from: f32, to: f32) -> Gltf {
    let (positions, indices) = points_of(&shapes::sphere(16, 8));
    let mut file = Gltf::default();
    let (position, index) = (file.floats(&positions), file.indices(&indices, 5125));
    for (material, [red, green], x) in [(0, [1, 0], -1.5), (1, [0, 1], 1.5)] {
        let color = format!("{{\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{red},{green},0,1]}}}}");
        file.add("materials", color);
        let more = format!(",\"indices\":{index},\"material\":{material}");
        let mesh = file.mesh(&format!("\"POSITION\":{position}"), &more);
        file.add("nodes", format!("{{\"mesh\":{mesh},\"translation\":[{x},0,0]}}"));
    }
    let values = file.floats(&[[from; 3], [to; 3]]);
    animate(&mut file, 1, "scale", "LINEAR", &[0.0, 1.0], values);
    file
}

/// An automatic palette covers what is visible while a model plays, not only what is visible at rest.
#[test]
fn a_palette_is_for_the_whole_animation() {
    let made = |file: Gltf, rounds: f64| -> AutomaticPalette {
        let model = loaded(file.glb(), "a.glb");
        let mut scene = composed(Object::new(model.mesh.clone()), &[], None).expect("a scene");
        let period = rig(&model).clips()[0].duration();
        scene.duration = rounds * period;
        let playback = Playback::new(rig(&model).clone(), 0, &scene, scene.object_ids()[0]).expect("an object");
        playback.show_in(&mut scene, 0.0);
        auto_palette::of_moving_scene(&scene, &[period], |scene, seconds| playback.show_in(scene, seconds))
            .expect("a scene")
    };
    let entries = |made: &AutomaticPalette| match made.entries[0][1] {
        Entries::Ramp { ramp, .. } => ramp.entries(),
        other => panic!("{other:?}"),
    };
    let [grows, shrinks, hides] =
        [(0.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(from, to)| entries(&made(growing(from, to), 1.0)));
    assert!(grows > hides && grows.abs_diff(shrinks) < 16, "{grows} {shrinks} {hides}");
    // However often it plays in a round of the scene.
    for rounds in [2.0, 8.0, 16.0, 48.0] {
        let often = entries(&made(growing(0.0, 1.0), rounds));
        assert!(grows.abs_diff(often) < 16, "{rounds}: {often}, not {grows}");
    }
}

/// A cube with clips called `translation`, `scale` and, without a name, a second move: to x = 1, twice as large, to x = 2.
fn with_clips() -> Gltf {
    let mut file = with_shape(&shapes::cube());
    for (path, end) in [("translation", [1.0, 0.0, 0.0]), ("scale", [2.0; 3]), ("translation", [2.0, 0.0, 0.0])] {
        let start = if path == "scale" { [1.0; 3] } else { [0.0; 3] };
        let values = file.floats(&[start, end]);
        animate(&mut file, 0, path, "LINEAR", &[0.0, 1.0], values);
    }
    file
}

#[test]
fn a_clip_is_found_by_name_or_number() {
    let model = loaded(with_clips().glb(), "a.glb");
    let found = |word: &str| rig(&model).find_clip(word).map_err(|unknown| unknown.to_string());
    for (word, clip) in [("translation", 0), ("scale", 1), ("0", 0), ("1", 1), ("2", 2)] {
        assert_eq!(found(word), Ok(clip), "{word}");
    }
    let known = "the model has 0: translation, 1: scale, 2: translation";
    for word in ["3", "-1", "Scale", "", "18446744073709551616"] {
        assert_eq!(found(word), Err(format!("no animation {word}; {known}")));
    }
    // A name takes precedence over a number; a clip without a name has only its number.
    let edited = |from: &str, to: &str| {
        let mut file = with_clips();
        file.replace("animations", from, to);
        loaded(file.glb(), "a.glb")
    };
    let model = edited("\"name\":\"scale\"", "\"name\":\"0\"");
    assert_eq!(rig(&model).find_clip("0"), Ok(1));
    let model = edited("\"name\":\"translation\",", "");
    assert_eq!(
        rig(&model).find_clip("x").expect_err("none").to_string(),
        "no animation x; the model has 0 (unnamed), 1: scale, 2 (unnamed)"
    );
}

/// The key `clip` of a scene's model.
#[test]
fn a_scene_chooses_the_clip_of_a_model() {
    let glb = with_clips().glb();
    let open = |path: &Path| -> io::Result<Box<dyn io::BufRead>> {
        match path.to_str() {
            Some("a.glb") => Ok(Box::new(io::Cursor::new(glb.clone()))),
            Some("a.stl") => {
                Ok(Box::new(io::Cursor::new(&include_bytes!("../../../tests/corpus/stl/tetrahedron")[..])))
            }
            _ => Err(io::ErrorKind::NotFound.into()),
        }
    };
    let read = |object: &str, keys: &str| {
        let text = format!("[[objects]]\n{object}\n{keys}");
        Scene::from_toml_bytes(text.as_bytes(), Path::new("a.toml"), open)
    };
    for (keys, size, middle) in [
        ("", 1.0, 0.5),
        ("clip = 'translation'", 1.0, 0.5),
        ("clip = 'scale'", 1.5, 0.0),
        ("clip = 1", 1.5, 0.0),
        ("clip = '1'", 1.5, 0.0),
        ("clip = 2", 1.0, 1.0),
    ] {
        let mut loaded = read("model = 'a.glb'", keys).expect(keys);
        let at_rest = loaded.scene.objects()[0].mesh().bounds();
        loaded.playbacks[0].show(&mut loaded.scene, 0.5);
        let moved = loaded.scene.objects()[0].mesh().bounds();
        assert_eq!((moved.radius / at_rest.radius, moved.centre.x - at_rest.centre.x), (size, middle), "{keys}");
    }
    let known = "the model has 0: translation, 1: scale, 2: translation";
    let expected = "expected the name of an animation, or its number, from 0";
    for (object, clip, says) in [
        ("model = 'a.glb'", "'run'", format!("no animation run; {known}")),
        ("model = 'a.glb'", "3", format!("no animation 3; {known}")),
        ("model = 'a.glb'", "-1", format!("{expected}, found -1")),
        ("model = 'a.glb'", "1.0", format!("{expected}, found floating point `1.0`")),
        ("model = 'a.stl'", "0", "the model has no animation".into()),
        ("shape = 'cube'", "0", "only a model has animations".into()),
    ] {
        let error = read(object, &format!("clip = {clip}")).expect_err(&says);
        assert_eq!(error.to_string(), format!("a.toml:3:8: key `objects[0].clip`: {says}"));
    }
}

/// A camera and a lamp on moving nodes.
#[test]
fn lights_and_the_camera_move_with_their_nodes() {
    let mut file = with_lights(with_shape(&shapes::cube()), &[("\"type\":\"point\"", "\"translation\":[0,4,0],")]);
    file.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.75,\"znear\":0.25}}");
    file.add("nodes", "{\"camera\":0,\"translation\":[0,0,8]}");
    file.add("nodes", "{\"children\":[1,2]}");
    let values = file.floats(&[[0.0, 0.0, 0.0], [4.0, 0.0, 2.0]]);
    animate(&mut file, 3, "translation", "LINEAR", &[0.0, 4.0], values);
    let model = loaded(file.glb(), "a.glb");
    let at_rest: Camera = model.camera.expect("a camera");
    let pose = rig(&model).pose(&model.mesh, 0, 2.0);
    let by = Vec3::new(2.0, 0.0, 1.0);
    assert_eq!(pose.camera, Some(Camera { eye: at_rest.eye + by, target: at_rest.target + by, ..at_rest }));
    let [Light::Lamp { position, .. }] = *pose.lights.as_slice() else { panic!("{:?}", pose.lights) };
    assert_eq!(position, Vec3::new(2.0, 4.0, 1.0));
    assert_eq!(pose.mesh, model.mesh);
    let mut scene = composed(Object::new(model.mesh.clone()), &model.lights, model.camera).expect("a scene");
    let (rig, object) = (rig(&model).clone(), scene.object_ids()[0]);
    let mut playback = Playback::new(rig, 0, &scene, object).expect("an object").with_lights_and_camera(true, true);
    scene.lights_mut()[0] = scene.lights()[0].with_intensity(0.125);
    playback.show(&mut scene, 2.0);
    assert_eq!((Some(scene.camera), scene.lights()[0].intensity()), (pose.camera, 0.125));
    assert!(matches!(scene.lights()[0], Light::Lamp { position, .. } if position == Vec3::new(2.0, 4.0, 1.0)));
    playback.release_camera();
    scene.camera = at_rest;
    playback.show(&mut scene, 3.0);
    assert_eq!(scene.camera, at_rest);
}

#[test]
fn errors_of_motion_say_their_part() {
    let refused = |file: &Gltf| refused(file.glb(), "a.glb");
    let moving = |times: &[f32], rows: usize, way: &str| {
        let mut file = with_shape(&shapes::cube());
        let values = file.floats(&vec![[0.0; 3]; rows]);
        animate(&mut file, 0, "translation", way, times, values);
        refused(&file)
    };
    assert_eq!(moving(&[0.0, 1.0], 2, "LINEAR"), "read");
    for (times, rows, way, said) in [
        (&[0.0, 1.0][..], 1, "LINEAR", "1 values for 2 keys"),
        (&[0.0, 1.0], 5, "CUBICSPLINE", "5 values for 2 keys"),
        (&[0.0, 2.0, 1.0], 3, "STEP", "key 2 is before key 1"),
        (&[f32::NAN], 1, "STEP", "a key at time NaN"),
    ] {
        assert_eq!(moving(times, rows, way), format!("a.glb: animations[0].samplers[0]: {said}"));
    }
    assert!(moving(&[0.0], 1, "BOUNCE").starts_with("a.glb: animations[0].samplers[0].interpolation: "));
    let edited = |list: &'static str, from: &str, to: &str| {
        let mut file = bar("u8", &half_weights(), 5126, "");
        let values = file.floats(&[[0.0; 3]]);
        animate(&mut file, 2, "translation", "STEP", &[0.0], values);
        file.replace(list, from, to);
        refused(&file)
    };
    for (list, from, to, said) in [
        ("nodes", "", "", "read"),
        ("animations", "\"node\":2", "\"node\":9", "a.glb: animations[0].channels[0]: its node does not exist"),
        ("animations", "\"translation\"}", "\"pointer\"}", "read"),
        ("skins", "[1,2]", "[1]", "a.glb: meshes[0].primitives[0]: there is no joint 1, only 1"),
        ("skins", "[1,2]", "[1,2,0]", "a.glb: skins[0]: 2 inverse bind matrices for 3 joints"),
    ] {
        assert_eq!(edited(list, from, to), said);
    }
    assert!(edited("skins", "[1,2]", "[1,9]").starts_with("a.glb: skins[0].joints[1]: "));
    assert!(edited("skins", "\"joints\"", "\"skeleton\":9,\"joints\"").starts_with("a.glb: skins[0].skeleton: "));
    let mut file = bar("u8", &half_weights(), 5126, "");
    file.add("nodes", "{\"children\":[3]}");
    file.add("scenes", "{\"nodes\":[0,1]}");
    file.lists.get_mut("skins").unwrap()[0] = "{\"joints\":[1,3]}".into();
    assert_eq!(refused(&file), "a.glb: skins[0]: nodes[3] is in a cycle");
    assert!(
        refused(&with_lights(with_shape(&shapes::cube()), &[("\"type\":\"sky\"", "")]))
            .starts_with("a.glb: extensions.")
    );
}
