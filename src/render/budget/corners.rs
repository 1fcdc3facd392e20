//! Corners of faces, for decisions: their distance from the highlights, and the lights that they see. Eight vertices
//! are worked out at a time in plain arrays that the compiler vectorises.

use glam::Vec3;

use super::eight::{NOUGHT, Vectors, dot, square_root};
use super::light::narrow;
use super::{Budget, LIGHTS, Lit};
use crate::lanes::{LANES, Lanes};
use crate::light::Lights;
use crate::simd::at_best_level;
use crate::span::Kernel;

/// The normal and the position of each vertex of a mesh.
#[derive(Clone, Copy)]
struct Corners<'a> {
    normals: &'a [Vec3],
    positions: &'a [Vec3],
}

/// Least distances of the eye, and of any lamp, from a vertex.
struct Nearest {
    eye: f32,
    lamp: f32,
}

impl Corners<'_> {
    /// The chord between the eye and the mirrored light that is nearest to it, of each vertex.
    #[inline(always)]
    fn chords(self, lights: &Lights<'_>, chords: &mut [f32]) -> Nearest {
        let (mut nearest_eye, mut nearest_lamp) = ([f32::INFINITY; LANES], [f32::INFINITY; LANES]);
        let eights = self.normals.chunks(LANES).zip(self.positions.chunks(LANES));
        for ((normals, positions), chords) in eights.zip(chords.chunks_mut(LANES)) {
            let (normals, positions) = (transposed(normals), transposed(positions));
            let eye = towards(narrow(lights.eye), &positions, &mut nearest_eye);
            let facing = dot(&normals, &eye);
            let mut most = [-1.0; LANES];
            for sun in lights.suns {
                let towards = sun.towards.to_array().map(|axis| [axis; LANES]);
                nearer(&mut most, &normals, &towards, (&eye, &facing));
            }
            for lamp in lights.lamps {
                let towards = towards(narrow(lamp.position), &positions, &mut nearest_lamp);
                nearer(&mut most, &normals, &towards, (&eye, &facing));
            }
            let mut eight = NOUGHT;
            for (chord, along) in eight.iter_mut().zip(&most) {
                let square = 2.0 - 2.0 * along;
                *chord = square_root(if square > 0.0 { square } else { 0.0 });
            }
            chords.copy_from_slice(&eight[..chords.len()]);
        }
        let least = |of: Lanes<f32>| of.into_iter().fold(f32::INFINITY, f32::min);
        Nearest { eye: least(nearest_eye), lamp: least(nearest_lamp) }
    }

    /// Marks each vertex with those of the first lights that its front sees.
    #[inline(always)]
    fn mark(self, lights: &Lights<'_>, flags: &mut [u8]) {
        let eights = self.normals.chunks(LANES).zip(self.positions.chunks(LANES));
        for ((normals, positions), flags) in eights.zip(flags.chunks_mut(LANES)) {
            let (normals, positions) = (transposed(normals), transposed(positions));
            let mut bits = [0_u32; LANES];
            for (i, sun) in (0..LIGHTS).zip(lights.suns) {
                let towards = sun.towards.to_array().map(|axis| [axis; LANES]);
                see(&mut bits, &dot(&normals, &towards), i);
            }
            for (i, lamp) in (lights.suns.len()..LIGHTS).zip(lights.lamps) {
                see(&mut bits, &dot(&normals, &ways(narrow(lamp.position), &positions)), i);
            }
            for (flags, bits) in flags.iter_mut().zip(bits) {
                // Seven bits.
                *flags |= bits as u8;
            }
        }
    }
}

/// The cosine between eye and mirrored light, where it is greater than of any light before.
#[inline(always)]
fn nearer(most: &mut Lanes<f32>, normals: &Vectors, light: &Vectors, (eye, facing): (&Vectors, &Lanes<f32>)) {
    let (cosines, between) = (dot(normals, light), dot(light, eye));
    for lane in 0..LANES {
        let along = 2.0 * cosines[lane] * facing[lane] - between[lane];
        // Not a number is the nearest.
        most[lane] = if along <= most[lane] { most[lane] } else { along };
    }
}

#[inline(always)]
fn see(bits: &mut Lanes<u32>, cosines: &Lanes<f32>, light: usize) {
    for (bits, cosine) in bits.iter_mut().zip(cosines) {
        *bits |= if *cosine > 0.0 { 1 << light } else { 0 };
    }
}

impl Budget {
    /// Finds out how far highlights are from the vertices, and what edges turn the directions to eye and lamps by.
    #[inline(never)]
    pub(super) fn find_chords(&mut self, object: &Lit<'_>) {
        let corners = Corners { normals: object.geometry.normals, positions: object.geometry.positions };
        self.chords.clear();
        self.chords.resize(corners.normals.len(), 0.0);
        let nearest = chords_of(corners, object.lights, &mut self.chords, object.kernel);
        (self.eye_turn, self.lamp_turn) = (1.0 / nearest.eye, 1.0 / nearest.lamp);
    }
}

/// Marks the vertices with the lights that their fronts see.
pub(super) fn mark(object: &Lit<'_>, flags: &mut [u8]) {
    let corners = Corners { normals: object.geometry.normals, positions: object.geometry.positions };
    at_best_level!(object.kernel, corners.mark(object.lights, flags));
}

fn chords_of(corners: Corners<'_>, lights: &Lights<'_>, chords: &mut [f32], kernel: Kernel) -> Nearest {
    at_best_level!(kernel, corners.chords(lights, chords))
}

/// Up to eight; what is missing is the last again.
#[inline(always)]
fn transposed(of: &[Vec3]) -> Vectors {
    let mut vectors = [NOUGHT; 3];
    let eight = <[Vec3; LANES]>::try_from(of).unwrap_or_else(|_| {
        let last = of.last().copied().unwrap_or_default();
        core::array::from_fn(|lane| of.get(lane).copied().unwrap_or(last))
    });
    for (lane, v) in eight.iter().enumerate() {
        (vectors[0][lane], vectors[1][lane], vectors[2][lane]) = (v.x, v.y, v.z);
    }
    vectors
}

/// Returns the ways from places to `to`.
#[inline(always)]
pub(super) fn ways(to: Vec3, places: &Vectors) -> Vectors {
    let mut ways = *places;
    for (values, to) in ways.iter_mut().zip(to.to_array()) {
        for value in values {
            *value = to - *value;
        }
    }
    ways
}

/// Unit directions from places to `to`. Each lane of `nearest` becomes the min of itself and the distance.
#[inline(always)]
fn towards(to: Vec3, places: &Vectors, nearest: &mut Lanes<f32>) -> Vectors {
    let mut ways = ways(to, places);
    let squares = dot(&ways, &ways);
    let mut parts = NOUGHT;
    for (lane, square) in squares.iter().enumerate() {
        let distance = square_root(*square);
        nearest[lane] = if distance < nearest[lane] { distance } else { nearest[lane] };
        parts[lane] = 1.0 / distance;
    }
    for values in &mut ways {
        for (value, part) in values.iter_mut().zip(&parts) {
            *value *= part;
        }
    }
    ways
}
