//! Numbers as text. A number that is not finite becomes a dash.

use std::fmt::Display;

use mode13h::settings::Shading;

pub(super) const DASH: &str = "–";

/// A time, in whichever unit reads best.
pub(super) fn time(nanoseconds: f64) -> String {
    let (divisor, unit) = match nanoseconds.abs() {
        ns if ns < 999.5 => (1.0, "ns"),
        ns if ns < 999.5e3 => (1e3, "µs"),
        ns if ns < 999.5e6 => (1e6, "ms"),
        _ => (1e9, "s"),
    };
    if nanoseconds.is_finite() { format!("{} {unit}", three_digits(nanoseconds / divisor)) } else { DASH.into() }
}

/// A time on an axis: 1 ms, not 1.00 ms.
pub(super) fn time_tick(nanoseconds: f64) -> String {
    let time = time(nanoseconds);
    match time.split_once(' ') {
        Some((number, unit)) => format!("{} {unit}", without_zeros(number)),
        None => time,
    }
}

/// Three significant digits, and all digits before the decimal point.
pub(super) fn three_digits(number: f64) -> String {
    match number.abs() {
        n if !n.is_finite() => DASH.into(),
        n if n < 9.995 => format!("{number:.2}"),
        n if n < 99.95 => format!("{number:.1}"),
        _ => format!("{number:.0}"),
    }
}

/// Shades, to two decimals.
pub(super) fn shades(number: f64) -> String {
    if number.is_finite() { format!("{number:.2}") } else { DASH.into() }
}

/// A budget as the user gave it.
pub(super) fn asked(number: f64) -> String {
    if number.is_finite() { number.to_string() } else { DASH.into() }
}

/// Shades as a bound, rounded up so that "at most" is true: to a tenth, or below one to a hundredth.
pub(super) fn at_most(number: f64) -> String {
    // A small slack, or else 0.7 as f64 would become 0.71.
    let up = |scale: f64| ((number * scale) - 1e-6).ceil().max(0.0) / scale;
    if !number.is_finite() {
        DASH.into()
    } else if number <= 1.0 {
        plain(up(100.0), 2)
    } else {
        plain(up(10.0), 1)
    }
}

/// A number without trailing zeros.
fn plain(number: f64, digits: usize) -> String {
    without_zeros(&format!("{number:.digits$}")).to_string()
}

/// A number's text without the zeros that end its decimals.
pub(super) fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// "1 shade", "0.7 shades".
pub(super) fn counted_shades(text: &str) -> String {
    format!("{text} shade{}", if text == "1" { "" } else { "s" })
}

/// A ratio: three significant digits, or more if it would read as 1 and is not.
pub(super) fn ratio(ratio: f64) -> String {
    let off = (ratio - 1.0).abs();
    if !ratio.is_finite() {
        DASH.into()
    } else if ratio.abs() < 0.1 || (0.0005..0.005).contains(&off) {
        format!("{ratio:.3}")
    } else {
        three_digits(ratio)
    }
}

/// A shading's name, marked if it is the default.
pub(super) fn name_of(shading: Shading) -> String {
    format!("{shading}{}", if shading == Shading::default() { " (default)" } else { "" })
}

/// A share as a percentage.
pub(super) fn percent(share: f64) -> String {
    match share * 100.0 {
        p if !p.is_finite() => DASH.into(),
        // Never 100 % unless it is all.
        p if p < 100.0 && p > 99.9 => format!("{:.3} %", (p * 1000.0).floor() / 1000.0),
        p => format!("{} %", plain(p, 2)),
    }
}

/// A count with thin spaces between thousands.
pub(super) fn count(number: impl Display) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

/// Names joined: "a", "a and b", "a, b and c".
pub(super) fn list(shadings: &[Shading]) -> String {
    match shadings {
        [] => String::new(),
        [one] => one.to_string(),
        [most @ .., last] => {
            let most: Vec<String> = most.iter().map(Shading::to_string).collect();
            format!("{} and {last}", most.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_rounded_up() {
        for (number, text) in [(0.7, "0.7"), (0.701, "0.71"), (0.0, "0"), (0.996, "1"), (11.0, "11"), (11.01, "11.1")] {
            assert_eq!(at_most(number), text);
        }
        assert_eq!(at_most(f64::NAN), DASH);
    }

    #[test]
    fn what_is_not_one_or_all_does_not_read_so() {
        assert_eq!([ratio(1.0), ratio(1.004), ratio(1.02), ratio(0.028)], ["1.00", "1.004", "1.02", "0.028"]);
        assert_eq!([percent(1.0), percent(0.999_999_9), percent(0.5)], ["100 %", "99.999 %", "50 %"]);
    }

    #[test]
    fn times_have_a_unit() {
        assert_eq!([time(12.0), time(229_130.0), time(6.26e6), time(f64::NAN)], ["12.0 ns", "229 µs", "6.26 ms", DASH]);
        assert_eq!(
            [time_tick(1e6), time_tick(1e7), time_tick(1e8), time_tick(5e3)],
            ["1 ms", "10 ms", "100 ms", "5 µs"]
        );
        assert_eq!(count(1_234_567), "1\u{2009}234\u{2009}567");
    }
}
