//! Clipping in homogeneous space: the near plane first, then the guard band, in f64.
//!
//! Faces are clipped only where the raster cannot draw them: nearer than the near plane, or projected more than 4,096
//! pixels away. The screen's edges need no clipping, since the raster omits exactly what lies beyond them.
//! [`raster::clip`](crate::raster::clip) visits the planes in an order that leaves no cracks.

use crate::fixed::U8F8;
use crate::raster::clip::{Clipped, Corners, clip as clip_triangle};
use crate::raster::effects::Attributes;
use crate::raster::{Interpolation, Vertex};
use crate::view::{Homogeneous, ObjectView};

/// Position of a cut on an edge, as a fraction of the distance from one end to the other.
#[derive(Clone, Copy, Debug)]
struct Parts {
    /// Along the edge in space.
    on_face: f64,
    /// On the screen.
    on_screen: f64,
    /// The one of these two along which shades are linear.
    of_shades: f64,
    /// The one of these two along which texture coordinates are linear.
    of_texture: f64,
}

/// The value at `part` of the way from one end to the other. Rounding does not take it out of their range.
fn between(from: f64, to: f64, part: f64) -> f64 {
    (from + (to - from) * part).max(from.min(to)).min(from.max(to))
}

/// Attributes where an edge is cut.
fn attributes_between(a: &Attributes, b: &Attributes, parts: Parts) -> Attributes {
    let Parts { on_face, on_screen, of_shades, of_texture } = parts;
    let shade = |from: U8F8, to: U8F8, part: f64| {
        // At most 0xFF00, being between two such values. The cast truncates, hence the half.
        U8F8::from_bits((between(from.to_bits().into(), to.to_bits().into(), part) + 0.5) as u16)
    };
    // Between two i32 values.
    let coordinate = |from: i32, to: i32| libm::floor(between(from.into(), to.into(), of_texture) + 0.5) as i32;
    Attributes {
        texture: core::array::from_fn(|i| coordinate(a.texture[i], b.texture[i])),
        fog: shade(a.fog, b.fog, on_screen),
        channels: core::array::from_fn(|i| shade(a.channels[i], b.channels[i], of_shades)),
        slope: core::array::from_fn(|i| shade(a.slope[i], b.slope[i], on_screen)),
        lit: core::array::from_fn(|i| {
            let (from, to) = (f64::from(a.lit[i]), f64::from(b.lit[i]));
            (from + (to - from) * on_face) as f32
        }),
    }
}

/// How shades and texture coordinates are interpolated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progressions {
    pub(super) interpolation: Interpolation,
    /// True if texture coordinates are linear on the screen.
    pub(super) affine: bool,
}

/// A corner of the polygon being clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: Homogeneous,
    /// In 1/256 shade, 0 to 0xFF00.
    pub(super) shade: f64,
    /// The projected vertex, for a corner of the mesh that needs no clipping. It is reused unchanged, because an
    /// unclipped neighbour draws with it too.
    pub(super) vertex: Option<Vertex>,
    pub(super) attributes: Attributes,
}

/// The distance of a corner from a plane, 0 or more inside.
fn distance(view: &ObjectView, plane: usize, corner: &Corner) -> f64 {
    let Homogeneous { x, y, w } = corner.at;
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let distance = match plane {
        0 => w - f64::from(view.near),
        1 => x + (limit + cx) * w,
        2 => (limit - cx) * w - x,
        3 => y + (limit + cy) * w,
        _ => (limit - cy) * w - y,
    };
    // A projected vertex counts as inside, whatever the rounding here says.
    if corner.vertex.is_some() { distance.max(0.0) } else { distance }
}

/// The point where an edge meets a plane.
///
/// It is the mean of the two ends, each weighted with the other's distance: numbers of one sign, like w, lose no digit,
/// however far apart they are. The coordinate that the plane fixes is not interpolated at all: with ends 10³⁸ away on
/// opposite sides, none of it would be left, and the next plane would drop the point, and the face with it.
fn cut(
    view: &ObjectView,
    progressions: Progressions,
    plane: usize,
    inside: &Corner,
    outside: &Corner,
    d_inside: f64,
    d_outside: f64,
) -> Corner {
    let whole = d_inside - d_outside;
    let mean = |a: f64, b: f64| (b * d_inside - a * d_outside) / whole;
    let (a, b) = (inside.at, outside.at);
    let (low, high) = (a.w.min(b.w), a.w.max(b.w));
    let w = if plane == 0 { f64::from(view.near) } else { mean(a.w, b.w).max(low).min(high) };
    let (cx, cy) = view.centre();
    let limit = ObjectView::LIMIT;
    let x = match plane {
        1 => -(limit + cx) * w,
        2 => (limit - cx) * w,
        _ => mean(a.x, b.x),
    };
    let y = match plane {
        3 => -(limit + cy) * w,
        4 => (limit - cy) * w,
        _ => mean(a.y, b.y),
    };
    // On the edge's projection the point lies at t·wb / w. If the other end has no projection, beyond the near plane,
    // values that are linear on the screen are linear along the edge.
    let on_face = d_inside / whole;
    let on_screen = if plane == 0 { on_face } else { on_face * b.w / w };
    let of_shades = if progressions.interpolation.is_linear_on_the_face() { on_face } else { on_screen };
    let of_texture = if progressions.affine { on_screen } else { on_face };
    let parts = Parts { on_face, on_screen, of_shades, of_texture };
    Corner {
        at: Homogeneous { x, y, w },
        shade: between(inside.shade, outside.shade, of_shades),
        vertex: None,
        attributes: attributes_between(&inside.attributes, &outside.attributes, parts),
    }
}

/// Clips a triangle. Returns `None` if nothing is left; otherwise the polygon and its corners' attributes.
pub(super) fn clip(
    view: &ObjectView,
    progressions: Progressions,
    corners: [Corner; 3],
) -> Option<(Clipped, Corners<Corner>)> {
    let left = clip_triangle(
        corners,
        |plane, corner| distance(view, plane, corner),
        |plane, inside, outside, d_inside, d_outside| {
            cut(view, progressions, plane, inside, outside, d_inside, d_outside)
        },
    )?;
    let polygon = left.project(|corner| {
        // At most 0xFF00, being between two such shades. The cast truncates, hence the half.
        let shade = U8F8::from_bits((corner.shade + 0.5) as u16);
        corner.vertex.or_else(|| view.divide(corner.at, shade))
    })?;
    Some((polygon, left))
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::Angle;
    use crate::lanes::three;
    use crate::mesh::shapes;
    use crate::scene::{Camera, Object};
    use crate::view::{Screen, View};

    /// Clipping leaves no part of a face on the screen if the face is off it, however long its edges.
    #[test]
    fn faces_off_the_screen_stay_there() {
        let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(200_000));
        let (off, left) = (core::cell::Cell::new(0), core::cell::Cell::new(0));
        let coordinate =
            || prop_oneof![8 => -3.0..3.0_f32, 2 => -300.0..300.0_f32, 1 => -1e30..1e30_f32, 1 => -1e9..1e9_f32];
        let corner = || prop::array::uniform3(coordinate()).prop_map(Vec3::from);
        let given = (prop::array::uniform3(corner()), prop::array::uniform2(-4.0..4.0_f64), 0.01..2.0_f32);
        let found = runner.run(&given, |(corners, [x, y], near)| {
            let camera = Camera { eye: Vec3::new(0.2, 0.1, 1.0), near, ..Camera::default() };
            let mut object = Object::new(shapes::cube());
            object.angles = [Angle::from_radians(x), Angle::from_radians(y), Angle::default()];
            let view = View::new(&camera, Screen::MODE_13H).expect("a legal camera");
            let view = ObjectView::new(&view, &object);
            let at = three(corners, |corner| view.homogeneous(corner));
            if !view.is_off_screen(&at) {
                return Ok(());
            }
            off.set(off.get() + 1);
            let progressions = Progressions { interpolation: Interpolation::Gouraud88, affine: false };
            let corner = |at| Corner { at, shade: 0.0, vertex: None, attributes: Attributes::default() };
            if let Some((polygon, _)) = clip(&view, progressions, at.map(corner)) {
                left.set(left.get() + 1);
                let all = |beyond: fn(&Vertex) -> bool| polygon.as_slice().iter().all(beyond);
                let is_beyond = all(|v| v.x().to_bits() < 0)
                    || all(|v| v.x().to_bits() > 320 << 8)
                    || all(|v| v.y().to_bits() < 0)
                    || all(|v| v.y().to_bits() > 200 << 8);
                prop_assert!(is_beyond, "{:?}", polygon);
            }
            Ok(())
        });
        found.expect("nothing on the screen");
        assert!(off.get() > 20_000 && left.get() > 5_000, "{} and {}", off.get(), left.get());
    }

    /// Coordinates and shades of a cut are the nearest to the exact ones; halves round up.
    #[test]
    fn attributes_of_a_cut_are_the_nearest() {
        let corner =
            |texture: [i32; 2], fog: u16| Attributes { texture, fog: U8F8::from_bits(fog), ..Attributes::default() };
        let (from, to) = (corner([0, -3], 0), corner([1, 0], 3));
        for (part, texture, fog) in [(0.25, [0, -2], 1), (0.5, [1, -1], 2), (0.875, [1, 0], 3), (1.0, [1, 0], 3)] {
            let cut = attributes_between(
                &from,
                &to,
                Parts { on_face: part, on_screen: part, of_shades: part, of_texture: part },
            );
            assert_eq!((cut.texture, cut.fog.to_bits()), (texture, fog), "{part}");
        }
    }
}
