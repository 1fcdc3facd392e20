//! Hard case S7: what a span kernel may do to the machine it runs on, and what the assembly is.
//!
//! A trampoline calls the kernel as checkasm does: every callee-saved register holds a distinct value, all others hold
//! rubbish, and so do the upper halves of the argument registers. Deliberately wrong kernels show that each violation
//! would be detected.

use crate::support::tried::Tried;
use iced_x86::{Decoder, DecoderOptions, Formatter, IntelFormatter, Mnemonic};
use mode13h::internals::span::entry;
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::loops::spans::naive_span;

#[cfg(target_os = "linux")]
mod edge;
#[cfg(all(target_os = "linux", target_arch = "x86_64", feature = "std"))]
mod every;
#[cfg(all(target_os = "linux", target_arch = "x86_64", feature = "std"))]
mod guarded;
/// Kernels behind the assembly's interface, whose calling convention and type of a length are given: `shim` is number
/// `I` of those available, and `WRONG` are those listed, each wrong in one respect, with the message it must give.
macro_rules! kernels {
    ($abi:literal, $count:ty; $($name:ident => $fault:literal: $($before:literal),* ; $($after:literal),*)*) => {
        pub(crate) type Count = $count;

        pub(crate) unsafe extern $abi fn shim<const I: usize>(row: *mut u8, count: Count, shade: u16, step: u16) {
            let kernel = Kernel::available().nth(I).expect("as many kernels as shims are used");
            // SAFETY: the caller's `row` is valid for `count` bytes.
            kernel.fill(unsafe { std::slice::from_raw_parts_mut(row, count as usize) }, shade, step);
        }

        $(#[unsafe(naked)]
        unsafe extern $abi fn $name(_row: *mut u8, _count: Count, _shade: u16, _step: u16) {
            sound_loop!($($before,)* ; $($after),*)
        })*

        pub(crate) const WRONG: &[(entry::Entry, &str)] = &[$(($name, $fault)),*];
    };
}

#[cfg(target_arch = "x86_64")]
#[path = "abi/x86_64.rs"]
mod machine;
#[cfg(target_arch = "x86")]
#[path = "abi/i686.rs"]
mod machine;

/// The trampoline's input: four words for the arguments, one for each callee-saved register, at most six, and one for all
/// other registers.
#[repr(C)]
pub(crate) struct Call {
    kernel: entry::Entry,
    arguments: [usize; 4],
    kept: [usize; 6],
    rubbish: usize,
}

/// The state that the trampoline found after the kernel returned.
#[repr(C)]
#[derive(Default)]
pub(crate) struct Seen {
    /// Contents of the callee-saved registers, in the order of [`machine::KEPT`].
    kept: [usize; 6],
    flags: usize,
    /// Difference of the stack pointer from before.
    stack_error: usize,
    /// Bits in which any of the words above the arguments differs from what was put there.
    stack_guard: usize,
    /// MXCSR: rounding and exceptions of floating point, whose control bits a callee must preserve.
    mxcsr_before: u32,
    mxcsr_after: u32,
}

impl Seen {
    /// Which rule was broken.
    fn rules(&self) -> Result<(), String> {
        for (i, name) in machine::KEPT.iter().enumerate() {
            if self.kept[i] != kept_value(i) {
                return Err(format!("{name} is {:#x}, not {:#x}", self.kept[i], kept_value(i)));
            }
        }
        if self.flags & DIRECTION_FLAG != 0 {
            return Err("the direction flag is set".to_owned());
        }
        if self.stack_error != 0 {
            return Err(format!("the stack pointer is off by {}", self.stack_error as isize));
        }
        if self.stack_guard != 0 {
            return Err(format!("the caller's stack was written to: {:#x}", self.stack_guard));
        }
        if (self.mxcsr_before ^ self.mxcsr_after) & MXCSR_CONTROL != 0 {
            return Err(format!("MXCSR is {:#x}, was {:#x}", self.mxcsr_after, self.mxcsr_before));
        }
        Ok(())
    }
}

/// The value with which the trampoline fills callee-saved register number `i`.
fn kept_value(i: usize) -> usize {
    (0x1357_9BDF_u32 as usize).wrapping_mul(0x0101_0101).wrapping_add(i * 0x1111)
}

const DIRECTION_FLAG: usize = 1 << 10;
const MXCSR_CONTROL: u32 = 0xFFC0;
const GUARD: usize = 64;

/// Calls `kernel` through the trampoline, with `rubbish` in everything that it must not read.
fn call(kernel: entry::Entry, row: *mut u8, length: usize, shade: u16, step: u16, rubbish: u64) -> Result<(), String> {
    let rubbish = rubbish as usize;
    let count = machine::Count::try_from(length).expect("a short row");
    let call = Call {
        kernel,
        arguments: [
            row as usize,
            rubbish << machine::Count::BITS | count as usize,
            rubbish << 16 | usize::from(shade),
            rubbish << 16 | usize::from(step),
        ],
        kept: std::array::from_fn(kept_value),
        rubbish,
    };
    let mut seen = Seen::default();
    // SAFETY: `row` is valid for `length` bytes, which is all that a correct kernel writes; the wrong ones here stay
    // within it, except for the guards beside it. The trampoline preserves its own caller's registers.
    unsafe { machine::trampoline(&call, &mut seen) };
    seen.rules()
}

/// Calls `kernel` for one span through the trampoline, with `rubbish` in everything that it must not read.
fn called(kernel: entry::Entry, length: usize, shade: u16, step: u16, rubbish: u64) -> Result<(), String> {
    let mut canvas = vec![0xA5; length + 2 * GUARD];
    call(kernel, canvas[GUARD..GUARD + length].as_mut_ptr(), length, shade, step, rubbish)?;
    let expected = naive_span(length, shade, step);
    if let Some(k) = (0..length).find(|&k| canvas[GUARD + k] != expected[k]) {
        return Err(format!("pixel {k} is {:#04x}, not {:#04x}", canvas[GUARD + k], expected[k]));
    }
    if canvas[..GUARD].iter().chain(&canvas[GUARD + length..]).any(|&byte| byte != 0xA5) {
        return Err("a byte beside the row was written".to_owned());
    }
    Ok(())
}

/// Runs `action` through the trampoline, with `rubbish` in everything that it must not read.
#[cfg(all(target_os = "linux", target_arch = "x86_64", feature = "std"))]
fn ran(mut action: impl FnMut(), rubbish: u64) -> Result<(), String> {
    let mut action: &mut dyn FnMut() = &mut action;
    call(machine::run, (&raw mut action).cast(), 1, 0, 0, rubbish)
}

/// Calls it for many spans.
fn keeps_the_rules(name: &str, kernel: entry::Entry, shortest: usize) {
    let mut tried = Tried::new(format!("s7_{name}"), 2_000);
    let mut random = Random::new(7);
    for i in 0..2_000 {
        let length = shortest + (random.next_u64() % 321) as usize;
        let bits = random.next_u64();
        let (shade, step) = (bits as u16, (bits >> 16) as u16);
        // Ones, zeros and noise, each of which can reveal that an upper half is read.
        let rubbish = [u64::MAX, 0, random.next_u64()][i % 3];
        if let Err(fault) = called(kernel, length, shade, step, rubbish) {
            panic!("{name}: {fault} (shade {shade:#06x} step {step:#06x} length {length} rubbish {rubbish:#x})");
        }
        tried.add(1);
    }
    tried.done();
}

/// An instruction of a kernel.
#[derive(Debug)]
pub(crate) struct Line {
    /// Offset from the function's first byte.
    offset: u64,
    text: String,
    /// Jump target, 0 if it does not jump.
    target: u64,
}

/// The instructions of a function, to its `ret`.
pub(crate) fn disassembled(function: entry::Entry) -> Vec<Line> {
    // SAFETY: reads code; 128 bytes, of which the functions here are a part and other code the rest.
    let code = unsafe { std::slice::from_raw_parts(function as *const u8, 128) };
    let mut decoder = Decoder::with_ip(usize::BITS, code, 0, DecoderOptions::NONE);
    let mut formatter = IntelFormatter::new();
    let mut lines = Vec::new();
    for instruction in &mut decoder {
        let mut text = String::new();
        formatter.format(&instruction, &mut text);
        lines.push(Line { offset: instruction.ip(), text, target: instruction.near_branch_target() });
        if instruction.mnemonic() == Mnemonic::Ret {
            break;
        }
    }
    lines
}

#[test]
fn s7_the_loop_keeps_the_rules() {
    keeps_the_rules("loop", machine::LOOP, 1);
}

#[cfg(target_arch = "x86_64")]
#[test]
fn s7_the_unrolled_loop_keeps_the_rules() {
    keeps_the_rules("unrolled", entry::mode13h_span_unrolled_x86_64, 1);
}

/// The Rust kernels, through a shim that reveals what their assembly does not declare.
#[test]
fn s7_every_kernel_keeps_the_rules() {
    #[rustfmt::skip]
    let shims = [
        machine::shim::<0>, machine::shim::<1>, machine::shim::<2>, machine::shim::<3>,
        machine::shim::<4>, machine::shim::<5>, machine::shim::<6>, machine::shim::<7>,
    ];
    assert!(Kernel::available().count() <= shims.len(), "a kernel has no shim");
    for (kernel, shim) in Kernel::available().zip(shims) {
        keeps_the_rules(&format!("shim_{}", kernel.name()), shim, 0);
    }
}

/// Rows that begin or end at a page whose neighbour must not be touched: guard bytes would not reveal a kernel that
/// reads beyond, or writes back what it read there. A fault ends the test program.
#[cfg(target_os = "linux")]
#[test]
fn s7_no_byte_beside_is_touched() {
    let mut tried = Tried::new("s7_no_byte_beside_is_touched", 2 * 321);
    let mut edge = edge::Edge::new();
    for kernel in Kernel::available() {
        for length in (0..=320).chain([edge::SIZE - 1, edge::SIZE]) {
            let expected = naive_span(length, 0x1234, 0xFE01);
            let bytes = edge.bytes();
            for start in [0, bytes.len() - length] {
                let row = &mut bytes[start..start + length];
                row.fill(0);
                kernel.fill(row, 0x1234, 0xFE01);
                assert!(*row == expected[..], "{kernel}: length {length} from {start}");
                tried.add(1);
            }
        }
    }
    tried.done();
}

/// Kernels that are wrong in one respect each are caught for exactly that.
#[test]
fn s7_wrong_kernels_are_caught() {
    let mut tried = Tried::new("s7_wrong_kernels_are_caught", machine::WRONG.len() as u64);
    for (kernel, fault) in machine::WRONG {
        match called(*kernel, 20, 0x1234, 0x0156, u64::MAX) {
            Ok(()) => panic!("not caught: {fault}"),
            Err(found) => assert!(found.contains(fault), "{fault} taken for: {found}"),
        }
        tried.add(1);
    }
    tried.done();
}

/// The loop is the five instructions, in their order, and jumps back to the first of them.
#[test]
fn s7_the_loop_is_five_instructions() {
    let mut tried = Tried::new("s7_the_loop_is_five_instructions", 5);
    let code = disassembled(machine::LOOP);
    let jumps: Vec<_> = (0..code.len()).filter(|&i| code[i].text.starts_with('j')).collect();
    let [jump] = jumps[..] else { panic!("one jump, the loop's: {code:#?}") };
    let first = jump.checked_sub(4).expect("four instructions before it");
    let four: Vec<_> = code[first..jump].iter().map(|line| line.text.as_str()).collect();
    assert_eq!(four, machine::FOUR, "{code:#?}");
    assert!(code[jump].text.starts_with("jne"), "{code:#?}");
    assert_eq!(code[jump].target, code[first].offset, "{code:#?}");
    // The four and the jump.
    tried.add(four.len() as u64 + 1);
}

/// The unrolled loop writes eight pixels per jump, with the same two instructions.
#[cfg(target_arch = "x86_64")]
#[test]
fn s7_the_unrolled_loop_is_the_same_eight_times() {
    let mut tried = Tried::new("s7_the_unrolled_loop_is_the_same_eight_times", 8);
    let code = disassembled(entry::mode13h_span_unrolled_x86_64);
    let text: Vec<_> = code.iter().map(|line| line.text.as_str()).collect();
    let mut eight = vec!["mov [rdi],ah".to_owned(), "add ax,bx".to_owned()];
    for k in 1..8 {
        eight.extend([format!("mov [rdi+{k}],ah"), "add ax,bx".to_owned()]);
    }
    eight.extend(["add rdi,8".to_owned(), "dec esi".to_owned()]);
    let found = text.windows(eight.len()).any(|window| window == eight);
    assert!(found, "{text:#?}");
    tried.add(8);
}
