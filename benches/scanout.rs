//! A frame from bytes to colours: `cargo bench --bench scanout`. To reach: under 40 µs for the
//! 64,000 pixels of a window.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mode13h::palette::{BIOS, builtin};
use mode13h::vga::Vga;

fn scan_out(c: &mut Criterion) {
    let mut vga = Vga::new();
    // Every byte, in no order that a predictor or a cache could profit from.
    let mut state = 1_u32;
    for pixel in vga.pixels_mut() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *pixel = state.to_be_bytes()[0];
    }
    let mut group = c.benchmark_group("scanout");
    group.throughput(Throughput::Elements(Vga::SHOWN as u64));

    let mut rgb = vec![0; Vga::SHOWN];
    group.bench_function("frame, 0x00RRGGBB", |b| b.iter(|| black_box(&vga).scan_out(black_box(&mut rgb))));

    let mut row_of_pixels = [0; Vga::WIDTH];
    group.bench_function("frame, RGB565 by row", |b| {
        b.iter(|| {
            for row in 0..Vga::HEIGHT {
                black_box(&vga).scan_out_row_rgb565(row, black_box(&mut row_of_pixels));
            }
        });
    });
    group.finish();

    let mut group = c.benchmark_group("palette");
    group.bench_function("set_palette", |b| b.iter(|| vga.set_palette(black_box(&builtin::COPPER))));
    group.bench_function("fade", |b| b.iter(|| vga.fade(black_box(&BIOS), black_box(&builtin::COPPER), black_box(77))));
    group.bench_function("cycle all by 1", |b| b.iter(|| vga.cycle(.., black_box(1))));
    group.finish();
}

criterion_group!(benches, scan_out);
criterion_main!(benches);
