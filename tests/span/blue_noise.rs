//! The blue-noise mask: how it is made, and what makes it blue.

use mode13h::internals::span::dither::DitherPattern;
use mode13h_conformance::Random;

const SIDE: usize = 64;
const PIXELS: usize = SIDE * SIDE;

/// Distance to a pixel along each axis beyond which its weight is 0.
const REACH: usize = 10;

/// Weights of neighbours by squared distance: e^(−d² / 2σ²) with σ = 1.5 in units of 2⁻³², computed by integer
/// multiplications so that every machine gets the same.
fn weights() -> Vec<u64> {
    // 2³² · e^(−1 / 4.5), rounded.
    const FACTOR: u64 = 3_439_140_958;
    core::iter::successors(Some(1_u64 << 32), |weight| Some((weight * FACTOR) >> 32))
        .take(2 * REACH * REACH + 1)
        .collect()
}

/// Some pixels of a torus, and how crowded it is around every pixel.
#[derive(Clone)]
struct Crowd {
    is_in: Vec<bool>,
    /// For each pixel the sum of the weights of those in the crowd.
    density: Vec<u64>,
    weights: Vec<u64>,
}

impl Crowd {
    fn new() -> Self {
        Self { is_in: vec![false; PIXELS], density: vec![0; PIXELS], weights: weights() }
    }

    fn flip(&mut self, pixel: usize) {
        self.is_in[pixel] ^= true;
        let (x, y) = (pixel % SIDE, pixel / SIDE);
        for j in 0..=2 * REACH {
            for i in 0..=2 * REACH {
                let at = (y + SIDE + j - REACH) % SIDE * SIDE + (x + SIDE + i - REACH) % SIDE;
                let weight = self.weights[i.abs_diff(REACH).pow(2) + j.abs_diff(REACH).pow(2)];
                if self.is_in[pixel] { self.density[at] += weight } else { self.density[at] -= weight }
            }
        }
    }

    /// The pixel in the crowd where it is densest; the first of several.
    fn cluster(&self) -> usize {
        (0..PIXELS)
            .filter(|&pixel| self.is_in[pixel])
            .min_by_key(|&pixel| u64::MAX - self.density[pixel])
            .expect("a crowd")
    }

    /// The pixel not in the crowd where it is thinnest; the first of several.
    fn void(&self) -> usize {
        (0..PIXELS).filter(|&pixel| !self.is_in[pixel]).min_by_key(|&pixel| self.density[pixel]).expect("a void")
    }
}

/// Ranks of all pixels by the void-and-cluster method.
///
/// Its third phase, which fills the densest clusters of the remaining pixels, is the second one here: on a torus the
/// densities of a crowd and of all other pixels add up to the same sum at every pixel.
fn void_and_cluster() -> Vec<usize> {
    let mut random = Random::seeded(13, "blue noise");
    let mut crowd = Crowd::new();
    // A tenth of the pixels, moved from clusters into voids until each would come back.
    while crowd.is_in.iter().filter(|is_in| **is_in).count() < PIXELS / 10 {
        let pixel = random.below(PIXELS);
        if !crowd.is_in[pixel] {
            crowd.flip(pixel);
        }
    }
    loop {
        let from = crowd.cluster();
        crowd.flip(from);
        let to = crowd.void();
        crowd.flip(to);
        if from == to {
            break;
        }
    }
    let mut ranks = vec![0; PIXELS];
    let mut thinned = crowd.clone();
    for rank in (0..PIXELS / 10).rev() {
        let pixel = thinned.cluster();
        thinned.flip(pixel);
        ranks[pixel] = rank;
    }
    for rank in PIXELS / 10..PIXELS {
        let pixel = crowd.void();
        crowd.flip(pixel);
        ranks[pixel] = rank;
    }
    ranks
}

fn mask(pattern: DitherPattern) -> Vec<u8> {
    (0..PIXELS).map(|pixel| pattern.thresholds().row(pixel / SIDE).at(pixel % SIDE)).collect()
}

/// With `MODE13H_UPDATE=1` the file is written, and the test always fails.
#[test]
fn the_mask_is_void_and_cluster() {
    // 4,096 ranks on 256 thresholds.
    let made: Vec<u8> = void_and_cluster().iter().map(|rank| (rank >> 4) as u8).collect();
    if std::env::var_os("MODE13H_UPDATE").is_some() {
        std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/src/span/blue_noise.bin"), &made).expect("it is writable");
        panic!("written; run the test again without the variable");
    }
    assert!(mask(DitherPattern::BlueNoise) == made);
}

#[test]
fn every_threshold_comes_as_often() {
    let mask = mask(DitherPattern::BlueNoise);
    for threshold in 0..=255 {
        assert_eq!(mask.iter().filter(|t| **t == threshold).count(), PIXELS / 256, "{threshold}");
    }
}

/// The variance of the means of all blocks of `side` × `side`, which wrap around.
fn variance_of_blocks(values: &[f64], side: usize) -> f64 {
    let mean = values.iter().sum::<f64>() / PIXELS as f64;
    let block = |pixel: usize| {
        let sum: f64 = (0..side * side)
            .map(|i| values[(pixel / SIDE + i / side) % SIDE * SIDE + (pixel % SIDE + i % side) % SIDE])
            .sum();
        sum / (side * side) as f64 - mean
    };
    (0..PIXELS).map(|pixel| block(pixel).powi(2)).sum::<f64>() / PIXELS as f64
}

/// Low frequencies are what remains in a mean over 4 × 4 or 8 × 8 pixels. The mask has less of them than the same
/// thresholds in any of ten random orders, and the same holds for the pixels below any one threshold.
#[test]
fn its_low_frequencies_are_below_those_of_white_noise() {
    let mask = mask(DitherPattern::BlueNoise);
    let mut random = Random::named("white noise");
    let orders: Vec<Vec<u8>> = (0..10)
        .map(|_| {
            let mut order = mask.clone();
            random.shuffle(&mut order);
            order
        })
        .collect();
    let check = |what: &str, value: &dyn Fn(u8) -> f64| {
        let energy = |mask: &[u8], side| variance_of_blocks(&mask.iter().map(|t| value(*t)).collect::<Vec<_>>(), side);
        for side in [4, 8] {
            let (own, white) =
                (energy(&mask, side), orders.iter().map(|order| energy(order, side)).fold(f64::MAX, f64::min));
            println!("{what}, {side} x {side}: {:.3} of white noise", own / white);
            assert!(own < white, "{what}, {side} x {side}: {own} {white}");
        }
    };
    check("thresholds", &f64::from);
    for level in [32, 64, 128, 192, 224] {
        check(&format!("below {level}"), &|t| f64::from(u8::from(t < level)));
    }
}

/// Ordered dither repeats after 8 pixels, blue noise does not: shifted by 8 it is uncorrelated with itself.
#[test]
fn it_has_no_period_of_eight() {
    let correlation = |pattern| {
        let values: Vec<f64> = mask(pattern).iter().map(|t| f64::from(*t) - 127.5).collect();
        let product =
            |shift: usize| (0..PIXELS).map(|i| values[i] * values[i / SIDE * SIDE + (i + shift) % SIDE]).sum::<f64>();
        product(8) / product(0)
    };
    assert_eq!(correlation(DitherPattern::Ordered), 1.0);
    assert!(correlation(DitherPattern::BlueNoise).abs() < 0.1);
}
