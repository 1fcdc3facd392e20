//! The error budget: for each triangle the cheapest rung that is known to keep within it.
//!
//! What the light at a point of a triangle should be, and what a rung makes of it, differ for three reasons, each of
//! which is bounded here from normals, lights and vertices, without lighting anything but the vertices:
//!
//! - **The model.** A linear shade is that of the sum N = Σ λᵢnᵢ of the vertices' normals; light at the point takes N
//!   made unit. For a light in a fixed direction l that makes N·l / |N| out of N·l: more by (1/|N| − 1) of it, where
//!   |N| is least at the point of the flat triangle n₁n₂n₃ that is nearest to the centre of the sphere.
//! - **The clamp.** Of a light that reaches some vertices and others not, linear shades are those of Σ λᵢ max(0, nᵢ·l),
//!   and should be max(0, Σ λᵢ nᵢ·l). With P the most that a vertex lies in the light and S the most that
//!   one lies in the dark, these are no farther apart than PS / (P + S).
//! - **Curvature.** A function whose second derivative along any line is at most M is farther from the linear one
//!   through the corners of a triangle, whose longest edge is L, by no more than ML²/6: ½M times the square of the
//!   greatest distance to the nearest corner, L/√3. That bounds lamps, whose directions turn and whose light falls off,
//!   and highlights, cosˢμ, whose second derivative by the angle is at most s. A highlight's direction turns
//!   by twice the normals' spread and by what light and eye turn. Angles are taken for their chords; up to 0.3 that
//!   is off by 1 %, and a fifth is added.
//! - **The screen.** What is linear on the screen and not on the face moves shades along by a share of at most
//!   (√ρ − 1) / (√ρ + 1) ≤ (ρ − 1) / 4 of their range, ρ being the ratio of the corners' distances.
//!
//! The bounds of the parts are added. Decisions are kept as long as the vertices are.

use alloc::vec::Vec;

use glam::Vec3;

use super::face::Faces;
use super::paint::Paint;
use super::vertex::Geometry;
use crate::light::{Beam, LampBeam, Lights};
use crate::mesh::Mesh;
use crate::raster::Vertex;
use crate::scene::{Rung, Shared};

/// What rounding adds to a linear shade that starts anew every 64 pixels: a half, and a quarter of drift.
const LINEAR: f32 = 0.75;

/// What rounding adds to a shade that is exact before it: a half, and what f32 may be off.
const EXACT: f32 = 0.51;

/// Curvature is taken a fifth too great, for angles that are taken for their chords.
const CURVATURE: f32 = 1.2 / 6.0;

/// What is decided for a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum Choice {
    /// Nobody has asked yet.
    #[default]
    Unknown,
    Flat,
    Linear,
    Float,
    Phong,
}

impl Choice {
    pub(super) const fn rung(self) -> Rung {
        match self {
            Self::Flat => Rung::Flat,
            Self::Float => Rung::Float,
            Self::Phong => Rung::Phong,
            Self::Linear | Self::Unknown => Rung::Gouraud88Reseeded,
        }
    }
}

/// What a triangle's normals and edges say, whatever the light.
#[derive(Clone, Copy, Debug)]
struct Facet {
    /// 1/|N| − 1 where |N| is least.
    shortening: f32,
    /// The greatest angle between two normals.
    spread: f32,
    /// The longest edge.
    edge: f32,
}

impl Facet {
    fn new(positions: [Vec3; 3], normals: [Vec3; 3]) -> Self {
        let squares = |of: [Vec3; 3]| [(of[0] - of[1]), (of[1] - of[2]), (of[2] - of[0])].map(Vec3::length_squared);
        let greatest = |squares: [f32; 3]| squares.into_iter().fold(0.0, f32::max);
        let chords = squares(normals);
        let chord = greatest(chords);
        let [a, b, c] = chords;
        // The nearest point lies on the longest edge, or, of an acute triangle, at the centre of its circumcircle,
        // of radius R: R² = a²b²c² / 16K², by the squares of the sides.
        let others = a + b + c - chord;
        let square = if others <= chord {
            chord / 4.0
        } else {
            a * b * c / (2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c))
        };
        Self {
            shortening: if square < 1.0 { 1.0 / libm::sqrtf(1.0 - square) - 1.0 } else { f32::INFINITY },
            spread: 2.0 * libm::asinf((libm::sqrtf(chord) / 2.0).min(1.0)),
            edge: libm::sqrtf(greatest(squares(positions))),
        }
    }
}

/// What the light on a material comes to at most.
#[derive(Clone, Copy, Debug)]
struct Strength {
    /// The shade of the ramp's first entry, in 1/256 of an entry.
    first: u16,
    /// Shades in 1/256 of an entry.
    scale: f32,
    /// The ramp's last shade.
    last: u16,
    /// What all highlights together curve by, in shades for an angle of 1; 0 without any.
    curvature: f32,
}

/// What is kept for an object's decisions.
#[derive(Debug, Default)]
pub(super) struct Budget {
    /// Whose facets these are; of a mesh that was split, none.
    mesh: Option<Shared<Mesh>>,
    facets: Vec<Facet>,
    /// For each vertex a bit for each sun that it sees; the last for all from the 32nd on.
    suns_seen: Vec<u32>,
    /// One for each surface.
    strengths: Vec<Strength>,
    allowed: f32,
    /// Whether there are suns alone, and no highlight.
    simple: bool,
    /// What an edge of 1 turns the direction to the eye by, at most.
    eye_turn: f32,
}

impl Budget {
    /// Takes on an object whose vertices are made anew. `whole` is its mesh, if that is what is drawn.
    #[inline(never)]
    pub(super) fn renew(
        &mut self,
        allowed: f32,
        geometry: &Geometry<'_>,
        whole: Option<&Shared<Mesh>>,
        lights: &Lights<'_>,
        paints: &[Paint],
        channels: bool,
    ) {
        self.allowed = allowed;
        let known = matches!((&self.mesh, whole), (Some(known), Some(whole)) if Shared::ptr_eq(known, whole));
        if !known {
            self.mesh = whole.map(Shared::clone);
            self.facets.clear();
            let corners = |of: &[Vec3], indices: [u32; 3]| indices.map(|i| of[i as usize]);
            let facet = |&i: &[u32; 3]| Facet::new(corners(geometry.positions, i), corners(geometry.normals, i));
            self.facets.extend(geometry.triangles.iter().map(facet));
        }
        self.suns_seen.clear();
        self.suns_seen.resize(geometry.normals.len(), 0);
        for (i, sun) in lights.suns.iter().enumerate() {
            for (seen, normal) in self.suns_seen.iter_mut().zip(geometry.normals) {
                *seen |= u32::from(normal.dot(sun.towards) > 0.0) << i.min(31);
            }
        }
        self.strengths.clear();
        self.strengths.extend(paints.iter().map(|paint| {
            // A ramp has at most 256 entries.
            let entries = paint.ramp.entries() as u16;
            let first = u16::from(paint.ramp.first()) << 8;
            let scale = if entries > 1 { 255.0 / (256.0 * f32::from(entries - 1)) } else { 0.0 };
            let suns = lights.suns.iter().map(|sun| brightest(sun.intensity, sun.channels, channels));
            let lamps = lights.lamps.iter().map(|lamp| brightest(lamp.intensity, lamp.channels, channels));
            let all: f32 = suns.chain(lamps).sum();
            let (ks, s) = highlight(paint, channels);
            let curvature = if ks == 0.0 { 0.0 } else { CURVATURE * curve(s) * ks * all };
            Strength { first, scale, last: first + ((entries - 1) << 8), curvature }
        }));
        self.simple = lights.lamps.is_empty() && !channels && self.strengths.iter().all(|of| of.curvature == 0.0);
        self.eye_turn = 0.0;
        if self.simple {
            return;
        }
        // The eye is at least this far away.
        let eye = Vec3::new(lights.eye[0] as f32, lights.eye[1] as f32, lights.eye[2] as f32);
        let nearest = geometry.positions.iter().map(|p| (*p - eye).length_squared()).fold(f32::INFINITY, f32::min);
        self.eye_turn = 1.0 / libm::sqrtf(nearest);
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.facets.capacity() * size_of::<Facet>()
            + self.suns_seen.capacity() * 4
            + self.strengths.capacity() * size_of::<Strength>()
    }
}

/// The greatest second derivative of cosˢ by its angle. Below s = 1 there is none: it is steep where it ends.
fn curve(shininess: f32) -> f32 {
    if shininess >= 1.0 { shininess } else { f32::INFINITY }
}

/// A light's greatest channel, or its one.
fn brightest(intensity: f32, channels: [f32; 3], in_color: bool) -> f32 {
    if in_color { channels.into_iter().fold(0.0, |most, c| most.max(c.abs())) } else { intensity.abs() }
}

/// The highlight's strength in shades, and its exponent.
fn highlight(paint: &Paint, in_color: bool) -> (f32, f32) {
    let color = if in_color { paint.answer.highlight.into_iter().fold(0.0, f64::max) } else { 1.0 };
    ((paint.answer.specular * color).abs() as f32 * 255.0, paint.answer.shininess as f32)
}

/// A triangle that is to be decided on.
pub(super) struct Question {
    /// Its place.
    pub(super) triangle: usize,
    pub(super) indices: [u32; 3],
    pub(super) surface: u16,
    pub(super) turned: bool,
    /// The corners' shades, or, of the channels, the three of each.
    pub(super) shades: [[u16; 3]; 3],
    /// The corners' depths; 0 if one has none.
    pub(super) depths: [u32; 3],
}

impl Budget {
    /// The cheapest rung of a face that suns light, all that it sees from each of its corners, and whose shades are
    /// not clamped, where that is known at once. The corners are given on the side that is seen.
    #[inline(always)]
    pub(super) fn decide_at_once(
        &self,
        triangle: usize,
        indices: [u32; 3],
        surface: u16,
        vertices: &[Vertex; 3],
    ) -> Choice {
        let [a, b, c] = indices.map(|i| self.suns_seen[i as usize]);
        if !self.simple || a != b || b != c {
            return Choice::Unknown;
        }
        let strength = &self.strengths[usize::from(surface)];
        let [a, b, c] = vertices.map(|vertex| vertex.shade().to_bits());
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        if most >= strength.last {
            return Choice::Unknown;
        }
        let range = f32::from(most - least) * strength.scale;
        // A corner's shade lies in its ramp.
        let model = f32::from(most - strength.first) * strength.scale * self.facets[triangle].shortening;
        let left = self.allowed - model;
        if range / 2.0 + EXACT <= left {
            return Choice::Flat;
        }
        let [a, b, c] = vertices.map(|vertex| vertex.depth());
        let (far, near) = (a.min(b).min(c), a.max(b).max(c));
        // Below 2³²; rounded, which is nothing to a bound that is rounded up in every step.
        if (near - far) as f32 * range <= 4.0 * far as f32 * (left - LINEAR) { Choice::Linear } else { Choice::Unknown }
    }
}

impl Faces<'_> {
    /// The cheapest rung that keeps within the budget.
    pub(super) fn cheapest_within(&self, budget: &Budget, question: &Question) -> Choice {
        let facet = &budget.facets[question.triangle];
        let strength = &budget.strengths[usize::from(question.surface)];
        let [a, b, c] = question.shades;
        let channels = if self.channels { 3 } else { 1 };
        let (mut range, mut top, mut clamped) = (0, 0, false);
        for channel in 0..channels {
            let least = a[channel].min(b[channel]).min(c[channel]);
            let most = a[channel].max(b[channel]).max(c[channel]);
            range = range.max(most - least);
            top = top.max(most - strength.first);
            clamped |= most >= strength.last && least < strength.last;
        }
        let (range, top) = (f32::from(range) * strength.scale, f32::from(top) * strength.scale);

        // For suns alone, all of them above the horizon or all below.
        let turned = 2.0 * facet.spread + facet.edge * budget.eye_turn;
        let mut model = top * facet.shortening + strength.curvature * turned * turned;
        let seen = question.indices.map(|i| budget.suns_seen[i as usize]);
        let some = (seen[0] | seen[1] | seen[2]) & !(seen[0] & seen[1] & seen[2]) != 0;
        let lamps = !self.lights.lamps.is_empty();
        let near = model + EXACT <= budget.allowed;
        let hopeless = top * facet.shortening > 2.0 * budget.allowed;
        if lamps || ((some || clamped) && near) || (strength.curvature > 0.0 && !near && !hopeless) {
            model = self.model_error(budget, question);
            if clamped {
                // What lies above the clamp is lost at some corners, by which the others are too dark at most.
                model += range;
            }
        }
        let bound = budget.allowed;
        if model + range / 2.0 + EXACT <= bound {
            return Choice::Flat;
        }
        // Depth is in proportion to 1 / w.
        let [a, b, c] = question.depths;
        let (far, near) = (a.min(b).min(c), a.max(b).max(c));
        let bend = (near - far) as f32 * range;
        // A corner behind the near plane has no depth.
        if far > 0 && bend <= 4.0 * far as f32 * (bound - model - LINEAR) {
            Choice::Linear
        } else if model + EXACT <= bound {
            Choice::Float
        } else if self.lights_pixels {
            Choice::Phong
        } else {
            Choice::Float
        }
    }

    /// How far linear shades are from the model, in shades.
    #[inline(never)]
    fn model_error(&self, budget: &Budget, question: &Question) -> f32 {
        let facet = &budget.facets[question.triangle];
        let paint = &self.paints[usize::from(question.surface)];
        let side = if question.turned { -1.0 } else { 1.0 };
        let corners = question.indices.map(|i| {
            let position = self.geometry.positions[i as usize];
            let [x, y, z] = self.lights.eye;
            let to_eye = Vec3::new(x as f32, y as f32, z as f32) - position;
            let distance = to_eye.length();
            PointOfView {
                position,
                normal: self.geometry.normals[i as usize] * side,
                to_eye: to_eye / distance,
                distance,
            }
        });
        let color = if self.channels { paint.answer.color.into_iter().fold(0.0, f64::max) } else { 1.0 };
        let kd = (paint.answer.diffuse * color).abs() as f32 * 255.0;
        let (ks, shininess) = highlight(paint, self.channels);
        let light = OneLight { facet, corners: &corners, kd, ks, shininess };
        let suns =
            self.lights.suns.iter().map(|sun| light.sun(sun, brightest(sun.intensity, sun.channels, self.channels)));
        let lamps = self
            .lights
            .lamps
            .iter()
            .map(|lamp| light.lamp(lamp, brightest(lamp.intensity, lamp.channels, self.channels)));
        suns.chain(lamps).sum()
    }
}

/// A corner, and the direction to the eye.
struct PointOfView {
    position: Vec3,
    normal: Vec3,
    to_eye: Vec3,
    distance: f32,
}

/// A triangle in the light of one source.
struct OneLight<'a> {
    facet: &'a Facet,
    corners: &'a [PointOfView; 3],
    kd: f32,
    ks: f32,
    shininess: f32,
}

impl OneLight<'_> {
    fn sun(&self, sun: &Beam, intensity: f32) -> f32 {
        let cosines = [0, 1, 2].map(|i| self.corners[i].normal.dot(sun.towards));
        let (most, least) = ends(cosines);
        if most <= 0.0 {
            // N·l is linear: nothing of the face sees it.
            return 0.0;
        }
        let body = most * self.facet.shortening + clamp_error(most, least);
        intensity * (self.kd * body + self.highlight([sun.towards; 3], cosines, 0.0))
    }

    fn lamp(&self, lamp: &LampBeam, intensity: f32) -> f32 {
        let edge = self.facet.edge;
        let at = Vec3::new(lamp.position[0] as f32, lamp.position[1] as f32, lamp.position[2] as f32);
        let to_lamp = [0, 1, 2].map(|i| at - self.corners[i].position);
        let distances = to_lamp.map(Vec3::length);
        let (farthest, nearest) = ends(distances);
        // No point is farther from its nearest corner.
        let nearest = nearest - 0.58 * edge;
        let inverse_square = lamp.inverse_square as f32;
        let part = nearest.max(0.0) * nearest.max(0.0) * inverse_square;
        if part >= 1.0 {
            return 0.0;
        }
        let turn = if edge < nearest { edge / nearest } else { 4.0 };
        let towards = [0, 1, 2].map(|i| to_lamp[i] / distances[i]);
        let cosines = [0, 1, 2].map(|i| self.corners[i].normal.dot(towards[i]));
        // The fall-off (1 − u)², u = d² / R², and its derivatives along an edge: |u'| ≤ 2√u·e, u'' = 2e², e being the
        // edge in units of the range.
        let e = edge * libm::sqrtf(inverse_square);
        let u = (farthest * farthest * inverse_square).min(1.0);
        let left = 1.0 - part;
        let (fall_off, first, second) = (left * left, 4.0 * libm::sqrtf(u) * left * e, (8.0 * u + 4.0 * left) * e * e);
        let angle = self.facet.spread + turn;
        let curvature = fall_off * angle * angle + 2.0 * first * angle + second;
        let (most, least) = ends(cosines);
        let body = CURVATURE * curvature + fall_off * clamp_error(most, least);
        // The highlight's own curvature, and the fall-off's on it.
        let highlight = fall_off * self.highlight(towards, cosines, turn);
        let fading = if self.ks > 0.0 {
            let slope = libm::sqrtf(self.shininess) * (2.0 * self.facet.spread + turn);
            self.ks * CURVATURE * (2.0 * first * slope + second)
        } else {
            0.0
        };
        intensity * (self.kd * body + highlight + fading)
    }

    /// How far linear highlights are off: by their curvature, or by no more than the brightest.
    fn highlight(&self, towards: [Vec3; 3], cosines: [f32; 3], light_turn: f32) -> f32 {
        if self.ks == 0.0 {
            return 0.0;
        }
        let (most, least) = ends(cosines);
        let nearest = self.corners.iter().map(|corner| corner.distance).fold(f32::INFINITY, f32::min);
        let turn = 2.0 * self.facet.spread + light_turn + self.facet.edge / (nearest - 0.58 * self.facet.edge).max(0.0);
        // Where the light comes over the horizon the highlight begins at once.
        let curved =
            if most > 0.0 && least <= 0.0 { f32::INFINITY } else { CURVATURE * curve(self.shininess) * turn * turn };
        let along = [0, 1, 2].map(|i| {
            let PointOfView { normal, to_eye, .. } = self.corners[i];
            2.0 * cosines[i] * normal.dot(to_eye) - towards[i].dot(to_eye)
        });
        let (along, _) = ends(along);
        // No point's direction is farther from that of its nearest corner than this.
        let apart = 0.58 * turn;
        let brightest = if apart < 1.5 && along < libm::cosf(apart) {
            let along = along.max(-1.0);
            along * libm::cosf(apart) + libm::sqrtf(1.0 - along * along) * libm::sinf(apart)
        } else {
            1.0
        };
        let peak = if brightest > 0.0 { libm::powf(brightest, self.shininess) } else { 0.0 };
        self.ks * curved.min(peak)
    }
}

/// The greatest and the least.
fn ends([a, b, c]: [f32; 3]) -> (f32, f32) {
    (a.max(b).max(c), a.min(b).min(c))
}

/// How far Σ λᵢ max(0, cᵢ) and max(0, Σ λᵢ cᵢ) are apart at most.
fn clamp_error(most: f32, least: f32) -> f32 {
    if most > 0.0 && least < 0.0 { most * least / (least - most) } else { 0.0 }
}
