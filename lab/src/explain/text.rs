//! A pixel explained in words.

use core::fmt;

use super::edge::EdgeKind;
use super::face::FaceHere;
use super::one_pixel::ShadedBy;
use super::paragraph::Text;
use super::pixel::{Pixel, PixelStage, Seen};
use super::span_text::{say_account, short_account};
use super::trace::Fate;
use mode13h::plan::Effect;
use mode13h::plan::FaceShading;
use mode13h::raster::Interpolation;
use mode13h::settings::Shading;

/// The maximum number of triangles listed.
const LISTED: usize = 6;

impl fmt::Display for Pixel {
    /// Lines of at most 100 columns.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = Text(String::new());
        let Self { x, y, byte, color, .. } = self;
        text.line(&format!("pixel ({x}, {y}): byte {byte} ({byte:#04x}), which the palette shows as #{color:06x}"));
        if self.seen.is_empty() {
            let words =
                format!("the background: no triangle covers its centre; the frame was cleared to {}", self.background);
            text.say("seen", &words);
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
    /// Names an object and one of its triangles, with its material and its line in the model's file.
    fn name(&self, face: &FaceHere) -> String {
        let mut name = self.objects.get(face.object).cloned().unwrap_or_default();
        if let Some(triangle) = face.triangle {
            let part = if face.is_part { "a part of " } else { "" };
            name += &format!(", {part}triangle {triangle}");
        }
        if let Some(line) = face.line {
            name += &format!(" (line {line} of the model)");
        }
        if let Some(material) = &face.material {
            name += &format!(", material {material}");
        }
        name
    }

    /// The technique that shades a face, whatever was asked for.
    fn shading_of(&self, face: &FaceHere, seen: &Seen) -> FaceShading {
        let by_shading = match face.interpolation {
            Interpolation::Flat(_) => Shading::Flat,
            Interpolation::GouraudVintage => Shading::GouraudVintage,
            Interpolation::Gouraud88 => Shading::Gouraud88,
            Interpolation::Gouraud88Reseeded => Shading::Gouraud88Reseeded,
            Interpolation::Gouraud1616 => Shading::Gouraud1616,
            Interpolation::GouraudHyperbolic => Shading::GouraudHyperbolic,
            Interpolation::GouraudFloat => Shading::GouraudFloat,
            _ => self.shading,
        };
        match seen.shaded_by {
            ShadedBy::NormalTable => Shading::PhongTable.into(),
            ShadedBy::Light { .. } => Shading::Phong.into(),
            ShadedBy::BetweenLit { spacing, .. } => FaceShading::PhongEvery(spacing),
            ShadedBy::BetweenSix(_) => FaceShading::Quadratic,
            ShadedBy::Corners if face.is_part && by_shading == Shading::Gouraud88Reseeded => {
                Shading::GouraudTessellated.into()
            }
            ShadedBy::Corners if self.shading == Shading::Flat => Shading::Flat.into(),
            ShadedBy::Corners => by_shading.into(),
        }
    }

    /// Says briefly which face is seen through another.
    fn say_behind(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let shade_trace = seen
            .accounts
            .first()
            .and_then(short_account)
            .map(|shade_trace| format!("{shade_trace}; "))
            .unwrap_or_default();
        let words =
            format!("{}, {}: {shade_trace}{}", self.name(face), self.shading_of(face, seen), stages(seen, false));
        text.say("through", &words);
    }

    fn say_seen(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let through = if face.fate == Fate::SeenThrough { ", which is transparent" } else { "" };
        text.say("seen", &format!("{}{through}", self.name(face)));
        self.say_corners(text, face, seen);
        self.say_shading(text, face, seen);
        match (&seen.shaded_by, seen.accounts.as_slice()) {
            (ShadedBy::Light { normal, position, shades }, _) => {
                let point = |p: &[f32; 3]| format!("({:.4}, {:.4}, {:.4})", p[0], p[1], p[2]);
                let words = format!(
                    "normal {}, not yet normalised, at {} in object space: interpolated \
                     perspective-correctly from the corners and lit by the whole model: {}",
                    point(normal),
                    point(position),
                    in_shades(seen, shades),
                );
                text.say("light", &words);
            }
            (ShadedBy::BetweenLit { spacing, before, after }, _) => {
                let words = format!(
                    "linear between two pixels of its row, at most {} apart, that are lit by the whole model: {} and {}",
                    spacing.pixels(),
                    in_shades(seen, before),
                    in_shades(seen, after),
                );
                text.say("light", &words);
            }
            (ShadedBy::BetweenSix(corners), _) => {
                let shades = |first: usize| corners.map(|of| format!("{:.2}", of[first] / 256.0)).join(", ");
                let words = format!(
                    "quadratic on the screen through light at six points: {} at the corners, {} at the midpoints of \
                     the opposite edges; light continues above 1 and below the horizon, and is clamped here",
                    shades(0),
                    shades(3),
                );
                text.say("light", &words);
            }
            (ShadedBy::NormalTable, [across, down]) => {
                let words = format!(
                    "column {} and row {} of a table of 256 x 256 normals: x and y in eye space, linear from corner \
                     to corner like shades",
                    across.byte, down.byte
                );
                text.say("normal", &words);
            }
            (_, [only]) => say_account(text, only, self.x),
            (_, all) => {
                for (name, shade_trace) in ["red", "green", "blue"].iter().zip(all) {
                    text.say(name, &short_account(shade_trace).unwrap_or_else(|| shade_trace.byte.to_string()));
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
            let shown = match (seen.stages.first(), seen.ramp.entries()) {
                (Some(PixelStage::Shade(shade)), entries @ 2..256) => {
                    // A shade lies within its ramp.
                    let (step, steps) = (f64::from(*shade) - f64::from(seen.ramp.first()), f64::from(entries - 1));
                    format!("; the byte is step {step} of the ramp's {steps}: {:.3}", 255.0 * step / steps)
                }
                _ => String::new(),
            };
            text.say("truth", &format!("{}, of 255 shades{shown}", errors.join(", ")));
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
        let flat = matches!(face.interpolation, Interpolation::Flat(_));
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
            let words =
                "on whole pixels, from Ax to the last before Bx in each row: no edge functions, no exact coverage";
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

    fn say_shading(&self, text: &mut Text, face: &FaceHere, seen: &Seen) {
        let drawn = self.shading_of(face, seen);
        let runs = seen.effects.iter().any(|row| row.effect == Effect::Gouraud);
        let words = if let Some(shades) = self.max_error {
            format!("{drawn}: chosen for this face by the budget of {shades} shades")
        } else if drawn == self.shading.into() {
            format!("{drawn}: {}", self.shading_why)
        } else if drawn == Shading::Flat.into() && !runs {
            format!("{drawn}: its corners have one shade (otherwise {}: {})", self.shading, self.shading_why)
        } else {
            format!("{drawn}, where {} is on ({})", self.shading, self.shading_why)
        };
        text.say("shading", &words);
    }

    /// Says what else covers the pixel.
    fn say_others(&self, text: &mut Text) {
        let others: Vec<&FaceHere> =
            self.faces.iter().filter(|face| !matches!(face.fate, Fate::Seen | Fate::SeenThrough)).collect();
        let method = format!("hidden surfaces by {}", self.hidden_surfaces);
        let method = match self.hidden_surfaces_why.as_str() {
            "" => method,
            reason => format!("{method}: {reason}"),
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
                Fate::NotItsEdge => "on its right or bottom edge: not its pixel",
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

/// A shade as light, of one channel or three.
fn in_shades(seen: &Seen, shades: &[u16; 3]) -> String {
    let [r, g, b] = shades.map(|shade| f64::from(shade) / 256.0);
    if matches!(seen.stages.first(), Some(PixelStage::Channels(_))) {
        format!("red {r:.3}, green {g:.3}, blue {b:.3}")
    } else {
        format!("shade {r:.3} ({:#06x})", shades[0])
    }
}

/// The level that a texel comes from, to append to its value.
fn of_level(level: Option<u8>) -> String {
    level.map_or(String::new(), |level| format!(" of level {level}"))
}

/// How the byte passes through the stages.
fn stages(seen: &Seen, whole: bool) -> String {
    if whole && let [PixelStage::Shade(byte)] = seen.stages.as_slice() {
        let (first, last) = (seen.ramp.first(), seen.ramp.last());
        return format!("the shade is the byte: entry {byte} of the palette, in the ramp of entries {first} to {last}");
    }
    let words = seen.stages.iter().map(|stage| match *stage {
        PixelStage::Shade(shade) => format!("shade {shade}"),
        PixelStage::Channels([r, g, b]) => format!("rgb {r} {g} {b}"),
        PixelStage::Dither { threshold, byte } => format!("dither by {threshold}: {byte}"),
        PixelStage::Texture { texel, level, byte } => format!("texel {texel}{}: {byte}", of_level(level)),
        PixelStage::TextureChannels { texel, level, channels: [r, g, b] } => {
            format!("texel {texel}{}: {r} {g} {b}", of_level(level))
        }
        PixelStage::Mix { threshold: Some(threshold), byte } => format!("mix, dither by {threshold}: {byte}"),
        PixelStage::Mix { threshold: None, byte } => format!("mix: {byte}"),
        PixelStage::Fog { level, byte } => format!("fog of {level}: {byte}"),
        PixelStage::Blend { behind, byte } => format!("over {behind}: {byte}"),
    });
    words.collect::<Vec<_>>().join(" > ")
}
