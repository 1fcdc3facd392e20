//! Eight numbers at a time: the form in which light, vertices and pixels are computed.

/// The number of pixels or vertices in one batch: two to eight vectors of a processor, and no more than short spans
/// have.
pub const LANES: usize = 8;

/// One number for each of so many pixels or vertices that follow each other.
pub type Lanes<T> = [T; LANES];

/// Normal and position, x, y and z each, of as many pixels or vertices.
pub type Points = [Lanes<f32>; 6];
