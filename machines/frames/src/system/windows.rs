//! Windows without a C library: four calls of kernel32.

use alloc::string::String;
use core::arch::global_asm;
use core::ffi::{CStr, c_char, c_void};
use core::ptr;

#[link(name = "kernel32", kind = "raw-dylib")]
unsafe extern "system" {
    fn GetCommandLineA() -> *const c_char;
    fn GetStdHandle(number: u32) -> *mut c_void;
    fn WriteFile(file: *mut c_void, bytes: *const u8, count: u32, written: *mut u32, overlapped: *mut c_void) -> i32;
    fn ExitProcess(status: u32) -> !;
}

/// Standard output, -11.
const OUTPUT: u32 = 0xFFFF_FFF5;

/// Required by the linker if a program uses floats.
#[unsafe(no_mangle)]
static _fltused: i32 = 0;

// Touches each page of a stack frame larger than one page, from the top, so that the guard page grows the stack. RAX
// bytes.
global_asm!(
    ".globl __chkstk",
    "__chkstk:",
    "push rcx",
    "push rax",
    "lea rcx, [rsp + 24]",
    "2:",
    "cmp rax, 4096",
    "jb 3f",
    "sub rcx, 4096",
    "test [rcx], rcx",
    "sub rax, 4096",
    "jmp 2b",
    "3:",
    "sub rcx, rax",
    "test [rcx], rcx",
    "pop rax",
    "pop rcx",
    "ret",
);

#[unsafe(no_mangle)]
extern "system" fn mainCRTStartup() -> ! {
    // SAFETY: the command line is a string that stays valid.
    let line = unsafe { CStr::from_ptr(GetCommandLineA()) };
    let line = String::from_utf8_lossy(line.to_bytes());
    // The program's name is quoted if it contains spaces.
    let words = match line.strip_prefix('"') {
        Some(quoted) => quoted.split_once('"'),
        None => line.split_once(' '),
    };
    exit(crate::run(words.map_or("", |(_, words)| words)))
}

pub(crate) fn print(text: &str) {
    let mut rest = text.as_bytes();
    while !rest.is_empty() {
        let mut written = 0;
        // SAFETY: writes these bytes, fewer than 2³², to the file, and stores their number.
        let is_done = unsafe {
            WriteFile(GetStdHandle(OUTPUT), rest.as_ptr(), rest.len() as u32, &raw mut written, ptr::null_mut())
        };
        match rest.get(written as usize..) {
            Some(left) if is_done != 0 && written > 0 => rest = left,
            _ => exit(false),
        }
    }
}

pub(crate) fn exit(passed: bool) -> ! {
    // SAFETY: it ends the program.
    unsafe { ExitProcess(u32::from(!passed)) }
}
