//! Faces cut by the near plane, and the shades of the cuts.

use mode13h::glam::Vec3;
use mode13h::light::{Light, Material};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;

/// A normal that gets `intensity` from a sun along z.
pub fn normal(intensity: f64) -> Vec3 {
    Vec3::new(f64::sqrt(1.0 - intensity * intensity) as f32, 0.0, intensity as f32)
}

/// Puts the scene under a sun along z, on a separate background.
pub fn lit(mut scene: Scene) -> Scene {
    scene.objects_mut()[0].materials = vec![Material { ambient: 0.0, diffuse: 1.0, ..Material::default() }];
    scene.add_light(Light::sun([0.0, 0.0, 1.0]));
    scene.background = 7;
    scene
}

/// Checks that every corner drawn on the near plane is a corner of the face, or the point where one of its edges meets
/// the plane, with the shade that is linear along that edge, to this many of its 256ths. The eye is at the origin and
/// looks along −z, with a field of view of 1 radian vertically and the near plane at ¼. Returns the number of such
/// points.
pub fn cuts_on_the_near_plane(
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
    let mut parts = Vec::new();
    renderer.for_each_triangle(scene, Screen::MODE_13H, |vertices, _| parts.extend(*vertices)).expect("a legal scene");
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
