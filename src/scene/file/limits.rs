//! How much a scene may ask for.

/// The most bytes of a scene file: 1 MiB.
#[doc(hidden)]
pub const LONGEST: usize = 1 << 20;

/// The most triangles that the shapes of a scene have together: one for every pixel of mode 13h, and some. Models may have
/// more.
#[doc(hidden)]
pub const MAX_TRIANGLES: u64 = 1 << 16;
