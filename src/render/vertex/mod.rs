//! The stages of an object's vertices. Each is its own loop over all of them, entered only if the plan requires it, so
//! disabled effects cost nothing. The most common ones process eight at a time (`lanes`).

use core::ops::Range;

use glam::Vec3;

use super::geometry::Geometry;
use super::surface_material::SurfaceMaterial;
use super::vertex_columns::{ScreenPos, VertexColumns};
use crate::fixed::U8F8;
use crate::lanes::{LANES, Points, three};
use crate::light::Lights;
use crate::palette::Ramp;
use crate::scene::Fog;
use crate::span::Kernel;
use crate::view::ObjectView;

mod lanes;

pub(super) use lanes::{light_eight, shade_of_intensities};

/// Applies the response of each vertex's material to its shade.
#[inline(never)]
pub(super) fn respond(geometry: &Geometry<'_>, materials: &[SurfaceMaterial], vertices: &mut VertexColumns) {
    for (i, &surface) in geometry.vertex_surfaces.iter().enumerate() {
        let material = &materials[usize::from(surface)];
        vertices.shade[i] = vertices.shade[i].map(|shade| material.respond(shade));
        if let Some(sides) = vertices.channels.get_mut(i) {
            *sides = sides.map(|channels| channels.map(|channel| material.respond(channel)));
        }
    }
}

/// Projects every vertex, none of which can need clipping.
#[inline(never)]
pub(super) fn project_inside(view: &ObjectView, positions: &[Vec3], kernel: Kernel, vertices: &mut VertexColumns) {
    project::<false>(view, positions, kernel, vertices);
}

/// Projects every vertex, and marks those that need clipping.
#[inline(never)]
pub(super) fn project_tested(view: &ObjectView, positions: &[Vec3], kernel: Kernel, vertices: &mut VertexColumns) {
    project::<true>(view, positions, kernel, vertices);
}

#[inline(always)]
fn project<const TESTED: bool>(view: &ObjectView, positions: &[Vec3], kernel: Kernel, vertices: &mut VertexColumns) {
    let Some(narrow) = view.narrow() else {
        return lanes::one_by_one::<TESTED>(view, positions, 0, vertices);
    };
    lanes::project::<TESTED>(kernel.simd_level(), view, &narrow, positions, vertices);
}

/// Rounds already rounded vertices again, to fewer fraction bits, half up.
#[cold]
pub(super) fn requantize(bits: u8, vertices: &mut VertexColumns) {
    let unit = 1 << (8 - bits.min(8));
    // Vertices lie within the guard band, a multiple of the unit, so no sum is near the ends of
    // i32, and no result leaves the band.
    let round = |c: i32| (c + unit / 2).div_euclid(unit) * unit;
    for at in vertices.at.iter_mut().filter(|at| !at.needs_clipping()) {
        *at = ScreenPos::new(round(at.x()), round(at.y()));
    }
}

/// No light: each surface has one shade.
#[inline(never)]
pub(super) fn light_none(geometry: &Geometry<'_>, materials: &[SurfaceMaterial], vertices: &mut VertexColumns) {
    for (shades, &surface) in vertices.shade.iter_mut().zip(geometry.vertex_surfaces) {
        *shades = [materials[usize::from(surface)].constant(); 2];
    }
}

/// Suns on matt surfaces, on the front or on `both` sides; without `both` the back's shades are 0.
#[inline(never)]
pub(super) fn light_suns(
    geometry: &Geometry<'_>,
    materials: &[SurfaceMaterial],
    lights: &Lights<'_>,
    (both, kernel): (bool, Kernel),
    vertices: &mut VertexColumns,
) {
    let level = kernel.simd_level();
    match both {
        true => lanes::light_suns::<true>(level, geometry, materials, lights, vertices),
        false => lanes::light_suns::<false>(level, geometry, materials, lights, vertices),
    }
}

/// Suns, lamps and highlights, on the front or on `both` sides.
#[inline(never)]
pub(super) fn light_all(
    geometry: &Geometry<'_>,
    materials: &[SurfaceMaterial],
    lights: &Lights<'_>,
    (both, kernel): (bool, Kernel),
    vertices: &mut VertexColumns,
) {
    each_eight(geometry, both, |eight, side, surface, points| {
        let material = &materials[surface];
        let intensities = lights.front_of_one_channel::<true>(&material.reflectance, points, kernel);
        let lit = SurfaceMaterial::shade_of_eight(material.ramp, &intensities);
        for (shades, shade) in vertices.shade[eight].iter_mut().zip(lit) {
            shades[side] = shade;
        }
    });
}

/// Suns, lamps and highlights on three channels, on the front or on `both` sides.
#[inline(never)]
pub(super) fn light_channels(
    geometry: &Geometry<'_>,
    materials: &[SurfaceMaterial],
    lights: &Lights<'_>,
    (both, kernel): (bool, Kernel),
    vertices: &mut VertexColumns,
) {
    each_eight(geometry, both, |eight, side, surface, points| {
        let intensities = lights.front_of_three_channels::<true>(&materials[surface].reflectance, points, kernel);
        let lit = |channel| SurfaceMaterial::shade_of_eight(Ramp::WHOLE, channel);
        let [red, green, blue] = three(intensities.each_ref(), lit);
        for (lane, channels) in vertices.channels[eight].iter_mut().enumerate() {
            channels[side] = [red[lane], green[lane], blue[lane]];
        }
    });
}

/// Passes on the vertices, up to eight of one surface at a time, first as seen from the front and then, with `both`,
/// from the back: their indices, the side, their surface, and their normals and positions.
#[inline(always)]
fn each_eight(geometry: &Geometry<'_>, both: bool, mut eight: impl FnMut(Range<usize>, usize, usize, &Points)) {
    let mut first = 0;
    for alike in geometry.vertex_surfaces.chunk_by(|a, b| a == b) {
        for part in alike.chunks(LANES) {
            let vertices = first..first + part.len();
            let mut points = [[0.0; LANES]; 6];
            let [nx, ny, nz, px, py, pz] = &mut points;
            for (lane, vertex) in vertices.clone().enumerate() {
                (nx[lane], ny[lane], nz[lane]) = geometry.normals[vertex].into();
                (px[lane], py[lane], pz[lane]) = geometry.positions[vertex].into();
            }
            first = vertices.end;
            eight(vertices.clone(), 0, usize::from(part[0]), &points);
            if both {
                points[..3].as_flattened_mut().iter_mut().for_each(|c| *c = -*c);
                eight(vertices, 1, usize::from(part[0]), &points);
            }
        }
    }
}

/// Texture coordinates in texels, for surfaces that have an image.
#[inline(never)]
pub(super) fn texture_coordinates(geometry: &Geometry<'_>, materials: &[SurfaceMaterial], texture: &mut [[i32; 2]]) {
    let Some(texcoords) = geometry.texcoords else { return };
    for ((texture, uv), &surface) in texture.iter_mut().zip(texcoords).zip(geometry.vertex_surfaces) {
        if let Some([width, height]) = materials[usize::from(surface)].texture_size {
            *texture = [texels(uv.x, width), texels(uv.y, height)];
        }
    }
}

/// `part` of a texture's `size`, in 16.16. Images repeat; coordinates more than 16,384 texels from the image's corner
/// are brought back by whole images.
fn texels(part: f32, size: u32) -> i32 {
    const FARTHEST: f64 = 16_384.0;
    let size = f64::from(size);
    let at = f64::from(part) * size;
    let near = if at.abs() <= FARTHEST { at } else { at - libm::floor(at / size) * size };
    // Within ±2³⁰; a value too large to have a fraction is still a number.
    floor(near * 65_536.0 + 0.5)
}

/// The greatest whole number not above `x`, or the i32 nearest to it; 0 for NaN. `libm::floor` takes twice the
/// instructions.
fn floor(x: f64) -> i32 {
    let toward_zero = x as i32;
    toward_zero.saturating_sub(i32::from(f64::from(toward_zero) > x))
}

/// Texture coordinates in an environment map, from the normal in eye space.
#[inline(never)]
pub(super) fn environment_coordinates(
    geometry: &Geometry<'_>,
    view: &ObjectView,
    materials: &[SurfaceMaterial],
    texture: &mut [[i32; 2]],
) {
    let to_eye = view.directions_to_eye();
    for ((texture, &normal), &surface) in texture.iter_mut().zip(geometry.normals).zip(geometry.vertex_surfaces) {
        if let Some([width, height]) = materials[usize::from(surface)].environment_size {
            let seen = to_eye * normal;
            // Up to the centres of the outermost texels, so that no coordinate wraps to the
            // opposite side.
            let within = |c: f32, size: u32| texels(0.5 + 0.5 * c * (1.0 - 1.0 / size as f32), size);
            *texture = [within(seen.x, width), within(seen.y, height)];
        }
    }
}

/// Fog density between the eye and every vertex, 0 to 0xFF00.
#[inline(never)]
pub(super) fn fog_levels(geometry: &Geometry<'_>, view: &ObjectView, fog: &Fog, levels: &mut [U8F8]) {
    for (level, &position) in levels.iter_mut().zip(geometry.positions) {
        let density = fog.level(view.homogeneous(position).w);
        *level = U8F8::from_intensity(density as f32, 0, Ramp::WHOLE.entries());
    }
}

/// The normals' x and y in eye space, for a table.
#[inline(never)]
pub(super) fn slopes(geometry: &Geometry<'_>, view: &ObjectView, slopes: &mut [[U8F8; 2]]) {
    let to_eye = view.directions_to_eye();
    for (slopes, &normal) in slopes.iter_mut().zip(geometry.normals) {
        let seen = to_eye * normal;
        let slope = |c: f32| U8F8::from_intensity(0.5 + 0.5 * c, 0, Ramp::WHOLE.entries());
        *slopes = [slope(seen.x), slope(seen.y)];
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn floors_at_the_ends() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 0.5, -0.5, -1.0, 2_147_483_647.5, -2_147_483_648.5]
        {
            assert_eq!(floor(x), libm::floor(x) as i32, "{x}");
        }
    }

    proptest! {
        #[test]
        fn floors_are_those_of_libm(bits: u64, whole: i32, part in -1.0..1.0_f64) {
            for x in [f64::from_bits(bits), f64::from(whole), f64::from(whole) + part] {
                prop_assert_eq!(floor(x), libm::floor(x) as i32, "{}", x);
            }
        }
    }
}
