//! The commonest stages of vertices, eight at a time: f32 serves, and suns light matt surfaces.

use glam::Vec3;

use super::Geometry;
use crate::fixed::U8F8;
use crate::light::{Lights, both_sides, both_sides_of_eight};
use crate::render::lit::{ScreenPos, ShadedVertices};
use crate::render::paint::SurfaceMaterial;
use crate::view::ObjectView;
use crate::view::lanes::{LANES, Narrow};

/// [`project_inside`](super::project_inside), or [`project_tested`](super::project_tested), by `eight`.
#[inline(always)]
pub(super) fn project<const TESTED: bool>(
    view: &ObjectView,
    narrow: &Narrow,
    positions: &[Vec3],
    lit: &mut ShadedVertices,
    eight: impl Fn(&Narrow, &[Vec3; LANES], &mut [ScreenPos; LANES], &mut [u32; LANES]),
) {
    let (eights, rest) = positions.as_chunks::<LANES>();
    let (places, _) = lit.places.as_chunks_mut::<LANES>();
    let (depths, _) = lit.depths.as_chunks_mut::<LANES>();
    for ((points, places), depths) in eights.iter().zip(places).zip(depths) {
        eight(narrow, points, places, depths);
    }
    // Those that are left; or, of an object that is said to lie inside and does not, all.
    let whole = positions.len() - rest.len();
    let strays = !TESTED && lit.places[..whole].iter().any(|place| place.needs_clipping());
    one_by_one::<TESTED>(view, positions, if strays { 0 } else { whole }, lit);
}

/// Eight vertices, with a mark on those that need clipping.
#[inline(always)]
pub(super) fn project_eight(
    narrow: &Narrow,
    points: &[Vec3; LANES],
    places: &mut [ScreenPos; LANES],
    depths: &mut [u32; LANES],
) {
    let eight = narrow.project(points);
    for (i, place) in places.iter_mut().enumerate() {
        let within = eight.within[i];
        *place = ScreenPos::new((eight.x[i] & within) | (ScreenPos::BEYOND & !within), eight.y[i] & within);
    }
    for (i, depth) in depths.iter_mut().enumerate() {
        *depth = (eight.depth[i] & eight.within[i]).cast_unsigned();
    }
}

/// Calls `project_eight` and is never inlined: from loops over eights the compiler makes vectors of the same lane of
/// eight eights, which takes twice as long.
#[inline(never)]
pub(super) fn project_eight_apart(
    narrow: &Narrow,
    points: &[Vec3; LANES],
    places: &mut [ScreenPos; LANES],
    depths: &mut [u32; LANES],
) {
    project_eight(narrow, points, places, depths);
}

/// The definition, of vertices from number `first` on.
#[inline(never)]
pub(super) fn one_by_one<const TESTED: bool>(
    view: &ObjectView,
    positions: &[Vec3],
    first: usize,
    lit: &mut ShadedVertices,
) {
    for (i, &position) in positions.iter().enumerate().skip(first) {
        lit.put(i, if TESTED { view.project(position) } else { Some(view.project_inside(position)) });
    }
}

/// [`light_suns`](super::light_suns), by `eight`.
#[inline(always)]
pub(super) fn light_suns<const BOTH: bool>(
    geometry: &Geometry<'_>,
    paints: &[SurfaceMaterial],
    lights: &Lights<'_>,
    lit: &mut ShadedVertices,
    eight: impl Fn(&SurfaceMaterial, &Lights<'_>, &[Vec3; LANES], &mut [[U8F8; 2]; LANES]),
) {
    let (eights, rest) = geometry.normals.as_chunks::<LANES>();
    let (shades, rest_shades) = lit.shades.as_chunks_mut::<LANES>();
    let (surfaces, rest_surfaces) = geometry.vertex_surfaces.as_chunks::<LANES>();
    for ((normals, shades), surfaces) in eights.iter().zip(shades).zip(surfaces) {
        if *surfaces == [surfaces[0]; LANES] {
            eight(&paints[usize::from(surfaces[0])], lights, normals, shades);
        } else {
            light_one_by_one::<BOTH>(normals, surfaces, paints, lights, shades);
        }
    }
    light_one_by_one::<BOTH>(rest, rest_surfaces, paints, lights, rest_shades);
}

/// The definition.
#[inline(never)]
fn light_one_by_one<const BOTH: bool>(
    normals: &[Vec3],
    surfaces: &[u16],
    paints: &[SurfaceMaterial],
    lights: &Lights<'_>,
    shades: &mut [[U8F8; 2]],
) {
    for ((shades, normal), &surface) in shades.iter_mut().zip(normals).zip(surfaces) {
        let paint = &paints[usize::from(surface)];
        let (front, back) = both_sides(paint.answer.ambient, paint.answer.diffuse, lights.suns, *normal);
        *shades = [paint.shade(front), if BOTH { paint.shade(back) } else { U8F8::default() }];
    }
}

/// Eight vertices of one surface.
#[inline(always)]
pub(super) fn light_eight<const BOTH: bool>(
    paint: &SurfaceMaterial,
    lights: &Lights<'_>,
    normals: &[Vec3; LANES],
    shades: &mut [[U8F8; 2]; LANES],
) {
    let (ambient, diffuse) = (paint.answer.ambient, paint.answer.diffuse);
    let [front, back] = both_sides_of_eight::<BOTH>(ambient, diffuse, lights.suns, normals);
    let front = paint.shade_of_eight(&front);
    let back = if BOTH { paint.shade_of_eight(&back) } else { [U8F8::default(); LANES] };
    for (lane, shades) in shades.iter_mut().enumerate() {
        *shades = [front[lane], back[lane]];
    }
}

/// Calls `light_eight` and is never inlined, for the reason that `project_eight_apart` gives.
#[inline(never)]
pub(super) fn light_eight_apart<const BOTH: bool>(
    paint: &SurfaceMaterial,
    lights: &Lights<'_>,
    normals: &[Vec3; LANES],
    shades: &mut [[U8F8; 2]; LANES],
) {
    light_eight::<BOTH>(paint, lights, normals, shades);
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::super::{light_suns, project_inside, project_tested};
    use super::*;
    use crate::fixed::U8F8;
    use crate::light::{Beam, Blend, Reflectance};
    use crate::mesh::Mesh;
    use crate::palette::Ramp;
    use crate::scene::{Camera, Object};
    use crate::span::Kernel;
    use crate::view::{Screen, View};

    fn kernels() -> Vec<Kernel> {
        // Every level that the processor has, the lower ones too: `simd` alone is the highest.
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

    fn paint() -> impl Strategy<Value = SurfaceMaterial> {
        let ramp = (0_u8..=255).prop_flat_map(|first| (Just(first), 1..=256 - u16::from(first)));
        (-0.5_f64..1.5, -1.0_f64..3.0, ramp).prop_map(|(ambient, diffuse, (first, entries))| SurfaceMaterial {
            answer: Reflectance {
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

    fn geometry<'a>(positions: &'a [Vec3], normals: &'a [Vec3], vertex_surfaces: &'a [u16]) -> Geometry<'a> {
        Geometry { positions, normals, texcoords: None, vertex_surfaces, triangles: &[], triangle_surfaces: &[] }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Every vertex is where it is alone, or needs clipping as it does alone.
        #[test]
        fn eight_vertices_are_where_each_is_alone(
            view in view(),
            positions in prop::collection::vec(vector(), 0..40),
        ) {
            let geometry = geometry(&positions, &[], &[]);
            for kernel in kernels() {
                let mut lit = ShadedVertices::default();
                lit.begin(positions.len());
                project_tested(&view, &geometry, kernel, &mut lit);
                for (i, &position) in positions.iter().enumerate() {
                    let alone = view.project(position);
                    prop_assert_eq!(lit.get(i).needs_clipping, alone.is_none(), "{:?}", position);
                    prop_assert_eq!(lit.get(i).vertex, alone.unwrap_or_default(), "{:?}", position);
                }
                project_inside(&view, &geometry, kernel, &mut lit);
                for (i, &position) in positions.iter().enumerate() {
                    prop_assert!(!lit.get(i).needs_clipping);
                    prop_assert_eq!(lit.get(i).vertex, view.project_inside(position), "{:?}", position);
                }
            }
        }

        /// Every vertex has the shades that it has alone, of one surface or of several.
        #[test]
        fn eight_vertices_are_lit_as_each_is_alone(
            normals in prop::collection::vec(vector(), 0..40),
            surfaces in prop::collection::vec(0_usize..6, 40),
            paints in prop::array::uniform2(paint()),
            suns in prop::collection::vec((vector(), -0.5_f32..2.0), 0..4),
        ) {
            let suns: Vec<Beam> =
                suns.into_iter().map(|(towards, intensity)| Beam { towards, intensity, channels: [0.0; 3] }).collect();
            let lights = Lights { suns: &suns, lamps: &[], eye: [0.0; 3] };
            // Mostly whole eights of the first.
            let vertex_surfaces: Vec<u16> = (0..normals.len()).map(|i| u16::from(surfaces[i / 8] == i % 8)).collect();
            let geometry = geometry(&[], &normals, &vertex_surfaces);
            for kernel in kernels() {
                for both in [true, false] {
                    let mut lit = ShadedVertices::default();
                    lit.begin(normals.len());
                    light_suns(&geometry, &paints, &lights, (both, kernel), &mut lit);
                    for (i, &normal) in normals.iter().enumerate() {
                        let paint = &paints[usize::from(vertex_surfaces[i])];
                        let (front, back) = both_sides(paint.answer.ambient, paint.answer.diffuse, &suns, normal);
                        let back = if both { paint.shade(back) } else { U8F8::default() };
                        prop_assert_eq!(lit.shades[i], [paint.shade(front), back], "{:?}", normal);
                    }
                }
            }
        }
    }
}
