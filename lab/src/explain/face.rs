//! A triangle at a pixel: its corners, its edges, who owns a tie, and its fate.

use core::fmt;

use mode13h::raster::{Interpolation, Vertex};

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

/// Kind of an edge, for a triangle seen clockwise.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum EdgeKind {
    /// Horizontal, with the triangle below it.
    Top,
    /// The triangle lies right of it.
    Left,
    /// The triangle lies left of it.
    Right,
    /// Horizontal, with the triangle above it.
    Bottom,
}

impl EdgeKind {
    /// Returns whether a pixel whose centre lies on it belongs to the triangle: true for top and left edges. To the
    /// neighbour the edge is a bottom or a right one.
    #[must_use]
    pub const fn owns_ties(self) -> bool {
        matches!(self, Self::Top | Self::Left)
    }
}

impl fmt::Display for EdgeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Top => "top",
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
        })
    }
}

/// An edge of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Edge {
    /// The kind of edge.
    pub kind: EdgeKind,
    /// Edge function at the pixel's centre, exact, in (1/256 pixel)²: twice the area of the triangle that the edge and
    /// the centre form, positive inside.
    pub value: i64,
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

/// The edges of clockwise corners, evaluated at the centre of a pixel.
fn edges(corners: &[Vertex; 3], x: u32, y: u32) -> [Edge; 3] {
    let centre = [x, y].map(|c| i64::from(c) * 256 + 128);
    [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
        let (a, b) = (at(&corners[from]), at(&corners[to]));
        let along = [b[0] - a[0], b[1] - a[1]];
        let kind = match along {
            [_, down] if down < 0 => EdgeKind::Left,
            [_, down] if down > 0 => EdgeKind::Right,
            [across, _] if across > 0 => EdgeKind::Top,
            _ => EdgeKind::Bottom,
        };
        // Two products, each within 2²¹ · 2²¹.
        Edge { kind, value: along[0] * (centre[1] - a[1]) - along[1] * (centre[0] - a[0]) }
    })
}

/// Returns whether an edge of a triangle passes through a pixel's centre.
pub(super) fn has_edge_at(vertices: &[Vertex; 3], x: u32, y: u32) -> bool {
    let values = edges(&clockwise(*vertices), x, y).map(|edge| edge.value);
    // At each point their sum is twice the triangle's area.
    values.iter().sum::<i64>() > 0 && values.contains(&0) && values.iter().all(|value| *value >= 0)
}

/// Clockwise on the screen, the upper one first.
pub(super) fn clockwise(mut vertices: [Vertex; 3]) -> [Vertex; 3] {
    let [a, b, c] = vertices.each_ref().map(at);
    if (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0 {
        vertices.swap(1, 2);
    }
    let first = (0..3).min_by_key(|&i| (vertices[i].y(), vertices[i].x())).unwrap_or(0);
    vertices.rotate_left(first);
    vertices
}

fn at(v: &Vertex) -> [i64; 2] {
    [v.x().to_bits().into(), v.y().to_bits().into()]
}
