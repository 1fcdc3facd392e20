//! A triangle that turns in mode 13h until Esc is pressed. With the argument `/W` it draws once,
//! and writes the card's contents to SCREEN.BIN: 64,000 bytes, and the DAC.
#![no_std]

extern crate alloc;

#[allow(dead_code, reason = "a program calls what it needs")]
#[path = "../../player/src/machine.rs"]
mod machine;

use alloc::vec;

use machine::{Machine, Parameters};
use mode13h::fixed::I24F8;
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};

/// Called once the program's memory is ready; returns the exit status.
///
/// # Safety
/// The stub passes its own table.
#[unsafe(no_mangle)]
unsafe extern "C" fn dos_main(parameters: *mut Parameters) -> i32 {
    // SAFETY: it is the stub's, which calls once.
    let (mut machine, _, words) = unsafe { Machine::new(parameters) };
    let mut dac = [0; 768];
    for (shade, color) in (0_u8..64).zip(dac.as_chunks_mut::<3>().0) {
        *color = [shade, shade / 2, 63 - shade];
    }
    machine.set_mode(Machine::MODE_13H);
    machine.set_dac(&dac, 64);
    let mut pixels = vec![0; 64_000];
    let mut corners = [(0, -90), (110, 70), (-110, 70)].map(|(x, y)| [x << 16, y << 16]);
    let is_drawn = loop {
        if !draw(&mut pixels, &corners) {
            break false;
        }
        machine.wait_for_retrace();
        machine.show(&pixels);
        if !words.trim_ascii().is_empty() {
            break machine.write_screen();
        }
        if machine.is_escaped() {
            break true;
        }
        for [x, y] in &mut corners {
            // A turn by 1/64 that preserves lengths.
            *x -= *y >> 6;
            *y += *x >> 6;
        }
    };
    machine.set_mode(Machine::TEXT);
    i32::from(!is_drawn)
}

/// Draws the triangle around the middle of the screen, in integers only.
fn draw(pixels: &mut [u8], corners: &[[i32; 2]; 3]) -> bool {
    pixels.fill(0);
    let Ok(frame) = Frame::new(pixels, 320, 200, 320) else { return false };
    let mut vertices = [Vertex::default(); 3];
    for ((to, [x, y]), shade) in vertices.iter_mut().zip(corners).zip([63_u8, 1, 32]) {
        let (x, y) = ((x >> 8) + (160 << 8), (y >> 8) + (100 << 8));
        let Ok(vertex) = Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), shade.into(), 0) else { return false };
        *to = vertex;
    }
    Raster::new(frame).triangle(&vertices, Interpolation::Gouraud1616);
    true
}
