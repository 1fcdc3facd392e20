//! Errors of invalid meshes.

use core::fmt;

/// The reason why a mesh is rejected. Vertices and triangles are counted from 0.
#[derive(Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// There is nothing to draw.
    NoTriangles,
    /// The mesh has more than [`Mesh::MAX_COUNT`](super::Mesh::MAX_COUNT) vertices or triangles.
    TooLarge,
    /// A position has a NaN or an infinity.
    PositionNotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A normal has a NaN or an infinity.
    NormalNotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A normal has length 0, and so no direction.
    NormalZero {
        /// The vertex.
        vertex: usize,
    },
    /// A texture coordinate is a NaN or an infinity.
    TexcoordNotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
    },
    /// A triangle refers to a surface that does not exist.
    SurfaceOutOfRange {
        /// The triangle.
        triangle: usize,
    },
    /// A scaling factor is not finite or not above 0.
    Factors,
    /// Two corresponding lists have different lengths.
    Count {
        /// The contents of the given list.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length it must have.
        needed: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoTriangles => write!(f, "no faces"),
            Self::TooLarge => write!(f, "more than 268,435,456 vertices or triangles"),
            Self::PositionNotFinite { vertex } => write!(f, "the position of vertex {vertex} is not finite"),
            Self::NormalNotFinite { vertex } => write!(f, "the normal of vertex {vertex} is not finite"),
            Self::NormalZero { vertex } => write!(f, "the normal of vertex {vertex} is zero"),
            Self::TexcoordNotFinite { vertex } => {
                write!(f, "the texture coordinates of vertex {vertex} are not finite")
            }
            Self::IndexOutOfRange { triangle } => {
                write!(f, "triangle {triangle} refers to a vertex that does not exist")
            }
            Self::SurfaceOutOfRange { triangle } => {
                write!(f, "triangle {triangle} refers to a surface that does not exist")
            }
            Self::Factors => write!(f, "factors must be finite and above 0"),
            Self::Count { what, given, needed } => write!(f, "{given} {what}, but {needed} are needed"),
        }
    }
}

crate::errors::error_type!(MeshError);
