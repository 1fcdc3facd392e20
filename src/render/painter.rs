//! Painter's order: far to near, each over what is there.
//!
//! Of *objects* it is right where their depths are apart. Of *faces* there may be no right order at
//! all (three bars that overlap in a circle), and none by one number a face is always right; so that
//! is only done when asked for.

use alloc::vec::Vec;

use crate::view::ObjectView;
use crate::raster::{Shading, Vertex};
use crate::scene::Object;

/// Puts the objects far to near if their depths are apart: if every vertex of one is nearer than all
/// of the next, in the whole units by which the depth buffer decides. Otherwise leaves `order` as it
/// was and returns `false`.
///
/// The depths are those of the objects' boxes: a few sums an object, whatever its number of vertices.
pub(super) fn far_to_near(objects: &[Object], views: &[ObjectView], order: &mut [usize]) -> bool {
    let mut depths: Vec<_> = objects
        .iter()
        .zip(views)
        .zip(0..)
        .map(|((object, view), i)| (view.depths(object.mesh().bounds()), i))
        .collect();
    depths.sort_unstable();
    let apart = depths.windows(2).all(|pair| pair[0].0.1 < pair[1].0.0);
    if apart {
        for (place, (_, i)) in order.iter_mut().zip(depths) {
            *place = i;
        }
    }
    apart
}

/// Puts faces far to near by the mean depth of their three vertices; of equal ones the first
/// submitted is painted first.
pub(super) fn sort(faces: &mut [([Vertex; 3], Shading)]) {
    // The sum orders as the mean does. The sort is stable.
    faces.sort_by_key(|(vertices, _)| vertices.iter().map(|v| u64::from(v.depth())).sum::<u64>());
}
