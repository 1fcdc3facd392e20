//! A display for readable tests: triangles are drawn into it with the raster, each of its pixels may be drawn only
//! once, and what it shows is compared with a picture made of characters.

use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};

pub struct Display {
    width: u32,
    height: u32,
    marks: Vec<char>,
}

impl Display {
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, marks: vec!['.'; (width * height) as usize] }
    }

    /// Draws a triangle with corners in pixels, using the given mark. Fails on a pixel that is already drawn, or if the
    /// raster's count differs from what it wrote.
    #[track_caller]
    pub fn draw(&mut self, mark: char, corners: [(f64, f64); 3]) -> &mut Self {
        let vertices = corners.map(|(x, y)| {
            let coordinate = |pixels| I24F8::round_from_f64(pixels).expect("a coordinate");
            Vertex::new(coordinate(x), coordinate(y), U8F8::from(0), 0).expect("inside the guard band")
        });
        let mut bytes = vec![0_u8; self.marks.len()];
        let frame = Frame::new(&mut bytes, self.width, self.height, self.width as usize).expect("a small frame");
        let drawn = Raster::new(frame).triangle(&vertices, Interpolation::Flat(1));
        let mut written = 0;
        for (place, (byte, old)) in bytes.iter().zip(&mut self.marks).enumerate() {
            if *byte == 1 {
                let (x, y) = (place as u32 % self.width, place as u32 / self.width);
                assert_eq!(*old, '.', "pixel ({x}, {y}) is drawn twice, by {old} and by {mark}");
                *old = mark;
                written += 1;
            }
        }
        assert_eq!(drawn.pixels, written, "the count of pixels written");
        self
    }

    #[track_caller]
    pub fn assert_pattern(&self, rows: &[&str]) {
        let shown: Vec<String> = self.marks.chunks(self.width as usize).map(|row| row.iter().collect()).collect();
        assert_eq!(shown, rows, "\nshown:\n{}\nexpected:\n{}\n", shown.join("\n"), rows.join("\n"));
    }
}
