//! A face as both sides of a picture take it: three corners on the screen.

use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Interpolation, Vertex};

/// A corner on the screen.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Corner {
    /// Distance to the right, in pixels.
    pub(super) x: f64,
    /// Distance down, in pixels.
    pub(super) y: f64,
    /// Shade, from 0 to 255.
    pub(super) shade: f64,
    /// near / w: 1 at the near plane, falling to 0 far away.
    pub(super) depth: f64,
}

/// A corner on the near plane.
pub(super) const fn at(x: f64, y: f64, shade: f64) -> Corner {
    Corner { x, y, shade, depth: 1.0 }
}

impl Corner {
    pub(super) const fn deep(self, depth: f64) -> Self {
        Self { depth, ..self }
    }

    pub(super) const fn moved(self, x: f64, y: f64) -> Self {
        Self { x: self.x + x, y: self.y + y, ..self }
    }

    /// Rounds the corner as the engine does, as input for faults that have nothing to do with rounding.
    pub(super) fn rounded(self) -> Self {
        let round = |pixels: f64| (pixels * 256.0 + 0.5).floor() / 256.0;
        Self { x: round(self.x), y: round(self.y), ..self }
    }

    /// The raster's vertex. A corner that the raster would refuse becomes the origin; no case has one.
    pub(super) fn vertex(self) -> Vertex {
        let place = I24F8::round_from_f64(self.x).zip(I24F8::round_from_f64(self.y));
        let shade = U8F8::from_bits((self.shade * 256.0 + 0.5) as u16);
        let depth = (self.depth * 1_073_741_824.0 + 0.5) as u32;
        place.and_then(|(x, y)| Vertex::new(x, y, shade, depth).ok()).unwrap_or_default()
    }
}

/// A triangle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Face {
    pub(super) corners: [Corner; 3],
    pub(super) interpolation: Interpolation,
}

/// A face shaded linearly between its corners.
pub(super) const fn gouraud(corners: [Corner; 3]) -> Face {
    Face { corners, interpolation: Interpolation::Gouraud88Reseeded }
}

/// A face with one byte.
pub(super) const fn flat(corners: [Corner; 3], byte: u8) -> Face {
    Face { corners, interpolation: Interpolation::Flat(byte) }
}

impl Face {
    /// Its three edges.
    pub(super) fn edges(&self) -> [Segment; 3] {
        let [a, b, c] = self.corners.map(|corner| (corner.x, corner.y));
        [[a, b], [b, c], [c, a]]
    }
}

/// The edges of quads without the diagonals. Each quad consists of two faces, (a, b, c) and (a, c, d).
pub(super) fn without_diagonals(edges: &[Segment]) -> Vec<Segment> {
    edges.iter().enumerate().filter(|(i, _)| ![2, 3].contains(&(i % 6))).map(|(_, edge)| *edge).collect()
}

/// A true edge: two points in pixels.
pub type Segment = [(f64, f64); 2];
