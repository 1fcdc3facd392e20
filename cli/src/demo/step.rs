//! Stepping through a triangle in the magnifier, pixel by pixel as the loop of 1994 writes it, with its registers.
//!
//! It begins with the face that is seen under the mouse and stops the clock. It ends when the mouse goes to another pixel.

use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::Screen;
use mode13h::window::{Input, Key};
use mode13h_lab::explain::{self, FaceHere, Progression, Seen, ShadedBy, Walk};

use super::pixel::Pixel;

/// A triangle that is seen at a pixel.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Traced {
    name: String,
    corners: [Vertex; 3],
    interpolation: Interpolation,
    exact_cover: bool,
    /// Source of its shades, if the loop does not make them.
    other: Option<&'static str>,
    /// True if something is made of the loop's byte before it is shown.
    has_effects: bool,
}

impl Traced {
    /// Takes the face that is seen at a pixel that gave this account.
    pub(super) fn of(shade_trace: &explain::Pixel) -> Option<Traced> {
        let (face, seen) = shade_trace.front()?;
        let object = shade_trace.objects.get(face.object).map_or("", String::as_str);
        let name = match face.triangle {
            Some(triangle) => format!("{object}, triangle {triangle}"),
            None => object.to_string(),
        };
        let (corners, interpolation, exact_cover) = (face.corners, face.interpolation, seen.exact_cover);
        let has_effects = seen.stages.len() > 1;
        Some(Traced { name, corners, interpolation, exact_cover, other: other(face, seen), has_effects })
    }
}

/// Source of a face's shades, if the loop does not make them.
fn other(face: &FaceHere, seen: &Seen) -> Option<&'static str> {
    match (seen.shaded_by, face.interpolation) {
        (ShadedBy::Light { .. } | ShadedBy::BetweenLit { .. } | ShadedBy::BetweenSix(_), _) => {
            Some("light worked out at the pixels")
        }
        (ShadedBy::NormalTable, _) => Some("a table of normals"),
        (ShadedBy::Corners, _) if seen.accounts.len() != 1 => Some("red, green and blue, a sum each"),
        (ShadedBy::Corners, Interpolation::Flat(_)) => Some("one shade for the face"),
        (ShadedBy::Corners, Interpolation::GouraudHyperbolic | Interpolation::Float) => {
            Some("a quotient at every pixel")
        }
        (ShadedBy::Corners, _) => None,
    }
}

/// Steps that keys ask for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
struct Wished {
    pixels: isize,
    rows: isize,
}

impl Wished {
    /// Reads the keys: a key that is held goes on.
    fn of(input: &Input) -> Wished {
        let typed = |wanted: char| input.typed.chars().filter(|typed| *typed == wanted).count() as isize;
        let with_shift = |key| isize::from(input.pressed_with_shift(key));
        // With Shift a comma may be typed as one too, on some keyboard.
        let (back, on) = (with_shift(Key::Comma), with_shift(Key::Period));
        Wished {
            pixels: if on == 0 { typed('.') } else { 0 } - if back == 0 { typed(',') } else { 0 },
            rows: on - back,
        }
    }
}

/// Place in a triangle.
#[derive(Debug)]
struct Place {
    /// Place of the mouse when it began.
    mouse: Pixel,
    pixel: Pixel,
    /// The number of the picture that the walk is of.
    number: u64,
    walk: Option<(Traced, Walk)>,
    /// Steps that wait for the walk.
    waiting: Wished,
}

/// Goes through a triangle, once a key was pressed.
#[derive(Debug, Default)]
pub(super) struct Stepper(Option<Place>);

impl Stepper {
    /// Steps by the keys, from the pixel under the mouse. Whether a step was asked for.
    pub(super) fn follow(&mut self, input: &Input, mouse: Pixel) -> bool {
        if self.0.as_ref().is_some_and(|place| place.mouse != mouse) {
            self.stop();
        }
        self.wish(Wished::of(input), mouse)
    }

    fn wish(&mut self, wished: Wished, mouse: Pixel) -> bool {
        if wished == Wished::default() {
            return false;
        }
        let begin = || Place { mouse, pixel: mouse, number: 0, walk: None, waiting: Wished::default() };
        let place = self.0.get_or_insert_with(begin);
        place.waiting.pixels += wished.pixels;
        place.waiting.rows += wished.rows;
        place.go();
        true
    }

    pub(super) fn stop(&mut self) {
        self.0 = None;
    }

    /// The pixel that was reached; `None` while nobody steps.
    pub(super) fn pixel(&self) -> Option<Pixel> {
        self.0.as_ref().map(|place| place.pixel)
    }

    /// Says what is seen at that pixel in the picture of this number, if anything. A walk over that picture goes on; in
    /// another picture one begins at the pixel that was reached.
    pub(super) fn take_up(&mut self, number: u64, seen: Option<&Traced>) {
        let Some(place) = &mut self.0 else { return };
        if place.number == number && place.walk.is_some() {
            return;
        }
        place.number = number;
        place.walk = seen.map(|traced| {
            let Traced { corners, interpolation, exact_cover, .. } = traced;
            (traced.clone(), Walk::new(corners, *interpolation, *exact_cover, Screen::MODE_13H))
        });
        if place.walk.is_none() {
            place.waiting = Wished::default();
        }
        place.go();
    }

    /// Lines on the registers at the pixel that was reached in the picture of this number, whose byte there is given.
    /// None while nobody steps.
    pub(super) fn lines(&self, number: u64, byte: u8) -> Vec<String> {
        let Some(place) = &self.0 else { return Vec::new() };
        let walk = place.walk.as_ref().filter(|_| place.number == number);
        let Some((traced, walk)) = walk else { return vec!["no triangle to step through here".into()] };
        let Some(step) = walk.number(place.pixel.x.into(), place.pixel.y.into()).and_then(|at| walk.step(at)) else {
            return vec![format!("{} does not cover this pixel", traced.name)];
        };
        let (row, column) = (step.row + 1, step.column + 1);
        let mut lines =
            vec![format!("{}: row {row} of {}, pixel {column} of {}", traced.name, walk.rows(), step.columns)];
        let at = format!("({}, {})", step.x, step.y);
        let (Progression::Accumulator(sums), Some(registers), None) =
            (step.shade_trace.way, step.registers, traced.other)
        else {
            let other = traced.other.unwrap_or_default();
            lines.push(format!("{at} has the byte {byte}; registers are of the loop for linear shades, here: {other}"));
            return lines;
        };
        let (edi, eax, ebx, cx) = (registers.edi, registers.eax, registers.ebx, registers.cx);
        lines.push(match sums.fraction_bits {
            8 => format!("EDI {edi:04X}  AX {eax:04X}  BX {ebx:04X}  CX {cx:04X}"),
            _ => format!("EDI {edi:04X}  EAX {eax:08X}  EBX {ebx:08X}  CX {cx:04X}"),
        });
        let written = step.shade_trace.byte;
        let unit = f64::from(1_u32 << sums.fraction_bits);
        let from = if sums.fraction_bits == 8 { "AH" } else { "EAX shifted by 16" };
        let in_frame = match written == byte {
            true => ", as the frame has it".into(),
            false if traced.has_effects => format!(", of which the effects make {byte}"),
            false => format!("; the frame has {byte}: another face is in front"),
        };
        lines.push(format!("{at} gets {from}: {written:02X}h = {written}{in_frame}"));
        if let Some(exact) = step.shade_trace.exact {
            let shade = exact.to_f64() / 256.0;
            let off = f64::from(written) - shade;
            lines.push(format!("exact {shade:.4}: the byte is off by {off:+.4}"));
            lines.push(format!("= {} / {} / 256", exact.numerator, exact.denominator));
        }
        let half = if sums.half > 0 { ", half a shade included" } else { "" };
        let again = if traced.interpolation == Interpolation::GouraudReseeded { ", anew every 64" } else { "" };
        lines.push(format!("shade {:.4}{half}, step {:+.4}", f64::from(eax) / unit, sums.step as f64 / unit));
        lines.push(format!("started at column {}{again}; {cx} left", step.start));
        lines
    }
}

impl Place {
    /// Takes the steps that wait, as far as the triangle reaches.
    fn go(&mut self) {
        let Some((_, walk)) = &self.walk else { return };
        let Wished { pixels, rows } = std::mem::take(&mut self.waiting);
        let Some(at) = walk.number(self.pixel.x.into(), self.pixel.y.into()) else { return };
        let last = walk.pixels().saturating_sub(1);
        let row = walk.step(at).map_or(0, |step| step.row);
        let at = match rows {
            0 => at,
            _ => walk.first_in(row.saturating_add_signed(rows).min(walk.rows().saturating_sub(1))).unwrap_or(at),
        };
        if let Some(step) = walk.step(at.saturating_add_signed(pixels).min(last)) {
            // Within the frame.
            self.pixel = Pixel { x: step.x as u16, y: step.y as u16 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::fixed::{I24F8, U8F8};
    use mode13h::render::Renderer;
    use mode13h::scene::Scene;
    use mode13h::settings::Shading;
    use mode13h::vga::Vga;

    /// Eight pixels wide at the top, one at the bottom, four rows high; the shade of pixel x of row 0 is 50 + 20·x.
    fn traced(interpolation: Interpolation) -> Traced {
        let corner = |x, y, shade| {
            let (x, y) = (I24F8::from(x), I24F8::from(y));
            Vertex::new(x, y, U8F8::from(shade), 100).expect("a legal vertex")
        };
        let corners = [corner(10, 20, 40), corner(18, 20, 200), corner(10, 24, 40)];
        let name = "body, triangle 7".to_string();
        Traced { name, corners, interpolation, exact_cover: true, other: None, has_effects: false }
    }

    const MOUSE: Pixel = Pixel { x: 12, y: 20 };

    fn at(stepper: &Stepper) -> (u16, u16) {
        stepper.pixel().map(|pixel| (pixel.x, pixel.y)).expect("somewhere")
    }

    #[test]
    fn it_goes_through_the_pixels_row_by_row_and_no_farther() {
        let mut stepper = Stepper::default();
        assert!(!stepper.wish(Wished::default(), MOUSE) && stepper.pixel().is_none());
        // The first steps wait until it is known what is seen.
        for _ in 0..2 {
            assert!(stepper.wish(Wished { pixels: 1, rows: 0 }, MOUSE));
        }
        assert_eq!(at(&stepper), (12, 20));
        stepper.take_up(5, Some(&traced(Interpolation::Gouraud)));
        assert_eq!(at(&stepper), (14, 20));
        let mut go = |pixels, rows| {
            stepper.wish(Wished { pixels, rows }, MOUSE);
            at(&stepper)
        };
        // Rows of 7, 5, 3 and 1: the centres left of the slope.
        assert_eq!([go(3, 0), go(-1, 0), go(1, 0)], [(10, 21), (16, 20), (10, 21)]);
        assert_eq!([go(0, 1), go(1, 0), go(0, 1), go(0, 1)], [(10, 22), (11, 22), (10, 23), (10, 23)]);
        assert_eq!([go(1, 0), go(-99, 0), go(-1, 0), go(0, -1)], [(10, 23), (10, 20), (10, 20), (10, 20)]);
        stepper.stop();
        assert!(stepper.pixel().is_none() && stepper.lines(5, 0).is_empty());
    }

    #[test]
    fn it_says_what_the_registers_hold() {
        let mut stepper = Stepper::default();
        stepper.wish(Wished { pixels: 1, rows: 0 }, MOUSE);
        assert_eq!(stepper.lines(5, 0), ["no triangle to step through here"]);
        stepper.take_up(5, Some(&traced(Interpolation::GouraudReseeded)));
        // 320·20 + 13 is 190Dh; three times 20 more than 50.5.
        let lines = stepper.lines(5, 110);
        let registers = [
            "body, triangle 7: row 1 of 4, pixel 4 of 7",
            "EDI 190D  AX 6E80  BX 1400  CX 0004",
            "(13, 20) gets AH: 6Eh = 110, as the frame has it",
            "exact 110.0000: the byte is off by +0.0000",
        ];
        assert_eq!(lines[..4], registers);
        let start =
            ["shade 110.5000, half a shade included, step +20.0000", "started at column 10, anew every 64; 4 left"];
        assert_eq!(lines[5..], start);
        assert!(stepper.lines(5, 9)[2].ends_with("the frame has 9: another face is in front"));
        // Another picture: the walk is of none, until it is known what is seen there.
        assert_eq!(stepper.lines(6, 110).len(), 1);
        stepper.take_up(6, Some(&traced(Interpolation::Gouraud1616)));
        assert_eq!(stepper.lines(6, 110)[1], "EDI 190D  EAX 006E8000  EBX 00140000  CX 0004");
        let quotient = Traced { other: Some("a quotient at every pixel"), ..traced(Interpolation::Float) };
        stepper.take_up(7, Some(&quotient));
        let lines = stepper.lines(7, 110);
        assert!(lines[1].ends_with("registers are of the loop for linear shades, here: a quotient at every pixel"));
        assert_eq!(lines.len(), 2);
    }

    #[test]
    fn every_shading_can_be_stepped_through() {
        let scene = Scene::showing(mode13h::mesh::shapes::torus(24, 12));
        for shading in Shading::ALL {
            let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
            renderer.settings.accuracy = Some(shading.into());
            renderer.draw(&scene, &mut vga).expect("a legal scene");
            let shade_trace = explain::pixel(&mut renderer, &scene, Screen::MODE_13H, 100, 100).expect("a legal scene");
            let traced = Traced::of(&shade_trace).expect("the torus is there");
            let (mut stepper, mouse) = (Stepper::default(), Pixel { x: 100, y: 100 });
            stepper.wish(Wished { pixels: 0, rows: 0 }, mouse);
            stepper.wish(Wished { pixels: 1, rows: 0 }, mouse);
            stepper.take_up(1, Some(&traced));
            let keeps_sums =
                [Shading::Gouraud88, Shading::Gouraud88Reseeded, Shading::Gouraud1616, Shading::GouraudVintage]
                    .contains(&shading)
                    || shading == Shading::GouraudTessellated;
            assert_eq!(stepper.lines(1, 0).iter().any(|line| line.starts_with("EDI")), keeps_sums, "{shading}");
        }
    }
}
