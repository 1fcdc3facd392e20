//! Small triangles that are lit at every pixel, and nothing else: a face of four pixels in three rows takes light once, not
//! three times. The bytes are those of its rows, one by one: each pixel's point is made from its own row's first.

use super::pipeline::{Lighting, PixelPipeline, ShadeSource};
use super::planes::LitPlane;
use super::{Attributes, HALVES, write};
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::depth::{Cell, DepthPlane};
use crate::raster::paint::to_bytes;
use crate::raster::triangle::{DrawStats, Raster};
use crate::raster::vertex::Vertex;
use crate::span::Kernel;
use crate::span::lit::{LANES, Lanes};

/// Rows that are lit together, and their pixels: wider ones are not small.
const ROWS: usize = 8;
const PIXELS: usize = ROWS * LANES;

/// Whether no row of a triangle is longer than what is lit at a time.
pub(super) fn is_narrow(vertices: &[Vertex; 3]) -> bool {
    let [a, b, c] = vertices.each_ref().map(|vertex| i64::from(vertex.x().to_bits()));
    a.max(b).max(c) - a.min(b).min(c) <= LANES as i64 * 256
}

/// Pixels of rows, each by its number from its row's first and what its row has there.
struct Eight {
    places: Lanes<f64>,
    a: [Lanes<f64>; 6],
    d: Lanes<f64>,
}

/// Rows of a triangle that wait for their light.
struct Waiting {
    rows: [Row; ROWS],
    count: usize,
    eight: Eight,
    /// Pixels of these rows, and the shades of those that are lit already.
    pixels: usize,
    shades: [u16; PIXELS],
}

impl Waiting {
    fn new() -> Self {
        let eight = Eight { places: [0.0; LANES], a: [[0.0; LANES]; 6], d: [1.0; LANES] };
        Self {
            rows: [Row { y: 0, origin: 0, x0: 0, x1: 0, last: 0 }; ROWS],
            count: 0,
            eight,
            pixels: 0,
            shades: [0; PIXELS],
        }
    }

    /// Puts a row of up to eight pixels behind the others; there is room for it.
    #[inline]
    fn push(&mut self, row: &Row, plane: &LitPlane, lighting: &dyn Lighting, kernel: Kernel) {
        self.rows[self.count] = *row;
        self.count += 1;
        let (a, d) = plane.at(row.origin, row.y);
        for x in row.x0..row.x1 {
            let lane = self.pixels % LANES;
            self.eight.places[lane] = f64::from(x - row.origin);
            for (lanes, a) in self.eight.a.iter_mut().zip(a) {
                lanes[lane] = a;
            }
            self.eight.d[lane] = d;
            self.pixels += 1;
            if lane == LANES - 1 {
                self.light(plane, lighting, kernel);
            }
        }
    }

    /// Lights the last pixels, up to eight.
    fn light(&mut self, plane: &LitPlane, lighting: &dyn Lighting, kernel: Kernel) {
        let Some(first) = self.pixels.checked_sub(1).map(|last| last / LANES * LANES) else { return };
        let (da, dd) = plane.step();
        let Eight { places, a, d } = &self.eight;
        let points = kernel.interpolate_each(places, a, da, d, dd);
        if let Some(shades) = self.shades.get_mut(first..first + LANES) {
            shades.copy_from_slice(&lighting.shades(&points));
        }
    }
}

impl PixelPipeline<'_> {
    /// What lights its pixels, if nothing else is done to them but dithering.
    pub(super) fn lit_alone(&self) -> Option<&dyn Lighting> {
        match self.source {
            ShadeSource::Lit(lighting) if self.channels().is_none() && self.texture().is_none() => Some(lighting),
            _ => None,
        }
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws a narrow triangle whose pixels are lit by `lighting`, by a look without fog and blending.
    #[inline(never)]
    pub(super) fn draw_small_lit<const CLIPS: bool>(
        &mut self,
        triangle: &SortedTriangle,
        (vertices, attributes): (&[Vertex; 3], &[Attributes; 3]),
        (look, lighting): (&PixelPipeline<'_>, &dyn Lighting),
    ) -> DrawStats {
        let mut drawn = DrawStats::default();
        let (width, clip, kernel) = (self.frame.width(), self.clip, self.kernel);
        let mut prepared = None;
        let prepare = || {
            let corners = super::corners(triangle, vertices, attributes);
            (LitPlane::new(triangle, corners), DepthPlane::new(triangle), Waiting::new())
        };
        let mut draw = |row: Row| {
            drawn.covered += (row.x1 - row.x0) as u32;
            let (lit, depth, waiting) = prepared.get_or_insert_with(prepare);
            if waiting.count == ROWS {
                self.write_waiting((lit, depth), waiting, (look, lighting), &mut drawn);
            }
            waiting.push(&row, lit, lighting, kernel);
        };
        if CLIPS {
            triangle.rows(width, clip, &mut draw);
        } else {
            triangle.rows_inside(&mut draw);
        }
        if let Some((lit, depth, waiting)) = &mut prepared {
            self.write_waiting((lit, depth), waiting, (look, lighting), &mut drawn);
        }
        drawn.lit += drawn.covered;
        drawn.dithered += if look.dither().is_some() { drawn.covered } else { 0 };
        drawn
    }

    /// Lights what is left to be lit of the rows that wait, and writes them all.
    fn write_waiting(
        &mut self,
        (lit, plane): (&LitPlane, &DepthPlane),
        waiting: &mut Waiting,
        (look, lighting): (&PixelPipeline<'_>, &dyn Lighting),
        drawn: &mut DrawStats,
    ) {
        if !waiting.pixels.is_multiple_of(LANES) {
            waiting.light(lit, lighting, self.kernel);
        }
        let mut shades = &waiting.shades[..];
        for row in &waiting.rows[..waiting.count] {
            let y = row.y as u32;
            // Columns of a frame, of which a row has eight at most.
            let range = row.x0 as usize..row.x1 as usize;
            let of_row;
            (of_row, shades) = shades.split_at(range.len());
            let mut bytes = [0; LANES];
            let bytes = &mut bytes[..range.len()];
            let thresholds = &look.dither().unwrap_or(&HALVES)[(row.y & 7) as usize];
            to_bytes(of_row, thresholds, range.start, bytes);
            let Some(pixels) = self.frame.row_mut(y).and_then(|row| row.get_mut(range.clone())) else { continue };
            drawn.spans += 1;
            // As where a triangle is drawn row by row.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let mut depths = match depth {
                None => None,
                Some(depth) => match depth.row_mut(y) {
                    Some(depths) => Some((depths, plane)),
                    None => continue,
                },
            };
            write(range, pixels, bytes, row.y, &mut depths, look.keeps_depth, drawn);
        }
        (waiting.count, waiting.pixels) = (0, 0);
    }
}
