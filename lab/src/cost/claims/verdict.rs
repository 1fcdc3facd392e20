//! Verdicts: the words of a claim, in numbers.

use crate::cost::Verdict;

/// An insignificant error, one that can be ignored: less than one shade, the least that a byte can show.
pub(super) const INSIGNIFICANT: f64 = 1.0;

/// A negligible share of wrong pixels: one in a hundred.
pub(super) const FEW: f64 = 0.01;

/// High accuracy: no pixel off by a whole shade. Rounding to bytes alone costs half a shade, whatever the arithmetic.
pub(super) const ACCURATE: f64 = 1.0;

/// "Little more": up to a quarter.
pub(super) const LITTLE_MORE: f64 = 1.25;

/// Three additions instead of one.
pub(super) const THREE: f64 = 3.0;

/// Two root mean squares that differ by at most this many shades have met.
pub(super) const MET: f64 = 0.1;

/// Greatest ratio of times that counts as equally fast: a tenth slower.
pub(super) const AS_FAST: f64 = 1.1;

/// Verdict on two conditions: both, one, or neither holds.
pub(super) fn both(one: bool, other: bool) -> Verdict {
    match (one, other) {
        (true, true) => Verdict::Holds,
        (false, false) => Verdict::DoesNotHold,
        _ => Verdict::HoldsInPart,
    }
}

/// Verdict on whether a list falls: at every step, or at least from first to last.
pub(super) fn falls(list: &[f64]) -> Verdict {
    let ends = list.first().zip(list.last()).is_some_and(|(first, last)| last < first);
    both(ends, ends && list.windows(2).all(|pair| pair[1] <= pair[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_follow_from_what_is_so() {
        assert_eq!(both(true, true), Verdict::Holds);
        assert_eq!(both(false, true), Verdict::HoldsInPart);
        assert_eq!(both(false, false), Verdict::DoesNotHold);
        assert_eq!(falls(&[3.0, 2.0, 2.0, 1.0]), Verdict::Holds);
        assert_eq!(falls(&[3.0, 1.0, 2.0]), Verdict::HoldsInPart);
        assert_eq!(falls(&[1.0, 2.0]), Verdict::DoesNotHold);
        assert_eq!(falls(&[]), Verdict::DoesNotHold);
    }
}
