//! WebAssembly: the page or node provides the arguments and takes the text.

use alloc::string::String;
use alloc::vec;

#[link(wasm_import_module = "machine")]
unsafe extern "C" {
    /// Takes `length` bytes of text.
    #[link_name = "print"]
    fn print_bytes(text: *const u8, length: usize);
    /// Writes the arguments, at most `room` bytes, and returns how many.
    fn words(to: *mut u8, room: usize) -> usize;
}

/// Runs the program; 0 if nothing is wrong.
#[unsafe(no_mangle)]
extern "C" fn start() -> i32 {
    let mut bytes = vec![0; 1_000];
    // SAFETY: there is room for as many bytes.
    let length = unsafe { words(bytes.as_mut_ptr(), bytes.len()) };
    bytes.truncate(length);
    i32::from(!crate::run(&String::from_utf8_lossy(&bytes)))
}

pub(crate) fn print(text: &str) {
    // SAFETY: the bytes are only read, and only during the call.
    unsafe { print_bytes(text.as_ptr(), text.len()) }
}

/// Ends a program that has panicked.
pub(crate) fn exit(_passed: bool) -> ! {
    core::arch::wasm32::unreachable()
}
