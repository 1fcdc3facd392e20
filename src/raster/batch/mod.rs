//! Batches: many triangles at once. Vectors cull those that cover no pixel, and find the rows of small ones.
//!
//! Half of the triangles of a fine model cover no pixel centre, and most of the others a few. So a triangle's own
//! work has to be small: no sorting by branches, no division for itself, no loop for a row of one pixel. A
//! [`Batch`] holds triangles as a structure of arrays, and they pass three stages:
//!
//! | stage | lanes | what |
//! |---|---|---|
//! | `sieve` | triangles | which have a pixel centre in their box, and if that is tiny in themselves; which of these are small |
//! | `rows` | triangles, or rows of one | of eight small ones at a time edges, shade plane and rows, as a list of spans; of a larger one eight rows at a time |
//! | [`Kernel::fill_list`](crate::span::Kernel::fill_list) | pixels | the bytes |
//!
//! With AVX-512 and without a depth buffer larger ones need no list: their rows go to the pixels eight at a time.
//!
//! A triangle larger than 2¹⁸ pixels, or one that reaches over the clip rectangle's edge, is drawn by
//! [`Raster::triangle`] when its turn comes. The bytes are those of a call of it for each triangle in turn.

use super::Interpolation;
use super::depth::{Cell, DepthPlane};
use super::draw_stats::DrawStats;
use super::frame::Rect;
use super::triangle::Raster;
use super::vertex::Vertex;
use crate::fixed::{HAS_F64, I24F8, U8F8};
use crate::span::Kernel;

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "assembly for processors found only when the program runs")]
mod avx512;
mod depths;
#[cfg(feature = "alloc")]
pub(crate) mod numbered;
mod rows;
mod sieve;
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
#[expect(unsafe_code, reason = "code for processors found only when the program runs")]
mod x86;

use crate::raster::shade::RESEED;
use rows::{DEPTHS, Draw, MAX_PIECES, Place, Spans};
use sieve::{Chosen, Kept, Kind};

/// Triangles to be drawn one after the other, in arrays.
#[derive(Clone, Debug)]
pub struct Batch {
    count: usize,
    /// True if triangles of no pixel have mostly been left out already: to look for more does not pay.
    is_sifted: bool,
    /// The corners of all triangles: x and y in 1/256 pixel, shade in 1/256.
    x: [[i32; Self::CAPACITY]; 3],
    y: [[i32; Self::CAPACITY]; 3],
    shade: [[u16; Self::CAPACITY]; 3],
    depth: [[u32; Self::CAPACITY]; 3],
    interpolation: [Interpolation; Self::CAPACITY],
}

impl Batch {
    /// The most triangles. With 64 the group of eight that ends a batch is oftener part empty.
    pub const CAPACITY: usize = 128;

    /// Without a triangle.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            count: 0,
            is_sifted: false,
            x: [[0; Self::CAPACITY]; 3],
            y: [[0; Self::CAPACITY]; 3],
            shade: [[0; Self::CAPACITY]; 3],
            depth: [[0; Self::CAPACITY]; 3],
            interpolation: [Interpolation::Flat(0); Self::CAPACITY],
        }
    }

    /// One for triangles of which those that cover no pixel have mostly been left out.
    #[cfg(feature = "alloc")]
    pub(crate) const fn of_sifted() -> Self {
        Self { is_sifted: true, ..Self::new() }
    }

    /// Returns whether triangles of this shading can be put into a batch: flat ones, and those linear in 8.8.
    #[must_use]
    #[inline]
    #[doc(hidden)]
    pub const fn takes(interpolation: Interpolation) -> bool {
        matches!(interpolation, Interpolation::Flat(_) | Interpolation::Gouraud | Interpolation::GouraudReseeded)
    }

    /// Puts a triangle behind the others. Returns `false`, and leaves it out, if the batch is full or does not
    /// [take](Self::takes) this shading.
    #[inline]
    pub fn push(&mut self, vertices: &[Vertex; 3], interpolation: Interpolation) -> bool {
        let at = self.count;
        if at >= Self::CAPACITY || !Self::takes(interpolation) {
            return false;
        }
        for (corner, v) in vertices.iter().enumerate() {
            self.x[corner][at] = v.x().to_bits();
            self.y[corner][at] = v.y().to_bits();
            // A flat triangle is one whose corners agree: the nearest of a whole shade is that shade.
            self.shade[corner][at] = match interpolation {
                Interpolation::Flat(index) => u16::from(index) << 8,
                _ => v.shade().to_bits(),
            };
            self.depth[corner][at] = v.depth();
        }
        self.interpolation[at] = interpolation;
        self.count = at + 1;
        true
    }

    /// Number of triangles in the batch.
    #[must_use]
    #[inline]
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the batch holds no triangle.
    #[must_use]
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns whether there is no room left.
    #[must_use]
    #[inline]
    #[doc(hidden)]
    pub const fn is_full(&self) -> bool {
        self.count == Self::CAPACITY
    }

    /// Takes all triangles out.
    #[inline]
    pub const fn clear(&mut self) {
        self.count = 0;
    }

    fn depth_plane(&self, at: usize) -> DepthPlane {
        let at = at % Self::CAPACITY;
        DepthPlane::of_corners([0, 1, 2].map(|corner| (self.x[corner][at], self.y[corner][at], self.depth[corner][at])))
    }

    /// The most pieces that start anew in a row of a large triangle.
    fn pieces(&self, at: usize) -> usize {
        if self.interpolation[at] != Interpolation::GouraudReseeded {
            return 1;
        }
        let [a, b, c] = self.x.each_ref().map(|x| x[at]);
        // As in `sieve`; at most 1,024 pixels.
        let columns = ((a.max(b).max(c) + 127) >> 8) - ((a.min(b).min(c) + 127) >> 8);
        ((columns - 1) as usize / RESEED as usize + 1).clamp(1, MAX_PIECES)
    }

    /// A triangle as it was put in, but that the vertices of a flat one have its shade.
    fn triangle(&self, at: usize) -> ([Vertex; 3], Interpolation) {
        let vertex = |corner: usize| {
            let (x, y) = (I24F8::from_bits(self.x[corner][at]), I24F8::from_bits(self.y[corner][at]));
            let shade = U8F8::from_bits(self.shade[corner][at]);
            // They came out of a vertex; with another shade none would be drawn.
            Vertex::new(x, y, shade, self.depth[corner][at]).unwrap_or_default()
        };
        ([vertex(0), vertex(1), vertex(2)], self.interpolation[at])
    }
}

impl Default for Batch {
    fn default() -> Self {
        Self::new()
    }
}

impl<D: Cell> Raster<'_, D> {
    /// Draws the triangles of a batch, one after the other: the bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each.
    #[doc(hidden)]
    pub fn batch(&mut self, batch: &Batch) -> DrawStats {
        self.draw_batch::<true>(batch)
    }

    /// Draws the triangles of a batch that all lie wholly inside the frame, one after the other.
    ///
    /// The bytes, depths and counts are those of [`triangle_inside`](Self::triangle_inside) called for each.
    #[doc(hidden)]
    pub fn batch_inside(&mut self, batch: &Batch) -> DrawStats {
        self.draw_batch::<false>(batch)
    }

    fn draw_batch<const CLIPS: bool>(&mut self, batch: &Batch) -> DrawStats {
        let mut drawn = DrawStats::default();
        let (_, pitch) = self.frame.pixels_mut();
        let (width, rows) = (self.frame.width(), self.frame.rows());
        // Offsets of pixels are kept in 32 bits, and a depth buffer has to hold the frame's rows and no others.
        let fits = pitch <= 1 << 16 && self.depth.as_ref().is_none_or(|depth| depth.holds(width, &rows));
        if !HAS_F64 || !fits {
            for at in 0..batch.count {
                drawn += self.one_of::<CLIPS>(batch, at);
            }
            return drawn;
        }
        let stages = Stages::of(self.kernel);
        let mut kept = Kept::new();
        (stages.sieve)(batch, self.clip, &mut kept);
        let depth_width = self.depth.is_some().then_some(width);
        let place = Place { first_row: rows.start, pitch: pitch as u32, depth_width };
        if let Some(at_once) = stages.at_once
            && self.depth.as_mut().is_none_or(|depth| D::as_u32(depth.values_mut()).is_some())
        {
            return self.draw_at_once::<CLIPS>(batch, at_once, &kept, place);
        }
        if depth_width.is_some() {
            self.draw_kept::<CLIPS>(batch, &stages, &kept, place, Spans::new(&mut { DEPTHS }))
        } else {
            self.draw_kept::<CLIPS>(batch, &stages, &kept, place, Spans::new(&mut []))
        }
    }

    /// Draws the triangles that culling has kept, all but others together.
    fn draw_at_once<const CLIPS: bool>(
        &mut self,
        batch: &Batch,
        at_once: AtOnce,
        kept: &Kept,
        place: Place,
    ) -> DrawStats {
        let mut drawn = DrawStats::default();
        let mut left = kept.triangles();
        while let Some(first) = left.first() {
            let together = Chosen::in_batch(left);
            if together == 0 {
                drawn += self.one_of::<CLIPS>(batch, first.number());
                left = &left[1..];
                continue;
            }
            let (pixels, _) = self.frame.pixels_mut();
            // As in `fill`.
            let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
            let cells = depth.and_then(|depth| D::as_u32(depth.values_mut()));
            drawn += at_once(batch, &left[..together], (place, self.clip), pixels, cells);
            left = &left[together..];
        }
        drawn
    }

    /// Draws the triangles that culling has kept.
    fn draw_kept<const CLIPS: bool>(
        &mut self,
        batch: &Batch,
        stages: &Stages,
        kept: &Kept,
        place: Place,
        mut spans: Spans<'_>,
    ) -> DrawStats {
        let mut drawn = DrawStats::default();
        let mut left = kept.triangles();
        while let Some(first) = left.first() {
            let kind = first.kind();
            if matches!(kind, Kind::Other | Kind::Clipped) {
                drawn += self.one_of::<CLIPS>(batch, first.number());
                left = &left[1..];
                continue;
            }
            let alike = Chosen::alike(left);
            if kind == Kind::Large {
                (stages.tall)(batch, &left[..alike], place, &mut spans, &mut |spans| self.fill(spans, &mut drawn));
                left = &left[alike..];
                continue;
            }
            if let Some(small) = stages.small
                && self.depth.as_mut().is_none_or(|depth| D::as_u32(depth.values_mut()).is_some())
            {
                let (pixels, _) = self.frame.pixels_mut();
                // As in `fill`.
                let depth = self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces"));
                let cells = depth.and_then(|depth| D::as_u32(depth.values_mut()));
                drawn += small(batch, &left[..alike], place, pixels, cells);
                left = &left[alike..];
                continue;
            }
            let listed = (stages.rows)(batch, &left[..alike], place, &mut spans);
            left = &left[listed..];
            self.fill(&spans, &mut drawn);
            spans.clear();
        }
        drawn
    }

    fn one_of<const CLIPS: bool>(&mut self, batch: &Batch, at: usize) -> DrawStats {
        let (vertices, interpolation) = batch.triangle(at);
        if CLIPS { self.triangle(&vertices, interpolation) } else { self.triangle_inside(&vertices, interpolation) }
    }

    /// Draws the spans of small triangles.
    #[inline]
    fn fill(&mut self, spans: &Spans<'_>, drawn: &mut DrawStats) {
        let covered = spans.covered();
        // At most 2¹¹ spans of 64 pixels.
        drawn.spans += spans.as_slice().len() as u32;
        drawn.covered += covered;
        let (pixels, _) = self.frame.pixels_mut();
        // In a build that leaves it out (`plan::Effect::is_left_out`) there is none.
        match self.depth.as_mut().filter(|_| !cfg!(mode13h_leave_out = "hidden-surfaces")) {
            None => {
                self.kernel.fill_list(pixels, spans.as_slice());
                drawn.pixels += covered;
            }
            Some(depth) => {
                drawn.tested += covered;
                let (cells, spans, depths) = (depth.values_mut(), spans.as_slice(), spans.depths());
                drawn.pixels += self.kernel.fill_list_nearer(pixels, cells, spans, depths);
            }
        }
    }
}

/// The stages as the kernel's processor runs them best.
struct Stages {
    sieve: fn(&Batch, Rect, &mut Kept),
    rows: fn(&Batch, &[Chosen], Place, &mut Spans<'_>) -> usize,
    tall: fn(&Batch, &[Chosen], Place, &mut Spans<'_>, Draw<'_>),
    /// In place of `rows`, and of the loop over its list, with cells of 32 bits if there is a depth buffer.
    small: Option<Small>,
    /// In place of all three, with cells of 32 bits if there is a depth buffer.
    at_once: Option<AtOnce>,
}

/// Draws small triangles into pixels, and where they are nearer than cells, if there are any.
type Small = fn(&Batch, &[Chosen], Place, &mut [u8], Option<&mut [u32]>) -> DrawStats;

/// Draws small, large and clipped triangles into pixels, and where they are nearer than cells, if there are any.
type AtOnce = fn(&Batch, &[Chosen], (Place, Rect), &mut [u8], Option<&mut [u32]>) -> DrawStats;

impl Stages {
    fn of(kernel: Kernel) -> Self {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if kernel.avx2().is_some() {
            let stages =
                Self { sieve: x86::sieve, rows: x86::rows, tall: x86::tall, small: Some(x86::small), at_once: None };
            if kernel.avx512().is_some() {
                return Self { sieve: x86::sieve_512, at_once: Some(x86::at_once), ..stages };
            }
            return stages;
        }
        let _ = kernel;
        Self { sieve: sieve::sieve, rows: rows::rows, tall: rows::tall, small: None, at_once: None }
    }
}
