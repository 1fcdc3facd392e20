//! Clipping in homogeneous space: the near plane first, then the guard band, in f64.
//!
//! Only what the raster cannot take is cut off: what lies nearer than the near plane, and what is
//! projected more than 4,096 pixels away. The screen's edges need no clipping, the raster leaves
//! out what lies beyond them exactly. [`raster::clip`](crate::raster::clip) goes through the
//! planes in an order that leaves no crack.

use crate::fixed::U8F8;
use crate::raster::clip::{Clipped, clip as clip_triangle};
use crate::raster::effects::Attributes;
use crate::raster::{Interpolation, Vertex};
use crate::view::{Homogeneous, ObjectView};

/// Place of a cut on an edge, as the part of the way from one end to the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// Along the edge in space.
    on_face: f64,
    /// On the screen.
    on_screen: f64,
    /// That of the two that shades are linear along.
    of_shades: f64,
}

/// The values that a corner carries beside its shade.
pub(super) trait Carried: Copy {
    /// The value where the edge from `self` to `other` is cut.
    fn between(&self, other: &Self, parts: Parts) -> Self;
}

/// Nothing.
impl Carried for () {
    fn between(&self, (): &Self, _: Parts) -> Self {}
}

/// Attributes that effects need, and whether the image's coordinates are linear on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithEffects {
    pub(super) attributes: Attributes,
    pub(super) affine: bool,
}

impl Carried for WithEffects {
    fn between(&self, other: &Self, Parts { on_face, on_screen, of_shades }: Parts) -> Self {
        let (a, b) = (&self.attributes, &other.attributes);
        let shade = |from: U8F8, to: U8F8, part: f64| {
            let (from, to) = (f64::from(from.to_bits()), f64::from(to.to_bits()));
            let (low, high) = (from.min(to), from.max(to));
            // At most 0xFF00: between two values that are. The cast truncates after the half.
            U8F8::from_bits(((from + (to - from) * part).max(low).min(high) + 0.5) as u16)
        };
        let coordinate = |from: i32, to: i32| {
            let part = if self.affine { on_screen } else { on_face };
            let (from, to) = (f64::from(from), f64::from(to));
            let (low, high) = (from.min(to), from.max(to));
            // Between two i32.
            libm::floor((from + (to - from) * part).max(low).min(high) + 0.5) as i32
        };
        Self {
            attributes: Attributes {
                texture: core::array::from_fn(|i| coordinate(a.texture[i], b.texture[i])),
                fog: shade(a.fog, b.fog, on_screen),
                channels: core::array::from_fn(|i| shade(a.channels[i], b.channels[i], of_shades)),
                slope: core::array::from_fn(|i| shade(a.slope[i], b.slope[i], on_screen)),
                lit: core::array::from_fn(|i| {
                    let (from, to) = (f64::from(a.lit[i]), f64::from(b.lit[i]));
                    (from + (to - from) * on_face) as f32
                }),
            },
            affine: self.affine,
        }
    }
}

/// A corner of the polygon that is being clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner<C> {
    pub(super) at: Homogeneous,
    /// In 1/256 shade, 0 to 0xFF00.
    pub(super) shade: f64,
    /// The projected vertex, of a corner of the mesh that needs no clipping. It is kept as it is,
    /// because a neighbour that needs none either draws with it.
    pub(super) vertex: Option<Vertex>,
    pub(super) carried: C,
}

/// The distance of a corner from a plane, 0 or more inside.
fn distance<C>(view: &ObjectView, plane: usize, corner: &Corner<C>) -> f64 {
    let Homogeneous { x, y, w } = corner.at;
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let distance = match plane {
        0 => w - f64::from(view.near()),
        1 => x + (limit + cx) * w,
        2 => (limit - cx) * w - x,
        3 => y + (limit + cy) * w,
        _ => (limit - cy) * w - y,
    };
    // A vertex that was projected counts as inside whatever the rounding here says.
    if corner.vertex.is_some() { distance.max(0.0) } else { distance }
}

/// The point where an edge meets a plane.
///
/// It is the mean of the two ends, each weighted with the other's distance: of numbers of one sign,
/// as w is, no digit is lost however far apart they are. The coordinate that the plane fixes is not
/// interpolated at all. With ends at opposite sides, 10³⁸ away, that would leave nothing of it, and
/// the next plane would throw the point away, and the face with it.
fn cut<C: Carried>(
    view: &ObjectView,
    interpolation: Interpolation,
    plane: usize,
    inside: &Corner<C>,
    outside: &Corner<C>,
    d_inside: f64,
    d_outside: f64,
) -> Corner<C> {
    let whole = d_inside - d_outside;
    let between = |a: f64, b: f64| (b * d_inside - a * d_outside) / whole;
    let (a, b) = (inside.at, outside.at);
    let (low, high) = (a.w.min(b.w), a.w.max(b.w));
    let w = if plane == 0 { f64::from(view.near()) } else { between(a.w, b.w).max(low).min(high) };
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let x = match plane {
        1 => -(limit + cx) * w,
        2 => (limit - cx) * w,
        _ => between(a.x, b.x),
    };
    let y = match plane {
        3 => -(limit + cy) * w,
        4 => (limit - cy) * w,
        _ => between(a.y, b.y),
    };
    // On the edge's projection the point lies at t·wb / w. Where the other end has no projection, beyond the near
    // plane, what is linear on the screen is linear along the edge.
    let on_face = d_inside / whole;
    let on_screen = if plane == 0 { on_face } else { on_face * b.w / w };
    let of_shades = if interpolation.is_linear_on_the_face() { on_face } else { on_screen };
    let shade = inside.shade + (outside.shade - inside.shade) * of_shades;
    // Rounding in `shade` must not leave the range of the two ends.
    let (low, high) = (inside.shade.min(outside.shade), inside.shade.max(outside.shade));
    Corner {
        at: Homogeneous { x, y, w },
        shade: shade.max(low).min(high),
        vertex: None,
        carried: inside.carried.between(&outside.carried, Parts { on_face, on_screen, of_shades }),
    }
}

/// Clips a triangle that is drawn with `interpolation`. Returns `None` if nothing is left; otherwise the polygon and
/// its corners' values.
pub(super) fn clip<C: Carried>(
    view: &ObjectView,
    interpolation: Interpolation,
    corners: [Corner<C>; 3],
) -> Option<(Clipped, impl Fn(usize) -> C)> {
    let left = clip_triangle(
        corners,
        |plane, corner| distance(view, plane, corner),
        |plane, inside, outside, d_inside, d_outside| {
            cut(view, interpolation, plane, inside, outside, d_inside, d_outside)
        },
    )?;
    let polygon = left.project(|corner| {
        // At most 0xFF00: between two shades that are. The cast truncates after the half.
        let shade = U8F8::from_bits((corner.shade + 0.5) as u16);
        corner.vertex.or_else(|| view.divide(corner.at, shade))
    })?;
    // Asked for corners of the polygon alone.
    Some((polygon, move |place: usize| left.as_slice().get(place).unwrap_or(&corners[0]).carried))
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    /// Coordinates and shades of a cut are the nearest to the exact ones; halves go up.
    #[test]
    fn attributes_of_a_cut_are_the_nearest() {
        let corner = |texture: [i32; 2], fog: u16| WithEffects {
            attributes: Attributes { texture, fog: U8F8::from_bits(fog), ..Attributes::default() },
            affine: false,
        };
        let (from, to) = (corner([0, -3], 0), corner([1, 0], 3));
        for (part, texture, fog) in [(0.25, [0, -2], 1), (0.5, [1, -1], 2), (0.875, [1, 0], 3), (1.0, [1, 0], 3)] {
            let cut = from.between(&to, Parts { on_face: part, on_screen: part, of_shades: part });
            assert_eq!((cut.attributes.texture, cut.attributes.fog.to_bits()), (texture, fog), "{part}");
        }
    }
}
