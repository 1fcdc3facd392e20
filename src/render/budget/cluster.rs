//! Decisions on 64 neighbouring faces at once, by what none of them exceeds: most of a body is far from the highlights,
//! and not large in the light of its lamps. Only what is not known to be linear so is looked at face by face.

use glam::Vec3;

use super::eight::{NOUGHT, Vectors, dot};
use super::facet::{Facet, Strength};
use super::light::{APART, APART_ANGLE, APART_TURN, narrow};
use super::{CURVATURE, LIGHTS, LINEAR, Lit, QUARTERS, highlight, parts};
use crate::lanes::{LANES, Lanes};
use crate::light::{Beam, LampBeam};

/// Cosines and sines of f32 are off by less.
const ROUNDING: f32 = 1e-3;

/// Bounds of faces that follow each other, wherever light comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    /// See [`Facet`].
    shortening: f32,
    spread: f32,
    edge: f32,
    /// A box that all corners lie in, its middle and half of its sides.
    min: Vec3,
    max: Vec3,
    centre: Vec3,
    half: Vec3,
    cone: Cone,
    /// The surface of all of them, if it is the same.
    surface: Option<u16>,
}

/// A cone that all normals of some faces lie in: its axis, and the cosine and the sine of half its angle; the sine is 1
/// where that is a right angle or more.
#[derive(Clone, Copy, Debug)]
struct Cone {
    axis: Vec3,
    cosine: f32,
    sine: f32,
}

impl Cone {
    fn new(normals: impl Iterator<Item = Vec3> + Clone) -> Self {
        let axis = normals.clone().fold(Vec3::ZERO, |sum, normal| sum + normal).normalize_or_zero();
        let cosine = normals.map(|normal| normal.dot(axis)).fold(1.0, f32::min) - ROUNDING;
        let sine = if cosine > 0.0 { libm::sqrtf(1.0 - cosine * cosine) + ROUNDING } else { 1.0 };
        Self { axis, cosine: cosine.max(0.0), sine: sine.min(1.0) }
    }

    /// A sun that comes no nearer than that to its axis, on either side, shines on all of these faces or on none.
    fn unmixed_from(&self) -> f32 {
        if self.sine < 1.0 { self.sine } else { f32::INFINITY }
    }
}

/// The cones of 64 faces that follow each other, of four each: the even ones, and the odd ones. (The torus within 16
/// shades takes 3 % more with cones of eight faces, and 1 % more with cones of two.)
#[derive(Clone, Copy, Debug)]
pub(super) struct Cones([EightCones; EVERY]);

#[derive(Clone, Copy, Debug)]
struct EightCones {
    axes: Vectors,
    unmixed_from: Lanes<f32>,
}

/// Faces of a cone.
const FOUR: usize = 4;

/// Number of cones of eight faces.
const EVERY: usize = LANES / FOUR;

impl Cones {
    /// Makes the cones of the faces with these corners.
    pub(super) fn new(triangles: &[[u32; 3]], normals: &[Vec3]) -> Self {
        let mut cones = [EightCones { axes: [NOUGHT; 3], unmixed_from: [f32::INFINITY; LANES] }; EVERY];
        for (i, four) in triangles.chunks(FOUR).enumerate().take(EVERY * LANES) {
            let cone = Cone::new(four.iter().flatten().map(|&i| normals[i as usize]));
            let (of, lane) = (&mut cones[i % EVERY], i / EVERY);
            for (axes, axis) in of.axes.iter_mut().zip(cone.axis.to_array()) {
                axes[lane] = axis;
            }
            of.unmixed_from[lane] = cone.unmixed_from();
        }
        Self(cones)
    }

    /// A bit for each face that is one of four which see a sun from all of their corners, or from none; bits beyond the last face
    /// say nothing.
    #[inline]
    pub(super) fn unmixed(&self, towards: Vec3) -> u64 {
        let towards = towards.to_array().map(|axis| [axis; LANES]);
        let mut faces = [0; LANES];
        for (cones, bits) in self.0.iter().zip([0x0F, 0xF0]) {
            let along = dot(&cones.axes, &towards);
            for (lane, faces) in faces.iter_mut().enumerate() {
                *faces |= if along[lane].abs() > cones.unmixed_from[lane] { bits } else { 0 };
            }
        }
        u64::from_le_bytes(faces)
    }
}

/// Light on a cluster.
struct Falling {
    /// 1 at its brightest; and what its first and second derivatives along an edge are at most.
    brightness: f32,
    first: f32,
    second: f32,
    /// Turn of the direction along an edge.
    turn: f32,
    /// The greatest n·l.
    most: f32,
    /// True if all faces lie in the light or all in the dark.
    unmixed: bool,
}

/// Errors and spreads of linear shades, in shares of a light's strength: the error where all corners of a face see
/// the light or none, the error anywhere, the difference of shades over a face, and their greatest value.
#[derive(Clone, Copy)]
struct Share {
    unmixed: f32,
    off: f32,
    range: f32,
    brightest: f32,
}

/// Faces of a cluster that are known to be linear.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::render) enum Linear {
    All,
    Where(Where),
    /// Each has to be looked at.
    Unknown,
}

/// Faces of which no corner's shade is clamped, and
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::render) struct Where {
    /// whose corners all see the same lights, if that matters, and
    pub(super) unmixed: bool,
    /// at whose corners eye and mirrored light are so far apart, as a chord.
    pub(super) from: f32,
}

impl Cluster {
    /// Makes the cluster of the faces with these facets, corners and surfaces; there is at least one face.
    pub(super) fn new(
        facets: &[Facet],
        triangles: &[[u32; 3]],
        surfaces: &[u16],
        positions: &[Vec3],
        normals: &[Vec3],
    ) -> Self {
        let most = |of: fn(&Facet) -> f32| facets.iter().map(of).fold(0.0, f32::max);
        let corners = || triangles.iter().flatten().map(|&i| i as usize);
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for i in corners() {
            (min, max) = (min.min(positions[i]), max.max(positions[i]));
        }
        let surface = surfaces.first().copied().filter(|first| surfaces.iter().all(|surface| surface == first));
        Self {
            shortening: most(|facet| facet.shortening),
            spread: most(|facet| facet.spread),
            edge: most(|facet| facet.edge),
            min,
            max,
            // Half of each, as their sum might overflow.
            centre: min * 0.5 + max * 0.5,
            half: (max * 0.5 - min * 0.5) * (1.0 + ROUNDING),
            cone: Cone::new(corners().map(|i| normals[i])),
            surface,
        }
    }

    /// Finds the faces on which linear shades keep within `allowed`.
    pub(super) fn linear(&self, object: &Lit<'_>, strengths: &[Strength], (allowed, adds): (f32, bool)) -> Linear {
        let Lit { view, lights, paints, channels, .. } = *object;
        let Some(surface) = self.surface.map(usize::from) else { return Linear::Unknown };
        let (answer, strength) = (&paints[surface].answer, &strengths[surface]);
        let kd = answer.diffuse.abs() as f32 * 255.0;
        let (mut unmixed, mut off, mut range) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut brightest = [answer.ambient.abs() as f32 * 255.0; 3];
        let mut add = |light: Share, intensity: f32, of_channels: [f32; 3]| {
            let of = parts(answer, intensity, of_channels, channels);
            for (channel, of) in of.into_iter().enumerate() {
                unmixed[channel] += kd * of * light.unmixed;
                off[channel] += kd * of * light.off;
                range[channel] += kd * of * light.range;
                brightest[channel] += kd * of * light.brightest;
            }
        };
        for Beam { towards, intensity, channels } in lights.suns {
            add(self.in_light(&self.sun(*towards)), *intensity, *channels);
        }
        for lamp in lights.lamps {
            match self.lamp(lamp) {
                Some(Some(light)) => add(self.in_light(&light), lamp.intensity, lamp.channels),
                Some(None) => {}
                None => return Linear::Unknown,
            }
        }
        let greatest = |of: [f32; 3]| of.into_iter().fold(0.0, f32::max);
        let range = greatest(range).min(255.0);
        // A quarter of ρ − 1, ρ being the ratio of two corners' distances along the view.
        let nearest = view.nearest(self.min, self.max);
        if nearest <= f64::from(view.near()) {
            return Linear::Unknown;
        }
        let bend = (f64::from(self.edge) * view.scale() / nearest / 4.0) as f32;
        // What is left for highlights, of which so much may be seen, and as much bent.
        let left = |off: [f32; 3]| (allowed - LINEAR - greatest(off) - range * bend) / (1.0 + bend);
        let has_highlights = highlight(&paints[surface], channels).0 != 0.0;
        let needed = if has_highlights { QUARTERS[0] * allowed / 4.0 } else { 0.0 };
        let has_bits = lights.suns.len() + lights.lamps.len() <= LIGHTS;
        let (unmixed, left) = match (left(off), left(unmixed)) {
            (left, _) if left >= needed => (false, left),
            (_, left) if left >= needed && has_bits => (true, left),
            _ => return Linear::Unknown,
        };
        if !has_highlights {
            let is_all = adds && !unmixed && greatest(brightest) * (1.0 + ROUNDING) < 255.0;
            return if is_all { Linear::All } else { Linear::Where(Where { unmixed, from: 0.0 }) };
        }
        // As `faint_highlight`.
        let eye = self.turn_towards(narrow(lights.eye));
        let lamps = lights.lamps.iter().map(|lamp| self.turn_towards(narrow(lamp.position)));
        let lamp = lamps.fold(0.0, f32::max);
        if eye.max(lamp) >= 0.5 || self.spread >= 1.5 {
            return Linear::Unknown;
        }
        let faint = strength.faint_from.iter().zip(QUARTERS).filter(|(_, quarters)| quarters * allowed / 4.0 <= left);
        let from = faint.map(|(from, _)| *from).fold(f32::INFINITY, f32::min);
        Linear::Where(Where { unmixed, from: from + 2.0 * APART_ANGLE * self.spread + APART_TURN * (eye + lamp) })
    }

    /// Distances of a point from the box, and from what is farthest in it.
    fn distances(&self, point: Vec3) -> (f32, f32) {
        let away = (point - self.centre).abs();
        ((away - self.half).max(Vec3::ZERO).length(), (away + self.half).length())
    }

    /// Bounds the turn of the direction to a point along an edge of one of its faces.
    fn turn_towards(&self, point: Vec3) -> f32 {
        let (nearest, _) = self.distances(point);
        if nearest > 0.0 { self.edge / nearest } else { f32::INFINITY }
    }

    /// The light of a sun.
    fn sun(&self, towards: Vec3) -> Falling {
        let Cone { axis, cosine, sine } = self.cone;
        let along = axis.dot(towards).abs();
        let most = if along >= cosine {
            1.0
        } else {
            (along * cosine + libm::sqrtf((1.0 - along * along).max(0.0)) * sine + ROUNDING).min(1.0)
        };
        Falling { brightness: 1.0, first: 0.0, second: 0.0, turn: 0.0, most, unmixed: along > self.cone.unmixed_from() }
    }

    /// The light of a lamp; nothing where that is out of range, and `None` where it is too near to say.
    fn lamp(&self, lamp: &LampBeam) -> Option<Option<Falling>> {
        let position = narrow(lamp.position);
        let (nearest, farthest) = self.distances(position);
        let inner = nearest - APART * self.edge;
        if inner <= self.edge {
            return None;
        }
        let inverse_range = libm::sqrt(lamp.inverse_square) as f32;
        let near = inner * inverse_range;
        if near >= 1.0 {
            return Some(None);
        }
        // As `OneLight::lamp`.
        let e = self.edge * inverse_range;
        let far = (farthest * inverse_range).min(1.0);
        let left = 1.0 - near * near;
        // The part of the way to it that goes along the axis, from wherever in the box.
        let Cone { axis, cosine, sine } = self.cone;
        let along = axis.dot(position - self.centre).abs() - axis.abs().dot(self.half);
        Some(Some(Falling {
            brightness: left * left,
            first: 4.0 * far * left * e,
            second: (8.0 * far * far + 4.0 * left) * e * e,
            turn: self.edge / inner,
            most: 1.0,
            unmixed: along * cosine > (sine + ROUNDING) * farthest,
        }))
    }

    /// Bounds the error of linear shades of any of these faces in one light: `OneLight::body_of_lamp`, whichever face
    /// it is.
    ///
    /// On a face that lies partly in the dark, the cosines at the corners, P of the light and S of the dark, differ by
    /// no more than d, the turn of normals and light. So P ≤ d, and the error at the clamp, PS / (P + S), is no more
    /// than d/4.
    fn in_light(&self, light: &Falling) -> Share {
        let Falling { brightness, first, second, turn, most, unmixed } = *light;
        let differ = self.spread + turn;
        let lit = most * self.shortening;
        let matt = if unmixed { lit } else { lit.max(differ * self.shortening.max(0.25)) };
        let curvature =
            2.0 * self.spread * (brightness * turn + first) + brightness * turn * turn + 2.0 * first * turn + second;
        Share {
            unmixed: CURVATURE * curvature + brightness * lit,
            off: CURVATURE * curvature + brightness * matt,
            range: brightness * differ + first,
            brightest: brightness * most,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Tests what cones say of each face: its corners lie all in the light, or all in the dark.
        #[test]
        fn faces_of_cones_that_are_not_mixed_are_not(
            points in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 3..60),
            towards in prop::array::uniform3(-1.0_f32..1.0),
            wide in 0.0_f32..1.5,
        ) {
            // About one direction, or all around.
            let unit = |v: [f32; 3]| Vec3::from(v).normalize_or(Vec3::X);
            let normals: Vec<Vec3> = points.iter().map(|&p| (Vec3::Y + unit(p) * wide).normalize_or(Vec3::X)).collect();
            let count = normals.len() as u32;
            let triangles: Vec<[u32; 3]> = (0..count).map(|i| [i, (i + 1) % count, (i + 2) % count]).collect();
            let towards = unit(towards);
            let unmixed = Cones::new(&triangles, &normals).unmixed(towards);
            for (at, triangle) in triangles.iter().enumerate() {
                if unmixed >> at & 1 == 1 {
                    let [a, b, c] = triangle.map(|i| f64::from(normals[i as usize].dot(towards)));
                    prop_assert!((a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0), "{a} {b} {c}");
                }
            }
            // Far from the horizon they do say it.
            if wide < 0.1 && towards.y.abs() > 0.3 {
                // Of four that are not all there no more is said than of those that are.
                prop_assert!((0..triangles.len()).all(|at| unmixed >> at & 1 == 1));
            }
        }
    }
}
