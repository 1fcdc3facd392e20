//! Bounds of `light` for eight whole faces at once, in the light of all sources: which of them are linear. The arrays
//! are plain, so that the compiler vectorises them. A face that the bounds leave open is asked of `question`.
//!
//! A highlight's curvature is bounded more closely than there, for where a face is far from its middle: along the angle μ from
//! it the second derivative of cosˢμ is s·c^(s−2)·(s − 1 − s·c²), c being cos μ, and across −s·cˢ. With y = s(1 − c)
//!
//! ```text
//! cˢ ≤ e^−y            s − 1 − s·c² ≤ 2y − 1            c^(s−2) ≤ e^(−ky),  k = 1 − 2/s
//! ```
//!
//! and (2y − 1)·e^(−ky) is greatest at 1/k + ½, where it is (2/k)·e^(−1−k/2), and falls from there on. What the paths of light and eye
//! bend by, their turns' squares at most, is added times the greatest slope, √(s/e). That of the normals, at most half of (2·spread)²
//! where it is not along the angle, adds less than a tenth from s = 8 on, which is in the fifth that all curvature is taken too great;
//! below 8 the bound is s, as there.

use glam::Vec3;

use super::corners::ways;
use super::decided::Bodies;
use super::light::{APART, FROM_ONE, clamp_error, narrow};
use super::{Budget, CURVATURE, EXACT, LINEAR, brightest, highlight, parts};
use crate::lanes::{LANES, Lanes};
use crate::light::{Lights, Reflectance};
use crate::render::faces::Faces;
use crate::simd::at_best_level;
use crate::span::Kernel;

/// Exponent from which on a highlight is known to curve less away from its middle.
const SHARP: f32 = 8.0;

/// x, y and z.
pub(super) type Vectors = [Lanes<f32>; 3];

pub(super) const NOUGHT: Lanes<f32> = [0.0; LANES];

/// Eight faces, on the side that is seen. Missing ones are zero.
pub(super) struct Eight {
    /// The normals at each corner.
    normals: [Vectors; 3],
    /// The position of each corner.
    positions: [Vectors; 3],
    shortening: Lanes<f32>,
    spread: Lanes<f32>,
    edge: Lanes<f32>,
}

/// Results for the faces of one chunk, a bit for each.
#[derive(Clone, Copy, Default)]
pub(in crate::render) struct Looked {
    pub(in crate::render) at: u64,
    pub(in crate::render) linear: u64,
    /// Faces that bounds for whole faces say nothing of.
    pub(in crate::render) hopeless: u64,
}

/// The light on a surface.
pub(super) struct Falling<'a> {
    lights: Lights<'a>,
    answer: &'a Reflectance,
    channels: bool,
    /// In shades.
    kd: f32,
    ks: f32,
    shininess: f32,
    /// 1 − 2/s, and what the curvature comes to at most beyond where it changes its sign, as a share of s; 1 of what is not
    /// sharp.
    k: f32,
    beyond: f32,
}

/// The eye, or a lamp, seen from the corners.
struct Towards {
    directions: [Vectors; 3],
    nearest: Lanes<f32>,
    farthest: Lanes<f32>,
}

impl Falling<'_> {
    /// Bounds the error of linear shades against the model, in shades: those of the body, and of the highlights.
    #[inline(always)]
    fn model(&self, eight: &Eight) -> [Lanes<f32>; 2] {
        let Lights { suns, lamps, eye } = self.lights;
        let mut sums = [NOUGHT; 3];
        let mut highlights = NOUGHT;
        let eye = (self.ks != 0.0).then(|| Towards::new(narrow(eye), eight));
        for sun in suns {
            let towards = sun.towards.to_array().map(|axis| [axis; LANES]);
            let cosines = eight.normals.each_ref().map(|normals| dot(normals, &towards));
            let (most, least) = ends(&cosines);
            let mut body = NOUGHT;
            for lane in 0..LANES {
                body[lane] = self.kd * matt(most[lane], least[lane], eight.shortening[lane]);
            }
            self.add(&mut sums, &body, sun.intensity, sun.channels);
            let Some(eye) = &eye else { continue };
            let of_sun = self.highlight(eight, eye, &[towards; 3], &cosines, &NOUGHT);
            let intensity = brightest(sun.intensity, sun.channels, self.channels);
            for (sum, (highlight, most)) in highlights.iter_mut().zip(of_sun.iter().zip(&most)) {
                *sum += if *most > 0.0 { intensity * highlight } else { 0.0 };
            }
        }
        for lamp in lamps {
            let inverse_range = libm::sqrt(lamp.inverse_square) as f32;
            let to_lamp = Towards::new(narrow(lamp.position), eight);
            let cosines = [0, 1, 2].map(|i| dot(&eight.normals[i], &to_lamp.directions[i]));
            let (most, least) = ends(&cosines);
            // As `OneLight::lamp`.
            let (mut turn, mut fall_off, mut first, mut second) = (NOUGHT, NOUGHT, NOUGHT, NOUGHT);
            let mut body = NOUGHT;
            for lane in 0..LANES {
                let (edge, spread) = (eight.edge[lane], eight.spread[lane]);
                let nearest = to_lamp.nearest[lane] - APART * edge;
                let near = nearest.max(0.0) * inverse_range;
                let reaches = if near < 1.0 { 1.0 } else { 0.0 };
                turn[lane] = if edge < nearest { edge / nearest } else { 4.0 };
                let (e, far) = (edge * inverse_range, (to_lamp.farthest[lane] * inverse_range).min(1.0));
                let left = reaches * (1.0 - near * near);
                fall_off[lane] = left * left;
                first[lane] = 4.0 * far * left * e;
                second[lane] = reaches * ((8.0 * far * far + 4.0 * left) * e * e);
                let (turn, fall_off, first, second) = (turn[lane], fall_off[lane], first[lane], second[lane]);
                let curvature =
                    2.0 * spread * (fall_off * turn + first) + fall_off * turn * turn + 2.0 * first * turn + second;
                let matt = fall_off * matt(most[lane], least[lane], eight.shortening[lane]);
                body[lane] = self.kd * (CURVATURE * curvature + matt);
            }
            self.add(&mut sums, &body, lamp.intensity, lamp.channels);
            let Some(eye) = &eye else { continue };
            let of_lamp = self.highlight(eight, eye, &to_lamp.directions, &cosines, &turn);
            let intensity = brightest(lamp.intensity, lamp.channels, self.channels);
            let root = libm::sqrtf(self.shininess);
            for lane in 0..LANES {
                let slope = root * (2.0 * eight.spread[lane] + turn[lane]);
                let fading = self.ks * CURVATURE * (2.0 * first[lane] * slope + second[lane]);
                highlights[lane] += intensity * (fading + fall_off[lane] * of_lamp[lane]);
            }
        }
        let [a, b, c] = &sums;
        let mut body = NOUGHT;
        for (lane, body) in body.iter_mut().enumerate() {
            *body = greater(greater(a[lane], b[lane]), c[lane]);
        }
        [body, highlights]
    }

    /// Adds what is off in one light, on each channel as much as it has of it.
    #[inline(always)]
    fn add(&self, sums: &mut [Lanes<f32>; 3], off: &Lanes<f32>, intensity: f32, channels: [f32; 3]) {
        for (sum, part) in sums.iter_mut().zip(parts(self.answer, intensity, channels, self.channels)) {
            for (sum, off) in sum.iter_mut().zip(off) {
                *sum += part * off;
            }
        }
    }

    /// Bounds the error of linear highlights on each of eight faces: `OneLight::highlight` in lanes.
    #[inline(always)]
    fn highlight(
        &self,
        eight: &Eight,
        eye: &Towards,
        towards: &[Vectors; 3],
        cosines: &[Lanes<f32>; 3],
        light_turn: &Lanes<f32>,
    ) -> Lanes<f32> {
        let (most, least) = ends(cosines);
        let mut along = [-1.0; LANES];
        for corner in 0..3 {
            let (to_eye, to_light) = (&eye.directions[corner], &towards[corner]);
            let (facing, between) = (dot(&eight.normals[corner], to_eye), dot(to_light, to_eye));
            for lane in 0..LANES {
                along[lane] = greater(along[lane], 2.0 * cosines[corner][lane] * facing[lane] - between[lane]);
            }
        }
        let half_way = self.half_way(eight, &eye.directions[0], &towards[0]);
        let slope = 0.61 / libm::sqrtf(self.shininess.max(1.0));
        let curve = super::curve(self.shininess);
        let mut off = NOUGHT;
        for lane in 0..LANES {
            let (edge, spread) = (eight.edge[lane], eight.spread[lane]);
            let nearest = eye.nearest[lane] - APART * edge;
            let eye_turn = if edge < nearest { edge / nearest } else { 4.0 };
            let turn = 2.0 * spread + light_turn[lane] + eye_turn;
            let along = if along[lane] < 1.0 { along[lane] } else { 1.0 };
            let from_one = FROM_ONE * turn;
            let more = if along < 0.0 { 0.5 * from_one * from_one } else { 0.0 };
            let along = along + from_one * square_root(1.0 - along * along) + more;
            let along = if along < 1.0 { along } else { 1.0 };
            let by_normals = half_way.along(lane, light_turn[lane] + eye_turn);
            let along = if by_normals < along { by_normals } else { along };
            let y = self.shininess * (1.0 - along);
            let bright = if along > 0.0 { falling(y) } else { 0.0 };
            // Its curvature, as a share of s.
            let beyond = falling(self.k * y) * (2.0 * y - 1.0);
            let beyond = if self.k * (y - 0.5) > 1.0 && beyond < self.beyond { beyond } else { self.beyond };
            let bends = slope * (light_turn[lane] * light_turn[lane] + eye_turn * eye_turn);
            let close = greater(bright, beyond) * turn * turn + bends;
            let curvature = if close < turn * turn { close } else { turn * turn };
            // Where the light comes over the horizon the highlight begins at once.
            let mixed = most[lane] > 0.0 && least[lane] <= 0.0;
            let curved = if mixed { 4.0 } else { CURVATURE * curve * curvature };
            off[lane] = self.ks * if curved < bright { curved } else { bright };
        }
        off
    }
}

/// The vector half-way between the directions to light and eye.
struct HalfWay {
    /// The length of the sum of the two.
    long: Lanes<f32>,
    /// Its cosine with the normal that is nearest to it.
    nearest: Lanes<f32>,
}

impl HalfWay {
    /// The greatest r·v of any point of the face in one lane: `OneLight::along` in lanes.
    #[inline(always)]
    fn along(&self, lane: usize, turn: f32) -> f32 {
        let (long, nearest) = (self.long[lane], self.nearest[lane]);
        let nearest = nearest + turn / long * square_root(1.0 - nearest * nearest);
        let nearest = if nearest < 1.0 { nearest } else { 1.0 };
        let square = long * long / 4.0 - turn / 2.0;
        let square = if square > 0.0 { square } else { 0.0 };
        let along = 1.0 - 2.0 * square * (1.0 - nearest * nearest);
        let along = if along > 0.0 { along } else { 0.0 };
        if long < 0.01 { 1.0 } else { along }
    }
}

impl Falling<'_> {
    #[inline(always)]
    fn half_way(&self, eight: &Eight, to_eye: &Vectors, to_light: &Vectors) -> HalfWay {
        let mut sum = *to_eye;
        for (sum, light) in sum.iter_mut().zip(to_light) {
            for (sum, light) in sum.iter_mut().zip(light) {
                *sum += light;
            }
        }
        let squares = dot(&sum, &sum);
        let mut long = NOUGHT;
        for (long, square) in long.iter_mut().zip(&squares) {
            *long = square_root(*square);
        }
        for values in &mut sum {
            for (value, long) in values.iter_mut().zip(&long) {
                *value /= long;
            }
        }
        HalfWay { long, nearest: nearest_normal(&eight.normals, &sum) }
    }
}

/// The greatest n·h of any unit n between three normals, as in `light`; none is below 0.
#[inline(always)]
fn nearest_normal(normals: &[Vectors; 3], h: &Vectors) -> Lanes<f32> {
    let [a, b, c] = normals;
    let along = [dot(a, h), dot(b, h), dot(c, h)];
    let (mut nearest, mut all, mut none) = (NOUGHT, [true; LANES], [true; LANES]);
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let (a, b, to_a, to_b) = (&normals[from], &normals[to], &along[from], &along[to]);
        let cosines = dot(a, b);
        let side = dot(&cross(a, b), h);
        for lane in 0..LANES {
            let (to_a, to_b, cosine) = (to_a[lane], to_b[lane], cosines[lane]);
            let between = to_a > cosine * to_b && to_b > cosine * to_a && cosine < 0.999_999;
            let square = (to_a * to_a + to_b * to_b - 2.0 * to_a * to_b * cosine) / (1.0 - cosine * cosine);
            let on_arc = square_root(if square > 0.0 { square } else { 0.0 });
            let end = greater(to_a, to_b);
            nearest[lane] = greater(nearest[lane], if between { on_arc } else { end });
            all[lane] &= side[lane] > 0.0;
            none[lane] &= side[lane] < 0.0;
        }
    }
    for lane in 0..LANES {
        // It lies among them, or opposite.
        let sum = along[0][lane] + along[1][lane] + along[2][lane];
        let among = if sum > 0.0 { 1.0 } else { 0.0 };
        let value = if all[lane] | none[lane] { among } else { nearest[lane] };
        nearest[lane] = if value < 1.0 { value } else { 1.0 };
    }
    nearest
}

#[inline(always)]
fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    let mut cross = [NOUGHT; 3];
    for (axis, values) in cross.iter_mut().enumerate() {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        for (lane, value) in values.iter_mut().enumerate() {
            *value = a[next][lane] * b[last][lane] - a[last][lane] * b[next][lane];
        }
    }
    cross
}

impl Towards {
    #[inline(always)]
    fn new(to: Vec3, eight: &Eight) -> Self {
        let mut directions = eight.positions.each_ref().map(|places| ways(to, places));
        let mut distances = [NOUGHT; 3];
        for (way, distances) in directions.iter_mut().zip(&mut distances) {
            let squares = dot(way, way);
            for (distance, square) in distances.iter_mut().zip(&squares) {
                *distance = square_root(*square);
            }
            for values in way {
                for (value, distance) in values.iter_mut().zip(&*distances) {
                    *value /= distance;
                }
            }
        }
        let (farthest, nearest) = ends(&distances);
        Self { directions, nearest, farthest }
    }
}

impl Faces<'_> {
    /// Among faces of one chunk, up to eight that are on the same surface as the first: those on which linear shades keep
    /// within the budget. None is clipped.
    pub(in crate::render) fn linear_of_eight(
        &self,
        budget: &Budget,
        first: usize,
        (asked, turned): (u64, u64),
        bodies: &mut [Bodies],
    ) -> Looked {
        let (triangles, surfaces) = (&self.geometry.triangles[first..], &self.geometry.triangle_surfaces[first..]);
        let surface = surfaces[asked.trailing_zeros() as usize];
        let mut eight = Eight {
            normals: [[NOUGHT; 3]; 3],
            positions: [[NOUGHT; 3]; 3],
            shortening: NOUGHT,
            spread: NOUGHT,
            edge: NOUGHT,
        };
        let (mut places, mut count, mut left, mut looked) = ([0_usize; LANES], 0, asked, 0_u64);
        while left != 0 && count < LANES {
            let at = left.trailing_zeros() as usize;
            left &= left - 1;
            if surfaces[at] != surface {
                continue;
            }
            looked |= 1 << at;
            places[count] = at;
            count += 1;
        }
        for (lane, &at) in places[..count].iter().enumerate() {
            let side = if turned >> at & 1 == 1 { -1.0 } else { 1.0 };
            let facet = &budget.facets[first + at];
            (eight.shortening[lane], eight.spread[lane], eight.edge[lane]) =
                (facet.shortening, facet.spread, facet.edge);
            for (corner, i) in triangles[at].into_iter().enumerate() {
                let normal = self.geometry.normals[i as usize] * side;
                let position = self.geometry.positions[i as usize];
                for axis in 0..3 {
                    eight.normals[corner][axis][lane] = normal[axis];
                    eight.positions[corner][axis][lane] = position[axis];
                }
            }
        }
        let paint = &self.paints[usize::from(surface)];
        let (ks, shininess) = highlight(paint, self.channels);
        let k = 1.0 - 2.0 / shininess;
        let falling = Falling {
            lights: self.lights,
            answer: &paint.answer,
            channels: self.channels,
            kd: paint.answer.diffuse.abs() as f32 * 255.0,
            ks,
            shininess,
            k,
            beyond: if shininess >= SHARP { 2.0 / k * libm::expf(-1.0 - k / 2.0) } else { 1.0 },
        };
        let [body, highlights] = model_of(&falling, &eight, budget.kernel.unwrap_or(Kernel::PORTABLE));
        let strength = &budget.strengths[usize::from(surface)];
        let mut all = Looked { at: looked, ..Looked::default() };
        for (&at, (body, highlights)) in places[..count].iter().zip(body.into_iter().zip(highlights)) {
            let is_turned = turned >> at & 1 == 1;
            bodies[at][usize::from(is_turned)] = body;
            let face = (first + at, surface, is_turned);
            let is_linear = |highlight: f32| self.is_linear_within(budget, face, body + highlight);
            if is_linear(highlights) {
                all.linear |= 1 << at;
                continue;
            }
            // As `linear_as_known`: what is known already makes no difference.
            let faint = || budget.faint_highlight(triangles[at], &budget.facets[first + at], strength);
            let highlight = if strength.curvature == 0.0 { None } else { faint() }.unwrap_or(f32::INFINITY);
            if is_linear(highlight) {
                all.linear |= 1 << at;
            } else if body + highlights.min(highlight) + EXACT > budget.allowed {
                all.hopeless |= 1 << at;
            }
        }
        all
    }

    /// Finds linear faces, a bit for each, among those far enough from the highlights, where what their bodies are off
    /// by is known.
    pub(in crate::render) fn linear_as_known(
        &self,
        budget: &Budget,
        first: usize,
        (asked, turned): (u64, u64),
        bodies: &[Bodies],
    ) -> u64 {
        let (mut linear, mut left) = (0_u64, asked);
        while left != 0 {
            let at = left.trailing_zeros() as usize;
            left &= left - 1;
            let is_turned = turned >> at & 1 == 1;
            let body = bodies[at][usize::from(is_turned)];
            if body.is_nan() {
                continue;
            }
            let surface = self.geometry.triangle_surfaces[first + at];
            let strength = &budget.strengths[usize::from(surface)];
            let highlight = if strength.curvature == 0.0 {
                0.0
            } else {
                let indices = self.geometry.triangles[first + at];
                let Some(faint) = budget.faint_highlight(indices, &budget.facets[first + at], strength) else {
                    continue;
                };
                faint
            };
            linear |=
                u64::from(self.is_linear_within(budget, (first + at, surface, is_turned), body + highlight)) << at;
        }
        linear
    }

    /// Returns whether linear shades that are so far from the model keep within.
    #[inline]
    fn is_linear_within(&self, budget: &Budget, (triangle, surface, turned): (usize, u16, bool), model: f32) -> bool {
        let strength = &budget.strengths[usize::from(surface)];
        let indices = self.geometry.triangles[triangle];
        let shades = self.corner_shades(indices, turned);
        let (mut range, mut clamped) = (0, false);
        for [a, b, c] in &shades[..if self.channels { 3 } else { 1 }] {
            let (least, most) = (a.min(b).min(c), a.max(b).max(c));
            range = range.max(most - least);
            clamped |= strength.cuts(*least, *most, budget.adds);
        }
        let range = f32::from(range) * strength.scale;
        // What lies above the clamp is lost at some corners, by which the others are too dark at most.
        let lost = if clamped { range } else { 0.0 };
        let [a, b, c] = indices.map(|i| self.lit.depths[i as usize]);
        let (far, near) = (a.min(b).min(c), a.max(b).max(c));
        let bend = (near - far) as f32 * range;
        // Not a number fails it too.
        far > 0 && bend <= 4.0 * far as f32 * (budget.allowed - (model + lost) - LINEAR)
    }
}

#[inline]
fn model_of(falling: &Falling<'_>, eight: &Eight, kernel: Kernel) -> [Lanes<f32>; 2] {
    at_best_level!(kernel, falling.model(eight))
}

/// Loss for want of length, or at the clamp, whichever is more.
#[inline(always)]
fn matt(most: f32, least: f32, shortening: f32) -> f32 {
    let short = if most > 0.0 { most * shortening } else { 0.0 };
    greater(short, clamp_error(most, least))
}

/// No less than e^−y.
#[inline(always)]
fn falling(y: f32) -> f32 {
    1.0 / (1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y / 120.0)))))
}

/// Returns the greater one. In this form it is one instruction.
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The greatest and the least.
#[inline(always)]
pub(super) fn ends([a, b, c]: &[Lanes<f32>; 3]) -> (Lanes<f32>, Lanes<f32>) {
    let (mut most, mut least) = (*a, *a);
    for values in [b, c] {
        for lane in 0..LANES {
            most[lane] = greater(values[lane], most[lane]);
            least[lane] = if values[lane] < least[lane] { values[lane] } else { least[lane] };
        }
    }
    (most, least)
}

#[inline(always)]
pub(super) fn dot(a: &Vectors, b: &Vectors) -> Lanes<f32> {
    let mut sums = NOUGHT;
    for (lane, sum) in sums.iter_mut().enumerate() {
        *sum = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
    sums
}

/// Both are the number nearest to the root, so they are one number. The compiler makes vectors of the first.
#[inline(always)]
pub(super) fn square_root(square: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        square.sqrt()
    }
    #[cfg(not(feature = "std"))]
    {
        libm::sqrtf(square)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::light::{Beam, LampBeam};
    use proptest::prelude::*;

    fn lanes() -> impl Strategy<Value = Lanes<f32>> {
        prop::array::uniform8(-2.0_f32..2.0)
    }

    fn vectors() -> impl Strategy<Value = [Vectors; 3]> {
        prop::array::uniform3(prop::array::uniform3(lanes()))
    }

    fn channels() -> impl Strategy<Value = [f32; 3]> {
        prop::array::uniform3(-0.5_f32..1.5)
    }

    proptest! {
        /// Every kernel finds the same bounds.
        #[test]
        fn bounds_do_not_depend_on_the_kernel(
            (normals, positions) in (vectors(), vectors()),
            (shortening, spread, edge) in (lanes(), lanes(), lanes()),
            sun in (prop::array::uniform3(-1.0_f32..1.0), -0.5_f32..1.5, channels()),
            lamp in (prop::array::uniform3(-5.0_f64..5.0), -0.5_f32..1.5, channels(), 0.001_f64..1.0),
            (specular, shininess, in_color) in (prop::sample::select(vec![0.0, 0.4]), 0.5_f32..200.0, any::<bool>()),
        ) {
            let eight = Eight {
                normals,
                positions,
                shortening: shortening.map(f32::abs),
                spread: spread.map(f32::abs),
                edge: edge.map(|edge| edge.abs() / 4.0),
            };
            let suns = [Beam { towards: Vec3::from(sun.0), intensity: sun.1, channels: sun.2 }];
            let (position, intensity, channels, inverse_square) = lamp;
            let lamps = [LampBeam { position, intensity, channels, inverse_square }];
            let (color, highlight) = ([0.2, 0.5, 1.0], [1.0; 3]);
            let answer = Reflectance {
                ambient: 0.1, diffuse: 0.6, specular, shininess: f64::from(shininess), color, highlight,
            };
            let k = 1.0 - 2.0 / shininess;
            let falling = Falling {
                lights: Lights { suns: &suns, lamps: &lamps, eye: [0.5, 1.0, 4.0] },
                answer: &answer,
                channels: in_color,
                kd: 153.0,
                ks: specular as f32 * 255.0,
                shininess,
                k,
                beyond: if shininess >= SHARP { 2.0 / k * libm::expf(-1.0 - k / 2.0) } else { 1.0 },
            };
            let bits = |of: [Lanes<f32>; 2]| of.map(|lanes| lanes.map(f32::to_bits));
            let portable = bits(model_of(&falling, &eight, Kernel::PORTABLE));
            for kernel in Kernel::available() {
                prop_assert_eq!(bits(model_of(&falling, &eight, kernel)), portable);
            }
        }
    }
}
