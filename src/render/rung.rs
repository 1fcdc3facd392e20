//! The rungs of the ladder: how a pixel gets its shade, from cheap to exact.

use core::fmt;
use core::str::FromStr;

/// A technique of shading.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum Rung {
    /// One shade for each face.
    Flat,
    /// Linear between the vertices in 8.8, each row of a triangle one span.
    Gouraud88,
    /// The same, started anew every 64 pixels: the default.
    #[default]
    Gouraud88Reseeded,
    /// Linear on the face in space, so perspective-correct: a quotient for every pixel.
    GouraudHyperbolic,
}

impl Rung {
    /// Every rung, from cheap to exact.
    pub const ALL: [Self; 4] = [Self::Flat, Self::Gouraud88, Self::Gouraud88Reseeded, Self::GouraudHyperbolic];

    /// Its name, as it is typed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud88 => "gouraud-8.8",
            Self::Gouraud88Reseeded => "gouraud-8.8-reseeded",
            Self::GouraudHyperbolic => "gouraud-hyperbolic",
        }
    }
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// There is no rung of that name. Its text lists those there are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UnknownRung;

impl fmt::Display for UnknownRung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unknown rung; there are")?;
        for (i, rung) in Rung::ALL.iter().enumerate() {
            write!(f, "{} {rung}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownRung {}

impl FromStr for Rung {
    type Err = UnknownRung;

    fn from_str(name: &str) -> Result<Self, UnknownRung> {
        Self::ALL.into_iter().find(|rung| rung.name() == name).ok_or(UnknownRung)
    }
}
