//! Every span kernel and `slice::fill` at the lengths that spans have.
//!
//! ```text
//! cargo bench --bench spans              criterion, then the table
//! cargo bench --bench spans -- table     the table alone
//! ```
//!
//! Criterion measures one kernel after the other, and a machine's speed drifts between them. So
//! ratios come from the table at the end: there each round times every kernel once, in a new
//! order, and the figure is the median over the rounds.

use criterion::{BenchmarkId, Criterion, Throughput};
use mode13h::span::Kernel;
use std::hint::black_box;
use std::time::{Duration, Instant};

const LENGTHS: [usize; 15] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 100, 160, 320];
/// Spans in a batch: one from each place in a cache line, as spans start anywhere.
const SPANS: usize = 64;

/// What is timed: a kernel, or the memset that a flat span would be.
#[derive(Clone, Copy)]
enum Candidate {
    Fill,
    Kernel(Kernel),
}

impl Candidate {
    fn all() -> Vec<Self> {
        // `simd` is one of the levels under another name, but the one that people get.
        [Self::Fill].into_iter().chain(Kernel::available().map(Self::Kernel)).collect()
    }

    fn name(self) -> String {
        match self {
            Self::Fill => "fill".to_owned(),
            Self::Kernel(kernel) => kernel.to_string(),
        }
    }

    /// Draws the spans, one after the other.
    #[inline(never)]
    fn draw(self, pixels: &mut Pixels, spans: &[Span; SPANS]) {
        match self {
            Self::Fill => {
                for span in spans {
                    pixels.0[span.start..span.start + span.length].fill(span.shade as u8); // its low byte, any would do
                }
            }
            Self::Kernel(kernel) => {
                for span in spans {
                    kernel.fill(&mut pixels.0[span.start..span.start + span.length], span.shade, span.step);
                }
            }
        }
    }
}

/// What a renderer hands to a kernel, and where.
#[derive(Clone, Copy)]
struct Span {
    start: usize,
    length: usize,
    shade: u16,
    step: u16,
}

/// Spans of these lengths, one from each place in a cache line.
fn spans(mut length: impl FnMut() -> usize) -> [Span; SPANS] {
    black_box(std::array::from_fn(|i| Span { start: i * 13 % 64, length: length(), shade: 0x1234, step: 0x56 }))
}

/// 320 pixels and room for every start, the first at the head of a cache line.
#[repr(align(64))]
struct Pixels([u8; 320 + 64]);

fn main() {
    let mut pixels = Pixels([0; 384]);
    if !std::env::args().any(|argument| argument == "table") {
        let mut criterion = Criterion::default()
            .sample_size(30)
            .warm_up_time(Duration::from_millis(100))
            .measurement_time(Duration::from_millis(400))
            .configure_from_args();
        for length in LENGTHS {
            let mut group = criterion.benchmark_group(format!("spans/{length}"));
            let batch = spans(|| length);
            group.throughput(Throughput::Elements((SPANS * length) as u64));
            for contender in Candidate::all() {
                group.bench_function(BenchmarkId::from_parameter(contender.name()), |bencher| {
                    bencher.iter(|| contender.draw(&mut pixels, &batch));
                });
            }
            group.finish();
        }
        criterion.final_summary();
    }
    // `cargo bench` passes --bench; under `cargo test` the benches only have to run.
    let measured = std::env::args().any(|argument| argument == "--bench" || argument == "table");
    let rounds = if measured { 201 } else { 1 };
    table(&mut pixels, rounds);
}

/// Median time of a span, ns, all contenders side by side.
fn table(pixels: &mut Pixels, rounds: usize) {
    let contenders = Candidate::all();
    println!("\nns per span, median of {rounds} rounds, every round all kernels in turn");
    print!("{:>10}", "pixels");
    for contender in &contenders {
        print!("{:>14}", contender.name());
    }
    println!("{:>12}{:>11}", "simd÷fill", "asm÷simd");
    // Beside the fixed lengths spans of 1 to 16 and of 1 to 64 in a random order, which branches cannot foresee.
    let mut state = 13_u32;
    let mut drawn = |most: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        1 + (state >> 16) as usize % most
    };
    let mut rows: Vec<(String, Vec<[Span; SPANS]>)> =
        LENGTHS.iter().map(|&length| (length.to_string(), vec![spans(|| length)])).collect();
    for most in [16, 64] {
        rows.push((format!("1 to {most}"), (0..100).map(|_| spans(|| drawn(most))).collect()));
    }
    for (name, batches) in rows {
        let turns = batches.len().max(1_000 / batches[0][0].length.max(10));
        let mut times = vec![Vec::new(); contenders.len()];
        for round in 0..rounds {
            for i in 0..contenders.len() {
                // 7 and the number of contenders have no common factor but when there are 7.
                let which = (i * 7 + round) % contenders.len();
                let started = Instant::now();
                for batch in batches.iter().cycle().take(turns) {
                    contenders[which].draw(pixels, batch);
                }
                times[which].push(started.elapsed().as_secs_f64() * 1e9 / (turns * SPANS) as f64);
            }
        }
        let medians: Vec<f64> = times.into_iter().map(median).collect();
        let of = |wanted: &str| {
            let at = contenders.iter().position(|c| matches!(c, Candidate::Kernel(k) if k.name() == wanted));
            at.map_or(f64::NAN, |i| medians[i])
        };
        print!("{name:>10}");
        for time in &medians {
            print!("{time:>14.2}");
        }
        println!("{:>12.2}{:>11.2}", of("simd") / medians[0], of("asm") / of("simd"));
    }
}

fn median(mut samples: Vec<f64>) -> f64 {
    samples.sort_by(f64::total_cmp);
    samples[samples.len() / 2]
}
