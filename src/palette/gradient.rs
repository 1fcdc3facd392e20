//! Ramps made from key colours.

use super::{Ramp, Rgb};

/// A key colour at a position on a ramp.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Stop {
    /// The position: 0 is the ramp's first entry, 255 its last.
    pub at: u8,
    /// The colour there.
    pub color: Rgb,
}

impl Stop {
    /// A key at position `at`, 0 to 255, with the colour `0xRRGGBB`.
    #[must_use]
    pub const fn new(at: u8, rgb: u32) -> Self {
        Self { at, color: Rgb::from_u32(rgb) }
    }
}

/// Fills the entries of `ramp` by linear interpolation between keys, channel by channel.
///
/// Entry `i` of `n` is at position `255·i/(n − 1)`, and a single entry at 255. A channel's value is
/// rounded to the nearest of 0 to 255, halves upward, from the exact fraction. Before the first key
/// and after the last, the colour is constant. The keys must be in increasing order of
/// [`Stop::at`]; a key that is not above the one before it is ignored. Without keys nothing
/// changes.
///
/// ```
/// use mode13h::palette::{Ramp, Rgb, gradient::{Stop, fill}};
/// let mut colors = [Rgb::BLACK; 256];
/// fill(&mut colors, Ramp::new(16, 3).unwrap(), &[Stop::new(0, 0x000000), Stop::new(255, 0xff8001)]);
/// assert_eq!(colors[17], Rgb::new(128, 64, 1));
/// assert_eq!(colors[19], Rgb::BLACK);
/// ```
pub const fn fill(colors: &mut [Rgb; 256], ramp: Ramp, keys: &[Stop]) {
    let mut i = 0;
    while i < ramp.entries() {
        if let Some(color) = color_at(i, ramp.entries(), keys) {
            colors[ramp.index(i) as usize] = color;
        }
        i += 1;
    }
}

/// The colour of entry `i` of `entries`, as in [`fill`]; `None` without keys or entries.
pub const fn color_at(i: u16, entries: u16, keys: &[Stop]) -> Option<Rgb> {
    if keys.is_empty() || entries == 0 {
        return None;
    }
    // Positions are stored as numerators over `entries − 1`.
    let (position, scale) = if entries == 1 { (255, 1) } else { (i as i32 * 255, entries as i32 - 1) };
    let mut below = keys[0];
    let mut k = 1;
    while k < keys.len() && keys[k].at as i32 * scale <= position {
        if keys[k].at > below.at {
            below = keys[k];
        }
        k += 1;
    }
    // The next key above, if there is one.
    while k < keys.len() && keys[k].at <= below.at {
        k += 1;
    }
    let start = below.at as i32 * scale;
    if k == keys.len() || position <= start {
        return Some(below.color);
    }
    let above = keys[k];
    let (along, length) = (position - start, above.at as i32 * scale - start);
    Some(Rgb::new(
        between(below.color.r, above.color.r, along, length),
        between(below.color.g, above.color.g, along, length),
        between(below.color.b, above.color.b, along, length),
    ))
}

/// `a + (b − a)·along/length`, rounded to the nearest, halves upward; between `a` and `b`. `length` is below 2²⁴.
const fn between(a: u8, b: u8, along: i32, length: i32) -> u8 {
    let (a, b, along, length) = (a as i64, b as i64, along as i64, length as i64);
    let twice = 2 * (a * length + (b - a) * along) + length;
    (twice / (2 * length)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_entries_has_the_nearest_colours() {
        let keys = [Stop::new(10, 0x00FF80), Stop::new(200, 0xFF0081)];
        for entries in [1, 2, 255, 256, 1_025, 16_501, 60_000, u16::MAX] {
            for i in [0, 1, entries / 7, entries / 3, entries / 2, entries - 1].into_iter().filter(|i| *i < entries) {
                let at = if entries == 1 { 255.0 } else { f64::from(i) * 255.0 / f64::from(entries - 1) };
                let part = ((at - 10.0) / 190.0).clamp(0.0, 1.0);
                let color = color_at(i, entries, &keys).expect("keys");
                for (found, [from, to]) in [(color.r, [0.0, 255.0]), (color.g, [255.0, 0.0]), (color.b, [128.0, 129.0])]
                {
                    // A half may go either way in f64.
                    let exact: f64 = from + (to - from) * part;
                    assert!((f64::from(found) - exact).abs() <= 0.5 + 1e-9, "{i} of {entries}: {color:?}");
                }
            }
        }
        assert_eq!(color_at(0, 0, &keys), None);
    }
}
