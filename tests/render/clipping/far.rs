//! Positions up to `f32::MAX` on the float path, byte by byte.

use mode13h::glam::Vec3;
use mode13h::mesh::Mesh;
use mode13h::render::{Renderer, Screen};
use mode13h::settings::Shading;

use super::scene;
use crate::near_plane::{lit, normal};
use crate::support::judged::judged;
use crate::support::tried::Tried;
use mode13h_conformance::Random;

const WIDTH: u32 = 20;
const HEIGHT: u32 = 12;
const SCREEN: Screen = Screen { width: WIDTH, height: HEIGHT, pixel_aspect: (5, 6) };

/// A coordinate of any magnitude, small and large equally likely.
fn coordinate(random: &mut Random) -> f32 {
    let size = f64::powf(2.0, random.unit() * 140.0 - 12.0).min(f64::from(f32::MAX)) as f32;
    random.one_of(&[size, -size, size, -size, f32::MAX, f32::MIN, 0.0])
}

/// Faces anywhere: bytes are those of the clipped triangles, no two parts of a face overlap, shades are in range.
pub(crate) fn faces_up_to_the_greatest_number(mut tried: Tried) {
    let mut random = Random::named("r7 greatest");
    let shadings = [
        Shading::Gouraud88,
        Shading::Gouraud88Reseeded,
        Shading::Gouraud1616,
        Shading::GouraudHyperbolic,
        Shading::GouraudFloat,
    ];
    let (mut seen, mut clipped, mut covered) = (0_u64, 0_u64, 0_u64);
    while tried.more() {
        let corners = [0; 3].map(|_| {
            let p = [0; 3].map(|_| coordinate(&mut random));
            // Half of them are in front of the eye.
            Vec3::new(p[0], p[1], if random.within(0, 1) == 0 { -p[2].abs() } else { p[2] })
        });
        let intensities = [0; 3].map(|_| random.unit());
        let Ok(mesh) = Mesh::with_normals(corners.to_vec(), intensities.map(normal).to_vec(), vec![[0, 1, 2]]) else {
            panic!("{corners:?}")
        };
        let mut renderer = Renderer::new();
        renderer.settings.accuracy = Some(random.one_of(&shadings).into());
        let (judged, stats) = judged(&mut renderer, &lit(scene(mesh)), SCREEN);
        assert!(judged.counts.iter().all(|&times| times <= 1), "parts of {corners:?} overlap");
        let shades = judged.triangles.iter().flat_map(|(vertices, _)| vertices.map(|v| f64::from(v.shade().to_bits())));
        let (low, high) = intensities.iter().fold((f64::MAX, 0.0), |(low, high), &i| (i.min(low), i.max(high)));
        // In f32 the normal is off by a few 2⁻²⁴, and the shade is rounded; from behind a face is dark.
        for shade in shades {
            let in_range = (low * 65_280.0 - 1.0..=high * 65_280.0 + 1.0).contains(&shade);
            assert!(in_range || shade == 0.0, "{shade} of {intensities:?}, {corners:?}");
        }
        seen += u64::from(judged.counts.contains(&1));
        covered += judged.counts.iter().map(|&times| u64::from(times)).sum::<u64>();
        clipped += stats.clipped;
    }
    for (measure, count) in [("faces in sight", seen), ("clipped", clipped), ("pixels", covered)] {
        tried.worst(measure, count as f64);
    }
    let stated = tried.stated();
    assert!(seen * 4 > stated && clipped * 4 > stated && covered > 10 * stated, "{seen}, {clipped}, {covered}");
}

/// A floor one below the eye or a ceiling one above it, of rectangles of any size: wherever a ray hits it, it is
/// covered once.
pub(crate) fn floors_up_to_the_greatest_number(mut tried: Tried) {
    let mut random = Random::named("r7 floors");
    let fy = f64::from(HEIGHT) / 2.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let mut hits = 0_u64;
    while tried.more() {
        let mut lines = || {
            let mut lines: Vec<f32> = (0..random.within(2, 4)).map(|_| coordinate(&mut random)).collect();
            lines.sort_unstable_by(f32::total_cmp);
            lines.dedup();
            lines
        };
        let (xs, zs) = (lines(), lines());
        let (Some(columns), Some(rows)) = (xs.len().checked_sub(1), zs.len().checked_sub(1)) else { continue };
        if columns * rows == 0 {
            continue;
        }
        let y = random.one_of(&[1.0, -1.0]);
        let positions = zs.iter().flat_map(|&z| xs.iter().map(move |&x| Vec3::new(x, y, z))).collect();
        let at = |column: usize, row: usize| (row * xs.len() + column) as u32;
        let mut triangles = Vec::new();
        for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column, row + 1), at(column + 1, row + 1)];
            triangles.extend(random.one_of(&[[[a, c, b], [b, c, d]], [[a, c, d], [a, d, b]]]));
        }
        let (judged, _) =
            judged(&mut Renderer::new(), &lit(scene(Mesh::new(positions, triangles).expect("a mesh"))), SCREEN);
        let is_hit = |x: f64, y_pixel: f64| {
            let ray = [(x - f64::from(WIDTH) / 2.0) / fx, -(y_pixel - f64::from(HEIGHT) / 2.0) / fy];
            // The distance along the view at which the floor is hit.
            let along = f64::from(y) / ray[1];
            let within = |lines: &[f32], at: f64| f64::from(lines[0]) < at && at < f64::from(lines[lines.len() - 1]);
            along > 0.25 && within(&xs, along * ray[0]) && within(&zs, -along)
        };
        for (place, &times) in judged.counts.iter().enumerate() {
            let (x, y) = ((place as u32 % WIDTH) as f64 + 0.5, (place as u32 / WIDTH) as f64 + 0.5);
            assert!(times <= 1, "({x}, {y}) of {xs:?} and {zs:?} is covered {times} times");
            // Within 1/64 pixel of an edge rounding may decide, as above.
            let (middle, e) = (is_hit(x, y), 1.0 / 64.0);
            if [(e, e), (e, -e), (-e, e), (-e, -e)].iter().all(|&(dx, dy)| is_hit(x + dx, y + dy) == middle) {
                assert_eq!(times, u32::from(middle), "({x}, {y}) of {xs:?} and {zs:?}");
                hits += u64::from(middle);
            }
        }
    }
    tried.worst("pixels met", hits as f64);
    assert!(hits > 10 * tried.stated(), "{hits} pixels met");
}
