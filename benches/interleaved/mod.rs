//! Times candidates side by side: a machine's speed drifts, so each round times all of them, in a new order.

use std::time::Instant;

use mode13h_conformance::Random;

/// Returns whether this runs under `cargo bench`; otherwise a benchmark only has to run.
pub(crate) fn is_bench() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

/// The times of `candidates` in wall-clock seconds, one per round each: how long `run` takes with the candidate's
/// index.
pub(crate) fn times(candidates: usize, rounds: usize, mut run: impl FnMut(usize)) -> Vec<Vec<f64>> {
    times_by(candidates, rounds, |_, candidate| {
        let started = Instant::now();
        run(candidate);
        started.elapsed().as_secs_f64()
    })
}

/// The times of `candidates`, one per round each: what `time` returns for a round and a candidate.
pub(crate) fn times_by(candidates: usize, rounds: usize, mut time: impl FnMut(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let (mut random, mut order) = (Random::again(13), (0..candidates).collect::<Vec<usize>>());
    let mut times = vec![Vec::with_capacity(rounds); candidates];
    for round in 0..rounds {
        random.shuffle(&mut order);
        for &candidate in &order {
            times[candidate].push(time(round, candidate));
        }
    }
    times
}

/// The median; for an even count the upper of the middle two.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
