//! Verdicts: the words of a claim in numbers.

use crate::cost::Verdict;

/// An error that is insignificant, or can be ignored: less than a shade, which is the least that a byte can show.
pub(super) const INSIGNIFICANT: f64 = 1.0;

/// A share of wrong pixels that can be ignored: one of a hundred.
pub(super) const FEW: f64 = 0.01;

/// High accuracy: no pixel a shade off. Half a shade is what bytes cost, whatever the arithmetic.
pub(super) const ACCURATE: f64 = 1.0;

/// "Little more": up to a quarter.
pub(super) const LITTLE_MORE: f64 = 1.25;

/// Three additions against one.
pub(super) const THREE: f64 = 3.0;

/// Greatest difference of two root mean squares that have met, in shades.
pub(super) const MET: f64 = 0.1;

/// The max ratio of times that counts as equally fast: a tenth slower.
pub(super) const AS_FAST: f64 = 1.1;

/// Verdict on both: the first of two is so, and the second.
pub(super) fn both(one: bool, other: bool) -> Verdict {
    match (one, other) {
        (true, true) => Verdict::Holds,
        (false, false) => Verdict::DoesNotHold,
        _ => Verdict::HoldsInPart,
    }
}

/// Verdict on whether a list falls: everywhere, or from its first to its last at least.
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
