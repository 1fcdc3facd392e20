//! Lights, materials, and the shade at a vertex, in integers.
//!
//! ```text
//! I = ka·Ia + kd · Σ over lights of Id·max(0, n·l)       clamped once, after the sum
//! shade = 256·first + round(I · (n − 1) · 256)           for a ramp of n entries
//! ```

use super::IntegerError;
use super::angle::SINE_BITS;
use super::vector::{Vector, dot, unit, widen};
use super::view::ObjectView;
use crate::fixed::{I16F16, U8F8};
use crate::palette::Ramp;

/// A sun: a light so far away that it comes from one direction everywhere.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Sun {
    /// **Towards** the light, in the scene; any length but zero.
    pub direction: Vector,
    /// Id, the intensity: 65,536 lights a white surface that faces it fully. It may be negative.
    pub intensity: I16F16,
}

impl Sun {
    /// The max number of suns in a scene: that many of the greatest intensity add up to less than 2⁶⁰.
    pub const MAX_COUNT: usize = 4096;

    pub(super) fn beam(&self, view: &ObjectView) -> Result<ObjectSun, IntegerError> {
        let world = unit(widen(self.direction).map(i128::from), SINE_BITS).ok_or(IntegerError::Light)?;
        Ok(ObjectSun { towards: view.direction_in_object(world), intensity: self.intensity })
    }
}

/// Storage for a sun transformed into object space.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct ObjectSun {
    /// The unit direction towards the light, in object space.
    towards: Vector,
    intensity: I16F16,
}

/// A surface's response to light, and its ramp in the palette.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Material {
    /// ka·Ia: the ambient light that the surface reflects.
    pub ambient: I16F16,
    /// kd: the share of a light that it reflects in all directions.
    pub diffuse: I16F16,
    /// The palette entries.
    pub ramp: Ramp,
}

impl Material {
    /// The shades of both sides: first that of the side that the unit `normal` points out of.
    #[inline]
    pub(super) fn shades(&self, beams: &[ObjectSun], normal: Vector) -> (U8F8, U8F8) {
        let normal = widen(normal);
        // With 32 fractional bits.
        let (mut front, mut back) = (0_i64, 0_i64);
        for beam in beams {
            // Below 2³³ for two vectors of length 1 within 2⁻¹⁴. Rounded to 16 bits it is below 2¹⁷; times 2³¹, for at
            // most 4,096 suns, below 2⁶⁰.
            let cosine = (dot(normal, widen(beam.towards)) + (1 << 15)) >> 16;
            let light = i64::from(beam.intensity.to_bits()) * cosine;
            if cosine > 0 {
                front += light;
            } else {
                back -= light;
            }
        }
        (self.shade(front), self.shade(back))
    }

    /// The shade under `light`, which has 32 fractional bits.
    #[inline]
    fn shade(&self, light: i64) -> U8F8 {
        // With 48 fractional bits: below 2³¹ · 2⁶⁰ + 2⁶³.
        let intensity =
            (i128::from(self.ambient.to_bits()) << 32) + i128::from(self.diffuse.to_bits()) * i128::from(light);
        // The only clamp: 0 to 2⁴⁸.
        let intensity = intensity.clamp(0, 1 << 48) as u64;
        // Entries are 1 to 256: the product is at most 2⁴⁸ · 65,280, which is 2⁵⁶ less than 2⁶⁴.
        let above = (intensity * u64::from(self.ramp.entries() - 1) * 256 + (1 << 47)) >> 48;
        // At most 0xFF00: the ramp ends at entry 255.
        U8F8::from_bits((u64::from(self.ramp.first()) * 256 + above) as u16)
    }
}
