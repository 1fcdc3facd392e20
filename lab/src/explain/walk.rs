//! A triangle pixel by pixel, with the registers of the 1994 loop at each.

use alloc::vec::Vec;

use mode13h::internals::raster::reference::cover::{Row, SortedTriangle};
use mode13h::internals::raster::reference::shade::RESEED;
use mode13h::internals::{Progression, ShadeTrace, rows_of};
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::Screen;

/// Registers when the loop reaches `mov [edi], ah`.
///
/// In 16.16 the shade and its step are 32 bits wide, and the byte is the third of EAX.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub struct Registers {
    /// Offset of the byte from the frame's first: in mode 13h, from the start of video memory.
    pub edi: u32,
    /// The running shade, including what is added for rounding: AX, or in 16.16 EAX.
    pub eax: u32,
    /// The step added to it every pixel: BX, or in 16.16 EBX.
    pub ebx: u32,
    /// Pixels left, including this one. It is 1 at the last pixel before the loop ends or is restarted.
    pub cx: u32,
}

/// A pixel of a triangle.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Step {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// Index of the row in the triangle, from 0.
    pub row: usize,
    /// Index of the pixel in the row, from 0.
    pub column: usize,
    /// Number of pixels in the row.
    pub columns: usize,
    /// Column where the loop last started in this row: the first pixel, or a multiple of 64 pixels after it.
    pub start: u32,
    /// Its value, including the byte.
    pub shade_trace: ShadeTrace,
    /// The registers; `None` for shadings without a running sum: one shade per face, or a quotient per pixel.
    pub registers: Option<Registers>,
}

/// The pixels of a triangle in a frame, in the order in which the loop writes them: row by row, from left to right.
///
/// Pixels hidden by another triangle are included.
///
/// ```
/// use mode13h_lab::explain::Walk;
/// use mode13h::fixed::{I24F8, U8F8};
/// use mode13h::raster::{Interpolation, Vertex};
/// use mode13h::render::Screen;
///
/// let corner = |x, y, shade| {
///     Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(shade), 1)
/// };
/// let triangle = [corner(0, 0, 40)?, corner(8, 0, 200)?, corner(0, 4, 40)?];
/// let walk = Walk::new(&triangle, Interpolation::Gouraud, true, Screen::MODE_13H);
/// let registers = walk.step(2).and_then(|step| step.registers).expect("the loop's");
/// // From 50 in the first pixel, and a half, by 20 a pixel.
/// assert_eq!((registers.edi, registers.eax, registers.ebx, registers.cx), (2, 0x5A80, 0x1400, 5));
/// # Ok::<(), mode13h::raster::RasterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Walk {
    triangle: SortedTriangle,
    interpolation: Interpolation,
    width: u32,
    rows: Vec<Row>,
    /// Number of pixels before each row.
    before: Vec<usize>,
    pixels: usize,
}

impl Walk {
    /// The pixels of a triangle that is shaded from its corners: those whose centres it covers or, without
    /// `exact_cover`, those that `interpolation` covers.
    #[must_use]
    pub fn new(triangle: &[Vertex; 3], interpolation: Interpolation, exact_cover: bool, screen: Screen) -> Self {
        let triangle = SortedTriangle::new(triangle);
        let rows = rows_of(&triangle, (!exact_cover).then_some(interpolation), screen.width, screen.height);
        let mut pixels = 0;
        let mut before = Vec::with_capacity(rows.len());
        for row in &rows {
            before.push(pixels);
            pixels += row.range().len();
        }
        Self { triangle, interpolation, width: screen.width, rows, before, pixels }
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.pixels
    }

    /// Number of rows that have pixels.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Index of the pixel in column `x` of row `y`.
    #[must_use]
    pub fn number(&self, x: u32, y: u32) -> Option<usize> {
        let row = self.rows.iter().position(|row| u32::try_from(row.y) == Ok(y))?;
        let range = self.rows[row].range();
        range.contains(&(x as usize)).then(|| self.before[row] + x as usize - range.start)
    }

    /// Index of the first pixel in the triangle's row `row`, from 0.
    #[must_use]
    pub fn first_in(&self, row: usize) -> Option<usize> {
        self.before.get(row).copied()
    }

    /// The pixel at an index, from 0.
    #[must_use]
    pub fn step(&self, number: usize) -> Option<Step> {
        if number >= self.pixels {
            return None;
        }
        let place = self.before.partition_point(|&before| before <= number).checked_sub(1)?;
        let (row, column) = (self.rows[place], number - self.before[place]);
        // A column of a frame.
        let x = row.x0 + column as i32;
        let shade_trace = ShadeTrace::new(&self.triangle, self.triangle.shades(), self.interpolation, &row, x);
        let (mut start, mut registers) = (row.x0, None);
        if let Progression::Accumulator(sums) = shade_trace.way {
            let reseeds = self.interpolation == Interpolation::GouraudReseeded;
            start = if reseeds { sums.start_at } else { row.x0 };
            let end = if reseeds { row.x1.min(start + RESEED) } else { row.x1 };
            // The step is added modulo the register's size.
            let ebx = if sums.fraction_bits == 8 { (sums.step as u16).into() } else { sums.step as u32 };
            registers = Some(Registers {
                // Not negative, as it is within the frame.
                edi: row.y as u32 * self.width + x as u32,
                eax: sums.sum(),
                ebx,
                cx: (end - x) as u32,
            });
        }
        Some(Step {
            x: x as u32,
            y: row.y as u32,
            row: place,
            column,
            columns: row.range().len(),
            start: start as u32,
            shade_trace,
            registers,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_nothing_to_walk_over_without_a_pixel() {
        let walk = Walk::new(&[Vertex::default(); 3], Interpolation::Gouraud, true, Screen::MODE_13H);
        assert_eq!((walk.pixels(), walk.rows(), walk.first_in(0), walk.number(0, 0)), (0, 0, None, None));
        assert_eq!(walk.step(0), None);
    }
}
