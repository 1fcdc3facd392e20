//! Chooses the hidden-surface method for a scene: the cheapest that is correct.
//!
//! A single convex object needs only back-face culling. Several convex objects whose depths do not
//! overlap can be painted far to near. Any other scene needs a depth for every pixel. Transparent
//! objects are drawn last, far to near, wherever the others do not hide them.

use alloc::vec::Vec;

use super::reason::Reason;
use crate::light::{Blend, Material};
use crate::scene::{Object, Scene};
use crate::settings::HiddenSurfaces;
use crate::view::ObjectView;

/// Returns whether an object is drawn with a transparent material; the 16.16 path draws all of them opaque.
pub(super) fn is_transparent(object: &Object, is_integer: bool) -> bool {
    !is_integer && object.materials.iter().any(|Material { blend, .. }| *blend != Blend::Opaque)
}

/// Chooses the method for `scene`, with the reason. Fills `order` with the objects' indices in drawing order.
pub(super) fn choose(
    scene: &Scene,
    views: &[ObjectView],
    (asked, is_integer): (Option<HiddenSurfaces>, bool),
    order: &mut Vec<usize>,
) -> (HiddenSurfaces, Reason) {
    let objects = scene.objects();
    order.clear();
    order.extend((0..objects.len()).filter(|&i| scene.is_visible(i)));
    let transparent = order.iter().filter(|&&i| is_transparent(&objects[i], is_integer)).count();
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

/// Sorts the objects far to near if their depths do not overlap: if every vertex of one is farther
/// than all of the next, in the integer units that the depth buffer compares. Otherwise leaves
/// `order` unchanged and returns `false`.
///
/// Depths are those of the bounding boxes: a few sums per object, however many vertices it has.
fn objects_far_to_near(objects: &[Object], views: &[ObjectView], order: &mut [usize]) -> bool {
    let depths = |i: usize| views[i].depths(objects[i].mesh().bounds());
    order.sort_unstable_by_key(|&i| (depths(i), i));
    let apart = order.windows(2).all(|pair| depths(pair[0]).1 < depths(pair[1]).0);
    if !apart {
        order.sort_unstable();
    }
    apart
}

/// Sorts faces far to near by the sum of the depths of their three vertices, which gives the same
/// order as the mean; ties are painted in the order of submission. Fills `order` with that sum and
/// the index of each face.
pub(crate) fn far_to_near(depths: impl Iterator<Item = u64>, order: &mut Vec<(u64, usize)>) {
    order.clear();
    order.extend(depths.zip(0..));
    // No two entries are equal, so an unstable sort, which needs no memory, is safe.
    order.sort_unstable();
}
