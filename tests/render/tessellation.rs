//! R12 and N7: faces that are split where light bends.

use std::collections::{HashMap, HashSet};

use crate::floor::counts_by;
use crate::support::scenes::{frame, frame_by, framed, shaded, triangles_by};
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene};
use mode13h::settings::DitherPattern;
use mode13h::settings::Shading;
use mode13h_conformance::Random;
use mode13h_conformance::oracle::{self, Point};

/// In 1/256 pixel.
type Place = (i32, i32);

fn point(v: &Vertex) -> Place {
    (v.x().to_bits(), v.y().to_bits())
}

/// The outline of triangles with the same winding: the edges that no neighbour traverses in the other direction, as
/// loops.
fn outlines(triangles: &[[Vertex; 3]]) -> Vec<Vec<Point>> {
    let mut edges: HashMap<(Place, Place), i32> = HashMap::new();
    for [a, b, c] in triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let (a, b) = (point(a), point(b));
            if a != b {
                *edges.entry((a, b)).or_default() += 1;
                *edges.entry((b, a)).or_default() -= 1;
            }
        }
    }
    let mut next: HashMap<Place, Vec<Place>> = HashMap::new();
    for ((a, b), times) in edges {
        (0..times).for_each(|_| next.entry(a).or_default().push(b));
    }
    let mut loops = Vec::new();
    while let Some(&start) = next.keys().min() {
        let (mut at, mut outline) = (start, Vec::new());
        while let Some(ends) = next.get_mut(&at) {
            let end = ends.pop().expect("a place that is left has an edge");
            if ends.is_empty() {
                next.remove(&at);
            }
            outline.push((i128::from(at.0), i128::from(at.1)));
            at = end;
        }
        loops.push(outline);
    }
    loops
}

/// A wall somewhere in front of the eye, with a lamp somewhere near it.
fn wall(random: &mut Random) -> Scene {
    let mut scene = Scene::new();
    let mut object = Object::new(shapes::wall(random.within(1, 4) as u32, random.within(1, 4) as u32));
    object.scale = 0.3 * (1.0 + 20.0 * random.unit() as f32 * random.unit() as f32);
    object.angles =
        [random.unit() * 1.2 - 0.6, random.unit() * 2.4 - 1.2, random.unit() * 6.0].map(Angle::from_radians);
    // The eye is three and a half units away.
    let z = 3.5 * (random.unit() * random.unit()) as f32;
    object.position = Vec3::new(random.unit() as f32 - 0.5, random.unit() as f32 - 0.5, z);
    if random.within(0, 2) == 0 {
        // With a highlight, too.
        object.materials[0].specular = 0.5;
        object.materials[0].shininess = 1.0 + 30.0 * random.unit() as f32;
    }
    scene.add(object);
    for _ in 0..random.within(1, 3) {
        let mut coordinate = || 2.0 * random.unit() as f32 - 1.0;
        let place = [coordinate(), coordinate(), 0.3 * coordinate()];
        scene.add_light(Light::lamp(place, 0.2 + 3.0 * random.unit() as f32));
    }
    scene.settings.tessellation = Some(random.one_of(&[0.5, 1.0, 2.0, 8.0]));
    scene
}

/// Neighbours that are split differently leave no hole and draw no pixel twice: what remains of the wall's faces has
/// one outline, and each pixel inside it is covered once.
#[test]
fn r12_walls_that_are_split_are_closed() {
    let mut tried = Tried::new("r12_walls_that_are_split_are_closed", 150);
    let mut random = Random::named("r12");
    let (mut split, mut clipped) = (0, 0);
    while tried.more() {
        let scene = wall(&mut random);
        let parts = triangles_by(&mut Renderer::new(), &scene);
        let (counts, stats) = counts_by(&mut Renderer::new(), &scene);
        split += usize::from(parts.len() > scene.objects()[0].mesh().triangles().len());
        clipped += usize::from(stats.clipped > 0);
        let loops = outlines(&parts);
        assert!(loops.len() <= 1, "{} outlines of {} triangles", loops.len(), parts.len());
        let outline = loops.first().cloned().unwrap_or_default();
        for y in 0..200 {
            for x in 0..320 {
                let inside = outline.len() > 2 && oracle::polygon_covers(&outline, oracle::centre(x, y));
                assert_eq!(counts[(y * 320 + x) as usize], u32::from(inside), "pixel ({x}, {y})");
            }
        }
    }
    assert!(split > 75 && clipped > 10, "{split} were split, {clipped} clipped");
}

/// Neighbours are closed in a mesh with creases, too, whose faces have separate vertices there: each edge is split in
/// one place, or not at all, whichever face is asked.
#[test]
fn r12_creases_are_split_alike_from_both_sides() {
    let mut tried = Tried::new("r12_creases_are_split_alike_from_both_sides", 60);
    let mut random = Random::named("r12 creases");
    while tried.more() {
        let mut scene = Scene::new();
        let mut cube = Object::new(shapes::cube());
        cube.angles = [random.unit() * 6.0, random.unit() * 6.0, 0.0].map(Angle::from_radians);
        scene.add(cube);
        let mut coordinate = || 2.4 * random.unit() as f32 - 1.2;
        scene.add_light(Light::lamp([coordinate(), coordinate(), coordinate()], 2.0));
        scene.settings.tessellation = Some(1.0);
        let parts = triangles_by(&mut Renderer::new(), &scene);
        // Convex: what is visible has one outline, unless rounding flipped a face.
        let outlines = outlines(&parts);
        assert_eq!(outlines.len(), 1, "{} triangles", parts.len());
        let corners: HashSet<_> = parts.iter().flatten().map(point).collect();
        assert!(corners.len() > 8, "it is split");
    }
}

/// An object with a highlight under one light.
fn lit_by(mesh: Mesh, light: Light, shininess: f32) -> Scene {
    let mut scene = framed(mesh);
    scene.clear_lights();
    scene.add_light(light);
    scene.ambient = 0.0;
    let material = Material { diffuse: 0.2, specular: 0.8, shininess, ..Material::default() };
    scene.objects_mut()[0].materials = vec![material];
    scene
}

/// A wall of two triangles with a highlight in its middle.
fn highlight() -> Scene {
    lit_by(shapes::wall(1, 1), Light::sun([0.0, 0.0, 1.0]), 120.0)
}

fn middle(scene: &Scene, shading: Shading) -> u8 {
    frame_by(&mut shaded(shading), scene).0[100 * 320 + 160]
}

#[test]
fn n7_a_highlight_inside_a_face() {
    let mut tried = Tried::new("n7_a_highlight_inside_a_face", 9);
    let scene = highlight();
    // Straight ahead the light is mirrored into the eye: 0.2 + 0.8 of 255.
    let misses = |shading: &Shading| !shading.lights_pixels() && *shading != Shading::GouraudTessellated;
    for shading in Shading::ALL.into_iter().filter(misses) {
        let shade = middle(&scene, shading);
        // A flat face has the shade of its own middle, off the highlight.
        assert!(shade < 200, "{shading} misses it: {shade}");
        tried.add(1);
    }
    for shading in [Shading::GouraudTessellated, Shading::Phong] {
        let shade = middle(&scene, shading);
        assert!(shade >= 253, "{shading} shows it: {shade}");
        tried.add(1);
    }
}

/// A renderer that has lit the parts of split faces, each at its middle, lights the whole faces at theirs afterwards.
#[test]
fn whole_faces_are_lit_at_their_own_middles_after_split_ones() {
    let mut scene = highlight();
    scene.settings.accuracy = Some(Shading::Flat.into());
    scene.settings.tessellation = Some(5.0);
    let mut renderer = Renderer::new();
    let (split, _) = frame_by(&mut renderer, &scene);
    scene.settings.tessellation = None;
    let (whole, _) = frame_by(&mut renderer, &scene);
    assert!(whole == frame(&scene), "the reused renderer draws something else");
    assert!(whole != split, "nothing was split");
}

/// A highlight splits the faces that it touches, and none on the other side of a sphere.
#[test]
fn faces_far_from_a_highlight_are_not_split() {
    let mut scene = lit_by(shapes::sphere(48, 24), Light::sun([-0.6, 0.3, 0.7]), 100.0);
    let whole = triangles_by(&mut Renderer::new(), &scene);
    scene.settings.tessellation = Some(2.0);
    let split = triangles_by(&mut Renderer::new(), &scene);
    assert!(split.len() > whole.len(), "{} of {}", split.len(), whole.len());
    let right = |corners: &&[Vertex; 3]| corners.iter().all(|corner| point(corner).0 > 200 * 256);
    assert!(whole.iter().filter(right).count() > 50);
    assert_eq!(split.iter().filter(right).count(), whole.iter().filter(right).count());
}

/// N3: halfway between two opposite normals the normal is one of them. A face has two tones, those of two faces whose
/// normals are all the one or all the other, and where the tones meet nothing is brighter or darker than both.
#[test]
fn n3_opposite_normals_at_two_ends_of_an_edge() {
    // Not one of the ramp's entries.
    const BACKGROUND: u8 = 7;
    let mut tried = Tried::new("n3_opposite_normals_at_two_ends_of_an_edge", 18 * 40);
    let mut random = Random::named("n3");
    let (mut compared, mut apart) = (0_u64, 0_u64);
    for _ in 0..40 {
        let axis = Vec3::from_array([0.0; 3].map(|_| random.unit() as f32 - 0.5)).normalize();
        let third = if random.within(0, 1) == 0 { 1.0_f64 } else { -1.0 };
        for (specular, shading, dither) in [0.0, 0.7].into_iter().flat_map(|specular| {
            [Shading::PhongTable, Shading::Phong, Shading::GouraudTessellated].into_iter().flat_map(move |shading| {
                [None, Some(DitherPattern::Ordered), Some(DitherPattern::BlueNoise)]
                    .map(move |dither| (specular, shading, dither))
            })
        }) {
            let scene = |normals: [Vec3; 3]| {
                let positions = vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
                let mesh = Mesh::with_normals(positions, normals.to_vec(), vec![[0, 1, 2]]).expect("sound");
                let mut scene = framed(mesh);
                scene.background = BACKGROUND;
                scene.palette = mode13h::palette::builtin::by_name("materials-4x64").map(|found| found.palette.clone());
                scene.settings.dither = dither;
                let material = &mut scene.objects_mut()[0].materials[0];
                (material.specular, material.shininess) = (specular, 10.0);
                material.ramp = mode13h::light::RampChoice::Number(2);
                scene
            };
            let (near, off) = match shading {
                // Shades are linear from corner to corner of a part: 3 % of the way to the other tone is 8 shades, two
                // entries, and rounding.
                Shading::GouraudTessellated => (0.97, 3),
                // Interpolated between pixels that are lit.
                _ => (0.2, 1),
            };
            let draw = |scene: &Scene| frame_by(&mut shaded(shading), scene).0;
            let [one, other, to_eye] = [axis, -axis, Vec3::Z].map(|normal| draw(&scene([normal; 3])));
            let scene = scene([axis, -axis, third as f32 * axis]);
            let bytes = draw(&scene);
            let mut renderer = Renderer::new();
            let corners = *triangles_by(&mut renderer, &scene).last().expect("the face, whole");
            let mut covered = vec![false; bytes.len()];
            for pixel in oracle::pixels(&corners, Interpolation::Flat(0), 320, 200) {
                covered[(pixel.y * 320 + pixel.x) as usize] = true;
            }
            assert!(covered.iter().filter(|covered| **covered).count() > 5000, "{shading}: it is drawn");
            for (place, (&byte, &covered)) in bytes.iter().zip(&covered).enumerate() {
                let what =
                    || format!("{shading}, dither {dither:?}, specular {specular}: pixel {place}, {axis}, {third}");
                let is_right = if covered { (128..192).contains(&byte) } else { byte == BACKGROUND };
                assert!(is_right, "{byte} of {}", what());
                if !covered {
                    continue;
                }
                // The sum of the normals there, as a multiple of the axis.
                let sum = weights(&corners, place).iter().zip([1.0, -1.0, third]).map(|(w, n)| w * n).sum::<f64>();
                let (one, other) = (one[place], other[place]);
                let (low, high, off) = match sum {
                    // The table is indexed with x and y of the sum as they are: none points to the eye, 2 % is 5
                    // shades.
                    _ if shading == Shading::PhongTable && sum.abs() < 0.02 && specular == 0.0 => {
                        (to_eye[place], to_eye[place], 2)
                    }
                    // Neither the table nor the corners of parts determine how bright a highlight is.
                    _ if shading == Shading::PhongTable || shading != Shading::Phong && specular > 0.0 => continue,
                    _ if sum > near => (one, one, off),
                    _ if sum < -near => (other, other, off),
                    _ => (one.min(other), one.max(other), off),
                };
                assert!((low - off..=high + off).contains(&byte), "{byte}, not {low} to {high}: {}, sum {sum}", what());
                compared += u64::from(low == high);
                apart += u64::from(low == high && one.abs_diff(other) > 8);
            }
            tried.add(1);
        }
    }
    tried.worst("pixels of two tones that differ", apart as f64);
    assert!(apart * 2 > compared && apart > 100_000, "{apart} of {compared}");
}

/// The weights of a face's corners at the centre of a pixel.
fn weights(corners: &[Vertex; 3], place: usize) -> [f64; 3] {
    let (x, y) = ((place % 320) as f64 + 0.5, (place / 320) as f64 + 0.5);
    let [a, b, c] = corners.each_ref().map(|v| [point(v).0, point(v).1].map(|k| f64::from(k) / 256.0));
    let area = |[px, py]: [f64; 2], [qx, qy]: [f64; 2]| (px - x) * (qy - y) - (qx - x) * (py - y);
    let areas = [area(b, c), area(c, a), area(a, b)];
    areas.map(|area| area / areas.iter().sum::<f64>())
}

/// P2: dither uses no index of another ramp, whatever the shading and the ramp.
#[test]
fn p2_dither_keeps_to_its_ramp() {
    let mut tried = Tried::new("p2_dither_keeps_to_its_ramp", 10 * 25);
    for shading in Shading::ALL {
        for (first, entries) in
            [(1, 1_u16), (7, 2), (64, 64), (192, 64), (255, 1)].into_iter().flat_map(|ramp| [ramp; 5])
        {
            let mut scene = framed(shapes::torus(12, 8));
            scene.settings.dither = Some(DitherPattern::Ordered);
            scene.settings.accuracy = Some(shading.into());
            scene.objects_mut()[0].angles = [0.3, tried_angle(first, entries), 0.2].map(Angle::from_radians);
            let ramp = mode13h::palette::Ramp::new(first, entries).expect("a ramp");
            let material = &mut scene.objects_mut()[0].materials[0];
            material.ramp = mode13h::light::RampChoice::Entries(ramp);
            (material.specular, material.shininess) = (1.0, 5.0);
            let (bytes, stats) = frame_by(&mut Renderer::new(), &scene);
            // A table of normals holds whole shades, so there is nothing between two entries.
            assert_eq!(stats.raster.dithered > 1000, shading != Shading::PhongTable, "{shading}");
            assert!(bytes.iter().all(|byte| *byte == 0 || ramp.contains(*byte)), "{shading}, {ramp:?}");
            tried.add(1);
        }
    }
}

fn tried_angle(first: u8, entries: u16) -> f64 {
    f64::from(first) * 0.37 + f64::from(entries) * 0.11
}
