//! A triangle at a pixel: its corners, its edges, who owns a tie, and what became of it.

use alloc::string::String;
use core::fmt;

use mode13h::raster::{Interpolation, Vertex};

use super::trace::Fate;

/// A triangle that covers the pixel, or whose edge runs through its centre.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct FaceHere {
    /// The object's place in the scene.
    pub object: usize,
    /// The triangle's place in the object's mesh; `None` where it could not be told.
    pub triangle: Option<usize>,
    /// The line of that triangle in the model's file, if it comes from one.
    pub line: Option<u32>,
    /// The name of that triangle's material, if it has one.
    pub material: Option<String>,
    /// True if it is only a part of that triangle, which was split.
    pub is_part: bool,
    /// Interpolation of its shades, where they come from its corners.
    pub interpolation: Interpolation,
    /// Its corners: the upper one first (of equal heights the left one), then clockwise as one sees them.
    pub corners: [Vertex; 3],
    /// Its depth at the pixel; greater is nearer.
    pub depth: u32,
    /// Its fate.
    pub fate: Fate,
}

/// Kind of an edge, the triangle seen clockwise.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum EdgeKind {
    /// Level, the triangle below it.
    Top,
    /// The triangle lies right of it.
    Left,
    /// The triangle lies left of it.
    Right,
    /// Level, the triangle above it.
    Bottom,
}

impl EdgeKind {
    /// Returns whether a pixel whose centre lies on it belongs to the triangle: a top or a left edge. The neighbour on
    /// its other side has it as a bottom or a right one.
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
    /// The edge function at the pixel's centre, exact, in (1/256 pixel)²: twice the area of the edge and the centre,
    /// above 0 inside.
    pub value: i64,
}

impl FaceHere {
    /// The edges from corner 0 to 1, from 1 to 2 and from 2 to 0, at the centre of the pixel (`x`, `y`).
    ///
    /// ```text
    /// e = (bx − ax)·(cy − ay) − (by − ay)·(cx − ax)       a, b: the edge's ends; c: the centre; y runs down
    /// ```
    #[must_use]
    pub fn edges(&self, x: u32, y: u32) -> [Edge; 3] {
        let centre = [x, y].map(|c| i64::from(c) * 256 + 128);
        [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
            let (a, b) = (at(&self.corners[from]), at(&self.corners[to]));
            let along = [b[0] - a[0], b[1] - a[1]];
            let kind = match along {
                [_, down] if down < 0 => EdgeKind::Left,
                [_, down] if down > 0 => EdgeKind::Right,
                [across, _] if across > 0 => EdgeKind::Top,
                _ => EdgeKind::Bottom,
            };
            // Within 2²¹ · 2²¹ twice.
            Edge { kind, value: along[0] * (centre[1] - a[1]) - along[1] * (centre[0] - a[0]) }
        })
    }
}

/// Clockwise as one sees them, the upper one first.
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
