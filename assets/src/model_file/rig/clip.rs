//! Keyframes: which nodes move, and how.

use core::fmt;
use std::error::Error;

use crate::model_file::word::shown;

/// An animation of a model: some of its nodes, moving for a while.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    pub(super) name: String,
    /// The time of the last key, in seconds.
    pub(super) duration: f64,
    pub(super) samplers: Vec<Sampler>,
    pub(super) channels: Vec<Channel>,
}

impl Clip {
    /// A clip of these channels, at least one. Each names one of the samplers.
    pub(crate) fn new(name: String, samplers: Vec<Sampler>, channels: Vec<Channel>) -> Self {
        let last = samplers.iter().filter_map(|sampler| sampler.times.last());
        let duration = last.fold(0.0, |duration: f64, &last| duration.max(last.into()));
        Self { name, duration, samplers, channels }
    }

    /// Its name in the file; empty if it has none.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How long it takes, in seconds: up to its last key. Then it begins again.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }
}

/// A model has no clip of this name or number.
///
/// Displays with a list of all clips: `no animation Jump; the model has 0: Idle, 1: Run`.
#[derive(Clone, PartialEq, Eq)]
pub struct UnknownClip {
    word: String,
    /// The names of all clips; empty for one without a name.
    names: Vec<String>,
}

impl UnknownClip {
    pub(super) fn new(word: &str, clips: &[Clip]) -> Self {
        Self { word: word.to_owned(), names: clips.iter().map(|clip| clip.name.clone()).collect() }
    }
}

impl fmt::Display for UnknownClip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no animation {}; the model has ", shown(self.word.as_bytes()))?;
        for (number, name) in self.names.iter().enumerate() {
            let before = if number == 0 { "" } else { ", " };
            match name.as_str() {
                "" => write!(f, "{before}{number} (unnamed)")?,
                name => write!(f, "{before}{number}: {}", shown(name.as_bytes()))?,
            }
        }
        Ok(())
    }
}

crate::errors::debug_as_display!(UnknownClip);

impl Error for UnknownClip {}

/// A part of a node's transform, and the sampler that it follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Channel {
    pub(crate) node: usize,
    pub(crate) property: Property,
    pub(crate) sampler: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Property {
    Translation,
    /// A quaternion: x, y, z, w.
    Rotation,
    Scale,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolation {
    Step,
    /// Quaternions along the shorter great circle.
    Linear,
    /// A cubic Hermite spline. Each key has three values: the incoming tangent, the value, and the outgoing tangent,
    /// both tangents per second.
    CubicSpline,
}

/// A value over time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sampler {
    pub(crate) interpolation: Interpolation,
    pub(crate) is_rotation: bool,
    /// The times of the keys in seconds, at least one, in ascending order; two may be equal.
    pub(crate) times: Vec<f32>,
    /// One for each key, or three; the last number of a vector is 0.
    pub(crate) values: Vec<[f32; 4]>,
}

impl Sampler {
    /// The value at a time: before the first key that key's value, and after the last key that one's.
    pub(super) fn at(&self, seconds: f64) -> [f64; 4] {
        let next = self.times.partition_point(|&time| f64::from(time) <= seconds);
        let is_spline = self.interpolation == Interpolation::CubicSpline;
        let number = |key: usize, part: usize| {
            let index = if is_spline { 3 * key + part } else { key };
            self.values.get(index).copied().unwrap_or_default().map(f64::from)
        };
        let value = |key: usize| number(key, 1);
        let (Some(before), true) = (next.checked_sub(1), next < self.times.len()) else {
            return value(next.saturating_sub(1));
        };
        // The first is not after `seconds`, and the second is.
        let [from, to] = [before, next].map(|key| f64::from(self.times[key]));
        let (length, t) = (to - from, (seconds - from) / (to - from));
        match self.interpolation {
            Interpolation::Step => value(before),
            Interpolation::Linear if self.is_rotation => slerp(value(before), value(next), t),
            Interpolation::Linear => mix([(value(before), 1.0 - t), (value(next), t)]),
            Interpolation::CubicSpline => {
                let (square, cube) = (t * t, t * t * t);
                let [ahead, behind] = [
                    mix([
                        (value(before), 2.0 * cube - 3.0 * square + 1.0),
                        (number(before, 2), length * (cube - 2.0 * square + t)),
                    ]),
                    mix([(value(next), 3.0 * square - 2.0 * cube), (number(next, 0), length * (cube - square))]),
                ];
                mix([(ahead, 1.0), (behind, 1.0)])
            }
        }
    }
}

fn mix([(a, of_a), (b, of_b)]: [([f64; 4], f64); 2]) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| a[i] * of_a + b[i] * of_b)
}

/// The rotation between two, along the shorter great circle (K. Shoemake, "Animating Rotation with Quaternion Curves",
/// 1985).
fn slerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    let length = |q: [f64; 4]| libm::sqrt(q.iter().map(|c| c * c).sum());
    let [a, b] = [a, b].map(|q| {
        let length = length(q);
        if length > 0.0 { q.map(|c| c / length) } else { q }
    });
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    // The same rotation, on the nearer side.
    let b = if dot < 0.0 { b.map(|c| -c) } else { b };
    // Exact also for a small angle, whose cosine is 1.
    let angle = 2.0 * libm::atan2(length(mix([(b, 1.0), (a, -1.0)])), length(mix([(a, 1.0), (b, 1.0)])));
    let sine = libm::sin(angle);
    if sine > 0.0 { mix([(a, libm::sin((1.0 - t) * angle) / sine), (b, libm::sin(t * angle) / sine)]) } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(interpolation: Interpolation, is_rotation: bool, times: &[f32], values: &[[f32; 4]]) -> Sampler {
        Sampler { interpolation, is_rotation, times: times.to_vec(), values: values.to_vec() }
    }

    fn are_near(a: [f64; 4], b: [f64; 4], most: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= most)
    }

    #[test]
    fn before_and_after_all_keys_the_ends_hold() {
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let sampler = sampler(interpolation, false, &[1.0, 2.0], &[[1.0; 4], [5.0; 4]]);
            assert_eq!([-1.0, 0.5, 1.0, 2.0, 9.0].map(|t| sampler.at(t)[0]), [1.0, 1.0, 1.0, 5.0, 5.0]);
            assert_eq!(sampler.at(1.5)[0], if interpolation == Interpolation::Step { 1.0 } else { 3.0 });
        }
        // Two keys at one time are a jump.
        let jump =
            sampler(Interpolation::Linear, false, &[0.0, 1.0, 1.0, 2.0], &[[0.0; 4], [1.0; 4], [7.0; 4], [8.0; 4]]);
        assert_eq!([0.5, 1.0, 1.5].map(|t| jump.at(t)[0]), [0.5, 7.0, 7.5]);
    }

    /// Turns about an axis by angles up to half a turn; between two of them the angle is interpolated. The quaternions
    /// are f32, off by 2⁻²⁵ of 1 in each number, which changes the angle between them by less than 2⁻²².
    #[test]
    fn a_rotation_turns_evenly_the_shorter_way() {
        let about = |angle: f64| {
            let (sine, cosine) = libm::sincos(angle / 2.0);
            [0.6 * sine, 0.0, 0.8 * sine, cosine]
        };
        for (from, to) in [(0.0, 1.0), (0.25, -2.5), (-1.0, 2.0), (3.0, 3.0 + 1e-5), (0.5, 0.5)] {
            for sign in [1.0, -1.0] {
                let keys = [about(from), about(to).map(|c| sign * c)].map(|q| q.map(|c| c as f32));
                let sampler = sampler(Interpolation::Linear, true, &[0.0, 4.0], &keys);
                for step in 0..=16 {
                    let t = f64::from(step) / 16.0;
                    let found = sampler.at(4.0 * t);
                    let expected = about(from + t * (to - from));
                    // A quaternion and its negative are one rotation.
                    let negative = expected.map(|c| -c);
                    let most = 2f64.powi(-22);
                    assert!(
                        are_near(found, expected, most) || are_near(found, negative, most),
                        "{from} {to} {t}: {found:?}, not {expected:?}"
                    );
                }
            }
        }
    }

    /// The formula of the specification, appendix C, with values exact in f32.
    #[test]
    fn a_spline_follows_the_formula() {
        let (a, b, c) = ([1.0, -2.0, 0.5, 8.0], [3.0, 0.25, 0.0, -1.0], [-4.0, 2.0, 1.0, 0.5]);
        let (d, e, f) = ([0.5, 4.0, -1.0, 2.0], [6.0, -3.0, 2.5, 1.0], [1.0, 1.0, 1.0, 1.0]);
        let sampler = sampler(Interpolation::CubicSpline, false, &[0.5, 2.5], &[a, b, c, d, e, f]);
        for step in 0..=32 {
            let t = f64::from(step) / 32.0;
            let expected = [0, 1, 2, 3].map(|i| {
                let (v0, out, into, v1): (f64, f64, f64, f64) = (b[i].into(), c[i].into(), d[i].into(), e[i].into());
                (2.0 * t.powi(3) - 3.0 * t.powi(2) + 1.0) * v0
                    + 2.0 * (t.powi(3) - 2.0 * t.powi(2) + t) * out
                    + (-2.0 * t.powi(3) + 3.0 * t.powi(2)) * v1
                    + 2.0 * (t.powi(3) - t.powi(2)) * into
            });
            // Some ten roundings of numbers up to 16.
            assert!(are_near(sampler.at(0.5 + 2.0 * t), expected, 1e-14), "{t}: {expected:?}");
        }
        assert_eq!((sampler.at(0.0), sampler.at(2.5)), (b.map(f64::from), e.map(f64::from)));
    }
}
