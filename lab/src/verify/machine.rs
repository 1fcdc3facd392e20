//! Group P: the machine and its palettes.

use super::Group;
use super::random::Random;
use mode13h::fixed::U8F8;
use mode13h::palette::{BIOS, Palette, Ramp, Rgb, builtin, dac6_to_8, to_dac6};
use mode13h::vga::{Dac, Vga};

/// 6 bits to 8 and back (P1), shades that stay in their ramp (P2), offsets that wrap (P3), and random
/// traffic on the DAC's ports, broken off writes among it, against a register-by-register model (P4).
///
/// ```
/// let group = mode13h_lab::verify::machine(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn machine(seed: u64) -> Group {
    check(seed, &dac6_to_8, &U8F8::from_intensity, &|vga, port, value| vga.write_port(port, value))
}

type Expand<'a> = &'a dyn Fn(u8) -> u8;
type Shade<'a> = &'a dyn Fn(f32, u8, u16) -> U8F8;
type Out<'a> = &'a dyn Fn(&mut Vga, u16, u8);

fn check(seed: u64, dac6_to_8: Expand<'_>, shade: Shade<'_>, out: Out<'_>) -> Group {
    let mut group = Group::new("machine");
    let mut random = Random::new(seed, "machine");
    for value in 0..64 {
        let eight = dac6_to_8(value);
        // 255 in 63 steps, each of 4 or 5: within one of the straight line.
        let right = to_dac6(eight) == value && eight.abs_diff((u16::from(value) * 255 / 63) as u8) <= 1;
        group.check(right, || format!("p1 6-bit {value} becomes {eight}, and back {}", to_dac6(eight)));
    }
    for value in 0..=255 {
        let once = Rgb::new(value, value, value).on_dac();
        group.check(once.on_dac() == once && once.r.abs_diff(value) < 4, || {
            format!("p1 8-bit {value} shows as {once:?}")
        });
    }
    ramps(&mut group, &mut random, shade);
    wraps(&mut group, &mut random);
    ports(&mut group, &mut random, out);
    group
}

/// P2: intensities at either end, and beyond it, on ramps of any length.
fn ramps(group: &mut Group, random: &mut Random, shade: Shade<'_>) {
    for _ in 0..5_000 {
        let first = random.below(256) as u8;
        let entries = if random.below(8) == 0 { 1 } else { 1 + random.below(256 - u32::from(first)) as u16 };
        let Some(ramp) = Ramp::new(first, entries) else { continue };
        let any = random.around_zero(2.0) as f32;
        let intensity = random.one_of(&[0.0, 1.0, f32::INFINITY, f32::NAN, -1e-45, 1.0 - f32::EPSILON / 2.0, any]);
        let byte = shade(intensity, first, entries).nearest();
        group.check(ramp.contains(byte), || format!("p2 intensity {intensity} on {ramp:?} is entry {byte}"));
    }
    for builtin in &builtin::ALL {
        // The ramps of a palette follow each other without a gap.
        let ramps: Vec<Ramp> = (0..builtin.palette.ramps()).filter_map(|i| builtin.palette.ramp(i)).collect();
        let entries: u32 = ramps.iter().map(|ramp| u32::from(ramp.entries())).sum();
        let right = ramps.len() == builtin.palette.ramps() && (entries == 256 || ramps.is_empty());
        group.check(right, || format!("p2 the ramps of the palette {} are {ramps:?}", builtin.name));
    }
}

/// P3: reads and writes at any offset.
fn wraps(group: &mut Group, random: &mut Random) {
    let mut vga = Vga::new();
    let mut model = vec![0_u8; Vga::MEMORY];
    for _ in 0..5_000 {
        let near = (random.within(0, 3) * 65_536 + random.within(-3, 3)).max(0) as u32;
        let offset = random.one_of(&[near, random.clone().next() as u32, 63_999, 64_000, u32::MAX]);
        let byte = random.below(256) as u8;
        vga.poke(offset, byte);
        model[(offset % 65_536) as usize] = byte;
        let read = random.below(u32::MAX);
        let (is, should) = (vga.peek(read), model[(read % 65_536) as usize]);
        group.check(is == should && vga.peek(offset) == byte, || {
            format!("p3 offset {read:#x} holds {is}, not {should}")
        });
    }
    let shown = vga.memory()[..] == model[..] && *vga.pixels() == model[..64_000];
    group.check(shown, || "p3 the memory is not what was written".into());
}

/// The DAC, register by register, in 6 bits.
struct Model {
    entries: [[u8; 3]; 256],
    address: u8,
    count: usize,
    pending: [u8; 3],
}

/// P4: three writes make an entry; fewer, and then a new index, leave it.
fn ports(group: &mut Group, random: &mut Random, out: Out<'_>) {
    let mut vga = Vga::new();
    let bios = BIOS.colors().map(Rgb::to_dac);
    let mut model = Model { entries: bios, address: 0, count: 0, pending: [0; 3] };
    for step in 0..4_000 {
        let value = random.below(256) as u8;
        if random.below(5) == 0 {
            out(&mut vga, Dac::WRITE_INDEX, value);
            (model.address, model.count) = (value, 0);
        } else {
            out(&mut vga, Dac::DATA, value);
            model.pending[model.count] = value % 64;
            model.count = (model.count + 1) % 3;
            if model.count == 0 {
                model.entries[usize::from(model.address)] = model.pending;
                model.address = model.address.wrapping_add(1);
            }
        }
        let wrong = (0..=255).find(|index| vga.dac().entry(*index) != model.entries[usize::from(*index)]);
        let index = vga.read_port(Dac::WRITE_INDEX);
        group.check(wrong.is_none() && index == model.address, || {
            let entry = wrong.unwrap_or(index);
            let (is, should) = (vga.dac().entry(entry), model.entries[usize::from(entry)]);
            format!("p4 write {step}: index {index}, not {}; entry {entry} is {is:?}, not {should:?}", model.address)
        });
    }
    // Read back by the port: 3C7h, then three times 3C9h for each entry.
    vga.write_port(Dac::READ_INDEX, 0);
    for index in 0..=255_u8 {
        let read = [0; 3].map(|_| vga.read_port(Dac::DATA));
        group.check(read == model.entries[usize::from(index)], || format!("p4 entry {index} reads as {read:?}"));
    }
    // What the palette shows, and what is scanned out: the entries, in 8 bits.
    let colors = model.entries.map(Rgb::from_dac);
    for (pixel, byte) in vga.pixels_mut().iter_mut().zip((0..=255).cycle()) {
        *pixel = byte;
    }
    let mut shown = vec![0; Vga::SHOWN];
    vga.scan_out(&mut shown);
    let scanned = shown.iter().zip(colors.iter().cycle()).all(|(is, color)| *is == u32::from(*color));
    group.check(scanned && vga.palette().colors() == &colors, || "p1 the picture is not in the DAC's colours".into());
    let set = Palette::from_colors(colors);
    vga.set_palette(&set);
    group.check(vga.palette().colors() == &colors, || "p1 a palette of 6 bits is not kept".into());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_machine_is_right() {
        let group = machine(1);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 14_000);
    }

    fn first_failure(dac6_to_8: Expand<'_>, shade: Shade<'_>, out: Out<'_>) -> String {
        let group = check(1, dac6_to_8, shade, out);
        group.failures.into_iter().next().expect("a failure")
    }

    #[test]
    fn faults_are_told() {
        let out: Out<'_> = &|vga, port, value| vga.write_port(port, value);
        let line = first_failure(&|six| (six & 63) << 2, &U8F8::from_intensity, out);
        assert!(line.starts_with("p1 6-bit "), "{line}");
        // A ramp's entries counted from 1.
        let over = |intensity: f32, first: u8, entries: u16| U8F8::from_intensity(intensity, first, entries + 1);
        let line = first_failure(&dac6_to_8, &over, out);
        assert!(line.starts_with("p2 intensity "), "{line}");
        // A write index that does not start the count of three anew.
        let keeps = |vga: &mut Vga, port: u16, value: u8| {
            if port != Dac::WRITE_INDEX || value > 128 {
                vga.write_port(port, value);
            }
        };
        let line = first_failure(&dac6_to_8, &U8F8::from_intensity, &keeps);
        assert!(line.starts_with("p4 write "), "{line}");
    }
}
