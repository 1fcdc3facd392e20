//! The scene on a Cortex-M0 with 16 KiB of RAM: draws it, and says by semihosting whether its bytes
//! are those of every other machine. (Semihosting is Arm's way to talk to a debugger, or to QEMU.)
#![no_std]
#![no_main]

use core::arch::asm;
use core::panic::PanicInfo;

// By its file: the crate that it is of asks for an allocator.
#[path = "../../../conformance/src/hash.rs"]
mod hash;
#[path = "../../support/chip_scene.rs"]
mod scene;

use hash::{START, fnv_1a};

/// Where the chip starts: the word after the top of the stack.
#[unsafe(link_section = ".reset")]
#[unsafe(no_mangle)]
static RESET: extern "C" fn() -> ! = start;

extern "C" fn start() -> ! {
    let mut hash = START;
    let drawn = scene::draw(11, |_, pixels| hash = fnv_1a(hash, pixels));
    print(match drawn {
        Some(()) if hash == scene::HASH => &b"the same bytes\n\0"[..],
        Some(()) => b"other bytes\n\0",
        None => b"refused\n\0",
    });
    stop()
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    print(b"panic\n\0");
    stop()
}

/// Prints text that ends with a zero: SYS_WRITE0.
fn print(text: &[u8]) {
    semihosting(0x04, text.as_ptr() as usize);
}

/// Ends the program: SYS_EXIT, ADP_Stopped_ApplicationExit.
fn stop() -> ! {
    loop {
        semihosting(0x18, 0x2_0026);
    }
}

fn semihosting(operation: usize, argument: usize) {
    // SAFETY: the debugger reads the text of the two calls above, and changes no register but r0.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument) };
}
