//! Levels of an error map: a range of shades and its colour. The report and the web page show errors in them.

/// A level.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct ErrorLevel {
    /// Greatest error in this level, in shades.
    pub up_to: f32,
    /// Its name in a legend.
    pub label: &'static str,
    /// Its colour as 0xRRGGBB.
    pub color: u32,
}

const fn level(up_to: f32, label: &'static str, color: u32) -> ErrorLevel {
    ErrorLevel { up_to, label, color }
}

/// All levels. The first is the best that rounding can do; the colours run from dark to light in equal steps of
/// lightness.
pub const ALL: [ErrorLevel; 7] = [
    level(0.5, "up to ½", 0x18_0f3e),
    level(1.0, "up to 1", 0x45_1077),
    level(2.0, "up to 2", 0x72_1f81),
    level(4.0, "up to 4", 0xb5_367a),
    level(8.0, "up to 8", 0xf1_605d),
    level(16.0, "up to 16", 0xfe_af77),
    level(f32::INFINITY, "more", 0xfc_fdbf),
];

/// Colour where no error was measured: the background, and pixels that show the wrong face.
pub const NOT_TAKEN: u32 = 0x8a_9099;

/// Index of an error's level; the number of levels for NaN.
#[must_use]
pub fn index_of(error: f32) -> u8 {
    let indices = ALL.iter().zip(0..).find(|(level, _)| error <= level.up_to);
    indices.map_or(ALL.len() as u8, |(_, index)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_has_the_level() {
        let errors = [0.0, 0.5, 0.500_1, 1.0, 1.5, 3.0, 8.0, 9.0, 16.5, f32::INFINITY, f32::NAN];
        assert_eq!(errors.map(index_of), [0, 0, 1, 1, 2, 3, 4, 5, 6, 6, 7]);
    }
}
