//! Eight numbers at a time: what light, vertices and pixels are worked out in.

/// Pixels or vertices that are worked on at a time: two to eight vectors of a processor, and no more than short spans have.
pub const LANES: usize = 8;

/// One number for each of so many pixels or vertices that follow each other.
pub type Lanes<T> = [T; LANES];

/// Normal and position, x, y and z each, of as many pixels or vertices.
pub type Points = [Lanes<f32>; 6];
