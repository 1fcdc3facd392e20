//! Linux without a C library: two system calls, and a start that finds the arguments on the stack.

use alloc::string::String;
use core::arch::{asm, global_asm};
use core::ffi::{CStr, c_char};

// Each calls `entry` with the stack as the kernel left it: the number of arguments, then their addresses.
#[cfg(target_arch = "x86")]
global_asm!(
    ".globl _start",
    "_start:",
    "mov eax, esp",
    "and esp, -16",
    "sub esp, 12",
    "push eax",
    "call {entry}",
    entry = sym entry
);
// A section of its own, so that machines/avx512 can place it at the start of the image.
#[cfg(target_arch = "x86_64")]
global_asm!(
    ".section .text._start, \"ax\"",
    ".globl _start",
    "_start:",
    "mov rdi, rsp",
    "and rsp, -16",
    "call {entry}",
    entry = sym entry
);
#[cfg(target_arch = "aarch64")]
global_asm!(".globl _start", "_start:", "mov x0, sp", "b {entry}", entry = sym entry);
#[cfg(target_arch = "riscv64")]
global_asm!(".globl _start", "_start:", "mv a0, sp", "tail {entry}", entry = sym entry);
#[cfg(target_arch = "s390x")]
global_asm!(".globl _start", "_start:", "lgr %r2, %r15", "aghi %r15, -160", "jg {entry}", entry = sym entry);
#[cfg(target_arch = "powerpc64")]
global_asm!(
    ".globl _start",
    "_start:",
    "addis 2, 12, .TOC.-_start@ha",
    "addi 2, 2, .TOC.-_start@l",
    "mr 3, 1",
    "li 0, 0",
    "stdu 0, -128(1)",
    "bl {entry}",
    "nop",
    entry = sym entry
);
#[cfg(target_arch = "powerpc")]
global_asm!(
    ".globl _start",
    "_start:",
    "mr 3, 1",
    "li 0, 0",
    "stwu 0, -16(1)",
    "bl {entry}",
    entry = sym entry
);

/// Where the program continues after its start; the first argument is its name.
unsafe extern "C" fn entry(stack: *const usize) -> ! {
    let mut words = String::new();
    // SAFETY: the kernel put the number of arguments there, followed by that many addresses of strings.
    unsafe {
        for i in 1..*stack {
            let argument = CStr::from_ptr(*stack.add(1 + i) as *const c_char);
            words.push(' ');
            words.push_str(argument.to_str().unwrap_or_default());
        }
    }
    exit(crate::run(&words))
}

pub(crate) fn print(text: &str) {
    let mut rest = text.as_bytes();
    while !rest.is_empty() {
        // SAFETY: write(1, rest) reads these bytes.
        let written = unsafe { call(WRITE, 1, rest.as_ptr() as usize, rest.len()) };
        match rest.get(written..) {
            Some(left) if written > 0 => rest = left,
            // An error is a number near the end of the range.
            _ => exit(false),
        }
    }
}

pub(crate) fn exit(passed: bool) -> ! {
    loop {
        // SAFETY: exit(status) accesses no memory.
        unsafe { call(EXIT, usize::from(!passed), 0, 0) };
    }
}

#[cfg(any(target_arch = "aarch64", target_arch = "riscv64"))]
const WRITE: usize = 64;
#[cfg(any(target_arch = "aarch64", target_arch = "riscv64"))]
const EXIT: usize = 93;
#[cfg(target_arch = "x86_64")]
const WRITE: usize = 1;
#[cfg(target_arch = "x86_64")]
const EXIT: usize = 60;
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")))]
const WRITE: usize = 4;
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")))]
const EXIT: usize = 1;

/// A system call with three arguments.
unsafe fn call(number: usize, a: usize, b: usize, c: usize) -> usize {
    let result;
    // SAFETY: the caller ensures that what the call reads is valid; it changes only what is named here.
    unsafe {
        #[cfg(target_arch = "x86")]
        asm!("int 0x80", inout("eax") number => result, in("ebx") a, in("ecx") b, in("edx") c);
        #[cfg(target_arch = "x86_64")]
        asm!("syscall", inout("rax") number => result, in("rdi") a, in("rsi") b, in("rdx") c, out("rcx") _, out("r11") _);
        #[cfg(target_arch = "aarch64")]
        asm!("svc 0", in("x8") number, inout("x0") a => result, in("x1") b, in("x2") c);
        #[cfg(target_arch = "riscv64")]
        asm!("ecall", in("a7") number, inout("a0") a => result, in("a1") b, in("a2") c);
        #[cfg(target_arch = "s390x")]
        asm!("svc 0", in("r1") number, inout("r2") a => result, in("r3") b, in("r4") c);
        #[cfg(any(target_arch = "powerpc", target_arch = "powerpc64"))]
        asm!(
            "sc",
            inout("r0") number => _, inout("r3") a => result, inout("r4") b => _, inout("r5") c => _,
            out("r6") _, out("r7") _, out("r8") _, out("r9") _, out("r10") _, out("r11") _, out("r12") _, out("cr0") _
        );
    }
    result
}
