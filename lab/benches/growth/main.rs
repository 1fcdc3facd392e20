//! How the time and memory of a frame grow: with faces, with pixels per triangle, with lights.
//!
//! ```text
//! cargo bench --bench growth
//! cargo bench --bench growth -- --most 10000000       # faces; without it 10⁶; 10⁷ need 2 GB of memory
//! ```
//!
//! Every round times every case once, and a figure is the median over the rounds; ratios compare times of the same
//! round. The exponent of growth is the slope of the least-squares line through the logarithms: 1 means proportional
//! time.

mod case;
#[expect(dead_code, reason = "other benchmarks use the rest")]
#[path = "../../../benches/interleaved/mod.rs"]
mod interleaved;
mod series;
#[path = "../../../benches/interleaved/thread_time.rs"]
mod thread_time;

use std::hint::black_box;

use case::Case;
use series::Series;
use thread_time::seconds;

/// Greatest ratio allowed of the time per face at 10⁶ faces to that at 10⁴.
const MAX_GROWTH: f64 = 1.5;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    // Under `cargo test` the benchmark only has to run.
    let is_bench = interleaved::is_bench();
    let most = match words.iter().position(|word| word == "--most") {
        Some(at) => words.get(at + 1).and_then(|word| word.parse().ok()).expect("--most takes a number of faces"),
        None if !is_bench => 3_000,
        None => 1_000_000,
    };
    let rounds = if is_bench { 15 } else { 1 };

    let spheres = case::spheres(most);
    println!("memory, bytes a face");
    println!("{:>10} {:>10} {:>14} {:>10} {:>10}", "faces", "mesh", "while built", "object", "renderer");
    for sphere in &spheres {
        let [mesh, peak, object, renderer] = sphere.bytes_a_face();
        println!("{:>10} {mesh:>10.1} {peak:>14.1} {object:>10.1} {renderer:>10.1}", sphere.faces);
    }

    let mut all = [
        Series::new("faces, 320 x 200 pixels", "faces", "face", case::faces(&spheres)),
        Series::new("faces, 4 pixels to each drawn", "faces", "face", case::faces_of_equal_size(&spheres)),
        Series::new("pixels a triangle", "pixels", "triangle", case::pixels()),
        Series::new("suns", "suns", "frame", case::lights(case::sun)),
        Series::new("lamps", "lamps", "frame", case::lights(case::lamp)),
    ];
    let mut cases: Vec<&mut Case> = all.iter_mut().flat_map(|series| &mut series.cases).collect();
    for case in &mut cases {
        // The first frame, which allocates memory, and one to find out how many frames take 2 ms.
        case.draw();
        let time = seconds(|| _ = case.draw());
        case.repeats = if is_bench { (2e-3 / time.max(1e-9)).clamp(1.0, 10_000.0) as u32 } else { 1 };
    }
    let times = interleaved::times_by(cases.len(), rounds, |_, which| {
        let repeats = cases[which].repeats;
        let time = seconds(|| (0..repeats).for_each(|_| _ = black_box(cases[which].draw())));
        time * 1e9 / f64::from(repeats)
    });
    cases.iter_mut().zip(times).for_each(|(case, times)| case.times = times);
    println!("\nmedian of {rounds} rounds");
    all.iter().for_each(Series::print);

    println!();
    for (series, both_ways) in [(&all[0], false), (&all[1], true)] {
        let Some(growth) = series.growth(1e4, 1e6) else { continue };
        let kept = growth <= MAX_GROWTH && (!both_ways || growth >= 1.0 / MAX_GROWTH);
        let least = if both_ways { format!("{:.2} to ", 1.0 / MAX_GROWTH) } else { "at most ".to_string() };
        println!(
            "{}: ns a face at 10^6 are {growth:.2} x those at 10^4 ({least}{MAX_GROWTH}: {})",
            series.title,
            if kept { "kept" } else { "NOT KEPT" }
        );
    }
}
