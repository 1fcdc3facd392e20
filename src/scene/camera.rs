//! The camera.

use glam::Vec3;

use crate::angle::Angle;

/// A perspective camera.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    /// The position of the eye.
    pub eye: Vec3,
    /// The point that it looks at, in the middle of the picture.
    pub target: Vec3,
    /// The direction that is up in the picture. If it is parallel to the view, another axis is used.
    pub up: Vec3,
    /// The vertical field of view; above 0, below 180°.
    pub field_of_view: Angle,
    /// The near distance, in the scene's units, above 0: nothing nearer is drawn. It also sets the unit of depth, so do
    /// not make it much smaller than needed.
    pub near: f32,
}

impl Camera {
    /// The vertical field of view of [`framing`](Self::framing): 40°, rounded to an f32.
    pub const FIELD_OF_VIEW: Angle = Angle::from_radians((40.0 * core::f32::consts::PI / 180.0) as f64);

    /// The fraction of the picture's height that a framed sphere fills.
    const FILL: f32 = 15.0 / 16.0;

    /// Makes a camera looking along −z at a sphere, which fills fifteen sixteenths of the picture's height.
    #[must_use]
    pub fn framing(centre: Vec3, radius: f32) -> Self {
        // Half the angle that the sphere subtends, and the distance at which its sine gives the radius. The distance is
        // at most f32::MAX, so even a sphere of that size is in front of the eye; at least far enough that the eye
        // differs from the centre in f32.
        let half = libm::atanf(Self::FILL * libm::tanf(Self::FIELD_OF_VIEW.to_radians() as f32 / 2.0));
        let least = (centre.z.abs() / 1_048_576.0).max(f32::MIN_POSITIVE);
        let distance = (radius / libm::sinf(half)).clamp(least, f32::MAX);
        let eye = (centre + Vec3::Z * distance).clamp(Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX));
        let near = Self::near_for(distance);
        Self { eye, target: centre, up: Vec3::Y, field_of_view: Self::FIELD_OF_VIEW, near }
    }

    /// The near distance that suffices for a target at this distance: 1/128 of it.
    #[must_use]
    pub fn near_for(distance: f32) -> f32 {
        (distance / 128.0).max(f32::MIN_POSITIVE)
    }
}

impl Default for Camera {
    /// The camera that looks along −z at the unit sphere around the origin, into which every built-in shape fits.
    fn default() -> Self {
        Self::framing(Vec3::ZERO, 1.0)
    }
}
