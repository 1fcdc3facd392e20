//! A span explained in words: start, step, sums, and how far the byte is from exact.

use super::paragraph::Text;
use mode13h::internals::{Accumulator, Progression, Ratio, ShadeTrace};

/// Sums listed at either end of a span.
const ENDS: i32 = 5;

/// A sum as it is in its register, in hexadecimal.
fn hex(sums: &Accumulator, sum: u32) -> String {
    if sums.fraction_bits == 16 { format!("{sum:06x}") } else { format!("{sum:04x}") }
}

fn in_units(sums: &Accumulator, value: f64) -> f64 {
    value / f64::from(1_u32 << sums.fraction_bits)
}

/// A step as the loop adds it: modulo the size of its register.
fn step_in_hex(sums: &Accumulator) -> String {
    // In the register's width.
    if sums.fraction_bits == 16 { format!("{:#010x}", sums.step as u32) } else { format!("{:#06x}", sums.step as u16) }
}

pub(super) fn short_account(shade_trace: &ShadeTrace) -> Option<String> {
    Some(match shade_trace.way {
        Progression::Flat(byte) => format!("one shade for the face: {byte}"),
        Progression::Accumulator(sums) => {
            let Accumulator { start_at, start, steps, .. } = sums;
            let step = in_units(&sums, sums.step as f64);
            let start = hex(&sums, start);
            format!("{start} at {start_at} + {steps} x {step:+.3} = {}", hex(&sums, sums.sum()))
        }
        Progression::Quotient => format!("exact quotient {:.4}", shade_trace.exact?.to_f64() / 256.0),
        Progression::Float { shade, .. } => format!("quotient in f32: {shade:.4}"),
    })
}

pub(super) fn say_account(text: &mut Text, shade_trace: &ShadeTrace, x: u32) {
    match shade_trace.way {
        Progression::Flat(byte) => text.say("span", &format!("one byte for the whole face, {byte}: a plain fill")),
        Progression::Accumulator(sums) => say_sums(text, &sums, x),
        Progression::Quotient => text.say(
            "quotient",
            "at every pixel exactly: the corners' shades weighted by their areas and depths (which stand for 1/w); the \
             byte is the nearest shade",
        ),
        Progression::Float { start, n: [n, dn], d: [d, dd], shade } => {
            let k = i64::from(x) - i64::from(start);
            let words = format!(
                "k = {k} pixels from column {start}, the row's far end: ({n:e} + k x {dn:e}) / ({d:e} + k x {dd:e}) = \
                 {shade:.6}, nearest byte {}",
                shade_trace.byte
            );
            text.say("f32", &words);
        }
    }
    if let Some(exact @ Ratio { numerator, denominator }) = shade_trace.exact {
        let shade = exact.to_f64() / 256.0;
        let off = f64::from(shade_trace.byte) - shade;
        let cut = match shade_trace.way {
            Progression::Accumulator(sums) => {
                let held = in_units(&sums, f64::from(sums.sum()) - f64::from(sums.half));
                format!(
                    ": {:+.4} by start and steps, {:+.4} by rounding",
                    held - shade,
                    f64::from(shade_trace.byte) - held
                )
            }
            _ => String::new(),
        };
        text.say(
            "exact",
            &format!("{numerator} / {denominator} / 256 = {shade:.4}; the byte is off by {off:+.4}{cut}"),
        );
    }
}

fn say_sums(text: &mut Text, sums: &Accumulator, x: u32) {
    let Accumulator { first, start_at, start, steps, half, .. } = *sums;
    let restart = if start_at == first { String::new() } else { format!(", restarted every 64 pixels: at {start_at}") };
    let half_words = if half > 0 { ", plus half a shade so that the byte is the nearest" } else { ", no half added" };
    let back = match sums.step {
        0 => "cut",
        step if step < 0 => "rounded up because it falls",
        _ => "rounded down because it rises",
    };
    let back = if half > 0 { format!("the exact shade there, {back}") } else { "its left edge's shade".into() };
    text.say("span", &format!("begins at column f = {first}{restart}; this is column {x}"));
    let in_shades = in_units(sums, f64::from(start));
    text.say("start", &format!("0x{} = {in_shades:.3}: {back}{half_words}", hex(sums, start)));
    let sum = sums.sum();
    let byte = sum >> sums.fraction_bits;
    let whole = format!(
        "0x{} = {:.3}, whose whole part is the byte {byte} ({byte:#04x})",
        hex(sums, sum),
        in_units(sums, f64::from(sum))
    );
    if sums.step == 0 {
        return text.say("step", &format!("0: the shade is the same all along the row, {whole}"));
    }
    let step = in_units(sums, sums.step as f64);
    text.say("step", &format!("{} = {step:+.4} a pixel: the slope, rounded toward zero", step_in_hex(sums)));
    // If there are many, only the first and the last few are shown.
    let ends = |k: &i32| steps < 2 * ENDS || *k < ENDS || *k > steps - ENDS;
    let mut shown: Vec<String> = (0..=steps).filter(ends).map(|k| hex(sums, sums.after(k))).collect();
    if steps >= 2 * ENDS {
        // A small number.
        shown.insert(ENDS as usize, "...".into());
    }
    let after = if steps == 1 { "1 step".into() } else { format!("{steps} steps") };
    text.say("sums", &format!("{}; after {after} {whole}", shown.join(" ")));
}
