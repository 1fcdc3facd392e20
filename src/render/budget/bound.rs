//! Bounds how far linear shades are from the model's light on a patch of a surface.
//! `docs/budget.md` has the proofs; its lemmas are named where they are used.
//!
//! A patch is a face, or a set of faces whose figures never exceed the patch's. Eight patches are
//! bounded at a time, in plain arrays that the compiler vectorises.

use super::ranges::{HUGE, Patches, Sight, greater, lesser, square_root};
use crate::lanes::{LANES, Lanes, each};
use crate::light::{ConeBeam, Lights, Reflectance};
use crate::simd::compiled_for_each_level;
use crate::span::Kernel;

/// The greatest turn of a direction, in radians: larger turns are clamped to it.
const GREATEST_TURN: f32 = 1e4;

/// Length of the second derivative of a unit vector, relative to its turn squared: 2/√3 (Lemma 5).
const BEND: f32 = 1.154_701;

/// A bound on the error of f32 arithmetic, relative to a light's strength, in the bound and in the cosines that it is
/// computed from.
const ROUNDING: f32 = 2e-5;

/// The spread from which the normals of a face may cancel.
const CANCELS: f32 = 0.99;

/// Figures of eight patches that do not depend on the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shapes {
    /// The radius of the corners' normals (Lemma 1); no face of the patch has a larger one.
    pub(super) spread: Lanes<f32>,
    /// Radius of the corners' positions.
    pub(super) edge: Lanes<f32>,
    /// Size of the parts into which the faces are divided, as a fraction of the face; `None` for whole faces, whose
    /// corners have unit normals.
    pub(super) part: Option<Lanes<f32>>,
    /// How far perspective shifts a shade, relative to its range.
    pub(super) bend: Lanes<f32>,
}

/// Signed strengths of one light on one surface, per channel.
#[derive(Clone, Copy, Debug)]
struct Strength {
    body: [f32; 3],
    highlight: [f32; 3],
}

/// Light on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Incident<'a> {
    pub(super) lights: Lights<'a>,
    pub(super) reflectance: &'a Reflectance,
    /// The greatest coordinate of the object's vertices.
    pub(super) extent: f32,
    /// True if red, green and blue are lit separately.
    pub(super) in_color: bool,
    /// True if light continues below the horizon, as negative light.
    pub(super) below: bool,
}

/// Bounds of a patch, as fractions of full intensity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// How far shades that are linear on the screen are from the model's light.
    pub(super) on_screen: Lanes<f32>,
    /// How far shades that are linear on the face are from the model's light.
    pub(super) on_face: Lanes<f32>,
}

/// Constants of Lemma 8 for a highlight's power.
#[derive(Clone, Copy, Debug)]
struct Lobe {
    shininess: f32,
    /// 1 − 1/s and 1 − 2/s.
    slow: f32,
    fast: f32,
    /// Where (2y − 1)·e^(−fast·y) is greatest, and its value there.
    peak_at: f32,
    peak: f32,
    /// Where √(2y/s)·e^(−slow·y) is greatest, and its value there.
    steepest_at: f32,
    steepest: f32,
}

impl Lobe {
    fn new(shininess: f64) -> Self {
        let s = shininess as f32;
        let (slow, fast) = (1.0 - 1.0 / s, 1.0 - 2.0 / s);
        let (peak_at, peak) =
            if fast > 0.01 { (1.0 / fast + 0.5, 2.0 / fast * libm::expf(-1.0 - fast / 2.0)) } else { (HUGE, HUGE) };
        let peak = peak.min((s - 1.0).max(0.0));
        let steepest_at = if slow > 0.0 { 0.5 / slow } else { HUGE };
        let steepest = if s > 1.0 { (0.606_54 / libm::sqrtf(s - 1.0)).min(1.0) } else { 1.0 };
        Self { shininess: s, slow, fast, peak_at, peak, steepest_at, steepest }
    }
}

/// One light's fall-off on a patch with distance or with the angle to a cone's axis, along the patch's radius.
#[derive(Clone, Copy, Debug)]
struct FallOff {
    most: f32,
    least: f32,
    /// Greatest first and second derivatives.
    first: f32,
    second: f32,
    /// Turn of the direction.
    turn: f32,
}

impl FallOff {
    const NONE: Self = Self { most: 1.0, least: 1.0, first: 0.0, second: 0.0, turn: 0.0 };

    /// Lemma 6, from the nearest and farthest distances.
    #[inline(always)]
    fn new(near: f32, far: f32, edge: f32, inverse_range: f32) -> Self {
        let (d0, d1) = (near * inverse_range, lesser(far * inverse_range, 1.0));
        let (left, least) = (greater(1.0 - d0 * d0, 0.0), greater(1.0 - d1 * d1, 0.0));
        let reaches = if d0 < 1.0 { 1.0 } else { 0.0 };
        let e = edge * inverse_range * reaches;
        const STEEPEST: f32 = 0.577_350_3;
        let at = greater(lesser(STEEPEST, d1), d0);
        let steepest = greater(at * (1.0 - at * at), 0.0) * (1.0 + ROUNDING);
        let turn = edge / near;
        Self {
            most: left * left,
            least: if far * inverse_range < 1.0 { least * least } else { 0.0 },
            first: lesser(4.0 * steepest * e, HUGE),
            second: lesser(greater(4.0 * left, 12.0 * d1 * d1 - 4.0) * e * e, HUGE),
            turn: lesser(turn, GREATEST_TURN),
        }
    }

    /// A spot light's share by Lemma 12, from the cosine's range at the corners and the turn of the direction.
    #[inline(always)]
    fn of_cone(cone: &ConeBeam, (most, least): (f32, f32), turn: f32) -> Self {
        let (inner, inverse_width) = (cone.inner as f32, cone.inverse_width as f32);
        let curved = 0.5 * BEND * turn * turn;
        let (most, least) = (lesser(most + curved, 1.0), greater(least - curved, -1.0));
        let x = |cosine: f32| lesser(greater(1.0 - (inner - cosine) * inverse_width, 0.0), 1.0);
        let (high, low) = (x(most), x(least));
        let share = |x: f32| x * x * (3.0 - 2.0 * x);
        // The range's x nearest the steepest point, and its farther end, where the curve bends
        // most.
        let steepest = greater(lesser(0.5, high), low);
        let is_edge = if low < 1.0 && high > 0.0 { 1.0 } else { 0.0 };
        let slope = is_edge * 6.0 * steepest * (1.0 - steepest) * inverse_width;
        let bend =
            is_edge * greater((6.0 - 12.0 * low).abs(), (6.0 - 12.0 * high).abs()) * inverse_width * inverse_width;
        // At the cone's edge, the cosine is no less than the outer one.
        let cosine = greater(greater(least, inner - 1.0 / inverse_width), 0.0);
        let sine = square_root(greater(1.0 - cosine * cosine, 0.0) + ROUNDING);
        let second = lesser((bend * sine * sine + slope * BEND) * turn * turn, HUGE);
        Self { most: share(high), least: share(low), first: lesser(slope * sine * turn, HUGE), second, turn }
    }

    /// The fall-off times a spot light's share.
    #[inline(always)]
    fn times(self, share: Self) -> Self {
        Self {
            most: self.most * share.most,
            least: self.least * share.least,
            first: lesser(self.first * share.most + self.most * share.first, HUGE),
            second: lesser(self.second * share.most + 2.0 * self.first * share.first + self.most * share.second, HUGE),
            turn: self.turn,
        }
    }
}

/// One term of the light on a patch, relative to its strength.
#[derive(Clone, Copy, Debug)]
struct Term {
    /// Error of linear shades.
    error: f32,
    /// How much the term varies over one face, or a part of it.
    range: f32,
    most: f32,
    least: f32,
}

/// Normals of a patch: radius, deficit 1/|N| − 1, and the part.
#[derive(Clone, Copy)]
struct Normals {
    spread: f32,
    deficit: f32,
    part: f32,
}

/// A light's diffuse term by Lemmas 2, 3 and 7, from the range of n·w at the corners, where w is
/// the direction times the fall-off.
#[inline(always)]
fn body(n: Normals, (most, least): (f32, f32), fall: FallOff, whole: bool, below: bool) -> Term {
    let Normals { spread, deficit, part } = n;
    let turned = spread * (1.0 + deficit);
    let w1 = fall.first + fall.most * fall.turn;
    let w2 = fall.second + 2.0 * fall.first * fall.turn + BEND * fall.most * fall.turn * fall.turn;
    let curved = spread * w1 + 0.5 * w2;
    let (above, under) = (greater(most + curved, 0.0), greater(curved - least, 0.0));
    let highest = lesser(above * (1.0 + deficit), fall.most);
    let lowest = if below { -lesser(under * (1.0 + deficit), fall.most) } else { greater(least - curved, 0.0) };
    let differs = lesser(2.0 * part * (turned * fall.most + w1), highest - lowest);
    let error = if whole {
        let (lit, dark) = (greater(most, 0.0), greater(-least, 0.0));
        let kink = lesser(lit * dark / (lit + dark), 0.5 * (spread * fall.most + w1));
        let kink = if lit * dark > 0.0 { kink } else { 0.0 };
        curved + greater(deficit * above, kink)
    } else {
        let mixed = !below && above > 0.0 && under > 0.0;
        let kink = if mixed { 0.5 * part * (turned * fall.most + w1) } else { 0.0 };
        part * part * (0.5 * BEND * turned * turned * fall.most + turned * w1 + 0.5 * w2) + kink
    };
    Term { error: lesser(error, differs), range: differs, most: highest, least: lowest }
}

/// A light's highlight by Lemma 8, from the range of r·v at the corners, and that of n·l.
#[inline(always)]
fn highlight(
    n: Normals,
    lobe: &Lobe,
    (along_most, along_least, along_highest): (f32, f32, f32),
    (facing_most, facing_least): (f32, f32),
    fall: FallOff,
    eye_turn: f32,
) -> Term {
    let Normals { spread, deficit, part } = n;
    let s = lobe.shininess;
    let turned = spread * (1.0 + deficit);
    let turn = 2.0 * turned + fall.turn + eye_turn;
    let aside = turned * turned * (2.0 + lesser(8.0 * spread, 1.237))
        + 4.0 * turned * fall.turn
        + fall.turn * fall.turn
        + eye_turn * eye_turn;
    let curved = 0.5 * (turn * turn + aside);
    let (highest, lowest) = (lesser(along_most + curved, along_highest), greater(along_least - curved, -1.0));
    let y = s * greater(1.0 - highest, 0.0);
    let seen = if highest > 0.0 { 1.0 } else { 0.0 };
    let bright = seen * falling(y);
    let (slope, bend) = if s >= 2.0 {
        let slowly = falling(lobe.slow * y);
        let slope = if y > lobe.steepest_at { slowly * square_root(2.0 * y / s) } else { lobe.steepest };
        let slope = lesser(slope, lobe.steepest);
        let beyond = if y > lobe.peak_at { falling(lobe.fast * y) * (2.0 * y - 1.0) } else { lobe.peak };
        let across = greater(slowly, lesser(beyond, lobe.peak));
        (seen * s * slope, seen * s * (turn * turn * across + aside * slope))
    } else {
        // s·c^(s − 1) and s(s − 1)·c^(s − 2) are bounded only away from c = 0, where the power may be a step.
        let inverse = 1.0 / lowest;
        let power = if s >= 1.0 { inverse } else { inverse * inverse };
        (s * power, s * (1.0 + (s - 1.0).abs()) * (turn * turn + aside) * power)
    };
    let is_smooth = s >= 2.0 || lowest > 0.05;
    // The light's horizon, where the highlight starts abruptly.
    let horizon = spread * fall.turn + 0.5 * BEND * fall.turn * fall.turn;
    let (is_lit, is_dark) = (facing_least - horizon > 0.0, facing_most + horizon <= 0.0);
    let most = if is_dark { 0.0 } else { fall.most * bright };
    let power = greater(if s >= 1.0 { 1.0 - s * (1.0 - lowest) } else { lowest }, 0.0);
    let least = if is_lit { lesser(fall.least * power, most) } else { 0.0 };
    let steep = 2.0 * part * (fall.most * slope * turn + fall.first * bright);
    let error = 0.5 * part * part * (fall.second * bright + 2.0 * fall.first * slope * turn + fall.most * bend);
    let (steep, error) = if is_lit && is_smooth { (steep, error) } else { (HUGE, HUGE) };
    let range = lesser(steep, most - least);
    Term { error: lesser(error, range), range, most, least }
}

/// At least e^−y, for y ≥ 0: e^y is greater than the first terms of its series.
#[inline(always)]
fn falling(y: f32) -> f32 {
    1.0 / (1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y / 120.0)))))
}

/// One term on eight patches: error, range, greatest and least value.
type Terms = [Lanes<f32>; 4];

#[inline(always)]
fn put(terms: &mut Terms, lane: usize, term: Term) {
    let [errors, ranges, most, least] = terms;
    (errors[lane], ranges[lane], most[lane], least[lane]) = (term.error, term.range, term.most, term.least);
}

/// The eye, for highlights: their lobe, the eye as seen from the patches, and how far its direction turns.
struct Eye<D> {
    lobe: Lobe,
    sight: Sight<D>,
    turn: Lanes<f32>,
}

/// Sums of all terms on the patches, for each of the first channels.
struct Sums {
    of: [Terms; 3],
    channels: usize,
    normals: [Normals; LANES],
    whole: bool,
    below: bool,
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, strengths: &[f32; 3], terms: &Terms) {
        // Index loops here and below, as in `light::lanes`.
        let mut channel = 0;
        while channel < self.channels.min(3) {
            let (sums, strength) = (&mut self.of[channel], strengths[channel]);
            let size = strength.abs();
            let (above, below) = (strength.max(0.0), strength.min(0.0));
            for lane in 0..LANES {
                let [error, range, most, least] = [terms[0][lane], terms[1][lane], terms[2][lane], terms[3][lane]];
                sums[0][lane] += size * (error + ROUNDING);
                sums[1][lane] += size * (range + ROUNDING);
                sums[2][lane] += above * most + below * least + size * ROUNDING;
                sums[3][lane] += above * least + below * most - size * ROUNDING;
            }
            channel += 1;
        }
    }

    /// Adds the terms of one light. `weighted` is the range of n·l times its fall-off, if it has one.
    #[inline(always)]
    fn add_light<P: Patches>(
        &mut self,
        patches: &P,
        directions: &P::Directions,
        (weighted, falls): (Option<[Lanes<f32>; 2]>, &[FallOff; LANES]),
        eye: Option<&Eye<P::Directions>>,
        strength: &Strength,
    ) {
        let (normals, whole, below) = (self.normals, self.whole, self.below);
        let facing = patches.facing(directions);
        let [most, least] = weighted.unwrap_or(facing);
        // Loops, because closures would not be inlined eight times.
        let mut bodies = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            put(&mut bodies, lane, body(normals[lane], (most[lane], least[lane]), falls[lane], whole, below));
        }
        self.add(&strength.body, &bodies);
        let Some(Eye { lobe, sight, turn }) = eye else { return };
        let turns = each!(lane => turn[lane] + falls[lane].turn);
        let along = patches.mirrored(directions, &sight.directions, &turns);
        let mut highlights = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            let (along, facing) =
                ((along[0][lane], along[1][lane], along[2][lane]), (facing[0][lane], facing[1][lane]));
            put(&mut highlights, lane, highlight(normals[lane], lobe, along, facing, falls[lane], turn[lane]));
        }
        self.add(&strength.highlight, &highlights);
    }
}

impl Incident<'_> {
    /// Returns whether all strengths together are small enough for finite sums, and positions and inverse ranges small
    /// enough for finite squares, and not so small that these vanish.
    fn is_moderate(&self) -> bool {
        const MODERATE: f32 = 1e6;
        let Lights { suns, lamps, eye } = self.lights;
        let is_near = |at: [f64; 3]| at.iter().all(|c| c.abs() < f64::from(HUGE));
        let lamps_are_near = lamps.iter().all(|lamp| is_near(lamp.position) && lamp.inverse_square < 1e30);
        if !(1.0 / HUGE..HUGE).contains(&self.extent)
            || !lamps_are_near
            || (self.reflectance.specular != 0.0 && !is_near(eye))
        {
            return false;
        }
        let suns = suns.iter().map(|sun| self.strength(sun.intensity, sun.channels));
        let lamps = lamps.iter().map(|lamp| self.strength(lamp.intensity, lamp.channels));
        let size = |of: Strength| of.body.iter().chain(&of.highlight).map(|share| share.abs()).sum::<f32>();
        let colors = self.reflectance.color.map(|color| color.abs() as f32);
        let ambient = self.reflectance.ambient.abs() as f32 * (1.0 + colors.iter().sum::<f32>());
        suns.chain(lamps).map(size).sum::<f32>() + ambient < MODERATE
    }

    /// The number of channels that are lit.
    #[inline(always)]
    fn channels(&self) -> usize {
        if self.in_color { 3 } else { 1 }
    }

    #[inline(always)]
    fn strength(&self, intensity: f32, channels: [f32; 3]) -> Strength {
        let (kd, ks) = (self.reflectance.diffuse as f32, self.reflectance.specular as f32);
        let of = |channel: usize, share: f32, color: [f64; 3]| {
            if self.in_color { share * channels[channel] * color[channel] as f32 } else { share * intensity }
        };
        let mut strength = Strength { body: [0.0; 3], highlight: [0.0; 3] };
        for channel in 0..self.channels() {
            strength.body[channel] = of(channel, kd, self.reflectance.color);
            strength.highlight[channel] = of(channel, ks, self.reflectance.highlight);
        }
        strength
    }
}

compiled_for_each_level! {
    /// Calls [`interpolation_error`] compiled for the kernel's processor; the results are the same.
    #[inline(never)]
    pub(super) fn error_at_best[P: Patches][P](
        kernel: Kernel, patches: &P, shapes: &Shapes, incident: &Incident<'_>,
    ) -> Bounds {
        interpolation_error(patches, shapes, incident)
    }
}

/// Bounds how far linear shades are from the model's light, not counting rounding to bytes, on each of eight patches.
/// If `shapes` gives the size of parts, the bound is for any part of that size, interpolated between light at the
/// part's own corners.
#[inline(always)]
pub(super) fn interpolation_error<P: Patches>(patches: &P, shapes: &Shapes, incident: &Incident<'_>) -> Bounds {
    let Lights { suns, lamps, eye } = incident.lights;
    let narrow = |[x, y, z]: [f64; 3]| [x as f32, y as f32, z as f32];
    // Coordinates in f32 are off by up to 2⁻²⁴ of their magnitude, and their differences by no more than this.
    let blur = |at: [f64; 3]| 5e-7 * at.iter().fold(incident.extent, |most, c| most.max(c.abs() as f32));
    // Values that are too large get no bound; with the others nothing overflows.
    if !incident.is_moderate() {
        return Bounds { on_screen: [HUGE; LANES], on_face: [HUGE; LANES] };
    }
    let (part, whole) = (shapes.part.unwrap_or([1.0; LANES]), shapes.part.is_none());
    let mut normals = [Normals { spread: 0.0, deficit: 0.0, part: 0.0 }; LANES];
    for (lane, normals) in normals.iter_mut().enumerate() {
        let spread = shapes.spread[lane];
        let length = square_root(greater(1.0 - spread * spread, 1e-6));
        let deficit = if spread < CANCELS { (1.0 - length) / length } else { HUGE };
        *normals = Normals { spread, deficit, part: part[lane] };
    }
    let ambient = incident.reflectance.ambient as f32;
    let mut of = [[[0.0; LANES]; 4]; 3];
    for (channel, of) in of.iter_mut().enumerate() {
        let ambient = if incident.in_color { ambient * incident.reflectance.color[channel] as f32 } else { ambient };
        (of[2], of[3]) = ([ambient; LANES], [ambient; LANES]);
    }
    let mut sums = Sums { of, channels: incident.channels(), normals, whole, below: incident.below };
    let eye = if incident.reflectance.specular != 0.0 {
        let sight = patches.point(narrow(eye), blur(eye), &shapes.edge);
        let turn = each!(lane => lesser(shapes.edge[lane] / sight.near[lane], GREATEST_TURN));
        Some(Eye { lobe: Lobe::new(incident.reflectance.shininess), sight, turn })
    } else {
        None
    };
    // One loop for suns and lamps, because whatever it calls takes long to compile.
    for light in 0..suns.len() + lamps.len() {
        let mut falls = [FallOff::NONE; LANES];
        let (directions, weighted, strength) = if let Some(sun) = suns.get(light) {
            (patches.sun(sun.towards.to_array()), None, incident.strength(sun.intensity, sun.channels))
        } else if let Some(lamp) = lamps.get(light - suns.len()) {
            let inverse_range = libm::sqrt(lamp.inverse_square) as f32;
            let sight = patches.point(narrow(lamp.position), blur(lamp.position), &shapes.edge);
            for (lane, fall) in falls.iter_mut().enumerate() {
                *fall = FallOff::new(sight.near[lane], sight.far[lane], shapes.edge[lane], inverse_range);
            }
            let ends = [each!(lane => falls[lane].most), each!(lane => falls[lane].least)];
            let mut weighted = patches.weighted(&sight, &ends, inverse_range);
            if let Some(cone) = &lamp.cone {
                let [most, least] = patches.along(&sight.directions, narrow(cone.back));
                for lane in 0..LANES {
                    let share = FallOff::of_cone(cone, (most[lane], least[lane]), falls[lane].turn);
                    falls[lane] = falls[lane].times(share);
                    let [above, below] = &mut weighted;
                    above[lane] *= if above[lane] > 0.0 { share.most } else { share.least };
                    below[lane] *= if below[lane] > 0.0 { share.least } else { share.most };
                }
            }
            (sight.directions, Some(weighted), incident.strength(lamp.intensity, lamp.channels))
        } else {
            break;
        };
        sums.add_light(patches, &directions, (weighted, &falls), eye.as_ref(), &strength);
    }
    let mut bounds = Bounds { on_screen: [0.0; LANES], on_face: [0.0; LANES] };
    for [errors, ranges, most, least] in &sums.of[..sums.channels.min(3)] {
        for lane in 0..LANES {
            let (error, range, most, least) = (errors[lane], ranges[lane], most[lane], least[lane]);
            // Lemma 4: the effect of clamping at 1 and at 0.
            let cut = lesser(range / 4.0, greater(most - 1.0, 0.0)) + lesser(range / 4.0, greater(-least, 0.0));
            // Both lie between the greatest and the least light.
            let apart =
                if incident.below { HUGE } else { lesser(greater(most, 0.0), 1.0) - greater(lesser(least, 1.0), 0.0) };
            let model = error + cut;
            let bent = model + lesser(shapes.bend[lane] * range, 1.0);
            let (bent, model) = (lesser(bent, apart), lesser(model, apart));
            // NaN counts as the greatest.
            let on_screen = &mut bounds.on_screen[lane];
            *on_screen = if bent <= *on_screen { *on_screen } else { bent };
            let on_face = &mut bounds.on_face[lane];
            *on_face = if model <= *on_face { *on_face } else { model };
        }
    }
    bounds
}
