//! A pixel of the picture.

use mode13h::vga::Vga;

/// A pixel of the frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Pixel {
    /// 0 to 319.
    pub(super) x: u16,
    /// 0 to 199.
    pub(super) y: u16,
}

impl Pixel {
    /// The one that a point of the picture lies in, if it is on the picture; x and y in pixels of the frame.
    pub(super) fn at((x, y): (f32, f32)) -> Option<Pixel> {
        let on_picture = (0.0..Vga::WIDTH as f32).contains(&x) && (0.0..Vga::HEIGHT as f32).contains(&y);
        // Whole numbers within the ranges above.
        on_picture.then_some(Pixel { x: x as u16, y: y as u16 })
    }
}
