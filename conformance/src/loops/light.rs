//! Loops that write no pixels: interpolated points for lighting, and shades along a parabola.

use alloc::{format, vec};

use mode13h::internals::lanes::{Lanes, Points};

use super::{Cases, Checked};

/// Checks eight points of a row, counted from one pixel on.
///
/// # Errors
/// The first wrong point.
pub fn check_interpolate(
    cases: Cases,
    mut interpolate: impl FnMut(u16, &[f64; 6], &[f64; 6], f64, f64) -> Points,
) -> Checked {
    check_points(cases, true, |places, a, da, d, dd| {
        // It was converted from a u16.
        interpolate(places[0] as u16, a, da, d, dd)
    })
}

/// Checks eight points given by their own indices, consecutive or not.
///
/// # Errors
/// The first wrong point.
pub fn check_interpolate_at(
    cases: Cases,
    interpolate: impl FnMut(&Lanes<f64>, &[f64; 6], &[f64; 6], f64, f64) -> Points,
) -> Checked {
    check_points(cases, false, interpolate)
}

fn check_points(
    cases: Cases,
    in_order: bool,
    mut interpolate: impl FnMut(&Lanes<f64>, &[f64; 6], &[f64; 6], f64, f64) -> Points,
) -> Checked {
    let mut random = cases.random("lit");
    let mut count = 0;
    for first in (0..=320_u16).chain([1_000, 4_088, 65_535]) {
        for case in 0..cases.of(2, 8) {
            let mut any = |most: f64| random.around_zero(most);
            let a = core::array::from_fn(|_| any(50.0));
            // Half of them pass through zero among the points, where the smallest rounding error shows.
            let zero = f64::from(first) + 3.0;
            let da = if case % 2 == 0 { a.map(|a: f64| -a / zero) } else { core::array::from_fn(|_| any(0.5)) };
            let (d, dd) = (0.001 + any(1.0).abs(), any(1.0).abs() * 0.01);
            let places: Lanes<f64> = core::array::from_fn(|lane| {
                let own = if in_order || case % 4 < 2 { lane as i64 } else { random.within(0, 319) };
                (i64::from(first) + own) as f64
            });
            let points = interpolate(&places, &a, &da, d, dd);
            for (i, values) in points.iter().enumerate() {
                for (lane, (value, k)) in values.iter().zip(places).enumerate() {
                    let reciprocal: f64 = 1.0 / (d + k * dd);
                    let should = ((a[i] + k * da[i]) * reciprocal) as f32;
                    if value.to_bits() != should.to_bits() {
                        return Err(format!(
                            "at {places:?}, {a:?} by {da:?} over {d} by {dd}: point {lane} [{i}] is {value}, not {should}"
                        ));
                    }
                }
            }
            count += 1;
        }
    }
    Ok(count)
}

/// The definition of `curve`, for one shade.
fn shade(k: u16, [a, b, c]: [f32; 3], least: u16, most: u16) -> u16 {
    let k = f32::from(k);
    let product = k * c;
    let sum = b + product;
    let product = k * sum;
    let value = a + product;
    let held = if value.is_nan() { f32::from(least) } else { value.max(f32::from(least)) };
    // To nearest, ties to even; below 2¹⁶.
    libm::rint(f64::from(held.min(f32::from(most)))) as u16
}

/// Checks shades along a parabola.
///
/// # Errors
/// The first wrong shade.
pub fn check_curve(cases: Cases, mut curve: impl FnMut(&mut [u16], [f32; 3], u16, u16)) -> Checked {
    /// Fills the memory after the shades, which must not change.
    const BEHIND: u16 = 0xABCD;
    let mut random = cases.random("curves");
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -0.0, 1e-40, 0.5, 1.5, 65_280.0];
    let mut count = 0;
    for length in (0..=100_u16).chain([128, 320, 321, 4_096]) {
        for case in 0..cases.of(12, 60) {
            let mut any = |most: f64| random.around_zero(most) as f32;
            // From one shade in range to another, including whole and half ones, and occasionally from values that are
            // not shades.
            let span = f64::from(length.max(2));
            let mut parabola = [any(70_000.0), any(200_000.0 / span), any(200_000.0 / span / span)];
            match case % 6 {
                0 => parabola = parabola.map(|value| libm::roundf(value * 2.0) / 2.0),
                1 => parabola = [libm::roundf(parabola[0]) + 0.5, 0.0, 0.0],
                2 => parabola[random.below(3)] = random.one_of(&odd),
                _ => {}
            }
            let mut ends = [0, 1].map(|_| random.within(0, 0xFF00) as u16);
            if case % 10 != 0 {
                ends.sort_unstable();
            }
            let [least, most] = ends;
            let mut shades = vec![BEHIND; usize::from(length) + 8];
            curve(&mut shades[..usize::from(length)], parabola, least, most);
            for (k, is) in (0..length).zip(&shades) {
                let should = shade(k, parabola, least, most);
                if *is != should {
                    return Err(format!("{parabola:?} from {least} to {most}: shade {k} is {is}, not {should}"));
                }
            }
            if shades[usize::from(length)..].iter().any(|shade| *shade != BEHIND) {
                return Err(format!("{length} shades: something was written behind them"));
            }
            count += 1;
        }
    }
    Ok(count)
}
