//! The only interface to the assembly: the loop of 1994 from `asm/`, for x86-64 and 32-bit x86.

/// Assembles a file of `asm/` between the macros `function` and `endfunction`, which emit what the object format
/// requires around a symbol. (Mach-O and 32-bit COFF put an underscore before it.)
macro_rules! assemble {
    ($file:literal) => {
        #[cfg(not(any(windows, target_os = "uefi", target_vendor = "apple")))]
        assemble!(
            $file,
            r#".macro function name
                .pushsection .text.\name,"ax",@progbits
                .globl \name
                .hidden \name
                .type \name,@function
                .p2align 5
                \name:
            .endm
            .macro endfunction name
                .size \name, . - \name
                .popsection
            .endm"#
        );
        #[cfg(any(target_vendor = "apple", all(any(windows, target_os = "uefi"), target_arch = "x86")))]
        assemble!(
            $file,
            r#".macro function name
                .text
                .globl _\name
                .p2align 5
                _\name:
            .endm
            .macro endfunction name
            .endm"#
        );
        #[cfg(all(any(windows, target_os = "uefi"), target_arch = "x86_64"))]
        assemble!(
            $file,
            r#".macro function name
                .text
                .globl \name
                .p2align 5
                \name:
            .endm
            .macro endfunction name
            .endm"#
        );
    };
    ($file:literal, $macros:literal) => {
        core::arch::global_asm!($macros, include_str!($file), ".purgem function", ".purgem endfunction", options(raw));
    };
}

#[cfg(target_arch = "x86_64")]
pub(super) use x86_64::{fill, fill_unrolled};

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    assemble!("../../asm/span_x86_64.s");

    /// The signature of both loops: `row` is valid for `count` bytes, `count` is not 0.
    pub type Entry = unsafe extern "sysv64" fn(row: *mut u8, count: u32, shade: u16, step: u16);

    unsafe extern "sysv64" {
        /// The loop of five instructions.
        pub fn mode13h_span_x86_64(row: *mut u8, count: u32, shade: u16, step: u16);
        /// The unrolled loop, eight pixels per iteration.
        pub fn mode13h_span_unrolled_x86_64(row: *mut u8, count: u32, shade: u16, step: u16);
    }

    pub(crate) fn fill(row: &mut [u8], shade: u16, step: u16) {
        call(mode13h_span_x86_64, row, shade, step);
    }

    pub(crate) fn fill_unrolled(row: &mut [u8], shade: u16, step: u16) {
        call(mode13h_span_unrolled_x86_64, row, shade, step);
    }

    /// Splits the row into pieces that the loop's count can hold; an empty row gives none.
    #[inline(always)]
    fn call(entry: Entry, row: &mut [u8], shade: u16, step: u16) {
        let mut shade = shade;
        for piece in row.chunks_mut(u32::MAX as usize) {
            let count = piece.len() as u32; // at most u32::MAX, by the cut
            // SAFETY: `piece` is `count` writable bytes, and `chunks_mut` gives none that is empty.
            unsafe { entry(piece.as_mut_ptr(), count, shade, step) };
            // Only a piece of u32::MAX pixels, 65,535 modulo 65,536, has one after it.
            shade = shade.wrapping_add(step.wrapping_mul(u16::MAX));
        }
    }
}

#[cfg(target_arch = "x86")]
pub(super) use x86::fill;

#[cfg(target_arch = "x86")]
mod x86 {
    assemble!("../../asm/span_i686.s");

    /// The signature of the loop: `row` is valid for `count` bytes, `count` is not 0.
    pub type Entry = unsafe extern "cdecl" fn(row: *mut u8, count: u16, shade: u16, step: u16);

    unsafe extern "cdecl" {
        /// The loop of 1994, to the letter.
        pub fn mode13h_span_i686(row: *mut u8, count: u16, shade: u16, step: u16);
    }

    /// Splits the row into pieces that the loop's count can hold; an empty row gives none.
    pub(crate) fn fill(row: &mut [u8], shade: u16, step: u16) {
        let mut shade = shade;
        for piece in row.chunks_mut(usize::from(u16::MAX)) {
            let count = piece.len() as u16; // at most u16::MAX, by the cut
            // SAFETY: `piece` is `count` writable bytes, and `chunks_mut` gives none that is empty.
            unsafe { mode13h_span_i686(piece.as_mut_ptr(), count, shade, step) };
            // Only a piece of u16::MAX pixels has one after it.
            shade = shade.wrapping_add(step.wrapping_mul(u16::MAX));
        }
    }
}

/// The entries themselves, for tests of what they do to registers and of their instructions.
pub(super) mod entry {
    #[cfg(target_arch = "x86")]
    pub use super::x86::{Entry, mode13h_span_i686};
    #[cfg(target_arch = "x86_64")]
    pub use super::x86_64::{Entry, mode13h_span_unrolled_x86_64, mode13h_span_x86_64};
}
