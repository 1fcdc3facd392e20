//! Errors of a frame against the truth.
//!
//! The unit is the shade, 1/255 of full intensity, whatever ramp a picture is shown in. Shades are compared where truth
//! and frame show the same face; every other pixel is counted separately, as an error in coverage or visibility.
//! With three channels the one that is farthest off counts.

use super::{Face, TruePixel, TruthFrame};

/// Pixels of a frame that is to be compared with the truth.
#[derive(Clone, PartialEq, Debug)]
pub struct Shown {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// The visible face at each pixel, width × height, row-major; `None` where there is none.
    pub faces: Vec<Option<Face>>,
    /// The shade of each channel at each pixel, 0 to 255, width × height, row-major. On one channel all three are
    /// equal. Where there is no face they may be anything.
    pub shades: Vec<[f64; 3]>,
}

/// Error of each pixel of a frame against the truth.
#[derive(Clone, PartialEq, Debug)]
pub struct ErrorMap {
    width: usize,
    /// The shade shown minus the true one, on each channel; `None` where the two show different faces, or no face.
    off: Vec<Option<[f64; 3]>>,
    cover_errors: usize,
}

/// Side of a block, in pixels.
const BLOCK: usize = 4;

/// Largest absolute error of three channels.
fn greatest(off: [f64; 3]) -> f64 {
    off.into_iter().fold(0.0, |most: f64, off| most.max(off.abs()))
}

impl ErrorMap {
    /// Compares a frame with the truth. Returns `None` if their sizes differ, or if a list's length does not match the
    /// size.
    #[must_use]
    pub fn new(truth: &TruthFrame, shown: &Shown) -> Option<Self> {
        let pixels = truth.width as usize * truth.height as usize;
        let lengths = [truth.pixels.len(), shown.faces.len(), shown.shades.len()];
        if (truth.width, truth.height) != (shown.width, shown.height) || lengths != [pixels; 3] {
            return None;
        }
        let mut cover_errors = 0;
        let compare = |((right, face), shades): ((&Option<TruePixel>, &Option<Face>), &[f64; 3])| match right {
            Some(right) if Some(right.face) == *face => Some([0, 1, 2].map(|i| shades[i] - 255.0 * right.intensity[i])),
            right => {
                cover_errors += usize::from(right.is_some() || face.is_some());
                None
            }
        };
        let off = truth.pixels.iter().zip(&shown.faces).zip(&shown.shades).map(compare).collect();
        Some(Self { width: truth.width as usize, off, cover_errors })
    }

    /// Number of pixels that show the wrong face, or a face where there is none, or none where there is one.
    #[must_use]
    pub fn cover_errors(&self) -> usize {
        self.cover_errors
    }

    /// Share of the covered pixels that were not compared, 0 to 1: [`cover_errors`](Self::cover_errors) among all
    /// pixels that show a face, or should.
    #[must_use]
    pub fn share_not_compared(&self) -> f64 {
        let compared = self.errors().flatten().count();
        // Pixels: below 2⁵³.
        self.cover_errors as f64 / (self.cover_errors + compared).max(1) as f64
    }

    /// The error of each pixel, row-major, in shades; `None` where it was not compared.
    pub fn errors(&self) -> impl Iterator<Item = Option<f64>> {
        self.off.iter().map(|off| off.map(greatest))
    }

    /// Figures of all pixels that were compared.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let mut figures = Figures::default();
        self.errors().flatten().for_each(|error| figures.count(error));
        figures
    }

    /// Figures of the means of blocks of 4 × 4 pixels, counted from the frame's upper left corner. Only blocks whose 16
    /// pixels were all compared count.
    #[must_use]
    pub fn block_figures(&self) -> Figures {
        let mut figures = Figures::default();
        if self.width == 0 {
            return figures;
        }
        for rows in self.off.chunks_exact(BLOCK * self.width) {
            for x in (0..self.width / BLOCK * BLOCK).step_by(BLOCK) {
                let block = rows.chunks_exact(self.width).flat_map(|row| &row[x..x + BLOCK]);
                let sum = block.copied().try_fold([0.0; 3], |sum: [f64; 3], off| {
                    let off = off?;
                    Some([0, 1, 2].map(|i| sum[i] + off[i]))
                });
                if let Some(sum) = sum {
                    figures.count(greatest(sum.map(|sum| sum / (BLOCK * BLOCK) as f64)));
                }
            }
        }
        figures
    }

    /// Share of the compared pixels whose error is at most `shades`, 0 to 1; 1 if none were compared.
    #[must_use]
    pub fn share_within(&self, shades: f64) -> f64 {
        let (mut within, mut all) = (0_u32, 0_u32);
        for error in self.errors().flatten() {
            all += 1;
            within += u32::from(error <= shades);
        }
        if all == 0 { 1.0 } else { f64::from(within) / f64::from(all) }
    }

    /// Number of pixels in the largest patch whose errors all exceed `shades`. Pixels are connected to their neighbours
    /// on the left, right, above and below.
    #[must_use]
    pub fn largest_patch(&self, shades: f64) -> usize {
        let mut beyond: Vec<bool> = self.errors().map(|error| error.is_some_and(|error| error > shades)).collect();
        let mut largest = 0;
        let mut waiting = Vec::new();
        for start in 0..beyond.len() {
            let mut size = 0;
            waiting.push(start);
            while let Some(place) = waiting.pop() {
                if !core::mem::take(&mut beyond[place]) {
                    continue;
                }
                size += 1;
                let x = place % self.width;
                let neighbours = [
                    (x > 0).then(|| place - 1),
                    (x + 1 < self.width).then_some(place + 1),
                    place.checked_sub(self.width),
                    Some(place + self.width),
                ];
                waiting.extend(neighbours.into_iter().flatten().filter(|&place| place < beyond.len()));
            }
            largest = largest.max(size);
        }
        largest
    }
}

/// Figures of a set of errors, in shades.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Figures {
    /// Number of errors: one for each pixel or block compared.
    pub count: u64,
    /// The largest error.
    pub max: f64,
    /// Number of errors of 1 or more.
    pub by_one: u64,
    sum: f64,
    squares: f64,
}

impl Figures {
    fn count(&mut self, error: f64) {
        self.count += 1;
        self.max = self.max.max(error);
        self.by_one += u64::from(error >= 1.0);
        self.sum += error;
        self.squares += error * error;
    }

    /// Adds those of another frame.
    pub fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.max = self.max.max(other.max);
        self.by_one += other.by_one;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// The mean error; 0 if there are none.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.of_each(self.sum)
    }

    /// The root mean square; 0 if there are none.
    #[must_use]
    pub fn rms(&self) -> f64 {
        libm::sqrt(self.of_each(self.squares))
    }

    /// Share of errors of 1 or more, 0 to 1.
    #[must_use]
    pub fn share_by_one(&self) -> f64 {
        self.of_each(self.by_one as f64)
    }

    fn of_each(&self, sum: f64) -> f64 {
        // Pixels: below 2⁵³.
        if self.count == 0 { 0.0 } else { sum / self.count as f64 }
    }
}

/// Change of the errors from one frame to the next, which the eye sees as crawling.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Swim(Figures);

impl Swim {
    /// Adds the change from one frame to the next at every pixel that was compared in both. Frames of different sizes
    /// have no pixel in common.
    pub fn add(&mut self, before: &ErrorMap, now: &ErrorMap) {
        if (before.width, before.off.len()) != (now.width, now.off.len()) {
            return;
        }
        for (before, now) in before.off.iter().zip(&now.off) {
            if let (Some(before), Some(now)) = (before, now) {
                self.0.count(greatest([0, 1, 2].map(|i| now[i] - before[i])));
            }
        }
    }

    /// Adds those of other frames.
    pub fn join(&mut self, other: &Self) {
        self.0.add(&other.0);
    }

    /// The root mean square of the changes, in shades; 0 if there are none.
    #[must_use]
    pub fn rms(&self) -> f64 {
        self.0.rms()
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    const FACE: Face = Face { object: 0, triangle: 0 };

    /// A frame 8 pixels wide with these errors, `None` where the wrong face is seen.
    fn map(errors: &[Option<f64>]) -> ErrorMap {
        let height = (errors.len() / 8) as u32;
        let right = TruePixel { face: FACE, intensity: [100.0 / 255.0; 3], w: 1.0 };
        let truth = TruthFrame { width: 8, height, pixels: vec![Some(right); errors.len()] };
        let faces = errors.iter().map(|error| error.map(|_| FACE)).collect();
        let shades = errors.iter().map(|error| [100.0 + error.unwrap_or(99.0), 100.0, 100.0]).collect();
        ErrorMap::new(&truth, &Shown { width: 8, height, faces, shades }).expect("of one size")
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-9
    }

    #[test]
    fn figures_by_hand() {
        let mut errors = vec![Some(0.0); 32];
        errors[3] = Some(2.0);
        errors[9] = Some(-1.0);
        errors[31] = None;
        let map = map(&errors);
        assert_eq!((map.cover_errors(), map.share_not_compared()), (1, 1.0 / 32.0));
        let figures = map.figures();
        assert_eq!((figures.count, figures.by_one), (31, 2));
        assert!(close(figures.max, 2.0) && close(figures.mean(), 3.0 / 31.0));
        assert!(close(figures.rms(), libm::sqrt(5.0 / 31.0)) && close(figures.share_by_one(), 2.0 / 31.0));
        assert!(close(map.share_within(1.5), 30.0 / 31.0));
        // The right-hand block is incomplete; the left-hand one has 2 − 1 in 16 pixels.
        let blocks = map.block_figures();
        assert!(blocks.count == 1 && close(blocks.max, 1.0 / 16.0) && blocks.by_one == 0);
        let mut twice = figures;
        twice.add(&figures);
        assert!(twice.count == 62 && close(twice.mean(), figures.mean()) && close(twice.rms(), figures.rms()));
    }

    #[test]
    fn patches_are_connected_by_sides_and_not_round_the_edge() {
        let mut errors = vec![Some(0.0); 32];
        // Three in an L; one that touches them at a corner; the end of row 0 and the start of row 1.
        for place in [1, 9, 10, 19, 7, 8] {
            errors[place] = Some(-3.0);
        }
        let mut map = map(&errors);
        assert_eq!((map.largest_patch(2.9), map.largest_patch(3.1)), (4, 0), "1, 9, 10 and 8");
        map.off[8] = None;
        assert_eq!(map.largest_patch(2.9), 3);
    }

    #[test]
    fn swim_is_the_change_of_the_error() {
        let still = map(&[Some(5.0); 32]);
        let mut swim = Swim::default();
        swim.add(&still, &still);
        assert!(close(swim.rms(), 0.0), "an error that stays does not swim");
        let mut errors = [Some(5.0); 32];
        errors[0] = Some(-3.0);
        errors[1] = None;
        swim = Swim::default();
        swim.add(&still, &map(&errors));
        assert!(close(swim.rms(), libm::sqrt(64.0 / 31.0)));
    }

    #[test]
    fn frames_of_different_sizes_are_not_compared() {
        let truth = TruthFrame { width: 8, height: 1, pixels: vec![None; 8] };
        let shown = |width, count| Shown { width, height: 1, faces: vec![None; count], shades: vec![[0.0; 3]; count] };
        assert!(ErrorMap::new(&truth, &shown(8, 8)).is_some());
        assert!(ErrorMap::new(&truth, &shown(7, 7)).is_none() && ErrorMap::new(&truth, &shown(8, 7)).is_none());
    }
}
