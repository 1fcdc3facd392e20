//! A list of short spans, drawn by one call: those of small triangles.
//!
//! ```text
//! for every span of the list:  fill(pixels[at .. at + length], shade, step)
//! ```

/// A span and where it lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct Listed {
    /// The offset of its first pixel.
    pub at: u32,
    /// Pixels.
    pub length: u32,
    /// In 8.8, as `fill` takes them.
    pub shade: u16,
    /// In 8.8.
    pub step: u16,
}

/// Fills every span of a list.
#[inline(always)]
pub(super) fn each(pixels: &mut [u8], spans: &[Listed], fill: impl Fn(&mut [u8], u16, u16)) {
    for span in spans {
        // No overflow: both are below 2³² and a length is at most 4,096 where usize has no more bits.
        let at = span.at as usize;
        if let Some(row) = pixels.get_mut(at..at.saturating_add(span.length as usize)) {
            fill(row, span.shade, span.step);
        }
    }
}
