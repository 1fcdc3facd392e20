//! Positions for names beside the points of a chart.

/// A rectangle in pixels: left, top, right, bottom.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Rectangle {
    pub(super) left: i32,
    pub(super) top: i32,
    pub(super) right: i32,
    pub(super) bottom: i32,
}

impl Rectangle {
    const fn around((x, y): (i32, i32), half: i32) -> Self {
        Self { left: x - half, top: y - half, right: x + half, bottom: y + half }
    }

    /// Area that two rectangles share, in pixels.
    fn overlap(self, other: Self) -> i32 {
        let across = self.right.min(other.right) - self.left.max(other.left);
        let down = self.bottom.min(other.bottom) - self.top.max(other.top);
        across.max(0) * down.max(0)
    }

    const fn is_within(self, other: Self) -> bool {
        self.left >= other.left && self.right <= other.right && self.top >= other.top && self.bottom <= other.bottom
    }
}

/// Width of a text. A letter of a sans-serif face averages 0.55 of its height in width; 0.6 is used to be safe.
pub(super) const fn width(text_length: usize, height: i32) -> i32 {
    // Names have a few dozen letters at most.
    text_length as i32 * height * 6 / 10
}

/// A position for each point's name, of the given length, within `area`: close to the point and, as far as there is
/// room, clear of the other names, of `marks` and of the pixels of `lines`. Points are in pixels.
pub(super) fn places(
    points: &[((i32, i32), usize)],
    marks: &[(i32, i32)],
    lines: &[(i32, i32)],
    height: i32,
    area: Rectangle,
) -> Vec<Rectangle> {
    let mut placed: Vec<Rectangle> = Vec::new();
    for &((x, y), length) in points {
        let wide = width(length, height);
        let mut best = None;
        for distance in 0..8 {
            let gap = 8 + distance * 8;
            let aside = [y, y - gap, y + gap];
            let right = aside.map(|y| (x + gap.min(16), y));
            let left = aside.map(|y| (x - gap.min(16) - wide, y));
            let above = [(x - wide / 2, y - gap - height / 2), (x - wide / 2, y + gap + height / 2)];
            for (left, middle) in right.into_iter().chain(left).chain(above) {
                let place = Rectangle {
                    left,
                    top: middle - height / 2,
                    right: left + wide,
                    bottom: middle + height - height / 2,
                };
                if !place.is_within(area) {
                    continue;
                }
                let names: i32 = placed.iter().map(|&other| place.overlap(other)).sum();
                let covered: i32 = marks.iter().map(|&at| place.overlap(Rectangle::around(at, 6))).sum();
                let crossed: i32 = lines.iter().map(|&at| place.overlap(Rectangle::around(at, 2))).sum();
                let cost = 4 * names + 4 * covered + crossed + 6 * distance;
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, place));
                }
            }
        }
        // A name wider than the area starts at its point.
        let beside = Rectangle { left: x + 8, top: y - height / 2, right: x + 8 + wide, bottom: y + height / 2 };
        placed.push(best.map_or(beside, |(_, place)| place));
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_close_points_do_not_meet() {
        let area = Rectangle { left: 0, top: 0, right: 600, bottom: 400 };
        let points: Vec<((i32, i32), usize)> = (0..7).map(|i| ((100 + 3 * i, 200 - 2 * i), 18)).collect();
        let names = places(&points, &points.iter().map(|&(at, _)| at).collect::<Vec<_>>(), &[], 12, area);
        for (i, name) in names.iter().enumerate() {
            assert!(name.is_within(area), "{name:?}");
            assert!(names[..i].iter().all(|other| other.overlap(*name) == 0), "{name:?}");
            assert!(points.iter().all(|&(at, _)| name.overlap(Rectangle::around(at, 3)) == 0), "{name:?}");
        }
    }
}
