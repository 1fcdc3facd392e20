//! Draws the frames of `verify` with every kernel that the machine has, and prints a line for each: its hash is that of
//! every other machine. The arguments are words:
//!
//! | word | what |
//! |---|---|
//! | `step=N` | draws every N-th frame, for slow machines |
//! | `kernel=NAME` | draws with this kernel alone |
//! | `spans` | tries all kernels on spans of random lengths, shades, steps and alignments, and draws no frame |
//!
//! The status is 1 if all 880 frames are drawn and are not those of other machines, or if a span is wrong. The hash of a
//! part is for the script to compare.
#![cfg_attr(not(feature = "std"), no_std, no_main)]

extern crate alloc;

#[path = "../../../lab/src/verify/freestanding/mod.rs"]
#[allow(dead_code, unused_imports, unreachable_pub, reason = "the laboratory has more use for it")]
mod freestanding;
#[cfg(not(feature = "std"))]
mod heap;
mod system;

use alloc::format;
use alloc::vec::Vec;
use freestanding::Frames;
use mode13h::span::Kernel;

/// The number that the cases of spans are made from, as `mode13h verify` has it.
const SEED: u64 = 13;

/// Does what the words say. Returns whether nothing is wrong.
fn run(words: &str) -> bool {
    // `simd` is one of the levels that follow it, under another name: they are drawn with once.
    let kernels = Kernel::available().filter(|kernel| kernel.name() != "simd");
    let (mut step, mut kernels) = (1, kernels.collect::<Vec<_>>());
    for word in words.split_ascii_whitespace() {
        match word.split_once('=') {
            None if word == "spans" => return spans(),
            Some(("step", number)) if number.parse().is_ok_and(|number: u64| number > 0) => {
                step = number.parse().unwrap_or(1);
            }
            Some(("kernel", name)) => match name.parse::<Kernel>() {
                Ok(kernel) => kernels = [kernel].into(),
                Err(error) => {
                    system::print(&format!("{name}: {error}\n"));
                    return false;
                }
            },
            _ => {
                system::print(&format!("{word}: no such word; there are step=N, kernel=NAME and spans\n"));
                return false;
            }
        }
    }
    let mut passed = true;
    for kernel in kernels {
        let frames = freestanding::frames_in_steps(kernel, step);
        system::print(&format!("{kernel}: {} frames, {:016x}\n", frames.count, frames.hash));
        passed &= step > 1 || frames == Frames::EXPECTED;
    }
    passed
}

fn spans() -> bool {
    let tally = freestanding::kernels(SEED);
    let names = Kernel::available().map(|kernel| format!("{kernel}")).collect::<Vec<_>>();
    system::print(&format!("spans of {}: {} cases, {} wrong\n", names.join(", "), tally.cases, tally.failures.len()));
    for failure in &tally.failures {
        system::print(&format!("    {failure}\n"));
    }
    tally.cases > 0 && tally.failures.is_empty()
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
