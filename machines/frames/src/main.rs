//! Draws the conformance frames with every kernel that the machine supports, and prints a line for each kernel: the
//! number of frames, one hash for all, and the names of those that differ from every other machine. It takes these
//! arguments:
//!
//! | argument | what |
//! |---|---|
//! | `step=N` | draws every N-th frame, for slow machines |
//! | `kernel=NAME` | draws with this kernel only |
//! | `frame=NAME` | prints the pixels of one frame, a line of hexadecimal digits for each row |
//! | `loops` | checks every pixel loop against its definition, and draws no frame |
//!
//! The status is 1 if a frame or a loop is wrong.
#![cfg_attr(not(feature = "std"), no_std, no_main)]

extern crate alloc;

#[cfg(not(feature = "std"))]
mod heap;
mod system;

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use mode13h::render::Renderer;
use mode13h::span::Kernel;
use mode13h_conformance::frames::{self, Frame};
use mode13h_conformance::hash::START;
use mode13h_conformance::loops::{self, Cases};

/// The seed of the loops' cases, the same as in `mode13h verify`.
const SEED: u64 = 13;
/// The most wrong frames named per kernel, since one fault shows in many.
const MOST_NAMED: usize = 8;

/// Runs what the arguments ask for. Returns whether nothing is wrong.
fn run(words: &str) -> bool {
    // `simd` is one of the following levels under another name, so they are drawn with once.
    let kernels = Kernel::available().filter(|kernel| kernel.name() != "simd");
    let (mut step, mut kernels, mut name) = (1, kernels.collect::<Vec<_>>(), None);
    for word in words.split_ascii_whitespace() {
        match word.split_once('=') {
            None if word == "loops" => return check_loops(),
            Some(("step", number)) if number.parse().is_ok_and(|number: usize| number > 0) => {
                step = number.parse().unwrap_or(1);
            }
            Some(("frame", of)) => name = Some(of),
            Some(("kernel", name)) => match name.parse::<Kernel>() {
                Ok(kernel) => kernels = [kernel].into(),
                Err(error) => {
                    system::print(&format!("{name}: {error}\n"));
                    return false;
                }
            },
            _ => {
                system::print(&format!("{word}: no such word; there are step=N, kernel=NAME, frame=NAME and loops\n"));
                return false;
            }
        }
    }
    let all = frames::all();
    let drawn = kernels.into_iter().map(|kernel| match name {
        Some(name) => print_pixels(kernel, all.iter().find(|frame| frame.name == name)),
        None => draw(kernel, all.iter().step_by(step)),
    });
    drawn.fold(true, |passed, right| passed & right)
}

/// Draws frames with a kernel. Returns whether all match those of every machine.
fn draw<'a>(kernel: Kernel, frames: impl Iterator<Item = &'a Frame>) -> bool {
    // One renderer for all frames: its caches must not show.
    let (mut renderer, mut count, mut hash, mut wrong) = (Renderer::new(), 0_usize, START, Vec::new());
    for frame in frames {
        count += 1;
        if cfg!(target_os = "none") {
            // A chip has no room for the cache.
            renderer = Renderer::new();
        }
        let drawn = frame.draw_by(&mut renderer, kernel);
        if let Ok(drawn) = &drawn {
            hash = frames::combined(hash, drawn);
        }
        if drawn.is_err() || drawn.ok().map(|drawn| drawn.hash) != frame.expected() {
            wrong.push(frame.name.as_str());
        }
    }
    let verdict = match wrong.len() {
        0 => "same".into(),
        number => format!("{number} DIFFERENT: {}", wrong[..number.min(MOST_NAMED)].join(" ")),
    };
    system::print(&format!("{kernel}: {count} frames, {hash:016x}, {verdict}\n"));
    wrong.is_empty()
}

fn print_pixels(kernel: Kernel, frame: Option<&Frame>) -> bool {
    let Some(Ok(drawn)) = frame.map(|frame| frame.draw(kernel)) else {
        system::print("no such frame\n");
        return false;
    };
    for row in drawn.pixels.chunks(drawn.width as usize) {
        let mut line: String = row.iter().map(|byte| format!("{byte:02x}")).collect();
        line.push('\n');
        system::print(&line);
    }
    true
}

fn check_loops() -> bool {
    let (mut count, mut cases, mut wrong) = (0, 0, Vec::new());
    for outcome in loops::all(Cases::quick(SEED)) {
        (count, cases) = (count + 1, cases + outcome.cases);
        if let Some(what) = &outcome.wrong {
            wrong.push(format!("    {outcome}: {what}\n"));
        }
    }
    system::print(&format!("{count} loops: {cases} cases, {} wrong\n", wrong.len()));
    wrong.iter().for_each(|line| system::print(line));
    cases > 0 && wrong.is_empty()
}

#[cfg(feature = "std")]
fn main() {
    let words: Vec<_> = std::env::args().skip(1).collect();
    std::process::exit(i32::from(!run(&words.join(" "))));
}

#[cfg(not(feature = "std"))]
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    system::print(&format!("{info}\n"));
    system::exit(false)
}
