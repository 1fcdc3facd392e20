//! Hidden surfaces: depth buffer against scan-line, byte for byte, on all input; painter's order and
//! back faces where they are right; depth order against exact rationals.

mod support;

use mode13h::raster::scan_line::Lists;
use mode13h::raster::{Drawn, Frame, Raster, Rect, Shading, Vertex};
use support::random::Random;
use support::triangles::{triangle, vertex};
use support::tried::Tried;

type Face = ([Vertex; 3], Shading);

/// A frame, drawn into by one method; with what the raster counted.
#[derive(Clone, Copy)]
struct Sheet {
    width: u32,
    height: u32,
    clip: Rect,
    /// Rows of a band.
    rows_each: u32,
}

impl Sheet {
    const EMPTY: u8 = 3;

    fn new(width: u32, height: u32) -> Self {
        Self { width, height, clip: Rect { x0: 0, y0: 0, x1: width, y1: height }, rows_each: height }
    }

    fn draw(self, mut paint: impl FnMut(Raster<'_>) -> Drawn) -> (Vec<u8>, Drawn) {
        // Bytes between the rows, and after them, must stay.
        let pitch = self.width as usize + 3;
        let mut bytes = vec![Self::EMPTY; pitch * self.height as usize];
        let mut drawn = Drawn::default();
        let mut frame = Frame::new(&mut bytes, self.width, self.height, pitch).expect("legal");
        for band in frame.bands(self.rows_each) {
            drawn += paint(Raster::new(band).with_clip(self.clip));
        }
        for row in bytes.chunks(pitch) {
            assert_eq!(row[self.width as usize..], [Self::EMPTY; 3], "bytes between the rows stay");
        }
        (bytes, drawn)
    }

    fn depth_buffer(self, faces: &[Face]) -> (Vec<u8>, Drawn) {
        let mut depths: Vec<u32> = Vec::new();
        self.draw(|raster| in_turn(raster.with_cleared_depth(&mut depths), faces))
    }

    fn scan_line(self, lists: &mut Lists, faces: &[Face]) -> (Vec<u8>, Drawn) {
        self.draw(|mut raster| raster.scan_line(faces, lists.scratch(faces.len())).expect("room enough"))
    }
}

fn in_turn(mut raster: Raster<'_>, faces: &[Face]) -> Drawn {
    let mut drawn = Drawn::default();
    for (vertices, shading) in faces {
        drawn += raster.triangle(vertices, *shading);
    }
    drawn
}

/// Both methods, whole, clipped and in bands.
fn check(random: &mut Random, lists: &mut Lists, width: u32, height: u32, faces: &[Face]) {
    let whole = Sheet::new(width, height);
    let mut ends = |size: u32| {
        let (a, b) = (random.within(0, size.into()) as u32, random.within(0, size.into()) as u32);
        (a.min(b), a.max(b))
    };
    let ((x0, x1), (y0, y1)) = (ends(width), ends(height));
    let clip = Rect { x0, y0, x1, y1 };
    let rows_each = random.within(1, height.into()) as u32;
    for sheet in [whole, Sheet { clip, ..whole }, Sheet { rows_each, ..whole }, Sheet { clip, rows_each, ..whole }] {
        let (by_depth, depth_drawn) = sheet.depth_buffer(faces);
        let (by_line, line_drawn) = sheet.scan_line(lists, faces);
        if by_depth != by_line {
            let (sheet, faces) = shrink(sheet, lists, faces);
            let at =
                sheet.depth_buffer(&faces).0.iter().zip(&sheet.scan_line(lists, &faces).0).position(|(a, b)| a != b);
            panic!(
                "byte {at:?}, {} × {}, {:?}, bands of {}: {faces:?}",
                sheet.width, sheet.height, sheet.clip, sheet.rows_each
            );
        }
        assert_eq!(line_drawn.covered, depth_drawn.covered);
        // Each pixel once: those that the depth buffer holds something for.
        let mut depths: Vec<u32> = Vec::new();
        let mut shown = 0;
        sheet.draw(|raster| {
            let drawn = in_turn(raster.with_cleared_depth(&mut depths), faces);
            shown += depths.iter().filter(|depth| **depth > 0).count();
            drawn
        });
        assert_eq!(line_drawn.pixels as usize, shown, "each pixel is written once");
    }
}

/// The smallest case that still fails, by leaving out one face after another.
fn shrink(sheet: Sheet, lists: &mut Lists, faces: &[Face]) -> (Sheet, Vec<Face>) {
    let mut faces = faces.to_vec();
    let mut i = 0;
    while i < faces.len() {
        let mut fewer = faces.clone();
        fewer.remove(i);
        if sheet.depth_buffer(&fewer).0 == sheet.scan_line(lists, &fewer).0 {
            i += 1;
        } else {
            faces = fewer;
        }
    }
    (sheet, faces)
}

fn with_depths(vertices: [Vertex; 3], mut depth: impl FnMut() -> i64) -> [Vertex; 3] {
    vertices.map(|v| vertex(v.x().to_bits().into(), v.y().to_bits().into(), v.shade().to_bits().into(), depth()))
}

fn soups(at_least: u64) {
    let mut tried = Tried::new("d_soups", at_least);
    let mut random = Random::named("d soups");
    let mut lists = Lists::default();
    while tried.more() {
        let (width, height) = random.one_of(&[(96, 24), (200, 40), (17, 60), (320, 20), (1, 9), (70, 1)]);
        let mut faces: Vec<Face> = Vec::new();
        // Depths of all sizes; few and near to each other, so that many are equal; up to the greatest; one for all.
        let kind = random.within(0, 4);
        for _ in 0..random.log_uniform(7) {
            let mut vertices = triangle(&mut random, width.into(), height.into());
            match kind {
                0 => {}
                1 => vertices = with_depths(vertices, || random.within(0, 4)),
                2 => vertices = with_depths(vertices, || random.one_of(&[0, 1, 0xFFFF_FFFF, 0xFFFF_FFFE, 1 << 30])),
                3 => vertices = with_depths(vertices, || 1000 + random.log_uniform(5) as i64),
                _ => vertices = with_depths(vertices, || 7),
            }
            let shading =
                random.one_of(&[Shading::GouraudReseeded, Shading::Gouraud, Shading::Flat(0), Shading::Flat(200)]);
            faces.push((vertices, shading));
            if random.within(0, 5) == 0 {
                // Again, and turned round, in other shades.
                let [a, b, c] = vertices.map(|v| v.with_shade(mode13h::fixed::U8F8::from_shade(77)));
                faces.push((random.one_of(&[[a, b, c], [c, b, a]]), shading));
            }
        }
        check(&mut random, &mut lists, width, height, &faces);
    }
}

#[test]
fn d_soups() {
    soups(1500);
}

#[test]
#[ignore = "the long run: 300,000 soups"]
fn d_long_soups() {
    soups(300_000);
}
