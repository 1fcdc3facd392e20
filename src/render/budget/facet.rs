//! Figures of triangles and surfaces, whichever of them is decided on.

use glam::Vec3;

/// Bounds from a triangle's normals and edges, whatever the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// 1/|N| − 1 where |N| is least.
    pub(super) shortening: f32,
    /// The greatest angle between two normals.
    pub(super) spread: f32,
    /// The longest edge.
    pub(super) edge: f32,
}

impl Facet {
    pub(super) fn new(positions: [Vec3; 3], normals: [Vec3; 3]) -> Self {
        let squares = |of: [Vec3; 3]| [(of[0] - of[1]), (of[1] - of[2]), (of[2] - of[0])].map(Vec3::length_squared);
        let greatest = |squares: [f32; 3]| squares.into_iter().fold(0.0, f32::max);
        let chords = squares(normals);
        let chord = greatest(chords);
        let [a, b, c] = chords;
        // The nearest point lies on the longest edge, or, of an acute triangle, at the centre of its circumcircle,
        // of radius R: R² = a²b²c² / 16K², by the squares of the sides.
        let others = a + b + c - chord;
        let square = if others <= chord {
            chord / 4.0
        } else {
            a * b * c / (2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c))
        };
        Self {
            shortening: if square < 1.0 { 1.0 / libm::sqrtf(1.0 - square) - 1.0 } else { f32::INFINITY },
            spread: 2.0 * libm::asinf((libm::sqrtf(chord) / 2.0).min(1.0)),
            edge: libm::sqrtf(greatest(squares(positions))),
        }
    }
}

/// Greatest strength of the light on a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strength {
    /// The shade of the ramp's first entry, in 1/256 of an entry.
    pub(super) first: u16,
    /// Shades in 1/256 of an entry.
    pub(super) scale: f32,
    /// The ramp's last shade.
    pub(super) last: u16,
    /// The shade without any light but ambient light.
    pub(super) dark: u16,
    /// Sum of all suns that shine straight at it, in shades.
    pub(super) body: f32,
    /// Curvature of all highlights together, in shades for an angle of 1; 0 without any.
    pub(super) curvature: f32,
    /// Sum of all highlights at their brightest, in shades.
    pub(super) highlights: f32,
    /// Angles from which on nothing is seen of them but one, two or three quarters of what is allowed.
    pub(super) faint_from: [f32; 3],
}

impl Strength {
    /// Returns whether some of the shades between these two are cut off, and not all: above, or below where light may
    /// be taken away.
    #[inline]
    pub(super) fn cuts(&self, least: u16, most: u16, adds: bool) -> bool {
        (most >= self.last && least < self.last) | (!adds & (least <= self.first) & (most > self.first))
    }

    /// The most that suns add or take away, where the brightest shade is this. Where some add and others take away it says
    /// nothing of that.
    #[inline]
    pub(super) fn top(&self, brightest: u16, adds: bool) -> f32 {
        let top = f32::from(brightest - self.first) * self.scale;
        if adds { top } else { top.max(self.body) }
    }
}
