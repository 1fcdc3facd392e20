//! The two ways from a mesh to projected vertices.

use core::fmt;
use core::str::FromStr;

/// A way from a mesh to projected vertices. From there on both are drawn by the same raster.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum VertexPath {
    /// In f32.
    #[default]
    Float,
    /// In 16.16, by [`integer`](crate::integer). The scene's own numbers are floats, so they are
    /// converted: a mesh when it is first seen, angles to the nearest 65,536th of a turn.
    Integer,
}

impl VertexPath {
    /// Both ways.
    pub const ALL: [Self; 2] = [Self::Float, Self::Integer];

    /// Its name, as it is typed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Integer => "integer",
        }
    }
}

impl fmt::Display for VertexPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// There is no vertex path of that name. Its text lists those there are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UnknownVertexPath;

impl fmt::Display for UnknownVertexPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unknown vertex path; there are")?;
        for (i, path) in VertexPath::ALL.iter().enumerate() {
            write!(f, "{} {path}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownVertexPath {}

impl FromStr for VertexPath {
    type Err = UnknownVertexPath;

    fn from_str(name: &str) -> Result<Self, UnknownVertexPath> {
        Self::ALL.into_iter().find(|path| path.name() == name).ok_or(UnknownVertexPath)
    }
}
