//! The decision on one triangle.

use glam::Vec3;

use super::WORTH_SAMPLES;
use super::decided::{Bodies, Choice};
use super::light::{OneLight, Towards, narrow};
use super::{Budget, EXACT, LINEAR, brightest, highlight, parts};
use crate::lanes::LANES;
use crate::raster::Vertex;
use crate::raster::clip::doubled_area;
use crate::raster::effects::SampleSpacing;
use crate::render::faces::Faces;
use crate::render::lit::ShadedVertices;
use crate::span::Kernel;

/// The widest row of a triangle that it pays to light some pixels of, in pixels: as eight are lit at a time.
const WORTH_KNOTS: f32 = 16.0;

/// Points of a triangle that divide each edge in four, by their weights; the corners first, then the middles of the edges, and
/// at the end one once more.
const SAMPLES: [[f32; 3]; 16] = {
    let mut points = [[1.0, 0.0, 0.0]; 16];
    points[1] = [0.0, 1.0, 0.0];
    points[2] = [0.0, 0.0, 1.0];
    points[3] = [0.0, 0.5, 0.5];
    points[4] = [0.5, 0.0, 0.5];
    points[5] = [0.5, 0.5, 0.0];
    let (mut at, mut a) = (6, 0);
    while a < 4 {
        let mut b = 0;
        while a + b <= 4 {
            let c = 4 - a - b;
            let is_corner = b == 4 || c == 4;
            let is_middle = a % 2 == 0 && b % 2 == 0 && c % 2 == 0;
            if !is_corner && !is_middle {
                points[at] = [a as f32 / 4.0, b as f32 / 4.0, c as f32 / 4.0];
                at += 1;
            }
            b += 1;
        }
        a += 1;
    }
    points
};

/// A triangle that is to be decided on.
pub(in crate::render) struct Question<'a> {
    /// Its place.
    pub(in crate::render) triangle: usize,
    pub(in crate::render) indices: [u32; 3],
    pub(in crate::render) surface: u16,
    pub(in crate::render) turned: bool,
    /// The corners' shades, or, of the channels, the three of each.
    pub(in crate::render) shades: [[u16; 3]; 3],
    /// Place on the screen; `None` if it is clipped.
    pub(in crate::render) vertices: Option<&'a [Vertex; 3]>,
}

impl Budget {
    /// The cheapest shading of a face that suns light, all that it sees from each of its corners, and whose shades are
    /// not clamped, where that is known at once. The corners are given on the side that is seen.
    #[inline(always)]
    pub(in crate::render) fn decide_at_once(
        &self,
        (triangle, indices, surface, turned): (usize, [u32; 3], u16, bool),
        lit: &ShadedVertices,
        normals: &[Vec3],
    ) -> Choice {
        if !self.simple {
            return Choice::Unknown;
        }
        let strength = &self.strengths[usize::from(surface)];
        let corners = indices.map(|i| i as usize);
        let shades = corners.map(|i| lit.shades[i]);
        let [a, b, c] = indices.map(|i| self.lights_seen(lit, i));
        let mixed = a != b || b != c;
        let [a, b, c] = shades.map(|sides| sides[usize::from(turned)].to_bits());
        let most = a.max(b).max(c);
        let least = a.min(b).min(c);
        if most >= strength.last || (!self.adds && least <= strength.first) {
            return Choice::Unknown;
        }
        if self.linear_unless_mixed && !mixed {
            return Choice::Linear;
        }
        let facet = &self.facets[triangle];
        let clamp = match self.suns.as_slice() {
            _ if !mixed => 0.0,
            [sun] if self.adds => {
                // P is what the brightest corner has of it, S what the darkest lacks.
                let lit = f32::from(most.saturating_sub(strength.dark)) * strength.scale;
                let [a, b, c] = corners.map(|i| normals[i].dot(sun.towards));
                let lacks = if turned { a.max(b).max(c) } else { -a.min(b).min(c) };
                let dark = strength.body * lacks.max(0.0);
                if lit > 0.0 { lit * dark / (lit + dark) } else { 0.0 }
            }
            // n·l differs by no more than the normals do, which is P + S at most; and PS / (P + S) ≤ (P + S) / 4.
            _ => strength.body * facet.spread / 4.0,
        };
        // A corner's shade lies in its ramp.
        let short = strength.top(most, self.adds) * facet.shortening;
        let model = if self.adds { clamp.max(short) } else { clamp + short };
        if least == most {
            return if model + EXACT <= self.allowed { Choice::Flat } else { Choice::Unknown };
        }
        let range = f32::from(most - least) * strength.scale;
        if model + range * self.bend + LINEAR <= self.allowed { Choice::Linear } else { Choice::Unknown }
    }
}

impl Question<'_> {
    /// The least and the greatest depth, which is in proportion to 1 / w; 0 if a corner has none.
    pub(super) fn depths(&self) -> (u32, u32) {
        let [a, b, c] = self.vertices.map_or([0; 3], |vertices| vertices.each_ref().map(Vertex::depth));
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// Its area on the screen.
    pub(super) fn pixels(&self) -> f32 {
        // In 1/256 pixel, and twice.
        self.vertices.map_or(f32::MAX, |vertices| doubled_area(vertices).unsigned_abs() as f32 / 131_072.0)
    }

    /// The widest of its rows, in pixels; 0 where it is nowhere.
    fn width(&self) -> f32 {
        let Some(vertices) = self.vertices else { return 0.0 };
        let [a, b, c] = vertices.each_ref().map(|vertex| vertex.y().to_bits());
        let height = a.max(b).max(c) - a.min(b).min(c);
        if height == 0 { 0.0 } else { 512.0 * self.pixels() / height as f32 }
    }
}

impl Faces<'_> {
    /// The cheapest shading that keeps within the budget.
    pub(in crate::render) fn cheapest_within(
        &self,
        budget: &Budget,
        question: &Question<'_>,
        known: &mut Bodies,
    ) -> Choice {
        let facet = &budget.facets[question.triangle];
        let strength = &budget.strengths[usize::from(question.surface)];
        let [a, b, c] = question.shades;
        let channels = if self.channels { 3 } else { 1 };
        let (mut range, mut brightest, mut clamped) = (0, strength.first, false);
        for channel in 0..channels {
            let least = a[channel].min(b[channel]).min(c[channel]);
            let most = a[channel].max(b[channel]).max(c[channel]);
            range = range.max(most - least);
            brightest = brightest.max(most);
            clamped |= strength.cuts(least, most, budget.adds);
        }
        let (range, top) = (f32::from(range) * strength.scale, strength.top(brightest, budget.adds));

        // For suns alone, all of them above the horizon or all below.
        let turned = 2.0 * facet.spread + facet.edge * budget.eye_turn;
        let mut model = top * facet.shortening + strength.curvature * turned * turned;
        let spare = budget.allowed - EXACT;
        // What the body alone is off by, at least as it is known, whatever the light.
        let hopeless = (top - strength.highlights) * facet.shortening > spare;
        let seen = question.indices.map(|i| budget.lights_seen(self.lit, i));
        let some = budget.many_suns || (seen[0] | seen[1] | seen[2]) & !(seen[0] & seen[1] & seen[2]) != 0;
        let lamps = !self.lights.lamps.is_empty();
        let near = model <= spare;
        let highlights = strength.curvature > 0.0;
        let faint = if highlights { budget.faint_highlight(question.indices, facet, strength) } else { None };
        if let Some(faint) = faint
            && !lamps
            && !some
            && !clamped
        {
            model = model.min(top * facet.shortening + faint);
        }
        let near = near || model <= spare;
        if !hopeless && (lamps || ((some || clamped) && near) || (highlights && !near)) {
            let body = &mut known[usize::from(question.turned)];
            if body.is_nan() {
                *body = self.body_error(budget, question, &self.one_light(budget, question, 1.0), spare);
            }
            let known = *body;
            // What lies above the clamp is lost at some corners, by which the others are too dark at most.
            let lost = if clamped { range } else { 0.0 };
            model = match faint {
                Some(faint) if known + faint + lost <= spare => known + faint + lost,
                _ if known + lost > spare => known + lost,
                _ => self.model_error(budget, question, 1.0, spare, Some(known)) + lost,
            };
            if model > spare && question.pixels() >= WORTH_SAMPLES as f32 {
                model = self.error_between_samples(budget, question, spare);
            }
        }
        let bound = budget.allowed;
        // Depth is in proportion to 1 / w.
        let (far, near) = question.depths();
        let bend = (near - far) as f32 * range;
        // A corner behind the near plane has no depth.
        let linear = far > 0 && bend <= 4.0 * far as f32 * (bound - model - LINEAR);
        // Linear shades cost no more than one shade where they differ at all: the same spans, by the same loop.
        if model + range / 2.0 + EXACT <= bound && (range == 0.0 || !linear) {
            Choice::Flat
        } else if linear {
            Choice::Linear
        } else if model + EXACT <= bound || !self.lights_pixels {
            Choice::Float
        } else if self.is_quadratic(budget, question) {
            Choice::Curved
        } else {
            let linear = |apart: &SampleSpacing| self.is_linear_between(budget, question, clamped, *apart);
            SampleSpacing::ALL.into_iter().rev().find(linear).map_or(Choice::Phong, Choice::PhongEvery)
        }
    }

    /// Returns whether light is linear enough between two pixels of a row that are so far apart.
    #[inline(never)]
    fn is_linear_between(&self, budget: &Budget, question: &Question<'_>, clamped: bool, apart: SampleSpacing) -> bool {
        // At most 16.
        let ((far, near), width, apart) = (question.depths(), question.width(), apart.pixels() as f32);
        if far == 0 || width < WORTH_KNOTS.max(1.5 * apart) {
            return false;
        }
        // A pixel is a step on the face that is greater by the ratio of distances where it is farthest than where it is
        // nearest.
        let ratio = near as f32 / far as f32;
        let part = apart * ratio / width;
        if part > 0.75 {
            return false;
        }
        let facet = &budget.facets[question.triangle];
        let strength = &budget.strengths[usize::from(question.surface)];
        let lamps = !self.lights.lamps.is_empty();
        let highlights = strength.curvature > 0.0;
        // What shades differ by over the face at most; cosˢ is nowhere steeper than √(s/e).
        let turned = 2.0 * facet.spread + facet.edge * budget.eye_turn;
        let shininess = self.paints[usize::from(question.surface)].answer.shininess as f32;
        let differ = if lamps {
            255.0
        } else {
            let body = strength.body * facet.spread * (1.0 + facet.shortening);
            (body + strength.highlights * 0.61 * libm::sqrtf(shininess) * turned).min(255.0)
        };
        // Shades that are cut off above 1 somewhere on the way: a fourth of what they differ by there.
        let cut = if clamped || highlights { part * differ / 4.0 } else { 0.0 };
        let bend = (ratio - 1.0) / 4.0 * part * part * differ;
        let spare = budget.allowed - EXACT - cut - bend;
        spare > 0.0 && self.model_error(budget, question, part, spare, None) <= spare
    }

    /// Gathers the input of the bounds for one source.
    pub(super) fn one_light<'a>(&self, budget: &'a Budget, question: &Question<'_>, part: f32) -> OneLight<'a> {
        let paint = &self.paints[usize::from(question.surface)];
        let side = if question.turned { -1.0 } else { 1.0 };
        let (ks, shininess) = highlight(paint, self.channels);
        let corners = question.indices.map(|i| i as usize);
        OneLight {
            facet: &budget.facets[question.triangle],
            normals: corners.map(|i| self.geometry.normals[i] * side),
            to_eye: if ks == 0.0 { [Towards::default(); 3] } else { self.seen_from(question, self.lights.eye) },
            kd: paint.answer.diffuse.abs() as f32 * 255.0,
            ks,
            shininess,
            part,
            below: false,
        }
    }

    /// Place of a point, from each corner.
    fn seen_from(&self, question: &Question<'_>, point: [f64; 3]) -> [Towards; 3] {
        let point = narrow(point);
        question.indices.map(|i| Towards::new(point - self.geometry.positions[i as usize]))
    }

    /// Bounds the error of linear shades against the model, in shades; anything beyond `limit` where it is more than
    /// that. `body` is the error without highlights, if that is known.
    #[inline(never)]
    fn model_error(&self, budget: &Budget, question: &Question<'_>, part: f32, limit: f32, body: Option<f32>) -> f32 {
        self.model_error_in(budget, question, &self.one_light(budget, question, part), limit, body)
    }

    /// Bounds the error of linear shades against the model in this light, in shades; anything beyond `limit` where it
    /// is more than that. `body` is the error without highlights, if that is known.
    #[inline]
    pub(super) fn model_error_in(
        &self,
        budget: &Budget,
        question: &Question<'_>,
        light: &OneLight<'_>,
        limit: f32,
        body: Option<f32>,
    ) -> f32 {
        let mut sum = body.unwrap_or_else(|| self.body_error(budget, question, light, limit));
        if light.ks == 0.0 || sum > limit {
            return sum;
        }
        for sun in self.lights.suns {
            let intensity = brightest(sun.intensity, sun.channels, self.channels);
            sum += light.highlight_of_sun(sun.towards, intensity, limit - sum);
            if sum > limit {
                return sum;
            }
        }
        let (corners, vertices) = (question.indices.map(|i| i as usize), self.geometry.positions.len());
        for (&(inverse_range, intensity), to_lamp) in budget.lamps.iter().zip(budget.to_lamps.chunks_exact(vertices)) {
            let to_lamp = corners.map(|i| to_lamp[i]);
            sum += light.highlight_of_lamp(to_lamp, inverse_range, intensity, limit - sum);
            if sum > limit {
                return sum;
            }
        }
        sum
    }

    /// Bounds the error of linear shades against the model without highlights, in shades; anything beyond `limit` where
    /// it is more than that. The eye's place makes no difference.
    #[inline(never)]
    fn body_error(&self, budget: &Budget, question: &Question<'_>, light: &OneLight<'_>, limit: f32) -> f32 {
        let answer = &self.paints[usize::from(question.surface)].answer;
        // Each channel for itself: what is red adds nothing to what is off on green.
        let mut sums = [0.0_f32; 3];
        let mut add = |off: f32, intensity: f32, channels: [f32; 3]| {
            for (sum, part) in sums.iter_mut().zip(parts(answer, intensity, channels, self.channels)) {
                *sum += part * off;
            }
            sums.into_iter().fold(0.0, f32::max)
        };
        let mut most = 0.0;
        for sun in self.lights.suns {
            most = add(light.body_of_sun(sun.towards), sun.intensity, sun.channels);
            if most > limit {
                return most;
            }
        }
        let (corners, vertices) = (question.indices.map(|i| i as usize), self.geometry.positions.len());
        let lamps = self.lights.lamps.iter().zip(&budget.lamps);
        for ((lamp, &(inverse_range, _)), to_lamp) in lamps.zip(budget.to_lamps.chunks_exact(vertices)) {
            let to_lamp = corners.map(|i| to_lamp[i]);
            most = add(light.body_of_lamp(to_lamp, inverse_range), lamp.intensity, lamp.channels);
            if most > limit {
                return most;
            }
        }
        most
    }

    /// Error of linear shades against the model, in shades, found at points between the corners. The points divide
    /// each edge in four: between them the function is no farther from linear than a part of a fourth of the size may
    /// be. Where that is enough they divide it in two, and are half as many.
    #[inline(never)]
    fn error_between_samples(&self, budget: &Budget, question: &Question<'_>, limit: f32) -> f32 {
        let between = self.model_error(budget, question, 0.25, limit, None);
        // A bound that is 16 times as much is seldom wrong by half.
        if between > limit / 3.0 {
            return f32::INFINITY;
        }
        // Curvature is four times as much on parts twice the size. (`two-lights` within 2 shades: 1,232 to 1,077 µs.)
        let halves = if 4.0 * between < limit { self.model_error(budget, question, 0.5, limit, None) } else { limit };
        let corners = question.indices.map(|i| i as usize);
        let normals =
            corners.map(|i| if question.turned { -self.geometry.normals[i] } else { self.geometry.normals[i] });
        let positions = corners.map(|i| self.geometry.positions[i]);
        let answer = &self.paints[usize::from(question.surface)].answer;
        let kernel = budget.kernel.unwrap_or(Kernel::PORTABLE);
        // The corners are among the points.
        let mut intensities = [[0.0_f32; 3]; SAMPLES.len()];
        let mut error = f32::INFINITY;
        for (eight, bound) in [halves, between].into_iter().enumerate() {
            let (first, end) = (eight * LANES, (eight + 1) * LANES);
            let (weights, intensities_of) = (&SAMPLES[first..end], &mut intensities[first..end]);
            let mut points = [[0.0; LANES]; 6];
            for (lane, [a, b, c]) in weights.iter().enumerate() {
                let between = |of: &[Vec3; 3]| (of[0] * *a + of[1] * *b + of[2] * *c).to_array();
                for (axis, (n, p)) in between(&normals).into_iter().zip(between(&positions)).enumerate() {
                    (points[axis][lane], points[axis + 3][lane]) = (n, p);
                }
            }
            // Shown, they are clamped.
            let shown = |intensity: f64| intensity.clamp(0.0, 1.0) as f32;
            if self.channels {
                let channels = self.lights.front_of_three_channels(answer, &points, kernel);
                for (lane, of) in intensities_of.iter_mut().enumerate() {
                    *of = channels.each_ref().map(|channel| shown(channel[lane]));
                }
            } else {
                let all = self.lights.front_of_one_channel(answer, &points, kernel);
                for (of, intensity) in intensities_of.iter_mut().zip(all) {
                    *of = [shown(intensity); 3];
                }
            }
            error = bound + self.off_linear(&intensities[..end], budget.adds);
            // Enough; or too much, however small the parts.
            if error <= limit || error - bound > limit {
                return error;
            }
        }
        error
    }

    /// Bounds the distance of intensities at as many of the points from linear, in shades.
    #[inline]
    fn off_linear(&self, intensities: &[[f32; 3]], adds: bool) -> f32 {
        let (mut off, mut clamp) = (0.0_f32, 0.0_f32);
        for channel in 0..if self.channels { 3 } else { 1 } {
            let [a, b, c] = [0, 1, 2].map(|i| intensities[i][channel]);
            let (mut least, mut most) = (1.0_f32, 0.0_f32);
            for (weights, intensities) in SAMPLES.iter().zip(intensities) {
                let at = intensities[channel];
                off = off.max((a * weights[0] + b * weights[1] + c * weights[2] - at).abs());
                (least, most) = (least.min(at), most.max(at));
            }
            // What is cut off.
            if most >= 1.0 || (least <= 0.0 && !adds) {
                clamp = clamp.max(most - least);
            }
        }
        // Of PS / (P + S), P what lies above the clamp, no more than a fourth of both.
        255.0 * (off + clamp / 4.0)
    }
}
