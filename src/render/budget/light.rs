//! Bounds of the error of linear shades in the light of one source.

use glam::Vec3;

use super::{CURVATURE, Facet, curve};

/// No point of a triangle is farther from its nearest corner than this share of the longest edge, 1/√3.
pub(super) const APART: f32 = 0.578;

/// No point of a triangle is farther from the corner that has the most of it than this share of an edge: 2/3, of the
/// chord that normals turn by, and a little for their angle.
pub(super) const FROM_ONE: f32 = 0.7;

/// A unit vector along a line turns with a second derivative of at most √2 times the square of what it turns by; a sixth
/// of that, see `CURVATURE`.
const BEND: f32 = 0.236;

/// No normal between three is farther from the nearest of them than this share of the greatest angle between two, if that
/// is at most 1.5: of three that are as far from each other sin R = (2/√3)·sin(a/2).
pub(super) const APART_ANGLE: f32 = 0.61;

/// Turn of directions to a point from any corner on, in edges over the distance of the nearest vertex, if that is at
/// least two edges away: no point of the triangle is nearer by more than 1/√3 of an edge. (The corner whose normal is
/// nearest may be any.)
pub(super) const APART_TURN: f32 = 1.0 / (1.0 - 0.578 / 2.0);

/// Highlights of which not more than this is seen are not looked at any closer, in shades.
const FAINT: f32 = 0.05;

/// Place of something, seen from a vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Towards {
    /// Unit.
    pub(super) direction: Vec3,
    pub(super) distance: f32,
}

impl Towards {
    pub(super) fn new(way: Vec3) -> Self {
        let distance = way.length();
        Self { direction: way / distance, distance }
    }
}

pub(super) fn narrow([x, y, z]: [f64; 3]) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

/// Light of a lamp on a triangle.
struct Lamplight {
    /// At the corners.
    cosines: [f32; 3],
    /// At the nearest point, and what its first and second derivatives along an edge are at most.
    fall_off: f32,
    first: f32,
    second: f32,
    /// Turn of the direction to the lamp.
    turn: f32,
}

/// A triangle, on one of its sides, in the light of one source.
pub(super) struct OneLight<'a> {
    pub(super) facet: &'a Facet,
    pub(super) normals: [Vec3; 3],
    /// Direction and distance from each corner to the eye; on a matt triangle anything.
    pub(super) to_eye: [Towards; 3],
    /// In shades.
    pub(super) kd: f32,
    pub(super) ks: f32,
    pub(super) shininess: f32,
    /// The edges of the parts that the triangle is looked at in, in edges of its own: 1 for the whole.
    pub(super) part: f32,
    /// True if light is meant as it goes on below the horizon, less than none.
    pub(super) below: bool,
}

impl OneLight<'_> {
    /// Bounds the error in the light of a sun of intensity 1, its highlight aside.
    pub(super) fn body_of_sun(&self, towards: Vec3) -> f32 {
        let (most, least) = ends(self.normals.map(|normal| normal.dot(towards)));
        // Below the horizon nothing of the face sees it: N·l is linear.
        if most <= 0.0 && !self.below { 0.0 } else { self.kd * self.matt(most, least) }
    }

    /// A sun's highlight. A bound that is not more than `limit` is not refined.
    pub(super) fn highlight_of_sun(&self, towards: Vec3, intensity: f32, limit: f32) -> f32 {
        let cosines = self.normals.map(|normal| normal.dot(towards));
        if ends(cosines).0 <= 0.0 {
            return 0.0;
        }
        intensity * self.highlight([towards; 3], cosines, 0.0, limit / intensity)
    }

    /// Bounds the loss in light from one direction, of cosines up to these: as normals are not made unit, and at the
    /// clamp.
    fn matt(&self, most: f32, least: f32) -> f32 {
        let (unit, clamp) = if self.below {
            (most.abs().max(least.abs()) * self.facet.shortening, 0.0)
        } else {
            (most.max(0.0) * self.facet.shortening, clamp_error(most, least))
        };
        if self.part == 1.0 {
            // One makes linear shades too dark, the other too bright.
            return unit.max(clamp);
        }
        // What a part's normals turn by, made unit.
        let turn = self.part * self.facet.spread * (1.0 + self.facet.shortening);
        unit.min(BEND * turn * turn) + clamp.min(turn / 4.0)
    }

    /// Bounds the error in the light of a lamp of intensity 1, its highlight aside.
    pub(super) fn body_of_lamp(&self, to_lamp: [Towards; 3], inverse_range: f32) -> f32 {
        let Some(lamp) = self.lamp(to_lamp, inverse_range) else { return 0.0 };
        let Lamplight { cosines, fall_off, first, second, turn } = lamp;
        let spread = self.part * self.facet.spread;
        // N · L of two sums of vectors, N of the normals, and L of the lamp's directions, as bright as it is: twice the
        // product of what they turn by, and L's own curvature. N is then made unit.
        let curvature = 2.0 * spread * (fall_off * turn + first) + fall_off * turn * turn + 2.0 * first * turn + second;
        let (most, least) = ends(cosines);
        self.kd * (CURVATURE * curvature + fall_off * self.matt(most, least))
    }

    /// A lamp's highlight. A bound that is not more than `limit` is not refined.
    pub(super) fn highlight_of_lamp(
        &self,
        to_lamp: [Towards; 3],
        inverse_range: f32,
        intensity: f32,
        limit: f32,
    ) -> f32 {
        let Some(lamp) = self.lamp(to_lamp, inverse_range) else { return 0.0 };
        let Lamplight { cosines, fall_off, first, second, turn } = lamp;
        // The highlight's own curvature, and the fall-off's on it.
        let slope = libm::sqrtf(self.shininess) * (2.0 * self.part * self.facet.spread + turn);
        let fading = self.ks * CURVATURE * (2.0 * first * slope + second);
        let towards = to_lamp.map(|lamp| lamp.direction);
        intensity * (fading + fall_off * self.highlight(towards, cosines, turn, limit / intensity))
    }

    /// Light of a lamp that reaches the triangle; nothing where the lamp is out of range.
    fn lamp(&self, to_lamp: [Towards; 3], inverse_range: f32) -> Option<Lamplight> {
        let edge = self.facet.edge;
        let (farthest, nearest) = ends(to_lamp.map(|lamp| lamp.distance));
        let nearest = nearest - APART * edge;
        let near = nearest.max(0.0) * inverse_range;
        if near >= 1.0 {
            return None;
        }
        let turn = self.part * if edge < nearest { edge / nearest } else { 4.0 };
        let cosines = [0, 1, 2].map(|i| self.normals[i].dot(to_lamp[i].direction));
        // The fall-off (1 − u)², u = d² / R², and its derivatives along an edge: |u'| ≤ 2√u·e, u'' = 2e², e being the
        // edge in units of the range.
        let e = self.part * edge * inverse_range;
        let far = (farthest * inverse_range).min(1.0);
        let left = 1.0 - near * near;
        Some(Lamplight {
            cosines,
            fall_off: left * left,
            first: 4.0 * far * left * e,
            second: (8.0 * far * far + 4.0 * left) * e * e,
            turn,
        })
    }

    /// Bounds the error of linear highlights: by their curvature, or by no more than the brightest. A bound that is not
    /// more than `limit` is not refined.
    fn highlight(&self, towards: [Vec3; 3], cosines: [f32; 3], light_turn: f32, limit: f32) -> f32 {
        let (most, least) = ends(cosines);
        let (_, nearest) = ends(self.to_eye.map(|eye| eye.distance));
        let eye_turn = self.part * self.facet.edge / (nearest - APART * self.facet.edge).max(0.0);
        let turn = 2.0 * self.part * self.facet.spread + light_turn + eye_turn;
        // Where the light comes over the horizon the highlight begins at once.
        let curved =
            if most > 0.0 && least <= 0.0 { f32::INFINITY } else { CURVATURE * curve(self.shininess) * turn * turn };
        if self.ks * curved <= FAINT {
            return FAINT;
        }
        // As bright as at no point: at the corners, and what it turns by from there.
        let (whole, light_turn) = (turn / self.part, light_turn / self.part);
        let along = (0..3).map(|i| {
            let eye = self.to_eye[i].direction;
            2.0 * cosines[i] * self.normals[i].dot(eye) - towards[i].dot(eye)
        });
        // cos(μ − t) ≤ cos μ + t·sin μ, and t²/2 more where cos μ is below 0.
        let (along, turn) = (along.fold(-1.0, f32::max).min(1.0), FROM_ONE * whole);
        let more = if along < 0.0 { 0.5 * turn * turn } else { 0.0 };
        let along = (along + turn * libm::sqrtf(1.0 - along * along) + more).clamp(0.0, 1.0);
        let bright = brightest(along, self.shininess);
        let least = curved.min(bright);
        if self.ks * least <= limit {
            return self.ks * least;
        }
        let eye_turn = eye_turn / self.part;
        self.ks * least.min(brightest(self.along(towards, light_turn + eye_turn), self.shininess))
    }

    /// The greatest r·v of any point: with the half-way vector h between the directions to light and eye, and θ
    /// the angle between these, r·v = 2(n·l)(n·v) − l·v ≤ 1 − 2cos²(θ/2)·(1 − (n·h)²), the product being no more than
    /// the square of the mean. `turn` is what the two directions turn by over the triangle.
    fn along(&self, towards: [Vec3; 3], turn: f32) -> f32 {
        let sum = towards[0] + self.to_eye[0].direction;
        let long = sum.length();
        if long < 0.01 {
            return 1.0;
        }
        let (half_way, apart) = (sum / long, turn / long);
        let nearest = nearest_normal(&self.normals, half_way).clamp(0.0, 1.0);
        // Turned towards it by what it may turn itself: cos(μ − a) ≤ cos μ + a·sin μ.
        let nearest = (nearest + apart * libm::sqrtf(1.0 - nearest * nearest)).min(1.0);
        let square = (long * long / 4.0 - turn / 2.0).max(0.0);
        (1.0 - 2.0 * square * (1.0 - nearest * nearest)).max(0.0)
    }
}

/// No less than xˢ: that is at most exp(−y), y = s(1 − x), which is less than one over the first terms of exp y.
fn brightest(x: f32, shininess: f32) -> f32 {
    let y = shininess * (1.0 - x);
    if x <= 0.0 { 0.0 } else { 1.0 / (1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y / 120.0))))) }
}

/// The greatest n·h of any unit n between three normals.
fn nearest_normal([a, b, c]: &[Vec3; 3], h: Vec3) -> f32 {
    let sides = [a.cross(*b).dot(h), b.cross(*c).dot(h), c.cross(*a).dot(h)];
    if sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0) {
        // It lies among them, or opposite.
        return if (*a + *b + *c).dot(h) > 0.0 { 1.0 } else { 0.0 };
    }
    // On an arc the nearest is an end, or the projection on the arc's plane, if that lies between the ends.
    let on_arc = |a: &Vec3, b: &Vec3| {
        let (to_a, to_b, cosine) = (a.dot(h), b.dot(h), a.dot(*b));
        let between = to_a > cosine * to_b && to_b > cosine * to_a && cosine < 0.999_999;
        if between {
            let square = (to_a * to_a + to_b * to_b - 2.0 * to_a * to_b * cosine) / (1.0 - cosine * cosine);
            libm::sqrtf(square.clamp(0.0, 1.0))
        } else {
            to_a.max(to_b)
        }
    };
    on_arc(a, b).max(on_arc(b, c)).max(on_arc(c, a))
}

/// The greatest and the least.
fn ends([a, b, c]: [f32; 3]) -> (f32, f32) {
    (a.max(b).max(c), a.min(b).min(c))
}

/// Bounds the distance between Σ λᵢ max(0, cᵢ) and max(0, Σ λᵢ cᵢ).
pub(super) fn clamp_error(most: f32, least: f32) -> f32 {
    if most > 0.0 && least < 0.0 { most * least / (least - most) } else { 0.0 }
}
