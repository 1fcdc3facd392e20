//! The edges of a triangle at a pixel's centre.

use core::fmt;

use mode13h::raster::Vertex;

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

/// The edges of clockwise corners, evaluated at the centre of a pixel.
pub(super) fn edges(corners: &[Vertex; 3], x: u32, y: u32) -> [Edge; 3] {
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
