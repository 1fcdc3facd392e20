//! Faces cut by the near plane, on either vertex path: what is drawn of them, and the shades of the cuts.

use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::mesh::Mesh;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::VertexPath;
use mode13h_conformance::Random;

use crate::floor::{HEIGHT, WIDTH, counts_by, floor, scene};
use crate::support::scenes::by_path as renderer;
use crate::support::scenes::triangles_by;
use crate::support::tried::Tried;
use crate::support::vector::{cross, dot, sub};

/// Checks that floors of these sizes, in this many squares a side, cover exactly the lower half of the picture, once.
pub(crate) fn floors_are_closed(mut tried: Tried, path: VertexPath, reaches: &[f32], squares: &[u32]) {
    for (&reach, &n) in reaches.iter().flat_map(|reach| squares.iter().map(move |n| (reach, n))) {
        // The far edge is projected fy / reach below the horizon: less than half a pixel. So exactly the rows from
        // the horizon down, 100 to 199, are all floor. (The floor begins under the eye, and the picture's lower
        // edge is much nearer than the far edge.)
        let (counts, stats) = counts_by(&mut renderer(path), &scene(floor(reach, n)));
        for (place, &times) in counts.iter().enumerate() {
            let inside = place / WIDTH >= HEIGHT / 2;
            let at = (place % WIDTH, place / WIDTH);
            assert_eq!(times, u32::from(inside), "{at:?} of a floor of {reach:e}, {n} squares a side");
        }
        assert!(stats.clipped > 0, "{stats}");
        tried.add(1);
    }
}

/// Checks faces with corners before, on and behind the near plane.
pub(crate) fn corners_about_the_near_plane(mut tried: Tried, path: VertexPath) {
    // In 16.16 normals and cosines are off by one or two units each, which is as many 256ths of a shade.
    let off = if path == VertexPath::Float { 1.0 } else { 6.0 };
    let mut random = Random::named("c1");
    let (mut drawn, mut hidden, mut cuts) = (0_u64, 0_u64, 0_u64);
    while tried.more() {
        let mut corner = || {
            let z = random.one_of(&[-0.25, -0.0, 0.0, 0.25, 1.0, -1.0, -0.250_000_03, -0.249_999_99, -5.0]);
            Vec3::new(random.unit() as f32 * 4.0 - 2.0, random.unit() as f32 * 4.0 - 2.0, z)
        };
        let corners = [corner(), corner(), corner()];
        let visible = corners.iter().any(|p| -p.z >= 0.25);
        let intensities = [0; 3].map(|_| random.unit());
        let normals = intensities.map(normal).to_vec();
        let Ok(mesh) = Mesh::with_normals(corners.to_vec(), normals, vec![[0, 1, 2]]) else { panic!("{corners:?}") };
        let scene = lit(scene(mesh));
        let (counts, _) = counts_by(&mut renderer(path), &scene);
        let (once, twice) = counts.iter().fold((0, 0), |(once, twice), &times| match times {
            0 => (once, twice),
            1 => (once + 1, twice),
            _ => (once, twice + 1),
        });
        let out_of_sight = if visible { 0 } else { once + twice };
        tried.worst("double pixels", f64::from(twice));
        tried.worst("pixels out of sight", f64::from(out_of_sight));
        assert_eq!(out_of_sight, 0, "nothing of {corners:?} is in sight");
        assert_eq!(twice, 0, "{corners:?} is cut into parts that overlap");
        drawn += u64::from(once > 0);
        hidden += u64::from(!visible);
        cuts += cuts_on_the_near_plane(&mut renderer(path), &scene, corners, intensities, off);
    }
    let stated = tried.stated();
    tried.worst("faces in sight", drawn as f64);
    tried.worst("cuts with their shades", cuts as f64);
    // Of the nine distances three are beyond the near plane and one is on it. With the three alone 19 of 27 faces have
    // a corner in sight, and at least half of those show something on the screen.
    assert!(drawn * 4 > stated && hidden * 10 > stated, "of {stated} faces {drawn} in sight, {hidden} before the eye");
    assert!(cuts * 4 > stated, "{cuts} cuts");
}

/// Checks that faces of any size and place cover exactly the pixels whose rays hit them beyond the near plane.
pub(crate) fn the_visible_part_is_hit(mut tried: Tried, path: VertexPath) {
    let mut random = Random::named("c1 rays");
    let fy = 100.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let mut hits = 0;
    while tried.more() {
        // In front of the eye, behind it, to the sides; also beyond the guard band.
        let size = f64::from(random.log_uniform(10) as u32);
        let mut corner = || [0; 3].map(|_| (random.unit() * 2.0 - 1.0) * size).map(|c| f64::from(c as f32));
        let [a, b, c] = [corner(), corner(), corner()];
        let narrow = |p: [f64; 3]| Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32);
        let Ok(mesh) = Mesh::new(vec![narrow(a), narrow(b), narrow(c)], vec![[0, 1, 2]]) else { continue };
        let (counts, _) = counts_by(&mut renderer(path), &scene(mesh));
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let ray =
                    |dx: f64, dy: f64| [(x as f64 + 0.5 + dx - 160.0) / fx, -(y as f64 + 0.5 + dy - 100.0) / fy, -1.0];
                // Within 1/64 pixel of an edge rounding may decide: vertices are rounded by half of 1/256 both ways, an
                // f32 vertex is off by less than that, and a cut by 1/128. In 16.16 the matrix is exact here, and
                // vertices have 30 bits: near the eye, at 1/4 of up to 1,024 units, 2⁻¹⁹ of the distance, which is 2⁻¹⁰
                // pixel.
                let middle = hit(a, b, c, ray(0.0, 0.0));
                let e = 1.0 / 64.0;
                if [(e, e), (e, -e), (-e, e), (-e, -e)].iter().any(|&(dx, dy)| hit(a, b, c, ray(dx, dy)) != middle) {
                    continue;
                }
                assert_eq!(counts[y * WIDTH + x], u32::from(middle), "({x}, {y}) of {a:?} {b:?} {c:?}");
                hits += u32::from(middle);
            }
        }
    }
    assert!(hits > 100_000, "faces were hit: {hits}");
}

/// Returns whether the ray from the origin hits the triangle beyond the near plane. `ray`'s z is −1, so its parameter
/// is the distance along the view.
fn hit(a: [f64; 3], b: [f64; 3], c: [f64; 3], ray: [f64; 3]) -> bool {
    let (u, v, w) = (dot(ray, cross(a, b)), dot(ray, cross(b, c)), dot(ray, cross(c, a)));
    let normal = cross(sub(b, a), sub(c, a));
    let along = dot(normal, a) / dot(normal, ray);
    ((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)) && along > 0.25
}

/// A normal that gets `intensity` from a sun along z.
pub(crate) fn normal(intensity: f64) -> Vec3 {
    Vec3::new(f64::sqrt(1.0 - intensity * intensity) as f32, 0.0, intensity as f32)
}

/// Puts the scene under a sun along z, on a separate background.
pub(crate) fn lit(mut scene: Scene) -> Scene {
    scene.objects_mut()[0].materials = vec![Material { ambient: 0.0, diffuse: 1.0, ..Material::default() }];
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene.background = 7;
    scene
}

/// Checks that every corner drawn on the near plane is a corner of the face, or the point where one of its edges meets
/// the plane, with the shade that is linear along that edge, to this many of its 256ths. The eye is at the origin and
/// looks along −z, with a field of view of 1 radian vertically and the near plane at ¼. Returns the number of such
/// points.
fn cuts_on_the_near_plane(
    renderer: &mut Renderer,
    scene: &Scene,
    corners: [Vec3; 3],
    intensities: [f64; 3],
    off: f64,
) -> u64 {
    let fy = 100.0 / f64::tan(0.5);
    let fx = fy * 6.0 / 5.0;
    let near = f64::from(0.25_f32);
    // x, y and shade of what may be on the near plane.
    let mut points = Vec::new();
    for i in 0..3 {
        let [a, b] = [corners[i], corners[(i + 1) % 3]].map(|p| p.to_array().map(f64::from));
        let (of_a, of_b) = (-a[2] - near, -b[2] - near);
        if (of_a >= 0.0) != (of_b >= 0.0) {
            let part = of_a / (of_a - of_b);
            let [x, y] = [0, 1].map(|k| a[k] + (b[k] - a[k]) * part);
            let shade = intensities[i] + (intensities[(i + 1) % 3] - intensities[i]) * part;
            points.push((x / near * fx + 160.0, -y / near * fy + 100.0, shade));
        }
    }
    let mut cuts = 0;
    let parts = triangles_by(renderer, scene);
    let parts = parts.as_flattened();
    // From behind a face is dark.
    let is_dark = parts.iter().all(|v| v.shade().to_bits() == 0);
    for v in parts.iter().filter(|v| v.depth() == 1 << 30 && !is_dark) {
        let (x, y) = (f64::from(v.x().to_bits()) / 256.0, f64::from(v.y().to_bits()) / 256.0);
        // Rounded to half of 1/256 pixel; the error of coordinates of up to 2 units is less than that, on either path.
        let is_there = |&(px, py, shade): &(f64, f64, f64)| {
            (px - x).abs() <= 0.01
                && (py - y).abs() <= 0.01
                && (shade * 65_280.0 - f64::from(v.shade().to_bits())).abs() <= off
        };
        let is_corner = corners.iter().any(|p| -p.z >= 0.25 && -p.z < 0.250_001);
        let is_beyond = x.abs() > 4_094.0 || y.abs() > 4_094.0;
        if is_corner || is_beyond {
            continue;
        }
        assert!(points.iter().any(is_there), "{v:?} of {corners:?}, {intensities:?}: {points:?}");
        cuts += 1;
    }
    cuts
}
