//! The stages with AVX2. (What the compiler makes of the plain loops ends in scalars, and fetches the coordinates one by one:
//! light 3.4 ns a vertex and places 3.1.)

use core::arch::x86_64::*;

use glam::Vec3;

use super::{Geometry, lanes};
use crate::fixed::U8F8;
use crate::light::Lights;
use crate::render::lit::{ScreenPos, ShadedVertices};
use crate::render::paint::SurfaceMaterial;
use crate::simd::Avx2;
use crate::view::ObjectView;
use crate::view::lanes::{LANES, Narrow};

pub(super) fn project<const TESTED: bool>(
    _: Avx2,
    (view, narrow): (&ObjectView, &Narrow),
    positions: &[Vec3],
    lit: &mut ShadedVertices,
) {
    #[target_feature(enable = "avx2")]
    fn avx2<const TESTED: bool>(view: &ObjectView, narrow: &Narrow, positions: &[Vec3], lit: &mut ShadedVertices) {
        lanes::project::<TESTED>(view, narrow, positions, lit, |narrow, points, places, depths| {
            project_eight(narrow, points, places, depths);
        });
    }
    // SAFETY: the processor has AVX2, says the token.
    unsafe { avx2::<TESTED>(view, narrow, positions, lit) }
}

pub(super) fn light_suns<const BOTH: bool>(
    _: Avx2,
    geometry: &Geometry<'_>,
    paints: &[SurfaceMaterial],
    lights: &Lights<'_>,
    lit: &mut ShadedVertices,
) {
    #[target_feature(enable = "avx2")]
    fn avx2<const BOTH: bool>(
        geometry: &Geometry<'_>,
        paints: &[SurfaceMaterial],
        lights: &Lights<'_>,
        lit: &mut ShadedVertices,
    ) {
        lanes::light_suns::<BOTH>(geometry, paints, lights, lit, |paint, lights, normals, shades| {
            light_eight::<BOTH>(paint, lights, normals, shades);
        });
    }
    // SAFETY: the processor has AVX2, says the token.
    unsafe { avx2::<BOTH>(geometry, paints, lights, lit) }
}

/// x, y and z of eight vectors.
#[inline]
#[target_feature(enable = "avx2")]
fn apart(vectors: &[Vec3; LANES]) -> [__m256; 3] {
    const { assert!(size_of::<Vec3>() == 12) };
    let from: *const f32 = vectors.as_ptr().cast();
    // SAFETY: 24 f32, as `Vec3` is three in this order, without anything between; four each are loaded from numbers 0, 4, 8, 12, 16
    // and 20 on, and the loads ask for no alignment.
    let [a, b, c] =
        unsafe { [0, 4, 8].map(|at| _mm256_set_m128(_mm_loadu_ps(from.add(at + 12)), _mm_loadu_ps(from.add(at)))) };
    // x y z x | y z x y | z x y z, of the first four vectors and of the last.
    let xy = _mm256_shuffle_ps(b, c, 0b10_01_11_10);
    let yz = _mm256_shuffle_ps(a, b, 0b01_00_10_01);
    [
        _mm256_shuffle_ps(a, xy, 0b10_00_11_00),
        _mm256_shuffle_ps(yz, xy, 0b11_01_10_00),
        _mm256_shuffle_ps(yz, c, 0b11_00_11_01),
    ]
}

/// The lower and the upper four.
#[inline]
#[target_feature(enable = "avx2")]
fn wide(eight: __m256) -> [__m256d; 2] {
    [_mm256_cvtps_pd(_mm256_castps256_ps128(eight)), _mm256_cvtps_pd(_mm256_extractf128_ps(eight, 1))]
}

/// Cut to whole numbers.
#[inline]
#[target_feature(enable = "avx2")]
fn whole([low, high]: [__m256d; 2]) -> __m256i {
    _mm256_set_m128i(_mm256_cvttpd_epi32(high), _mm256_cvttpd_epi32(low))
}

/// `lanes::project_eight`, which names the reasons.
#[inline]
#[target_feature(enable = "avx2")]
fn project_eight(narrow: &Narrow, points: &[Vec3; LANES], places: &mut [ScreenPos; LANES], depths: &mut [u32; LANES]) {
    let [px, py, pz] = apart(points);
    let all = |x: f32| _mm256_set1_ps(x);
    let (matrix, offset) = (&narrow.matrix, narrow.offset.to_array());
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.to_array());
    let row = |k: usize| {
        let [a, b, c] = axes.map(|axis| _mm256_set1_ps(axis[k]));
        let sum = _mm256_add_ps(_mm256_mul_ps(a, px), _mm256_mul_ps(b, py));
        _mm256_add_ps(_mm256_add_ps(sum, _mm256_mul_ps(c, pz)), _mm256_set1_ps(offset[k]))
    };
    let w = row(2);
    let inverse = _mm256_div_ps(all(1.0), w);
    let x = _mm256_add_ps(all(narrow.centre.0), _mm256_mul_ps(row(0), inverse));
    let y = _mm256_add_ps(all(narrow.centre.1), _mm256_mul_ps(row(1), inverse));
    let near_limit =
        |x| _mm256_cmp_ps(_mm256_andnot_ps(_mm256_set1_ps(-0.0), x), _mm256_set1_ps(Narrow::LIMIT), _CMP_LE_OQ);
    let in_front = _mm256_cmp_ps(w, all(narrow.near), _CMP_GE_OQ);
    let within = _mm256_castps_si256(_mm256_and_ps(in_front, _mm256_and_ps(near_limit(x), near_limit(y))));
    let x = _mm256_blendv_epi8(_mm256_set1_epi32(ScreenPos::BEYOND), units(x), within);
    let y = _mm256_and_si256(units(y), within);
    // 1 to 2³⁰ of what is within, of which the lower half of a number that is cut is that of `whole_part`.
    let near = _mm256_set1_pd(narrow.near.into());
    let depth = wide(w).map(|w| {
        let part = _mm256_mul_pd(_mm256_div_pd(near, w), _mm256_set1_pd(1_073_741_824.0));
        _mm256_add_pd(part, _mm256_set1_pd(0.5))
    });
    let depth = _mm256_and_si256(_mm256_max_epi32(whole(depth), _mm256_set1_epi32(1)), within);
    // x beside y; the unpacking keeps to the halves of a vector.
    let (low, high) = (_mm256_unpacklo_epi32(x, y), _mm256_unpackhi_epi32(x, y));
    let places: *mut __m256i = places.as_mut_ptr().cast();
    // SAFETY: eight places of eight bytes, four and four, x in the lower half; eight depths; the stores ask for no alignment.
    unsafe {
        _mm256_storeu_si256(places, _mm256_permute2x128_si256(low, high, 0x20));
        _mm256_storeu_si256(places.add(1), _mm256_permute2x128_si256(low, high, 0x31));
        _mm256_storeu_si256(depths.as_mut_ptr().cast(), depth);
    }
}

/// `view::lanes::units`.
#[inline]
#[target_feature(enable = "avx2")]
fn units(pixels: __m256) -> __m256i {
    let magic = _mm256_set1_ps(12_582_912.0);
    let scaled = _mm256_mul_ps(pixels, _mm256_set1_ps(256.0));
    let sum = _mm256_add_ps(scaled, magic);
    let nearest = _mm256_sub_epi32(_mm256_castps_si256(sum), _mm256_castps_si256(magic));
    // −1 where a half was rounded down.
    let is_less = _mm256_cmp_ps(_mm256_sub_ps(scaled, _mm256_sub_ps(sum, magic)), _mm256_set1_ps(0.5), _CMP_GE_OQ);
    _mm256_sub_epi32(nearest, _mm256_castps_si256(is_less))
}

/// `lanes::light_eight`, which names the reasons.
#[inline]
#[target_feature(enable = "avx2")]
fn light_eight<const BOTH: bool>(
    paint: &SurfaceMaterial,
    lights: &Lights<'_>,
    normals: &[Vec3; LANES],
    shades: &mut [[U8F8; 2]; LANES],
) {
    let [nx, ny, nz] = apart(normals);
    let dark = [_mm256_setzero_pd(); 2];
    let (mut front, mut back) = (dark, dark);
    for sun in lights.suns {
        let [x, y, z] = sun.towards.to_array().map(|c| _mm256_set1_ps(c));
        let sum = _mm256_add_ps(_mm256_mul_ps(nx, x), _mm256_mul_ps(ny, y));
        let cosine = _mm256_add_ps(sum, _mm256_mul_ps(nz, z));
        // What is left out adds zero; of no number nothing is more or less.
        let (front_of, back_of) =
            (_mm256_max_ps(cosine, _mm256_setzero_ps()), _mm256_min_ps(cosine, _mm256_setzero_ps()));
        let intensity = _mm256_set1_pd(sun.intensity.into());
        front = add::<false>(front, front_of, intensity);
        if BOTH {
            back = add::<true>(back, back_of, intensity);
        }
    }
    let front = shade(paint, front);
    let both = if BOTH { _mm256_or_si256(front, _mm256_slli_epi32(shade(paint, back), 16)) } else { front };
    // SAFETY: eight pairs of 16 bits, the front's lower; the store asks for no alignment.
    unsafe { _mm256_storeu_si256(shades.as_mut_ptr().cast(), both) }
}

/// Sums of light with one more sun's, or less it.
#[inline]
#[target_feature(enable = "avx2")]
fn add<const LESS: bool>(sums: [__m256d; 2], cosine: __m256, intensity: __m256d) -> [__m256d; 2] {
    let [low, high] = wide(cosine).map(|cosine| _mm256_mul_pd(intensity, cosine));
    if LESS {
        [_mm256_sub_pd(sums[0], low), _mm256_sub_pd(sums[1], high)]
    } else {
        [_mm256_add_pd(sums[0], low), _mm256_add_pd(sums[1], high)]
    }
}

/// `SurfaceMaterial::shade_of_eight` of these sums of light.
#[inline]
#[target_feature(enable = "avx2")]
fn shade(paint: &SurfaceMaterial, light: [__m256d; 2]) -> __m256i {
    let (ambient, diffuse) = (_mm256_set1_pd(paint.answer.ambient), _mm256_set1_pd(paint.answer.diffuse));
    let [low, high] = light.map(|light| _mm256_cvtpd_ps(_mm256_add_pd(ambient, _mm256_mul_pd(diffuse, light))));
    // Of what is no number the second of both: 0.
    let clamped = _mm256_max_ps(_mm256_set_m128(high, low), _mm256_setzero_ps());
    let clamped = _mm256_min_ps(clamped, _mm256_set1_ps(1.0));
    let units = _mm256_set1_pd(f64::from(paint.ramp.entries().saturating_sub(1)) * 256.0);
    let units = wide(clamped).map(|part| _mm256_add_pd(_mm256_mul_pd(part, units), _mm256_set1_pd(0.5)));
    let sum = _mm256_add_epi32(_mm256_set1_epi32(i32::from(paint.ramp.first()) * 256), whole(units));
    _mm256_min_epi32(sum, _mm256_set1_epi32(0xFF00))
}
