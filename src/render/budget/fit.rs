//! Fits a quadratic function on the screen, tested on a grid of points of one face
//! (`docs/budget.md`, Lemma 10).
//!
//! The quadratic function goes through the light at six points: the corners and the middles of the edges (see
//! `raster::effects::ShadeSource::Curved`). It approximates unclamped light: clamping both at 1 never increases their
//! difference.
//!
//! On a matt face, light from one source continues below the horizon as negative light, whose
//! magnitude is the light on the other side.

use glam::Vec3;

use super::{Budget, EXACT_ROUNDING, PHONG};
use crate::fixed::U8F8;
use crate::lanes::{LANES, Lanes, Points, each, three};
use crate::light::Reflectance;
use crate::plan::FaceShading;
use crate::raster::Vertex;
use crate::raster::clip::doubled_area;
use crate::raster::effects::{Limits, SampleSpacing};
use crate::render::faces::{Face, Faces};
use crate::render::surface_material::SurfaceMaterial;
use crate::simd::compiled_for_each_level;
use crate::span::Kernel;

/// The finer grids are tried on faces with at least this many pixels for each of their points. (The spheres of `phong`
/// within 2 shades take 1.04 of that shading's time at 10, 0.99 at 5, 0.95 at 3; a failed attempt costs more on a finer
/// grid.)
const PIXELS_A_POINT: f32 = 4.0;

/// Size in pixels from which a face is fitted. (Instructions of a frame within 1 shade, relative to
/// 48, for 16, 32 and 48: `rgb` 1.06, 1.02 and 1, `torus` 1.04, 1.00 and 1, `teapot` 1.02, 1 and 1;
/// `torus` within 2 takes 1.01, 0.99 and 1.)
const WORTH_CURVE: f32 = 48.0;

/// The bound of parts is computed only if it is likely to help: if the face's bound, times the square of the smallest
/// part's size, is at most this fraction of the allowed error. (Instructions of a frame within 1 shade with it: `phong`
/// 0.94, `rgb` 0.92; with 0.5 instead `rgb` 0.97.)
const HOPE: f32 = 0.25;

/// A grid is worth lighting if light deviates between its points by less than this fraction of the
/// allowed error. (Within 1 shade the torus takes 1.00 of `phong` with 0.5, 0.93 with 0.9.)
const MODEL: f32 = 0.9;

/// Width in pixels of a triangle's widest row from which lighting only some of its pixels pays:
/// eight are lit at a time.
const WORTH_KNOTS: f32 = 16.0;

/// Weights of eight points on the screen.
type Weights = [Lanes<f32>; 3];

/// The corners, the middles of the opposite edges, and two unused ones.
const NODES: Weights = [
    [1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0],
    [0.0, 1.0, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.5, 0.5, 0.0, 0.0, 0.0],
];

/// The points of a grid that divides each edge into `n` parts, except for the corners and, as `n` is even, the middles
/// of the edges; padded to full eights with the first corner.
const fn grid<const EIGHTS: usize>(n: usize) -> [Weights; EIGHTS] {
    let mut eights = [[[1.0; LANES], [0.0; LANES], [0.0; LANES]]; EIGHTS];
    let (mut at, mut point) = (0, 0);
    while point < (n + 1) * (n + 1) {
        let (a, b) = (point / (n + 1), point % (n + 1));
        let is_node = a.is_multiple_of(n / 2) && b.is_multiple_of(n / 2);
        if a + b <= n && !is_node {
            let eight = &mut eights[at / LANES];
            eight[0][at % LANES] = a as f32 / n as f32;
            eight[1][at % LANES] = b as f32 / n as f32;
            eight[2][at % LANES] = (n - a - b) as f32 / n as f32;
            at += 1;
        }
        point += 1;
    }
    eights
}

/// The points of grids of 15, 45 and 153, without the six nodes.
static FOURTHS: [Weights; 2] = grid(4);
static EIGHTHS: [Weights; 5] = grid(8);
static SIXTEENTHS: [Weights; 19] = grid(16);

/// Divisions of an edge: the number of parts, and the points.
const GRIDS: [(f32, &[Weights]); 4] = [(2.0, &[]), (4.0, &FOURTHS), (8.0, &EIGHTHS), (16.0, &SIXTEENTHS)];

/// Light at the nodes, on each channel.
type Nodes = [Lanes<f32>; 3];

/// A face on the screen.
struct OnScreen<'a> {
    normals: [Vec3; 3],
    positions: [Vec3; 3],
    depths: [f32; 3],
    reflectance: &'a Reflectance,
    /// True if its light continues below the horizon.
    below: bool,
}

impl OnScreen<'_> {
    /// Normals, of any length, and positions.
    #[inline]
    fn points(&self, weights: &Weights, turned: bool) -> Points {
        let ([a, b, c], [da, db, dc]) = (weights, self.depths);
        let wa: Lanes<f32> = each!(lane => a[lane] * da);
        let wb: Lanes<f32> = each!(lane => b[lane] * db);
        let wc: Lanes<f32> = each!(lane => c[lane] * dc);
        let shares: Lanes<f32> = each!(lane => 1.0 / (wa[lane] + wb[lane] + wc[lane]));
        let side = if turned { -1.0 } else { 1.0 };
        let mut points = [[0.0; LANES]; 6];
        for axis in 0..3 {
            let [a, b, c] = self.normals;
            let (a, b, c) = (side * a[axis], side * b[axis], side * c[axis]);
            points[axis] = each!(lane => (a * wa[lane] + b * wb[lane] + c * wc[lane]) * shares[lane]);
            let [a, b, c] = self.positions;
            let (a, b, c) = (a[axis], b[axis], c[axis]);
            points[3 + axis] = each!(lane => (a * wa[lane] + b * wb[lane] + c * wc[lane]) * shares[lane]);
        }
        points
    }
}

/// The quadratic function of one channel.
#[derive(Clone, Copy, Default)]
struct Quadratic {
    corners: [f32; 3],
    /// Twice the second differences along the edges opposite the corners.
    bends: [f32; 3],
}

impl Quadratic {
    fn new(nodes: &Lanes<f32>) -> Self {
        let [fa, fb, fc, ma, mb, mc, ..] = *nodes;
        let bend = |from: f32, middle: f32, to: f32| 2.0 * (from - 2.0 * middle + to);
        Self { corners: [fa, fb, fc], bends: [bend(fb, ma, fc), bend(fc, mb, fa), bend(fa, mc, fb)] }
    }

    /// Bounds the function's distance from these values.
    #[inline(always)]
    fn off(&self, [a, b, c]: &Weights, values: &Lanes<f32>) -> f32 {
        let ([fa, fb, fc], [da, db, dc]) = (self.corners, self.bends);
        greatest(each!(lane => {
            let (a, b, c) = (a[lane], b[lane], c[lane]);
            let q = (fa * a + fb * b + fc * c) - (da * (b * c) + db * (c * a) + dc * (a * b));
            (q - values[lane]).abs()
        }))
    }

    /// How much it bends between the points of a grid that divides each edge into `n`.
    #[inline]
    fn between(&self, n: f32) -> f32 {
        // D is half of the greatest bend.
        greatest(three(self.bends, f32::abs)) / 3.0 / (n * n)
    }
}

compiled_for_each_level! {
    fn off_at_best[][](kernel: Kernel, curve: &Quadratic, weights: &Weights, values: &Lanes<f32>) -> f32 {
        curve.off(weights, values)
    }
}

/// Returns the greatest value; NaN if any is NaN.
#[inline(always)]
fn greatest<const N: usize>(values: [f32; N]) -> f32 {
    let (mut most, mut i) = (0.0, 0);
    while i < N {
        most = if values[i] <= most { most } else { values[i] };
        i += 1;
    }
    most
}

/// Narrows to f32; values beyond its range become infinite.
#[inline(always)]
fn narrow(wide: &Lanes<f64>) -> Lanes<f32> {
    each!(lane => wide[lane] as f32)
}

impl Faces<'_> {
    /// A face whose light may continue below the horizon.
    fn on_screen(&self, Face { indices, surface, back_facing, .. }: Face, depths: [u32; 3]) -> OnScreen<'_> {
        let normals = three(indices, |i| self.geometry.normals[i as usize]);
        let positions = three(indices, |i| self.geometry.positions[i as usize]);
        let reflectance = &self.materials[usize::from(surface)].reflectance;
        let mixed = |cosines: [f32; 3]| cosines.iter().any(|c| *c > 0.0) && cosines.iter().any(|c| *c < 0.0);
        let below = reflectance.specular == 0.0
            && match (self.lights.suns, self.lights.lamps) {
                ([sun], []) => mixed(three(normals, |normal| normal.dot(sun.towards))),
                ([], [lamp]) => {
                    let at = Vec3::from_array(lamp.position.map(|c| c as f32));
                    mixed(three([0, 1, 2], |i| normals[i].dot(at - positions[i])))
                }
                _ => false,
            };
        OnScreen {
            normals: if back_facing { three(normals, |normal| -normal) } else { normals },
            positions,
            // Rounded to 24 bits.
            depths: three(depths, |depth| depth as f32),
            reflectance,
            below,
        }
    }

    /// Light on each channel, or on the first, unclamped.
    #[inline]
    fn light_at(&self, face: &OnScreen<'_>, weights: &Weights) -> [Lanes<f32>; 3] {
        let front = self.front(face, weights, false);
        if !face.below {
            return front;
        }
        // One side has the light; the other has what remains without it, which is less.
        let back = self.front(face, weights, true);
        let mut both = [[0.0; LANES]; 3];
        for channel in 0..3 {
            let (front, back) = (&front[channel], &back[channel]);
            both[channel] = each!(lane => front[lane] - back[lane] + front[lane].min(back[lane]));
        }
        both
    }

    #[inline]
    fn front(&self, face: &OnScreen<'_>, weights: &Weights, turned: bool) -> [Lanes<f32>; 3] {
        let points = face.points(weights, turned);
        if self.stages.has_channels() {
            let [r, g, b] = self.lights.front_of_three_channels::<false>(face.reflectance, &points, self.kernel);
            [narrow(&r), narrow(&g), narrow(&b)]
        } else {
            let one = self.lights.front_of_one_channel::<false>(face.reflectance, &points, self.kernel);
            [narrow(&one), [0.0; LANES], [0.0; LANES]]
        }
    }

    /// The cheapest shading of a face that is known, from light at some of its points, to stay within the budget; if it
    /// is quadratic, with the light that its function goes through. `error` is the bound of shades that are linear on
    /// the face.
    #[inline(never)]
    pub(in crate::render) fn fit(
        &self,
        budget: &Budget,
        (face, error): (Face, f32),
        vertices: &[Vertex; 3],
    ) -> (FaceShading, Option<Nodes>) {
        let (depths, spare) = (three(vertices.each_ref(), Vertex::depth), budget.spare(EXACT_ROUNDING));
        let (near, far) = (depths[0].max(depths[1]).max(depths[2]), depths[0].min(depths[1]).min(depths[2]));
        let (ratio, (pixels, width)) = (near as f32 / far as f32, size_of(vertices));
        // If rounding uses up all that is allowed, nothing fits.
        if far == 0 || pixels < WORTH_CURVE || !self.stages.lights_pixels() || spare <= 0.0 {
            return (PHONG, None);
        }
        // The sizes of parts: four grids, then three spacings; the last is unused.
        let (mut part, mut bend) = ([1.0; LANES], [1.0; LANES]);
        for (lane, (n, _)) in GRIDS.iter().enumerate() {
            part[lane] = (2.155 * ratio - 1.155).min(1.155 * ratio) / n;
            bend[lane] = (ratio - 1.0) / (4.0 * n);
        }
        for (lane, spacing) in (GRIDS.len()..).zip(SampleSpacing::ALL) {
            let share = spacing.pixels() as f32 / width.max(1.0);
            (part[lane], bend[lane]) = (share * ratio, (ratio - 1.0) / 4.0 * share);
        }
        let mut on_screen = self.on_screen(face, depths);
        // Light is continued below the horizon only if no light and no material takes light away.
        on_screen.below &= budget.adds;
        // Eight points at a time, and the nodes.
        let pays = |points: &[Weights]| (LANES * (points.len() + 1)) as f32 * PIXELS_A_POINT <= pixels;
        let grids = GRIDS.iter().enumerate().take_while(|(grid, of)| *grid < 2 || pays(of.1)).count();
        let spaced = |lane: usize, spacing: SampleSpacing| {
            width >= WORTH_KNOTS.max(1.5 * spacing.pixels() as f32) && part[lane] <= 0.75
        };
        let spacings = (GRIDS.len()..).zip(SampleSpacing::ALL).filter(|(lane, spacing)| spaced(*lane, *spacing));
        let least = spacings.clone().map(|(lane, _)| part[lane]).fold(part[grids - 1], f32::min);
        // If light continues below the horizon, the face's bound says little.
        if !on_screen.below && error * least * least > HOPE * spare {
            return (PHONG, None);
        }
        let bounds = |below: bool| self.bounds_of_parts(budget, face, (part, bend), below).on_screen;
        let of_light = bounds(false);
        let smooth = if on_screen.below { bounds(true) } else { of_light };
        let left = each!(lane => if part[lane] < 1.0 { spare - smooth[lane] } else { 0.0 });
        if budget.adds
            && let Some(nodes) = self.quadratic(&on_screen, &GRIDS[..grids], (spare, &left))
        {
            return (FaceShading::Quadratic, Some(nodes));
        }
        let spacing = spacings.filter(|(lane, _)| of_light[*lane] <= spare).last();
        (spacing.map_or(PHONG, |(_, spacing)| FaceShading::PhongEvery(spacing)), None)
    }

    /// Tests the quadratic function on grids, from coarse to fine; returns the light that it goes through, if it fits.
    /// `spare` is the whole allowance, and `left` is what remains of it on each grid.
    fn quadratic(
        &self,
        face: &OnScreen<'_>,
        grids: &[(f32, &[Weights])],
        (spare, left): (f32, &Lanes<f32>),
    ) -> Option<Nodes> {
        let channels = if self.stages.has_channels() { 3 } else { 1 };
        let mut known = None;
        for (grid, (n, points)) in grids.iter().enumerate().filter(|(grid, _)| left[*grid] > (1.0 - MODEL) * spare) {
            let nodes: &Nodes = known.get_or_insert_with(|| self.light_at(face, &NODES));
            let curves = three(nodes.each_ref(), Quadratic::new);
            let between = greatest(three(curves, |curve| curve.between(*n)));
            let fits = |weights: &Weights| {
                let light = self.light_at(face, weights);
                let off = |channel: usize| off_at_best(self.kernel, &curves[channel], weights, &light[channel]);
                (0..channels).all(|channel| off(channel) <= left[grid] - between)
            };
            if between < left[grid] && points.iter().all(fits) {
                return known;
            }
        }
        None
    }

    /// The shades that a quadratic face goes through, for each of its corners: see `Attributes::lit`.
    pub(in crate::render) fn curve(&self, surface: u16, nodes: &Nodes) -> [[f32; 6]; 3] {
        let ramp = self.materials[usize::from(surface)].ramp;
        let (first, units) = (f32::from(ramp.first()) * 256.0, f32::from(ramp.entries().saturating_sub(1)) * 256.0);
        let mut curve = [[0.0; 6]; 3];
        for (corner, values) in curve.iter_mut().enumerate() {
            for (channel, light) in nodes.iter().enumerate() {
                values[channel] = first + light[corner] * units;
                values[channel + 3] = first + light[corner + 3] * units;
            }
        }
        curve
    }
}

/// The area of a triangle on the screen, and its widest row, in pixels.
fn size_of(vertices: &[Vertex; 3]) -> (f32, f32) {
    // In 1/256 pixel, and doubled.
    let area = doubled_area(vertices).unsigned_abs() as f32 / 131_072.0;
    let [a, b, c] = three(vertices.each_ref(), |vertex| vertex.y().to_bits());
    let height = a.max(b).max(c) - a.min(b).min(c);
    (area, if height == 0 { 0.0 } else { 512.0 * area / height as f32 })
}

/// The limits of quadratic shades: the shade without light, since no light is negative here, and
/// the last shade.
pub(in crate::render) fn limits(material: &SurfaceMaterial, channels: bool) -> [Limits; 3] {
    if channels {
        let Reflectance { ambient, color, .. } = material.reflectance;
        return color.map(|channel| Limits { least: material.shade(ambient * channel), most: U8F8::MAX_VERTEX });
    }
    // A ramp ends at entry 255 at most.
    let last = u16::from(material.ramp.first()) + material.ramp.entries().saturating_sub(1);
    let most = U8F8::from_bits(last.min(255) << 8);
    [Limits { least: material.constant(), most }; 3]
}
