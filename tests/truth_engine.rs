//! The engine against the truth: every rung that claims something, on every scene.
#![cfg(feature = "alloc")]

mod support;

use mode13h::cost::{Probe, ProbeError};
use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::builtin;
use mode13h::plan::Effect;
use mode13h::raster::FrameError;
use mode13h::render::{RenderError, Renderer, Rung, VertexPath};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::span::channels::mix_cube;
use mode13h::truth::{Bound, ErrorMap, Face, Screen, Shown, Standard, Truth, TruthFrame};
use mode13h::vga::Vga;
use support::random::Random;
use support::scenes;
use support::tried::Tried;

const SCREEN: Screen = Screen::MODE_13H;

fn truth(scene: &Scene) -> Truth<'_> {
    Truth::new(scene, SCREEN).expect("a legal scene")
}

fn probe(rung: Rung) -> Probe {
    let mut renderer = Renderer::new();
    renderer.set_rung(rung);
    Probe::new(renderer)
}

fn look(scene: &Scene, rung: Rung) -> Shown {
    probe(rung).look(scene, SCREEN).expect("a legal scene")
}

fn compare(frame: &TruthFrame, shown: &Shown) -> ErrorMap {
    ErrorMap::new(frame, shown).expect("of one size")
}

/// Every scene, those that are shipped at two more moments of their round.
fn all() -> Vec<(String, Scene)> {
    let mut all = scenes::all();
    #[cfg(feature = "scene-files")]
    for shipped in &mode13h::scene::shipped::ALL {
        for part in [0.05, 0.73] {
            let mut scene = shipped.load().expect("a scene that loads").scene;
            scene.set_time(part * scene.duration);
            all.push((format!("scene {} at {part}", shipped.name), scene));
        }
    }
    // What is split is another mesh, of which this one's vertices say little.
    all.iter_mut().for_each(|(_, scene)| scene.wishes.tessellation = None);
    all
}

/// How far a vertex on the screen may be from where it should be, in pixels: half of 1/256 for rounding, and what
/// f32 makes: 2⁻²⁴ of what a coordinate's terms reach, some 2¹¹ pixels, a few times over.
const VERTEX: f64 = 0.5 / 256.0 + 0.001;

/// Places about a pixel's centre, as far as a vertex may be off, and between.
fn about(x: usize, y: usize) -> impl Iterator<Item = (f64, f64)> {
    let at = |i: i32| VERTEX * f64::from(i) / 4.0;
    (-4..=4).flat_map(move |i| (-4..=4).map(move |j| (x as f64 + 0.5 + at(i), y as f64 + 0.5 + at(j))))
}

/// Whether it takes no more than vertices moved by so little, or depths rounded to 30 bits, that `shown` is seen at a
/// pixel in place of `right`.
fn may_be_taken_for(
    truth: &Truth,
    near: f32,
    right: Option<Face>,
    shown: Option<Face>,
    (x, y): (usize, usize),
) -> bool {
    about(x, y).any(|(x, y)| {
        let met = |face: Option<Face>| face.and_then(|face| truth.lit_at(face, x, y)).map(|pixel| 1.0 / pixel.w);
        match (met(right), met(shown)) {
            // An edge of the right face lies here.
            (None, None) => shown.is_none() && right.is_some(),
            (None, Some(_)) => true,
            // At the same depth: both rounded, and interpolated to within a unit.
            (Some(right), Some(shown)) => (right - shown) * f64::from(near) <= 4.0 / 1_073_741_824.0,
            (Some(_), None) => false,
        }
    })
}

/// Fails at pixels that show another face than they should without reason. Returns how many show another.
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

/// Intensities in f32, before they are rounded to 1/256 shade: a few parts in 2²⁴ of 255 shades, and of a highlight some
/// dozens.
const F32: f64 = 0.01;

/// What is right at each pixel changes by so much over 1/256 pixel across and down, in shades: from its neighbours of the same
/// face, a pixel away, and a quarter more for what bends between. `None` where a face has no other pixel in the row or in the
/// column: it is a pixel wide there, and what its shades change by is not known.
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

/// Pixels that are farther off than the bound, by what exempts them from it.
#[derive(Default)]
struct Exempt {
    /// A coordinate was rounded to the unit beside the right one: of a hundred one is, as the engine's come from f32, and a
    /// face that is clipped has new corners, which are rounded too. Either moves shades by no more than a unit.
    moved: u64,
    /// The same of a face a pixel wide, where nothing says what its shades change by.
    narrow: u64,
}

/// Compares every pixel with the bound itself. What is beyond it for no reason fails.
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

/// Checks every rung that claims a bound, and is linear between vertices, on a scene.
fn check_linear(tried: &mut Tried, name: &str, scene: &Scene) -> Exempt {
    let mut all_exempt = Exempt::default();
    let truth = truth(scene);
    let right = [Standard::Gouraud, Standard::GouraudPerspective].map(|standard| truth.draw(standard));
    for rung in Rung::ALL {
        let Some(Bound { standard, shades }) = Bound::of(rung, SCREEN.width) else { continue };
        if standard == Standard::Lit {
            continue;
        }
        let shown = look(scene, rung);
        let frame = &right[usize::from(standard == Standard::GouraudPerspective)];
        let errors = compare(frame, &shown);
        let figures = errors.figures();
        // A pixel of a face that is moved: what is left to a whole shade, or to two.
        assert!(figures.max <= shades.ceil(), "{name}, {rung}: {:.3} shades from {standard}", figures.max);
        let exempt = beyond(&format!("{name}, {rung}"), frame, &errors, shades + F32);
        // Whatever exempts them, few are.
        let (Exempt { moved, narrow }, all) = (exempt, figures.count);
        assert!((moved + narrow) * 1_000 <= all, "{name}, {rung}: {moved} and {narrow} of {all} beyond {shades:.4}");
        (all_exempt.moved, all_exempt.narrow) = (all_exempt.moved + moved, all_exempt.narrow + narrow);
        tried.add(figures.count);
        tried.worst("shades", figures.max);
        let others = check_cover(name, scene, &truth, frame, &shown);
        tried.worst("pixels of another face", others as f64);
        assert_eq!(others, errors.cover_errors());
        // Rounded alike, they differ in one pixel of thousands.
        assert!(others <= 5, "{name}, {rung}: {others} pixels show another face");
    }
    all_exempt
}

/// Checks them on all of these, and reports what was exempt.
fn check_all_linear(mut tried: Tried, scenes: impl Iterator<Item = (String, Scene)>) {
    let mut sum = Exempt::default();
    for (name, scene) in scenes {
        let Exempt { moved, narrow } = check_linear(&mut tried, &name, &scene);
        (sum.moved, sum.narrow) = (sum.moved + moved, sum.narrow + narrow);
    }
    tried.worst("pixels exempt as vertices are moved", sum.moved as f64);
    tried.worst("as faces are a pixel wide", sum.narrow as f64);
}

/// How many pixels are compared at least: the shipped scenes are files.
fn stated() -> u64 {
    if cfg!(feature = "scene-files") { 1_000_000 } else { 400_000 }
}

#[test]
fn linear_rungs_keep_their_bounds_on_every_scene() {
    check_all_linear(Tried::new("linear_rungs_keep_their_bounds_on_every_scene", stated()), all().into_iter());
}

#[test]
fn linear_rungs_keep_their_bounds_on_random_scenes() {
    let mut random = Random::named("truth linear");
    let scenes = (0..12).map(|i| (format!("random scene {i}"), scenes::random(&mut random)));
    check_all_linear(Tried::new("linear_rungs_keep_their_bounds_on_random_scenes", 200_000), scenes);
}

/// Light at every pixel is right but for the rounding of a shade to 1/256 and to a byte, and for vertices that are
/// rounded. Those move the point of a face that is seen at a pixel: with the weights λ of its corners there, which are
/// moved by δ each, what is seen is what should be at p − Σ λδ, no farther from p than a vertex is moved.
fn check_lit(tried: &mut Tried, name: &str, scene: &Scene) {
    let (truth, shown) = (truth(scene), look(scene, Rung::Phong));
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
        let near = about(place % 320, place / 320).filter_map(|(x, y)| truth.lit_at(right.face, x, y));
        let moved =
            near.map(|near| (0..3).fold(0.0, |most, i| f64::max(most, (near.intensity[i] - right.intensity[i]).abs())));
        // Between the places that are tried, light changes a little more.
        let allowed = rounding + 1.2 * 255.0 * moved.fold(0.0, f64::max);
        assert!(
            error <= allowed,
            "{name}: ({}, {}) is {error:.3} off, {allowed:.3} are explained",
            place % 320,
            place / 320
        );
        tried.worst("shades off that vertices explain", error);
    }
    let others = check_cover(name, scene, &truth, &frame, &shown);
    assert_eq!(others, errors.cover_errors());
    tried.worst("pixels of another face", others as f64);
    assert!(errors.share_within(1.0) > 0.999, "{name}: {}", errors.share_within(1.0));
}

#[test]
fn phong_is_lit_at_every_pixel_on_every_scene() {
    let mut tried = Tried::new("phong_is_lit_at_every_pixel_on_every_scene", stated());
    for (name, scene) in all() {
        check_lit(&mut tried, &name, &scene);
    }
}

/// A body gives back its own colour, its highlight has another: white, where nothing is said.
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

/// The same bodies with each face's own normal at its corners; and with each face in three that meet in its middle.
fn flattened(scene: &Scene) -> [Scene; 2] {
    let [mut flat, mut parted] = [scene.clone(), scene.clone()];
    for (i, object) in scene.objects().iter().enumerate() {
        let with = |mesh: Mesh| {
            let mut with = Object::new(mesh);
            (with.pivot, with.position, with.scale) = (object.pivot, object.position, object.scale);
            (with.up_axis, with.materials) = (object.up_axis, object.materials.clone());
            with.set_angles(object.angles());
            with
        };
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

/// Where a face's middle lies on the screen, in pixels: the corner that its three parts have in common. `None` where
/// it is clipped, or rounding leaves a part no area.
fn middle(parted: &Truth, face: Face) -> Option<[f64; 2]> {
    let parts = [0, 1, 2].map(|part| parted.rounded_triangles(Face { triangle: 3 * face.triangle + part, ..face }));
    let [[a], [b], [c]] = parts.each_ref().map(Vec::as_slice) else { return None };
    let mut common = a.iter().filter(|corner| b.contains(corner) && c.contains(corner));
    let ([x, y], None) = (common.next()?, common.next()) else { return None };
    Some([*x as f64 / 256.0, *y as f64 / 256.0])
}

/// A flat face has the model's shade at its middle, by its own normal: ½ for the byte, 1/512 for the shade, f32,
/// and what light changes by where the middle may be instead.
#[test]
fn flat_faces_have_the_light_at_their_middle() {
    let mut tried = Tried::new("flat_faces_have_the_light_at_their_middle", stated() / 4);
    for (name, scene) in all() {
        let shown = look(&scene, Rung::Flat);
        let [flat, parted] = flattened(&scene);
        let (truth, parted) = (truth(&flat), self::truth(&parted));
        let mut shades = std::collections::BTreeMap::new();
        for (face, shade) in shown.faces.iter().zip(&shown.shades) {
            let Some(face) = *face else { continue };
            let right = shades.entry(face).or_insert_with(|| {
                let [x, y] = middle(&parted, face)?;
                let at = |dx: f64, dy: f64| Some(truth.lit_at(face, x + VERTEX * dx, y + VERTEX * dy)?.intensity);
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

/// Rungs that claim no bound are measured as all others; and splitting brings linear shades nearer to `lit`.
#[test]
fn rungs_without_a_bound_are_measured() {
    let mut tried = Tried::new("rungs_without_a_bound_are_measured", 8 * stated() / 10);
    let (mut split, mut linear) = (0.0, 0.0);
    for (name, scene) in all() {
        let truth = truth(&scene);
        let frame = truth.draw(Standard::Lit);
        let rms = |rung: Rung| {
            let figures = compare(&frame, &look(&scene, rung)).figures();
            assert!(figures.max.is_finite() && figures.rms() <= figures.max + 1e-9, "{name}, {rung}: {figures:?}");
            (figures.rms(), figures.count)
        };
        let (reseeded, _) = rms(Rung::Gouraud88Reseeded);
        for rung in Rung::ALL.into_iter().filter(|rung| Bound::of(*rung, SCREEN.width).is_none()) {
            let (rms, count) = rms(rung);
            tried.add(count);
            if rung == Rung::GouraudTessellated {
                // The split faces' corners are rounded anew, and a byte has its half.
                assert!(rms <= reseeded + 0.5, "{name}: {rms} split, {reseeded} not");
                (split, linear) = (split + rms, linear + reseeded);
            }
        }
    }
    assert!(split < 0.5 * linear, "{split} split, {linear} not");
}

// The probe

/// What it says is shown is what is drawn.
#[test]
fn the_probe_shows_what_is_drawn() {
    for (name, scene) in scenes::all() {
        let (drawn, in_color) = {
            let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
            let mut scene = scene.clone();
            // As the probe sees it: grey, 256 shades, nothing over them.
            scene.palette = Some(builtin::GREY.clone());
            scene.fog = None;
            scene.wishes.dither = false;
            for material in scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials) {
                *material = Material { texture: None, environment: None, ..material.clone() };
                material.ramp = Material::white().ramp;
                material.blend = Material::white().blend;
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

/// Channels are mixed to the colour that is drawn.
#[test]
fn the_probe_shows_the_channels_that_are_mixed() {
    let mut scene = Scene::showing(shapes::sphere(24, 12));
    scene.palette = Some(builtin::by_name("cube").expect("built in").palette.clone());
    scene.add_light(Light::sun([-1.0, 0.5, 0.5]).with_color([1.0, 0.4, 0.2]));
    // A body without colour beside one that has one: both are on channels, as the light is coloured.
    scene.add(Object::new(shapes::cube()));
    for rung in Rung::ALL {
        let (shown, mut vga) = (look(&scene, rung), Vga::new());
        let mut renderer = Renderer::new();
        renderer.set_rung(rung);
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        let mut seen = 0;
        for ((face, shades), &drawn) in shown.faces.iter().zip(&shown.shades).zip(vga.pixels()) {
            if face.is_some() {
                // Shades of 0 to 255.
                let [r, g, b] = shades.map(|shade| shade as u8);
                let mut mixed = [0];
                mix_cube(&mut mixed, &[r], &[g], &[b], &[128; 8], 0);
                assert_eq!(mixed[0], drawn, "{rung}");
                seen += 1;
            }
        }
        assert!(seen > 10_000);
    }
    // What the renderer drew through the probe is no longer there.
    let mut probe = probe(Rung::Phong);
    probe.look(&scene, SCREEN).expect("a legal scene");
    let (mut by_probe, mut fresh) = (Vga::new(), Vga::new());
    probe.renderer().draw(&scene, &mut by_probe).expect("a legal scene");
    let mut renderer = Renderer::new();
    renderer.set_rung(Rung::Phong);
    renderer.draw(&scene, &mut fresh).expect("a legal scene");
    assert!(by_probe.pixels() == fresh.pixels());
}

/// Numbers of three digits, and the 16.16 path.
#[test]
fn the_probe_numbers_any_triangle() {
    let mut scene = Scene::new();
    for (n, x) in [(300_u32, -0.8), (20, 0.8)] {
        let wall = scene.add(Object::new(shapes::wall(n, n / 2)));
        scene[wall].position = Vec3::new(x, 0.0, 0.0);
        scene[wall].set_angles([0.3, 0.2, 0.0]);
    }
    scene.add_light(Light::lamp([0.3, 0.4, 1.0], 3.0));
    let (truth, shown) = (truth(&scene), look(&scene, Rung::GouraudHyperbolic));
    let frame = truth.draw(Standard::GouraudPerspective);
    let errors = compare(&frame, &shown);
    let numbers: Vec<usize> = shown.faces.iter().flatten().map(|face| face.triangle).collect();
    assert!(numbers.iter().max() > Some(&65_536) && numbers.iter().min() < Some(&256));
    // Triangles of a pixel's size: one in four of them has no pixel, and half of all pixels lie near an edge.
    assert_eq!(check_cover("many", &scene, &truth, &frame, &shown), errors.cover_errors());
    assert!(errors.cover_errors() * 100 < errors.figures().count as usize, "{}", errors.cover_errors());
    assert!(errors.figures().max <= 1.0, "{:?}", errors.figures());

    let mut torus = Scene::showing(shapes::torus(48, 24));
    torus.objects_mut()[0].set_angles([0.3, 0.2, 0.0]);
    let mut probe = probe(Rung::Gouraud88Reseeded);
    probe.renderer().set_vertex_path(VertexPath::Integer);
    let shown = probe.look(&torus, SCREEN).expect("a legal scene");
    let errors = compare(&self::truth(&torus).draw(Standard::Gouraud), &shown);
    // Angles of 16 bits, a table sine and normals of 16 bits are off by less than 1/1,000 of what a shade takes.
    assert!(errors.figures().mean() < 0.5 && errors.cover_errors() < 300, "{errors:?}");
}

#[test]
fn the_probe_refuses_what_cannot_be_drawn() {
    let scene = Scene::showing(shapes::cube());
    let mut probe = Probe::new(Renderer::new());
    let too_wide = Screen { width: 5_000, ..SCREEN };
    assert!(matches!(probe.look(&scene, too_wide), Err(ProbeError::Screen(FrameError::Size { width: 5_000, .. }))));
    let none = Screen { width: 0, ..SCREEN };
    assert!(matches!(probe.look(&scene, none), Err(ProbeError::Screen(_))));
    let mut broken = scene.clone();
    broken.ambient = f32::NAN;
    assert_eq!(probe.look(&broken, SCREEN), Err(ProbeError::Scene(RenderError::Ambient)));
    assert!(probe.look(&scene, SCREEN).is_ok(), "it can be used on");
}

// Hard cases

/// The eye at the origin looks along −z. What a unit at w = 1 is in pixels, across and down.
fn eye(scene: &mut Scene, near: f32) -> [f64; 2] {
    scene.camera = Camera { eye: Vec3::ZERO, target: Vec3::NEG_Z, up: Vec3::Y, near, ..Camera::default() };
    let down = 100.0 / f64::tan(f64::from(Camera::FIELD_OF_VIEW) / 2.0);
    [1.2 * down, down]
}

/// A triangle whose corners are at these places on the screen and distances, lit at these intensities.
fn triangle(corners: [([f64; 2], f64, f64); 3], near: f32) -> Scene {
    let mut scene = Scene::new();
    let [fx, fy] = eye(&mut scene, near);
    let position = |([x, y], w, _): ([f64; 2], f64, f64)| {
        Vec3::new(((x - 160.0) * w / fx) as f32, (-(y - 100.0) * w / fy) as f32, -w as f32)
    };
    let normal = |(_, _, i): ([f64; 2], f64, f64)| Vec3::new(f64::sqrt(1.0 - i * i) as f32, 0.0, i as f32);
    let mesh = Mesh::with_normals(corners.map(position).to_vec(), corners.map(normal).to_vec(), vec![[0, 1, 2]]);
    let object = scene.add(Object::new(mesh.expect("a mesh")));
    scene[object].materials[0] = Material { ambient: 0.0, diffuse: 1.0, ..Material::white() };
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene
}

/// How far a rung is from a standard on a scene; no pixel is without a reason another face's.
fn figures(name: &str, scene: &Scene, rung: Rung, standard: Standard) -> mode13h::truth::Figures {
    let (truth, shown) = (truth(scene), look(scene, rung));
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
        let hyperbolic = figures(&name, &scene, Rung::GouraudHyperbolic, Standard::GouraudPerspective);
        assert!(hyperbolic.max <= 1.0, "{name}: {hyperbolic:?}");
        tried.worst("shades", hyperbolic.max);
        tried.add(hyperbolic.count);
        linear = linear.max(figures(&name, &scene, Rung::Gouraud88Reseeded, Standard::GouraudPerspective).max);
    }
    assert!(linear > 100.0, "linear shades show what is tried: {linear}");
}

#[test]
fn n7_a_highlight_inside_a_face_against_the_truth() {
    let mut tried = Tried::new("n7_a_highlight_inside_a_face_against_the_truth", 100_000);
    let mut scene = Scene::new();
    let wall = scene.add(Object::new(shapes::wall(1, 1)));
    scene[wall].materials[0] =
        Material { ambient: 0.1, diffuse: 0.2, specular: 0.6, shininess: 60.0, ..Material::white() };
    scene.add_light(Light::sun([0.2, 0.1, 1.0]));
    for angle in [0.0, 0.05, 0.1, 0.15] {
        scene[wall].set_angles([0.5 * angle, angle, 2.0 * angle]);
        for (rung, most) in [
            // The loop at every pixel: a half, and vertices.
            (Rung::Phong, 1.0),
            // Split until an edge is within a shade; a face inside of three edges by as much again.
            (Rung::GouraudTessellated, 2.5),
        ] {
            let figures = figures("wall", &scene, rung, Standard::Lit);
            assert!(figures.max <= most, "{rung} at {angle}: {figures:?}");
            tried.worst(rung.name(), figures.max);
            tried.add(figures.count);
        }
        for rung in [Rung::Gouraud88, Rung::Gouraud88Reseeded, Rung::GouraudHyperbolic] {
            let figures = figures("wall", &scene, rung, Standard::Lit);
            assert!(figures.max > 50.0, "{rung} at {angle}: {figures:?}");
            tried.add(figures.count);
        }
    }
}
