//! The engine against the truth: every shading that claims a bound, on every scene.

use std::sync::LazyLock;

use crate::support::tried::Tried;
use crate::support::vector::{cross, dot, sub, wide};
use crate::support::{scenes, shaded};
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::internals;
use mode13h::internals::span::channels::mix_cube;
use mode13h::internals::span::dither::ThresholdRow;
use mode13h::light::{Light, Material, RampChoice};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::builtin;
use mode13h::plan::Effect;
use mode13h::raster::RasterError;
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::{Camera, Object, Scene, Shared};
use mode13h::settings::{Accuracy, HiddenSurfaces, Shading, VertexPath};
use mode13h::vga::Vga;
use mode13h_conformance::Random;
use mode13h_lab::cost::{Probe, ProbeError};
use mode13h_lab::truth::{Bound, ErrorMap, Face, Screen, Shown, Standard, Truth, TruthFrame};

const SCREEN: Screen = Screen::MODE_13H;

fn truth(scene: &Scene) -> Truth<'_> {
    Truth::new(scene, SCREEN).expect("a legal scene")
}

fn probe(shading: Shading) -> Probe {
    Probe::new(shaded(shading))
}

fn look(scene: &Scene, shading: Shading) -> Shown {
    probe(shading).look(scene, SCREEN).expect("a legal scene")
}

fn compare(frame: &TruthFrame, shown: &Shown) -> ErrorMap {
    ErrorMap::new(frame, shown).expect("of one size")
}

/// Every scene, the shipped ones at two more moments of their duration. They are loaded once.
fn all() -> Vec<(String, Scene)> {
    static ALL: LazyLock<Vec<(String, Scene)>> = LazyLock::new(load);
    ALL.clone()
}

fn load() -> Vec<(String, Scene)> {
    let mut all = scenes::all();
    all.push(("parents".to_string(), scenes::parents()));
    for shipped in &mode13h_assets::shipped::ALL {
        for part in [0.05, 0.73] {
            let mut scene = shipped.load().expect("a scene that loads").scene;
            scene.set_time(part * scene.duration);
            all.push((format!("scene {} at {part}", shipped.name), scene));
        }
    }
    // A split mesh is a different one, about which this one's vertices say little.
    all.iter_mut().for_each(|(_, scene)| scene.settings.tessellation = None);
    all
}

/// How far a vertex on the screen may be from its true position, in pixels: half of 1/256 for rounding, and the error
/// of f32: 2⁻²⁴ of the largest terms of a coordinate, about 2¹¹ pixels, several times over.
const VERTEX: f64 = 0.5 / 256.0 + 0.001;

/// Points around a pixel's centre, as far away as a vertex may be off, and in between.
fn about(x: usize, y: usize) -> impl Iterator<Item = (f64, f64)> {
    let at = |i: i32| VERTEX * f64::from(i) / 4.0;
    (-4..=4).flat_map(move |i| (-4..=4).map(move |j| (x as f64 + 0.5 + at(i), y as f64 + 0.5 + at(j))))
}

/// Returns whether vertices moved by that little, or depths rounded to 30 bits, suffice for `shown` to be seen at a
/// pixel instead of `right`.
fn may_be_taken_for(
    truth: &Truth,
    near: f32,
    right: Option<Face>,
    shown: Option<Face>,
    (x, y): (usize, usize),
) -> bool {
    about(x, y).any(|(x, y)| {
        let met = |face: Option<Face>| face.and_then(|face| truth.sampling(face, x, y)).map(|pixel| 1.0 / pixel.w);
        match (met(right), met(shown)) {
            // An edge of the right face passes here.
            (None, None) => shown.is_none() && right.is_some(),
            (None, Some(_)) => true,
            // At the same depth: both are rounded, and interpolated to within a unit.
            (Some(right), Some(shown)) => (right - shown) * f64::from(near) <= 4.0 / 1_073_741_824.0,
            (Some(_), None) => false,
        }
    })
}

/// Fails at pixels that show the wrong face without reason. Returns how many show another one with reason.
fn check_cover(name: &str, scene: &Scene, truth: &Truth, frame: &TruthFrame, shown: &Shown) -> usize {
    let mut others = 0;
    for (place, (right, &shown)) in frame.pixels.iter().zip(&shown.faces).enumerate() {
        let right = right.map(|pixel| pixel.face);
        if right != shown {
            let (x, y) = (place % 320, place / 320);
            assert!(
                may_be_taken_for(truth, scene.camera.near, right, shown, (x, y)),
                "{name}: ({x}, {y}) shows {shown:?} in place of {right:?}"
            );
            others += 1;
        }
    }
    others
}

/// Intensities in f32, before they are rounded to 1/256 shade: a few parts in 2²⁴ of 255 shades, and a few dozen parts
/// for a highlight.
const F32: f64 = 0.01;

/// By how many shades the true value at a pixel changes over 1/256 pixel across and down: estimated from neighbours on
/// the same face, a pixel away, plus a quarter for curvature. `None` where a face has no other pixel in the row or the
/// column: it is one pixel wide there, and the change of its shades is unknown.
fn over_a_unit(frame: &TruthFrame, place: usize) -> Option<f64> {
    let (x, y) = (place % 320, place / 320);
    let here = frame.pixels[place]?;
    let change = |x: Option<usize>, y: Option<usize>| {
        let there = frame.pixels[x.filter(|x| *x < 320)? + 320 * y.filter(|y| *y < 200)?]?;
        let apart = (0..3).map(|i| (there.intensity[i] - here.intensity[i]).abs()).fold(0.0, f64::max);
        (there.face == here.face).then_some(apart)
    };
    let most = |one: Option<f64>, other: Option<f64>| one.into_iter().chain(other).reduce(f64::max);
    let across = most(change(x.checked_sub(1), Some(y)), change(Some(x + 1), Some(y)))?;
    let down = most(change(Some(x), y.checked_sub(1)), change(Some(x), Some(y + 1)))?;
    Some(1.25 * 255.0 * (across + down) / 256.0)
}

/// Pixels beyond the bound, by what exempts them from it.
#[derive(Default)]
struct Exempt {
    /// A coordinate was rounded to the unit next to the right one, as happens to one in a hundred because the engine's
    /// come from f32; or the face is clipped and has new corners, which are rounded too. Either moves shades by no more
    /// than a unit.
    moved: u64,
    /// Beyond the bound on a face one pixel wide, where nothing says how its shades change.
    narrow: u64,
}

/// Compares every pixel with the bound itself. One beyond it without a reason fails.
fn beyond(what: &str, frame: &TruthFrame, errors: &ErrorMap, bound: f64) -> Exempt {
    let mut exempt = Exempt::default();
    for (place, error) in errors.errors().enumerate() {
        let Some(error) = error.filter(|error| *error > bound) else { continue };
        match over_a_unit(frame, place) {
            Some(change) => {
                let at = (place % 320, place / 320);
                assert!(
                    error <= bound + change,
                    "{what}: {error:.4} at {at:?}, {bound:.4} and {change:.4} are allowed"
                );
                exempt.moved += 1;
            }
            None => exempt.narrow += 1,
        }
    }
    exempt
}

/// Checks every shading that claims a bound, and is linear between vertices, on a scene.
///
/// Adds the exempt pixels to `sum`.
fn check_linear(tried: &mut Tried, name: &str, scene: &Scene, sum: &mut Exempt) {
    let truth = truth(scene);
    let right = [Standard::Gouraud, Standard::GouraudPerspective].map(|standard| truth.draw(standard));
    for shading in Shading::ALL {
        let Some(Bound { standard, shades }) = Bound::of(shading, SCREEN.width) else { continue };
        if standard == Standard::Lit {
            continue;
        }
        let shown = look(scene, shading);
        let frame = &right[usize::from(standard == Standard::GouraudPerspective)];
        let errors = compare(frame, &shown);
        let figures = errors.figures();
        // Any pixel, exempt or not, must be within the bound rounded up to whole shades.
        assert!(figures.max <= shades.ceil(), "{name}, {shading}: {:.3} shades from {standard}", figures.max);
        let exempt = beyond(&format!("{name}, {shading}"), frame, &errors, shades + F32);
        // Whatever exempts them, they are few.
        let (Exempt { moved, narrow }, all) = (exempt, figures.count);
        assert!((moved + narrow) * 1_000 <= all, "{name}, {shading}: {moved} and {narrow} of {all} beyond {shades:.4}");
        (sum.moved, sum.narrow) = (sum.moved + moved, sum.narrow + narrow);
        tried.add(figures.count);
        tried.worst("shades", figures.max);
        let others = check_cover(name, scene, &truth, frame, &shown);
        tried.worst("pixels of another face", others as f64);
        assert_eq!(others, errors.cover_errors());
        // With the same rounding they differ in one pixel of thousands.
        assert!(others <= 5, "{name}, {shading}: {others} pixels show another face");
    }
}

/// Checks them on all of these scenes, and reports what was exempt.
fn check_all_linear(mut tried: Tried, scenes: impl Iterator<Item = (String, Scene)>) {
    let mut sum = Exempt::default();
    for (name, scene) in scenes {
        check_linear(&mut tried, &name, &scene, &mut sum);
    }
    tried.worst("pixels exempt as vertices are moved", sum.moved as f64);
    tried.worst("as faces are a pixel wide", sum.narrow as f64);
}

/// The least number of pixels to compare; the shipped scenes are files.
const STATED: u64 = 1_000_000;

#[test]
fn linear_shadings_keep_their_bounds_on_every_scene() {
    check_all_linear(Tried::new("linear_shadings_keep_their_bounds_on_every_scene", STATED), all().into_iter());
}

#[test]
fn linear_shadings_keep_their_bounds_on_random_scenes() {
    let mut random = Random::named("truth linear");
    let scenes = (0..12).map(|i| (format!("random scene {i}"), scenes::random(&mut random)));
    check_all_linear(Tried::new("linear_shadings_keep_their_bounds_on_random_scenes", 200_000), scenes);
}

/// Light at every pixel is right except for rounding a shade to 1/256 and to a byte, and for rounding vertices. The
/// latter moves the point of a face seen at a pixel p: with the weights λ of its corners there, each moved by δ, it is
/// the point that should be seen at p − Σ λδ, no farther from p than a vertex is moved.
fn check_lit(tried: &mut Tried, name: &str, scene: &Scene) {
    let (truth, shown) = (truth(scene), look(scene, Shading::Phong));
    let frame = truth.draw(Standard::Lit);
    let errors = compare(&frame, &shown);
    for (place, (error, right)) in errors.errors().zip(&frame.pixels).enumerate() {
        let (Some(error), Some(right)) = (error, right) else { continue };
        // 1/512, and f32.
        let rounding = 0.5 + 1.0 / 512.0 + 0.01;
        tried.add(1);
        if error <= rounding {
            continue;
        }
        let (x, y) = (place as u32 % 320, place as u32 / 320);
        let allowed = rounding + truth.rounding_shift(right.face, x, y).unwrap_or_default();
        assert!(error <= allowed, "{name}: ({x}, {y}) is {error:.3} off, {allowed:.3} are explained");
        tried.worst("shades off that vertices explain", error);
    }
    let others = check_cover(name, scene, &truth, &frame, &shown);
    assert_eq!(others, errors.cover_errors());
    tried.worst("pixels of another face", others as f64);
    assert!(errors.share_within(1.0) > 0.999, "{name}: {}", errors.share_within(1.0));
}

#[test]
fn phong_is_lit_at_every_pixel_on_every_scene() {
    let mut tried = Tried::new("phong_is_lit_at_every_pixel_on_every_scene", STATED);
    for (name, scene) in all() {
        check_lit(&mut tried, &name, &scene);
    }
}

/// An object reflects its own colour, and its highlight has another one: white by default.
#[test]
fn phong_is_lit_at_every_pixel_where_body_and_highlight_differ_in_color() {
    let mut tried = Tried::new("phong_is_lit_at_every_pixel_where_body_and_highlight_differ_in_color", 20_000);
    for highlight in [[1.0; 3], [0.2, 0.6, 1.0]] {
        let mut scene = Scene::new();
        let mut object = Object::new(shapes::sphere(24, 12));
        let (ambient, diffuse) = (0.1, 0.7);
        let (color, specular, shininess) = ([0.8, 0.4, 0.2], 0.4, 8.0);
        object.materials[0] =
            Material { ambient, diffuse, specular, shininess, color, highlight, ..Material::default() };
        scene.add(object);
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        scene.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
        check_lit(&mut tried, &format!("highlight {highlight:?}"), &scene);
    }
}

#[test]
fn phong_is_lit_at_every_pixel_on_random_scenes() {
    let mut tried = Tried::new("phong_is_lit_at_every_pixel_on_random_scenes", 100_000);
    let mut random = Random::named("truth lit");
    for i in 0..12 {
        check_lit(&mut tried, &format!("random scene {i}"), &scenes::random(&mut random));
    }
}

/// Copies of the objects with each face's own normal at its corners; and with each face divided into three that meet in
/// its middle.
fn flattened(scene: &Scene) -> [Scene; 2] {
    let [mut flat, mut parted] = [scene.clone(), scene.clone()];
    for (i, object) in scene.objects().iter().enumerate() {
        let with = |mesh: Mesh| internals::with_mesh(object, Shared::new(mesh), object.materials.clone());
        let mut mesh = object.mesh().clone();
        mesh.flat();
        flat.objects_mut()[i] = with(mesh);
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for corners in object.mesh().triangles() {
            let [a, b, c] = corners.map(|corner| object.mesh().positions()[corner as usize]);
            let first = positions.len() as u32;
            positions.extend([a, b, c, a / 3.0 + b / 3.0 + c / 3.0]);
            triangles.extend([[0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|corners| corners.map(|corner| first + corner)));
        }
        let normals = vec![Vec3::Z; positions.len()];
        parted.objects_mut()[i] = with(Mesh::with_normals(positions, normals, triangles).expect("a mesh"));
    }
    [flat, parted]
}

/// Position of a face's middle on the screen, in pixels: the corner that its three parts share. `None` if it is
/// clipped, or rounding leaves a part without area.
fn middle(parted: &Truth, face: Face) -> Option<[f64; 2]> {
    let parts = [0, 1, 2].map(|part| parted.rounded_triangles(Face { triangle: 3 * face.triangle + part, ..face }));
    let [[a], [b], [c]] = parts.each_ref().map(Vec::as_slice) else { return None };
    let mut common = a.iter().filter(|corner| b.contains(corner) && c.contains(corner));
    let ([x, y], None) = (common.next()?, common.next()) else { return None };
    Some([*x as f64 / 256.0, *y as f64 / 256.0])
}

/// A flat face has the model's shade at its middle, with its own normal: ½ for the byte, 1/512 for the shade, f32, and
/// the change of the light within the distance that the middle may be off.
#[test]
fn flat_faces_have_the_light_at_their_middle() {
    let mut tried = Tried::new("flat_faces_have_the_light_at_their_middle", STATED / 4);
    for (name, scene) in all() {
        let shown = look(&scene, Shading::Flat);
        let [flat, parted] = flattened(&scene);
        let (truth, parted) = (truth(&flat), self::truth(&parted));
        let mut shades = std::collections::BTreeMap::new();
        for (face, shade) in shown.faces.iter().zip(&shown.shades) {
            let Some(face) = *face else { continue };
            let right = shades.entry(face).or_insert_with(|| {
                let [x, y] = middle(&parted, face)?;
                let at = |dx: f64, dy: f64| Some(truth.sampling(face, x + VERTEX * dx, y + VERTEX * dy)?.intensity);
                let right = at(0.0, 0.0)?;
                let mut moved = 0.0_f64;
                for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
                    let near = at(dx, dy)?;
                    moved = (0..3).fold(moved, |most, i| most.max((near[i] - right[i]).abs()));
                }
                Some((right, 0.5 + 1.0 / 512.0 + F32 + 2.0 * 255.0 * moved))
            });
            let Some((right, allowed)) = right else { continue };
            let error = (0..3).fold(0.0, |most, i| f64::max(most, (shade[i] - 255.0 * right[i]).abs()));
            assert!(error <= *allowed, "{name}: {face:?} is {error:.3} off its middle's shade, not {allowed:.3}");
            tried.add(1);
            tried.worst("shades", error);
        }
    }
}

/// Shadings that claim no bound are measured like all others, and splitting brings linear shades nearer to `lit`.
#[test]
fn shadings_without_a_bound_are_measured() {
    let mut tried = Tried::new("shadings_without_a_bound_are_measured", 8 * STATED / 10);
    let (mut split, mut linear) = (0.0, 0.0);
    for (name, scene) in all() {
        let truth = truth(&scene);
        let frame = truth.draw(Standard::Lit);
        let rms = |shading: Shading| {
            let figures = compare(&frame, &look(&scene, shading)).figures();
            assert!(figures.max.is_finite() && figures.rms() <= figures.max + 1e-9, "{name}, {shading}: {figures:?}");
            (figures.rms(), figures.count)
        };
        let (reseeded, _) = rms(Shading::Gouraud88Reseeded);
        for shading in Shading::ALL.into_iter().filter(|shading| Bound::of(*shading, SCREEN.width).is_none()) {
            let (rms, count) = rms(shading);
            tried.add(count);
            if shading == Shading::GouraudTessellated {
                // The split faces' corners are rounded again, and a byte adds half a shade.
                assert!(rms <= reseeded + 0.5, "{name}: {rms} split, {reseeded} not");
                (split, linear) = (split + rms, linear + reseeded);
            }
        }
    }
    assert!(split < 0.5 * linear, "{split} split, {linear} not");
}

// The probe

/// The probe reports what the engine draws.
#[test]
fn the_probe_shows_what_is_drawn() {
    for (name, scene) in scenes::all() {
        let (drawn, in_color) = {
            let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
            let mut scene = scene.clone();
            // As the probe sees it: grey, 256 shades, nothing applied to them.
            scene.palette = Some(builtin::GREY.clone());
            scene.fog = None;
            scene.settings.dither = None;
            for material in scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials) {
                *material = Material { texture: None, environment: None, ..material.clone() };
                material.ramp = Material::default().ramp;
                material.blend = Material::default().blend;
            }
            renderer.draw(&scene, &mut vga).expect("a legal scene");
            (vga.pixels().to_vec(), renderer.plan().is_on_anywhere(Effect::RgbChannels))
        };
        let shown = Probe::new(Renderer::new()).look(&scene, SCREEN).expect("a legal scene");
        for ((face, shades), &drawn) in shown.faces.iter().zip(&shown.shades).zip(&drawn) {
            if face.is_some() && !in_color {
                assert_eq!(*shades, [f64::from(drawn); 3], "{name}");
            }
        }
    }
}

/// Channels are mixed into the colour that is drawn.
#[test]
fn the_probe_shows_the_channels_that_are_mixed() {
    let mut scene = crate::support::scenes::framed(shapes::sphere(24, 12));
    scene.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
    scene.add_light(Light::sun([-1.0, 0.5, 0.5]).with_color([1.0, 0.4, 0.2]));
    // A colourless object beside a coloured one: both use three channels, as the light is coloured.
    scene.add(Object::new(shapes::cube()));
    // The palette has no ramps, so materials that name one would be dithered.
    for material in scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials) {
        material.ramp = RampChoice::Nearest;
    }
    for shading in Shading::ALL {
        let (shown, mut vga) = (look(&scene, shading), Vga::new());
        shaded(shading).draw(&scene, &mut vga).expect("a legal scene");
        let mut seen = 0;
        for ((face, shades), &drawn) in shown.faces.iter().zip(&shown.shades).zip(vga.pixels()) {
            if face.is_some() {
                // Shades from 0 to 255.
                let [r, g, b] = shades.map(|shade| shade as u8);
                let mut mixed = [0];
                mix_cube(&mut mixed, &[r], &[g], &[b], &ThresholdRow::new(&[128]), 0);
                assert_eq!(mixed[0], drawn, "{shading}");
                seen += 1;
            }
        }
        assert!(seen > 10_000);
    }
    // What the renderer drew before, through the probe, leaves no traces.
    let mut probe = probe(Shading::Phong);
    probe.look(&scene, SCREEN).expect("a legal scene");
    let (mut by_probe, mut fresh) = (Vga::new(), Vga::new());
    probe.renderer().draw(&scene, &mut by_probe).expect("a legal scene");
    shaded(Shading::Phong).draw(&scene, &mut fresh).expect("a legal scene");
    assert!(by_probe.pixels() == fresh.pixels());
}

/// Pixels that are not compared could hide errors, so they must be few. Faces are found wherever objects are, whatever
/// their parents and whether they are visible: all that remains are edges moved by rounded vertices.
#[test]
fn nearly_every_covered_pixel_is_compared() {
    for (name, scene) in all() {
        let frame = truth(&scene).draw(Standard::Lit);
        for shading in [Shading::default(), Shading::Flat, Shading::Phong] {
            let share = compare(&frame, &look(&scene, shading)).share_not_compared();
            assert!(share < 0.005, "{name}, {shading}: {:.2} % not compared", 100.0 * share);
        }
    }
}

/// Face numbers of three digits, and the 16.16 path.
#[test]
fn the_probe_numbers_any_triangle() {
    let mut scene = Scene::new();
    for (n, x) in [(300_u32, -0.8), (20, 0.8)] {
        let wall = scene.add(Object::new(shapes::wall(n, n / 2)));
        scene[wall].position = Vec3::new(x, 0.0, 0.0);
        scene[wall].angles = [0.3, 0.2, 0.0].map(Angle::from_radians);
    }
    scene.add_light(Light::lamp([0.3, 0.4, 1.0], 3.0));
    let (truth, shown) = (truth(&scene), look(&scene, Shading::GouraudHyperbolic));
    let frame = truth.draw(Standard::GouraudPerspective);
    let errors = compare(&frame, &shown);
    let numbers: Vec<usize> = shown.faces.iter().flatten().map(|face| face.triangle).collect();
    assert!(numbers.iter().max() > Some(&65_536) && numbers.iter().min() < Some(&256));
    // Pixel-sized triangles: one in four has no pixel, and half of all pixels lie near an edge.
    assert_eq!(check_cover("many", &scene, &truth, &frame, &shown), errors.cover_errors());
    assert!(errors.cover_errors() * 100 < errors.figures().count as usize, "{}", errors.cover_errors());
    assert!(errors.figures().max <= 1.0, "{:?}", errors.figures());

    let mut torus = crate::support::scenes::framed(shapes::torus(48, 24));
    torus.objects_mut()[0].angles = [0.3, 0.2, 0.0].map(Angle::from_radians);
    let mut probe = probe(Shading::Gouraud88Reseeded);
    probe.renderer().settings.vertex_path = Some(VertexPath::Integer);
    let shown = probe.look(&torus, SCREEN).expect("a legal scene");
    let errors = compare(&self::truth(&torus).draw(Standard::Gouraud), &shown);
    // 16-bit angles, a tabulated sine and 16-bit normals are off by less than 1/1,000 of what a shade takes.
    assert!(errors.figures().mean() < 0.5 && errors.cover_errors() < 300, "{errors:?}");
}

#[test]
fn the_probe_refuses_what_cannot_be_drawn() {
    let scene = crate::support::scenes::framed(shapes::cube());
    let mut probe = Probe::new(Renderer::new());
    let too_wide = Screen { width: 5_000, ..SCREEN };
    assert!(matches!(probe.look(&scene, too_wide), Err(ProbeError::Screen(RasterError::Size { width: 5_000, .. }))));
    let none = Screen { width: 0, ..SCREEN };
    assert!(matches!(probe.look(&scene, none), Err(ProbeError::Screen(_))));
    let mut broken = scene.clone();
    broken.ambient = f32::NAN;
    assert_eq!(probe.look(&broken, SCREEN), Err(ProbeError::Scene(RenderError::Ambient)));
    assert!(probe.look(&scene, SCREEN).is_ok(), "it can be used on");
}

// Hard cases

/// An eye at the origin looking along −z. Returns the size in pixels of a unit at w = 1, across and down.
fn eye(scene: &mut Scene, near: f32) -> [f64; 2] {
    scene.camera = Camera { eye: Vec3::ZERO, target: Vec3::NEG_Z, up: Vec3::Y, near, ..Camera::default() };
    let down = 100.0 / f64::tan(Camera::FIELD_OF_VIEW.to_radians() / 2.0);
    [1.2 * down, down]
}

/// A triangle with corners at these screen positions and distances, lit at these intensities.
fn triangle(corners: [([f64; 2], f64, f64); 3], near: f32) -> Scene {
    let mut scene = Scene::new();
    let [fx, fy] = eye(&mut scene, near);
    let position = |([x, y], w, _): ([f64; 2], f64, f64)| {
        Vec3::new(((x - 160.0) * w / fx) as f32, (-(y - 100.0) * w / fy) as f32, -w as f32)
    };
    let normal = |(_, _, i): ([f64; 2], f64, f64)| Vec3::new(f64::sqrt(1.0 - i * i) as f32, 0.0, i as f32);
    let mesh = Mesh::with_normals(corners.map(position).to_vec(), corners.map(normal).to_vec(), vec![[0, 1, 2]]);
    let object = scene.add(Object::new(mesh.expect("a mesh")));
    scene[object].materials[0] = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene
}

/// How far a shading is from a standard on a scene; no pixel shows the wrong face without a reason.
fn figures(name: &str, scene: &Scene, shading: Shading, standard: Standard) -> mode13h_lab::truth::Figures {
    let (truth, shown) = (truth(scene), look(scene, shading));
    let frame = truth.draw(standard);
    check_cover(name, scene, &truth, &frame, &shown);
    compare(&frame, &shown).figures()
}

#[test]
fn c5_a_face_from_1_to_10_000_against_the_truth() {
    let mut tried = Tried::new("c5_a_face_from_1_to_10_000_against_the_truth", 300_000);
    let mut random = Random::named("c5 truth");
    let mut linear = 0.0_f64;
    for i in 0..60 {
        let mut corner = || {
            let place = [random.unit() * 420.0 - 50.0, random.unit() * 300.0 - 50.0];
            (place, f64::powf(10_000.0, random.unit()).max(1.001), 0.05 + 0.9 * random.unit())
        };
        let scene = triangle([corner(), corner(), corner()], 1.0);
        let name = format!("triangle {i}");
        let hyperbolic = figures(&name, &scene, Shading::GouraudHyperbolic, Standard::GouraudPerspective);
        assert!(hyperbolic.max <= 1.0, "{name}: {hyperbolic:?}");
        tried.worst("shades", hyperbolic.max);
        tried.add(hyperbolic.count);
        linear = linear.max(figures(&name, &scene, Shading::Gouraud88Reseeded, Standard::GouraudPerspective).max);
    }
    assert!(linear > 100.0, "linear shades show what is tried: {linear}");
}

#[test]
fn n7_a_highlight_inside_a_face_against_the_truth() {
    let mut tried = Tried::new("n7_a_highlight_inside_a_face_against_the_truth", 100_000);
    let mut scene = Scene::new();
    let wall = scene.add(Object::new(shapes::wall(1, 1)));
    scene[wall].materials[0] =
        Material { ambient: 0.1, diffuse: 0.2, specular: 0.6, shininess: 60.0, ..Material::default() };
    scene.add_light(Light::sun([0.2, 0.1, 1.0]));
    for angle in [0.0, 0.05, 0.1, 0.15] {
        scene[wall].angles = [0.5 * angle, angle, 2.0 * angle].map(Angle::from_radians);
        for (shading, most) in [
            // Light at every pixel: half a shade, and vertices.
            (Shading::Phong, 1.0),
            // Split until an edge is within a shade; the inside of a face may be off by as much again.
            (Shading::GouraudTessellated, 2.5),
        ] {
            let figures = figures("wall", &scene, shading, Standard::Lit);
            assert!(figures.max <= most, "{shading} at {angle}: {figures:?}");
            tried.worst(shading.name(), figures.max);
            tried.add(figures.count);
        }
        for shading in [Shading::Gouraud88, Shading::Gouraud88Reseeded, Shading::GouraudHyperbolic] {
            let figures = figures("wall", &scene, shading, Standard::Lit);
            assert!(figures.max > 50.0, "{shading} at {angle}: {figures:?}");
            tried.add(figures.count);
        }
    }
}

/// Checks that tiles show exactly what the whole frame does, pixel by pixel, and nothing else.
fn check_tiles(name: &str, scene: &Scene) {
    let truth = truth(scene);
    let whole = truth.draw(Standard::Lit);
    let mut tiles = truth.tiles();
    for (step, first) in [(1, 0), (4, 2), (7, 3)] {
        let mut frame = tiles.empty_frame();
        // In any order.
        (0..tiles.count()).rev().for_each(|tile| tiles.draw(tile, step, &mut frame));
        for (place, (pixel, right)) in frame.pixels.iter().zip(&whole.pixels).enumerate() {
            let (x, y) = (place as u32 % whole.width, place as u32 / whole.width);
            let is_drawn = x % step == first && y % step == first;
            assert_eq!(*pixel, right.filter(|_| is_drawn), "{name}: ({x}, {y}) by steps of {step}");
        }
    }
    for tile in (0..tiles.count()).filter(|&tile| tiles.is_empty(tile)) {
        let [columns, rows] = tiles.area(tile);
        let mut pixels = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        assert!(pixels.all(|(x, y)| whole.at(x, y).is_none()), "{name}: tile {tile} is not empty");
    }
}

#[test]
fn tiles_are_parts_of_the_whole_truth() {
    for (name, scene) in all() {
        check_tiles(&name, &scene);
    }
    let mut random = Random::named("tiles");
    for i in 0..10 {
        check_tiles(&format!("random scene {i}"), &scenes::random(&mut random));
    }
    // An eye inside the mesh: faces extend behind it, and are clipped.
    let mut within = Scene::showing(shapes::torus(24, 12));
    within.camera.eye = Vec3::new(0.7, 0.0, 0.05);
    within.camera.target = Vec3::new(0.0, 0.7, 0.0);
    check_tiles("within", &within);
}

// Models as scanners and exporters produce them.

/// A closed mesh of a few thousand faces as OBJ text: positions and faces, counted from 1.
#[derive(Clone)]
struct Written {
    positions: Vec<Vec3>,
    faces: Vec<[usize; 3]>,
}

impl Written {
    /// A sphere whose vertices are slightly displaced in or out.
    fn scan(random: &mut Random, radius: f32, centre: Vec3, stacks: u32) -> Self {
        let sphere = shapes::sphere(2 * stacks, stacks);
        // Vertices on its seam and at its poles are listed several times.
        let mut positions: Vec<Vec3> = Vec::new();
        let mut number = Vec::new();
        let mut written = Vec::new();
        for &p in sphere.positions() {
            let known = positions.iter().position(|&other| other == p).unwrap_or_else(|| {
                positions.push(p);
                written.push(centre + p * radius * (1.0 + 0.3 * (random.unit() as f32 - 0.5) / stacks as f32));
                positions.len() - 1
            });
            number.push(known + 1);
        }
        let faces = sphere.triangles().iter().map(|t| t.map(|i| number[i as usize])).collect();
        Self { positions: written, faces }
    }

    fn add(&mut self, other: &Self) {
        let before = self.positions.len();
        self.positions.extend(&other.positions);
        self.faces.extend(other.faces.iter().map(|face| face.map(|i| i + before)));
    }

    fn turned(mut self) -> Self {
        self.faces.iter_mut().for_each(|face| face.swap(1, 2));
        self
    }

    fn at(&self, i: usize) -> Vec3 {
        self.positions[i - 1]
    }

    fn push(&mut self, p: Vec3) -> usize {
        self.positions.push(p);
        self.positions.len()
    }

    fn both_ways(&mut self, [a, b, c]: [usize; 3]) {
        self.faces.extend([[a, b, c], [b, a, c]]);
    }

    /// Shuffled, so that of two faces at the same depth either may come first.
    fn load(mut self, random: &mut Random) -> mode13h_assets::model_file::Loaded {
        random.shuffle(&mut self.faces);
        let mut text = String::new();
        self.positions.iter().for_each(|p| text += &format!("v {} {} {}\n", p.x, p.y, p.z));
        self.faces.iter().for_each(|[a, b, c]| text += &format!("f {a} {b} {c}\n"));
        let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        mode13h_assets::model_file::obj::parse(text.as_bytes(), "scan.obj", none).expect("a model")
    }
}

/// The faults, separately and together: name, model, and the end of each expected warning.
fn faulty(random: &mut Random) -> Vec<(&'static str, Written, Vec<&'static str>)> {
    let body = Written::scan(random, 1.0, Vec3::ZERO, 30);
    let count = body.faces.len();
    let mut some = |count: usize| -> Vec<[usize; 3]> {
        (0..count).map(|_| body.faces[random.within(0, body.faces.len() as i64 - 1) as usize]).collect()
    };
    let (doubled, ribs, fins, cut, lines) = (some(60), some(20), some(8), some(25), some(30));

    // Once more, and once with the opposite winding.
    let twice = |w: &mut Written| doubled.iter().for_each(|&face| w.both_ways(face));
    // Faces that stand on edges as a two-sided sheet.
    let stand = |w: &mut Written| {
        for &[a, b, _] in &ribs {
            let tip = w.push((w.at(a) + w.at(b)) * 0.53);
            w.both_ways([a, b, tip]);
        }
    };
    // Two to four such sheets on one edge: 6 to 10 faces.
    let fan = |w: &mut Written| {
        for (i, &[a, b, c]) in fins.iter().enumerate() {
            for k in 0..2 + i % 3 {
                let out = (w.at(a) + w.at(b)) * (0.55 + 0.02 * k as f32) + (w.at(c) - w.at(a)) * (k as f32 * 0.4 - 0.4);
                let tip = w.push(out);
                w.both_ways([a, b, tip]);
            }
        }
    };
    // An edge split on one side only, closed by a face without area or left open.
    let split = |w: &mut Written, is_filled: bool| {
        for &[a, b, c] in &cut {
            let Some(place) = w.faces.iter().position(|face| *face == [a, b, c]) else { continue };
            let middle = w.push((w.at(a) + w.at(b)) * 0.5);
            w.faces[place] = [a, middle, c];
            w.faces.push([middle, b, c]);
            w.faces.extend(is_filled.then_some([a, b, middle]));
        }
    };
    let (filled, open) = (|w: &mut Written| split(w, true), |w: &mut Written| split(w, false));
    let without_area = |w: &mut Written| lines.iter().for_each(|&[a, b, _]| w.faces.extend([[a, a, b], [a, b, a]]));
    let with = |changes: &[&dyn Fn(&mut Written)]| {
        let mut written = body.clone();
        changes.iter().for_each(|change| change(&mut written));
        written
    };
    let mut random = Random::named("shells");
    let small = |random: &mut Random, radius, x, y, z| Written::scan(random, radius, Vec3::new(x, y, z), 8);
    let joined = |parts: &[Written]| {
        let mut all = body.clone();
        parts.iter().for_each(|part| all.add(part));
        all
    };
    let apart = [small(&mut random, 0.3, 1.1, 0.9, 0.3), small(&mut random, 0.25, -1.2, 0.5, 0.5)];
    let overlapping = small(&mut random, 0.4, 0.5, 0.5, 0.6);
    let cavity = small(&mut random, 0.5, 0.0, 0.0, 0.0);
    let in_cavity = small(&mut random, 0.2, 0.05, 0.0, 0.0);
    let mut all_over = joined(&[apart[0].clone().turned(), apart[1].clone(), cavity.clone().turned()]);
    [&twice as &dyn Fn(&mut Written), &stand, &fan, &filled, &without_area]
        .iter()
        .for_each(|change| change(&mut all_over));
    let mut everything_twice = body.clone();
    everything_twice.faces.extend(body.faces.iter().map(|&[a, b, c]| [b, a, c]));
    let mut with_hole = with(&[&stand, &fan, &twice]);
    with_hole.faces.truncate(count - 40);
    let eight = eight();

    let (left_out, turned) = ("pairs of faces back to back", "a solid that was inside out");
    vec![
        ("as it is", body.clone(), vec![]),
        ("faces doubled both ways", with(&[&twice]), vec![left_out]),
        ("sheets on edges", with(&[&stand]), vec![]),
        ("edges of 6 to 10 faces", with(&[&fan]), vec![]),
        ("cuts on one side, filled", with(&[&filled]), vec![]),
        ("cuts on one side", with(&[&open, &stand, &without_area]), vec![]),
        ("faces without area", with(&[&without_area]), vec![]),
        ("inside out", body.clone().turned(), vec![turned]),
        ("inside out, with sheets", with(&[&stand, &twice]).turned(), vec![left_out, turned]),
        ("bodies apart, one inside out", joined(&[apart[0].clone(), apart[1].clone().turned()]), vec![turned]),
        ("overlapping", joined(std::slice::from_ref(&overlapping)), vec![]),
        ("overlapping, inside out", joined(&[overlapping.turned()]), vec![turned]),
        ("with a cavity and what is in it", joined(&[cavity.turned(), in_cavity]), vec![]),
        ("all at once", all_over, vec![left_out, turned]),
        ("every face both ways", everything_twice, vec![]),
        ("open, with sheets", with_hole, vec![]),
        ("an 8", eight, vec![turned]),
    ]
}

/// A closed spindle with a figure-8 outline: one half is inside out, however it is turned.
fn eight() -> Written {
    let (around, along) = (16, 48);
    let mut positions = Vec::new();
    for i in 0..along {
        // Its radius changes sign, so that the surface passes through itself.
        let t = std::f32::consts::PI * i as f32 / (along - 1) as f32;
        let (x, radius) = (-t.cos(), 0.6 * (2.0 * t).sin());
        let radius = if i == 0 || i == along - 1 { 0.0 } else { radius + 0.001 };
        for k in 0..around {
            let angle = std::f32::consts::TAU * k as f32 / around as f32;
            positions.push(Vec3::new(x, radius * angle.cos(), radius * angle.sin()));
        }
    }
    let at = |i: usize, k: usize| 1 + i * around + k % around;
    let mut faces = Vec::new();
    for i in 0..along - 1 {
        for k in 0..around {
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
            faces.extend([[a, c, b], [a, d, c]]);
        }
    }
    Written { positions, faces }
}

/// Which faces are turned toward an eye.
fn look_toward(mesh: &Mesh, eye: Vec3) -> Vec<bool> {
    let toward = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| wide(mesh.positions()[i as usize]));
        dot(cross(sub(b, a), sub(c, a)), sub(wide(eye), a)) > 0.0
    };
    mesh.triangles().iter().map(toward).collect()
}

/// The scene with both sides of all faces, even of closed meshes, but of two faces back to back only the one turned
/// toward the eye; and each face's index in the original scene. A stray face that no picture shows leaves the mesh
/// open.
fn two_sided(scene: &Scene) -> (Scene, Vec<usize>) {
    let mesh = scene.objects()[0].mesh();
    let toward = look_toward(mesh, scene.camera.eye);
    let key = |triangle: &[u32; 3]| {
        let mut places = triangle.map(|i| (mesh.positions()[i as usize] + Vec3::ZERO).to_array().map(f32::to_bits));
        places.sort_unstable();
        places
    };
    let mut sides = std::collections::HashMap::<_, [bool; 2]>::new();
    for (triangle, toward) in mesh.triangles().iter().zip(&toward) {
        sides.entry(key(triangle)).or_default()[usize::from(*toward)] = true;
    }
    let keeps = |&i: &usize| toward[i] || !sides[&key(&mesh.triangles()[i])][1];
    let kept: Vec<usize> = (0..mesh.triangles().len()).filter(keeps).collect();
    let (mut positions, mut normals) = (mesh.positions().to_vec(), mesh.normals().to_vec());
    let behind = scene.camera.eye + (scene.camera.eye - scene.camera.target) * 3.0;
    let first = positions.len() as u32;
    positions.extend([behind, behind + Vec3::X, behind + Vec3::Y]);
    normals.extend([Vec3::Z; 3]);
    let triangles = kept.iter().map(|&i| mesh.triangles()[i]).chain([[first, first + 1, first + 2]]).collect();
    let mut both = Scene::new();
    (both.camera, both.ambient) = (scene.camera, scene.ambient);
    let mut object = Object::new(Mesh::with_normals(positions, normals, triangles).expect("legal"));
    object.materials = scene.objects()[0].materials.clone();
    both.add(object);
    scene.lights().iter().for_each(|light| _ = both.add_light(*light));
    (both, kept)
}

/// Wrong pixels: those that show a face that is not in front, or the back of one where another is turned toward the
/// eye, or that are far darker than everything around them should be.
fn specks(scene: &Scene, probe: &mut Probe) -> Vec<(usize, usize)> {
    let (right, kept) = two_sided(scene);
    let truth = truth(&right);
    let frame = truth.draw(Standard::Gouraud);
    let shown = probe.look(scene, SCREEN).expect("a legal scene");
    let toward = look_toward(scene.objects()[0].mesh(), scene.camera.eye);
    let in_right = |face: Face| kept.binary_search(&face.triangle).ok().map(|triangle| Face { object: 0, triangle });
    let darkest = |place: usize| {
        let near = [0, 1, 319, 320, 321].into_iter().flat_map(|step| [place.checked_sub(step), Some(place + step)]);
        let near = near.flatten().filter_map(|place| frame.pixels.get(place)?.as_ref());
        near.map(|pixel| 255.0 * pixel.intensity[0]).fold(255.0, f64::min)
    };
    let is_speck = |&place: &usize| {
        let (x, y) = (place % 320, place / 320);
        let face = frame.pixels[place].map(|pixel| pixel.face);
        let Some(seen) = shown.faces[place] else {
            return face.is_some() && !may_be_taken_for(&truth, right.camera.near, face, None, (x, y));
        };
        // A face left out of the reference lies back to back with one that is in it.
        let Some(seen_right) = in_right(seen) else { return true };
        let is_other = Some(seen_right) != face;
        let behind = is_other && !may_be_taken_for(&truth, right.camera.near, face, Some(seen_right), (x, y));
        let back = is_other && !toward[seen.triangle] && face.is_some_and(|face| toward[kept[face.triangle]]);
        behind || back || shown.shades[place][0] < darkest(place) - 16.0
    };
    (0..shown.faces.len()).filter(is_speck).map(|place| (place % 320, place / 320)).collect()
}

fn eyes() -> [Vec3; 3] {
    [Vec3::new(1.1, 0.7, 3.4), Vec3::new(-2.6, 2.3, 1.4), Vec3::new(0.9, -1.2, -3.3)]
}

#[test]
fn n2_models_with_faults_have_no_specks() {
    let mut tried = Tried::new("n2_models_with_faults_have_no_specks", 17 * 3);
    let mut random = Random::named("faulty models");
    let mut found = Vec::new();
    for (name, written, warnings) in faulty(&mut random) {
        let loaded = written.load(&mut random);
        if loaded.warnings.len() != warnings.len()
            || loaded.warnings.iter().zip(&warnings).any(|(given, due)| !given.contains(due))
        {
            found.push(format!("{name}: warned {:?}, due {warnings:?}", loaded.warnings));
        }
        let mut scene = Scene::new();
        scene.add(Object::new(loaded.mesh));
        scene.add_light(Light::sun([0.3, 0.7, 1.0]));
        for (i, eye) in eyes().into_iter().enumerate() {
            scene.camera = Camera { eye, target: Vec3::ZERO, near: 0.1, ..Camera::default() };
            let mut probe = probe(Shading::Gouraud88Reseeded);
            // The other methods are right only for convex objects and for objects sorted far to near.
            let way = if i == 1 { HiddenSurfaces::ScanLine } else { HiddenSurfaces::DepthBuffer };
            probe.renderer().settings.hidden_surfaces = Some(way);
            let specks = specks(&scene, &mut probe);
            tried.worst("specks", specks.len() as f64);
            if !specks.is_empty() {
                found.push(format!("{name}, from {eye}: {} specks, the first at {:?}", specks.len(), specks[0]));
            }
            tried.add(1);
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// When two faces lie back to back, the one turned toward the eye is drawn: with every hidden-surface method, in
/// floating point and in 16.16, with every shading and within a budget, whichever comes first, and where the near plane
/// clips them.
#[test]
fn d3_of_faces_back_to_back_the_one_in_front_is_seen() {
    let mut tried = Tried::new("d3_of_faces_back_to_back_the_one_in_front_is_seen", 2 * 2 * 3 * 4 * 12);
    let leaf = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.2), Vec3::Y];
    // A separate face, so that the mesh is open and both sides of its faces may be seen.
    let positions: Vec<Vec3> = leaf.into_iter().chain([Vec3::NEG_X, Vec3::NEG_Y, Vec3::new(-1.0, -1.0, 0.3)]).collect();
    for swapped in [false, true] {
        let mut triangles = vec![[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0], [4, 5, 6]];
        if swapped {
            triangles.rotate_left(2);
        }
        let mesh = Mesh::new(positions.clone(), triangles).expect("legal");
        assert!(!mesh.is_closed() && (0..5).filter(|&t| mesh.has_twin(t)).count() == 4);
        for side in [1.0, -1.0] {
            // From afar, and so near that the near plane clips the leaf.
            for (eye, target) in [
                (Vec3::new(0.4, 0.3, 3.0 * side), Vec3::ZERO),
                (Vec3::new(-0.3, 0.2, 0.4 * side), Vec3::new(1.0, 0.9, 0.0)),
                (Vec3::new(0.4, 0.3, 40.0 * side), Vec3::ZERO),
            ] {
                let mut scene = Scene::new();
                scene.add(Object::new(mesh.clone()));
                scene.add_light(Light::lamp([0.5, 0.5, 1.0], 3.0));
                scene.add_light(Light::sun([0.3, 0.7, 1.0]));
                let near = if eye.length() < 1.0 { 0.5 } else { 0.1 };
                scene.camera = Camera { eye, target, near, ..Camera::default() };
                if eye.length() > 10.0 {
                    scene.camera.field_of_view = Angle::from_radians(0.08);
                }
                let toward = look_toward(&mesh, eye);
                for way in HiddenSurfaces::ALL {
                    if way == HiddenSurfaces::BackFaces {
                        tried.add(12);
                        continue;
                    }
                    for setting in 0..12 {
                        let mut probe = probe(Shading::ALL[setting % Shading::ALL.len()]);
                        probe.renderer().settings.hidden_surfaces = Some(way);
                        match setting {
                            10 => probe.renderer().settings.vertex_path = Some(VertexPath::Integer),
                            11 => {
                                probe.renderer().settings.accuracy = Some(Accuracy::WithinError(4.0));
                            }
                            _ => {}
                        }
                        let shown = probe.look(&scene, SCREEN).expect("a legal scene");
                        let leaf = shown.faces.iter().flatten().copied().filter(|face| mesh.has_twin(face.triangle));
                        let (front, back) = leaf.partition::<Vec<Face>, _>(|face| toward[face.triangle]);
                        assert!(front.len() > 500, "{way} {setting} {eye}: {}", front.len());
                        assert!(back.is_empty(), "{way} {setting} {eye}: {} pixels of the back", back.len());
                        tried.add(1);
                    }
                }
            }
        }
    }
}
