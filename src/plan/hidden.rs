//! The way to leave out hidden surfaces that a scene calls for: the cheapest that is right.
//!
//! One convex object hides nothing but its own back faces. Among several that are convex and whose depths are apart,
//! the nearer hides the farther, whole. Any other scene needs a depth for every pixel. Bodies that shine through are
//! drawn last, far to near, over the others, unless these hide them.

use alloc::vec::Vec;

use super::reason::Reason;
use crate::light::{Blend, Material};
use crate::scene::{Object, Scene};
use crate::settings::HiddenSurfaces;
use crate::view::ObjectView;

/// Returns whether any of an object's materials shines through.
pub(super) fn is_transparent(object: &Object) -> bool {
    object.materials.iter().any(|Material { blend, .. }| *blend != Blend::Opaque)
}

/// Chooses the way for `scene`, with the reason. Puts the objects' places in `order` as they are to be drawn.
pub(super) fn choose(
    scene: &Scene,
    views: &[ObjectView],
    asked: Option<HiddenSurfaces>,
    order: &mut Vec<usize>,
) -> (HiddenSurfaces, Reason) {
    let objects = scene.objects();
    order.clear();
    order.extend((0..objects.len()).filter(|&i| scene.is_visible(i)));
    let transparent = order.iter().filter(|&&i| is_transparent(&objects[i])).count();
    match asked {
        Some(HiddenSurfaces::ScanLine) if transparent > 0 => {
            return (HiddenSurfaces::DepthBuffer, Reason::ScanLineShowsOneFace);
        }
        Some(asked) => return (asked, Reason::Asked),
        None => {}
    }
    if transparent > 0 {
        let is_opaque = |material: &Material| material.blend == Blend::Opaque;
        let none_opaque = order.iter().all(|&i| !objects[i].materials.iter().any(is_opaque));
        return if none_opaque {
            (HiddenSurfaces::BackFaces, Reason::AllTransparent)
        } else {
            (HiddenSurfaces::DepthBuffer, Reason::TransparentLast)
        };
    }
    let dented = order.iter().copied().find(|&i| !objects[i].mesh().is_convex());
    match (order.len(), dented) {
        (0, _) => (HiddenSurfaces::BackFaces, Reason::Empty),
        (_, Some(object)) => (HiddenSurfaces::DepthBuffer, Reason::NotConvex { object }),
        (1, None) => (HiddenSurfaces::BackFaces, Reason::OneConvex),
        _ if objects_far_to_near(objects, views, order) => (HiddenSurfaces::PainterOrder, Reason::ConvexApart),
        _ => (HiddenSurfaces::DepthBuffer, Reason::Overlap),
    }
}

/// Puts the objects far to near if their depths are apart: if every vertex of one is nearer than all
/// of the next, in the whole units by which the depth buffer decides. Otherwise leaves `order` as it
/// was and returns `false`.
///
/// The depths are those of the objects' boxes: a few sums an object, whatever its number of vertices.
fn objects_far_to_near(objects: &[Object], views: &[ObjectView], order: &mut [usize]) -> bool {
    let depths = |i: usize| views[i].depths(objects[i].mesh().bounds());
    order.sort_unstable_by_key(|&i| (depths(i), i));
    let apart = order.windows(2).all(|pair| depths(pair[0]).1 < depths(pair[1]).0);
    if !apart {
        order.sort_unstable();
    }
    apart
}

/// Puts faces far to near by the sum of the depths of their three vertices, which orders as the mean does; among equal
/// ones the first submitted is painted first. `order` then holds that sum and the place of each.
pub(crate) fn far_to_near(depths: impl Iterator<Item = u64>, order: &mut Vec<(u64, usize)>) {
    order.clear();
    order.extend(depths.zip(0..));
    // No two are equal, so nothing is lost by a sort that needs no memory.
    order.sort_unstable();
}
