//! The span with a depth test: the same row of shades, written where the triangle is in front.
//!
//! ```text
//! for every k:  d = ((z + k·dz) mod 2⁶⁴) >> 24
//!               if d > depth[k] { depth[k] = d; row[k] = ((shade + k·step) mod 65,536) >> 8 }
//! ```
//!
//! Of equal depths the first that was drawn stays.

/// Fills `row` where the depth at a pixel is greater than in `depth`, and keeps the greater depth.
///
/// `shade` and `step` are 8.8, `z` and `dz` depths with 24 fraction bits; both sums wrap.
/// Returns the number of pixels written. Pixels beyond the shorter of the two slices are left alone.
#[inline]
pub fn fill_nearer(row: &mut [u8], depth: &mut [u32], shade: u16, step: u16, z: i64, dz: i64) -> u32 {
    let (mut ax, mut z, mut written) = (shade, z, 0);
    for (pixel, nearest) in row.iter_mut().zip(depth) {
        // Depths are u32: what lies above bit 56 is not there within a triangle.
        let d = (z >> 24) as u32;
        if d > *nearest {
            *nearest = d;
            *pixel = (ax >> 8) as u8;
            written += 1;
        }
        ax = ax.wrapping_add(step);
        z = z.wrapping_add(dz);
    }
    written
}
