//! Light sources.

use crate::Angle;
use glam::Vec3;

/// A light source.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Light {
    /// A sun, so far away that its light comes from the same direction everywhere.
    Sun {
        /// Towards the light, in the world; any length but zero.
        direction: Vec3,
        /// Id, the intensity: 1 lights a white surface that faces it fully.
        intensity: f32,
        /// Red, green, blue, usually 0 to 1.
        color: [f32; 3],
    },
    /// A lamp: a light with a position that falls off with the distance (the Russian textbook: the flash of a shot on a
    /// wall).
    ///
    /// At a distance d below `range` the intensity is scaled by (1 − d²/range²)², which is 1 at the
    /// lamp itself and 9/16 at half the range. Beyond `range` it is 0; it fades out without an
    /// edge.
    Lamp {
        /// The lamp's position, in the world.
        position: Vec3,
        /// Id, the intensity at the lamp itself.
        intensity: f32,
        /// The distance that it reaches, in the world's units; above 0.
        range: f32,
        /// Red, green, blue, usually 0 to 1.
        color: [f32; 3],
        /// The cone of a spot light; `None` for a lamp that shines in all directions.
        cone: Option<Cone>,
    },
}

/// The cone of a spot light.
///
/// Light is at full intensity within `inner` and zero beyond `outer`. In between, the share depends on the cosine of
/// the angle θ to `direction`:
///
/// ```text
/// x     = (cos θ − cos outer) / (cos inner − cos outer), clamped to 0 … 1
/// share = x²·(3 − 2x)
/// ```
///
/// This is the `smoothstep` of RenderMan's spot light (S. Upstill, *The RenderMan Companion*, 1990), which has no edge
/// at either end. Cosines less than 2⁻¹⁶ apart count as 2⁻¹⁶ apart, so equal angles make a sharp edge.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cone {
    /// The direction away from the light, in the world; any length but zero.
    pub direction: Vec3,
    /// The half-angle of full intensity; at most `outer`.
    pub inner: Angle,
    /// The half-angle beyond which there is no light: above 0, at most 90 degrees.
    pub outer: Angle,
}

/// Plain white.
const WHITE: [f32; 3] = [1.0; 3];

impl Light {
    /// A white sun of intensity 1 in `direction`, which points **towards** it; any length but zero.
    #[must_use]
    pub fn sun(direction: impl Into<Vec3>) -> Self {
        Self::Sun { direction: direction.into(), intensity: 1.0, color: WHITE }
    }

    /// A white lamp of intensity 1 at `position`, with a range above 0.
    #[must_use]
    pub fn lamp(position: impl Into<Vec3>, range: f32) -> Self {
        Self::Lamp { position: position.into(), intensity: 1.0, range, color: WHITE, cone: None }
    }

    /// A white spot light of intensity 1: a lamp at `position` with a range above 0, limited to `cone`.
    ///
    /// On large faces its edge shows only if light is computed inside them, too: see
    /// [`Settings`](crate::settings::Settings).
    #[must_use]
    pub fn spot(position: impl Into<Vec3>, range: f32, cone: Cone) -> Self {
        Self::Lamp { position: position.into(), intensity: 1.0, range, color: WHITE, cone: Some(cone) }
    }

    /// Sets the light's intensity.
    #[must_use]
    pub fn with_intensity(mut self, new: f32) -> Self {
        match &mut self {
            Self::Sun { intensity, .. } | Self::Lamp { intensity, .. } => *intensity = new,
        }
        self
    }

    /// Sets the light's colour: red, green, blue, usually 0 to 1, or an [`Rgb`](crate::palette::Rgb).
    #[must_use]
    pub fn with_color(mut self, new: impl Into<[f32; 3]>) -> Self {
        match &mut self {
            Self::Sun { color, .. } | Self::Lamp { color, .. } => *color = new.into(),
        }
        self
    }

    /// Turns a sun or a spot light. The direction points towards a sun, but away from a spot light. A lamp that shines
    /// in all directions is left as it is.
    ///
    /// ```
    /// use mode13h::Angle;
    /// use mode13h::glam::Vec3;
    /// use mode13h::light::{Cone, Light};
    ///
    /// let [inner, outer] = [10.0, 15.0].map(Angle::from_degrees);
    /// let mut light = Light::spot([0.0, 4.0, 0.0], 9.0, Cone { direction: -Vec3::Y, inner, outer });
    /// light.aim([0.3, -1.0, 0.0]);
    /// assert!(matches!(light, Light::Lamp { cone: Some(Cone { direction, .. }), .. } if direction.x == 0.3));
    /// ```
    pub fn aim(&mut self, direction: impl Into<Vec3>) {
        match self {
            Self::Sun { direction: of, .. } | Self::Lamp { cone: Some(Cone { direction: of, .. }), .. } => {
                *of = direction.into()
            }
            Self::Lamp { cone: None, .. } => {}
        }
    }

    /// Returns the light's intensity.
    #[must_use]
    pub fn intensity(&self) -> f32 {
        match *self {
            Self::Sun { intensity, .. } | Self::Lamp { intensity, .. } => intensity,
        }
    }

    /// Returns the light's red, green and blue.
    #[must_use]
    pub fn color(&self) -> [f32; 3] {
        match *self {
            Self::Sun { color, .. } | Self::Lamp { color, .. } => color,
        }
    }

    /// Returns the intensity for lighting on one channel: for a coloured light, times its luminance per ITU-R BT.601.
    #[must_use]
    pub fn brightness(&self) -> f32 {
        let color = self.color();
        let share = if self.is_colored() { luminance(color) } else { color[0] };
        share * self.intensity()
    }

    /// Returns whether its three channels differ, so that it needs lighting on three channels.
    #[must_use]
    pub fn is_colored(&self) -> bool {
        is_colored(self.color())
    }

    /// Checks the light; the error says what is wrong.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let not_finite = match self {
            Self::Sun { .. } => "its direction, intensity and colour must be finite",
            Self::Lamp { .. } => "its position, intensity, range and colour must be finite",
        };
        if !(self.intensity().is_finite() && self.color().iter().all(|c| c.is_finite())) {
            return Err(not_finite);
        }
        // The sum of an infinity and a number of the opposite sign would be NaN.
        let is_held = |share: f32| (share * self.intensity()).is_finite();
        if !(self.color().into_iter().all(is_held) && self.brightness().is_finite()) {
            return Err("its intensity times its colour must be finite");
        }
        match *self {
            Self::Sun { direction, .. } if !direction.is_finite() => Err(not_finite),
            Self::Sun { direction, .. } if direction == Vec3::ZERO => Err("its direction must not be zero"),
            Self::Lamp { position, range, .. } if !(position.is_finite() && range.is_finite()) => Err(not_finite),
            Self::Lamp { range, .. } if range <= 0.0 => Err("its range must be above 0"),
            Self::Lamp { cone: Some(cone), .. } => cone.check(),
            _ => Ok(()),
        }
    }
}

impl Cone {
    fn check(&self) -> Result<(), &'static str> {
        let (inner, outer) = (self.inner.to_radians(), self.outer.to_radians());
        if !self.direction.is_finite() {
            Err("the direction of its cone must be finite")
        } else if self.direction == Vec3::ZERO {
            Err("the direction of its cone must not be zero")
        } else if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= core::f64::consts::FRAC_PI_2) {
            Err("the angles of its cone must be 0 <= inner <= outer, and outer above 0 and at most 90 degrees")
        } else {
            Ok(())
        }
    }
}

/// The luminance after ITU-R BT.601, the weights of a television of the time.
pub(super) fn luminance([red, green, blue]: [f32; 3]) -> f32 {
    0.299 * red + 0.587 * green + 0.114 * blue
}

/// Returns whether the three channels differ.
pub(super) fn is_colored([red, green, blue]: [f32; 3]) -> bool {
    red != green || green != blue
}
