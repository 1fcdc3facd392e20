//! Limits of a scene file.

/// The most bytes of a scene file: 1 MiB.
pub const LONGEST: usize = 1 << 20;

/// The most triangles of all shapes in a scene together: slightly more than one for every pixel of mode 13h. Models may
/// have more.
pub const MAX_TRIANGLES: u64 = 1 << 16;
