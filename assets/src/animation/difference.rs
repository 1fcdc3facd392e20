//! Differences between a frame of an animation and the one before it.

use mode13h::export::Picture;
use mode13h::export::Scaled;

use super::{AnimationError, AnimationErrorKind};

/// A rectangle of the animation, in pixels: from `left` and `top` up to, but not including, `right` and `bottom`.
#[derive(Clone, Copy)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) right: usize,
    pub(super) bottom: usize,
}

impl Area {
    pub(super) const FIRST_PIXEL: Area = Area { left: 0, top: 0, right: 1, bottom: 1 };

    pub(super) fn whole(scaled: &Scaled<'_>) -> Area {
        Area { left: 0, top: 0, right: scaled.width as usize, bottom: scaled.height as usize }
    }

    /// Counts the area's pixels.
    pub(super) fn pixels(self) -> usize {
        (self.right - self.left) * (self.bottom - self.top)
    }

    /// The smallest area that contains this one, if there is one, and a row from `left` up to `right`.
    fn with_row(area: Option<Area>, y: usize, left: usize, right: usize) -> Area {
        match area {
            Some(area) => {
                Area { left: area.left.min(left), top: area.top, right: area.right.max(right), bottom: y + 1 }
            }
            None => Area { left, top: y, right, bottom: y + 1 },
        }
    }
}

/// Finds the smallest rectangle with all pixels whose colour differs between `before` and `now`, whether because of the
/// index or of the palette. Returns `None` if there is none. An index with an equal colour does not count as a change.
pub(super) fn changed(before: &Picture<'_>, now: &Scaled<'_>) -> Result<Option<Area>, AnimationError> {
    let (picture, columns, rows) = now.sources();
    let (first, size) = ((before.width, before.height), (picture.width, picture.height));
    if first != size {
        return Err(AnimationErrorKind::OtherSize { first, now: size }.into());
    }
    let same_palette = before.palette == picture.palette;
    let changed = |y: usize| {
        let (old, new) = (before.row(y), picture.row(y));
        if same_palette && old == new {
            return None;
        }
        let differs = |&x: &usize| before.palette[usize::from(old[x])] != picture.palette[usize::from(new[x])];
        let left = columns.iter().position(differs)?;
        let right = columns.iter().rposition(differs)? + 1;
        Some((left, right))
    };
    let mut area = None;
    // Rows of the animation that show the same row of the frame are compared once.
    let mut last = None;
    for (y, &row) in rows.iter().enumerate() {
        let ends = match last {
            Some((of, ends)) if of == row => ends,
            _ => changed(row),
        };
        last = Some((row, ends));
        if let Some((left, right)) = ends {
            area = Some(Area::with_row(area, y, left, right));
        }
    }
    Ok(area)
}

/// Yields for each pixel of a part of the animation, row by row, whether its colour is the same in `now` as in
/// `before`. `was` and `is` are the part's palette indices in the two.
pub(super) fn kept<'a>(
    before: &'a Picture<'_>,
    was: &'a [u8],
    now: &'a Picture<'_>,
    is: &'a [u8],
) -> impl Iterator<Item = bool> + 'a {
    was.iter().zip(is).map(|(&was, &is)| before.palette[usize::from(was)] == now.palette[usize::from(is)])
}
