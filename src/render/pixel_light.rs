//! Light at every pixel: S1's Phong, and the table that stood in for it in 1994.

use glam::Vec3;

use super::paint::Paint;
use crate::light::Lights;
use crate::mesh::normals::unit;
use crate::palette::Table;
use crate::raster::effects::Lighting;

/// One surface of an object, lit pixel by pixel in the object's own space.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelLight<'a> {
    pub(super) lights: Lights<'a>,
    pub(super) paint: &'a Paint,
}

impl PixelLight<'_> {
    /// The position and the unit normal of a point. Where the normals of two ends cancel there is none:
    /// no light falls there but the ambient.
    fn point(point: &[f32; 6]) -> (Vec3, Vec3) {
        let [nx, ny, nz, x, y, z] = *point;
        (Vec3::new(x, y, z), unit(Vec3::new(nx, ny, nz)).unwrap_or(Vec3::ZERO))
    }
}

impl Lighting for PixelLight<'_> {
    #[inline(never)]
    fn shades(&self, points: &[[f32; 6]], shades: &mut [u16]) {
        for (point, shade) in points.iter().zip(shades) {
            let (position, normal) = Self::point(point);
            let (front, _) = self.lights.one_channel(&self.paint.answer, position, normal);
            *shade = self.paint.shade(front).to_bits();
        }
    }

    #[inline(never)]
    fn channels(&self, points: &[[f32; 6]], [red, green, blue]: [&mut [u16]; 3]) {
        for (((point, red), green), blue) in points.iter().zip(red).zip(green).zip(blue) {
            let (position, normal) = Self::point(point);
            let (front, _) = self.lights.three_channels(&self.paint.answer, position, normal);
            let channels = Paint::channels(front);
            [*red, *green, *blue] = channels.map(|channel| channel.to_bits());
        }
    }
}

/// The shade for every normal that the eye may see: column and row are the normal's x and y, from −1 to
/// 1; the rest of its length points towards the eye. Beyond the circle the normal on its rim counts.
///
/// `lights` are in the eye's space, the eye far away on z.
#[inline(never)]
pub(super) fn normal_table(lights: &Lights<'_>, paint: &Paint) -> Table {
    Table::from_fn(|row, column| {
        let at = |step: u8| (f32::from(step) - 127.5) / 127.5;
        let (x, y) = (at(column), at(row));
        let z = libm::sqrtf((1.0 - x * x - y * y).max(0.0));
        let normal = unit(Vec3::new(x, y, z)).unwrap_or(Vec3::Z);
        let (front, _) = lights.one_channel(&paint.answer, Vec3::ZERO, normal);
        paint.shade(front).nearest()
    })
}
