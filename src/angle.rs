//! Angles.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// An angle of any size (two full turns are not the same as none), made from degrees or radians and stored in radians.
///
/// ```
/// use mode13h::Angle;
/// let eighth = Angle::from_degrees(45.0);
/// assert_eq!(eighth + eighth, Angle::from_degrees(90.0));
/// assert_eq!(eighth.to_degrees(), 45.0);
/// assert_eq!(eighth.to_radians(), std::f64::consts::FRAC_PI_4);
/// ```
#[derive(Clone, Copy, PartialEq, PartialOrd, Debug, Default)]
pub struct Angle(f64);

impl Angle {
    /// A full turn: 360°.
    pub(crate) const TURN: Self = Self(core::f64::consts::TAU);

    /// Makes an angle from degrees.
    #[must_use]
    pub const fn from_degrees(degrees: f64) -> Self {
        Self(degrees.to_radians())
    }

    /// Makes an angle from radians.
    #[must_use]
    pub const fn from_radians(radians: f64) -> Self {
        Self(radians)
    }

    /// Returns the angle in degrees.
    #[must_use]
    pub const fn to_degrees(self) -> f64 {
        self.0.to_degrees()
    }

    /// Returns the angle in radians.
    #[must_use]
    pub const fn to_radians(self) -> f64 {
        self.0
    }
}

impl Add for Angle {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl AddAssign for Angle {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl Sub for Angle {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl SubAssign for Angle {
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl Mul<f64> for Angle {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl Div<f64> for Angle {
    type Output = Self;

    fn div(self, divisor: f64) -> Self {
        Self(self.0 / divisor)
    }
}

impl Neg for Angle {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}
