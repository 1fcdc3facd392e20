//! The usual vertex stages, eight at a time: where f32 suffices, and suns light matt surfaces.
//!
//! Each vertex gets the same values as from [`ObjectView::project`] and
//! [`both_sides`](crate::light::both_sides): the operations and their order are the same, and each
//! rounds the same in a vector as in a scalar.

use glam::Vec3;

use super::Geometry;
use crate::fixed::U8F8;
use crate::lanes::{LANES, each};
use crate::light::{Lights, both_sides};
use crate::render::surface_material::SurfaceMaterial;
use crate::render::vertex_columns::{ScreenPos, VertexColumns};
use crate::simd::{F32Lanes8, compiled_for_each_level};
use crate::view::{Narrow, ObjectView};

compiled_for_each_level! {
    /// Projects vertices, eight at a time, with or without the test of the near plane.
    pub(super) fn project[const TESTED: bool][TESTED](
        view: &ObjectView,
        narrow: &Narrow,
        positions: &[Vec3],
        vertices: &mut VertexColumns,
    ) = project_by;
}

#[inline(always)]
fn project_by<S: F32Lanes8, const TESTED: bool>(
    s: S,
    view: &ObjectView,
    narrow: &Narrow,
    positions: &[Vec3],
    vertices: &mut VertexColumns,
) {
    let (eights, rest) = positions.as_chunks::<LANES>();
    let (projected, _) = vertices.at.as_chunks_mut::<LANES>();
    let (depths, _) = vertices.depth.as_chunks_mut::<LANES>();
    let n = eights.len().min(projected.len()).min(depths.len());
    let (projected, depths) = (&mut projected[..n], &mut depths[..n]);
    for (i, points) in eights[..n].iter().enumerate() {
        project_eight(s, narrow, points, &mut projected[i], &mut depths[i]);
    }
    // The remaining vertices, or all of an object that is claimed to lie inside but does not.
    let whole = positions.len() - rest.len();
    let strays = !TESTED && vertices.at[..whole].iter().any(|at| at.needs_clipping());
    one_by_one::<TESTED>(view, positions, if strays { 0 } else { whole }, vertices);
}

/// Projects eight vertices, and marks those that need clipping.
#[inline(always)]
fn project_eight<S: F32Lanes8>(
    s: S,
    narrow: &Narrow,
    points: &[Vec3; LANES],
    projected: &mut [ScreenPos; LANES],
    depths: &mut [u32; LANES],
) {
    let at = s.vectors(points);
    let w = row(s, narrow, at, 2);
    let inverse = s.div_f32(s.splat_f32(1.0), w);
    let x = s.add_f32(s.splat_f32(narrow.centre.0), s.mul_f32(row(s, narrow, at, 0), inverse));
    let y = s.add_f32(s.splat_f32(narrow.centre.1), s.mul_f32(row(s, narrow, at, 1), inverse));
    let is_far_enough = s.is_at_least(w, s.splat_f32(narrow.near));
    let within = s.and(is_far_enough, s.and(is_near(s, x), is_near(s, y)));
    let nothing = s.splat_i32(0);
    let mark = s.select_i32(is_far_enough, nothing, s.splat_i32(ScreenPos::TOO_NEAR_Y));
    let x = s.select_i32(within, units(s, x), s.splat_i32(ScreenPos::BEYOND));
    let y = s.select_i32(within, units(s, y), mark);
    // As in `ObjectView::depth`: 1 to 2³⁰ for vertices within it.
    let part = s.mul(s.div(s.splat_f64(narrow.near.into()), s.widen(w)), s.splat_f64(1_073_741_824.0));
    let depth = s.max_i32(s.whole(s.add(part, s.splat_f64(0.5))), s.splat_i32(1));

    let mut pairs = [[0; LANES]; 2];
    let [low, high] = s.interleave_i32(x, y);
    s.store_i32(low, &mut pairs[0]);
    s.store_i32(high, &mut pairs[1]);
    for (lane, projected) in projected.iter_mut().enumerate() {
        let (half, x) = (lane / 4, 2 * (lane % 4));
        *projected = ScreenPos::new(pairs[half][x], pairs[half][x + 1]);
    }
    let mut numbers = [0; LANES];
    s.store_i32(s.select_i32(within, depth, nothing), &mut numbers);
    *depths = each!(lane => numbers[lane].cast_unsigned());
}

/// Coordinate `k` of points in eye space, computed column by column as glam does.
#[inline(always)]
fn row<S: F32Lanes8>(s: S, narrow: &Narrow, at: [S::F32; 3], k: usize) -> S::F32 {
    // No closures, and no standard library functions that take them: they would not be compiled for the level.
    let Narrow { matrix, offset, .. } = narrow;
    let a = s.mul_f32(s.splat_f32(matrix.x_axis.to_array()[k]), at[0]);
    let b = s.mul_f32(s.splat_f32(matrix.y_axis.to_array()[k]), at[1]);
    let c = s.mul_f32(s.splat_f32(matrix.z_axis.to_array()[k]), at[2]);
    s.add_f32(s.add_f32(s.add_f32(a, b), c), s.splat_f32(offset.to_array()[k]))
}

/// True within the limit; false for NaN.
#[inline(always)]
fn is_near<S: F32Lanes8>(s: S, c: S::F32) -> S::Mask {
    s.and(s.is_at_least(c, s.splat_f32(-Narrow::LIMIT)), s.is_at_least(s.splat_f32(Narrow::LIMIT), c))
}

/// `floor(256·pixels + ½)` for coordinates within the limit; arbitrary for others. It stays in f32, where such a
/// coordinate is exact, and so is 256 times it:
///
/// ```text
/// s = 256·x        |s| < 2²⁰
/// n = (s + 1.5·2²³) − 1.5·2²³        the nearest whole number, halves to even: below 2²² f32 holds no halves there
/// floor(s + ½) = n + 1 if s − n = ½, else n
/// ```
///
/// s − n is exact: below 1 in magnitude and a multiple of the lesser of both units in the last place. It lies within
/// ±½, and −½ is a half that has already been rounded up.
#[inline(always)]
fn units<S: F32Lanes8>(s: S, pixels: S::F32) -> S::I32 {
    let magic = s.splat_f32(12_582_912.0);
    let scaled = s.mul_f32(pixels, s.splat_f32(256.0));
    let sum = s.add_f32(scaled, magic);
    // The integer is in the low bits of the sum.
    let nearest = s.sub_i32(s.bits_of_f32(sum), s.bits_of_f32(magic));
    let is_less = s.is_at_least(s.sub_f32(scaled, s.sub_f32(sum, magic)), s.splat_f32(0.5));
    s.add_i32(nearest, s.select_i32(is_less, s.splat_i32(1), s.splat_i32(0)))
}

/// Projects vertices one by one, from index `first` on: the definition.
#[inline(never)]
pub(super) fn one_by_one<const TESTED: bool>(
    view: &ObjectView,
    positions: &[Vec3],
    first: usize,
    vertices: &mut VertexColumns,
) {
    for (i, &position) in positions.iter().enumerate().skip(first) {
        let vertex = if TESTED { view.project(position) } else { Some(view.project_inside(position)) };
        (vertices.at[i], vertices.depth[i]) = match vertex {
            Some(vertex) => (ScreenPos::of(&vertex), vertex.depth()),
            None if view.is_far_enough(position) => (ScreenPos::NEEDS_CLIPPING, 0),
            None => (ScreenPos::TOO_NEAR, 0),
        };
    }
}

compiled_for_each_level! {
    /// Lights vertices for [`light_suns`](super::light_suns), eight at a time.
    pub(super) fn light_suns[const BOTH: bool][BOTH](
        geometry: &Geometry<'_>,
        materials: &[SurfaceMaterial],
        lights: &Lights<'_>,
        vertices: &mut VertexColumns,
    ) = light_suns_by;
}

#[inline(always)]
fn light_suns_by<S: F32Lanes8, const BOTH: bool>(
    s: S,
    geometry: &Geometry<'_>,
    materials: &[SurfaceMaterial],
    lights: &Lights<'_>,
    vertices: &mut VertexColumns,
) {
    let (eights, rest) = geometry.normals.as_chunks::<LANES>();
    let (shades, rest_shades) = vertices.shade.as_chunks_mut::<LANES>();
    let (surfaces, rest_surfaces) = geometry.vertex_surfaces.as_chunks::<LANES>();
    let n = eights.len().min(shades.len()).min(surfaces.len());
    let (shades, surfaces) = (&mut shades[..n], &surfaces[..n]);
    for (i, normals) in eights[..n].iter().enumerate() {
        let (shades, surfaces) = (&mut shades[i], &surfaces[i]);
        if *surfaces == [surfaces[0]; LANES] {
            let mut pairs = [0; LANES];
            s.store_i32(light_eight::<S, BOTH>(s, &materials[usize::from(surfaces[0])], lights, normals), &mut pairs);
            for (lane, shades) in shades.iter_mut().enumerate() {
                *shades = [U8F8::from_bits(pairs[lane] as u16), U8F8::from_bits((pairs[lane] >> 16) as u16)];
            }
        } else {
            light_one_by_one::<BOTH>(normals, surfaces, materials, lights, shades);
        }
    }
    light_one_by_one::<BOTH>(rest, rest_surfaces, materials, lights, rest_shades);
}

/// Lights vertices one by one: the definition.
#[inline(never)]
fn light_one_by_one<const BOTH: bool>(
    normals: &[Vec3],
    surfaces: &[u16],
    materials: &[SurfaceMaterial],
    lights: &Lights<'_>,
    shades: &mut [[U8F8; 2]],
) {
    for ((shades, normal), &surface) in shades.iter_mut().zip(normals).zip(surfaces) {
        let material = &materials[usize::from(surface)];
        let (front, back) =
            both_sides(material.reflectance.ambient, material.reflectance.diffuse, lights.suns, *normal);
        *shades = [material.shade(front), if BOTH { material.shade(back) } else { U8F8::default() }];
    }
}

/// The shades of eight normals of one surface: the front's in the lower half, and with `BOTH` the back's in the upper.
#[inline(always)]
pub(in crate::render) fn light_eight<S: F32Lanes8, const BOTH: bool>(
    s: S,
    material: &SurfaceMaterial,
    lights: &Lights<'_>,
    normals: &[Vec3; LANES],
) -> S::I32 {
    let [nx, ny, nz] = s.vectors(normals);
    let dark = s.splat_f32(0.0);
    let (mut front, mut back) = (s.splat_f64(0.0), s.splat_f64(0.0));
    for sun in lights.suns {
        let towards = sun.towards;
        let (x, y) = (s.mul_f32(nx, s.splat_f32(towards.x)), s.mul_f32(ny, s.splat_f32(towards.y)));
        // As glam does.
        let cosine = s.add_f32(s.add_f32(x, y), s.mul_f32(nz, s.splat_f32(towards.z)));
        let intensity = s.splat_f64(sun.intensity.into());
        // A light without effect adds zero, which changes no sum: none is −0, as each begins at +0. NaN has no effect.
        front = s.add(front, s.mul(intensity, s.widen(s.max_f32(cosine, dark))));
        if BOTH {
            back = s.sub(back, s.mul(intensity, s.widen(s.min_f32(cosine, dark))));
        }
    }
    let front = shade(s, material, front);
    if BOTH { s.or_i32(front, s.shl_i32(shade(s, material, back), 16)) } else { front }
}

/// The shades of these sums of light.
#[inline(always)]
fn shade<S: F32Lanes8>(s: S, material: &SurfaceMaterial, light: S::F64) -> S::I32 {
    shade_of_intensities(
        s,
        material,
        s.add(s.splat_f64(material.reflectance.ambient), s.mul(s.splat_f64(material.reflectance.diffuse), light)),
    )
}

/// The shades of these intensities, each as computed by [`SurfaceMaterial::shade`].
#[inline(always)]
pub(in crate::render) fn shade_of_intensities<S: F32Lanes8>(s: S, material: &SurfaceMaterial, light: S::F64) -> S::I32 {
    // NaN gives the second argument, 0.
    let clamped = s.min_f32(s.max_f32(s.narrow(light), s.splat_f32(0.0)), s.splat_f32(1.0));
    let units = s.splat_f64(f64::from(material.ramp.entries().saturating_sub(1)) * 256.0);
    let above = s.whole(s.add(s.mul(s.widen(clamped), units), s.splat_f64(0.5)));
    s.min_i32(s.add_i32(s.splat_i32(i32::from(material.ramp.first()) * 256), above), s.splat_i32(0xFF00))
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::super::{light_suns, project_inside, project_tested};
    use super::*;
    use crate::fixed::U8F8;
    use crate::light::{Blend, Reflectance, SunBeam};
    use crate::mesh::Mesh;
    use crate::palette::Ramp;
    use crate::scene::{Camera, Object};
    use crate::span::Kernel;
    use crate::view::{Screen, View};

    fn kernels() -> Vec<Kernel> {
        // Every level the processor has, lower ones included: `simd` alone is the highest.
        Kernel::available().collect()
    }

    fn coordinate() -> impl Strategy<Value = f32> {
        let end = prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 1e-40, 1e12, -1e25, f32::MAX, f32::MIN_POSITIVE]);
        prop_oneof![12 => -1.5_f32..1.5, 3 => -40.0_f32..40.0, 1 => end]
    }

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(coordinate()).prop_map(Vec3::from)
    }

    fn view() -> impl Strategy<Value = ObjectView> {
        let near = prop::sample::select(vec![0.001_f32, 0.1, 1.0, 2.5, 30.0]);
        let angles = prop::array::uniform3(-4.0_f64..4.0);
        let scale = prop::sample::select(vec![0.01_f32, 0.5, 1.0, 1.0, 1.0, 40.0, 1e6]);
        (prop::array::uniform3(-6.0_f32..6.0), near, angles, prop::array::uniform3(-2.0_f32..2.0), scale).prop_map(
            |(eye, near, angles, position, scale)| {
                let eye = Vec3::from(eye) + Vec3::new(0.0, 0.0, 8.0);
                let camera = Camera { eye, near, ..Camera::default() };
                let corners = [Vec3::NEG_ONE, Vec3::ONE, Vec3::X];
                let mut object = Object::new(Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("a legal mesh"));
                object.angles = angles.map(crate::Angle::from_radians);
                (object.position, object.scale) = (position.into(), scale);
                ObjectView::new(&View::new(&camera, Screen::MODE_13H).expect("a legal camera"), &object)
            },
        )
    }

    fn material() -> impl Strategy<Value = SurfaceMaterial> {
        let ramp = (0_u8..=255).prop_flat_map(|first| (Just(first), 1..=256 - u16::from(first)));
        (-0.5_f64..1.5, -1.0_f64..3.0, ramp).prop_map(|(ambient, diffuse, (first, entries))| SurfaceMaterial {
            reflectance: Reflectance {
                ambient,
                diffuse,
                specular: 0.0,
                shininess: 0.0,
                color: [0.0; 3],
                highlight: [0.0; 3],
            },
            ramp: Ramp::new(first, entries).expect("a legal ramp"),
            texture_size: None,
            environment_size: None,
            blend: Blend::Opaque,
            has_effects: false,
            response: None,
        })
    }

    fn geometry<'a>(normals: &'a [Vec3], vertex_surfaces: &'a [u16]) -> Geometry<'a> {
        Geometry { normals, vertex_surfaces, ..Geometry::default() }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Every vertex gets the same position as on its own, or needs clipping exactly if it does
        /// on its own.
        #[test]
        fn eight_vertices_are_where_each_is_alone(
            view in view(),
            positions in prop::collection::vec(vector(), 0..40),
        ) {
            for kernel in kernels() {
                let mut vertices = VertexColumns::default();
                vertices.begin(positions.len());
                project_tested(&view, &positions, kernel, &mut vertices);
                for (i, &position) in positions.iter().enumerate() {
                    let alone = view.project(position);
                    let mark = match view.homogeneous(position).w >= f64::from(view.near) {
                        true => ScreenPos::NEEDS_CLIPPING,
                        false => ScreenPos::TOO_NEAR,
                    };
                    prop_assert_eq!(vertices.at[i], alone.map_or(mark, |v| ScreenPos::of(&v)), "{:?}", position);
                    prop_assert_eq!(vertices.depth[i], alone.unwrap_or_default().depth(), "{:?}", position);
                }
                project_inside(&view, &positions, kernel, &mut vertices);
                for (i, &position) in positions.iter().enumerate() {
                    prop_assert!(!vertices.at[i].needs_clipping());
                    let alone = view.project_inside(position);
                    prop_assert_eq!((vertices.at[i], vertices.depth[i]), (ScreenPos::of(&alone), alone.depth()));
                }
            }
        }

        /// Every vertex gets the same shades as on its own, with one surface or several.
        #[test]
        fn eight_vertices_are_lit_as_each_is_alone(
            normals in prop::collection::vec(vector(), 0..40),
            surfaces in prop::collection::vec(0_usize..6, 40),
            materials in prop::array::uniform2(material()),
            suns in prop::collection::vec((vector(), -0.5_f32..2.0), 0..4),
        ) {
            let suns: Vec<SunBeam> =
                suns.into_iter().map(|(towards, intensity)| SunBeam { towards, intensity, channels: [0.0; 3] }).collect();
            let lights = Lights { suns: &suns, lamps: &[], eye: [0.0; 3] };
            // Usually whole eights of the first.
            let vertex_surfaces: Vec<u16> = (0..normals.len()).map(|i| u16::from(surfaces[i / 8] == i % 8)).collect();
            let geometry = geometry(&normals, &vertex_surfaces);
            for kernel in kernels() {
                for both in [true, false] {
                    let mut vertices = VertexColumns::default();
                    vertices.begin(normals.len());
                    light_suns(&geometry, &materials, &lights, (both, kernel), &mut vertices);
                    for (i, &normal) in normals.iter().enumerate() {
                        let material = &materials[usize::from(vertex_surfaces[i])];
                        let (front, back) = both_sides(material.reflectance.ambient, material.reflectance.diffuse, &suns, normal);
                        let back = if both { material.shade(back) } else { U8F8::default() };
                        prop_assert_eq!(vertices.shade[i], [material.shade(front), back], "{:?}", normal);
                    }
                }
            }
        }
    }
}
