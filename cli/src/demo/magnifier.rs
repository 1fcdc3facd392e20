//! The pixels about the mouse, 16 times as large, with their centres and the true edges of the faces that are seen, and
//! the account that the pixel under the mouse gives of itself.
//!
//! Faces and account are worked out in the background. The pixels are those of the frame that they belong to, so that
//! edges and pixels agree while things move. While one steps through a triangle (`step`), the lens follows, and the
//! registers stand above the account.
//!
//! The lens stands in a corner beside the mouse and the account at the edge that is farther from both, no larger than its
//! text, so that what is magnified stays in sight, and most of the picture with it:
//!
//! ```text
//!   mouse: upper left     upper right        lower left          lower right
//!   frame    lens        lens    frame       account             account
//!   frame   frame        frame   frame       frame   frame       frame   frame
//!   account              account             frame    lens       lens    frame
//! ```

use std::ops::Range;

use mode13h::palette::{Palette, Rgb};
use mode13h::raster::{Index, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h::window::Area;
use mode13h_lab::show::{Enlarged, Segment};

use super::background::{Background, Desk};
use super::pixel::Pixel;
use super::shade_trace;
use super::step::Traced;
use crate::failure::Failure;
use crate::overlay::{self, Letters, Sheet};

/// Pixels that the lens is wide and high: a seventh of the frame in all.
const COLUMNS: u16 = 7;
const ROWS: u16 = 5;
/// The place in the lens of the pixel under the mouse.
const MIDDLE: (i32, i32) = (3, 2);
/// Paper under the account, and how much of 255 of it is seen.
const PAPER: (Rgb, u8) = (Rgb::new(0x08, 0x08, 0x10), 224);
/// Pixels of the window between the account and the picture's edge.
const MARGIN: usize = 4;
const WIDTH: i32 = Vga::WIDTH as i32;
const HEIGHT: i32 = Vga::HEIGHT as i32;
/// The lens's sides on the screen.
const LENS: (i32, i32) = (COLUMNS as i32 * Enlarged::ZOOM, ROWS as i32 * Enlarged::ZOOM);

/// The colours that the lens adds, at the end of the palette.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Ink {
    /// Beyond the frame.
    Beyond,
    Grid,
    Edge,
    CentreOnDark,
    CentreOnLight,
    Mouse,
}

impl Ink {
    const COLORS: [u32; 6] = [0x1B2547, 0x2B3863, 0x28C8F0, 0xD8E0FF, 0x283048, 0xFF3060];
    /// The first entry of these colours.
    const FIRST: usize = 256 - Self::COLORS.len();

    fn entry(self) -> u8 {
        // At most 255.
        Self::FIRST as u8 + self as u8
    }

    fn index(self) -> Index {
        Index(self.entry())
    }
}

impl Pixel {
    /// The upper left corner of the lens's view about it, which may lie beyond the frame.
    fn corner(self) -> (i32, i32) {
        (i32::from(self.x) - MIDDLE.0, i32::from(self.y) - MIDDLE.1)
    }

    /// The places of lens and account.
    fn places(self) -> Places {
        let left = i32::from(self.x) < WIDTH / 2;
        let upper = i32::from(self.y) < HEIGHT / 2;
        Places {
            lens: (if left { WIDTH - LENS.0 } else { 0 }, if upper { 0 } else { HEIGHT - LENS.1 }),
            rows: if upper { HEIGHT / 2..HEIGHT } else { 0..HEIGHT / 2 },
            at_bottom: upper,
        }
    }
}

#[derive(Clone, PartialEq, Eq, Debug)]
struct Places {
    /// The lens's upper left corner.
    lens: (i32, i32),
    /// The rows of the frame in which the account may stand, and whether it stands at their lower end.
    rows: Range<i32>,
    at_bottom: bool,
}

/// Question of the lens.
pub(super) struct Question {
    /// The number of the frame.
    pub(super) number: u64,
    pub(super) pixel: Pixel,
    pub(super) scene: Scene,
    /// One set as that which drew the frame.
    pub(super) renderer: Renderer,
    /// The bytes under the lens.
    pub(super) cells: Cells,
}

struct Answer {
    number: u64,
    pixel: Pixel,
    cells: Cells,
    /// Edges of the faces that are seen in the lens, in pixels of the frame.
    edges: Vec<Segment>,
    shade_trace: Vec<String>,
    /// The triangle that is seen at the pixel.
    seen: Option<Traced>,
}

/// The frame's bytes under the lens, row by row; `None` beyond the frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Cells([[Option<u8>; COLUMNS as usize]; ROWS as usize]);

impl Cells {
    pub(super) fn about(pixel: Pixel, vga: &Vga) -> Cells {
        let (left, top) = pixel.corner();
        let mut cells = [[None; COLUMNS as usize]; ROWS as usize];
        for (y, row) in (top..).zip(&mut cells) {
            for (x, cell) in (left..).zip(row) {
                if (0..WIDTH).contains(&x) && (0..HEIGHT).contains(&y) {
                    // Within the frame.
                    *cell = Some(vga.pixels()[(y * WIDTH + x) as usize]);
                }
            }
        }
        Cells(cells)
    }

    fn each(&self) -> impl Iterator<Item = (u16, u16, Option<u8>)> {
        let row = |(y, row): (u16, &[Option<u8>; COLUMNS as usize])| {
            let row = *row;
            (0..COLUMNS).zip(row).map(move |(x, byte)| (x, y, byte))
        };
        (0..ROWS).zip(&self.0).flat_map(row)
    }
}

/// The lens and the thread that works for it.
#[derive(Default)]
pub(super) struct Magnifier {
    thread: Option<Background<Question, Answer>>,
    asked: Option<(u64, Pixel)>,
    last: Option<Answer>,
}

impl Magnifier {
    /// Asks about the pixel in the frame that has this number, unless that was done already, and takes the last answer.
    pub(super) fn follow(
        &mut self,
        number: u64,
        pixel: Pixel,
        question: impl FnOnce() -> Question,
    ) -> Result<(), Failure> {
        let thread = match &mut self.thread {
            Some(thread) => thread,
            none => {
                let work = |question, desk: &Desk<Question, Answer>| desk.give(answer(question));
                none.insert(Background::start("magnifier", work).map_err(Failure::from)?)
            }
        };
        if self.asked != Some((number, pixel)) {
            self.asked = Some((number, pixel));
            thread.ask(question());
        }
        if let Some(answer) = thread.answer() {
            self.last = Some(answer);
        }
        Ok(())
    }

    /// Face seen at a pixel of the frame of this number; `None` until that is known.
    pub(super) fn seen(&self, number: u64, pixel: Pixel) -> Option<Option<&Traced>> {
        let answer = self.last.as_ref().filter(|answer| (answer.number, answer.pixel) == (number, pixel))?;
        Some(answer.seen.as_ref())
    }

    /// Draws the lens over what `vga` shows, which is the frame of this number.
    pub(super) fn lay_over(&self, vga: &mut Vga, number: u64, pixel: Pixel) {
        let last = self.last.as_ref();
        // What is laid over a frame may change while that stays.
        let older = last.filter(|answer| answer.pixel == pixel && answer.number != number);
        let cells = older.map_or_else(|| Cells::about(pixel, vga), |answer| answer.cells.clone());
        let entries = make_room(vga, &cells);
        let Places { lens, .. } = pixel.places();
        let (left, top) = pixel.corner();

        let enlarged = Enlarged { at: lens, columns: COLUMNS, rows: ROWS };
        let palette = vga.palette();
        let mut frame = mode13h::raster::Frame::from(&mut *vga);
        for (x, y, byte) in cells.each() {
            match byte {
                Some(byte) => enlarged.cell(&mut frame, x, y, Index(entries[usize::from(byte)])),
                None => enlarged.empty_cell(&mut frame, x, y, Ink::Beyond.index(), Ink::Grid.index()),
            }
        }
        let moved = |(x, y): (f64, f64)| (x - f64::from(left), y - f64::from(top));
        let edges: Vec<Segment> =
            last.map_or(&[][..], |answer| &answer.edges).iter().map(|edge| edge.map(moved)).collect();
        enlarged.edges(&mut frame, &edges, Ink::Edge.index());
        for (x, y, byte) in cells.each() {
            let is_light = |byte: u8| palette[entries[usize::from(byte)]].brightness() > 110_000;
            let ink = if byte.is_some_and(is_light) { Ink::CentreOnLight } else { Ink::CentreOnDark };
            enlarged.centre(&mut frame, x, y, ink.index());
        }
        // Within the lens.
        enlarged.rim(&mut frame, MIDDLE.0 as u16, MIDDLE.1 as u16, Ink::Mouse.index());

        // Where the lens looks, on the frame, as far as the lens and the account leave room.
        outline(vga, (left - 1, top - 1), (i32::from(COLUMNS) + 2, i32::from(ROWS) + 2), lens);
    }

    /// Writes the account of a pixel at the lower or the upper edge, after lines that come first. In a small window what has
    /// no room is left out, from the end.
    pub(super) fn write(&self, sheet: &mut Sheet, pixel: Pixel, byte: u8, first: Vec<String>) {
        let answer = self.last.as_ref().filter(|answer| answer.pixel == pixel);
        let waiting = [format!("({}, {}) byte {byte}", pixel.x, pixel.y), "computing".to_string()];
        let shade_trace = answer.map_or(&waiting[..], |answer| &answer.shade_trace);
        let picture = sheet.picture_area();
        let Places { rows, at_bottom, .. } = pixel.places();
        // Rows of the window, above what is said at its lower edge.
        let row = |y: i32| picture.from_frame(0.0, y as f32).1 as usize;
        let (top, bottom) = (row(rows.start), row(rows.end).min(sheet.free_bottom()));
        let room = Area { left: picture.left, top, width: picture.width, height: bottom.saturating_sub(top) };
        let lines: Vec<&str> = first.iter().chain(shade_trace).map(String::as_str).collect();
        let letters = [sheet.letters(), Letters::Small]
            .into_iter()
            .find(|&letters| laid_out(&lines, room, letters).1 == lines.len());
        let letters = letters.unwrap_or(Letters::Small);
        let laid = laid_out(&lines, room, letters).0;
        let widest = laid.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let (width, height) = (widest * letters.width() + 2 * MARGIN, laid.len() * letters.line());
        let top = if at_bottom { bottom.saturating_sub(height) } else { room.top };
        sheet.block(Area { left: room.left, top, width, height }, PAPER.0, PAPER.1);
        for (top, line) in (top..).step_by(letters.line()).zip(laid) {
            sheet.text((room.left + MARGIN, top), letters, overlay::TEXT, line);
        }
    }
}

/// Lines of text in lines that fit between the sides of a rectangle, as long as all of one has room above its lower edge;
/// and how many had.
fn laid_out(lines: &[&str], area: Area, letters: Letters) -> (Vec<String>, usize) {
    let columns = area.width.saturating_sub(2 * MARGIN) / letters.width();
    let mut laid = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let wrapped = overlay::wrapped(line, columns);
        if (laid.len() + wrapped.len()) * letters.line() > area.height {
            return (laid, i);
        }
        laid.extend(wrapped);
    }
    (laid, lines.len())
}

/// A rectangle of the lens's own colour, one pixel thick, but not where the lens is.
fn outline(vga: &mut Vga, (left, top): (i32, i32), (width, height): (i32, i32), lens: (i32, i32)) {
    let (right, bottom) = (left + width - 1, top + height - 1);
    for y in top.max(0)..=bottom.min(HEIGHT - 1) {
        for x in left.max(0)..=right.min(WIDTH - 1) {
            let in_lens = (lens.0..lens.0 + LENS.0).contains(&x) && (lens.1..lens.1 + LENS.1).contains(&y);
            if !in_lens && (x == left || x == right || y == top || y == bottom) {
                // Within the frame.
                vga.pixels_mut()[(y * WIDTH + x) as usize] = Ink::Mouse.entry();
            }
        }
    }
}

/// Frees the last entries of the palette for the lens's own colours: bytes that are in use there move to entries that
/// are not, the rarest, if there is no room, to the nearest colour. Returns what has become of each byte.
fn make_room(vga: &mut Vga, cells: &Cells) -> [u8; 256] {
    let mut uses = [0_u32; 256];
    let in_lens = cells.each().filter_map(|(_, _, byte)| byte);
    // What the lens shows is worth as much as all the rest.
    in_lens.for_each(|byte| uses[usize::from(byte)] += 64_000);
    vga.pixels().iter().for_each(|&byte| uses[usize::from(byte)] += 1);
    let shown = vga.palette();
    let mut colors = *shown.colors();
    let mut entries: [u8; 256] = std::array::from_fn(|byte| byte as u8);

    // Entries below the lens's own, the least used first.
    let mut free: Vec<usize> = (0..Ink::FIRST).collect();
    free.sort_by_key(|&entry| uses[entry]);
    let mut free = free.into_iter().peekable();
    let mut moving: Vec<usize> = (Ink::FIRST..256).filter(|&byte| uses[byte] > 0).collect();
    moving.sort_by_key(|&byte| std::cmp::Reverse(uses[byte]));
    let mut homeless = Vec::new();
    for byte in moving {
        match free.next_if(|&entry| uses[entry] < uses[byte]) {
            Some(entry) => {
                if uses[entry] > 0 {
                    homeless.push(entry);
                }
                colors[entry] = shown.colors()[byte];
                // Below 250.
                entries[byte] = entry as u8;
            }
            None => homeless.push(byte),
        }
    }
    let kept = |entry: usize| if entry < Ink::FIRST { colors[entry] } else { colors[0] };
    let searched = Palette::from_colors(std::array::from_fn(kept));
    for byte in homeless {
        entries[byte] = searched.nearest(shown.colors()[byte]);
    }
    for (color, ink) in colors[Ink::FIRST..].iter_mut().zip(Ink::COLORS) {
        *color = Rgb::from(ink);
    }
    vga.set_palette(&Palette::from_colors(colors));
    vga.pixels_mut().iter_mut().for_each(|byte| *byte = entries[usize::from(*byte)]);
    entries
}

fn answer(question: Question) -> Answer {
    let Question { number, pixel, scene, mut renderer, cells } = question;
    let mut triangles = Vec::new();
    let (left, top) = pixel.corner();
    let (columns, rows) = (left..left + i32::from(COLUMNS), top..top + i32::from(ROWS));
    // A scene that cannot be drawn was not drawn either, and the demo has ended.
    let _ = renderer.for_each_triangle(&scene, Screen::MODE_13H, |vertices, _| {
        if meets(vertices, &columns, &rows) {
            triangles.push(*vertices);
        }
    });
    let edges = seen_edges(&triangles, columns, rows);
    let (shade_trace, seen) = shade_trace::lines(&mut renderer, &scene, pixel);
    Answer { number, pixel, cells, edges, shade_trace, seen }
}

/// Returns whether the rectangle about a triangle meets the view.
fn meets(vertices: &[Vertex; 3], columns: &Range<i32>, rows: &Range<i32>) -> bool {
    let meets = |of: fn(&Vertex) -> i32, view: &Range<i32>| {
        let least = vertices.iter().map(of).min().unwrap_or(0);
        let greatest = vertices.iter().map(of).max().unwrap_or(0);
        least <= view.end * 256 && greatest >= view.start * 256
    };
    meets(|v| v.x().to_bits(), columns) && meets(|v| v.y().to_bits(), rows)
}

/// Points along each side of a pixel at which it is looked what is seen. A face that none of them meets is thinner
/// than a quarter of a pixel.
const POINTS: i32 = 4;

/// The edges of those triangles that are in front somewhere in the view, in pixels of the frame.
fn seen_edges(triangles: &[[Vertex; 3]], columns: Range<i32>, rows: Range<i32>) -> Vec<Segment> {
    let corners: Vec<[[f64; 3]; 3]> = triangles.iter().map(|vertices| vertices.each_ref().map(in_pixels)).collect();
    let mut is_seen = vec![false; triangles.len()];
    let points = |view: &Range<i32>| view.start * POINTS..view.end * POINTS;
    let place = |point: i32| (f64::from(point) + 0.5) / f64::from(POINTS);
    for y in points(&rows).map(place) {
        for x in points(&columns).map(place) {
            let depths = corners.iter().enumerate().filter_map(|(i, corners)| Some((depth_at(corners, x, y)?, i)));
            // Of equal ones the first, as the depth buffer has it.
            let front = depths.reduce(|first, next| if next.0 > first.0 { next } else { first });
            if let Some((_, i)) = front {
                is_seen[i] = true;
            }
        }
    }
    let seen = corners.iter().zip(is_seen).filter_map(|(corners, is_seen)| is_seen.then_some(corners));
    let edges = |corners: &[[f64; 3]; 3]| {
        let [a, b, c] = corners.map(|[x, y, _]| (x, y));
        [[a, b], [b, c], [c, a]]
    };
    seen.flat_map(edges).collect()
}

/// x and y in pixels of the frame, and the depth.
fn in_pixels(vertex: &Vertex) -> [f64; 3] {
    let pixels = |bits: i32| f64::from(bits) / 256.0;
    [pixels(vertex.x().to_bits()), pixels(vertex.y().to_bits()), f64::from(vertex.depth())]
}

/// A triangle's depth at a point that it covers.
fn depth_at(corners: &[[f64; 3]; 3], x: f64, y: f64) -> Option<f64> {
    let [a, b, c] = corners;
    let area = |p: &[f64; 3], q: &[f64; 3], (x, y): (f64, f64)| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let whole = area(a, b, (c[0], c[1]));
    let weights = [area(b, c, (x, y)), area(c, a, (x, y)), area(a, b, (x, y))].map(|part| part / whole);
    let inside = whole != 0.0 && weights.iter().all(|weight| *weight >= 0.0);
    inside.then(|| weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::fixed::{I24F8, U8F8};

    #[test]
    fn the_mouse_is_on_the_pixel_whose_area_it_is_in() {
        for (mouse, pixel) in [
            ((0.0, 0.0), Some((0, 0))),
            ((0.99, 1.0), Some((0, 1))),
            ((319.99, 199.99), Some((319, 199))),
            ((160.5, 99.5), Some((160, 99))),
            // On the black beside the picture.
            ((320.0, 100.0), None),
            ((100.0, 200.0), None),
            ((-0.01, 100.0), None),
            ((100.0, -0.01), None),
            ((f32::NAN, 1.0), None),
        ] {
            assert_eq!(Pixel::at(mouse), pixel.map(|(x, y)| Pixel { x, y }), "{mouse:?}");
        }
    }

    #[test]
    fn the_lens_shows_the_pixel_in_its_middle_and_nothing_beyond_the_frame() {
        let mut vga = Vga::new();
        for (i, byte) in vga.pixels_mut().iter_mut().enumerate() {
            *byte = (i * 7 + i / 320 * 13) as u8;
        }
        for y in 0..200 {
            for x in 0..320 {
                let pixel = Pixel { x, y };
                let cells = Cells::about(pixel, &vga);
                for (column, row, byte) in cells.each() {
                    let (at_x, at_y) = (i32::from(x + column) - MIDDLE.0, i32::from(y + row) - MIDDLE.1);
                    let outside = !(0..=319).contains(&at_x) || !(0..=199).contains(&at_y);
                    let expected = (!outside).then(|| vga.pixels()[(at_y * 320 + at_x) as usize]);
                    assert_eq!(byte, expected, "{pixel:?}: {column}, {row}");
                }
            }
        }
    }

    #[test]
    fn what_is_magnified_stays_in_sight() {
        for y in 0..200 {
            for x in 0..320 {
                let Places { lens, rows, .. } = Pixel { x, y }.places();
                let (x, y) = (i32::from(x), i32::from(y));
                assert!(!(lens.0..lens.0 + LENS.0).contains(&x) || !(lens.1..lens.1 + LENS.1).contains(&y));
                assert!(!rows.contains(&y));
                // Lens and account lie on the frame and not on each other.
                assert!(lens.0 >= 0 && lens.0 + LENS.0 <= WIDTH && lens.1 >= 0 && lens.1 + LENS.1 <= HEIGHT);
                assert!(0 <= rows.start && rows.end <= HEIGHT);
                assert!(lens.1 + LENS.1 <= rows.start || rows.end <= lens.1);
            }
        }
    }

    /// Lens and account cover at most half of the picture, in each window that there is room for the account in; nothing
    /// is said below the account, or on it.
    #[test]
    fn most_of_the_picture_is_left() {
        let scene = "crate"
            .parse::<mode13h_assets::shipped::Shipped>()
            .expect("a shipped scene")
            .load()
            .expect("a scene")
            .scene;
        for size in overlay::tests::WINDOWS {
            for (x, y) in [(160, 90), (160, 110), (100, 99), (219, 100), (0, 0), (319, 199)] {
                let pixel = Pixel { x, y };
                let (lines, _) = shade_trace::lines(&mut Renderer::new(), &scene, pixel);
                let last = Answer {
                    number: 0,
                    pixel,
                    cells: Cells::about(pixel, &Vga::new()),
                    edges: Vec::new(),
                    shade_trace: lines,
                    seen: None,
                };
                let magnifier = Magnifier { last: Some(last), ..Magnifier::default() };
                let mut sheet = Sheet::new(size);
                sheet.message(overlay::TEXT, "stopped");
                magnifier.write(&mut sheet, pixel, 0, Vec::new());
                assert_eq!(sheet.faults(), [""; 0], "{pixel:?} in {size:?}");
                let picture = sheet.picture_area();
                let whole = (picture.width * picture.height) as f64;
                let lens = f64::from(LENS.0 * LENS.1) / f64::from(WIDTH * HEIGHT);
                let covered =
                    lens + sheet.blocks().last().map_or(0.0, |area| (area.width * area.height) as f64 / whole);
                assert!(covered <= if size.0 < 640 { 0.65 } else { 0.5 }, "{covered} at {pixel:?} in {size:?}");
            }
        }
    }

    #[test]
    fn the_frame_keeps_its_colours_beside_the_lens() {
        // All entries but 20 low ones in use, the last among them; then all, where six must give way.
        for (first, may_change) in [(20_usize, 0), (0, 6)] {
            let mut vga = Vga::new();
            let colors = std::array::from_fn(|i| Rgb::new((i as u8) & 0xFC, 255 - ((i as u8) & 0xFC), (i as u8) << 6));
            vga.set_palette(&Palette::from_colors(colors));
            for (i, byte) in vga.pixels_mut().iter_mut().enumerate() {
                *byte = (first + i % (256 - first)) as u8;
            }
            let pixel = Pixel { x: 160, y: 100 };
            let cells = Cells::about(pixel, &vga);
            let mut before = vec![0; Vga::SHOWN];
            vga.scan_out(&mut before);
            let bytes = vga.pixels().to_vec();
            make_room(&mut vga, &cells);
            let mut after = vec![0; Vga::SHOWN];
            vga.scan_out(&mut after);
            let changed: std::collections::BTreeSet<u8> =
                (0..Vga::SHOWN).filter(|&i| before[i] != after[i]).map(|i| bytes[i]).collect();
            assert!(changed.len() <= may_change, "{changed:?}");
            assert!(vga.pixels().iter().all(|&byte| usize::from(byte) < Ink::FIRST));
            assert!(cells.each().all(|(_, _, byte)| byte.is_none_or(|byte| !changed.contains(&byte))));
        }
    }

    #[test]
    fn only_edges_of_faces_that_are_seen_are_drawn() {
        let vertex = |x: i32, y: i32, depth| {
            Vertex::new(I24F8::from_bits(x * 256), I24F8::from_bits(y * 256), U8F8::from_bits(0), depth)
                .expect("on the screen")
        };
        let triangle = |depth| [vertex(0, 0, depth), vertex(20, 0, depth), vertex(0, 20, depth)];
        let seen = seen_edges(&[triangle(5), triangle(9), triangle(9)], 0..10, 0..7);
        assert_eq!(seen, [[(0.0, 0.0), (20.0, 0.0)], [(20.0, 0.0), (0.0, 20.0)], [(0.0, 20.0), (0.0, 0.0)]]);
        assert!(seen_edges(&[triangle(5)], 30..40, 0..7).is_empty());
        // No area.
        let line = [vertex(0, 0, 1), vertex(5, 5, 1), vertex(9, 9, 1)];
        assert!(seen_edges(&[line], 0..10, 0..7).is_empty());
        assert!(meets(&triangle(1), &(15..25), &(-3..4)));
        assert!(!meets(&triangle(1), &(21..31), &(-3..4)));
    }
}
