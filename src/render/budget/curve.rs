//! Faces on which light is near enough to a quadratic function of the screen, through the light at six points: the corners
//! and the middles of the edges (see `raster::effects::ShadeSource::Curved`).
//!
//! Whether it is, light at a grid of points says, which divides each edge on the screen in n. With f the light, q the
//! quadratic function, and off the greatest |f − q| at these points, they differ in any of the n² parts by no more than
//!
//! ```text
//! off                                     of the function that is linear between the part's corners,
//! + model(ρ/n)                            f from the one that is linear on the part of the face,
//! + (ρ − 1)/4n · range                    that one from the one that is linear on the screen,
//! + ⅔ D/n²                                and q from that
//! ```
//!
//! - ρ is the ratio of the corners' distances. A part's edge on the screen is 1/n of one of the whole's; with depths d, points
//!   on the face P(L) = Σ dᵢLᵢPᵢ / Σ dᵢLᵢ, and from L to L + (eᵢ − eⱼ)/n it is (dᵢ(Pᵢ − P) − dⱼ(Pⱼ − P)) / n·W that P moves
//!   by, W being no less than the least depth. That is dⱼ(Pᵢ − Pⱼ) + (dᵢ − dⱼ)(Pᵢ − P) over n·W: as no two points are farther
//!   apart than the longest edge, no more than ρ/n of that. The same holds for normals and their chords.
//! - Depths within a part differ by a ratio of at most 1 + (ρ − 1)/n, so its range is bent by a quarter of (ρ − 1)/n. The range is
//!   that of q, whose slope along an edge is at most |fᵢ − fⱼ| + 4D, over n, and 2·off.
//! - D is the greatest second difference of q along an edge of the whole. On a part, where these are n² times smaller, q is
//!   linear less 2 Σ Dᵢⱼ lᵢlⱼ / n², and the products add up to at most ⅓.
//!
//! All this is of light that is not cut off above 1: cut off both differ by no more.
//!
//! **The horizon.** A matt face in one light is dark beyond a line. There the quadratic function goes through the light as it
//! would go on below the horizon (on the other side of the face as much is added as here is missing), and where
//! it is below the shade without light that one is drawn: so the bend is where it should be.

use glam::Vec3;

use super::light::OneLight;
use super::{Budget, EXACT, Question};
use crate::fixed::U8F8;
use crate::lanes::{LANES, Lanes, Points};
use crate::light::Reflectance;
use crate::raster::Vertex;
use crate::raster::effects::{Attributes, Limits};
use crate::render::faces::Faces;
use crate::render::paint::SurfaceMaterial;
use crate::span::Kernel;

/// Pixels from which on it pays to find out. (From 64 on the torus takes 0.86 of the time of `phong` within 2 shades, from 32
/// on 0.78, from 16 on 0.75; from 10 on 0.77.)
const WORTH_CURVE: f32 = 16.0;

/// Pixels for each point of the finer grids, at least, for it to be worth it. (The spheres of `phong` within 2 shades: at 10
/// 1.04 of the time of the shading, at 5 0.99, at 3 0.95; a grid that is lit in vain is dearer the finer it is.)
const PIXELS_A_POINT: f32 = 4.0;

/// Share of the allowed error up to which light may be off between the points of a grid for it to be worth lighting.
/// (With 0.5 the torus within 1 shade takes 1.00 of `phong`, with 0.9 0.93.)
const MODEL: f32 = 0.9;

/// Weights of eight points on the screen.
type Weights = [Lanes<f32>; 3];

/// The corners, the middles of the edges opposite to them, and two that nobody needs.
const NODES: Weights = [
    [1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0],
    [0.0, 1.0, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.5, 0.5, 0.0, 0.0, 0.0],
];

/// The points that divide each edge in `n`, but for the corners and, as `n` is even, the middles of the edges; to full eights
/// with the first corner.
const fn grid<const EIGHTS: usize>(n: usize) -> [Weights; EIGHTS] {
    let mut eights = [[[1.0; LANES], [0.0; LANES], [0.0; LANES]]; EIGHTS];
    let (mut at, mut a) = (0, 0);
    while a <= n {
        let mut b = 0;
        while a + b <= n {
            let c = n - a - b;
            let half = n / 2;
            let is_node = a == n
                || b == n
                || c == n
                || (a == half && b == half)
                || (a + b == half && c == half && (a == 0 || b == 0));
            if !is_node {
                let eight = &mut eights[at / LANES];
                eight[0][at % LANES] = a as f32 / n as f32;
                eight[1][at % LANES] = b as f32 / n as f32;
                eight[2][at % LANES] = c as f32 / n as f32;
                at += 1;
            }
            b += 1;
        }
        a += 1;
    }
    eights
}

/// 15, 45 and 153 points, the six nodes among them.
static FOURTHS: [Weights; 2] = grid(4);
static EIGHTHS: [Weights; 5] = grid(8);
static SIXTEENTHS: [Weights; 19] = grid(16);

/// Divisions of an edge: the number of parts, and the points.
const GRIDS: [(f32, &[Weights]); 3] = [(4.0, &FOURTHS), (8.0, &EIGHTHS), (16.0, &SIXTEENTHS)];

/// A face on the screen.
struct OnScreen<'a> {
    normals: [Vec3; 3],
    positions: [Vec3; 3],
    depths: [f32; 3],
    answer: &'a Reflectance,
    /// True if its light goes on below the horizon.
    below: bool,
    kernel: Kernel,
}

impl OnScreen<'_> {
    /// Normals, of any length, and positions.
    #[inline]
    fn points(&self, weights: &Weights, turned: bool) -> Points {
        let mut on_face = *weights;
        for (weights, depth) in on_face.iter_mut().zip(self.depths) {
            weights.iter_mut().for_each(|weight| *weight *= depth);
        }
        let [wa, wb, wc] = &on_face;
        let mut shares = [0.0; LANES];
        for (lane, share) in shares.iter_mut().enumerate() {
            *share = 1.0 / (wa[lane] + wb[lane] + wc[lane]);
        }
        let mut points = [[0.0; LANES]; 6];
        let side = if turned { -1.0 } else { 1.0 };
        for axis in 0..3 {
            let [a, b, c] = self.normals.map(|normal| side * normal[axis]);
            let [pa, pb, pc] = self.positions.map(|position| position[axis]);
            for lane in 0..LANES {
                points[axis][lane] = (a * wa[lane] + b * wb[lane] + c * wc[lane]) * shares[lane];
                points[axis + 3][lane] = (pa * wa[lane] + pb * wb[lane] + pc * wc[lane]) * shares[lane];
            }
        }
        points
    }
}

/// The quadratic function of one channel.
#[derive(Clone, Copy, Default)]
struct Quadratic {
    corners: [f32; 3],
    /// 2D of the edges opposite to the corners.
    bends: [f32; 3],
}

impl Quadratic {
    fn new(nodes: &Lanes<f32>) -> Self {
        let [fa, fb, fc, ma, mb, mc, ..] = *nodes;
        let bend = |from: f32, middle: f32, to: f32| 2.0 * (from - 2.0 * middle + to);
        Self { corners: [fa, fb, fc], bends: [bend(fb, ma, fc), bend(fc, mb, fa), bend(fa, mc, fb)] }
    }

    /// Bounds its distance from some values.
    #[inline]
    fn off(&self, [a, b, c]: &Weights, values: &Lanes<f32>) -> f32 {
        let ([fa, fb, fc], [da, db, dc]) = (self.corners, self.bends);
        let mut off = [0.0_f32; LANES];
        for lane in 0..LANES {
            let (a, b, c) = (a[lane], b[lane], c[lane]);
            let q = (fa * a + fb * b + fc * c) - (da * (b * c) + db * (c * a) + dc * (a * b));
            off[lane] = (q - values[lane]).abs();
        }
        greatest(off)
    }

    /// Bounds its distance, between the points, from light that is so far off at the points.
    fn between(&self, off: f32, n: f32, ratio: f32) -> f32 {
        let [fa, fb, fc] = self.corners;
        let range = greatest([fa - fb, fb - fc, fc - fa].map(f32::abs));
        let d = greatest(self.bends.map(f32::abs)) / 2.0;
        let bent = (ratio - 1.0) / (4.0 * n) * ((range + 4.0 * d) / n + 2.0 * off);
        off + bent + 2.0 / 3.0 * d / (n * n)
    }
}

/// Returns the greatest value; not a number if one of them is not.
fn greatest<const N: usize>(values: [f32; N]) -> f32 {
    values.into_iter().fold(0.0, |most, value| if value <= most { most } else { value })
}

impl Faces<'_> {
    /// A face whose light may go on below the horizon.
    fn on_screen(
        &self,
        indices: [u32; 3],
        surface: u16,
        turned: bool,
        depths: [u32; 3],
        kernel: Kernel,
    ) -> OnScreen<'_> {
        let normals = indices.map(|i| self.geometry.normals[i as usize]);
        let positions = indices.map(|i| self.geometry.positions[i as usize]);
        let answer = &self.paints[usize::from(surface)].answer;
        let mixed = |cosines: [f32; 3]| cosines.iter().any(|c| *c > 0.0) && cosines.iter().any(|c| *c < 0.0);
        let below = answer.specular == 0.0
            && match (self.lights.suns, self.lights.lamps) {
                ([sun], []) => mixed(normals.map(|normal| normal.dot(sun.towards))),
                ([], [lamp]) => {
                    let at = super::light::narrow(lamp.position);
                    mixed([0, 1, 2].map(|i| normals[i].dot(at - positions[i])))
                }
                _ => false,
            };
        OnScreen {
            normals: if turned { normals.map(|normal| -normal) } else { normals },
            positions,
            // Rounded to 24 bits.
            depths: depths.map(|depth| depth as f32),
            answer,
            below,
            kernel,
        }
    }

    /// Light on each channel, or on the first, not cut off.
    #[inline]
    fn light_at(&self, face: &OnScreen<'_>, weights: &Weights) -> [Lanes<f32>; 3] {
        let front = self.front(face, weights, false);
        if !face.below {
            return front;
        }
        // One side has the light, the other what is there without it, which is the lesser.
        let back = self.front(face, weights, true);
        let mut both = front;
        for (both, back) in both.iter_mut().zip(&back) {
            for (both, back) in both.iter_mut().zip(back) {
                *both = *both - *back + both.min(*back);
            }
        }
        both
    }

    #[inline]
    fn front(&self, face: &OnScreen<'_>, weights: &Weights, turned: bool) -> [Lanes<f32>; 3] {
        let points = face.points(weights, turned);
        // Beyond f32 infinite.
        let narrow = |wide: [f64; LANES]| wide.map(|intensity| intensity as f32);
        if self.channels {
            self.lights.front_of_three_channels(face.answer, &points, face.kernel).map(narrow)
        } else {
            let one = narrow(self.lights.front_of_one_channel(face.answer, &points, face.kernel));
            [one, [0.0; LANES], [0.0; LANES]]
        }
    }

    /// Returns whether quadratic shades keep within.
    #[inline(never)]
    pub(super) fn is_quadratic(&self, budget: &Budget, question: &Question<'_>) -> bool {
        let (Some(vertices), (far, near), pixels) = (question.vertices, question.depths(), question.pixels()) else {
            return false;
        };
        if far == 0 || pixels < WORTH_CURVE || !budget.adds {
            return false;
        }
        let kernel = budget.kernel.unwrap_or(Kernel::PORTABLE);
        let depths = vertices.each_ref().map(Vertex::depth);
        let face = self.on_screen(question.indices, question.surface, question.turned, depths, kernel);
        let (ratio, spare) = (near as f32 / far as f32, budget.allowed - EXACT);
        let channels = if self.channels { 3 } else { 1 };
        // Eight points at a time, and the nodes.
        let pays = |points: &[Weights]| (LANES * (points.len() + 1)) as f32 * PIXELS_A_POINT <= pixels;
        let grids = 1 + GRIDS[1..].iter().filter(|(_, points)| pays(points)).count();
        let model = |n: f32| {
            let part = ratio / n;
            if part > 0.75 {
                return f32::INFINITY;
            }
            let light = OneLight { below: face.below, ..self.one_light(budget, question, part) };
            self.model_error_in(budget, question, &light, spare, None)
        };
        // Where the finest grid is too coarse all are.
        let least = model(GRIDS[grids - 1].0);
        if least > MODEL * spare {
            return false;
        }
        let mut curves = None;
        for (i, (n, points)) in GRIDS[..grids].iter().enumerate() {
            let n = *n;
            let model = if i + 1 == grids { least } else { model(n) };
            if model > MODEL * spare {
                continue;
            }
            let curves = curves.get_or_insert_with(|| self.light_at(&face, &NODES).map(|nodes| Quadratic::new(&nodes)));
            let left = (spare - model) / 255.0;
            let within = |off: f32, curve: &Quadratic| curve.between(off, n, ratio) <= left;
            if !curves[..channels].iter().all(|curve| within(0.0, curve)) {
                continue;
            }
            let is_within = |weights: &Weights| {
                let light = self.light_at(&face, weights);
                curves.iter().zip(&light).take(channels).all(|(curve, light)| within(curve.off(weights, light), curve))
            };
            return points.iter().all(is_within);
        }
        false
    }

    /// Puts the quadratic attributes of a face's corners: see `Attributes::lit`.
    #[inline(never)]
    pub(in crate::render) fn put_curve(
        &self,
        attributes: &mut [Attributes; 3],
        (indices, surface, turned): ([u32; 3], u16, bool),
        vertices: &[Vertex; 3],
    ) {
        let depths = vertices.each_ref().map(Vertex::depth);
        let kernel = self.kernel;
        let face = self.on_screen(indices, surface, turned, depths, kernel);
        let light = self.light_at(&face, &NODES);
        let ramp = self.paints[usize::from(surface)].ramp;
        let (first, units) = (f32::from(ramp.first()) * 256.0, f32::from(ramp.entries().saturating_sub(1)) * 256.0);
        for (corner, attributes) in attributes.iter_mut().enumerate() {
            for (channel, light) in light.iter().enumerate() {
                attributes.lit[channel] = first + light[corner] * units;
                attributes.lit[channel + 3] = first + light[corner + 3] * units;
            }
        }
    }
}

/// Between which shades quadratic ones are held: that without light, as no light takes any away, and the last.
pub(in crate::render) fn limits(paint: &SurfaceMaterial, channels: bool) -> [Limits; 3] {
    if channels {
        let Reflectance { ambient, color, .. } = paint.answer;
        let least = SurfaceMaterial::channels(color.map(|channel| ambient * channel));
        return least.map(|least| Limits { least, most: U8F8::MAX_VERTEX });
    }
    // A ramp ends at entry 255 at most.
    let last = u16::from(paint.ramp.first()) + paint.ramp.entries().saturating_sub(1);
    let most = U8F8::from_bits(last.min(255) << 8);
    [Limits { least: paint.constant(), most }; 3]
}
