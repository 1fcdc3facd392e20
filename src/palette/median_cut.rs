//! Median cut: reduces many colours to a few.
//!
//! After Heckbert ("Color image quantization for frame buffer display", SIGGRAPH 1982): a box
//! around all colours is cut in two, then one of the two, and so on; each box becomes the mean of
//! its colours. Heckbert cuts the longest side of the fullest box at the median. Here each cut is
//! the one, among all boxes, axes and positions, that lowers the sum of squared distances most
//! (after Wu, "Efficient statistical computations for optimal color quantization", Graphics Gems
//! II, 1991).
//!
//! Crates for this (`quantette`, `imagequant`, `color_quant`) need `std`, use randomness, or do not report the gain of
//! the next cut, which palettes made for a scene need.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::Rgb;

/// Median cut: reduces weighted colours to a few, box by box.
#[derive(Clone, Debug)]
pub struct MedianCut {
    /// Colours with their weights, grouped by box.
    colors: Vec<(Rgb, u32)>,
    boxes: Vec<ColorBox>,
}

#[derive(Clone, Debug)]
struct ColorBox {
    range: Range<usize>,
    moments: Moments,
    /// The best cut; `None` if there is only one colour.
    cut: Option<Cut>,
}

/// The best cut through a box.
#[derive(Clone, Copy, Debug)]
struct Cut {
    channel: usize,
    /// The least value in the upper part.
    from: u8,
    /// The decrease of the weighted sum of squared distances.
    gain: f64,
}

/// The weighted sums of red, green and blue, and the total weight.
type Moments = [u64; 4];

impl MedianCut {
    /// Makes one box around weighted colours. Colours without weight are dropped, as are all beyond
    /// the first 2²⁴, so that no sum exceeds 2⁶⁴.
    #[must_use]
    pub fn new(mut colors: Vec<(Rgb, u32)>) -> Self {
        colors.retain(|&(_, weight)| weight > 0);
        colors.truncate(1 << 24);
        let whole = 0..colors.len();
        let boxes = if colors.is_empty() { Vec::new() } else { vec![ColorBox::new(&colors, whole)] };
        Self { colors, boxes }
    }

    /// The box with the best cut; the first if several are equally good.
    fn best(&self) -> Option<(usize, Cut)> {
        let cuts = self.boxes.iter().enumerate().filter_map(|(i, b)| Some((i, b.cut?)));
        cuts.reduce(|best, next| if next.1.gain > best.1.gain { next } else { best })
    }

    /// The amount by which the next cut lowers the sum of weight × squared distance to the mean.
    /// `None` if every colour has a box of its own.
    pub fn gain(&self) -> Option<f64> {
        self.best().map(|(_, cut)| cut.gain)
    }

    /// Makes the next cut. Returns whether there was one.
    pub fn cut(&mut self) -> bool {
        let Some((i, cut)) = self.best() else { return false };
        let range = self.boxes[i].range.clone();
        let part = &mut self.colors[range.clone()];
        let mut middle = range.start;
        for i in 0..part.len() {
            if channels(part[i].0)[cut.channel] < cut.from {
                part.swap(i, middle - range.start);
                middle += 1;
            }
        }
        self.boxes[i] = ColorBox::new(&self.colors, range.start..middle);
        self.boxes.push(ColorBox::new(&self.colors, middle..range.end));
        true
    }

    /// Cuts until there are `boxes` boxes, or one for each distinct colour.
    pub fn cut_to(&mut self, boxes: usize) {
        while self.boxes.len() < boxes && self.cut() {}
    }

    /// Counts the boxes.
    pub fn boxes(&self) -> usize {
        self.boxes.len()
    }

    /// The mean colour of each box, each channel rounded to the nearest; the colour itself for a box of one colour.
    pub fn means(&self) -> impl Iterator<Item = Rgb> + '_ {
        self.boxes.iter().map(|b| mean(b.moments))
    }
}

impl ColorBox {
    fn new(colors: &[(Rgb, u32)], range: Range<usize>) -> Self {
        // The moments at each value of each channel.
        let mut by_value = vec![[[0; 4]; 256]; 3];
        let mut moments = [0; 4];
        for &(color, weight) in &colors[range.clone()] {
            let [r, g, b] = channels(color);
            let one = [r, g, b, 1].map(|v| u64::from(v) * u64::from(weight));
            add(&mut moments, one);
            for (values, v) in by_value.iter_mut().zip([r, g, b]) {
                add(&mut values[usize::from(v)], one);
            }
        }
        let mut best: Option<Cut> = None;
        for (channel, values) in by_value.iter().enumerate() {
            let mut lower = [0; 4];
            for (from, value) in (1..=255).zip(values) {
                add(&mut lower, *value);
                let upper = [0, 1, 2, 3].map(|i| moments[i] - lower[i]);
                if value[3] == 0 || upper[3] == 0 {
                    continue;
                }
                let gain = gain_between(lower, upper);
                if best.is_none_or(|best| gain > best.gain) {
                    best = Some(Cut { channel, from, gain });
                }
            }
        }
        Self { range, moments, cut: best }
    }
}

fn add(sums: &mut Moments, more: Moments) {
    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// The sum of squares about the common mean minus that about two separate means: W₁·W₂/(W₁ + W₂) times the squared
/// distance between the two means.
fn gain_between(a: Moments, b: Moments) -> f64 {
    let (w1, w2) = (a[3] as f64, b[3] as f64);
    let d = [0, 1, 2].map(|i| a[i] as f64 / w1 - b[i] as f64 / w2);
    w1 * w2 / (w1 + w2) * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
}

fn mean(moments: Moments) -> Rgb {
    let weight = moments[3];
    // At most 255, like every colour. The sums are below 2⁶⁴, so doubling them could overflow.
    let [r, g, b, _] = moments.map(|sum| ((sum + weight / 2) / weight.max(1)) as u8);
    Rgb::new(r, g, b)
}

fn channels(color: Rgb) -> [u8; 3] {
    [color.r, color.g, color.b]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of weight × squared distance to the mean, exactly: Σw·c² − (Σw·c)²/Σw, times Σw.
    fn squares_times_weight(colors: &[(Rgb, u32)]) -> i128 {
        let sum = |of: &dyn Fn([u8; 3], i128) -> i128| -> i128 {
            colors.iter().map(|&(color, weight)| of(channels(color), i128::from(weight))).sum()
        };
        let weight = sum(&|_, w| w);
        (0..3)
            .map(|i| weight * sum(&|c, w| w * i128::from(c[i]).pow(2)) - sum(&|c, w| w * i128::from(c[i])).pow(2))
            .sum()
    }

    fn squares(colors: &[(Rgb, u32)]) -> f64 {
        let weight: f64 = colors.iter().map(|&(_, weight)| f64::from(weight)).sum();
        squares_times_weight(colors) as f64 / weight
    }

    fn hashed(count: u32, seed: u32) -> Vec<(Rgb, u32)> {
        let hash =
            |i: u32| (i + 1).wrapping_mul(0x9E37_79B9).wrapping_add(seed).wrapping_mul(0x85EB_CA6B).rotate_left(13);
        (0..count).map(|i| (Rgb::from_u32(hash(i)), hash(i + count) >> 24)).collect()
    }

    /// The first cut, against every way to split the colours by the value of one channel.
    #[test]
    fn the_cut_is_the_one_that_lowers_the_squares_most() {
        for seed in 0..50 {
            let colors: Vec<_> = hashed(20, seed).into_iter().filter(|&(_, weight)| weight > 0).collect();
            let best = (0..3)
                .flat_map(|channel| (1..=255_u8).map(move |from| (channel, from)))
                .filter_map(|(channel, from)| {
                    let (upper, lower): (Vec<_>, Vec<_>) =
                        colors.iter().partition(|(color, _)| channels(*color)[channel] >= from);
                    (!upper.is_empty() && !lower.is_empty()).then(|| squares(&upper) + squares(&lower))
                })
                .fold(f64::INFINITY, f64::min);
            let mut cut = MedianCut::new(colors.clone());
            let gain = cut.gain().expect("different colours");
            // Sums of 20 terms below 2²⁴, with a relative error of 2⁻⁵³ per operation.
            assert!((squares(&colors) - best - gain).abs() < 1e-6, "{gain}");
            assert!(cut.cut());
            let after: f64 = cut.boxes.iter().map(|b| squares(&cut.colors[b.range.clone()])).sum();
            assert!((after - best).abs() < 1e-6);
        }
    }

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let colors = hashed(40, 7);
        let mut expected: Vec<Rgb> = colors.iter().filter(|(_, weight)| *weight > 0).map(|(color, _)| *color).collect();
        let mut cut = MedianCut::new(colors);
        cut.cut_to(256);
        let mut means: Vec<Rgb> = cut.means().collect();
        expected.sort();
        means.sort();
        assert_eq!(means, expected);
        assert!(cut.gain().is_none() && !cut.cut());
    }

    #[test]
    fn nothing_has_no_colours() {
        let mut cut = MedianCut::new(vec![(Rgb::WHITE, 0)]);
        cut.cut_to(4);
        assert_eq!((cut.boxes(), cut.means().count()), (0, 0));
    }
}
