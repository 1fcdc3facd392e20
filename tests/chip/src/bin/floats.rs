//! A program that divides floats, so that a search for the routines of such a division has something to find.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

#[unsafe(link_section = ".reset")]
#[unsafe(no_mangle)]
static RESET: extern "C" fn() -> ! = start;

extern "C" fn start() -> ! {
    loop {
        black_box(black_box(1.0_f32) / black_box(3.0_f32));
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}
