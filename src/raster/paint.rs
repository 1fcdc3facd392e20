//! From a row of a triangle to bytes: which pixel loop, from which start.
//!
//! Every way to draw a triangle paints its rows here, whole or in parts, so all give the same bytes.

use core::ops::Range;

use super::cover::{Ordered, Row};
use super::depth::{Cell, DepthPlane};
use super::hyperbolic::HyperbolicPlane;
use super::shade::{RESEED, ShadePlane};
use super::triangle::{Drawn, Shading};
use crate::span::{Kernel, depth, hyperbolic};

/// The shades of one triangle, ready to be painted row by row.
#[derive(Clone, Copy, Debug)]
pub(super) enum Paint {
    Flat(u8),
    Linear { plane: ShadePlane, reseeded: bool },
    Hyperbolic(HyperbolicPlane),
}

impl Paint {
    /// Of a triangle that is not degenerate.
    #[inline]
    pub(super) fn new(triangle: &Ordered, shading: Shading) -> Self {
        match shading {
            Shading::Flat(index) => Self::Flat(index),
            Shading::Gouraud => Self::Linear { plane: ShadePlane::new(triangle), reseeded: false },
            Shading::GouraudReseeded => Self::Linear { plane: ShadePlane::new(triangle), reseeded: true },
            Shading::GouraudHyperbolic => Self::Hyperbolic(HyperbolicPlane::new(triangle)),
        }
    }

    /// Paints `row` into `pixels`, which is the frame's whole row.
    #[inline]
    pub(super) fn row(&self, row: &Row, pixels: &mut [u8], kernel: Kernel, drawn: &mut Drawn) {
        match self {
            Self::Flat(index) => span(pixels, row.range(), drawn, |pixels| pixels.fill(*index)),
            Self::Linear { plane, reseeded } => starts(row, plane, *reseeded, |range, start| {
                span(pixels, range, drawn, |pixels| kernel.fill(pixels, start, plane.step()));
            }),
            Self::Hyperbolic(plane) => span(pixels, row.range(), drawn, |pixels| {
                let ((n, d), (dn, dd)) = (plane.quotient(row.x0, row.y), plane.step());
                hyperbolic::fill_quotients(pixels, n, dn, d, dd);
            }),
        }
    }

    /// Paints `row` where it is nearer than `depths`, which is the depth buffer's whole row.
    #[inline]
    pub(super) fn row_where_nearer<D: Cell>(
        &self,
        row: &Row,
        pixels: &mut [u8],
        depths: &mut [D],
        plane: &DepthPlane,
        drawn: &mut Drawn,
    ) {
        let mut tested = Tested { row: row.y, pixels, depths, plane, drawn };
        match self {
            Self::Flat(index) => tested.span(row.range(), |pixels, depths, z, dz| {
                depth::fill_nearer(pixels, depths, u16::from(*index) << 8, 0, z, dz)
            }),
            Self::Linear { plane: shade, reseeded } => starts(row, shade, *reseeded, |range, start| {
                tested.span(range, |pixels, depths, z, dz| {
                    depth::fill_nearer(pixels, depths, start, shade.step(), z, dz)
                });
            }),
            Self::Hyperbolic(shade) => {
                let (dn, dd) = shade.step();
                let mut bytes = [0; 64];
                for x in row.range().step_by(bytes.len()) {
                    let end = row.range().end.min(x + bytes.len());
                    let bytes = &mut bytes[..end - x];
                    // A column is below 4,096.
                    let (n, d) = shade.quotient(x as i32, row.y);
                    hyperbolic::fill_quotients(bytes, n, dn, d, dd);
                    tested.span(x..end, |pixels, depths, z, dz| depth::copy_nearer(pixels, depths, bytes, z, dz));
                }
            }
        }
    }
}

/// Hands the pixels of a span to its loop, and counts them.
#[inline]
fn span(pixels: &mut [u8], range: Range<usize>, drawn: &mut Drawn, fill: impl FnOnce(&mut [u8])) {
    if let Some(pixels) = pixels.get_mut(range) {
        drawn.spans += 1;
        // At most 4,096.
        drawn.pixels += pixels.len() as u32;
        fill(pixels);
    }
}

/// A row with a depth test.
struct Tested<'a, D> {
    row: i32,
    pixels: &'a mut [u8],
    depths: &'a mut [D],
    plane: &'a DepthPlane,
    drawn: &'a mut Drawn,
}

impl<D: Cell> Tested<'_, D> {
    /// Hands the pixels and depths of a span to its loop, which gives the number of pixels written.
    #[inline]
    fn span(&mut self, range: Range<usize>, fill: impl FnOnce(&mut [u8], &mut [D], i64, i64) -> u32) {
        // A column is below 4,096.
        let z = self.plane.fixed_at(range.start as i32, self.row);
        let depths = self.depths.get_mut(range.clone());
        if let (Some(pixels), Some(depths)) = (self.pixels.get_mut(range), depths) {
            self.drawn.spans += 1;
            // At most 4,096.
            self.drawn.tested += pixels.len() as u32;
            self.drawn.pixels += fill(pixels, depths, z, self.plane.step());
        }
    }
}

/// Cuts a row into spans, each with its start. Exact starts lie at the row's origin and, if
/// `reseeded`, every 64 pixels from there; a row whose drawn part begins later continues from the
/// last start at or left of it, so that the clip rectangle changes no byte.
#[inline]
fn starts(row: &Row, shade: &ShadePlane, reseeded: bool, mut span: impl FnMut(Range<usize>, u16)) {
    let advance = |start: u16, pixels: i32| start.wrapping_add(shade.step().wrapping_mul(pixels as u16));
    if !reseeded {
        let start = shade.start(row.origin, row.y);
        return span(row.range(), advance(start, row.x0 - row.origin));
    }
    let mut seed = row.origin + (row.x0 - row.origin) / RESEED * RESEED;
    let mut x = row.x0;
    while x < row.x1 {
        let end = row.x1.min(seed + RESEED);
        span(x as usize..end as usize, advance(shade.start(seed, row.y), x - seed));
        seed += RESEED;
        x = end;
    }
}
