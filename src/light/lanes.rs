//! The sum of all light at eight points of a surface at a time, in plain arrays that the compiler vectorises.
//!
//! Each point gets the numbers that [`Lights::one_channel`] and [`Lights::three_channels`] give: the operations and
//! their order are the same, and each of them (sum, product, quotient, square root) rounds alike in a vector and alone.
//! If a point has no part in a light, zero is added, which changes no sum: none is −0, as each begins at +0.

use super::intensity::{Lights, Reflectance, Wide};
use super::power::Shininess;
use crate::lanes::{LANES, Lanes, Points};
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
use crate::simd::compiled_for_avx2;
use crate::span::Kernel;

type Wides = Lanes<f64>;

/// x, y and z.
type Vectors = [Wides; 3];

const ZERO: Wides = [0.0; LANES];

/// The light that falls on the points, for each channel.
struct Front<const N: usize> {
    diffuse: [Wides; N],
    specular: [Wides; N],
}

impl<const N: usize> Front<N> {
    #[inline(always)]
    fn add(&mut self, light: [f64; N], fall_off: Option<&Wides>, cosines: &Wides, highlights: Option<&Wides>) {
        for (channel, intensity) in light.into_iter().enumerate() {
            let mut lights = [intensity; LANES];
            if let Some(fall_off) = fall_off {
                for (light, fall_off) in lights.iter_mut().zip(fall_off) {
                    *light *= fall_off;
                }
            }
            for (sum, (light, cosine)) in self.diffuse[channel].iter_mut().zip(lights.iter().zip(cosines)) {
                *sum += light * cosine;
            }
            let Some(highlights) = highlights else { continue };
            for (sum, (light, highlight)) in self.specular[channel].iter_mut().zip(lights.iter().zip(highlights)) {
                *sum += light * highlight;
            }
        }
    }
}

/// The normals at the points, as they are or made unit.
#[inline(always)]
fn normals_of<const UNIT: bool>(points: &Points) -> [Lanes<f32>; 3] {
    if UNIT { [points[0], points[1], points[2]] } else { unit_normals(points) }
}

/// The normals at the points, made unit and rounded to f32; 0 for those that vanish because their ends cancel.
#[inline(always)]
fn unit_normals(points: &Points) -> [Lanes<f32>; 3] {
    let wide = [0, 1, 2].map(|axis| widen(&points[axis]));
    let squares = dot(&wide, &wide);
    let mut parts = ZERO;
    for (part, square) in parts.iter_mut().zip(&squares) {
        let length = square_root(*square);
        *part = if length > 0.0 && length < f64::INFINITY { 1.0 / length } else { 0.0 };
    }
    let mut normals = [[0.0; LANES]; 3];
    for (values, wide) in normals.iter_mut().zip(&wide) {
        for (value, (wide, part)) in values.iter_mut().zip(wide.iter().zip(&parts)) {
            // Of −0 too, as where one normal is made unit.
            *value = (wide * part) as f32 + 0.0;
        }
    }
    normals
}

impl Lights<'_> {
    /// Sums all light on one channel, not yet clamped, for the side that the points' normals, of any length, point away
    /// from.
    pub(crate) fn front_of_one_channel(&self, answer: &Reflectance, points: &Points, kernel: Kernel) -> Wides {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx2) = kernel.avx2() {
            return one_channel_avx2::<false>(avx2, self, answer, points);
        }
        let _ = kernel;
        self.one_channel_apart::<false>(answer, points)
    }

    /// Sums all light on one channel for unit normals, which are taken as they are. Otherwise like
    /// [`front_of_one_channel`](Self::front_of_one_channel).
    pub(crate) fn unit_front_of_one_channel(&self, answer: &Reflectance, points: &Points, kernel: Kernel) -> Wides {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx2) = kernel.avx2() {
            return one_channel_avx2::<true>(avx2, self, answer, points);
        }
        let _ = kernel;
        self.one_channel_apart::<true>(answer, points)
    }

    /// Sums all light on three channels: red, green, blue. Otherwise like
    /// [`front_of_one_channel`](Self::front_of_one_channel).
    pub(crate) fn front_of_three_channels(&self, answer: &Reflectance, points: &Points, kernel: Kernel) -> [Wides; 3] {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx2) = kernel.avx2() {
            return three_channels_avx2::<false>(avx2, self, answer, points);
        }
        let _ = kernel;
        self.three_channels_apart::<false>(answer, points)
    }

    /// Sums all light on three channels for unit normals, which are taken as they are. Otherwise like
    /// [`front_of_three_channels`](Self::front_of_three_channels).
    pub(crate) fn unit_front_of_three_channels(
        &self,
        answer: &Reflectance,
        points: &Points,
        kernel: Kernel,
    ) -> [Wides; 3] {
        #[cfg(all(feature = "simd", target_arch = "x86_64"))]
        if let Some(avx2) = kernel.avx2() {
            return three_channels_avx2::<true>(avx2, self, answer, points);
        }
        let _ = kernel;
        self.three_channels_apart::<true>(answer, points)
    }

    #[inline(never)]
    fn one_channel_apart<const UNIT: bool>(&self, answer: &Reflectance, points: &Points) -> Wides {
        self.one_channel_of_eight::<UNIT, true>(answer, points)
    }

    #[inline(never)]
    fn three_channels_apart<const UNIT: bool>(&self, answer: &Reflectance, points: &Points) -> [Wides; 3] {
        self.three_channels_of_eight::<UNIT, true>(answer, points)
    }

    /// Inlined, with all that it calls, into code that is compiled for a processor; but with highlights `APART`.
    #[inline(always)]
    fn one_channel_of_eight<const UNIT: bool, const APART: bool>(
        &self,
        answer: &Reflectance,
        points: &Points,
    ) -> Wides {
        let of_sun = |sun: &super::Beam| [f64::from(sun.intensity)];
        let of_lamp = |lamp: &super::LampBeam| [f64::from(lamp.intensity)];
        let normals = normals_of::<UNIT>(points);
        if !answer.shines() {
            let [mut body] = self.front::<1, APART, false>(answer, &normals, points, of_sun, of_lamp).diffuse;
            // Zero is the highlight: −0 becomes 0, as with one.
            body.iter_mut().for_each(|body| *body = (answer.ambient + answer.diffuse * *body) + 0.0);
            return body;
        }
        let front = self.front::<1, APART, true>(answer, &normals, points, of_sun, of_lamp);
        let [mut body] = front.diffuse;
        for (body, highlight) in body.iter_mut().zip(&front.specular[0]) {
            *body = (answer.ambient + answer.diffuse * *body) + answer.specular * highlight;
        }
        body
    }

    #[inline(always)]
    fn three_channels_of_eight<const UNIT: bool, const APART: bool>(
        &self,
        answer: &Reflectance,
        points: &Points,
    ) -> [Wides; 3] {
        let of_sun = |sun: &super::Beam| sun.channels.map(f64::from);
        let of_lamp = |lamp: &super::LampBeam| lamp.channels.map(f64::from);
        let normals = normals_of::<UNIT>(points);
        if !answer.shines() {
            let mut channels = self.front::<3, APART, false>(answer, &normals, points, of_sun, of_lamp).diffuse;
            for (channel, color) in channels.iter_mut().zip(answer.color) {
                // As on one channel.
                channel.iter_mut().for_each(|body| *body = (answer.ambient + answer.diffuse * *body) * color + 0.0);
            }
            return channels;
        }
        let front = self.front::<3, APART, true>(answer, &normals, points, of_sun, of_lamp);
        let mut channels = front.diffuse;
        for (i, channel) in channels.iter_mut().enumerate() {
            for (body, highlight) in channel.iter_mut().zip(&front.specular[i]) {
                let (own, mirrored) = (answer.ambient + answer.diffuse * *body, answer.specular * highlight);
                *body = own * answer.color[i] + mirrored * answer.highlight[i];
            }
        }
        channels
    }

    /// Sums the light that falls on the points. Without highlights, `SHINES`, the eye is not looked at, and nothing is
    /// specular.
    #[inline(always)]
    fn front<const N: usize, const APART: bool, const SHINES: bool>(
        &self,
        answer: &Reflectance,
        narrow: &[Lanes<f32>; 3],
        points: &Points,
        of_sun: impl Fn(&super::Beam) -> [f64; N],
        of_lamp: impl Fn(&super::LampBeam) -> [f64; N],
    ) -> Front<N> {
        let mut front = Front { diffuse: [ZERO; N], specular: [ZERO; N] };
        // Suns alone ask for neither.
        let wide = || (narrow.each_ref().map(widen), [3, 4, 5].map(|axis| widen(&points[axis])));
        // As in `Lights::sum_by`.
        let lamps = if cfg!(mode13h_leave_out = "positional-lights") { &[] } else { self.lamps };
        let shininess = Shininess::new(answer.shininess);
        let eye = SHINES.then(|| {
            let (normals, places) = wide();
            Eye::new(unit(&from(&self.eye, &places)), &normals)
        });
        for sun in self.suns {
            let towards = sun.towards.to_array();
            let mut cosines = ZERO;
            for (lane, cosine) in cosines.iter_mut().enumerate() {
                let [x, y, z] = [0, 1, 2].map(|axis| narrow[axis][lane] * towards[axis]);
                *cosine = f64::from((x + y) + z);
            }
            let cosines = positive(&cosines);
            if cosines == ZERO {
                continue;
            }
            let highlights = eye.as_ref().map(|eye| {
                let towards = towards.map(|c| [f64::from(c); LANES]);
                eye.highlights_by::<APART>(&towards, &cosines, shininess)
            });
            front.add(of_sun(sun), None, &cosines, highlights.as_ref());
        }
        if lamps.is_empty() {
            return front;
        }
        let (normals, places) = wide();
        for lamp in lamps {
            let to_lamp = from(&lamp.position, &places);
            let squares = dot(&to_lamp, &to_lamp).map(|square| square * lamp.inverse_square);
            let towards = unit(&to_lamp);
            let mut cosines = positive(&dot(&normals, &towards));
            let mut fall_off = ZERO;
            for (cosine, (fall_off, square)) in cosines.iter_mut().zip(fall_off.iter_mut().zip(&squares)) {
                // NaN, of what is too far to be squared, fails it too.
                let is_in_range = *square < 1.0;
                *fall_off = if is_in_range { (1.0 - square) * (1.0 - square) } else { 0.0 };
                *cosine = if is_in_range { *cosine } else { 0.0 };
            }
            if cosines == ZERO {
                continue;
            }
            let highlights = eye.as_ref().map(|eye| eye.highlights_by::<APART>(&towards, &cosines, shininess));
            front.add(of_lamp(lamp), Some(&fall_off), &cosines, highlights.as_ref());
        }
        front
    }
}

// Frames lit at every pixel: `teapot` and `phong` 8 % sooner than by SSE2, the torus, whose rows are of four pixels, no sooner.
#[cfg(all(feature = "simd", target_arch = "x86_64"))]
compiled_for_avx2! {
    fn one_channel_avx2<const UNIT: bool>(lights: &Lights<'_>, answer: &Reflectance, points: &Points) -> Wides {
        lights.one_channel_of_eight::<UNIT, false>(answer, points)
    }
}

#[cfg(all(feature = "simd", target_arch = "x86_64"))]
compiled_for_avx2! {
    fn three_channels_avx2<const UNIT: bool>(lights: &Lights<'_>, answer: &Reflectance, points: &Points) -> [Wides; 3] {
        lights.three_channels_of_eight::<UNIT, false>(answer, points)
    }
}

/// The eye, for highlights.
struct Eye {
    /// The unit direction towards the eye; not a number if the eye is at the point itself.
    towards: Vectors,
    /// Its cosine with the normal.
    cosines: Wides,
}

impl Eye {
    #[inline(always)]
    fn new(towards: Vectors, normals: &Vectors) -> Self {
        Self { towards, cosines: dot(normals, &towards) }
    }

    #[inline(always)]
    fn highlights_by<const APART: bool>(&self, towards: &Vectors, cosines: &Wides, shininess: Shininess) -> Wides {
        if APART {
            self.highlights_apart(towards, cosines, shininess)
        } else {
            self.highlights(towards, cosines, shininess)
        }
    }

    // A function of its own, so that `.ci/off_is_free` can see where it is entered.
    #[inline(never)]
    fn highlights_apart(&self, towards: &Vectors, cosines: &Wides, shininess: Shininess) -> Wides {
        self.highlights(towards, cosines, shininess)
    }

    /// max(0, r·v)^s; 0 if the light's own cosine is.
    #[inline(always)]
    fn highlights(&self, towards: &Vectors, cosines: &Wides, shininess: Shininess) -> Wides {
        let mut along = dot(towards, &self.towards);
        for (along, (cosine, eye)) in along.iter_mut().zip(cosines.iter().zip(&self.cosines)) {
            let mirrored = 2.0 * cosine * eye - *along;
            *along = if *cosine > 0.0 { mirrored } else { 0.0 };
        }
        let along = positive(&along);
        if along == ZERO { ZERO } else { shininess.of_lanes(&along) }
    }
}

/// Replaces values that are not above 0, or not numbers, by zero.
#[inline(always)]
fn positive(values: &Wides) -> Wides {
    let mut positive = ZERO;
    for (positive, value) in positive.iter_mut().zip(values) {
        *positive = if *value > 0.0 { *value } else { 0.0 };
    }
    positive
}

#[inline(always)]
fn widen(values: &Lanes<f32>) -> Wides {
    let mut wide = ZERO;
    for (wide, value) in wide.iter_mut().zip(values) {
        *wide = f64::from(*value);
    }
    wide
}

/// The vectors from the points to `to`.
#[inline(always)]
fn from(to: &Wide, points: &Vectors) -> Vectors {
    let mut vectors = *points;
    for (values, to) in vectors.iter_mut().zip(to) {
        for value in values {
            *value = to - *value;
        }
    }
    vectors
}

#[inline(always)]
fn dot(a: &Vectors, b: &Vectors) -> Wides {
    let mut sums = ZERO;
    for (lane, sum) in sums.iter_mut().enumerate() {
        *sum = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
    sums
}

/// The vectors made unit; not a number if there is no direction.
#[inline(always)]
fn unit(vectors: &Vectors) -> Vectors {
    let squares = dot(vectors, vectors);
    let mut parts = ZERO;
    for (part, square) in parts.iter_mut().zip(&squares) {
        *part = 1.0 / square_root(*square);
    }
    let mut units = *vectors;
    for values in &mut units {
        for (value, part) in values.iter_mut().zip(&parts) {
            *value *= part;
        }
    }
    units
}

/// Both are the number nearest to the root, so they are one number. The compiler makes vectors of the first.
#[inline(always)]
fn square_root(square: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        square.sqrt()
    }
    #[cfg(not(feature = "std"))]
    {
        libm::sqrt(square)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Beam, LampBeam};
    use super::*;
    use crate::mesh::normals;
    use glam::Vec3;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        // Near 0, as a face has it, and at the ends of what there is.
        prop_oneof![
            8 => prop::array::uniform3(-2.0_f32..2.0),
            1 => Just([0.0; 3]),
            1 => prop::array::uniform3(prop::sample::select(vec![f32::MAX, -f32::MAX, 1e-40, -0.0, 1.0, 0.0])),
        ]
    }

    fn sun() -> impl Strategy<Value = Beam> {
        (vector(), -1.0_f32..2.0, prop::array::uniform3(0.0_f32..1.0)).prop_map(|(v, intensity, channels)| Beam {
            towards: normals::unit(Vec3::from(v)).unwrap_or(Vec3::Z),
            intensity,
            channels,
        })
    }

    fn lamp() -> impl Strategy<Value = LampBeam> {
        (vector(), 0.01_f64..10.0, -1.0_f32..2.0, prop::array::uniform3(0.0_f32..1.0)).prop_map(
            |(v, inverse_square, intensity, channels)| LampBeam {
                position: v.map(f64::from),
                intensity,
                channels,
                inverse_square,
            },
        )
    }

    fn answer() -> impl Strategy<Value = Reflectance> {
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
        /// Every bit of every lane is that of one point alone.
        #[test]
        fn eight_points_are_each_for_itself(
            ends in prop::array::uniform8((vector(), vector())),
            suns in prop::collection::vec(sun(), 0..4),
            lamps in prop::collection::vec(lamp(), 0..4),
            eye in vector(),
            answer in answer(),
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
            let one = lights.front_of_one_channel(&answer, &points, kernel);
            let three = lights.front_of_three_channels(&answer, &points, kernel);
            let mut unit_points = points;
            for (lane, (normal, _)) in ends.iter().enumerate() {
                let unit = normals::unit((*normal).into()).unwrap_or(Vec3::ZERO).to_array();
                (0..3).for_each(|axis| unit_points[axis][lane] = unit[axis]);
            }
            let mut turned = unit_points;
            turned[..3].iter_mut().flatten().for_each(|c| *c = -*c);
            let sides = [unit_points, turned].map(|points| {
                let one = lights.unit_front_of_one_channel(&answer, &points, kernel);
                (one, lights.unit_front_of_three_channels(&answer, &points, kernel))
            });
            for (lane, (normal, position)) in ends.into_iter().enumerate() {
                let (normal, position) = (normals::unit(normal.into()).unwrap_or(Vec3::ZERO), Vec3::from(position));
                let (front, _) = lights.one_channel(&answer, position, normal);
                prop_assert_eq!(one[lane].to_bits(), front.to_bits(), "{} and {}", one[lane], front);
                let (front, _) = lights.three_channels(&answer, position, normal);
                prop_assert_eq!(three.map(|channel| channel[lane].to_bits()), front.map(f64::to_bits));
                let (ones, threes) = (lights.one_channel(&answer, position, normal), lights.three_channels(&answer, position, normal));
                for (side, (one, three)) in sides.iter().zip([(ones.0, threes.0), (ones.1, threes.1)]) {
                    prop_assert_eq!(side.0[lane].to_bits(), one.to_bits(), "{} and {}", side.0[lane], one);
                    prop_assert_eq!(side.1.map(|channel| channel[lane].to_bits()), three.map(f64::to_bits));
                }
            }
        }
    }
}
