//! Motions in a scene, computed from absolute time, never by accumulating small steps.
//!
//! Frame n does not depend on whether the frames before it were drawn; a step of an hour, or backwards, works like any
//! other.

use core::f64::consts::TAU;

use glam::Vec3;

use super::{LightId, ObjectId};
use crate::angle::Angle;
use crate::mesh::wide::widen;

/// Something in a scene that moves.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Motion {
    /// An object turns about its pivot.
    Spin {
        /// The object.
        object: ObjectId,
        /// Its angles about x, y and z at time 0.
        start: [Angle; 3],
        /// Turns per second about x, y and z. Whole turns per loop make an animation seamless. A scene file's `spin`
        /// is in turns per loop: it is divided by [`Scene::duration`](super::Scene::duration).
        turns: [f64; 3],
    },
    /// Something moves along a path.
    Path {
        /// The thing that moves.
        what: Moving,
        /// The path that it moves along.
        path: Path,
    },
}

/// A thing that can move along a path.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Moving {
    /// An object's position.
    Object(ObjectId),
    /// A lamp's position, or the direction of a sun. A spot light keeps its direction; [`Light::aim`] changes it.
    ///
    /// [`Light::aim`]: crate::light::Light::aim
    Light(LightId),
    /// The camera's eye.
    Eye,
    /// The point that the camera looks at.
    Target,
}

/// A path with its period.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Path {
    /// Straight from one point to another, then again from the first.
    Line {
        /// The starting point.
        from: Vec3,
        /// The end point.
        to: Vec3,
        /// The period, in seconds; above 0.
        period: f64,
        /// Whether the path returns the same way; then there and back together take one period.
        back: bool,
    },
    /// Around an axis through a point.
    Circle {
        /// The centre.
        centre: Vec3,
        /// The radius vector to the starting point; from there it turns towards `towards`.
        from: Vec3,
        /// The radius vector a quarter of the way around.
        towards: Vec3,
        /// The time of one revolution, in seconds; above 0.
        period: f64,
    },
}

impl Path {
    /// The point at a time in seconds; the starting point if the period is not above 0 or the time is not finite.
    #[must_use]
    pub fn at(&self, seconds: f64) -> Vec3 {
        let (Self::Line { period, .. } | Self::Circle { period, .. }) = *self;
        let part = if period > 0.0 { part(seconds, period) } else { 0.0 };
        match *self {
            Self::Line { from, to, back, .. } => {
                let part = match back {
                    true if part > 0.5 => 2.0 - 2.0 * part,
                    true => 2.0 * part,
                    false => part,
                };
                let between = |a: f32, b: f32| (f64::from(a) * (1.0 - part) + f64::from(b) * part) as f32;
                Vec3::new(between(from.x, to.x), between(from.y, to.y), between(from.z, to.z))
            }
            Self::Circle { centre, from, towards, .. } => {
                let (sine, cosine) = libm::sincos(part * TAU);
                let [centre, from, towards] = [centre, from, towards].map(widen);
                Vec3::from_array([0, 1, 2].map(|i| (centre[i] + from[i] * cosine + towards[i] * sine) as f32))
            }
        }
    }
}

/// The fraction of the current period that has passed: at least 0, below 1.
pub(super) fn part(seconds: f64, period: f64) -> f64 {
    let periods = seconds / period;
    let part = periods - libm::floor(periods);
    // 0 for a value that is not finite, and where rounding makes it 1.
    if part < 1.0 { part } else { 0.0 }
}

/// The angles at a time: `start` plus `turns` per second. Whole turns are removed first, so no precision is lost at
/// late times.
pub(super) fn spun(start: [Angle; 3], turns: [f64; 3], seconds: f64) -> [Angle; 3] {
    core::array::from_fn(|i| {
        if turns[i] == 0.0 { start[i] } else { start[i] + Angle::TURN * part(seconds, 1.0 / turns[i]) }
    })
}
