//! What light needs at every pixel: normal and position, perspective-correct. A pass that writes no pixel.

/// Six numbers at each pixel of a row, each the quotient of two that change linearly along it:
///
/// ```text
/// points[k][i] = (a[i] + k·da[i]) / (d + k·dd)
/// ```
///
/// in f64, a product, a sum and a quotient, each rounded once and in this order, then to f32. Every point
/// is made from its own k: it does not depend on how many were made before it, but for k itself.
///
/// For Phong's shading `a` is normal and position at the first pixel, each over w, and `d` is 1/w; `da` and
/// `dd` are what they change by from one pixel to the next.
///
/// Floats are what it is about, so a processor without them pays for calling it (and only then: it is
/// compiled where it is called).
#[inline]
pub fn interpolate(points: &mut [[f32; 6]], a: [f64; 6], da: [f64; 6], d: f64, dd: f64) {
    for (k, point) in points.iter_mut().enumerate() {
        // Exact: no row is 2⁵³ pixels long.
        let k = k as f64;
        let divisor = d + k * dd;
        for (value, (a, da)) in point.iter_mut().zip(a.iter().zip(&da)) {
            *value = ((a + k * da) / divisor) as f32;
        }
    }
}
