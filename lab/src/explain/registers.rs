//! The registers of the 1994 loop at a pixel.

use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::internals::raster::reference::shade::RESEED;
use mode13h::internals::{Progression, ShadeTrace, row_of};
use mode13h::raster::{Interpolation, Vertex};

/// Registers when the loop reaches `mov [edi], ah`.
///
/// In 16.16 the shade and its step are 32 bits wide, and the byte is the third of EAX.
///
/// ```
/// use mode13h::fixed::{I24F8, U8F8};
/// use mode13h::raster::{Interpolation, Vertex};
/// use mode13h_lab::explain::Registers;
///
/// let corner = |x, y, shade| {
///     Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(shade), 1)
/// };
/// let triangle = [corner(0, 0, 40)?, corner(8, 0, 200)?, corner(0, 4, 40)?];
/// let registers = Registers::at(2, 0, &triangle, (Interpolation::Gouraud88, true), 320).expect("the loop's");
/// // From 50 in the first pixel, and a half, by 20 a pixel.
/// assert_eq!((registers.edi, registers.eax, registers.ebx, registers.cx), (2, 0x5A80, 0x1400, 5));
/// # Ok::<(), mode13h::raster::RasterError>(())
/// ```
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

impl Registers {
    /// The registers at pixel (`x`, `y`) of a triangle that is shaded from its corners, in a frame of `width` pixels a
    /// row. The triangle covers the pixels whose centres are inside or, without `exact_cover`, those that
    /// `interpolation` covers.
    ///
    /// `None` for any other pixel, and for shadings without a running sum: one shade per face, or a quotient per pixel.
    #[must_use]
    pub fn at(
        x: u32,
        y: u32,
        triangle: &[Vertex; 3],
        (interpolation, exact_cover): (Interpolation, bool),
        width: u32,
    ) -> Option<Self> {
        let triangle = SortedTriangle::new(triangle);
        let row = row_of(&triangle, (!exact_cover).then_some(interpolation), width, x, y)?;
        // A column of a frame.
        let column = x as i32;
        let trace = ShadeTrace::new(&triangle, triangle.shades(), interpolation, &row, column);
        let Progression::Accumulator(sums) = trace.way else { return None };
        let end = match interpolation {
            Interpolation::Gouraud88Reseeded => (row.last + 1).min(sums.start_at + RESEED),
            _ => row.last + 1,
        };
        Some(Self {
            edi: y * width + x,
            eax: sums.sum(),
            // The step is added modulo the register's size.
            ebx: if sums.fraction_bits == 8 { (sums.step as u16).into() } else { sums.step as u32 },
            cx: (end - column) as u32,
        })
    }
}
