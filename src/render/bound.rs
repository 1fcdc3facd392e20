//! Bounds of the error of linear shades against light at every pixel, from normals, lights and vertices.
//!
//! Over a triangle a linear shade lies between those of the three vertices, wherever on it and however it
//! is interpolated. Light worked out at a point of the triangle, with a normal between the vertices', lies
//! between bounds too:
//!
//! - A normal between three unit normals is no farther from each of them, as an angle, than the two that
//!   are farthest apart. So n·l, which is cos θ at a vertex, lies within cos(θ ± σ), σ being that angle and
//!   the one by which the direction to the light turns over the triangle.
//! - A mirrored ray turns by twice what its normal does, and by what light and eye do.
//! - A lamp's distance changes by no more than the longest edge; seen from a distance d, an edge L long
//!   turns a direction by no more than asin(L / d).
//!
//! Each vertex gives such a range; the light lies in all three.

use glam::Vec3;

use super::paint::SurfaceMaterial;
use super::vertex::Geometry;
use crate::light::Lights;

const PI: f64 = core::f64::consts::PI;

/// A range of numbers.
#[derive(Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    const fn of(value: f64) -> Self {
        Self { low: value, high: value }
    }

    fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    fn times(self, other: Self) -> Self {
        let products = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Self {
            low: products.iter().copied().fold(f64::INFINITY, f64::min),
            high: products.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// max(0, cos)^power over all angles within `turn` of `angle`.
fn cosines(angle: f64, turn: f64, power: f64) -> Range {
    let at = |angle: f64| {
        let cosine = if angle >= PI / 2.0 { 0.0 } else { libm::cos(angle) };
        if power == 1.0 { cosine } else { libm::pow(cosine, power) }
    };
    Range { low: at((angle + turn).min(PI)), high: at((angle - turn).max(0.0)) }
}

fn widen(v: Vec3) -> [f64; 3] {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(v: [f64; 3]) -> f64 {
    libm::sqrt(dot(v, v))
}

/// The angle between two directions; of one without direction anything, so half a turn's middle.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let lengths = length(a) * length(b);
    if lengths > 0.0 { libm::acos((dot(a, b) / lengths).clamp(-1.0, 1.0)) } else { PI / 2.0 }
}

/// Returns the angle by which the direction to a point at `distance` turns along an edge of `edge`.
fn turn(edge: f64, distance: f64) -> f64 {
    if edge < distance { libm::asin(edge / distance) } else { PI }
}

/// A triangle on one of its sides.
struct Face {
    positions: [[f64; 3]; 3],
    normals: [[f64; 3]; 3],
    /// The greatest angle between two normals.
    spread: f64,
    longest: f64,
}

impl Face {
    /// The light at any point of the face, by what it is at vertex `i`, not clamped.
    fn light(&self, i: usize, lights: &Lights<'_>, paint: &SurfaceMaterial) -> Range {
        let answer = &paint.answer;
        let (at, normal) = (self.positions[i], self.normals[i]);
        let to_eye = sub(lights.eye, at);
        let eye_turn = turn(self.longest, length(to_eye));
        let mut sum = Range::of(answer.ambient);
        let mut add = |towards: [f64; 3], light_turn: f64, strength: Range| {
            let theta = angle(normal, towards);
            let cosine = cosines(theta, self.spread + light_turn, 1.0);
            sum = sum.plus(cosine.times(strength).times(Range::of(answer.diffuse)));
            if answer.specular != 0.0 {
                let unit = |v: [f64; 3]| {
                    let length = length(v);
                    if length > 0.0 { v.map(|c| c / length) } else { v }
                };
                let (l, v) = (unit(towards), unit(to_eye));
                let along = 2.0 * dot(normal, l) * dot(normal, v) - dot(l, v);
                let mirrored = libm::acos(along.clamp(-1.0, 1.0));
                let mut highlight = cosines(mirrored, 2.0 * self.spread + light_turn + eye_turn, answer.shininess);
                // Behind the face there is none, and it begins at once where the light comes round the edge.
                if theta + self.spread + light_turn >= PI / 2.0 {
                    highlight.low = 0.0;
                }
                if theta - self.spread - light_turn >= PI / 2.0 {
                    highlight.high = 0.0;
                }
                sum = sum.plus(highlight.times(strength).times(Range::of(answer.specular)));
            }
        };
        for sun in lights.suns {
            add(widen(sun.towards), 0.0, Range::of(f64::from(sun.intensity)));
        }
        for lamp in lights.lamps {
            let towards = sub(lamp.position, at);
            let distance = length(towards);
            let fall_off = |distance: f64| {
                let left = (1.0 - distance * distance * lamp.inverse_square).max(0.0);
                left * left
            };
            let nearest = (distance - self.longest).max(0.0);
            let fall_off = Range { low: fall_off(distance + self.longest), high: fall_off(nearest) };
            let strength = fall_off.times(Range::of(f64::from(lamp.intensity)));
            add(towards, turn(self.longest, distance), strength);
        }
        sum
    }

    /// Bounds the error of linear shades, in shares of full intensity.
    fn error(&self, lights: &Lights<'_>, paint: &SurfaceMaterial, shades: [f64; 3]) -> f64 {
        let shown = |intensity: f64| intensity.clamp(0.0, 1.0);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for i in 0..3 {
            let range = self.light(i, lights, paint);
            low = low.max(shown(range.low));
            high = high.min(shown(range.high));
        }
        let shades = shades.map(shown);
        let least = shades.iter().copied().fold(1.0, f64::min);
        let most = shades.iter().copied().fold(0.0, f64::max);
        (high - least).max(most - low).max(0.0)
    }
}

/// No pixel of the object is farther than this, in shades of 1/255 of full intensity, from what light at
/// every pixel, or at the vertices of its faces split, would make of it, rounding aside.
#[inline(never)]
pub(super) fn linear_error(
    geometry: &Geometry<'_>,
    lights: &Lights<'_>,
    paints: &[SurfaceMaterial],
    two_sided: bool,
) -> f64 {
    let mut greatest = 0.0_f64;
    for (triangle, &surface) in geometry.triangles.iter().zip(geometry.triangle_surfaces) {
        let paint = &paints[usize::from(surface)];
        let positions = triangle.map(|i| geometry.positions[i as usize]);
        let normals = triangle.map(|i| geometry.normals[i as usize]);
        let wide = positions.map(widen);
        let edges = [(0, 1), (1, 2), (2, 0)];
        let longest = edges.iter().map(|&(i, j)| length(sub(wide[i], wide[j]))).fold(0.0, f64::max);
        let spread = edges.iter().map(|&(i, j)| angle(widen(normals[i]), widen(normals[j]))).fold(0.0, f64::max);
        let both = [0, 1, 2].map(|i| lights.one_channel(&paint.answer, positions[i], normals[i]));
        let front = Face { positions: wide, normals: normals.map(widen), spread, longest };
        greatest = greatest.max(front.error(lights, paint, both.map(|(front, _)| front)));
        if two_sided {
            let back = Face { normals: normals.map(|n| widen(-n)), ..front };
            greatest = greatest.max(back.error(lights, paint, both.map(|(_, back)| back)));
        }
    }
    greatest * 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point twice as far as the edge is long is seen at most 30° off; one as near as that, from any side.
    #[test]
    fn directions_turn_by_the_arcsine() {
        assert!((turn(1.0, 2.0) - PI / 6.0).abs() < 1e-15);
        assert!(turn(1.0, 1e9) < 1.1e-9);
        assert_eq!([turn(2.0, 1.0), turn(0.5, 0.0)], [PI; 2]);
    }
}
