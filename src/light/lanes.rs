//! The sum of all light at points of a surface, eight at a time.
//!
//! Each point gets the results of [`Lights::one_channel`] and [`Lights::three_channels`]: the operations and their
//! order are the same, and each operation (sum, product, quotient, square root) rounds the same in vectors and in
//! scalars. If a light does not contribute to a point, zero is added, which changes no sum, since none is −0: each
//! starts at +0.
//!
//! Lanes stay in vectors ([`F32Lanes8`]), because the compiler vectorised index loops over arrays only in part: three
//! coloured lamps took a sixth longer.

use super::ConeBeam;
use super::intensity::{Lights, Reflectance};
use super::power::Shininess;
use crate::lanes::{LANES, Lanes, Points};
use crate::mesh::wide::Wide;
use crate::simd::{F32Lanes8, Lanes8, compiled_for_each_level};
use crate::span::Kernel;

type Wides = Lanes<f64>;

/// x, y and z.
type Vectors<L> = [<L as Lanes8>::F64; 3];

/// The light that falls on the points, for each channel.
struct Front<L: Lanes8, const N: usize> {
    diffuse: [L::F64; N],
    specular: [L::F64; N],
}

impl<L: Lanes8, const N: usize> Front<L, N> {
    #[inline(always)]
    fn add(&mut self, l: L, light: [f64; N], fall_off: Option<L::F64>, cosines: L::F64, highlights: Option<L::F64>) {
        let mut channel = 0;
        while channel < N {
            let mut lights = l.splat_f64(light[channel]);
            if let Some(fall_off) = fall_off {
                lights = l.mul(lights, fall_off);
            }
            self.diffuse[channel] = l.add(self.diffuse[channel], l.mul(lights, cosines));
            if let Some(highlights) = highlights {
                self.specular[channel] = l.add(self.specular[channel], l.mul(lights, highlights));
            }
            channel += 1;
        }
    }
}

/// The normals at the points: unchanged if they are `UNIT`, otherwise normalised and rounded to f32; 0 where they
/// vanish because their ends cancel.
#[inline(always)]
fn normals_of<L: F32Lanes8, const UNIT: bool>(l: L, points: &Points) -> [L::F32; 3] {
    let [x, y, z] = [l.load_f32(&points[0]), l.load_f32(&points[1]), l.load_f32(&points[2])];
    if UNIT {
        return [x, y, z];
    }
    let wide = [l.widen(x), l.widen(y), l.widen(z)];
    let lengths = l.sqrt(dot(l, &wide, &wide));
    let parts = l.if_less(lengths, l.splat_f64(f64::INFINITY), l.div(l.splat_f64(1.0), lengths));
    let parts = l.if_less(l.splat_f64(0.0), lengths, parts);
    // Turns −0 into 0, like normalising a single normal.
    let zero = l.splat_f32(0.0);
    [
        l.add_f32(l.narrow(l.mul(wide[0], parts)), zero),
        l.add_f32(l.narrow(l.mul(wide[1], parts)), zero),
        l.add_f32(l.narrow(l.mul(wide[2], parts)), zero),
    ]
}

/// The intensities of a light on one channel, or on red, green and blue.
#[inline(always)]
fn channels<const N: usize>(intensity: f32, colors: [f32; 3]) -> [f64; N] {
    let mut channels = [f64::from(intensity); N];
    if N == 3 {
        let mut i = 0;
        while i < N {
            channels[i] = f64::from(colors[i % 3]);
            i += 1;
        }
    }
    channels
}

impl Lights<'_> {
    /// Sums all light on one channel, not yet clamped, for the side that the points' normals point out of. They may
    /// have any length, unless they are `UNIT` normals, which are used unchanged.
    pub(crate) fn front_of_one_channel<const UNIT: bool>(
        &self,
        reflectance: &Reflectance,
        points: &Points,
        kernel: Kernel,
    ) -> Wides {
        let (level, shines) = (kernel.simd_level(), reflectance.shines());
        let sum = if shines { shiny_one::<UNIT> } else { matt_one::<UNIT> };
        let [lanes] = sum(level, self, reflectance, points);
        lanes
    }

    /// [`front_of_one_channel`](Self::front_of_one_channel) for three channels: red, green, blue.
    pub(crate) fn front_of_three_channels<const UNIT: bool>(
        &self,
        reflectance: &Reflectance,
        points: &Points,
        kernel: Kernel,
    ) -> [Wides; 3] {
        let (level, shines) = (kernel.simd_level(), reflectance.shines());
        let sum = if shines { shiny_three::<UNIT> } else { matt_three::<UNIT> };
        sum(level, self, reflectance, points)
    }

    /// Sums the light that falls on the points. Without highlights (`SHINES`), the eye is not used, and nothing is
    /// specular.
    #[inline(always)]
    fn front<L: F32Lanes8, const N: usize, const SHINES: bool>(
        &self,
        l: L,
        reflectance: &Reflectance,
        narrow: &[L::F32; 3],
        points: &Points,
    ) -> Front<L, N> {
        let (zero, one) = (l.splat_f64(0.0), l.splat_f64(1.0));
        let mut front = Front { diffuse: [zero; N], specular: [zero; N] };
        // As in `Lights::sum_by`.
        let lamps = if cfg!(mode13h_leave_out = "positional-lights") { &[] } else { self.lamps };
        let shininess = Shininess::new(reflectance.shininess);
        let mut eye = None;
        if SHINES {
            let (normals, positions) = widened(l, narrow, points);
            eye = Some(Eye::new(l, unit(l, &from(l, &self.eye, &positions)), &normals));
        }
        for sun in self.suns {
            let [x, y, z] = sun.towards.to_array();
            let sum = l.add_f32(l.mul_f32(narrow[0], l.splat_f32(x)), l.mul_f32(narrow[1], l.splat_f32(y)));
            let cosines = positive(l, l.widen(l.add_f32(sum, l.mul_f32(narrow[2], l.splat_f32(z)))));
            // Where all cosines are 0, so is the contribution. A branch pays only with highlights.
            if SHINES && l.is_zero(cosines) {
                continue;
            }
            let mut highlights = None;
            if let Some(eye) = &eye {
                let towards = [l.splat_f64(x.into()), l.splat_f64(y.into()), l.splat_f64(z.into())];
                highlights = Some(eye.highlights(l, &towards, cosines, shininess));
            }
            front.add(l, channels(sun.intensity, sun.channels), None, cosines, highlights);
        }
        if lamps.is_empty() {
            return front;
        }
        // With highlights, normals and positions are widened a second time: kept from above, they would take up
        // registers even where there are no lamps.
        let points = if SHINES { core::hint::black_box(points) } else { points };
        let (normals, positions) = widened(l, narrow, points);
        for lamp in lamps {
            let to_lamp = from(l, &lamp.position, &positions);
            let squares = l.mul(dot(l, &to_lamp, &to_lamp), l.splat_f64(lamp.inverse_square));
            let towards = unit(l, &to_lamp);
            // NaN, from a lamp too far away to be squared, counts as out of range.
            let cosines = l.if_less(squares, one, positive(l, dot(l, &normals, &towards)));
            if SHINES && l.is_zero(cosines) {
                continue;
            }
            let left = l.sub(one, squares);
            let mut fall_off = l.if_less(squares, one, l.mul(left, left));
            if let Some(cone) = &lamp.cone {
                fall_off = l.mul(fall_off, share(l, cone, &towards));
            }
            let mut highlights = None;
            if let Some(eye) = &eye {
                highlights = Some(eye.highlights(l, &towards, cosines, shininess));
            }
            front.add(l, channels(lamp.intensity, lamp.channels), Some(fall_off), cosines, highlights);
        }
        front
    }
}

/// The normals and the positions of the points in f64.
#[inline(always)]
fn widened<L: F32Lanes8>(l: L, normals: &[L::F32; 3], points: &Points) -> (Vectors<L>, Vectors<L>) {
    let normals = [l.widen(normals[0]), l.widen(normals[1]), l.widen(normals[2])];
    (normals, [l.widen(l.load_f32(&points[3])), l.widen(l.load_f32(&points[4])), l.widen(l.load_f32(&points[5]))])
}

/// The sum of all light on the points, for each channel.
#[inline(always)]
fn sum<L: F32Lanes8, const N: usize, const UNIT: bool, const SHINES: bool>(
    l: L,
    lights: &Lights<'_>,
    reflectance: &Reflectance,
    points: &Points,
) -> [Wides; N] {
    let normals = normals_of::<L, UNIT>(l, points);
    let (ambient, diffuse) = (l.splat_f64(reflectance.ambient), l.splat_f64(reflectance.diffuse));
    let front = lights.front::<L, N, SHINES>(l, reflectance, &normals, points);
    let mut lanes = [[0.0; LANES]; N];
    let mut i = 0;
    while i < N {
        let mut own = l.add(ambient, l.mul(diffuse, front.diffuse[i]));
        // Without a highlight, zero is added: that turns −0 into 0, as it does with a highlight.
        let mut mirrored = l.splat_f64(0.0);
        if SHINES {
            mirrored = l.mul(l.splat_f64(reflectance.specular), front.specular[i]);
        }
        if N == 3 {
            own = l.mul(own, l.splat_f64(reflectance.color[i % 3]));
            if SHINES {
                mirrored = l.mul(mirrored, l.splat_f64(reflectance.highlight[i % 3]));
            }
        }
        l.store_f64(l.add(own, mirrored), &mut lanes[i]);
        i += 1;
    }
    lanes
}

/// [`sum`] for a number of channels, with or without highlights, under a separate name for `.ci/off_is_free`.
macro_rules! sums {
    ($($name:ident = $by:ident: $channels:literal, $shines:literal;)*) => {
        $(
            compiled_for_each_level! {
                #[inline(never)]
                fn $name[const UNIT: bool][UNIT](lights: &Lights<'_>, reflectance: &Reflectance, points: &Points)
                    -> [Wides; $channels] = $by;
            }
            #[inline(always)]
            fn $by<L: F32Lanes8, const UNIT: bool>(
                l: L,
                lights: &Lights<'_>,
                reflectance: &Reflectance,
                points: &Points,
            ) -> [Wides; $channels] {
                sum::<L, $channels, UNIT, $shines>(l, lights, reflectance, points)
            }
        )*
    };
}
sums! {
    matt_one = matt_one_by: 1, false;
    shiny_one = shiny_one_by: 1, true;
    matt_three = matt_three_by: 3, false;
    shiny_three = shiny_three_by: 3, true;
}

/// The eye, for highlights.
struct Eye<L: Lanes8> {
    /// The unit direction towards the eye; NaN if the eye is at the point itself.
    towards: Vectors<L>,
    /// The cosine between that direction and the normal.
    cosines: L::F64,
}

impl<L: F32Lanes8> Eye<L> {
    #[inline(always)]
    fn new(l: L, towards: Vectors<L>, normals: &Vectors<L>) -> Self {
        Self { towards, cosines: dot(l, normals, &towards) }
    }

    /// max(0, r·v)^s; 0 where the light's own cosine is 0.
    #[inline(always)]
    fn highlights(&self, l: L, towards: &Vectors<L>, cosines: L::F64, shininess: Shininess) -> L::F64 {
        let mirrored = l.mul(l.mul(l.splat_f64(2.0), cosines), self.cosines);
        let mirrored = l.sub(mirrored, dot(l, towards, &self.towards));
        let along = positive(l, l.if_less(l.splat_f64(0.0), cosines, mirrored));
        if l.is_zero(along) { along } else { shininess.of_lanes(l, along) }
    }
}

/// Replaces values that are not above 0, and NaN, by zero.
#[inline(always)]
fn positive<L: F32Lanes8>(l: L, values: L::F64) -> L::F64 {
    l.if_less(l.splat_f64(0.0), values, values)
}

/// The result of [`ConeBeam::share`] for each point.
#[inline(always)]
fn share<L: F32Lanes8>(l: L, cone: &ConeBeam, towards: &Vectors<L>) -> L::F64 {
    let back = [l.splat_f64(cone.back[0]), l.splat_f64(cone.back[1]), l.splat_f64(cone.back[2])];
    let beyond = l.mul(l.sub(l.splat_f64(cone.inner), dot(l, &back, towards)), l.splat_f64(cone.inverse_width));
    let x = positive(l, l.sub(l.splat_f64(1.0), positive(l, beyond)));
    l.mul(l.mul(x, x), l.sub(l.splat_f64(3.0), l.mul(l.splat_f64(2.0), x)))
}

/// The vectors from the points to `to`.
#[inline(always)]
fn from<L: Lanes8>(l: L, to: &Wide, points: &Vectors<L>) -> Vectors<L> {
    let [x, y, z] = *points;
    [l.sub(l.splat_f64(to[0]), x), l.sub(l.splat_f64(to[1]), y), l.sub(l.splat_f64(to[2]), z)]
}

#[inline(always)]
fn dot<L: Lanes8>(l: L, a: &Vectors<L>, b: &Vectors<L>) -> L::F64 {
    l.add(l.add(l.mul(a[0], b[0]), l.mul(a[1], b[1])), l.mul(a[2], b[2]))
}

/// The vectors normalised; NaN where there is no direction.
#[inline(always)]
fn unit<L: F32Lanes8>(l: L, vectors: &Vectors<L>) -> Vectors<L> {
    let parts = l.div(l.splat_f64(1.0), l.sqrt(dot(l, vectors, vectors)));
    [l.mul(vectors[0], parts), l.mul(vectors[1], parts), l.mul(vectors[2], parts)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Angle;
    use crate::light::{Cone, LampBeam, SunBeam};
    use crate::mesh::normals;
    use glam::Vec3;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        // Near 0, as on a real face, and at the extremes.
        prop_oneof![
            8 => prop::array::uniform3(-2.0_f32..2.0),
            1 => Just([0.0; 3]),
            1 => prop::array::uniform3(prop::sample::select(vec![f32::MAX, -f32::MAX, 1e-40, -0.0, 1.0, 0.0])),
        ]
    }

    fn sun() -> impl Strategy<Value = SunBeam> {
        (vector(), -1.0_f32..2.0, prop::array::uniform3(0.0_f32..1.0)).prop_map(|(v, intensity, channels)| SunBeam {
            towards: normals::unit(Vec3::from(v)).unwrap_or(Vec3::Z),
            intensity,
            channels,
        })
    }

    fn cone() -> impl Strategy<Value = Option<ConeBeam>> {
        prop::option::of((vector(), 0.0..90.0, 0.0..90.0).prop_map(|(direction, a, b): (_, f64, f64)| {
            let [inner, outer] = [a.min(b), a.max(b)].map(Angle::from_degrees);
            ConeBeam::new(&Cone { direction: direction.into(), inner, outer }, direction.map(f64::from))
        }))
        .prop_map(Option::flatten)
    }

    fn lamp() -> impl Strategy<Value = LampBeam> {
        (vector(), 0.01_f64..10.0, -1.0_f32..2.0, prop::array::uniform3(0.0_f32..1.0), cone()).prop_map(
            |(v, inverse_square, intensity, channels, cone)| LampBeam {
                position: v.map(f64::from),
                intensity,
                channels,
                inverse_square,
                cone,
            },
        )
    }

    fn reflectance() -> impl Strategy<Value = Reflectance> {
        let shininess = prop_oneof![(0_u32..200).prop_map(f64::from), 0.0..60.0];
        (prop::array::uniform3(0.0..1.0), prop::bool::ANY, shininess, prop::array::uniform3(0.0..1.0)).prop_map(
            |([ambient, diffuse, specular], is_specular, shininess, color)| Reflectance {
                ambient,
                diffuse,
                specular: if is_specular { specular } else { 0.0 },
                shininess,
                color,
                highlight: [1.0, 0.5, 0.25],
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]
        /// Every bit of every lane equals the result for that point alone.
        #[test]
        fn eight_points_are_each_for_itself(
            ends in prop::array::uniform8((vector(), vector())),
            suns in prop::collection::vec(sun(), 0..4),
            lamps in prop::collection::vec(lamp(), 0..4),
            eye in vector(),
            reflectance in reflectance(),
            kernel in prop::sample::select(Kernel::available().collect::<Vec<_>>()),
        ) {
            let lights = Lights { suns: &suns, lamps: &lamps, eye: eye.map(f64::from) };
            let mut points = [[0.0; LANES]; 6];
            for (lane, (normal, position)) in ends.iter().enumerate() {
                for axis in 0..3 {
                    points[axis][lane] = normal[axis];
                    points[axis + 3][lane] = position[axis];
                }
            }
            let one = lights.front_of_one_channel::<false>(&reflectance, &points, kernel);
            let three = lights.front_of_three_channels::<false>(&reflectance, &points, kernel);
            let mut unit_points = points;
            for (lane, (normal, _)) in ends.iter().enumerate() {
                let unit = normals::unit((*normal).into()).unwrap_or(Vec3::ZERO).to_array();
                (0..3).for_each(|axis| unit_points[axis][lane] = unit[axis]);
            }
            let mut turned = unit_points;
            turned[..3].iter_mut().flatten().for_each(|c| *c = -*c);
            let sides = [unit_points, turned].map(|points| {
                let one = lights.front_of_one_channel::<true>(&reflectance, &points, kernel);
                (one, lights.front_of_three_channels::<true>(&reflectance, &points, kernel))
            });
            for (lane, (normal, position)) in ends.into_iter().enumerate() {
                let (normal, position) = (normals::unit(normal.into()).unwrap_or(Vec3::ZERO), Vec3::from(position));
                let (front, _) = lights.one_channel(&reflectance, position, normal);
                prop_assert_eq!(one[lane].to_bits(), front.to_bits(), "{} and {}", one[lane], front);
                let (front, _) = lights.three_channels(&reflectance, position, normal);
                prop_assert_eq!(three.map(|channel| channel[lane].to_bits()), front.map(f64::to_bits));
                let (ones, threes) = (lights.one_channel(&reflectance, position, normal), lights.three_channels(&reflectance, position, normal));
                for (side, (one, three)) in sides.iter().zip([(ones.0, threes.0), (ones.1, threes.1)]) {
                    prop_assert_eq!(side.0[lane].to_bits(), one.to_bits(), "{} and {}", side.0[lane], one);
                    prop_assert_eq!(side.1.map(|channel| channel[lane].to_bits()), three.map(f64::to_bits));
                }
            }
        }
    }
}
