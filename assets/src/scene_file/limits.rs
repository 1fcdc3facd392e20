//! Limits of a scene file.

/// The max number of bytes of a scene file: 1 MiB.
pub const LONGEST: usize = 1 << 20;

/// The max number of triangles of all shapes in a scene: slightly more than one for every pixel of mode 13h. Models may
/// have more.
pub const MAX_TRIANGLES: u64 = 1 << 16;
