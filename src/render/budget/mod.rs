//! The error budget: for each triangle the cheapest shading that is known to keep within it.
//!
//! A shading's light at a point of a triangle differs from the right one for three reasons, each of
//! which is bounded here from normals, lights and vertices:
//!
//! - **The model.** A linear shade is that of the sum N = Σ λᵢnᵢ of the vertices' normals; light at the point takes N
//!   made unit. For a light in a fixed direction l that makes N·l / |N| out of N·l: more by (1/|N| − 1) of it, where
//!   |N| is least at the point of the flat triangle n₁n₂n₃ that is nearest to the centre of the sphere.
//! - **The clamp.** Of a light that reaches some vertices and others not, linear shades are those of Σ λᵢ max(0, nᵢ·l),
//!   and should be max(0, Σ λᵢ nᵢ·l). With P the most that a vertex lies in the light and S the most that
//!   one lies in the dark, these are no farther apart than PS / (P + S). By that much linear shades are too bright, and for
//!   want of length too dark: of the two the greater counts, not their sum.
//! - **Curvature.** A function whose second derivative along any line is at most M is farther from the linear one
//!   through the corners of a triangle, whose longest edge is L, by no more than ML²/6: ½M times the square of the
//!   greatest distance to the nearest corner, L/√3. That bounds lamps, whose directions turn and whose light falls off,
//!   and highlights, cosˢμ, whose second derivative by the angle is at most s. A highlight's direction turns
//!   by twice the normals' spread and by what light and eye turn. Angles are taken for their chords; up to 0.3 that
//!   is off by 1 %, and a fifth is added.
//! - **The screen.** What is linear on the screen and not on the face moves shades along by a share of at most
//!   (√ρ − 1) / (√ρ + 1) ≤ (ρ − 1) / 4 of their range, ρ being the ratio of the corners' distances.
//!
//! The bounds of the parts are added. Where that is too much, three ways are left before every pixel is lit:
//!
//! - **Points between the corners** (`error_between_samples`). Twelve are lit, which divide each edge in four. A function
//!   is no farther from the linear one than at the worst of these points, and what a bound for a part of a fourth of the
//!   size says: a sixteenth of the curvature, a fourth of what a clamp or a horizon does.
//! - **A quadratic function of the screen** through light at six points of the face (`curve`).
//! - **Pixels of a row that lie apart** (`is_linear_between`). 16, 8 or 4 of them are so small a part of the face that
//!   light is linear between.
//!
//! Decisions are kept as long as the vertices are; what bodies are off by without their highlights, as long as the object
//! and its lights are, wherever the eye goes.
//!
//! | file | what |
//! |---|---|
//! | `facet` | what is known of every triangle and surface |
//! | `cluster` | the decision on 64 triangles at once |
//! | `light` | how far linear shades are off in the light of one source |
//! | `corners` | what is known of every vertex |
//! | `eight` | which of eight triangles are linear |
//! | `question` | the decision on one triangle |
//! | `settle` | which faces of a chunk are linear, before any is looked at by itself |
//! | `curve` | whether quadratic shades do |
//! | `decided` | what is decided |

mod cluster;
mod corners;
mod curve;
mod decided;
mod eight;
mod facet;
mod light;
mod question;
mod settle;

use alloc::vec::Vec;

use glam::Vec3;

use self::cluster::{Cluster, Cones};
use self::cluster::{Linear, Where};
pub(super) use self::curve::limits;
pub(super) use self::decided::{Bodies, Choice, Decided};
use self::facet::{Facet, Strength};
use self::light::{Towards, narrow};
pub(super) use self::question::Question;
pub(super) use self::settle::Vain;
use super::lit::ShadedVertices;
use super::paint::SurfaceMaterial;
use super::sift;
use super::vertex::{Geometry, VertexAttributes};
use crate::light::{Beam, LampBeam, Lights, Reflectance};
use crate::mesh::Mesh;
use crate::shared::Shared;
use crate::span::Kernel;
use crate::view::ObjectView;

/// Pixels from which on it pays to light a face at some points before it is lit at all of them. (With 12 `still` takes 2 % less,
/// and `two-lights` within 2 shades 25 % more.)
pub(super) const WORTH_SAMPLES: u64 = 5;

/// Rounding of a linear shade that starts anew every 64 pixels: a half, and a quarter of drift.
const LINEAR: f32 = 0.75;

/// Rounding of a shade that is exact before it: a half, and the error of f32.
const EXACT: f32 = 0.51;

/// The shares of what is allowed, in quarters, that highlights may take where they are faint.
const QUARTERS: [f32; 3] = [1.0, 2.0, 3.0];

/// Lights that a vertex has a bit for. The one above says whether a shade of it is clamped.
const LIGHTS: usize = 7;

/// Curvature is taken a fifth too great, for angles that are taken for their chords.
const CURVATURE: f32 = 1.2 / 6.0;

/// An object, projected and lit.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a> {
    pub(super) geometry: &'a Geometry<'a>,
    /// Its mesh, if that is what is drawn.
    pub(super) whole: Option<&'a Shared<Mesh>>,
    pub(super) view: &'a ObjectView,
    /// Least distance, along the view.
    pub(super) nearest: f64,
    pub(super) lights: &'a Lights<'a>,
    pub(super) paints: &'a [SurfaceMaterial],
    pub(super) channels: bool,
    pub(super) kernel: Kernel,
}

/// Error budget of an object: the data that its decisions are made from.
#[derive(Debug, Default)]
pub(super) struct Budget {
    /// Whose facets these are; of a mesh that was split, none.
    mesh: Option<Shared<Mesh>>,
    facets: Vec<Facet>,
    /// One for as many faces as are culled at a time.
    clusters: Vec<Cluster>,
    /// The cones of each cluster's faces.
    cones: Vec<Cones>,
    /// Faces of each cluster that are known to be linear; empty if `linear_unless_mixed`.
    linear: Vec<Linear>,
    /// One for each surface.
    strengths: Vec<Strength>,
    /// The kernel of the frame that is drawn.
    kernel: Option<Kernel>,
    allowed: f32,
    longest_edge: f32,
    most_shortening: f32,
    most_spread: f32,
    /// A quarter of ρ − 1, at most, of any triangle that no plane clips.
    bend: f32,
    /// True if there are more suns than a vertex has bits for; and if there is one.
    many_suns: bool,
    one_sun: bool,
    /// True if there are suns alone, no more than that, and no highlight.
    simple: bool,
    /// Then, whether linear shades keep within wherever all corners see the same suns and none is clamped.
    linear_unless_mixed: bool,
    /// True if linear shades, as in `linear_unless_mixed`, keep within where they are clamped, too.
    linear_unless_mixed_or_clamped: bool,
    /// True if that is so and there are only one sun and one surface: vertices then need no marks.
    by_cones: bool,
    /// Rest of what is allowed, for the clamp.
    left_for_clamp: f32,
    /// The max spread of normals up to which a face's linear shades keep within everywhere; below 0 if there is none.
    harmless_spread: f32,
    /// Lights and materials that the bodies' errors are known for.
    suns: Vec<Beam>,
    known_lamps: Vec<LampBeam>,
    answers: Vec<Reflectance>,
    in_color: bool,
    /// True if no light and no material takes light away.
    adds: bool,
    /// Greatest turn of the direction to the eye along an edge of 1.
    eye_turn: f32,
    /// Chords between the eye and the mirrored light that is nearest to it, one for each vertex, if there are
    /// highlights: no more than the angle.
    chords: Vec<f32>,
    /// Greatest turn of the direction to any lamp along an edge of 1.
    lamp_turn: f32,
    /// Lamps: 1 / range and the intensity, that of the brightest channel; and the place from each vertex.
    lamps: Vec<(f32, f32)>,
    to_lamps: Vec<Towards>,
}

impl Budget {
    /// Kernel that light is worked out by.
    pub(super) fn kernel(&self) -> Kernel {
        self.kernel.unwrap_or(Kernel::PORTABLE)
    }

    /// Takes on an object, or the same as it is now.
    #[inline(never)]
    pub(super) fn renew(&mut self, allowed: f32, object: &Lit<'_>, decided: &mut Decided) {
        let Lit { geometry, whole, view, nearest, lights, paints, channels, kernel } = *object;
        self.kernel = Some(kernel);
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
            self.cones.clear();
            let chunks = geometry.triangles.chunks(sift::MOST);
            self.cones.extend(chunks.map(|triangles| Cones::new(triangles, geometry.normals)));
            self.clusters.clear();
            let chunks = self.facets.chunks(sift::MOST).zip(geometry.triangles.chunks(sift::MOST));
            let chunks = chunks.zip(geometry.triangle_surfaces.chunks(sift::MOST));
            self.clusters.extend(chunks.map(|((facets, triangles), surfaces)| {
                Cluster::new(facets, triangles, surfaces, geometry.positions, geometry.normals)
            }));
        }
        same &= known && decided.triangles() == geometry.triangles.len();
        if same {
            decided.no_choices();
        } else {
            decided.nothing_of(geometry.triangles.len());
        }
        self.adds = adds(lights, paints);
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
                faint_from: QUARTERS.map(|quarters| faint_from(ks * all, s, quarters * allowed / 4.0)),
            }
        }));
        self.many_suns = lights.suns.len() > LIGHTS;
        self.one_sun = lights.suns.len() == 1;
        self.simple = lights.lamps.is_empty()
            && !channels
            && !self.many_suns
            && self.strengths.iter().all(|of| of.curvature == 0.0);
        // How far linear shades are off at most, but where some corners see a sun and others not, or some are clamped.
        let keeps_within = |of: &Strength, model: f32| {
            let top = f32::from(of.last - of.first) * of.scale;
            let range = (of.body * self.most_spread).min(top);
            model + range * self.bend + LINEAR <= self.allowed
        };
        self.linear_unless_mixed = self.simple
            && self.strengths.iter().all(|of| keeps_within(of, of.top(of.last, self.adds) * self.most_shortening));
        let lost = |of: &Strength| {
            // One step more, as the shade without light is rounded.
            let brightest = f32::from(of.dark - of.first + 1) * of.scale + of.body;
            (brightest - f32::from(of.last - of.first) * of.scale).max(0.0)
        };
        self.linear_unless_mixed_or_clamped = self.linear_unless_mixed
            && self.adds
            && self.strengths.iter().all(|of| {
                let top = f32::from(of.last - of.first) * of.scale;
                keeps_within(of, top * self.most_shortening + lost(of))
            });
        self.by_cones = self.linear_unless_mixed_or_clamped && self.by_shades();
        // And there, too. Of a sun that not all corners see, normals put the brightest P in the light and another
        // a − P in the dark at most; so linear shades are off by P(a − P)/a, and bent by that share of P: together no more
        // than a(1 + bend)²/4. Of one that all see they are bent by that share of a, which is less. (What they lose for
        // want of length makes them darker, and not more than above.)
        let left = |of: &Strength| self.allowed - LINEAR - lost(of);
        self.left_for_clamp = self.strengths.iter().map(left).fold(f32::INFINITY, f32::min);
        let mixed = (1.0 + self.bend) * (1.0 + self.bend) / 4.0;
        let body = self.strengths.iter().map(|of| of.body).fold(0.0, f32::max);
        let harmless = match self.left_for_clamp {
            left if left < 0.0 => -1.0,
            _ if body == 0.0 => f32::INFINITY,
            left => left / (body * mixed),
        };
        self.harmless_spread = if self.linear_unless_mixed_or_clamped { harmless } else { -1.0 };
        self.linear.clear();
        if !self.linear_unless_mixed {
            self.linear.extend(self.clusters.iter().map(|of| of.linear(object, &self.strengths, (allowed, self.adds))));
        }
        if !same {
            self.lamps.clear();
            self.lamps.extend(lights.lamps.iter().map(|lamp| {
                let inverse_range = libm::sqrt(lamp.inverse_square) as f32;
                (inverse_range, brightest(lamp.intensity, lamp.channels, channels))
            }));
            self.to_lamps.clear();
        }
        // Where any face has to be looked at, what its corners see has to be known.
        if self.to_lamps.is_empty() && self.linear.iter().any(|linear| *linear != Linear::All) {
            self.to_lamps.extend(lights.lamps.iter().flat_map(|lamp| {
                let at = narrow(lamp.position);
                geometry.positions.iter().map(move |position| Towards::new(at - *position))
            }));
        }
        self.eye_turn = 0.0;
        if self.strengths.iter().any(|of| of.curvature != 0.0) {
            self.find_chords(object);
        }
    }

    /// Bounds a highlight on a face, if that is no more than three quarters of what is allowed: it is so far from each
    /// corner, and from the nearest no point is farther than the shares that are in `light`.
    #[inline]
    fn faint_highlight(&self, indices: [u32; 3], facet: &Facet, strength: &Strength) -> Option<f32> {
        let [a, b, c] = indices.map(|i| self.chords[i as usize]);
        let turn =
            2.0 * light::APART_ANGLE * facet.spread + light::APART_TURN * facet.edge * (self.eye_turn + self.lamp_turn);
        // Where that is more it says nothing.
        if facet.edge * self.eye_turn.max(self.lamp_turn) >= 0.5 || facet.spread >= 1.5 {
            return None;
        }
        let nearest = a.min(b).min(c) - turn;
        let faint = strength.faint_from.iter().zip(QUARTERS).find(|(from, _)| nearest >= **from);
        faint.map(|(_, quarters)| quarters * self.allowed / 4.0)
    }

    /// Marks the object's vertices with the lights that they see, and whether their shades are clamped on either side: what
    /// clusters ask of them. `extras` has the shades of three channels.
    #[inline(never)]
    pub(super) fn mark(&self, object: &Lit<'_>, lit: &mut ShadedVertices, extras: &[VertexAttributes]) {
        let Lit { geometry, .. } = *object;
        if self.is_linear_throughout() || self.by_cones {
            return;
        }
        lit.flags.resize(geometry.normals.len(), 0);
        match self.strengths.as_slice() {
            [one] if self.by_shades() => {
                for (flags, [front, back]) in lit.flags.iter_mut().zip(&lit.shades) {
                    let below = !self.adds && front.min(back).to_bits() <= one.first;
                    let clamped = front.max(back).to_bits() >= one.last || below;
                    *flags = u8::from(front.to_bits() != one.dark) | u8::from(clamped) << LIGHTS;
                }
                return;
            }
            of_all => {
                for (i, (flags, surface)) in lit.flags.iter_mut().zip(geometry.vertex_surfaces).enumerate() {
                    let [front, back] = lit.shades[i];
                    let (mut least, mut most) = (front.min(back), front.max(back));
                    if self.in_color
                        && let Some(extra) = extras.get(i)
                    {
                        for channel in extra.front.channels.into_iter().chain(extra.back_channels) {
                            (least, most) = (least.min(channel), most.max(channel));
                        }
                    }
                    let of = &of_all[usize::from(*surface)];
                    let below = !self.adds && least.to_bits() <= of.first;
                    *flags = u8::from(most.to_bits() >= of.last || below) << LIGHTS;
                }
            }
        }
        corners::mark(object, &mut lit.flags);
    }

    /// Faces of a cluster that are known to be linear.
    #[inline]
    pub(super) fn of_cluster(&self, cluster: usize) -> Linear {
        if self.is_linear_throughout() {
            Linear::All
        } else if self.linear_unless_mixed {
            Linear::Where(Where { unmixed: true, from: 0.0 })
        } else {
            self.linear.get(cluster).copied().unwrap_or(Linear::Unknown)
        }
    }

    /// Returns whether all of its faces are linear.
    fn is_linear_throughout(&self) -> bool {
        self.most_spread <= self.harmless_spread
    }

    /// Returns whether a face of a cluster is one of these.
    #[inline]
    fn is_one_of(&self, these: &Where, indices: [u32; 3], lit: &ShadedVertices) -> bool {
        let Where { unmixed, from } = *these;
        let corners = indices.map(|i| i as usize);
        let [a, b, c] = corners.map(|i| lit.flags[i]);
        let same = !unmixed || (a == b && b == c);
        let clamped = (a | b | c) >> LIGHTS != 0;
        same && !clamped && (from == 0.0 || corners.into_iter().all(|i| self.chords[i] >= from))
    }

    /// Returns whether there are suns alone and no highlight, so that `decide_at_once` may say something.
    #[inline]
    pub(in crate::render) fn is_simple(&self) -> bool {
        self.simple
    }

    /// Returns whether a vertex says by its shades which sun it sees: there is one sun, and no other light. Only light
    /// that is less than a step of its shades goes unnoticed.
    #[inline]
    fn by_shades(&self) -> bool {
        self.simple && self.one_sun && self.strengths.len() == 1
    }

    /// Finds the faces of a chunk that see the sun from all of their corners, or from none, as far as their cones say.
    #[inline]
    fn unmixed_by_cones(&self, chunk: usize) -> u64 {
        let all = self.suns.iter().map(|sun| self.cones[chunk].unmixed(sun.towards));
        all.fold(!0, |all, of| all & of)
    }

    /// The lights that a vertex sees, a bit for each, suns first.
    #[inline]
    fn lights_seen(&self, lit: &ShadedVertices, vertex: u32) -> u8 {
        if let ([one], true) = (self.strengths.as_slice(), self.by_cones) {
            return u8::from(lit.shades[vertex as usize][0].to_bits() != one.dark);
        }
        lit.flags.get(vertex as usize).copied().unwrap_or(0) & !(1 << LIGHTS)
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        self.facets.capacity() * size_of::<Facet>()
            + self.clusters.capacity() * size_of::<Cluster>()
            + self.cones.capacity() * size_of::<Cones>()
            + self.linear.capacity() * size_of::<Linear>()
            + self.chords.capacity() * size_of::<f32>()
            + self.lamps.capacity() * size_of::<(f32, f32)>()
            + self.to_lamps.capacity() * size_of::<Towards>()
            + self.strengths.capacity() * size_of::<Strength>()
            + self.suns.capacity() * size_of::<Beam>()
            + self.known_lamps.capacity() * size_of::<LampBeam>()
            + self.answers.capacity() * size_of::<Reflectance>()
    }
}

/// The greatest second derivative of cosˢ by its angle. Below s = 1 there is none: it is steep where it ends.
fn curve(shininess: f32) -> f32 {
    if shininess >= 1.0 { shininess } else { f32::INFINITY }
}

/// Angle from which on `strength`·cosˢ is not more than `limit`: xˢ ≤ exp(−s(1 − x)).
fn faint_from(strength: f32, shininess: f32, limit: f32) -> f32 {
    if strength <= limit {
        return 0.0;
    }
    let cosine = 1.0 - libm::logf(strength / limit) / shininess;
    if cosine > -1.0 { libm::acosf(cosine) } else { f32::INFINITY }
}

/// Returns whether no light and no material takes light away.
fn adds(lights: &Lights<'_>, paints: &[SurfaceMaterial]) -> bool {
    let is_light = |intensity: f32, channels: [f32; 3]| intensity >= 0.0 && channels.iter().all(|c| *c >= 0.0);
    lights.suns.iter().all(|sun| is_light(sun.intensity, sun.channels))
        && lights.lamps.iter().all(|lamp| is_light(lamp.intensity, lamp.channels))
        && paints.iter().all(|SurfaceMaterial { answer: of, .. }| {
            let shares = [of.diffuse, of.specular].into_iter().chain(of.color).chain(of.highlight);
            shares.into_iter().all(|share| share >= 0.0)
        })
}

/// A light's greatest channel, or its one.
fn brightest(intensity: f32, channels: [f32; 3], in_color: bool) -> f32 {
    if in_color { channels.into_iter().fold(0.0, |most, c| most.max(c.abs())) } else { intensity.abs() }
}

/// A light's intensity on each channel, as much of it as a body gives back; of one channel the first.
fn parts(answer: &Reflectance, intensity: f32, channels: [f32; 3], in_color: bool) -> [f32; 3] {
    if !in_color {
        return [intensity.abs(), 0.0, 0.0];
    }
    let mut parts = [0.0; 3];
    for ((part, channel), color) in parts.iter_mut().zip(channels).zip(answer.color) {
        *part = channel.abs() * color.abs() as f32;
    }
    parts
}

/// The highlight's strength in shades, and its exponent.
fn highlight(paint: &SurfaceMaterial, in_color: bool) -> (f32, f32) {
    let color = if in_color { paint.answer.highlight.into_iter().fold(0.0, f64::max) } else { 1.0 };
    ((paint.answer.specular * color).abs() as f32 * 255.0, paint.answer.shininess as f32)
}
