//! Every span kernel and `slice::fill` at typical span lengths: `cargo bench --bench spans`.

mod interleaved;

use std::hint::black_box;

use mode13h::span::Kernel;
use mode13h_conformance::Random;

const LENGTHS: [usize; 15] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 100, 160, 320];
/// Spans per batch: one for each offset in a cache line, as spans start anywhere.
const SPANS: usize = 64;

/// A contender: a kernel, or the memset of a flat span.
#[derive(Clone, Copy)]
enum Candidate {
    Fill,
    Kernel(Kernel),
}

impl Candidate {
    fn all() -> Vec<Self> {
        // `simd` is one of the levels under another name, but the one that users get.
        [Self::Fill].into_iter().chain(Kernel::available().map(Self::Kernel)).collect()
    }

    fn name(self) -> String {
        match self {
            Self::Fill => "fill".to_owned(),
            Self::Kernel(kernel) => kernel.to_string(),
        }
    }

    /// Draws the spans one after another.
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

/// What a renderer passes to a kernel, and where it draws.
#[derive(Clone, Copy)]
struct Span {
    start: usize,
    length: usize,
    shade: u16,
    step: u16,
}

/// Spans of these lengths, one for each offset in a cache line.
fn spans(mut length: impl FnMut() -> usize) -> [Span; SPANS] {
    black_box(std::array::from_fn(|i| Span { start: i * 13 % 64, length: length(), shade: 0x1234, step: 0x56 }))
}

/// 320 pixels and room for every start offset, beginning at a cache line.
#[repr(align(64))]
struct Pixels([u8; 320 + 64]);

fn main() {
    let mut pixels = Pixels([0; 384]);
    let rounds = if interleaved::is_bench() { 201 } else { 1 };
    table(&mut pixels, rounds);
}

/// Median time per span in nanoseconds, with all contenders interleaved.
fn table(pixels: &mut Pixels, rounds: usize) {
    let contenders = Candidate::all();
    println!("\nns per span, median of {rounds} rounds, every round all kernels in turn");
    print!("{:>10}", "pixels");
    for contender in &contenders {
        print!("{:>14}", contender.name());
    }
    println!("{:>12}{:>11}", "simd÷fill", "asm÷simd");
    // Besides the fixed lengths, spans of 1 to 16 and of 1 to 64 in random order, which branch prediction cannot
    // foresee.
    let mut random = Random::again(13);
    let mut drawn = |most: usize| 1 + random.below(most);
    let mut rows: Vec<(String, Vec<[Span; SPANS]>)> =
        LENGTHS.iter().map(|&length| (length.to_string(), vec![spans(|| length)])).collect();
    for most in [16, 64] {
        rows.push((format!("1 to {most}"), (0..100).map(|_| spans(|| drawn(most))).collect()));
    }
    for (name, batches) in rows {
        let turns = batches.len().max(1_000 / batches[0][0].length.max(10));
        let times = interleaved::times(contenders.len(), rounds, |which| {
            for batch in batches.iter().cycle().take(turns) {
                contenders[which].draw(pixels, batch);
            }
        });
        let nanoseconds = |times| interleaved::median(times) * 1e9 / (turns * SPANS) as f64;
        let medians: Vec<f64> = times.into_iter().map(nanoseconds).collect();
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
