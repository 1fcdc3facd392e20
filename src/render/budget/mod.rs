//! The error budget: for each triangle the cheapest rung that is known to keep within it.
//!
//! What the light at a point of a triangle should be, and what a rung makes of it, differ for three reasons, each of
//! which is bounded here from normals, lights and vertices, without lighting anything but the vertices:
//!
//! - **The model.** A linear shade is that of the sum N = Σ λᵢnᵢ of the vertices' normals; light at the point takes N
//!   made unit. For a light in a fixed direction l that makes N·l / |N| out of N·l: more by (1/|N| − 1) of it, where
//!   |N| is least at the point of the flat triangle n₁n₂n₃ that is nearest to the centre of the sphere.
//! - **The clamp.** Of a light that reaches some vertices and others not, linear shades are those of Σ λᵢ max(0, nᵢ·l),
//!   and should be max(0, Σ λᵢ nᵢ·l). With P the most that a vertex lies in the light and S the most that
//!   one lies in the dark, these are no farther apart than PS / (P + S).
//! - **Curvature.** A function whose second derivative along any line is at most M is farther from the linear one
//!   through the corners of a triangle, whose longest edge is L, by no more than ML²/6: ½M times the square of the
//!   greatest distance to the nearest corner, L/√3. That bounds lamps, whose directions turn and whose light falls off,
//!   and highlights, cosˢμ, whose second derivative by the angle is at most s. A highlight's direction turns
//!   by twice the normals' spread and by what light and eye turn. Angles are taken for their chords; up to 0.3 that
//!   is off by 1 %, and a fifth is added.
//! - **The screen.** What is linear on the screen and not on the face moves shades along by a share of at most
//!   (√ρ − 1) / (√ρ + 1) ≤ (ρ − 1) / 4 of their range, ρ being the ratio of the corners' distances.
//!
//! The bounds of the parts are added. Decisions are kept as long as the vertices are.

mod light;

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use glam::Vec3;

use self::light::{OneLight, Towards, narrow};
use super::face::Faces;
use super::lit::{LitVertex, LitVertices};
use super::paint::Paint;
use super::vertex::Geometry;
use crate::light::{Answer, Beam, LampBeam, Lights};
use crate::mesh::Mesh;
use crate::raster::Vertex;
use crate::raster::clip::doubled_area;
use crate::raster::effects::Apart;
use crate::scene::{Rung, Shared};
use crate::span::lit::LANES;
use crate::view::ObjectView;

/// What rounding adds to a linear shade that starts anew every 64 pixels: a half, and a quarter of drift.
const LINEAR: f32 = 0.75;

/// What rounding adds to a shade that is exact before it: a half, and what f32 may be off.
const EXACT: f32 = 0.51;

/// Suns that a vertex has a bit for.
const SUNS: usize = 8;

/// Curvature is taken a fifth too great, for angles that are taken for their chords.
const CURVATURE: f32 = 1.2 / 6.0;

/// Pixels from which on it pays to light a face at some points before it is lit at all of them.
const WORTH_SAMPLES: f32 = 5.0;

/// The widest row of a triangle that it pays to light some pixels of, in pixels: as eight are lit at a time.
const WORTH_KNOTS: f32 = 16.0;

/// Points of a triangle that divide each edge in four, by their weights; the corners first, and at the end one once more.
const SAMPLES: [[f32; 3]; 16] = {
    let mut points = [[1.0, 0.0, 0.0]; 16];
    points[1] = [0.0, 1.0, 0.0];
    points[2] = [0.0, 0.0, 1.0];
    let (mut at, mut a) = (3, 0);
    while a < 4 {
        let mut b = 0;
        while a + b <= 4 {
            if b < 4 && a + b > 0 {
                points[at] = [a as f32 / 4.0, b as f32 / 4.0, (4 - a - b) as f32 / 4.0];
                at += 1;
            }
            b += 1;
        }
        a += 1;
    }
    points
};

/// What is decided for a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum Choice {
    /// Nobody has asked yet.
    #[default]
    Unknown,
    Flat,
    Linear,
    Float,
    /// Light at pixels of a row that lie apart, linear between.
    PhongEvery(Apart),
    Phong,
}

impl Choice {
    pub(super) const fn rung(self) -> Rung {
        match self {
            Self::Flat => Rung::Flat,
            Self::Float => Rung::Float,
            Self::Phong | Self::PhongEvery(_) => Rung::Phong,
            Self::Linear | Self::Unknown => Rung::Gouraud88Reseeded,
        }
    }
}

impl Choice {
    /// Whether pixels are lit, all or some.
    pub(super) fn lights_pixels(self) -> bool {
        matches!(self, Self::Phong | Self::PhongEvery(_))
    }

    /// How far those are apart that are lit, if not all are.
    pub(super) fn apart(self) -> Option<Apart> {
        if let Self::PhongEvery(apart) = self { Some(apart) } else { None }
    }
}

/// What is known of a triangle.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Decided {
    pub(super) choice: Choice,
    /// How far linear shades of its two sides are from the model, highlights aside. Known as long as the object and its
    /// lights are what they are, wherever the eye is.
    body: [Option<f32>; 2],
}

impl Decided {
    /// One of which all is known.
    pub(super) const LINEAR: Self = Self { choice: Choice::Linear, body: [None; 2] };
}

/// How many triangles went to which rung, and why.
pub(super) fn shares(decided: &[Decided]) -> String {
    let kinds = [
        (Choice::Flat, "one shade at their corners, or near enough"),
        (Choice::Linear, "light is linear enough on them"),
        (Choice::Float, "so it is, but not on the screen"),
        (Choice::PhongEvery(Apart::Sixteen), "at every 16th pixel of a row, and so it is between"),
        (Choice::PhongEvery(Apart::Eight), "at every 8th"),
        (Choice::PhongEvery(Apart::Four), "at every 4th"),
        (Choice::Phong, "it is not known to be"),
    ];
    let mut text = String::new();
    for (choice, why) in kinds {
        let count = decided.iter().filter(|of| of.choice == choice).count();
        if count > 0 {
            text += &format!("{count} {} ({why}), ", choice.rung());
        }
    }
    let unseen = decided.iter().filter(|of| of.choice == Choice::Unknown).count();
    text + &format!("{unseen} not drawn")
}

/// What a triangle's normals and edges say, whatever the light.
#[derive(Clone, Copy, Debug)]
struct Facet {
    /// 1/|N| − 1 where |N| is least.
    shortening: f32,
    /// The greatest angle between two normals.
    spread: f32,
    /// The longest edge.
    edge: f32,
}

impl Facet {
    fn new(positions: [Vec3; 3], normals: [Vec3; 3]) -> Self {
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

/// What the light on a material comes to at most.
#[derive(Clone, Copy, Debug)]
struct Strength {
    /// The shade of the ramp's first entry, in 1/256 of an entry.
    first: u16,
    /// Shades in 1/256 of an entry.
    scale: f32,
    /// The ramp's last shade.
    last: u16,
    /// The shade without any light but ambient light.
    dark: u16,
    /// What all suns that shine straight at it add, in shades.
    body: f32,
    /// What all highlights together curve by, in shades for an angle of 1; 0 without any.
    curvature: f32,
    /// What all highlights at their brightest add, in shades.
    highlights: f32,
    /// From so far on, as an angle, nothing is seen of them but a fourth of what is allowed.
    faint_from: f32,
}

/// An object, projected and lit.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a> {
    pub(super) geometry: &'a Geometry<'a>,
    /// Its mesh, if that is what is drawn.
    pub(super) whole: Option<&'a Shared<Mesh>>,
    pub(super) view: &'a ObjectView,
    /// How near it comes, along the view.
    pub(super) nearest: f64,
    pub(super) lights: &'a Lights<'a>,
    pub(super) paints: &'a [Paint],
    pub(super) channels: bool,
}

/// What is kept for an object's decisions.
#[derive(Debug, Default)]
pub(super) struct Budget {
    /// Whose facets these are; of a mesh that was split, none.
    mesh: Option<Shared<Mesh>>,
    facets: Vec<Facet>,
    /// One for each surface.
    strengths: Vec<Strength>,
    allowed: f32,
    longest_edge: f32,
    most_shortening: f32,
    most_spread: f32,
    /// A quarter of ρ − 1, at most, of any triangle that no plane clips.
    bend: f32,
    /// Whether there are more suns than a vertex has bits for, and whether there is one.
    many_suns: bool,
    one_sun: bool,
    /// Whether there are suns alone, no more than that, and no highlight.
    simple: bool,
    /// Then, whether linear shades keep within wherever all corners see the same suns and none is clamped.
    linear_unless_mixed: bool,
    /// And there, too.
    linear_throughout: bool,
    /// What lights it, and what it answers: what bodies' errors are known for.
    suns: Vec<Beam>,
    known_lamps: Vec<LampBeam>,
    answers: Vec<Answer>,
    in_color: bool,
    /// What an edge of 1 turns the direction to the eye by, at most.
    eye_turn: f32,
    /// For each vertex the eye, if there are highlights, and the chord between the eye and the mirrored light that is
    /// nearest to it: no more than the angle.
    to_eye: Vec<Towards>,
    chords: Vec<f32>,
    /// What an edge of 1 turns the direction to any lamp by, at most.
    lamp_turn: f32,
    /// For each lamp 1 / range and its intensity, that of its brightest channel; and for each vertex where it is.
    lamps: Vec<(f32, f32)>,
    to_lamps: Vec<Towards>,
}

impl Budget {
    /// Takes on an object, or the same as it is now.
    #[inline(never)]
    pub(super) fn renew(&mut self, allowed: f32, object: &Lit<'_>, decided: &mut Vec<Decided>) {
        let Lit { geometry, whole, view, nearest, lights, paints, channels } = *object;
        let mut same = self.allowed == allowed && self.in_color == channels;
        (self.allowed, self.in_color) = (allowed, channels);
        same &= self.suns == lights.suns && self.known_lamps == lights.lamps;
        same &= self.answers.iter().eq(paints.iter().map(|paint| &paint.answer));
        if !same {
            self.suns.clear();
            self.suns.extend_from_slice(lights.suns);
            self.known_lamps.clear();
            self.known_lamps.extend_from_slice(lights.lamps);
            self.answers.clear();
            self.answers.extend(paints.iter().map(|paint| paint.answer));
        }
        let known = matches!((&self.mesh, whole), (Some(known), Some(whole)) if Shared::ptr_eq(known, whole));
        if !known {
            self.mesh = whole.map(Shared::clone);
            self.facets.clear();
            let corners = |of: &[Vec3], indices: [u32; 3]| indices.map(|i| of[i as usize]);
            let facet = |&i: &[u32; 3]| Facet::new(corners(geometry.positions, i), corners(geometry.normals, i));
            self.facets.extend(geometry.triangles.iter().map(facet));
            let most = |of: fn(&Facet) -> f32| self.facets.iter().map(of).fold(0.0, f32::max);
            (self.longest_edge, self.most_shortening) = (most(|facet| facet.edge), most(|facet| facet.shortening));
            self.most_spread = most(|facet| facet.spread);
        }
        same &= known && decided.len() == geometry.triangles.len();
        if same {
            decided.iter_mut().for_each(|of| of.choice = Choice::Unknown);
        } else {
            decided.clear();
            decided.resize(geometry.triangles.len(), Decided::default());
        }
        let nearest = nearest.max(f64::from(view.near()));
        self.bend = (f64::from(self.longest_edge) * view.scale() / nearest / 4.0) as f32;
        self.strengths.clear();
        self.strengths.extend(paints.iter().map(|paint| {
            // A ramp has at most 256 entries.
            let entries = paint.ramp.entries();
            let first = u16::from(paint.ramp.first()) << 8;
            let scale = if entries > 1 { 255.0 / (256.0 * f32::from(entries - 1)) } else { 0.0 };
            let suns = lights.suns.iter().map(|sun| brightest(sun.intensity, sun.channels, channels));
            let lamps = lights.lamps.iter().map(|lamp| brightest(lamp.intensity, lamp.channels, channels));
            let all: f32 = suns.chain(lamps).sum();
            let (ks, s) = highlight(paint, channels);
            let curvature = if ks == 0.0 { 0.0 } else { CURVATURE * curve(s) * ks * all };
            let body = (paint.answer.diffuse.abs() * 255.0) as f32
                * lights.suns.iter().map(|s| s.intensity.abs()).sum::<f32>();
            let dark = paint.constant().to_bits();
            Strength {
                body,
                dark,
                first,
                scale,
                last: first + ((entries - 1) << 8),
                curvature,
                highlights: ks * all,
                faint_from: faint_from(ks * all, s, allowed / 4.0),
            }
        }));
        let positions = geometry.positions.iter();
        if !same {
            self.lamps.clear();
            self.lamps.extend(lights.lamps.iter().map(|lamp| {
                let inverse_range = libm::sqrt(lamp.inverse_square) as f32;
                (inverse_range, brightest(lamp.intensity, lamp.channels, channels))
            }));
            self.to_lamps.clear();
            self.to_lamps.extend(lights.lamps.iter().flat_map(|lamp| {
                let at = narrow(lamp.position);
                positions.clone().map(move |position| Towards::new(at - *position))
            }));
        }
        self.to_eye.clear();
        self.many_suns = lights.suns.len() > SUNS;
        self.one_sun = lights.suns.len() == 1;
        self.simple = lights.lamps.is_empty()
            && !channels
            && !self.many_suns
            && self.strengths.iter().all(|of| of.curvature == 0.0);
        self.eye_turn = 0.0;
        if self.simple {
            return;
        }
        if self.strengths.iter().any(|of| of.curvature != 0.0) {
            let eye = narrow(lights.eye);
            self.to_eye.extend(positions.map(|position| Towards::new(eye - *position)));
            // The eye is at least this far away.
            let nearest = |of: &[Towards]| of.iter().map(|of| of.distance).fold(f32::INFINITY, f32::min);
            self.eye_turn = 1.0 / nearest(&self.to_eye);
            self.lamp_turn = 1.0 / nearest(&self.to_lamps);
            self.find_chords(geometry, lights);
        }
    }

    /// Finds out how far highlights are from the vertices.
    #[inline(never)]
    fn find_chords(&mut self, geometry: &Geometry<'_>, lights: &Lights<'_>) {
        self.chords.clear();
        self.chords.resize(self.to_eye.len(), 2.0);
        let vertices = geometry.normals.iter().zip(&self.to_eye);
        let chord = |normal: &Vec3, eye: &Towards, light: Vec3| {
            let along = 2.0 * normal.dot(light) * normal.dot(eye.direction) - light.dot(eye.direction);
            libm::sqrtf((2.0 - 2.0 * along).max(0.0))
        };
        for sun in lights.suns {
            for (least, (normal, eye)) in self.chords.iter_mut().zip(vertices.clone()) {
                *least = least.min(chord(normal, eye, sun.towards));
            }
        }
        for to_lamp in self.to_lamps.chunks_exact(self.to_eye.len().max(1)) {
            for ((least, (normal, eye)), lamp) in self.chords.iter_mut().zip(vertices.clone()).zip(to_lamp) {
                *least = least.min(chord(normal, eye, lamp.direction));
            }
        }
    }

    /// Whether nothing is seen of a highlight on a face but a fourth of what is allowed: it is that far from each corner,
    /// and from there no point is farther than the share of an edge that is in `light`.
    #[inline]
    fn is_far_from_highlights(&self, question: &Question<'_>, facet: &Facet, strength: &Strength) -> bool {
        let [a, b, c] = question.indices.map(|i| self.chords[i as usize]);
        let turn = 2.0 * facet.spread + facet.edge * (self.eye_turn + self.lamp_turn);
        // Where that is more it says nothing.
        facet.edge * self.eye_turn.max(self.lamp_turn) < 0.5
            && facet.spread < 1.5
            && a.min(b).min(c) >= strength.faint_from + light::FROM_ONE * 1.2 * turn
    }

    /// Marks the object's vertices with the suns that they see, and finds out what holds for all of it.
    #[inline(never)]
    pub(super) fn mark(&mut self, object: &Lit<'_>, lit: &mut LitVertices) {
        let Lit { geometry, lights, .. } = *object;
        // How far linear shades are off at most, but where some corners see a sun and others not, or some are clamped.
        let keeps_within = |of: &Strength, more: f32| {
            let top = f32::from(of.last - of.first) * of.scale;
            let range = (of.body * self.most_spread).min(top);
            top * self.most_shortening + range * self.bend + more + LINEAR <= self.allowed
        };
        self.linear_unless_mixed = self.simple && self.strengths.iter().all(|of| keeps_within(of, 0.0));
        // And there too; see `decide_at_once`.
        self.linear_throughout = self.linear_unless_mixed
            && self.strengths.iter().all(|of| {
                let brightest = f32::from(of.dark - of.first) * of.scale + of.body;
                let is_clamped = brightest >= f32::from(of.last - of.first) * of.scale;
                !is_clamped && keeps_within(of, of.body * self.most_spread / 4.0)
            });
        if !self.by_shades() && !self.linear_throughout {
            lit.suns_seen.resize(geometry.normals.len(), 0);
            for (i, sun) in (0..SUNS).zip(lights.suns) {
                for (seen, normal) in lit.suns_seen.iter_mut().zip(geometry.normals) {
                    *seen |= u8::from(normal.dot(sun.towards) > 0.0) << i;
                }
            }
        }
    }

    /// Whether linear shades keep within on all of the object.
    pub(super) fn is_linear_throughout(&self) -> bool {
        self.linear_throughout
    }

    /// Whether a vertex says by its shades which sun it sees: there is one, and no other light. Only what it sees by
    /// less than a step of its shades goes unnoticed.
    #[inline]
    fn by_shades(&self) -> bool {
        self.simple && self.one_sun
    }

    /// The suns that a vertex sees, a bit for each.
    #[inline]
    fn suns_seen(&self, lit: &LitVertex) -> u8 {
        if self.by_shades() { u8::from(lit.vertex.shade() > lit.back) } else { lit.suns_seen }
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.facets.capacity() * size_of::<Facet>()
            + self.chords.capacity() * size_of::<f32>()
            + (self.to_eye.capacity() + self.to_lamps.capacity()) * size_of::<Towards>()
            + self.lamps.capacity() * size_of::<(f32, f32)>()
            + self.strengths.capacity() * size_of::<Strength>()
            + self.suns.capacity() * size_of::<Beam>()
            + self.known_lamps.capacity() * size_of::<LampBeam>()
            + self.answers.capacity() * size_of::<Answer>()
    }
}

/// The greatest second derivative of cosˢ by its angle. Below s = 1 there is none: it is steep where it ends.
fn curve(shininess: f32) -> f32 {
    if shininess >= 1.0 { shininess } else { f32::INFINITY }
}

/// From which angle on `strength`·cosˢ is not more than `limit`: xˢ ≤ exp(−s(1 − x)).
fn faint_from(strength: f32, shininess: f32, limit: f32) -> f32 {
    if strength <= limit {
        return 0.0;
    }
    let cosine = 1.0 - libm::logf(strength / limit) / shininess;
    if cosine > -1.0 { libm::acosf(cosine) } else { f32::INFINITY }
}

/// A light's greatest channel, or its one.
fn brightest(intensity: f32, channels: [f32; 3], in_color: bool) -> f32 {
    if in_color { channels.into_iter().fold(0.0, |most, c| most.max(c.abs())) } else { intensity.abs() }
}

/// The highlight's strength in shades, and its exponent.
fn highlight(paint: &Paint, in_color: bool) -> (f32, f32) {
    let color = if in_color { paint.answer.highlight.into_iter().fold(0.0, f64::max) } else { 1.0 };
    ((paint.answer.specular * color).abs() as f32 * 255.0, paint.answer.shininess as f32)
}

/// A triangle that is to be decided on.
pub(super) struct Question<'a> {
    /// Its place.
    pub(super) triangle: usize,
    pub(super) indices: [u32; 3],
    pub(super) surface: u16,
    pub(super) turned: bool,
    /// The corners' shades, or, of the channels, the three of each.
    pub(super) shades: [[u16; 3]; 3],
    /// Where it is on the screen; of what is clipped nowhere.
    pub(super) vertices: Option<&'a [Vertex; 3]>,
}

impl Budget {
    /// The cheapest rung of a face that suns light, all that it sees from each of its corners, and whose shades are
    /// not clamped, where that is known at once. The corners are given on the side that is seen.
    #[inline(always)]
    pub(super) fn decide_at_once(
        &self,
        triangle: usize,
        surface: u16,
        lit: &LitVertices,
        indices: [u32; 3],
        turned: bool,
    ) -> Choice {
        if !self.simple {
            return Choice::Unknown;
        }
        let corners = indices.map(|i| i as usize);
        let shades = corners.map(|i| lit.shades[i]);
        let [a, b, c] = if self.by_shades() {
            shades.map(|[front, back]| u8::from(front > back))
        } else {
            corners.map(|i| lit.suns_seen[i])
        };
        let mixed = a != b || b != c;
        let strength = &self.strengths[usize::from(surface)];
        let [a, b, c] = shades.map(|sides| sides[usize::from(turned)].to_bits());
        let most = a.max(b).max(c);
        if most >= strength.last {
            return Choice::Unknown;
        }
        if self.linear_unless_mixed && !mixed {
            return Choice::Linear;
        }
        // n·l differs by no more than the normals do, which is P + S at most; and PS / (P + S) ≤ (P + S) / 4.
        let facet = &self.facets[triangle];
        let apart = strength.body * facet.spread;
        let least = a.min(b).min(c);
        let clamp = if !mixed {
            0.0
        } else if self.one_sun {
            // P is what the brightest corner has of it.
            let lit = f32::from(most.saturating_sub(strength.dark)) * strength.scale;
            if lit < apart { lit * (apart - lit) / apart } else { 0.0 }
        } else {
            apart / 4.0
        };
        // A corner's shade lies in its ramp.
        let model = clamp + f32::from(most - strength.first) * strength.scale * facet.shortening;
        if least == most {
            return if model + EXACT <= self.allowed { Choice::Flat } else { Choice::Unknown };
        }
        let range = f32::from(most - least) * strength.scale;
        if model + range * self.bend + LINEAR <= self.allowed { Choice::Linear } else { Choice::Unknown }
    }
}

impl Question<'_> {
    /// The least and the greatest depth, which is in proportion to 1 / w; 0 if a corner has none.
    fn depths(&self) -> (u32, u32) {
        let [a, b, c] = self.vertices.map_or([0; 3], |vertices| vertices.each_ref().map(Vertex::depth));
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// Its area on the screen.
    fn pixels(&self) -> f32 {
        // In 1/256 pixel, and twice.
        self.vertices.map_or(f32::MAX, |vertices| doubled_area(vertices).unsigned_abs() as f32 / 131_072.0)
    }

    /// The widest of its rows, in pixels; 0 where it is nowhere.
    fn width(&self) -> f32 {
        let Some(vertices) = self.vertices else { return 0.0 };
        let [a, b, c] = vertices.each_ref().map(|vertex| vertex.y().to_bits());
        let height = a.max(b).max(c) - a.min(b).min(c);
        if height == 0 { 0.0 } else { 512.0 * self.pixels() / height as f32 }
    }
}

impl Faces<'_> {
    /// The cheapest rung that keeps within the budget.
    pub(super) fn cheapest_within(&self, budget: &Budget, question: &Question<'_>, decided: &mut Decided) -> Choice {
        let facet = &budget.facets[question.triangle];
        let strength = &budget.strengths[usize::from(question.surface)];
        let [a, b, c] = question.shades;
        let channels = if self.channels { 3 } else { 1 };
        let (mut range, mut top, mut clamped) = (0, 0, false);
        for channel in 0..channels {
            let least = a[channel].min(b[channel]).min(c[channel]);
            let most = a[channel].max(b[channel]).max(c[channel]);
            range = range.max(most - least);
            top = top.max(most - strength.first);
            clamped |= most >= strength.last && least < strength.last;
        }
        let (range, top) = (f32::from(range) * strength.scale, f32::from(top) * strength.scale);

        // For suns alone, all of them above the horizon or all below.
        let turned = 2.0 * facet.spread + facet.edge * budget.eye_turn;
        let mut model = top * facet.shortening + strength.curvature * turned * turned;
        let spare = budget.allowed - EXACT;
        // What the body alone is off by, at least as it is known, whatever the light.
        let hopeless = (top - strength.highlights) * facet.shortening > spare;
        let seen = question.indices.map(|i| budget.suns_seen(&self.lit.get(i as usize)));
        let some = budget.many_suns || (seen[0] | seen[1] | seen[2]) & !(seen[0] & seen[1] & seen[2]) != 0;
        let lamps = !self.lights.lamps.is_empty();
        let near = model <= spare;
        let highlights = strength.curvature > 0.0;
        let far = highlights && budget.is_far_from_highlights(question, facet, strength);
        if far && !lamps && !some && !clamped {
            model = model.min(top * facet.shortening + budget.allowed / 4.0);
        }
        let near = near || model <= spare;
        if !hopeless && (lamps || ((some || clamped) && near) || (highlights && !near)) {
            let body = &mut decided.body[usize::from(question.turned)];
            let known = *body.get_or_insert_with(|| {
                self.body_error(budget, question, &self.one_light(budget, question, 1.0), spare)
            });
            model = if far {
                known + budget.allowed / 4.0
            } else {
                self.model_error(budget, question, 1.0, spare, Some(known))
            };
            if clamped {
                // What lies above the clamp is lost at some corners, by which the others are too dark at most.
                model += range;
            }
            if model > spare && question.pixels() >= WORTH_SAMPLES {
                model = self.error_between_samples(budget, question, spare);
            }
        }
        let bound = budget.allowed;
        // Depth is in proportion to 1 / w.
        let (far, near) = question.depths();
        let bend = (near - far) as f32 * range;
        // A corner behind the near plane has no depth.
        let linear = far > 0 && bend <= 4.0 * far as f32 * (bound - model - LINEAR);
        // Linear shades cost no more than one shade where they differ at all: the same spans, by the same loop.
        if model + range / 2.0 + EXACT <= bound && (range == 0.0 || !linear) {
            Choice::Flat
        } else if linear {
            Choice::Linear
        } else if model + EXACT <= bound || !self.lights_pixels {
            Choice::Float
        } else {
            let linear = |apart: &Apart| self.is_linear_between(budget, question, clamped, *apart);
            Apart::ALL.into_iter().rev().find(linear).map_or(Choice::Phong, Choice::PhongEvery)
        }
    }

    /// Whether light is linear enough between two pixels of a row that are so far apart.
    #[inline(never)]
    fn is_linear_between(&self, budget: &Budget, question: &Question<'_>, clamped: bool, apart: Apart) -> bool {
        // At most 16.
        let ((far, near), width, apart) = (question.depths(), question.width(), apart.pixels() as f32);
        if far == 0 || width < WORTH_KNOTS.max(1.5 * apart) {
            return false;
        }
        // A pixel is a step on the face that is greater by the ratio of distances where it is farthest than where it is
        // nearest.
        let ratio = near as f32 / far as f32;
        let part = apart * ratio / width;
        if part > 0.75 {
            return false;
        }
        let facet = &budget.facets[question.triangle];
        let strength = &budget.strengths[usize::from(question.surface)];
        let lamps = !self.lights.lamps.is_empty();
        let highlights = strength.curvature > 0.0;
        // What shades differ by over the face at most; cosˢ is nowhere steeper than √(s/e).
        let turned = 2.0 * facet.spread + facet.edge * budget.eye_turn;
        let shininess = self.paints[usize::from(question.surface)].answer.shininess as f32;
        let differ = if lamps {
            255.0
        } else {
            let body = strength.body * facet.spread * (1.0 + facet.shortening);
            (body + strength.highlights * 0.61 * libm::sqrtf(shininess) * turned).min(255.0)
        };
        // Shades that are cut off above 1 somewhere on the way: a fourth of what they differ by there.
        let cut = if clamped || highlights { part * differ / 4.0 } else { 0.0 };
        let bend = (ratio - 1.0) / 4.0 * part * part * differ;
        let spare = budget.allowed - EXACT - cut - bend;
        spare > 0.0 && self.model_error(budget, question, part, spare, None) <= spare
    }

    /// What light from one source needs to know.
    fn one_light<'a>(&self, budget: &'a Budget, question: &Question<'_>, part: f32) -> OneLight<'a> {
        let paint = &self.paints[usize::from(question.surface)];
        let side = if question.turned { -1.0 } else { 1.0 };
        let color = if self.channels { paint.answer.color.into_iter().fold(0.0, f64::max) } else { 1.0 };
        let (ks, shininess) = highlight(paint, self.channels);
        let corners = question.indices.map(|i| i as usize);
        OneLight {
            facet: &budget.facets[question.triangle],
            normals: corners.map(|i| self.geometry.normals[i] * side),
            to_eye: if ks == 0.0 { [Towards::default(); 3] } else { corners.map(|i| budget.to_eye[i]) },
            kd: (paint.answer.diffuse * color).abs() as f32 * 255.0,
            ks,
            shininess,
            part,
        }
    }

    /// How far linear shades are from the model, in shades; where that is more than `limit`, anything beyond it. `body`
    /// is what they are off by without highlights, if that is known.
    #[inline(never)]
    fn model_error(&self, budget: &Budget, question: &Question<'_>, part: f32, limit: f32, body: Option<f32>) -> f32 {
        let light = self.one_light(budget, question, part);
        let corners = question.indices.map(|i| i as usize);
        let mut sum = body.unwrap_or_else(|| self.body_error(budget, question, &light, limit));
        if light.ks == 0.0 || sum > limit {
            return sum;
        }
        for sun in self.lights.suns {
            let intensity = brightest(sun.intensity, sun.channels, self.channels);
            sum += light.highlight_of_sun(sun.towards, intensity, limit - sum);
            if sum > limit {
                return sum;
            }
        }
        let vertices = self.geometry.positions.len();
        for (&(inverse_range, intensity), to_lamp) in budget.lamps.iter().zip(budget.to_lamps.chunks_exact(vertices)) {
            sum += light.highlight_of_lamp(corners.map(|i| to_lamp[i]), inverse_range, intensity, limit - sum);
            if sum > limit {
                return sum;
            }
        }
        sum
    }

    /// The same without highlights: where the eye is makes no difference.
    #[inline(never)]
    fn body_error(&self, budget: &Budget, question: &Question<'_>, light: &OneLight<'_>, limit: f32) -> f32 {
        let corners = question.indices.map(|i| i as usize);
        let mut sum = 0.0;
        for sun in self.lights.suns {
            sum += light.body_of_sun(sun.towards, brightest(sun.intensity, sun.channels, self.channels));
            if sum > limit {
                return sum;
            }
        }
        let vertices = self.geometry.positions.len();
        for (&(inverse_range, intensity), to_lamp) in budget.lamps.iter().zip(budget.to_lamps.chunks_exact(vertices)) {
            sum += light.body_of_lamp(corners.map(|i| to_lamp[i]), inverse_range, intensity);
            if sum > limit {
                return sum;
            }
        }
        sum
    }

    /// The same, found at twelve points between the corners, which divide each edge in four: between them the
    /// function is no farther from linear than a part of a fourth of the size may be.
    #[inline(never)]
    fn error_between_samples(&self, budget: &Budget, question: &Question<'_>, limit: f32) -> f32 {
        let between = self.model_error(budget, question, 0.25, limit, None);
        // A bound that is 16 times as much is seldom wrong by half.
        if between > limit / 3.0 {
            return f32::INFINITY;
        }
        let corners = question.indices.map(|i| i as usize);
        let normals =
            corners.map(|i| if question.turned { -self.geometry.normals[i] } else { self.geometry.normals[i] });
        let positions = corners.map(|i| self.geometry.positions[i]);
        let answer = &self.paints[usize::from(question.surface)].answer;
        // The corners are among the points.
        let mut intensities = [[0.0_f32; 3]; SAMPLES.len()];
        for (weights, intensities) in SAMPLES.chunks_exact(LANES).zip(intensities.chunks_exact_mut(LANES)) {
            let mut points = [[0.0; LANES]; 6];
            for (lane, [a, b, c]) in weights.iter().enumerate() {
                let between = |of: &[Vec3; 3]| (of[0] * *a + of[1] * *b + of[2] * *c).to_array();
                for (axis, (n, p)) in between(&normals).into_iter().zip(between(&positions)).enumerate() {
                    (points[axis][lane], points[axis + 3][lane]) = (n, p);
                }
            }
            // Shown, they are clamped.
            let shown = |intensity: f64| intensity.clamp(0.0, 1.0) as f32;
            if self.channels {
                let channels = self.lights.front_of_three_channels(answer, &points);
                for (lane, of) in intensities.iter_mut().enumerate() {
                    *of = channels.each_ref().map(|channel| shown(channel[lane]));
                }
            } else {
                let all = self.lights.front_of_one_channel(answer, &points);
                for (of, intensity) in intensities.iter_mut().zip(all) {
                    *of = [shown(intensity); 3];
                }
            }
        }
        let [a, b, c, ..] = intensities;
        let (mut off, mut clamp) = (0.0_f32, 0.0_f32);
        for channel in 0..3 {
            let (a, b, c) = (a[channel], b[channel], c[channel]);
            let (mut least, mut most) = (1.0_f32, 0.0_f32);
            for (weights, intensities) in SAMPLES.iter().zip(&intensities) {
                let at = intensities[channel];
                off = off.max((a * weights[0] + b * weights[1] + c * weights[2] - at).abs());
                (least, most) = (least.min(at), most.max(at));
            }
            if most >= 1.0 {
                clamp = clamp.max(most - least);
            }
        }
        // Of PS / (P + S), P what lies above the clamp, no more than a fourth of both.
        between + 255.0 * (off + clamp / 4.0)
    }
}
