//! The commonest stages of vertices, eight at a time: f32 serves, and suns light matt surfaces.

use glam::Vec3;

use super::Geometry;
use super::light_one;
use crate::light::{Lights, both_sides_of_eight};
use crate::render::lit::{LitVertices, Place};
use crate::render::paint::Paint;
use crate::view::ObjectView;
use crate::view::lanes::{LANES, Narrow};

/// [`project_inside`](super::project_inside), or [`project_tested`](super::project_tested).
#[inline(always)]
pub(super) fn project<const TESTED: bool>(
    view: &ObjectView,
    narrow: &Narrow,
    positions: &[Vec3],
    lit: &mut LitVertices,
) {
    let (eights, rest) = positions.as_chunks::<LANES>();
    let (places, _) = lit.places.as_chunks_mut::<LANES>();
    let (depths, _) = lit.depths.as_chunks_mut::<LANES>();
    for ((points, places), depths) in eights.iter().zip(places).zip(depths) {
        let eight = narrow.project(points);
        for (i, place) in places.iter_mut().enumerate() {
            let within = eight.within[i];
            *place = Place::new((eight.x[i] & within) | (Place::BEYOND & !within), eight.y[i] & within);
        }
        for (i, depth) in depths.iter_mut().enumerate() {
            *depth = (eight.depth[i] & eight.within[i]).cast_unsigned();
        }
    }
    // Those that are left; or, of an object that is said to lie inside and does not, all.
    let strays = !TESTED && lit.places[..positions.len() - rest.len()].iter().any(|place| place.needs_clipping());
    let first = if strays { 0 } else { positions.len() - rest.len() };
    one_by_one::<TESTED>(view, positions, first, lit);
}

/// The definition, of vertices from number `first` on.
#[inline(never)]
pub(super) fn one_by_one<const TESTED: bool>(
    view: &ObjectView,
    positions: &[Vec3],
    first: usize,
    lit: &mut LitVertices,
) {
    for (i, &position) in positions.iter().enumerate().skip(first) {
        lit.put(i, if TESTED { view.project(position) } else { Some(view.project_inside(position)) });
    }
}

/// [`light_suns`](super::light_suns).
#[inline(always)]
pub(super) fn light_suns(geometry: &Geometry<'_>, paints: &[Paint], lights: &Lights<'_>, lit: &mut LitVertices) {
    let (eights, rest) = geometry.normals.as_chunks::<LANES>();
    let (shades, rest_shades) = lit.shades.as_chunks_mut::<LANES>();
    let (surfaces, rest_surfaces) = geometry.vertex_surfaces.as_chunks::<LANES>();
    for ((normals, shades), surfaces) in eights.iter().zip(shades).zip(surfaces) {
        let paint = &paints[usize::from(surfaces[0])];
        if *surfaces != [surfaces[0]; LANES] {
            for ((shades, normal), &surface) in shades.iter_mut().zip(normals).zip(surfaces) {
                *shades = light_one(&paints[usize::from(surface)], lights, *normal);
            }
            continue;
        }
        let (ambient, diffuse) = (paint.answer.ambient, paint.answer.diffuse);
        let [front, back] = both_sides_of_eight(ambient, diffuse, lights.suns, normals);
        let (front, back) = (paint.shade_of_eight(&front), paint.shade_of_eight(&back));
        for (lane, shades) in shades.iter_mut().enumerate() {
            *shades = [front[lane], back[lane]];
        }
    }
    for ((shades, normal), &surface) in rest_shades.iter_mut().zip(rest).zip(rest_surfaces) {
        *shades = light_one(&paints[usize::from(surface)], lights, *normal);
    }
}
