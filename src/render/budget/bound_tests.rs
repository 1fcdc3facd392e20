//! Tests that the bound holds: on random patches in random light, no sampled error exceeds the
//! bound of the face, of the part, or of the cluster that contains the face. `cargo test` tests
//! 56,000 faces, the long run 100 times as many.

use core::f64::consts::FRAC_PI_2;
use std::vec::Vec;

use glam::Vec3;
use proptest::prelude::*;

use super::bound::{Bounds, Incident, Shapes, error_at_best, interpolation_error};
use super::clusters::{Clusters, radius};
use super::ranges::{EightFaces, ZERO};
use crate::Angle;
use crate::lanes::LANES;
use crate::light::{Cone, ConeBeam, LampBeam, Lights, Reflectance, SunBeam};
use crate::mesh::normals::unit;
use crate::mesh::wide::widen;
use crate::random::Random;
use crate::render::geometry::Geometry;

/// Source of random faces and lights.
struct Chance(Random);

impl Chance {
    fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from([0.0; 3].map(|_| (2.0 * self.unit() - 1.0) as f32))
    }

    fn direction(&mut self) -> Vec3 {
        unit(self.vector()).unwrap_or(Vec3::Z)
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// A cone whose edge, soft or sharp, is near a point, whatever its angles.
    fn cone(&mut self, from: Vec3, to: Vec3) -> ConeBeam {
        let axis = unit(to - from).unwrap_or(Vec3::Z);
        let aside = unit(axis.cross(self.direction())).unwrap_or(Vec3::Z);
        let angle = self.log(0.3, 89.0).to_radians();
        let direction = axis * angle.cos() as f32 + aside * angle.sin() as f32;
        let (inner, outer) = (angle * (1.0 - self.log(1e-3, 1.0)), angle * (1.0 + self.log(1e-3, 1.0)));
        let [inner, outer] = [inner, outer.min(FRAC_PI_2)].map(Angle::from_radians);
        ConeBeam::new(&Cone { direction, inner, outer }, widen(direction)).expect("a direction")
    }

    fn colors(&mut self) -> [f32; 3] {
        [0.0; 3].map(|_| (1.5 * self.unit() - 0.5) as f32)
    }
}

/// Eight faces of some size about the origin, and the light on them.
struct Case {
    triangles: Vec<[u32; 3]>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    suns: Vec<SunBeam>,
    lamps: Vec<LampBeam>,
    eye: [f64; 3],
    reflectance: Reflectance,
    part: f32,
    in_color: bool,
}

impl Case {
    fn new(random: &mut Chance) -> Self {
        let spread = random.log(0.003, 2.0) as f32;
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        let apart = random.log(0.01, 3.0) as f32;
        for _ in 0..LANES {
            let middle = random.vector() * apart;
            let bias = Vec3::Z + random.vector() * spread.min(0.5);
            for _ in 0..3 {
                positions.push(middle + random.vector() * Vec3::new(1.0, 1.0, 0.2));
                normals.push(unit(bias + random.vector() * spread).unwrap_or(Vec3::Z));
            }
        }
        let wide = |v: Vec3| [v.x, v.y, v.z].map(f64::from);
        let on = |random: &mut Chance| positions[0] * random.unit() as f32 + positions[1] * random.unit() as f32;
        let eye_at = on(random) + (Vec3::Z + random.vector()) * random.log(1e-2, 100.0) as f32;
        let mirrored = |at: Vec3| {
            let to_eye = unit(eye_at - at).unwrap_or(Vec3::Z);
            Vec3::new(-to_eye.x, -to_eye.y, to_eye.z)
        };
        let intensity =
            |random: &mut Chance| random.log(1e-2, 10.0) as f32 * if random.chance(0.25) { -1.0 } else { 1.0 };
        let (mut suns, mut lamps) = (Vec::new(), Vec::new());
        for _ in 0..1 + (3.0 * random.unit()) as usize {
            if random.chance(0.5) {
                let about = if random.chance(0.6) { mirrored(positions[0]) } else { random.direction() };
                let towards = unit(about + random.vector() * random.log(0.01, 2.0) as f32).unwrap_or(Vec3::Z);
                suns.push(SunBeam { towards, intensity: intensity(random), channels: random.colors() });
            } else {
                let at = on(random);
                let towards = if random.chance(0.5) { mirrored(at) } else { Vec3::Z + random.vector() };
                let height = random.log(1e-3, 10.0);
                let range = random.log(0.2, 30.0) * if random.chance(0.5) { 1.0 } else { height };
                lamps.push(LampBeam {
                    position: wide(at + towards * height as f32),
                    intensity: intensity(random),
                    channels: random.colors(),
                    inverse_square: 1.0 / (range * range),
                    cone: None,
                });
            }
        }
        let shininess = match random.unit() {
            kind if kind < 0.1 => random.log(1e-30, 2.0),
            kind if kind < 0.2 => random.log(0.1, 2.0),
            kind if kind < 0.6 => 1.0 + (60.0 * random.unit()).floor(),
            _ => random.log(1.0, 300.0),
        };
        let reflectance = Reflectance {
            ambient: random.unit() * 0.5,
            diffuse: random.unit(),
            specular: if random.chance(0.6) { random.log(1e-2, 10.0) } else { 0.0 },
            shininess,
            color: random.colors().map(f64::from),
            highlight: random.colors().map(f64::from),
        };
        let part = if random.chance(0.5) { 1.0 } else { random.log(0.02, 0.7) as f32 };
        let triangles = (0..LANES as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let in_color = random.chance(0.4);
        Self { triangles, positions, normals, suns, lamps, eye: wide(eye_at), reflectance, part, in_color }
    }

    /// Faces that one lamp grazes, seen from the other side: all corners are lit, the first one
    /// least, and the points between may be dark. A highlight peaks there, and ends abruptly.
    fn grazing(random: &mut Chance) -> Self {
        let mut case = Self::new(random);
        let spread = random.log(0.01, 0.5) as f32;
        for normal in &mut case.normals {
            *normal = unit(Vec3::Z + random.vector() * Vec3::new(1.0, 1.0, 0.0) * spread).unwrap_or(Vec3::Z);
        }
        let along = random.direction() * Vec3::new(1.0, 1.0, 0.0);
        let away = along * random.log(2.0, 100.0) as f32;
        // The least height above the face at which all of its corners are lit, and a little more.
        let needed = (0..3).map(|i| -case.normals[i].dot(away - case.positions[i]) / case.normals[i].z);
        let height = needed.fold(f32::MIN, f32::max) + random.log(1e-5, 1e-2) as f32;
        let wide = |v: Vec3| [v.x, v.y, v.z].map(f64::from);
        let (intensity, channels) = (1.0, [1.0; 3]);
        let lamp = LampBeam {
            position: wide(away + Vec3::Z * height),
            intensity,
            channels,
            inverse_square: 1e-12,
            cone: None,
        };
        (case.suns, case.lamps) = (Vec::new(), [lamp].into());
        let eye = away * -random.log(0.5, 2.0) as f32 + Vec3::Z * random.log(1e-3, 1.0) as f32;
        case.eye = wide(eye);
        (case.reflectance.specular, case.reflectance.shininess) = (1.0, random.log(2.0, 20.0));
        case
    }

    /// Faces at the edge of a spot light, near it or far away.
    fn spot(random: &mut Chance) -> Self {
        let mut case = Self::new(random);
        case.suns.clear();
        case.lamps.clear();
        let size = random.log(0.01, 1.0) as f32;
        case.positions.iter_mut().for_each(|position| *position *= size);
        let away = random.log(0.1, 30.0) as f32;
        for _ in 0..if random.chance(0.8) { 1 } else { 2 } {
            let at = case.positions[0].lerp(case.positions[1], random.unit() as f32);
            let from = at + (Vec3::Z + 0.5 * random.vector()) * away;
            let range = f64::from(away) * random.log(1.0, 10.0);
            let intensity = random.log(0.1, 10.0) as f32 * if random.chance(0.25) { -1.0 } else { 1.0 };
            case.lamps.push(LampBeam {
                position: [from.x, from.y, from.z].map(f64::from),
                intensity,
                channels: random.colors(),
                inverse_square: 1.0 / (range * range),
                cone: Some(random.cone(from, at)),
            });
        }
        case
    }

    /// A tiny exponent: where r·v passes 0 the highlight is nearly a step, and elsewhere it is flat.
    fn stepped(random: &mut Chance) -> Self {
        let mut case = Self::new(random);
        case.reflectance.shininess = if random.chance(0.1) { 0.0 } else { random.log(1e-30, 1.0) };
        case.reflectance.specular = random.log(1e-2, 10.0);
        case
    }

    fn lights(&self) -> Lights<'_> {
        Lights { suns: &self.suns, lamps: &self.lamps, eye: self.eye }
    }

    /// Light at a point of a face, clamped, by the model in f64.
    fn light(&self, face: usize, weights: [f64; 3]) -> [f64; 3] {
        let sum = |of: &[Vec3]| {
            let mut sum = [0.0; 3];
            for (corner, weight) in weights.into_iter().enumerate() {
                let v = of[3 * face + corner];
                sum = [0, 1, 2].map(|axis| sum[axis] + weight * f64::from(v[axis]));
            }
            sum
        };
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let made_unit = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
        let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let (at, normal) = (sum(&self.positions), made_unit(sum(&self.normals)));
        let to_eye = made_unit(sub(self.eye, at));
        let mut light =
            self.reflectance.color.map(|color| self.reflectance.ambient * if self.in_color { color } else { 1.0 });
        let mut add = |towards: [f64; 3], intensity: f64, channels: [f32; 3]| {
            let cosine = dot(normal, towards);
            if cosine <= 0.0 || cosine.is_nan() {
                return;
            }
            let along = 2.0 * cosine * dot(normal, to_eye) - dot(towards, to_eye);
            let power = if along > 0.0 { along.powf(self.reflectance.shininess) } else { 0.0 };
            for (channel, light) in light.iter_mut().enumerate() {
                let (body, mirrored) = (self.reflectance.diffuse * cosine, self.reflectance.specular * power);
                let (own, of_highlight) = (self.reflectance.color[channel], self.reflectance.highlight[channel]);
                *light += if self.in_color {
                    f64::from(channels[channel]) * (body * own + mirrored * of_highlight)
                } else {
                    intensity * (body + mirrored)
                };
            }
        };
        for sun in &self.suns {
            add(sun.towards.to_array().map(f64::from), f64::from(sun.intensity), sun.channels);
        }
        for lamp in &self.lamps {
            let way = sub(lamp.position, at);
            let left = (1.0 - dot(way, way) * lamp.inverse_square).max(0.0);
            let share = lamp.cone.map_or(1.0, |cone| {
                let outer = cone.inner - 1.0 / cone.inverse_width;
                let x = ((dot(cone.back, made_unit(way)) - outer) / (cone.inner - outer)).clamp(0.0, 1.0);
                3.0 * x * x - 2.0 * x * x * x
            });
            let fall_off = left * left * share;
            let mut channels = lamp.channels;
            channels.iter_mut().for_each(|channel| *channel *= fall_off as f32);
            add(made_unit(way), f64::from(lamp.intensity) * fall_off, channels);
        }
        light.map(|light| light.clamp(0.0, 1.0))
    }

    fn incident(&self, extent: f32) -> Incident<'_> {
        Incident {
            lights: self.lights(),
            reflectance: &self.reflectance,
            extent,
            in_color: self.in_color,
            below: false,
        }
    }

    fn clusters(&self) -> Clusters {
        Clusters::new(&Geometry {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.triangles,
            triangle_surfaces: &[0; LANES],
            ..Geometry::default()
        })
    }

    fn faces(&self) -> EightFaces {
        let mut faces = EightFaces { normals: [[ZERO; 3]; 3], positions: [[ZERO; 3]; 3] };
        for lane in 0..LANES {
            for corner in 0..3 {
                for axis in 0..3 {
                    faces.normals[corner][axis][lane] = self.normals[3 * lane + corner][axis];
                    faces.positions[corner][axis][lane] = self.positions[3 * lane + corner][axis];
                }
            }
        }
        faces
    }

    /// Bounds of the faces, of their parts, and of the cluster that contains them.
    fn bounds(&self) -> (Bounds, Bounds, Bounds) {
        let clusters = self.clusters();
        let mut shapes = Shapes { spread: ZERO, edge: ZERO, part: None, bend: ZERO };
        for (lane, facet) in clusters.facets.iter().enumerate() {
            (shapes.spread[lane], shapes.edge[lane]) = (facet.spread, facet.edge);
        }
        let (faces, incident) = (self.faces(), self.incident(clusters.extent));
        let parts = Shapes { part: Some([self.part; LANES]), ..shapes };
        let chunk = &clusters.chunks[0];
        let of_chunk = Shapes { spread: chunk.spread, edge: chunk.edge, part: None, bend: ZERO };
        (
            interpolation_error(&faces, &shapes, &incident),
            interpolation_error(&faces, &parts, &incident),
            interpolation_error(&chunk.clusters, &of_chunk, &incident),
        )
    }

    /// The greatest error among points of a part of a face: the triangle with these corners.
    fn sampled(&self, face: usize, corners: [[f64; 3]; 3], points: u32) -> f64 {
        let at_corners = corners.map(|weights| self.light(face, weights));
        let mut most = 0.0_f64;
        for a in 0..=points {
            for b in 0..=points - a {
                let shares = [a, b, points - a - b].map(|share| f64::from(share) / f64::from(points));
                let mix = |of: [[f64; 3]; 3]| -> [f64; 3] {
                    core::array::from_fn(|i| (0..3).map(|corner| shares[corner] * of[corner][i]).sum())
                };
                let (light, linear) = (self.light(face, mix(corners)), mix(at_corners));
                for channel in 0..if self.in_color { 3 } else { 1 } {
                    let error = (light[channel] - linear[channel]).abs();
                    // There is no bound for a light on the surface itself.
                    most = if error.is_nan() { most } else { most.max(error) };
                }
            }
        }
        most
    }

    /// The corners of a random part of the case's size.
    fn part(&self, random: &mut Chance) -> [[f64; 3]; 3] {
        let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let part = f64::from(self.part);
        let turned = random.chance(0.5) && part < 0.5;
        let (mut a, mut b) = (random.unit(), random.unit());
        if a + b > 1.0 {
            (a, b) = (1.0 - a, 1.0 - b);
        }
        let room = 1.0 - if turned { 2.0 * part } else { part };
        let origin = [a, b, 1.0 - a - b].map(|share| share * room + if turned { part } else { 0.0 });
        whole.map(|corner| [0, 1, 2].map(|i| origin[i] + if turned { -part } else { part } * corner[i]))
    }
}

/// Rounding of f32 sums near 1: 1/10,000 shade, covered by the allowance for the rounding of shades.
const ROUNDING: f64 = 4e-7;

/// Tests one case; returns the ratio of bound to error for each face with a significant error.
fn try_case(case: &Case, random: &mut Chance, points: u32) -> Vec<f64> {
    let (whole, parts, clusters) = case.bounds();
    let mut ratios = Vec::new();
    for lane in 0..LANES {
        let bound = f64::from(whole.on_face[lane]);
        let error = case.sampled(lane, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], points);
        let what = || {
            let corners = [0, 1, 2].map(|i| (case.positions[3 * lane + i], case.normals[3 * lane + i]));
            std::format!(
                "{corners:?} {:?} {:?} {:?} {:?} in colour: {}",
                case.suns,
                case.lamps,
                case.eye,
                case.reflectance,
                case.in_color
            )
        };
        assert!(error <= bound + ROUNDING, "{error} beyond {bound}: {}", what());
        let of_cluster = f64::from(clusters.on_face[0]);
        assert!(error <= of_cluster + ROUNDING, "{error} beyond {of_cluster} of the cluster: {}", what());
        assert!(whole.on_screen[lane] >= whole.on_face[lane]);
        if error > 1.0 / 255.0 {
            ratios.push(bound / error);
        }
        let bound = f64::from(parts.on_face[lane]);
        let error = case.sampled(lane, case.part(random), points / 2);
        assert!(error <= bound + ROUNDING, "{error} beyond {bound} of a part of {}: {}", case.part, what());
    }
    ratios
}

#[test]
fn no_sampled_error_of_a_spot_light_is_beyond_its_bound() {
    let mut random = Chance(Random::again(16));
    let mut ratios: Vec<f64> = (0..2_000)
        .map(|_| Case::spot(&mut random))
        .collect::<Vec<_>>()
        .iter()
        .flat_map(|case| try_case(case, &mut random, 24))
        .collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
    std::println!("{} faces: bound over error {:.2} at the least, {:.2} in the median", ratios.len(), at(0.0), at(0.5));
    assert!(ratios.len() > 2_000);
}

#[test]
fn no_sampled_error_is_beyond_its_bound() {
    let mut random = Chance(Random::again(13));
    let mut ratios = Vec::new();
    for _ in 0..4_000 {
        let case = Case::new(&mut random);
        ratios.extend(try_case(&case, &mut random, 12));
    }
    for _ in 0..500 {
        try_case(&Case::grazing(&mut random), &mut random, 12);
        try_case(&Case::stepped(&mut random), &mut random, 12);
    }
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
    std::println!("{} faces: bound over error {:.2} in the median, {:.2} at 95 %", ratios.len(), at(0.5), at(0.95));
    assert!(ratios.len() > 5_000);
    // Measured with the current bound, plus 2 % for other machines' power functions: a looser bound
    // slows down the budget.
    assert!(at(0.5) < 3.71 && at(0.95) < 43.6, "a looser bound: {:.2} and {:.2}", at(0.5), at(0.95));
}

/// Tests a hundred times as many patches.
#[test]
#[ignore = "the long run: 3,200,000 faces"]
fn bound_of_many_more_patches() {
    let mut random = Chance(Random::again(14));
    for _ in 0..400_000 {
        let case = match random.unit() {
            kind if kind < 0.1 => Case::grazing(&mut random),
            kind if kind < 0.2 => Case::stepped(&mut random),
            kind if kind < 0.4 => Case::spot(&mut random),
            _ => Case::new(&mut random),
        };
        try_case(&case, &mut random, 12);
    }
}

/// Every kernel finds the same bounds.
#[test]
fn bounds_do_not_depend_on_the_kernel() {
    use crate::span::Kernel;
    let mut random = Chance(Random::again(15));
    for _ in 0..200 {
        let case = if random.chance(0.3) { Case::spot(&mut random) } else { Case::new(&mut random) };
        let clusters = case.clusters();
        let shapes = Shapes {
            spread: [clusters.facets[0].spread; LANES],
            edge: [clusters.facets[0].edge; LANES],
            part: None,
            bend: [0.1; LANES],
        };
        let parts = Shapes { part: Some([0.25; LANES]), ..shapes };
        let (faces, incident) = (case.faces(), case.incident(clusters.extent));
        let bits = |bounds: Bounds| (bounds.on_screen.map(f32::to_bits), bounds.on_face.map(f32::to_bits));
        let all = |kernel: Kernel| {
            [false, true].map(|in_color| {
                let incident = Incident { in_color, ..incident };
                let of_faces = error_at_best(kernel, &faces, &parts, &incident);
                let of_nodes = error_at_best(kernel, &clusters.chunks[0].clusters, &shapes, &incident);
                (bits(of_faces), bits(of_nodes))
            })
        };
        let portable = all(Kernel::PORTABLE);
        for kernel in Kernel::available() {
            assert_eq!(all(kernel), portable);
        }
    }
}

proptest! {
    /// Lemma 1: no point of a triangle has a greater weighted mean square distance from the corners, and one has nearly
    /// as much.
    #[test]
    fn radii_are_of_the_smallest_balls(points in prop::array::uniform3(prop::array::uniform3(-1.0_f32..1.0)), thin in 0.0_f32..1.0) {
        let points = points.map(|p| Vec3::from(p) * Vec3::new(1.0, thin * thin, 0.3));
        let square = |weights: [f32; 3]| {
            let [ab, bc, ca] = [(0, 1), (1, 2), (2, 0)].map(|(i, j): (usize, usize)| {
                f64::from((points[i] - points[j]).length_squared()) * f64::from(weights[i] * weights[j])
            });
            ab + bc + ca
        };
        let mut most = 0.0_f64;
        for a in 0..=60_u8 {
            for b in 0..=60 - a {
                most = most.max(square([a, b, 60 - a - b].map(|share| f32::from(share) / 60.0)));
            }
        }
        let radius = f64::from(radius(points));
        prop_assert!(most <= radius * radius, "{most} of {radius}");
        prop_assert!(radius * radius <= most * 1.01 + 1e-12, "{radius}² of {most}");
    }
}
