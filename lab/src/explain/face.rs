//! A triangle at a pixel: its corners, its edges, and its fate.

use mode13h::raster::{Interpolation, Vertex};

use super::edge::{Edge, edges};
use super::trace::Fate;

/// A triangle that covers the pixel, or has an edge through its centre.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct FaceHere {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the triangle in the object's mesh; `None` if it cannot be determined.
    pub triangle: Option<usize>,
    /// Line of that triangle in the model's file, if it comes from one.
    pub line: Option<u32>,
    /// Name of that triangle's material, if it has one.
    pub material: Option<String>,
    /// True if it is only part of that triangle, which was split.
    pub is_part: bool,
    /// Interpolation of its shades, if they come from its corners.
    pub interpolation: Interpolation,
    /// Its corners: the upper one first (of two at the same height, the left one), then clockwise on the screen.
    pub corners: [Vertex; 3],
    /// Its depth at the pixel; greater is nearer.
    pub depth: u32,
    /// Its fate.
    pub fate: Fate,
}

impl FaceHere {
    /// The edges from corner 0 to 1, 1 to 2 and 2 to 0, evaluated at the centre of the pixel (`x`, `y`).
    ///
    /// ```text
    /// e = (bx − ax)·(cy − ay) − (by − ay)·(cx − ax)       a, b: the edge's ends; c: the centre; y runs down
    /// ```
    #[must_use]
    pub fn edges(&self, x: u32, y: u32) -> [Edge; 3] {
        edges(&self.corners, x, y)
    }
}
