//! Paths.

use core::ops::Range;

use mode13h::glam::Vec3;
use mode13h::scene::Path;
use toml::Spanned;

use super::error::Fault;
use super::layout::{Axis, CircleLayout, PathLayout};
use super::value::{List, Name};

/// Makes a path in a scene with this duration, in seconds.
pub(super) fn path(layout: &Spanned<PathLayout>, duration: f64) -> Result<Path, Fault> {
    let span = layout.span();
    let PathLayout { line, back, circle, rounds } = layout.get_ref();
    let rounds = rounds.map_or(1.0, |rounds| rounds.0);
    let period = duration / rounds.abs();
    let backwards = rounds < 0.0;
    match (line, circle) {
        (Some(List([from, to])), None) => {
            let (from, to) = if backwards { (to, from) } else { (from, to) };
            let back = back.as_ref().is_some_and(|back| *back.get_ref());
            Ok(Path::Line { from: from.vec3(), to: to.vec3(), period, back })
        }
        (None, Some(circle)) => {
            if let Some(back) = back {
                return Err(Fault::value(back.span(), "only a line can go back"));
            }
            let (from, towards) = radii(circle.get_ref(), circle.span())?;
            let towards = if backwards { -towards } else { towards };
            let centre = circle.get_ref().centre.map_or(Vec3::ZERO, |centre| centre.vec3());
            Ok(Path::Circle { centre, from, towards, period })
        }
        _ => Err(Fault::value(span, "a path is either a `line` or a `circle`")),
    }
}

/// The radius vectors to the starting point of a circle, and to the point a quarter of the way around.
fn radii(circle: &CircleLayout, span: Range<usize>) -> Result<(Vec3, Vec3), Fault> {
    match circle {
        CircleLayout { from: Some(from), towards: Some(towards), radius: None, axis: None, start: None, .. } => {
            Ok((from.vec3(), towards.vec3()))
        }
        CircleLayout { from: None, towards: None, radius: Some(radius), axis, start, .. } => {
            // Counter-clockwise seen from the end of the axis.
            let (first, second) = match axis {
                Some(Name(Axis::X)) => (Vec3::Y, Vec3::Z),
                None | Some(Name(Axis::Y)) => (Vec3::Z, Vec3::X),
                Some(Name(Axis::Z)) => (Vec3::X, Vec3::Y),
            };
            let (sine, cosine) = libm::sincos(start.map_or(0.0, |start| start.0.to_radians()));
            let (sine, cosine) = (radius.0 * sine as f32, radius.0 * cosine as f32);
            Ok((first * cosine + second * sine, second * cosine - first * sine))
        }
        _ => Err(Fault::value(
            span,
            "a circle has either a `radius`, with an optional `axis` and `start`, or `from` and `towards`",
        )),
    }
}
