//! The sum of all light at a point, in object space.

use glam::Vec3;

use super::power::Shininess;
use super::source::Cone;
use crate::lanes::three;
use crate::mesh::Bounds;
use crate::mesh::wide::{Wide, dot, sub, widen};

/// A sun transformed into object space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct SunBeam {
    /// The unit direction towards the light.
    pub(crate) towards: Vec3,
    /// The intensity on one channel.
    pub(crate) intensity: f32,
    /// The intensities on three channels.
    pub(crate) channels: [f32; 3],
}

/// A lamp transformed into object space and its units.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct LampBeam {
    pub(crate) position: Wide,
    pub(crate) intensity: f32,
    pub(crate) channels: [f32; 3],
    /// 1 / range².
    pub(crate) inverse_square: f64,
    pub(crate) cone: Option<ConeBeam>,
}

/// The cone of a spot light in object space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ConeBeam {
    /// The unit direction along the cone's axis, back to the light.
    pub(crate) back: Wide,
    /// The cosine of the inner angle.
    pub(crate) inner: f64,
    /// 1 / (cosine of the inner angle − cosine of the outer).
    pub(crate) inverse_width: f64,
}

/// The minimum difference between a cone's two cosines.
const LEAST_WIDTH: f64 = 1.0 / 65_536.0;

impl ConeBeam {
    /// Makes a cone from its direction in object space, of any length; `None` if the direction is zero.
    pub(crate) fn new(cone: &Cone, direction: Wide) -> Option<Self> {
        let inner = libm::cos(cone.inner.to_radians());
        let width = inner - libm::cos(cone.outer.to_radians());
        Some(Self { back: unit(three(direction, |c| -c))?, inner, inverse_width: 1.0 / width.max(LEAST_WIDTH) })
    }

    /// The share of the light that reaches a point, given the unit direction from there to the light.
    #[inline]
    pub(crate) fn share(&self, towards: Wide) -> f64 {
        let x = positive(1.0 - positive((self.inner - dot(self.back, towards)) * self.inverse_width));
        x * x * (3.0 - 2.0 * x)
    }
}

/// Returns the number if it is above 0, and otherwise 0, including for NaN.
fn positive(number: f64) -> f64 {
    if number > 0.0 { number } else { 0.0 }
}

/// Returns whether a lamp reaches anything within `bounds`.
pub(crate) fn lamp_reaches(lamp: &LampBeam, bounds: Bounds) -> bool {
    let (min, max) = (widen(bounds.min), widen(bounds.max));
    // From the lamp to the nearest point of the box.
    let apart: Wide = core::array::from_fn(|i| (min[i] - lamp.position[i]).max(lamp.position[i] - max[i]).max(0.0));
    dot(apart, apart) * lamp.inverse_square < 1.0
}

/// All light that reaches an object.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lights<'a> {
    pub(crate) suns: &'a [SunBeam],
    pub(crate) lamps: &'a [LampBeam],
    /// The eye's position in object space.
    pub(crate) eye: Wide,
}

/// A material's response to light, in f64.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Reflectance {
    /// ka·Ia.
    pub(crate) ambient: f64,
    pub(crate) diffuse: f64,
    /// 0 if the material has no highlight.
    pub(crate) specular: f64,
    /// Above 0 if there is a highlight.
    pub(crate) shininess: f64,
    /// The factors of ambient and diffuse light, on three channels.
    pub(crate) color: Wide,
    /// The factors of the highlight, on three channels.
    pub(crate) highlight: Wide,
}

impl Reflectance {
    /// Returns whether it has highlights. A build that leaves them out (`plan::Effect::is_left_out`) has none.
    #[inline(always)]
    pub(super) fn shines(&self) -> bool {
        !cfg!(mode13h_leave_out = "specular") && self.specular != 0.0
    }
}

/// ka·Ia + kd·Σ Id·max(0, n·l), not yet clamped, for the side of the surface that the unit `normal` points out of, and
/// for the other side: only suns, on one channel, for a matt material.
///
/// The sum is taken in f64, in the order of the lights. There, even a thousand lights of `f32::MAX`, of either sign,
/// have a finite sum.
#[inline]
pub(crate) fn both_sides(ambient: f64, diffuse: f64, suns: &[SunBeam], normal: Vec3) -> (f64, f64) {
    let (mut front, mut back) = (0.0, 0.0);
    for sun in suns {
        let cosine = normal.dot(sun.towards);
        // −0.0 and NaN light neither side.
        if cosine > 0.0 {
            front += f64::from(sun.intensity) * f64::from(cosine);
        } else if cosine < 0.0 {
            back -= f64::from(sun.intensity) * f64::from(cosine);
        }
    }
    (ambient + diffuse * front, ambient + diffuse * back)
}

/// The sums of one side of a surface, for each channel.
#[derive(Clone, Copy)]
struct Side<const N: usize> {
    diffuse: [f64; N],
    specular: [f64; N],
}

impl<const N: usize> Side<N> {
    const DARK: Self = Self { diffuse: [0.0; N], specular: [0.0; N] };

    fn add(&mut self, light: [f64; N], cosine: f64, highlight: f64) {
        for (i, intensity) in light.iter().enumerate() {
            self.diffuse[i] += intensity * cosine;
            self.specular[i] += intensity * highlight;
        }
    }

    /// The ambient and diffuse light that the surface reflects, and its highlight.
    fn reflected(&self, reflectance: &Reflectance) -> ([f64; N], [f64; N]) {
        let (mut body, mut highlight) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            body[i] = reflectance.ambient + reflectance.diffuse * self.diffuse[i];
            highlight[i] = reflectance.specular * self.specular[i];
        }
        (body, highlight)
    }
}

impl Lights<'_> {
    /// Sums all light on one channel, not yet clamped, for the side that the unit `normal` points
    /// out of and for the other: first the suns, then the lamps, each in their order. Without lamps
    /// and highlights, the results are those of [`both_sides`].
    #[inline(never)]
    pub(crate) fn one_channel(&self, reflectance: &Reflectance, position: Vec3, normal: Vec3) -> (f64, f64) {
        let of_sun = |sun: &SunBeam| [f64::from(sun.intensity)];
        let of_lamp = |lamp: &LampBeam| [f64::from(lamp.intensity)];
        let [front, back] = self.sum(reflectance, position, normal, of_sun, of_lamp);
        let of_side = |side: Side<1>| {
            let ([body], [highlight]) = side.reflected(reflectance);
            body + highlight
        };
        (of_side(front), of_side(back))
    }

    /// Sums all light on three channels: red, green, blue. Otherwise like [`one_channel`](Self::one_channel).
    #[inline(never)]
    pub(crate) fn three_channels(&self, reflectance: &Reflectance, position: Vec3, normal: Vec3) -> (Wide, Wide) {
        let of_sun = |sun: &SunBeam| three(sun.channels, f64::from);
        let of_lamp = |lamp: &LampBeam| three(lamp.channels, f64::from);
        let [front, back] = self.sum(reflectance, position, normal, of_sun, of_lamp);
        let of_side = |side: Side<3>| {
            let (body, highlight) = side.reflected(reflectance);
            three([0, 1, 2], |i| body[i] * reflectance.color[i] + highlight[i] * reflectance.highlight[i])
        };
        (of_side(front), of_side(back))
    }

    /// Sums the light that falls on the front and on the back.
    #[inline]
    fn sum<const N: usize>(
        &self,
        reflectance: &Reflectance,
        position: Vec3,
        normal: Vec3,
        of_sun: impl Fn(&SunBeam) -> [f64; N],
        of_lamp: impl Fn(&LampBeam) -> [f64; N],
    ) -> [Side<N>; 2] {
        if reflectance.shines() {
            self.sum_by::<N, true>(reflectance, position, normal, of_sun, of_lamp)
        } else {
            self.sum_by::<N, false>(reflectance, position, normal, of_sun, of_lamp)
        }
    }

    /// Sums the light. Without highlights (`SHINES`), the eye is not used, and nothing is specular.
    #[inline]
    fn sum_by<const N: usize, const SHINES: bool>(
        &self,
        reflectance: &Reflectance,
        position: Vec3,
        normal: Vec3,
        of_sun: impl Fn(&SunBeam) -> [f64; N],
        of_lamp: impl Fn(&LampBeam) -> [f64; N],
    ) -> [Side<N>; 2] {
        let (mut front, mut back) = (Side::DARK, Side::DARK);
        let at = widen(position);
        let wide_normal = widen(normal);
        // A build that leaves them out (`plan::Effect::is_left_out`) has no lamps.
        let lamps = if cfg!(mode13h_leave_out = "positional-lights") { &[] } else { self.lamps };
        let to_eye = SHINES.then(|| unit(sub(self.eye, at))).flatten();
        let shininess = Shininess::new(reflectance.shininess);
        for sun in self.suns {
            let cosine = f64::from(normal.dot(sun.towards));
            let highlight = highlight(to_eye, wide_normal, widen(sun.towards), cosine, shininess);
            if cosine > 0.0 {
                front.add(of_sun(sun), cosine, highlight);
            } else if cosine < 0.0 {
                back.add(of_sun(sun), -cosine, highlight);
            }
        }
        for lamp in lamps {
            let to_lamp = sub(lamp.position, at);
            let square = dot(to_lamp, to_lamp) * lamp.inverse_square;
            // Out of range, or NaN because the lamp is too far away to be squared.
            if square >= 1.0 || square.is_nan() {
                continue;
            }
            // A lamp at the point itself lies in the plane of any face through that point, so it lights none of them.
            let Some(towards) = unit(to_lamp) else { continue };
            let cosine = dot(wide_normal, towards);
            let highlight = highlight(to_eye, wide_normal, towards, cosine, shininess);
            let mut fall_off = (1.0 - square) * (1.0 - square);
            if let Some(cone) = &lamp.cone {
                fall_off *= cone.share(towards);
            }
            let mut light = of_lamp(lamp);
            light.iter_mut().for_each(|intensity| *intensity *= fall_off);
            if cosine > 0.0 {
                front.add(light, cosine, highlight);
            } else if cosine < 0.0 {
                back.add(light, -cosine, highlight);
            }
        }
        [front, back]
    }
}

/// max(0, r·v)^s, where r is the light's direction mirrored at the surface; 0 if no highlight is requested.
///
/// The normal enters twice, so both sides of a surface give the same result.
#[inline]
fn highlight(to_eye: Option<Wide>, normal: Wide, towards: Wide, cosine: f64, shininess: Shininess) -> f64 {
    let Some(to_eye) = to_eye else { return 0.0 };
    let along = 2.0 * cosine * dot(normal, to_eye) - dot(towards, to_eye);
    shininess.of(along)
}

/// `None` for the zero vector.
fn unit(v: Wide) -> Option<Wide> {
    let length = libm::sqrt(dot(v, v));
    let part = 1.0 / length;
    (length > 0.0).then(|| three(v, |c| c * part))
}
