//! The machine: memory, ports, DAC, clock and scan-out; hard cases P1, P3 and P4.

use crate::support::tried::Tried;
use mode13h::palette::{BIOS, Palette, Rgb, builtin, dac6_to_8, to_dac6};
use mode13h::vga::{Vga, timing};
use proptest::prelude::*;

const MASK: u16 = 0x3C6;
const READ: u16 = 0x3C7;
const WRITE: u16 = 0x3C8;
const DATA: u16 = 0x3C9;
const STATUS: u16 = 0x3DA;

fn write_color(vga: &mut Vga, rgb: [u8; 3]) {
    for value in rgb {
        vga.write_port(DATA, value);
    }
}

fn read_color(vga: &mut Vga) -> [u8; 3] {
    [(); 3].map(|()| vga.read_port(DATA))
}

fn entries(vga: &Vga) -> Vec<[u8; 3]> {
    (0..=255).map(|index| vga.dac().entry(index)).collect()
}

fn palette_of(color: impl Fn(u8) -> Rgb) -> Palette {
    Palette::from_colors(core::array::from_fn(|i| color(i as u8)))
}

/// 256 different colours that use all bits.
fn scattered() -> Palette {
    palette_of(|i| Rgb::new(i, i.wrapping_mul(37), 255 - i))
}

/// A machine with all of its 65,536 bytes and colours in use.
fn busy() -> Vga {
    let mut vga = Vga::new();
    for (offset, byte) in vga.memory_mut().iter_mut().enumerate() {
        *byte = (offset * 7 + offset / 256) as u8;
    }
    vga.set_palette(&scattered());
    vga
}

// P1

#[test]
fn p1_every_colour_value_goes_through_the_dac_as_six_bits() {
    let mut tried = Tried::new("p1_every_colour_value_goes_through_the_dac_as_six_bits", 256);
    let mut vga = Vga::new();
    for v in 0..=255_u8 {
        vga.set_palette(&palette_of(|_| Rgb::new(v, v, v)));
        assert_eq!(vga.dac().entry(9), [v >> 2; 3]);
        assert_eq!(vga.palette()[9], Rgb::new(v, v, v).on_dac());

        vga.write_port(WRITE, 9);
        write_color(&mut vga, [v; 3]);
        assert_eq!(vga.dac().entry(9), [v & 63; 3], "the DAC takes the low six bits");
        vga.write_port(READ, 9);
        assert_eq!(read_color(&mut vga), [v & 63; 3]);
        assert_eq!(to_dac6(dac6_to_8(v & 63)), v & 63);
        tried.add(1);
    }
}

#[test]
fn p1_what_is_displayed_can_be_set_again() {
    let mut tried = Tried::new("p1_what_is_displayed_can_be_set_again", 4);
    let mut vga = Vga::new();
    for palette in [&scattered(), &BIOS, &builtin::GREY, &builtin::COPPER] {
        vga.set_palette(palette);
        let shown = vga.palette();
        assert_eq!(shown, palette.on_dac());
        vga.set_palette(&shown);
        assert_eq!(vga.palette(), shown);
        tried.add(1);
    }
}

// P3

#[test]
fn p3_offsets_wrap_at_the_end_of_memory() {
    let mut tried = Tried::new("p3_offsets_wrap_at_the_end_of_memory", 10 * 2);
    let mut vga = Vga::new();
    for (offset, at) in [
        (0_u32, 0_usize),
        (63_999, 63_999),
        (64_000, 64_000),
        (65_535, 65_535),
        (65_536, 0),
        (65_537, 1),
        (131_071, 65_535),
        (131_072 + 777, 777),
        (u32::MAX, 65_535),
        (u32::MAX - 65_535, 0),
    ] {
        for byte in [0xA5, 0x5A] {
            vga.memory_mut().fill(!byte);
            vga.poke(offset, byte);
            assert_eq!(vga.peek(offset), byte);
            let changed: Vec<usize> = (0..Vga::MEMORY).filter(|&i| vga.memory()[i] == byte).collect();
            assert_eq!(changed, [at], "offset {offset}");
            tried.add(1);
        }
    }
}

#[test]
fn p3_a_row_written_over_the_end_goes_on_at_the_beginning() {
    let mut tried = Tried::new("p3_a_row_written_over_the_end_goes_on_at_the_beginning", 320);
    let mut vga = Vga::new();
    for k in 0..320 {
        vga.poke(65_536 - 100 + k, 1 + (k % 255) as u8);
    }
    for k in 0..320_u32 {
        assert_eq!(vga.memory()[(65_436 + k as usize) % 65_536], 1 + (k % 255) as u8);
        tried.add(1);
    }
    assert_eq!(vga.memory().iter().filter(|&&byte| byte != 0).count(), 320);
}

#[test]
fn p3_bytes_behind_the_frame_are_stored_but_not_shown() {
    let mut tried = Tried::new("p3_bytes_behind_the_frame_are_stored_but_not_shown", 1_536);
    let mut vga = Vga::new();
    let mut dark = vec![0; Vga::SHOWN];
    vga.scan_out(&mut dark);
    for offset in 64_000..65_536 {
        vga.poke(offset, 15);
        tried.add(1);
    }
    let mut shown = vec![1; Vga::SHOWN];
    vga.scan_out(&mut shown);
    assert_eq!(shown, dark);
    assert!(vga.memory()[64_000..].iter().all(|&byte| byte == 15));
    assert_eq!((vga.pixels().len(), vga.pixels_mut().len()), (64_000, 64_000));
}

// P4

#[test]
fn p4_a_write_broken_off_leaves_the_entry_alone() {
    let mut tried = Tried::new("p4_a_write_broken_off_leaves_the_entry_alone", 3 * 2);
    for values in 0..3 {
        for index_port in [WRITE, READ] {
            let mut vga = busy();
            let before = entries(&vga);
            vga.write_port(WRITE, 7);
            for value in [1, 2, 3].iter().take(values) {
                vga.write_port(DATA, *value);
            }
            assert_eq!(entries(&vga), before, "after {values} values");

            // The next index starts a new count of three, wherever the old one stood.
            vga.write_port(index_port, 7);
            assert_eq!(entries(&vga), before);
            vga.write_port(WRITE, 9);
            write_color(&mut vga, [61, 62, 63]);
            let mut expected = before;
            expected[9] = [61, 62, 63];
            assert_eq!(entries(&vga), expected);
            tried.add(1);
        }
    }
}

#[test]
fn p4_a_read_broken_off_starts_anew_as_well() {
    let mut tried = Tried::new("p4_a_read_broken_off_starts_anew_as_well", 3);
    let mut vga = busy();
    let before = entries(&vga);
    for values in 0..3 {
        vga.write_port(READ, 200);
        for channel in &before[200][..values] {
            assert_eq!(vga.read_port(DATA), *channel);
        }
        vga.write_port(READ, 17);
        assert_eq!(read_color(&mut vga), before[17]);
        tried.add(1);
    }
    assert_eq!(entries(&vga), before, "reading changes nothing");
}

#[test]
fn p4_the_third_write_changes_the_entry_and_steps_on_over_the_end() {
    let mut tried = Tried::new("p4_the_third_write_changes_the_entry_and_steps_on_over_the_end", 12 + 12);
    let mut vga = Vga::new();
    vga.write_port(WRITE, 250);
    let mut expected = entries(&vga);
    for k in 0..12_u8 {
        let index = 250_u8.wrapping_add(k);
        assert_eq!(vga.read_port(WRITE), index);
        write_color(&mut vga, [k, k + 1, k + 2]);
        expected[usize::from(index)] = [k, k + 1, k + 2];
        assert_eq!(entries(&vga), expected);
        tried.add(1);
    }
    vga.write_port(READ, 250);
    for k in 0..12_u8 {
        assert_eq!(read_color(&mut vga), expected[usize::from(250_u8.wrapping_add(k))]);
        tried.add(1);
    }
}

#[test]
fn a_whole_palette_goes_through_the_ports() {
    let mut vga = Vga::new();
    vga.write_port(WRITE, 0);
    for color in scattered().colors() {
        write_color(&mut vga, color.to_dac());
    }
    assert_eq!(vga.palette().colors(), scattered().on_dac().colors());
    assert_eq!(vga.read_port(WRITE), 0, "once around");
}

/// A second card, written as the register descriptions read: an address, a count, a latch and an array of entries.
struct NaiveDac {
    entries: [[u8; 3]; 256],
    address: usize,
    reading: bool,
    count: usize,
    latch: [u8; 3],
    mask: u8,
}

impl NaiveDac {
    fn write(&mut self, port: u16, value: u8) {
        match port {
            MASK => self.mask = value,
            READ => (self.address, self.reading, self.count) = ((usize::from(value) + 1) % 256, true, 0),
            WRITE => (self.address, self.reading, self.count) = (usize::from(value), false, 0),
            DATA => {
                self.latch[self.count] = value % 64;
                self.count = (self.count + 1) % 3;
                if self.count == 0 {
                    self.entries[self.address] = self.latch;
                    self.address = (self.address + 1) % 256;
                }
            }
            _ => {}
        }
    }

    fn read(&mut self, port: u16) -> u8 {
        match port {
            MASK => self.mask,
            READ => u8::from(self.reading) * 3,
            WRITE => self.address as u8,
            DATA => {
                if self.count == 0 {
                    self.latch = self.entries[(self.address + 255) % 256];
                }
                let value = self.latch[self.count];
                self.count = (self.count + 1) % 3;
                if self.count == 0 {
                    self.address = (self.address + 1) % 256;
                }
                value
            }
            // The clock is at the first dot.
            STATUS => 0,
            _ => 0xFF,
        }
    }
}

proptest! {
    #[test]
    fn any_port_traffic_does_what_the_registers_say(
        traffic in proptest::collection::vec((any::<bool>(), prop_oneof![4 => MASK..=DATA, 1 => any::<u16>()], any::<u8>()), 0..200)
    ) {
        let mut vga = Vga::new();
        let start = entries(&vga).try_into().unwrap();
        let mut naive =
            NaiveDac { entries: start, address: 0, reading: false, count: 0, latch: [0; 3], mask: 0xFF };
        for (write, port, value) in traffic {
            if write {
                vga.write_port(port, value);
                naive.write(port, value);
            } else {
                prop_assert_eq!(vga.read_port(port), naive.read(port), "port {:X}", port);
            }
        }
        prop_assert_eq!(entries(&vga), naive.entries.to_vec());
        let shown = palette_of(|i| Rgb::from_dac(naive.entries[usize::from(i & naive.mask)]));
        prop_assert_eq!(&vga.palette(), &shown.with_ramps(0).unwrap());
    }

    /// However the time is divided, the beam ends up where the elapsed dots put it.
    #[test]
    fn time_does_not_drift(steps in proptest::collection::vec(prop_oneof![0..100_u64, 0..20_000_000_u64, any::<u64>()], 0..20)) {
        let mut vga = Vga::new();
        let mut nanoseconds = 0_u128;
        for step in steps {
            vga.advance(step);
            nanoseconds += u128::from(step);
            let dots = nanoseconds * 25_175_000 / 1_000_000_000;
            let (line, dot) = (dots / 800 % 449, dots % 800);
            prop_assert_eq!((u128::from(vga.beam().line()), u128::from(vga.beam().dot())), (line, dot));
            let blank = line >= 400 || dot >= 640;
            let retrace = line == 412 || line == 413;
            prop_assert_eq!(vga.read_port(STATUS), u8::from(blank) + 8 * u8::from(retrace));

            // The next retrace begins in this many nanoseconds, and not one earlier.
            let ahead = vga.beam().nanoseconds_to_retrace();
            prop_assert!((1..=14_268_124).contains(&ahead));
            let mut other = vga.clone();
            other.advance(ahead - 1);
            let waiting = !other.beam().is_in_retrace() || other.beam().line() == 413 || retrace;
            other.advance(1);
            prop_assert!(waiting && other.beam().is_in_retrace());
            prop_assert_eq!((other.beam().line(), other.beam().dot()), (412, 0));
        }
    }
}

// Ports and clock

#[test]
fn other_ports_are_an_empty_bus() {
    let mut vga = busy();
    let before = (entries(&vga), vga.palette(), vga.stamp(), vga.memory().to_vec());
    for port in (0..=u16::MAX).filter(|port| !(MASK..=DATA).contains(port)) {
        vga.write_port(port, 0x55);
        if port != STATUS {
            assert_eq!(vga.read_port(port), 0xFF, "port {port:X}");
        }
    }
    assert_eq!((entries(&vga), vga.palette(), vga.stamp(), vga.memory().to_vec()), before);
    assert_eq!(vga.read_port(MASK), 0xFF);
}

/// One frame, dot by dot: 1,007 dots take 40,000 ns.
#[test]
fn a_frame_has_its_dots_shown_and_hidden() {
    let mut vga = Vga::new();
    let (mut shown, mut retrace, mut now) = (0, 0, 0);
    for dot in 0..800_u64 * 449 {
        // The first whole nanosecond at which this many dots have elapsed.
        let then = (dot * 40_000).div_ceil(1_007);
        vga.advance(then - now);
        now = then;
        let beam = vga.beam();
        assert_eq!((beam.line(), beam.dot()), ((dot / 800) as u32, (dot % 800) as u32));
        shown += u32::from(beam.is_displaying());
        retrace += u32::from(beam.is_in_retrace());
    }
    assert_eq!((shown, retrace), (640 * 400, 800 * 2));
}

#[test]
fn a_thousand_and_seven_frames_later_the_beam_is_back_at_the_start() {
    // 1,007 frames are 359,200 · 40,000 ns.
    let mut vga = Vga::new();
    for _ in 0..359_200 {
        vga.advance(40_000);
    }
    assert_eq!((vga.beam().line(), vga.beam().dot()), (0, 0));
    let hertz = f64::from(timing::DOT_CLOCK) / f64::from(timing::DOTS_PER_LINE * timing::LINES_PER_FRAME);
    assert_eq!(format!("{hertz:.3}"), "70.086");
}

#[test]
fn a_program_can_wait_for_the_retrace() {
    let mut vga = Vga::new();
    let mut microseconds = 0;
    while vga.read_port(STATUS) & timing::VERTICAL_RETRACE == 0 {
        vga.advance(1_000);
        microseconds += 1;
    }
    // 412 lines of 800 dots at 25.175 MHz: 13,092.4 µs.
    assert_eq!(microseconds, 13_093);
    let mut other = Vga::new();
    other.advance(other.beam().nanoseconds_to_retrace());
    assert_eq!(other.read_port(STATUS), 9);
}

// Plain calls

#[test]
fn plain_calls_leave_the_ports_alone() {
    let mut vga = Vga::new();
    vga.write_port(WRITE, 40);
    vga.write_port(DATA, 1);
    vga.write_port(DATA, 2);
    vga.set_palette(&scattered());
    vga.fade(&BIOS, &scattered(), 100);
    vga.cycle(.., 3);
    vga.write_port(DATA, 3);
    assert_eq!(vga.dac().entry(40), [1, 2, 3]);
    assert_eq!(vga.read_port(WRITE), 41);
}

#[test]
fn a_fade_begins_and_ends_at_its_palettes_and_runs_straight() {
    let (from, to) = (scattered(), palette_of(|i| Rgb::new(0, 255, i)));
    let mut vga = Vga::new();
    for t in 0..=300_u32 {
        vga.fade(&from, &to, t as u16);
        let t = t.min(256);
        let mix = |a: u8, b: u8| ((u32::from(a) * (256 - t) + u32::from(b) * t) / 256 / 4) as u8;
        for i in 0..=255 {
            let (a, b) = (from[i], to[i]);
            assert_eq!(vga.dac().entry(i), [mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)], "t {t}, entry {i}");
        }
        if t == 0 || t == 256 {
            assert_eq!(vga.palette().colors(), if t == 0 { &from } else { &to }.on_dac().colors());
        }
    }
    vga.fade(&from, &to, u16::MAX);
    assert_eq!(vga.palette().colors(), to.on_dac().colors());
}

#[test]
fn a_cycle_turns_its_range_and_nothing_else() {
    let lengths = [(0_u8, 255_u8), (0, 0), (255, 255), (16, 31), (200, 255), (1, 3)];
    for (first, last) in lengths {
        let length = i64::from(last) - i64::from(first) + 1;
        for steps in [0, 1, -1, 2, 15, 16, 17, -16, 255, 256, 257, -1000, i32::MAX, i32::MIN] {
            let mut vga = busy();
            let before = entries(&vga);
            vga.cycle(first..=last, steps);
            for (i, entry) in entries(&vga).into_iter().enumerate() {
                let mut from = i as i64;
                if (i64::from(first)..=i64::from(last)).contains(&from) {
                    from = i64::from(first) + (from - i64::from(first) - i64::from(steps)).rem_euclid(length);
                }
                assert_eq!(entry, before[from as usize], "{first} to {last} by {steps}, entry {i}");
            }
            vga.cycle(first..=last, 0_i32.wrapping_sub(steps));
            if steps != i32::MIN {
                assert_eq!(entries(&vga), before);
            }
        }
    }
}

#[test]
fn ranges_of_every_kind_cycle() {
    let turned = |range: &dyn Fn(&mut Vga)| {
        let mut vga = busy();
        range(&mut vga);
        entries(&vga)
    };
    let whole = turned(&|vga| vga.cycle(0..=255, 5));
    assert_eq!(turned(&|vga| vga.cycle(.., 5)), whole);
    assert_eq!(turned(&|vga| vga.cycle(0.., 5)), whole);
    assert_eq!(turned(&|vga| vga.cycle(16..32, 5)), turned(&|vga| vga.cycle(16..=31, 5)));
    assert_eq!(turned(&|vga| vga.cycle(..32, 5)), turned(&|vga| vga.cycle(..=31, 5)));
    let ramp = builtin::MATERIALS_8X32.ramp(2).unwrap();
    assert_eq!(turned(&|vga| vga.cycle(ramp.range(), 5)), turned(&|vga| vga.cycle(64..96, 5)));

    let still = entries(&busy());
    assert_eq!(turned(&|vga| vga.cycle(7..7, 5)), still);
    #[expect(clippy::reversed_empty_ranges, reason = "a range that runs backwards is the case")]
    let backwards = [turned(&|vga| vga.cycle(9..7, 5)), turned(&|vga| vga.cycle(255..=0, 5))];
    assert_eq!(backwards, [still.clone(), still]);
}

#[test]
fn the_card_starts_with_the_colours_of_the_bios() {
    let mut vga = Vga::new();
    assert_eq!(vga.palette(), BIOS);
    assert!(vga.memory().iter().all(|&byte| byte == 0));
    assert_eq!((vga.read_port(MASK), vga.read_port(STATUS)), (0xFF, 0));
    const { assert!(Vga::new().memory()[0] == 0, "Vga::new is const") };
}

#[test]
fn the_palettes_ramps_are_remembered() {
    let mut vga = Vga::new();
    vga.set_palette(&builtin::MATERIALS_4X64);
    assert_eq!(vga.palette(), builtin::MATERIALS_4X64.on_dac());
    vga.fade(&BIOS, &builtin::MATERIALS_8X32, 10);
    assert_eq!(vga.palette().ramps(), 8);
    vga.cycle(.., 1);
    assert_eq!(vga.palette().ramps(), 8);
}

// Stamp

#[test]
fn the_stamp_changes_with_every_mutable_access_and_with_nothing_else() {
    let mut vga = Vga::new();
    let mut seen = std::collections::BTreeSet::from([vga.stamp()]);
    for round in 0..100 {
        vga.poke(round, 0);
        assert!(seen.insert(vga.stamp()));
        let _ = vga.pixels_mut();
        assert!(seen.insert(vga.stamp()));
        let _ = vga.memory_mut();
        assert!(seen.insert(vga.stamp()));
        let before = vga.stamp();
        vga.set_palette(&scattered());
        vga.write_port(MASK, 3);
        vga.advance(1_000);
        vga.cycle(.., 1);
        vga.scan_out(&mut [0; 10]);
        let _ = (vga.memory(), vga.pixels(), vga.peek(5), vga.palette());
        assert_eq!(vga.stamp(), before);
    }
}

#[test]
fn equal_stamps_mean_equal_memory() {
    let (mut one, mut two) = (Vga::new(), Vga::new());
    assert_eq!(one.stamp(), two.stamp(), "neither was touched");
    one.poke(0, 1);
    two.poke(0, 2);
    assert_ne!(one.stamp(), two.stamp());

    let mut copy = one.clone();
    assert_eq!(copy.stamp(), one.stamp(), "the same bytes");
    copy.poke(1, 3);
    one.poke(1, 4);
    assert_ne!(copy.stamp(), one.stamp());

    // More than one block of stamps: the blocks of two machines stay separate.
    let mut seen = std::collections::BTreeSet::new();
    for k in 0..2_200_000 {
        one.poke(k, 0);
        two.poke(k, 0);
        if k % 1000 < 2 || (1_048_500..1_048_700).contains(&(k % 1_048_576)) {
            assert!(seen.insert(one.stamp()) && seen.insert(two.stamp()));
        }
    }
}

// Scan-out

#[test]
fn scan_out_looks_every_byte_up_through_the_mask() {
    for mask in [0xFF, 0x00, 0x0F, 0xF0, 0x55, 0x80] {
        let mut vga = busy();
        vga.write_port(MASK, mask);
        let mut rgb = vec![0; Vga::SHOWN];
        vga.scan_out(&mut rgb);
        for (k, &color) in rgb.iter().enumerate() {
            let [r, g, b] = vga.dac().entry(vga.pixels()[k] & mask).map(|v| u32::from((v << 2) | (v >> 4)));
            assert_eq!(color, r << 16 | g << 8 | b, "pixel {k}, mask {mask:X}");
            assert_eq!(color, u32::from(vga.palette()[vga.pixels()[k]]));
        }
        let mut rgba = vec![0; 4 * Vga::SHOWN];
        vga.scan_out_rgba(&mut rgba);
        for (k, (rgba, color)) in rgba.chunks(4).zip(&rgb).enumerate() {
            let [_, r, g, b] = color.to_be_bytes();
            assert_eq!(rgba, [r, g, b, 255], "pixel {k}, mask {mask:X}");
        }
        let mut row565 = [0; 320];
        for row in 0..200 {
            vga.scan_out_row_rgb565(row, &mut row565);
            for (x, &color) in row565.iter().enumerate() {
                let [r, g, b] = vga.dac().entry(vga.pixels()[320 * row + x] & mask).map(u16::from);
                // 6 bits to 5 by dropping one; green is unchanged.
                assert_eq!(color, (r >> 1) << 11 | g << 5 | b >> 1, "{x}, {row}, mask {mask:X}");
            }
        }
    }
}

#[test]
fn buffers_of_other_lengths_are_filled_as_far_as_they_go() {
    let vga = busy();
    let mut whole = vec![0; Vga::SHOWN];
    vga.scan_out(&mut whole);
    for length in [0, 1, 7, 320, 63_999, 64_001, 70_000] {
        let mut out = vec![0xDEAD_BEEF; length];
        vga.scan_out(&mut out);
        let filled = length.min(Vga::SHOWN);
        assert_eq!(out[..filled], whole[..filled]);
        assert!(out[filled..].iter().all(|&color| color == 0xDEAD_BEEF));
    }
    let mut whole = vec![0; 4 * Vga::SHOWN];
    vga.scan_out_rgba(&mut whole);
    for length in [0, 1, 3, 4, 1_279, 255_999, 256_001, 256_004] {
        let mut out = vec![0xEF; length];
        vga.scan_out_rgba(&mut out);
        let filled = length.min(4 * Vga::SHOWN) / 4 * 4;
        assert_eq!(out[..filled], whole[..filled]);
        assert!(out[filled..].iter().all(|&byte| byte == 0xEF));
    }
    for row in [0, 199] {
        let mut whole = [0; 320];
        vga.scan_out_row_rgb565(row, &mut whole);
        for length in [0, 1, 319, 321, 400] {
            let mut out = vec![0xBEEF; length];
            vga.scan_out_row_rgb565(row, &mut out);
            assert_eq!(out[..length.min(320)], whole[..length.min(320)]);
            assert!(out[length.min(320)..].iter().all(|&color| color == 0xBEEF));
        }
    }
    for row in [200, 201, usize::MAX] {
        let mut out = [0xBEEF; 320];
        vga.scan_out_row_rgb565(row, &mut out);
        assert_eq!(out, [0xBEEF; 320], "row {row}");
    }
}

#[test]
fn pixels_fill_a_screen_of_four_to_three() {
    let (width, height) = Vga::PIXEL_ASPECT;
    assert_eq!(Vga::WIDTH as u32 * width * 3, Vga::HEIGHT as u32 * height * 4);
    assert_eq!(Vga::PITCH * Vga::HEIGHT, Vga::SHOWN);
}
