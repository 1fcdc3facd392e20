//! Limits of a scene file.

/// The maximum size of a scene file, in bytes: 1 MiB.
pub const LONGEST: usize = 1 << 20;

/// The maximum number of triangles in all shapes of a scene: slightly more than one for every pixel of mode 13h. Models
/// may have more.
pub const MAX_TRIANGLES: u64 = 1 << 16;
