//! What a budget decides for a triangle, and how that is said.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::raster::effects::Apart;
use crate::render::face::LitAt;
use crate::scene::Rung;

/// What is decided for a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::render) enum Choice {
    /// Nobody has asked yet.
    #[default]
    Unknown,
    Flat,
    Linear,
    Float,
    /// Quadratic on the screen, through light at six points.
    Curved,
    /// Light at pixels of a row that lie apart, linear between.
    PhongEvery(Apart),
    Phong,
}

impl Choice {
    pub(in crate::render) const fn rung(self) -> Rung {
        match self {
            Self::Flat => Rung::Flat,
            Self::Float => Rung::Float,
            Self::Phong | Self::PhongEvery(_) | Self::Curved => Rung::Phong,
            Self::Linear | Self::Unknown => Rung::Gouraud88Reseeded,
        }
    }
}

impl Choice {
    /// Whether its pixels need light beyond that of the corners.
    pub(in crate::render) fn needs_light(self) -> bool {
        matches!(self, Self::Phong | Self::PhongEvery(_) | Self::Curved)
    }

    /// Where it takes light.
    pub(in crate::render) fn lit_at(self) -> LitAt {
        match self {
            Self::PhongEvery(apart) => LitAt::Every(apart),
            Self::Curved => LitAt::SixPoints,
            _ => LitAt::Pixels,
        }
    }
}

/// What is known of an object's triangles.
#[derive(Clone, Debug, Default)]
pub(in crate::render) struct Decided {
    pub(in crate::render) choices: Vec<Choice>,
    /// For each how far linear shades of its two sides are from the model, highlights aside, if that is known. It stays as
    /// long as the object and its lights are what they are, wherever the eye is.
    pub(in crate::render) bodies: Vec<[Option<f32>; 2]>,
}

impl Decided {
    /// So many of which nothing is known.
    pub(in crate::render) fn nothing_of(&mut self, triangles: usize) {
        self.choices.clear();
        self.choices.resize(triangles, Choice::Unknown);
        self.bodies.clear();
        self.bodies.resize(triangles, [None; 2]);
    }

    pub(in crate::render) fn clear(&mut self) {
        self.nothing_of(0);
    }

    /// Bytes that it holds.
    pub(in crate::render) fn bytes(&self) -> usize {
        self.choices.capacity() * size_of::<Choice>() + self.bodies.capacity() * size_of::<[Option<f32>; 2]>()
    }
}

/// How many triangles went to which rung, and why.
pub(in crate::render) fn shares(decided: &Decided) -> String {
    let kinds = [
        (Choice::Flat, "one shade at their corners, or near enough"),
        (Choice::Linear, "light is linear enough on them"),
        (Choice::Float, "so it is, but not on the screen"),
        (Choice::Curved, "it is quadratic on the screen"),
        (Choice::PhongEvery(Apart::Sixteen), "at every 16th pixel of a row, and so it is between"),
        (Choice::PhongEvery(Apart::Eight), "at every 8th"),
        (Choice::PhongEvery(Apart::Four), "at every 4th"),
        (Choice::Phong, "it is not known to be"),
    ];
    let mut text = String::new();
    for (choice, why) in kinds {
        let count = decided.choices.iter().filter(|of| **of == choice).count();
        if count > 0 {
            text += &format!("{count} {} ({why}), ", choice.rung());
        }
    }
    let unseen = decided.choices.iter().filter(|of| **of == Choice::Unknown).count();
    text + &format!("{unseen} not drawn")
}
