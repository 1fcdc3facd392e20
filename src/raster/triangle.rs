//! One triangle, from three vertices to bytes.

#[cfg(feature = "alloc")]
use super::depth::DepthMemory;
use super::depth::{Cell, DepthBuffer};
use super::draw_stats::DrawStats;
use super::frame::{Frame, Rect};
use super::interpolation::Interpolation;
use super::reference::cover::{Row, SortedTriangle};
use super::reference::depth::DepthPlane;
use super::reference::shade::{RESEED, ShadePlane};
use super::row_shader::{InRow, RowShader, WhereNearer, start_at};
use super::vertex::Vertex;
use super::vintage::VintageTriangle;
use crate::fixed::{HAS_F64, IS_COMPACT};
use crate::span::Kernel;

/// Draws triangles into a frame: inside a clip rectangle, with an optional depth buffer, and with a choice of span
/// kernel.
#[derive(Debug)]
pub struct Raster<'a, D: Cell = u32> {
    pub(super) frame: Frame<'a>,
    pub(super) clip: Rect,
    pub(super) depth: Option<DepthBuffer<'a, D>>,
    pub(super) kernel: Kernel,
}

impl<'a> Raster<'a> {
    /// A raster over all that `frame` holds, without a depth buffer, with the fastest kernel.
    #[must_use]
    pub fn new(frame: Frame<'a>) -> Self {
        Self { clip: frame.bounds(), frame, depth: None, kernel: Kernel::default() }
    }

    /// Draws with its own depth buffer, cleared, in `values`, which grows as needed.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn with_cleared_depth<D: Cell>(self, values: &'a mut alloc::vec::Vec<D>) -> Raster<'a, D> {
        let rows = self.frame.rows();
        values.clear();
        values.resize(self.frame.width() as usize * (rows.end - rows.start) as usize, D::default());
        let Self { frame, clip, depth: _, kernel } = self;
        // Long enough, by the line above.
        let depth = DepthBuffer::new(values, &frame).ok();
        Raster { frame, clip, depth, kernel }
    }

    /// Draws with the next depth buffer of `memory`, as if cleared. Depths must be from 1 to 2³⁰, as those of a
    /// camera's vertices are: a depth of 0 or above 2³⁰ can be hidden by what earlier frames drew, or show through it.
    /// The same can happen with [`Interpolation::GouraudVintage`], which draws beyond the edges of a triangle.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn with_depth_memory(self, memory: &'a mut DepthMemory) -> Raster<'a> {
        let bounds = self.frame.bounds();
        self.with_depth_memory_within(memory, bounds)
    }

    /// Draws with the next depth buffer of `memory`, and nothing outside `within`. With [`Rect::EVERYWHERE`] depths may
    /// be anything.
    #[cfg(feature = "alloc")]
    pub(crate) fn with_depth_memory_within(self, memory: &'a mut DepthMemory, within: Rect) -> Raster<'a> {
        let Self { frame, clip, depth: _, kernel } = self;
        let depth = memory.next(&frame, within);
        Raster { frame, clip, depth, kernel }
    }

    /// Draws only what is nearer than `depth`, which must have been created for this frame's rows
    /// ([`DepthBuffer::new`]); rows that it lacks are not drawn.
    #[must_use]
    pub fn with_depth<D: Cell>(self, depth: DepthBuffer<'a, D>) -> Raster<'a, D> {
        let Self { frame, clip, depth: _, kernel } = self;
        Raster { frame, clip, depth: Some(depth), kernel }
    }
}

/// The height of a triangle, in 256ths of a pixel, from which eight-lane set-up of its rows pays off: 32 pixels. (With
/// AVX2, 19 rows take 200 ns row by row and 228 ns together, 100 rows 1,320 and 690 ns.)
const TALL: i64 = 32 << 8;

/// The simplest shading that gives the same bytes: rows of up to 64 pixels are not reseeded.
#[inline]
fn simplest(vertices: &[Vertex; 3], interpolation: Interpolation) -> Interpolation {
    let [a, b, c] = vertices.each_ref().map(|vertex| vertex.x().to_bits());
    match interpolation {
        Interpolation::Gouraud88Reseeded if a.max(b).max(c) - a.min(b).min(c) <= RESEED << 8 => {
            Interpolation::Gouraud88
        }
        interpolation => interpolation,
    }
}

impl<'a, D: Cell> Raster<'a, D> {
    /// Draws only inside `clip`, as far as the frame holds it. The bytes inside are the same as without clipping.
    #[must_use]
    pub fn with_clip(mut self, clip: Rect) -> Self {
        // The start of an empty rectangle may be any number.
        let clip = clip.intersection(self.frame.bounds());
        self.clip = if clip.x0 < clip.x1 && clip.y0 < clip.y1 { clip } else { Rect::default() };
        self
    }

    /// Draws with `kernel`. All kernels give the same bytes.
    #[must_use]
    pub fn with_kernel(mut self, kernel: Kernel) -> Self {
        self.kernel = kernel;
        self
    }

    /// The clip rectangle.
    #[cfg(feature = "alloc")]
    pub(crate) fn clip(&self) -> Rect {
        self.clip
    }

    /// The frame that is drawn into.
    pub fn frame(&mut self) -> Frame<'_> {
        self.frame.reborrow()
    }

    /// Draws a triangle. The order and winding of the vertices do not matter; a triangle without area draws nothing.
    #[inline]
    pub fn triangle(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> DrawStats {
        let [a, b, c] = vertices.map(|vertex| i64::from(vertex.y().to_bits()));
        if HAS_F64 && a.max(b).max(c) - a.min(b).min(c) >= TALL && interpolation.has_exact_cover() {
            return self.tall_triangle(vertices, interpolation);
        }
        self.triangle_by_rows(vertices, interpolation)
    }

    /// Draws a triangle row by row, following the definition.
    #[inline]
    pub(super) fn triangle_by_rows(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> DrawStats {
        let (triangle, interpolation) = (SortedTriangle::new(vertices), simplest(vertices, interpolation));
        if !IS_COMPACT && self.depth.is_none() {
            let mut plane = None;
            match interpolation {
                Interpolation::Gouraud88 => {
                    return self.fill_rows(&triangle, |row| {
                        let plane = plane.get_or_insert_with(|| ShadePlane::new(&triangle));
                        (start_at(plane, row, row.x0, false), plane.step())
                    });
                }
                Interpolation::Flat(index) => return self.fill_rows(&triangle, |_| (u16::from(index) << 8, 0)),
                _ => {}
            }
        }
        let mut drawn = DrawStats::default();
        // Created for the first row: half of the triangles of a detailed model cover no pixel.
        let (mut paint, mut plane) = (None, None);
        let (width, clip) = (self.frame.width(), self.clip);
        let mut draw = |row: Row| {
            drawn.covered += (row.x1 - row.x0) as u32;
            let (y, kernel, drawn) = (row.y as u32, self.kernel, &mut drawn);
            let Some(pixels) = self.frame.row_mut(y) else { return };
            let paint = paint.get_or_insert_with(|| RowShader::new(&triangle, interpolation));
            // A build that leaves out hidden surfaces (`plan::Effect::is_left_out`) has no depth.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let Some(depth) = depth else { return paint.row(&row, &mut InRow { pixels, kernel, drawn }) };
            let base = depth.base;
            let Some(depths) = depth.row_mut(y) else { return };
            let plane = plane.get_or_insert_with(|| DepthPlane::new(&triangle).raised_by(base));
            paint.row(&row, &mut WhereNearer { row: row.y, pixels, depths, plane, drawn });
        };
        if interpolation.has_exact_cover() {
            triangle.rows(width, clip, draw);
        } else if triangle.doubled_area != 0 {
            // As the sources print them. Depths are those of the triangle's plane, also beyond its edges, where they
            // may wrap.
            VintageTriangle::new(&triangle, triangle.shades()).rows(width, clip, &mut draw);
        }
        drawn
    }

    /// Fills the rows of a triangle without a depth test, each from the shade and the step that `shades` returns for
    /// it. All values fit into registers, and no branch depends on lengths: this takes a quarter less time than
    /// [`RowShader`].
    #[inline(always)]
    fn fill_rows(&mut self, triangle: &SortedTriangle, mut shades: impl FnMut(&Row) -> (u16, u16)) -> DrawStats {
        let (mut drawn, kernel) = (DrawStats::default(), self.kernel);
        let (width, clip) = (self.frame.width(), self.clip);
        triangle.rows(width, clip, |row| {
            let length = row.range().len();
            let Some(pixels) = self.frame.starting_at(row.range().start, row.y as u32) else { return };
            drawn.spans += 1;
            // At most 4,096.
            drawn.pixels += length as u32;
            let (shade, step) = shades(&row);
            kernel.fill_first(length, pixels, shade, step);
        });
        drawn.covered = drawn.pixels;
        drawn
    }
}
