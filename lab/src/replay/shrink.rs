//! A failing frame made small: as few triangles as still fail, at plain coordinates.

use crate::record::Record;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::Vertex;

/// Greatest number of times that the frame is tried.
const TRIES: u32 = 2_000;

/// The smallest record found that still `fails`. Simple and greedy: first triangles are left out, half
/// of them at a time, then a quarter, and so on; then what else there is is made plainer, as long as
/// anything gets plainer by it.
pub(super) fn shrink(record: &Record, fails: &mut dyn FnMut(&Record) -> bool) -> Record {
    let mut shrinking = Shrinking { smallest: record.clone(), tries: 0, fails };
    shrinking.try_it(|record| record.palette = None);
    shrinking.fewer_triangles();
    shrinking.try_it(|record| *record = record.clone().with_clip(None));
    shrinking.try_it(|record| record.background = 0);
    while shrinking.plainer_vertices() && shrinking.tries < TRIES {}
    shrinking.smallest
}

struct Shrinking<'a> {
    smallest: Record,
    tries: u32,
    fails: &'a mut dyn FnMut(&Record) -> bool,
}

impl Shrinking<'_> {
    /// Keeps the change if the frame is another then, and still fails.
    fn try_it(&mut self, change: impl FnOnce(&mut Record)) -> bool {
        let mut changed = self.smallest.clone();
        change(&mut changed);
        if changed == self.smallest || self.tries >= TRIES {
            return false;
        }
        self.tries += 1;
        let keep = (self.fails)(&changed);
        if keep {
            self.smallest = changed;
        }
        keep
    }

    fn fewer_triangles(&mut self) {
        let mut many = self.smallest.triangles.len().div_ceil(2);
        while many > 0 {
            let mut first = 0;
            while first < self.smallest.triangles.len() {
                let end = (first + many).min(self.smallest.triangles.len());
                if !self.try_it(|record| drop(record.triangles.drain(first..end))) {
                    first = end;
                }
            }
            many = if many == 1 { 0 } else { many.div_ceil(2) };
        }
    }

    /// Moves single numbers to plainer ones; whether any could be.
    fn plainer_vertices(&mut self) -> bool {
        let mut any = false;
        for number in 0..self.smallest.triangles.len() {
            for corner in 0..3 {
                for field in 0..4 {
                    for plainer in plainer(value(&self.smallest.triangles[number].0[corner], field)) {
                        let kept = self.try_it(|record| {
                            let vertex = &mut record.triangles[number].0[corner];
                            *vertex = with_value(*vertex, field, plainer);
                        });
                        if kept {
                            any = true;
                            break;
                        }
                    }
                }
            }
        }
        any
    }
}

/// x, y, shade, depth.
fn value(vertex: &Vertex, field: usize) -> i64 {
    match field {
        0 => vertex.x().to_bits().into(),
        1 => vertex.y().to_bits().into(),
        2 => vertex.shade().to_bits().into(),
        _ => vertex.depth().into(),
    }
}

/// The vertex with another value there, or as it was if it cannot have that.
fn with_value(v: Vertex, field: usize, value: i64) -> Vertex {
    let mut values = [0, 1, 2, 3].map(|field| self::value(&v, field));
    values[field] = value;
    let [x, y, shade, depth] = values;
    // Each is nearer to 0 than what was in range.
    Vertex::new(I24F8::from_bits(x as i32), I24F8::from_bits(y as i32), U8F8::from_bits(shade as u16), depth as u32)
        .unwrap_or(v)
}

/// Plainer numbers, all nearer to 0, the plainest first: 0, the half in whole pixels or shades,
/// multiples of 256, of 128 and of 16.
fn plainer(value: i64) -> impl Iterator<Item = i64> {
    let multiple = move |of: i64| value / of * of;
    [0, value / 2 / 256 * 256, multiple(256), multiple(128), multiple(16)]
        .into_iter()
        .filter(move |plainer| plainer.abs() < value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::raster::Interpolation;
    use mode13h_conformance::Random;

    /// One of a hundred triangles is at fault, for the shade of its second vertex.
    #[test]
    fn one_triangle_is_left_and_what_makes_it_fail() {
        let mut random = Random::seeded(5, "shrink");
        let mut vertex = || {
            let mut units = |most: i64| I24F8::from_bits(random.within(-500, most * 256 + 500) as i32);
            let (x, y) = (units(64), units(48));
            Vertex::new(x, y, U8F8::from_bits(random.within(0, 0xFF00) as u16), random.next_u64() as u32 >> 2)
                .expect("inside the guard band")
        };
        let mut record = Record::new(64, 48).expect("a frame").with_clip(None);
        for _ in 0..100 {
            record.triangles.push(([vertex(), vertex(), vertex()], Interpolation::Gouraud));
        }
        record.background = 7;
        let guilty = record.triangles.iter().map(|(v, _)| v[1].shade()).max().expect("a shade");
        let mut tried = 0;
        let small = shrink(&record, &mut |record| {
            tried += 1;
            record.triangles.iter().any(|(v, _)| v[1].shade().to_bits() >= guilty.to_bits() & 0xFF00)
        });
        assert_eq!((small.triangles.len(), small.background), (1, 0));
        let [a, b, c] = small.triangles[0].0;
        assert_eq!((a, c), (Vertex::default(), Vertex::default()));
        assert_eq!(b, Vertex::default().with_shade(U8F8::from_bits(guilty.to_bits() & 0xFF00)));
        assert!(tried < 1000, "{tried}");
    }

    #[test]
    fn what_never_fails_stays() {
        let record = Record::new(1, 1).expect("a frame");
        assert_eq!(shrink(&record, &mut |_| false), record);
    }
}
