//! The account of a pixel in words.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use super::face::{EdgeKind, FaceHere};
use super::pixel::{Pixel, Seen, Stage};
use crate::plan::Effect;
use crate::raster::Shading;
use crate::raster::account::{Account, Ratio, Sums, Way};
use crate::render::{Fate, Rung, ShadedBy};

/// Columns of text.
const WIDTH: usize = 100;

/// Columns of what stands before it.
const LABEL: usize = 10;

/// Triangles that are listed, at most.
const LISTED: usize = 6;

/// Sums that are shown of either end of a span.
const ENDS: i32 = 5;

/// Lines that begin with a label and go on below it.
struct Text(String);

impl Text {
    /// A paragraph, wrapped.
    fn say(&mut self, label: &str, words: &str) {
        let mut line = format!("  {label:LABEL$}");
        let mut empty = true;
        for word in words.split_whitespace() {
            if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
                self.line(&line);
                line = " ".repeat(LABEL + 2);
                empty = true;
            }
            if !empty {
                line.push(' ');
            }
            line += word;
            empty = false;
        }
        self.line(&line);
    }

    /// One line as it is.
    fn line(&mut self, line: &str) {
        self.0 += line.trim_end();
        self.0.push('\n');
    }

    /// A line behind a label, as it is.
    fn row(&mut self, label: &str, row: &str) {
        self.line(&format!("  {label:LABEL$}{row}"));
    }
}

impl fmt::Display for Pixel {
    /// Lines of at most 100 columns.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = Text(String::new());
        let Self { x, y, byte, color, .. } = self;
        let in_hex = color.to_u32();
        text.line(&format!("pixel ({x}, {y}): byte {byte} ({byte:#04x}), an entry of the palette: #{in_hex:06x}"));
        if self.seen.is_empty() {
            let words = format!("no triangle covers its centre; the frame was cleared to {}", self.background);
            text.say("background", &words);
        }
        let front = self.seen.len().saturating_sub(1);
        for (i, seen) in self.seen.iter().enumerate() {
            match self.faces.get(seen.face) {
                Some(face) if i == front => self.say_seen(&mut text, face, seen),
                Some(face) => self.say_behind(&mut text, face, seen),
                None => {}
            }
        }
        self.say_others(&mut text);
        f.write_str(&text.0)
    }
}

impl Pixel {
    /// The same in a few short lines, for where there is little room: at most six, each of at most `width` characters
    /// (what is longer is cut).
    #[must_use]
    pub fn lines(&self, width: usize) -> Vec<String> {
        let Self { x, y, byte, color, .. } = self;
        let mut lines = Vec::from([format!("({x}, {y}) byte {byte} #{:06x}", color.to_u32())]);
        match self.front() {
            None => lines.push("background: no face is here".into()),
            Some((face, seen)) => {
                let losers = self.losers().count();
                let others = if losers > 0 { format!(", {losers} behind") } else { String::new() };
                lines.push(format!("{}{others}", self.name(face)));
                lines.push(format!("{} {}", self.shading_of(face, seen), short_edges(face, *x, *y)));
                lines.extend(seen.accounts.first().and_then(short_account));
                if let ShadedBy::Light { shades: [shade, ..], .. } = seen.shaded_by {
                    lines.push(format!("light here {:.2}", f64::from(shade) / 256.0));
                }
                let errors = seen.against.iter().map(|a| format!("{} {:+.2}", a.standard, a.error));
                let errors = errors.collect::<Vec<_>>().join(", ");
                lines.extend((!errors.is_empty()).then(|| format!("off {errors}")));
                lines.push(stages(seen, false));
            }
        }
        lines.truncate(6);
        lines.iter().map(|line| line.chars().take(width).collect()).collect()
    }

    /// An object and a triangle of it.
    fn name(&self, face: &FaceHere) -> String {
        let object = self.objects.get(face.object).map_or("", String::as_str);
        match face.triangle {
            Some(triangle) if face.is_part => format!("{object}, a part of triangle {triangle}"),
            Some(triangle) => format!("{object}, triangle {triangle}"),
            None => object.to_string(),
        }
    }

    /// The technique that a face is shaded by, whatever was asked for.
    fn shading_of(&self, face: &FaceHere, seen: &Seen) -> Rung {
        let by_shading = match face.shading {
            Shading::Flat(_) => Rung::Flat,
            Shading::GouraudPeriod => Rung::GouraudPeriod,
            Shading::Gouraud => Rung::Gouraud88,
            Shading::GouraudReseeded => Rung::Gouraud88Reseeded,
            Shading::Gouraud1616 => Rung::Gouraud1616,
            Shading::GouraudHyperbolic => Rung::GouraudHyperbolic,
            Shading::Float => Rung::Float,
        };
        match seen.shaded_by {
            ShadedBy::NormalTable => Rung::PhongTable,
            ShadedBy::Light { .. } => Rung::Phong,
            ShadedBy::Corners if face.is_part && by_shading == Rung::Gouraud88Reseeded => Rung::GouraudTessellated,
            ShadedBy::Corners if self.rung == Rung::Flat => Rung::Flat,
            ShadedBy::Corners => by_shading,
        }
    }

    /// A face that is seen through another, in short.
    fn say_behind(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let account =
            seen.accounts.first().and_then(short_account).map(|account| format!("{account}; ")).unwrap_or_default();
        let words = format!("{}, {}: {account}{}", self.name(face), self.shading_of(face, seen), stages(seen, false));
        text.say("through", &words);
    }

    fn say_seen(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let through = if face.fate == Fate::SeenThrough { ", which shines through" } else { "" };
        text.say("seen", &format!("{}{through}", self.name(face)));
        self.say_corners(text, face, seen);
        self.say_rung(text, face, seen);
        match (&seen.shaded_by, seen.accounts.as_slice()) {
            (ShadedBy::Light { normal, position, shades }, _) => {
                let point = |p: &[f32; 3]| format!("({:.4}, {:.4}, {:.4})", p[0], p[1], p[2]);
                let words = format!(
                    "normal {}, not yet of unit length, at {} in the object's own space: interpolated \
                     perspective-correctly from the corners' and lit by the whole model: {}",
                    point(normal),
                    point(position),
                    in_shades(seen, shades),
                );
                text.say("light", &words);
            }
            (ShadedBy::NormalTable, [across, down]) => {
                let words = format!(
                    "column {} and row {} of a table of 256 x 256 normals: x and y as the eye sees them, linear from \
                     corner to corner as shades are",
                    across.byte, down.byte
                );
                text.say("normal", &words);
            }
            (_, [only]) => say_account(text, only, self.x),
            (_, all) => {
                for (name, account) in ["red", "green", "blue"].iter().zip(all) {
                    text.say(name, &short_account(account).unwrap_or_else(|| account.byte.to_string()));
                }
            }
        }
        let errors: Vec<String> = seen
            .against
            .iter()
            .map(|a| {
                let shades = match a.shades {
                    [r, g, b] if r == g && g == b => format!("{r:.3}"),
                    [r, g, b] => format!("{r:.2} {g:.2} {b:.2}"),
                };
                format!("{} {shades} (off {:+.3})", a.standard, a.error)
            })
            .collect();
        if !errors.is_empty() {
            text.say("truth", &format!("{}, of 255 shades", errors.join(", ")));
        }
        text.say("stages", &stages(seen, true));
        let effects: Vec<String> = seen
            .effects
            .iter()
            .map(|row| match row.choice {
                "" => row.effect.to_string(),
                choice => format!("{} ({choice})", row.effect),
            })
            .collect();
        text.say("effects", &format!("on: {}", effects.join(", ")));
    }

    /// The corners, and the edges between them.
    fn say_corners(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let flat = matches!(face.shading, Shading::Flat(_));
        let has_shades = seen.shaded_by == ShadedBy::Corners && seen.accounts.len() == 1 && !flat;
        text.row("corners", "     x/256     y/256          in pixels     shade (8.8)         depth");
        for (name, corner) in ["A", "B", "C"].iter().zip(&face.corners) {
            let (x, y) = (corner.x().to_bits(), corner.y().to_bits());
            let at = format!("({:.3}, {:.3})", f64::from(x) / 256.0, f64::from(y) / 256.0);
            let bits = corner.shade().to_bits();
            let shade = if has_shades { format!("{bits:#06x} {:7.3}", f64::from(bits) / 256.0) } else { "-".into() };
            text.row("", &format!("{name} {x:>8}  {y:>8}  {at:>20}  {shade:>14}  {:>12}", corner.depth()));
        }
        if !seen.exact_cover {
            let words = "on whole pixels, from Ax to the last before Bx in each row: no edge functions, no exact cover";
            return text.say("cover", words);
        }
        for (name, edge) in ["A to B", "B to C", "C to A"].iter().zip(face.edges(self.x, self.y)) {
            let label = if *name == "A to B" { "edges" } else { "" };
            let inside = match edge.value {
                0 => format!("the centre is on this {} edge, {}", edge.kind, owner(edge.kind)),
                _ => format!("inside (a {} edge)", edge.kind),
            };
            text.row(label, &format!("{name} {:>16}  {inside}", edge.value));
        }
    }

    fn say_rung(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let drawn = self.shading_of(face, seen);
        let runs = seen.effects.iter().any(|row| row.effect == Effect::Gouraud);
        let words = if drawn == self.rung {
            format!("{drawn}: {}", self.rung_why)
        } else if drawn == Rung::Flat && !runs {
            format!("{drawn}: its corners have one shade (else {}: {})", self.rung, self.rung_why)
        } else {
            format!("{drawn}, where {} is on ({})", self.rung, self.rung_why)
        };
        text.say("rung", &words);
    }

    /// What else meets the pixel.
    fn say_others(&self, text: &mut Text) {
        let others: Vec<&FaceHere> =
            self.faces.iter().filter(|face| !matches!(face.fate, Fate::Seen | Fate::SeenThrough)).collect();
        let method = format!("hidden surfaces by {}", self.hidden_surfaces);
        let method = match self.hidden_surfaces_why.as_str() {
            "" => method,
            why => format!("{method}: {why}"),
        };
        let seen: Vec<String> =
            self.seen.iter().filter_map(|s| Some(self.faces.get(s.face)?.depth.to_string())).collect();
        let depth = match seen.as_slice() {
            [] => String::new(),
            depths => format!("; depth here {} (greater is nearer)", depths.join(", ")),
        };
        text.say(
            "depth",
            &format!("{method}{depth}{}", if others.is_empty() { "; no other face is here" } else { "" }),
        );
        for face in others.iter().take(LISTED) {
            let fate = match face.fate {
                Fate::Behind => "behind",
                Fate::PaintedOver => "painted over",
                Fate::NotItsEdge => "its right or bottom edge: not its pixel",
                Fate::Seen | Fate::SeenThrough => "seen",
            };
            text.row("", &format!("{:>12}  {fate}: {}", face.depth, self.name(face)));
        }
        if others.len() > LISTED {
            text.row("", &format!("{:>12}  and {} more", "", others.len() - LISTED));
        }
    }
}

fn owner(kind: EdgeKind) -> &'static str {
    if kind.owns_ties() { "which owns it" } else { "which the neighbour owns" }
}

fn short_edges(face: &FaceHere, x: u32, y: u32) -> String {
    match face.edges(x, y).iter().find(|edge| edge.value == 0) {
        Some(edge) => format!("on a {} edge", edge.kind),
        None => String::new(),
    }
}

/// A shade in light, of one channel or of three.
fn in_shades(seen: &Seen, shades: &[u16; 3]) -> String {
    let [r, g, b] = shades.map(|shade| f64::from(shade) / 256.0);
    if matches!(seen.stages.first(), Some(Stage::Channels(_))) {
        format!("red {r:.3}, green {g:.3}, blue {b:.3}")
    } else {
        format!("shade {r:.3} ({:#06x})", shades[0])
    }
}

/// A sum as its register shows it, in hexadecimal.
fn hex(sums: &Sums, sum: u32) -> String {
    if sums.fraction_bits == 16 { format!("{sum:06x}") } else { format!("{sum:04x}") }
}

fn in_units(sums: &Sums, value: f64) -> f64 {
    value / f64::from(1_u32 << sums.fraction_bits)
}

/// A step as the loop adds it: modulo the size of its register.
fn step_in_hex(sums: &Sums) -> String {
    // Of the register's bits.
    if sums.fraction_bits == 16 { format!("{:#010x}", sums.step as u32) } else { format!("{:#06x}", sums.step as u16) }
}

fn short_account(account: &Account) -> Option<String> {
    Some(match account.way {
        Way::Flat(byte) => format!("one shade for the face: {byte}"),
        Way::Sums(sums) => {
            let Sums { start_at, start, steps, .. } = sums;
            let step = in_units(&sums, sums.step as f64);
            let start = hex(&sums, start);
            format!("{start} at {start_at} + {steps} x {step:+.3} = {}", hex(&sums, sums.sum()))
        }
        Way::Quotient => format!("exact quotient {:.4}", account.exact?.to_f64() / 256.0),
        Way::Float { shade, .. } => format!("quotient in f32: {shade:.4}"),
    })
}

fn say_account(text: &mut Text, account: &Account, x: u32) {
    match account.way {
        Way::Flat(byte) => text.say("span", &format!("one byte for the whole face, {byte}: a plain fill")),
        Way::Sums(sums) => say_sums(text, &sums, x),
        Way::Quotient => text.say(
            "quotient",
            "at every pixel exactly: the corners' shades weighted by their areas and depths (which stand for 1/w); the \
             byte is the nearest shade",
        ),
        Way::Float { start, n: [n, dn], d: [d, dd], shade } => {
            let k = i64::from(x) - i64::from(start);
            let words = format!(
                "k = {k} pixels from column {start}, the row's far end: ({n:e} + k x {dn:e}) / ({d:e} + k x {dd:e}) = \
                 {shade:.6}, nearest byte {}",
                account.byte
            );
            text.say("f32", &words);
        }
    }
    if let Some(exact @ Ratio { numerator, denominator }) = account.exact {
        let shade = exact.to_f64() / 256.0;
        let off = f64::from(account.byte) - shade;
        let cut = match account.way {
            Way::Sums(sums) => {
                let held = in_units(&sums, f64::from(sums.sum()) - f64::from(sums.half));
                format!(": {:+.4} by start and steps, {:+.4} by rounding", held - shade, f64::from(account.byte) - held)
            }
            _ => String::new(),
        };
        text.say(
            "exact",
            &format!("{numerator} / {denominator} / 256 = {shade:.4}; the byte is off by {off:+.4}{cut}"),
        );
    }
}

fn say_sums(text: &mut Text, sums: &Sums, x: u32) {
    let Sums { first, start_at, start, steps, half, .. } = *sums;
    let anew = if start_at == first { String::new() } else { format!(", and anew every 64 pixels: at {start_at}") };
    let half_words = if half > 0 { ", half a shade added to make the byte the nearest" } else { ", no half added" };
    let back = match sums.step {
        0 => "cut",
        step if step < 0 => "rounded up, back to where it falls from",
        _ => "rounded down, back to where it rises from",
    };
    let back = if half > 0 { format!("the exact shade there {back}") } else { "its left edge's shade".into() };
    text.say("span", &format!("begins at column f = {first}{anew}; this is column {x}"));
    let in_shades = in_units(sums, f64::from(start));
    text.say("start", &format!("0x{} = {in_shades:.3}: {back}{half_words}", hex(sums, start)));
    let step = in_units(sums, sums.step as f64);
    text.say("step", &format!("{} = {step:+.4} a pixel: the slope, cut toward zero", step_in_hex(sums)));
    // Of many the first and the last few.
    let ends = |k: &i32| steps < 2 * ENDS || *k < ENDS || *k > steps - ENDS;
    let mut shown: Vec<String> = (0..=steps).filter(ends).map(|k| hex(sums, sums.after(k))).collect();
    if steps >= 2 * ENDS {
        // A small number.
        shown.insert(ENDS as usize, "...".into());
    }
    let sum = sums.sum();
    let byte = sum >> sums.fraction_bits;
    text.say(
        "sums",
        &format!(
            "{}; after {steps} steps 0x{} = {:.3}, whose whole part is the byte {byte} ({byte:#04x})",
            shown.join(" "),
            hex(sums, sum),
            in_units(sums, f64::from(sum))
        ),
    );
}

/// The way of the byte through the stages.
fn stages(seen: &Seen, whole: bool) -> String {
    let mut words = Vec::new();
    for stage in &seen.stages {
        words.push(match *stage {
            Stage::Shade(shade) => format!("shade {shade}"),
            Stage::Channels([r, g, b]) => format!("rgb {r} {g} {b}"),
            Stage::Dither { threshold, byte } => format!("dither (threshold {threshold}) {byte}"),
            Stage::Texture { texel, byte } => format!("texel {texel} {byte}"),
            Stage::TextureChannels { texel, channels: [r, g, b] } => format!("texel {texel} rgb {r} {g} {b}"),
            Stage::Mix { threshold: Some(threshold), byte } => format!("mix (threshold {threshold}) {byte}"),
            Stage::Mix { threshold: None, byte } => format!("mix {byte}"),
            Stage::Fog { level, byte } => format!("fog (level {level}) {byte}"),
            Stage::Blend { behind, byte } => format!("blend (over {behind}) {byte}"),
        });
    }
    if whole && let [Stage::Shade(byte)] = seen.stages.as_slice() {
        return format!(
            "the shade is the byte: entry {byte} of the palette, in the ramp of entries {} to {}",
            seen.ramp.first(),
            seen.ramp.last()
        );
    }
    words.join(" > ")
}
