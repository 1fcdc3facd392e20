//! Which way to leave out hidden surfaces a scene calls for.

use alloc::vec::Vec;

use super::painter;
use crate::scene::{HiddenSurfaces, Scene};
use crate::view::ObjectView;

/// The way that a scene calls for: the cheapest that is right. Its objects are put in `order`: far
/// to near for painter's order, else as they are.
///
/// One convex object hides nothing but its own back faces. Of several that are convex and whose
/// depths are apart, the nearer hides the farther, whole. All else needs a depth for every pixel.
pub(super) fn called_for(scene: &Scene, views: &[ObjectView], order: &mut Vec<usize>) -> HiddenSurfaces {
    let objects = scene.objects();
    order.clear();
    order.extend(0..objects.len());
    let convex = objects.iter().all(|object| object.mesh().is_convex());
    match objects {
        [] => HiddenSurfaces::BackFaces,
        [_] if convex => HiddenSurfaces::BackFaces,
        _ if convex && painter::far_to_near(objects, views, order) => HiddenSurfaces::PainterOrder,
        _ => HiddenSurfaces::DepthBuffer,
    }
}
