//! Per-pixel lighting: the Russian article's Phong shading, and the table that stood in for it in 1994.

use super::surface_material::SurfaceMaterial;
use crate::fixed::U8F8;
use crate::lanes::{LANES, Lanes, Points, each};
use crate::light::Lights;
use crate::palette::{Lut64K, Ramp};
use crate::raster::effects::PixelLighting;
use crate::span::Kernel;

/// One surface of an object, lit pixel by pixel in object space.
///
/// Where the normals at two ends cancel, no normal is left between them, and only ambient light remains.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelLight<'a> {
    pub(super) lights: Lights<'a>,
    pub(super) material: &'a SurfaceMaterial,
    pub(super) kernel: Kernel,
}

impl PixelLight<'_> {
    /// The shades of eight intensities on the material's ramp, or on that of a channel.
    #[inline(always)]
    fn shown(&self, ramp: Ramp, intensities: &Lanes<f64>) -> Lanes<u16> {
        let shades = SurfaceMaterial::shade_of_eight(ramp, intensities);
        if self.material.response.is_some() {
            return each!(lane => self.material.respond(shades[lane]).to_bits());
        }
        each!(lane => shades[lane].to_bits())
    }
}

impl PixelLighting for PixelLight<'_> {
    #[inline(never)]
    fn shades(&self, points: &Points) -> Lanes<u16> {
        let intensities = self.lights.front_of_one_channel::<false>(&self.material.reflectance, points, self.kernel);
        self.shown(self.material.ramp, &intensities)
    }

    #[inline(never)]
    fn channels(&self, points: &Points) -> [Lanes<u16>; 3] {
        let [red, green, blue] =
            self.lights.front_of_three_channels::<false>(&self.material.reflectance, points, self.kernel);
        // Without a closure, which would not be inlined.
        [self.shown(Ramp::WHOLE, &red), self.shown(Ramp::WHOLE, &green), self.shown(Ramp::WHOLE, &blue)]
    }
}

/// Fills `table` with the shade of every normal that the eye may see: column and row are the normal's x and y, from −1
/// to 1; its z points toward the eye and completes unit length. Beyond the circle the normal on its rim is used.
///
/// The light is in eye space, with the eye far away on z.
#[inline(never)]
pub(super) fn fill_normal_table(table: &mut Lut64K, light: &PixelLight<'_>) {
    let at = |step: u8| (f32::from(step) - 127.5) / 127.5;
    table.fill_by_eights(|row, first| {
        // At most 248 + 7.
        let (x, y): (Lanes<f32>, f32) = (each!(lane => at(first + lane as u8)), at(row));
        let z = x.map(|x| libm::sqrtf((1.0 - x * x - y * y).max(0.0)));
        let shades = light.shades(&[x, [y; LANES], z, [0.0; LANES], [0.0; LANES], [0.0; LANES]]);
        each!(lane => U8F8::from_bits(shades[lane]).nearest())
    });
}
