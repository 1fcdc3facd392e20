//! Group N: normals and light.

use super::Group;
use super::random::Random;
use mode13h::Angle;
use mode13h::fixed::I16F16;
use mode13h::glam::Vec3;
use mode13h::integer::unit_vector;
use mode13h::light::{Light, Material, RampChoice};
use mode13h::mesh::{Mesh, Weight, shapes};
use mode13h::palette::Ramp;
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;

/// Normals have length 1 within 2⁻¹⁴ (N6), faces without area count nothing (N1), normals that cancel
/// leave each face its own (N2); light of any number and sign stays in the ramp (N4, N5), and is what
/// the formula says.
///
/// ```
/// let group = mode13h_lab::verify::normals(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn normals(seed: u64) -> Group {
    check(seed, &|mesh| mesh.normals().to_vec(), &shades_of)
}

/// The normals of a mesh.
type Normals<'a> = &'a dyn Fn(&Mesh) -> Vec<Vec3>;
/// The shades of all corners of a scene's triangles, in 1/256.
type Shades<'a> = &'a dyn Fn(&Scene) -> Vec<u16>;

fn shades_of(scene: &Scene) -> Vec<u16> {
    let mut shades = Vec::new();
    let each = |vertices: &[Vertex; 3], _| shades.extend(vertices.each_ref().map(|v| v.shade().to_bits()));
    match Renderer::new().for_each_triangle(scene, Screen::MODE_13H, each) {
        Ok(_) => shades,
        Err(_) => Vec::new(),
    }
}

fn check(seed: u64, normals: Normals<'_>, shades: Shades<'_>) -> Group {
    let mut group = Group::new("normals");
    let mut random = Random::new(seed, "normals");
    for name in shapes::NAMES {
        let Some(mesh) = shapes::by_name(name) else { continue };
        unit(&mut group, name, &normals(&mesh));
    }
    for _ in 0..2_000 {
        // N6 on the 16.16 path: vectors of any length, along an axis too.
        let most = random.log_uniform(31);
        let v = [0; 3].map(|_| I16F16::from_bits(random.within(-most, most) as i32));
        let v = if random.below(8) == 0 { [v[0], I16F16::default(), I16F16::default()] } else { v };
        let Some(unit_vector) = unit_vector(v) else {
            group.check(v == [I16F16::default(); 3], || format!("n6 {v:?} has no unit vector"));
            continue;
        };
        let in_ones = unit_vector.map(|c| c.to_bits() as f32 / 65_536.0);
        unit(&mut group, "16.16", &[Vec3::from_array(in_ones)]);
    }
    for _ in 0..400 {
        soup(&mut group, &mut random, normals);
    }
    for _ in 0..200 {
        folded(&mut group, &mut random, normals);
        lit(&mut group, &mut random, shades);
        in_ramp(&mut group, &mut random, shades);
    }
    group
}

/// Every normal has length 1 within 2⁻¹⁴.
fn unit(group: &mut Group, what: &str, normals: &[Vec3]) {
    let length = |n: &Vec3| libm::sqrt([n.x, n.y, n.z].map(|c| f64::from(c) * f64::from(c)).iter().sum::<f64>());
    // NaN lies in no range.
    let range = 1.0 - 1.0 / 16_384.0..1.0 + 1.0 / 16_384.0;
    let wrong = normals.iter().find(|n| !range.contains(&length(n)));
    group.check(wrong.is_none() && !normals.is_empty(), || format!("n6 {what}: a normal is {wrong:?}"));
}

/// Random faces of any size, some of them without area.
fn soup(group: &mut Group, random: &mut Random, normals: Normals<'_>) {
    let size = libm::exp2(random.within(-140, 120) as f64);
    let count = 3 + random.below(10);
    let mut positions: Vec<Vec3> =
        (0..count).map(|_| Vec3::from_array([0; 3].map(|_| random.around_zero(size) as f32))).collect();
    let mut triangles: Vec<[u32; 3]> = (0..1 + random.below(12)).map(|_| [0; 3].map(|_| random.below(count))).collect();
    let Ok(mut mesh) = Mesh::new(positions.clone(), triangles.clone()) else {
        group.check(false, || format!("n1 a mesh of size {size:e} is refused"));
        return;
    };
    let before = normals(&mesh);
    unit(group, "random faces", &before);

    // N1: a line and a point, on vertices of their own and on those of the others.
    positions.push(positions[0]);
    triangles.extend([[0, 1, 0], [1, 1, 1], [0, count, 1]]);
    if let Ok(more) = Mesh::new(positions, triangles) {
        let after = normals(&more);
        let kept = before.iter().zip(&after).take(count as usize).all(|(a, b)| a == b);
        group.check(kept, || format!("n1 faces without area change normals {before:?} to {after:?}"));
    }
    mesh.smooth(
        random.one_of(&[Weight::Count, Weight::Area, Weight::Angle]),
        Some(Angle::from_radians(random.unit() * 3.2)),
    );
    unit(group, "random faces, smoothed", &normals(&mesh));
}

/// N2: a sheet folded back on itself: each side has its own face's normal.
fn folded(group: &mut Group, random: &mut Random, normals: Normals<'_>) {
    let corners = [0; 3].map(|_| Vec3::from_array([0; 3].map(|_| random.around_zero(10.0) as f32)));
    let Ok(mesh) = Mesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 1]]) else { return };
    let normals = normals(&mesh);
    let wide = corners.map(|p| [p.x, p.y, p.z].map(f64::from));
    let [e, f] = [1, 2].map(|i| [0, 1, 2].map(|axis| wide[i][axis] - wide[0][axis]));
    let n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    let length = libm::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    let mut wrong = None;
    for (triangle, sign) in mesh.triangles().iter().zip([1.0, -1.0]) {
        for vertex in triangle {
            let is = normals[*vertex as usize];
            let cosine = (f64::from(is.x) * n[0] + f64::from(is.y) * n[1] + f64::from(is.z) * n[2]) / length * sign;
            // 1 but for the rounding of three f32: 2⁻²², and far more where the corners are all but on
            // a line, which 10⁻³ of the edges' product is not.
            if length > 0.1 && !(0.999_99..1.000_01).contains(&cosine) {
                wrong = Some(is);
            }
        }
    }
    group.check(wrong.is_none(), || format!("n2 a folded sheet {corners:?} has the normal {wrong:?}"));
}

/// A triangle that fills the picture, with a normal of its own at each corner, in a random ramp.
fn facing(random: &mut Random) -> Option<(Scene, Ramp)> {
    let corners = vec![Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, -0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)];
    let normals = (0..3).map(|_| Vec3::from_array([0; 3].map(|_| random.around_zero(1.0) as f32 + 1e-6))).collect();
    let mut scene = super::framed(Mesh::with_normals(corners, normals, vec![[0, 1, 2]]).ok()?);
    scene.clear_lights();
    scene.camera = mode13h::scene::Camera::default();
    let first = random.below(256) as u8;
    let ramp = Ramp::new(first, 1 + random.below(256 - u32::from(first)) as u16)?;
    scene.objects_mut()[0].pivot = Vec3::ZERO;
    scene.objects_mut()[0].materials = vec![Material { ramp: RampChoice::Entries(ramp), ..Material::default() }];
    Some((scene, ramp))
}

/// The shades of a few lights, as the formula has them: I = ka·Ia + Σ kd·Id·max(0, n·l).
fn lit(group: &mut Group, random: &mut Random, shades: Shades<'_>) {
    let Some((mut scene, ramp)) = facing(random) else { return };
    scene.ambient = random.unit() as f32;
    let mut suns = Vec::new();
    for _ in 0..=random.below(4) {
        let (towards, intensity) =
            ([0; 3].map(|_| random.around_zero(1.0) as f32 + 1e-6), random.around_zero(1.0) as f32);
        scene.add_light(Light::sun(towards).with_intensity(intensity));
        suns.push((towards.map(f64::from), f64::from(intensity)));
    }
    let material = &scene.objects()[0].materials[0];
    let expected = scene.objects()[0].mesh().normals().iter().map(|n| {
        let n = [n.x, n.y, n.z].map(f64::from);
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let diffuse = suns.iter().map(|(l, intensity)| intensity * (dot(&n, l) / libm::sqrt(dot(l, l))).max(0.0));
        let light =
            f64::from(material.ambient) * f64::from(scene.ambient) + f64::from(material.diffuse) * diffuse.sum::<f64>();
        f64::from(ramp.first()) * 256.0 + light.clamp(0.0, 1.0) * f64::from(ramp.entries() - 1) * 256.0
    });
    let expected: Vec<f64> = expected.collect();
    let is = shades(&scene);
    // n·l in f32 is off by 2⁻²¹ at most. Times five lights and 65,280 that is less than a sixth, and
    // rounding adds a half.
    let right = is.len() == 3 && is.iter().zip(&expected).all(|(is, should)| (f64::from(*is) - should).abs() < 0.7);
    group.check(right, || format!("n4 {} lights on {ramp:?}: shades {is:?}/256, not {expected:?}/256", suns.len()));
}

/// N5: up to a thousand lights of any intensity: no shade leaves its ramp.
fn in_ramp(group: &mut Group, random: &mut Random, shades: Shades<'_>) {
    let Some((mut scene, ramp)) = facing(random) else { return };
    let most = random.one_of(&[0.001, 1.0, 1e6, 3e38]);
    scene.ambient = random.around_zero(most) as f32;
    let count = random.log_uniform(10);
    for _ in 0..count {
        let towards = [0; 3].map(|_| random.around_zero(1.0) as f32 + 1e-6);
        scene.add_light(Light::sun(towards).with_intensity(random.around_zero(most) as f32));
    }
    let is = shades(&scene);
    let range = u16::from(ramp.first()) * 256..=u16::from(ramp.last()) * 256;
    let right = is.len() == 3 && is.iter().all(|shade| range.contains(shade));
    group.check(right, || format!("n5 {count} lights of up to {most:e} on {ramp:?}: shades {is:?}/256"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_and_light_are_right() {
        let group = normals(1);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 1_500);
    }

    /// The Hungarian tutorial's average, divided by the number of faces and left at that.
    #[test]
    fn short_normals_are_told() {
        let group = check(1, &|mesh| mesh.normals().iter().map(|n| *n * 0.9).collect(), &shades_of);
        assert!(group.failures[0].starts_with("n6 cube: a normal is Some("), "{:?}", group.failures);
    }

    #[test]
    fn shades_out_of_their_ramp_are_told() {
        let brighter = |scene: &Scene| shades_of(scene).into_iter().map(|shade| shade.saturating_add(300)).collect();
        let group = check(1, &|mesh| mesh.normals().to_vec(), &brighter);
        assert!(group.failures.iter().any(|line| line.starts_with("n5 ")), "{:?}", group.failures);
        assert!(group.failures.iter().any(|line| line.starts_with("n4 ")), "{:?}", group.failures);
    }
}
