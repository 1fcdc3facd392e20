//! A plasma from palette and bytes alone: no scene, no rasterizer. The bytes are drawn once; only the DAC moves,
//! rotated by one entry at each vertical retrace.
//!
//! `cargo run --release --example plasma -- [OUT.png] [RETRACES]` saves the picture after that many retraces (70 a
//! second), by default 100.

use mode13h::export;
use mode13h::palette::gradient::{Stop, fill};
use mode13h::palette::{Ramp, Rgb};
use mode13h::vga::{Vga, timing};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().unwrap_or_else(|| "plasma.png".to_owned());
    let retraces: u32 = arguments.next().map_or(Ok(100), |text| text.parse())?;

    let mut vga = Vga::new();
    load_colors(&mut vga);
    draw(vga.pixels_mut());

    let drawn = vga.stamp();
    for _ in 0..retraces {
        vga.advance(vga.beam().nanoseconds_to_retrace());
        assert_ne!(vga.read_port(0x3DA) & timing::VERTICAL_RETRACE, 0);
        vga.cycle(.., 1);
    }
    assert_eq!(vga.stamp(), drawn, "no byte was touched");

    export::png(&vga, &out)?;
    println!("{out}");
    Ok(())
}

/// Loads colours that end where they begin, through the ports as in 1994: index 0, then 768 values.
fn load_colors(vga: &mut Vga) {
    let mut colors = [Rgb::BLACK; 256];
    let keys = [
        Stop::new(0, 0x100030),
        Stop::new(50, 0x8010a0),
        Stop::new(95, 0xff6040),
        Stop::new(128, 0xffe890),
        Stop::new(170, 0x20b0c0),
        Stop::new(215, 0x103080),
        Stop::new(255, 0x100030),
    ];
    fill(&mut colors, Ramp::WHOLE, &keys);
    vga.write_port(0x3C8, 0);
    for value in colors.iter().flat_map(|color| color.to_dac()) {
        vga.write_port(0x3C9, value);
    }
}

/// The sum of four waves: across, down, slanting, and in rings.
fn draw(pixels: &mut [u8]) {
    for (y, row) in (0..).zip(pixels.chunks_exact_mut(Vga::PITCH)) {
        for (x, pixel) in (0..).zip(row) {
            let (dx, dy): (i32, i32) = (x - 200, y - 70);
            // A pixel is 5 wide and 6 high: (5/6)² makes the rings round. In quarter pixels.
            let ring = (16 * (dx * dx * 25 / 36 + dy * dy)).isqrt();
            let sum = sine(2 * x) + sine(3 * y + 40) + sine(x + 2 * y) + sine(ring);
            // −508 to 508, halved: two turns of the palette.
            *pixel = (sum / 2).rem_euclid(256) as u8;
        }
    }
}

/// 127 · sin of an angle in 1/256 of a turn, by Bhaskara's fraction of the seventh century; off by at most 1.2.
fn sine(angle: i32) -> i32 {
    let half = angle & 127;
    let p = half * (128 - half);
    let sine = 127 * 16 * p / (5 * 128 * 128 - 4 * p);
    if angle & 128 == 0 { sine } else { -sine }
}
