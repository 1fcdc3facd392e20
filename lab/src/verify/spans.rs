//! Group S: every span kernel of this machine against the definition, and the twins of other loops.

use super::Group;
use super::freestanding::{Tally, kernels};

/// Every span kernel of this machine against the definition, in the manner of hard cases S1 to S6; under 2 s.
///
/// ```text
/// row[k] = ((shade + k·step) mod 65,536) >> 8, and no byte beside the row
/// ```
///
/// Tried are no pixel, one and two (S1 to S3); random and extreme starts and steps at 191 pixels (S4);
/// every length to 320 and those around 65,536, at changing alignments (S5); and whole rows with the least
/// steps (S6). Other loops that have a faster twin (dither, perspective-correct texels, the colour cube) are
/// tried against their portable specification, at every length to 320. The same `seed` tries the same cases.
///
/// ```
/// let group = mode13h_lab::verify::spans(13);
/// assert!(group.cases > 0 && group.failures.is_empty());
/// ```
#[must_use]
pub fn spans(seed: u64) -> Group {
    let Tally { cases, failures } = kernels(seed);
    Group { cases, failures, ..Group::new("spans") }
}
