//! Pixels enlarged 16 times, with their centres and the true edges between them.

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::{DrawTarget, DrawTargetExt};
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::prelude::Primitive;
use embedded_graphics::primitives::{Line, PrimitiveStyle, Rectangle};

use super::face::Segment;
use mode13h::raster::{Frame, Index};

/// Part of a frame, drawn enlarged on another frame. Nothing is drawn outside either.
#[derive(Clone, Copy)]
pub(super) struct Enlarged {
    /// Its upper left corner, in pixels of the frame drawn on.
    pub(super) at: (i32, i32),
    /// Number of columns enlarged.
    pub(super) columns: u16,
    /// Number of rows enlarged.
    pub(super) rows: u16,
}

impl Enlarged {
    /// Magnification: pixels per enlarged pixel.
    pub(super) const ZOOM: i32 = 16;

    /// The upper left corner of a pixel's cell.
    fn corner(&self, x: u16, y: u16) -> Point {
        Point::new(self.at.0, self.at.1) + Point::new(i32::from(x), i32::from(y)) * Self::ZOOM
    }

    fn area(&self) -> Rectangle {
        let side = |pixels: u16| u32::from(pixels) * Self::ZOOM.unsigned_abs();
        Rectangle::new(self.corner(0, 0), Size::new(side(self.columns), side(self.rows)))
    }

    /// Fills a pixel's cell.
    pub(super) fn cell(&self, frame: &mut Frame<'_>, x: u16, y: u16, index: Index) {
        fill(&mut frame.clipped(&self.area()), self.corner(x, y), Self::ZOOM, index);
    }

    /// Fills the cell of an empty pixel, with lines in another colour along its left and upper sides.
    pub(super) fn empty_cell(&self, frame: &mut Frame<'_>, x: u16, y: u16, index: Index, line: Index) {
        self.cell(frame, x, y, line);
        fill(&mut frame.clipped(&self.area()), self.corner(x, y) + Point::new(1, 1), Self::ZOOM - 1, index);
    }

    /// Marks a pixel's centre.
    pub(super) fn centre(&self, frame: &mut Frame<'_>, x: u16, y: u16, index: Index) {
        let middle = Point::new(Self::ZOOM / 2 - 1, Self::ZOOM / 2 - 1);
        fill(&mut frame.clipped(&self.area()), self.corner(x, y) + middle, 2, index);
    }

    /// Draws true edges one pixel thick, clipped to this part. Their ends are in pixels before enlargement, relative to
    /// the upper left corner of the part.
    pub(super) fn edges(&self, frame: &mut Frame<'_>, outline: &[Segment], index: Index) {
        let style = PrimitiveStyle::with_stroke(index, 1);
        let size = (f64::from(self.columns), f64::from(self.rows));
        for segment in outline {
            if let Some(ends) = cut(*segment, size) {
                let [a, b] = ends.map(|(x, y)| {
                    // Within the part, as the segment was clipped.
                    let zoomed = |c: f64| (c * f64::from(Self::ZOOM)) as i32;
                    self.corner(0, 0) + Point::new(zoomed(x), zoomed(y))
                });
                let Ok(()) = Line::new(a, b).into_styled(style).draw(&mut frame.clipped(&self.area()));
            }
        }
    }
}

fn fill<D: DrawTarget<Color = Index>>(target: &mut D, at: Point, side: i32, index: Index) {
    let area = Rectangle::new(at, Size::new(side.unsigned_abs(), side.unsigned_abs()));
    // Drawing on a frame cannot fail.
    let _ = target.fill_solid(&area, index);
}

/// The part of a segment inside the rectangle (Liang and Barsky 1984).
fn cut([(x0, y0), (x1, y1)]: Segment, (width, height): (f64, f64)) -> Option<Segment> {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (step, room) in [(-dx, x0), (dx, width - x0), (-dy, y0), (dy, height - y0)] {
        if step == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if step < 0.0 {
            from = from.max(room / step);
        } else {
            to = to.min(room / step);
        }
    }
    (from <= to).then(|| [from, to].map(|t| (x0 + dx * t, y0 + dy * t)))
}
