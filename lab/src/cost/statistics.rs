//! Statistics of many time samples: quartiles, and ratios with their confidence intervals.

use mode13h_conformance::Random;

use super::Nanoseconds;

/// Number of resamples that an interval is computed from.
const RESAMPLES: usize = 1000;

/// Share of resamples beyond each end of an interval: it is a 95 % interval.
const TAIL: f64 = 0.025;

/// The quantile of sorted numbers at `share`, interpolated linearly; 0 for an empty list.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = share * last as f64;
    // At most `last`.
    let below = libm::floor(place) as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (place - below as f64)
}

fn sorted(numbers: &[f64]) -> Vec<f64> {
    let mut numbers: Vec<f64> = numbers.iter().copied().filter(|number| !number.is_nan()).collect();
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// The median; 0 for an empty list. NaN means not measured and is ignored.
pub(super) fn median(numbers: &[f64]) -> f64 {
    quantile(&sorted(numbers), 0.5)
}

/// Median and quartiles.
pub(super) fn quartiles(samples: &[f64]) -> Nanoseconds {
    let sorted = sorted(samples);
    Nanoseconds {
        median: quantile(&sorted, 0.5),
        lower_quartile: quantile(&sorted, 0.25),
        upper_quartile: quantile(&sorted, 0.75),
    }
}

/// A ratio of two times.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Ratio {
    /// Median of the ratios of all rounds.
    pub(super) median: f64,
    /// Interval that contains the median of 95 of 100 resamples of the rounds.
    pub(super) interval: (f64, f64),
}

impl Ratio {
    /// The ratio of `times` to `others`. Sample i of both comes from the same round, since whatever slows down a whole
    /// round slows both. Rounds in which either is NaN are ignored.
    ///
    /// The interval is that of the percentile bootstrap (Efron 1979): the same number of rounds, drawn with
    /// replacement, a thousand times.
    pub(super) fn new(times: &[f64], others: &[f64], chance: &mut Random) -> Self {
        let ratios: Vec<f64> = times.iter().zip(others).map(|(time, other)| time / other).collect();
        let ratios = sorted(&ratios);
        let count = ratios.len();
        if count == 0 {
            return Self { median: 1.0, interval: (1.0, 1.0) };
        }
        // The list is sorted, so only indices are drawn, and their order statistics looked up.
        let mut medians = Vec::with_capacity(RESAMPLES);
        let mut places = vec![0; count];
        for _ in 0..RESAMPLES {
            places.iter_mut().for_each(|place| *place = chance.below(count));
            let (low, &mut middle, _) = places.select_nth_unstable(count / 2);
            let below = if count.is_multiple_of(2) { low.iter().copied().max().unwrap_or(middle) } else { middle };
            medians.push((ratios[below] + ratios[middle]) / 2.0);
        }
        medians.sort_by(f64::total_cmp);
        Self { median: quantile(&ratios, 0.5), interval: (quantile(&medians, TAIL), quantile(&medians, 1.0 - TAIL)) }
    }

    /// Returns whether the interval contains 1, so that neither can be called faster.
    pub(super) fn cannot_be_told(&self) -> bool {
        self.interval.0 <= 1.0 && 1.0 <= self.interval.1
    }

    /// Width of the interval as a share of the ratio.
    pub(super) fn spread(&self) -> f64 {
        (self.interval.1 - self.interval.0) / self.median
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn quartiles_by_hand() {
        let five = quartiles(&[5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((five.lower_quartile, five.median, five.upper_quartile), (2.0, 3.0, 4.0));
        let four = quartiles(&[40.0, 10.0, 30.0, 20.0]);
        assert_eq!((four.lower_quartile, four.median, four.upper_quartile), (17.5, 25.0, 32.5));
        assert_eq!(quartiles(&[7.0]), Nanoseconds { median: 7.0, lower_quartile: 7.0, upper_quartile: 7.0 });
        assert_eq!(quartiles(&[]), Nanoseconds::default());
    }

    #[test]
    fn a_shuffle_loses_nothing_and_leaves_no_order_out() {
        let mut chance = Random::again(1);
        let mut seen = std::collections::BTreeMap::<[u8; 3], u32>::new();
        for _ in 0..6000 {
            let mut list = [1, 2, 3];
            chance.shuffle(&mut list);
            *seen.entry(list).or_default() += 1;
        }
        // Six orders, each 1000 times on average, with a standard deviation of √(6000 · 1/6 · 5/6) = 29.
        assert!(seen.len() == 6 && seen.values().all(|&times| (855..1145).contains(&times)), "{seen:?}");
    }

    /// The median of 401 rounds is at index 200. The index of the resampled median follows the binomial distribution:
    /// it is at most k if 201 or more of 401 draws are among the first k + 1. The probability of that is 0.012 at index
    /// 177, 0.020 at 179, 0.025 at 180, 0.032 at 181, and 0.049 at 183. An end computed from a thousand resamples is
    /// off by one index by chance; the mean of 40 ends by a sixth of one.
    #[test]
    fn the_interval_is_that_of_the_binomial_law() {
        let times: Vec<f64> = (0..401).map(|i| 1000.0 + f64::from(i)).collect();
        let (mut low, mut high) = (0.0, 0.0);
        for seed in 0..40 {
            let ratio = Ratio::new(&times, &[1000.0; 401], &mut Random::again(seed));
            assert!(close(ratio.median, 1.2));
            // The ends of the interval as indices.
            low += (ratio.interval.0 - 1.0) * 1000.0 / 40.0;
            high += (ratio.interval.1 - 1.0) * 1000.0 / 40.0;
        }
        assert!((179.0..=181.0).contains(&low) && (219.0..=221.0).contains(&high), "{low} to {high}");
    }

    #[test]
    fn a_ratio_is_taken_round_by_round() {
        // Some rounds are ten times as slow as others; the second is always half of the first.
        let times = [10.0, 100.0, 12.0, 90.0, 11.0];
        let halves = times.map(|time| time / 2.0);
        let ratio = Ratio::new(&times, &halves, &mut Random::again(3));
        assert_eq!(ratio, Ratio { median: 2.0, interval: (2.0, 2.0) });
        assert!(!ratio.cannot_be_told() && close(ratio.spread(), 0.0));
        let sat_out = [20.0, f64::NAN, 36.0, f64::NAN, f64::NAN];
        assert!(close(Ratio::new(&sat_out, &times, &mut Random::again(3)).median, 2.5), "2 and 3");
        assert!(close(quartiles(&sat_out).median, 28.0));
    }

    #[test]
    fn what_differs_by_chance_cannot_be_told_apart() {
        let mut chance = Random::again(4);
        let mut noise =
            |mean: f64| -> Vec<f64> { (0..101).map(|_| mean + chance.below(1000) as f64 / 100.0).collect() };
        let (a, b, slower) = (noise(100.0), noise(100.0), noise(110.0));
        assert!(Ratio::new(&a, &b, &mut Random::again(5)).cannot_be_told());
        assert!(!Ratio::new(&slower, &a, &mut Random::again(5)).cannot_be_told());
        assert!(Ratio::new(&[], &[], &mut Random::again(5)).cannot_be_told());
    }

    /// The interval contains 1 for about 95 of a hundred pairs with equal times: for at least 88, three standard
    /// deviations less.
    #[test]
    fn the_interval_holds_the_truth_as_often_as_it_says() {
        let mut chance = Random::again(6);
        let mut held = 0;
        for _ in 0..100 {
            let mut times = || -> Vec<f64> { (0..41).map(|_| 1000.0 + chance.below(1000) as f64).collect() };
            let (a, b) = (times(), times());
            held += u32::from(Ratio::new(&a, &b, &mut chance).cannot_be_told());
        }
        assert!((88..=100).contains(&held), "{held}");
    }
}
