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
    let mut strays = false;
    for ((points, places), depths) in eights.iter().zip(places).zip(depths) {
        let eight = narrow.project(points);
        for i in 0..LANES {
            let is_within = eight.is_within[i];
            places[i].x = if is_within { eight.x[i] } else { Place::NEEDS_CLIPPING.x };
            places[i].y = if is_within { eight.y[i] } else { Place::NEEDS_CLIPPING.y };
            depths[i] = if is_within { eight.depth[i] } else { 0 };
            strays |= !is_within;
        }
    }
    for (i, &position) in rest.iter().enumerate() {
        lit.put(eights.len() * LANES + i, project_one::<TESTED>(view, position));
    }
    if !TESTED && strays {
        // An object that is said to lie inside and does not.
        for (i, &position) in positions.iter().enumerate() {
            lit.put(i, project_one::<false>(view, position));
        }
    }
}

#[inline]
fn project_one<const TESTED: bool>(view: &ObjectView, position: Vec3) -> Option<crate::raster::Vertex> {
    if TESTED { view.project(position) } else { Some(view.project_inside(position)) }
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
