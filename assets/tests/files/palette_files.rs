//! Palettes: the hard cases P1, P2 and P5, the ramps, the cube, the built-ins and their files.

use std::collections::BTreeSet;
use std::io;

use mode13h::fixed::U8F8;
use mode13h::palette::gradient::{Stop, fill};
use mode13h::palette::{BIOS, Palette, Ramp, Rgb, builtin, cube, dac6_to_8, to_dac6};
use mode13h_assets::palette_file::{self, FORMATS, Format, LoadErrorKind, PaletteError, PaletteErrorKind, Place};
use proptest::prelude::*;

use crate::support::property::property;
use crate::support::tried::Tried;
use crate::support::workspace::names_in;

fn format(name: &str) -> &'static Format {
    Format::by_name(name).unwrap()
}

fn palette_of(color: impl Fn(u8) -> Rgb) -> Palette {
    Palette::from_colors(core::array::from_fn(|i| color(i as u8)))
}

fn hash_like(i: u8, seed: u32) -> Rgb {
    Rgb::from((u32::from(i) + 1).wrapping_mul(0x9E37_79B9).wrapping_mul(seed | 1) >> 7)
}

// P1

#[test]
fn p1_six_bit_values_survive_eight_bits() {
    let mut tried = Tried::new("p1_six_bit_values_survive_eight_bits", 64);
    for v in 0..=63 {
        assert_eq!(to_dac6(dac6_to_8(v)), v);
        assert_eq!(dac6_to_8(v), (v << 2) | (v >> 4));
        // Spread evenly: within half a step of 255·v/63.
        assert!((i32::from(dac6_to_8(v)) * 63 - 255 * i32::from(v)).abs() < 63, "{v}");
        tried.add(1);
    }
    assert_eq!((dac6_to_8(0), dac6_to_8(63)), (0, 255));
}

#[test]
fn p1_eight_bit_values_round_down_and_stay_there() {
    let mut tried = Tried::new("p1_eight_bit_values_round_down_and_stay_there", 256);
    for v in 0..=255_u8 {
        assert_eq!(to_dac6(v), v / 4);
        let once = dac6_to_8(to_dac6(v));
        assert_eq!(dac6_to_8(to_dac6(once)), once);
        assert!(once.abs_diff(v) <= 3, "{v} shows as {once}");
        assert_eq!(dac6_to_8(v), dac6_to_8(v & 63), "the DAC has no seventh bit");
        tried.add(1);
    }
}

// P2 (without dither)

#[test]
fn p2_no_shade_leaves_its_ramp() {
    let mut tried = Tried::new("p2_no_shade_leaves_its_ramp", 256 * 257 / 2 * (11 + 8));
    let mut ramps = 0;
    for first in 0..=255_u8 {
        for entries in 0..=300_u16 {
            let fits = entries > 0 && u32::from(first) + u32::from(entries) <= 256;
            let Some(ramp) = Ramp::new(first, entries) else {
                assert!(!fits, "{first} + {entries}");
                continue;
            };
            assert!(fits, "{first} + {entries}");
            ramps += 1;
            let inside = usize::from(first)..usize::from(first) + usize::from(entries);
            for shade in [0, 1, entries - 1, entries, entries + 1, 255, 256, 257, 511, 512, u16::MAX] {
                let index = ramp.index(shade);
                assert!(inside.contains(&usize::from(index)) && ramp.contains(index));
                if shade < entries {
                    assert_eq!(u16::from(index), u16::from(first) + shade);
                }
                tried.add(1);
            }
            for intensity in [-1.0, 0.0, 0.5, 1.0 - f32::EPSILON, 1.0, 2.0, f32::NAN, f32::INFINITY] {
                let shade = U8F8::from_intensity(intensity, first, entries);
                assert!(ramp.contains(shade.nearest()), "{intensity} on {ramp:?}");
                tried.add(1);
            }
            assert_eq!((ramp.first(), ramp.entries()), (first, entries));
            assert_eq!(ramp.range().count(), usize::from(entries));
            assert_eq!(usize::from(ramp.last()) + 1, inside.end);
        }
    }
    assert_eq!(ramps, 256 * 257 / 2);
}

#[test]
fn p2_ramps_of_a_palette_share_the_entries_out() {
    let mut tried = Tried::new("p2_ramps_of_a_palette_share_the_entries_out", 301);
    for ramps in 0..=300 {
        tried.add(1);
        let palette = BIOS.with_ramps(ramps);
        assert_eq!(palette.is_some(), ramps == 0 || ramps <= 256 && 256 % ramps == 0, "{ramps}");
        let Some(palette) = palette else { continue };
        let mut next = 0;
        for i in 0..palette.ramps() {
            let ramp = palette.ramp(i).unwrap();
            assert_eq!(usize::from(ramp.first()), next);
            next += usize::from(ramp.entries());
        }
        assert_eq!(next, if ramps == 0 { 0 } else { 256 });
        for beyond in [palette.ramps(), palette.ramps() + 1, 256, 257, usize::MAX] {
            assert_eq!(palette.ramp(beyond), None);
        }
    }
}

// Colours and ramps

#[test]
fn packed_forms_are_what_their_names_say() {
    for (color, packed, rgb565) in [
        (Rgb::new(0x12, 0x34, 0x56), 0x0012_3456, 0x11AA),
        (Rgb::WHITE, 0x00FF_FFFF, 0xFFFF),
        (Rgb::new(255, 0, 0), 0x00FF_0000, 0xF800),
        (Rgb::new(0, 255, 0), 0x0000_FF00, 0x07E0),
        (Rgb::new(0, 0, 255), 0x0000_00FF, 0x001F),
    ] {
        assert_eq!((u32::from(color), color.to_rgb565()), (packed, rgb565));
        assert_eq!(Rgb::from(packed | 0xAB00_0000), color);
    }
    assert_eq!(Rgb::WHITE.brightness(), 255_000);
    assert_eq!(Rgb::WHITE.distance_squared(Rgb::BLACK), 3 * 255 * 255);
}

/// The exact fraction, in i64, rounded to the nearest, halves upward.
fn naive_gradient(i: u16, entries: u16, keys: &[Stop], channel: impl Fn(Rgb) -> u8) -> u8 {
    let (place, scale) = if entries == 1 { (255, 1) } else { (i64::from(i) * 255, i64::from(entries) - 1) };
    let at = |key: &Stop| i64::from(key.at) * scale;
    let (first, last) = (&keys[0], &keys[keys.len() - 1]);
    if place <= at(first) {
        return channel(first.color);
    }
    if place >= at(last) {
        return channel(last.color);
    }
    let pair = keys.windows(2).find(|pair| at(&pair[0]) <= place && place < at(&pair[1])).unwrap();
    let (a, b) = (i64::from(channel(pair[0].color)), i64::from(channel(pair[1].color)));
    let (along, length) = (place - at(&pair[0]), at(&pair[1]) - at(&pair[0]));
    // floor(x + 1/2) of a + (b − a)·along/length
    u8::try_from((2 * (a * length + (b - a) * along) + length).div_euclid(2 * length)).unwrap()
}

#[test]
fn gradients_equal_the_rounded_fraction() {
    let keys = [Stop::new(0, 0x00ff10), Stop::new(3, 0xff0011), Stop::new(100, 0x807f00), Stop::new(254, 0x0102ff)];
    for keys in [&keys[..], &keys[1..3], &keys[3..]] {
        for entries in 1..=256 {
            let ramp = Ramp::new(0, entries).unwrap();
            let mut colors = [Rgb::new(9, 9, 9); 256];
            fill(&mut colors, ramp, keys);
            for i in 0..entries {
                let color = colors[usize::from(i)];
                for channel in [|c: Rgb| c.r, |c: Rgb| c.g, |c: Rgb| c.b] {
                    assert_eq!(channel(color), naive_gradient(i, entries, keys, channel), "{i} of {entries}");
                }
            }
            assert!(colors[usize::from(entries)..].iter().all(|&color| color == Rgb::new(9, 9, 9)));
        }
    }
}

#[test]
fn gradients_of_odd_keys_end_well() {
    let mut colors = [Rgb::new(9, 9, 9); 256];
    fill(&mut colors, Ramp::WHOLE, &[]);
    assert_eq!(colors, [Rgb::new(9, 9, 9); 256]);
    // Keys that repeat or go back are ignored.
    let odd = [
        Stop::new(10, 0x111111),
        Stop::new(10, 0xffffff),
        Stop::new(5, 0xffffff),
        Stop::new(200, 0x222222),
        Stop::new(0, 0),
    ];
    fill(&mut colors, Ramp::WHOLE, &odd);
    let mut plain = [Rgb::BLACK; 256];
    fill(&mut plain, Ramp::WHOLE, &[odd[0], odd[3]]);
    assert_eq!(colors, plain);
}

#[test]
fn nearest_is_the_first_of_the_nearest() {
    let palette = palette_of(|i| hash_like(i / 2, 77));
    for i in 0..=255 {
        let found = palette.nearest(palette[i]);
        assert_eq!(palette[found], palette[i]);
        assert!(found <= i);
    }
    for seed in 0..200 {
        let color = hash_like(seed, 12345);
        let naive = (0..=255).min_by_key(|&i| palette[i].distance_squared(color)).unwrap();
        assert_eq!(palette.nearest(color), naive);
    }
}

#[test]
fn the_cube_finds_its_nearest_without_a_search() {
    // Every 5th value of a channel, and both ends: 52³ colours. And all that are almost grey, where the mean of the
    // three lies between two greys.
    let values: Vec<u8> = (0..=255).step_by(5).collect();
    let greys = (0..=255_u8).flat_map(|v| (0..27).map(move |k| [k / 9, k / 3 % 3, k % 3].map(|d| v.saturating_add(d))));
    let greys = greys.map(|[r, g, b]| Rgb::new(r, g, b));
    let mixtures = values
        .iter()
        .flat_map(|&r| values.iter().flat_map(move |&g| (0..=255).step_by(5).map(move |b| Rgb::new(r, g, b))));
    for color in greys.chain(mixtures) {
        assert_eq!(cube::nearest(color), cube::CUBE.nearest(color), "{color:?}");
        let among_mixtures = (0..216).min_by_key(|&i| cube::CUBE[i].distance_squared(color)).unwrap();
        assert_eq!(cube::nearest_mixture(color), among_mixtures, "{color:?}");
    }
}

#[test]
#[ignore = "16,777,216 searches: run it in release"]
fn the_cube_finds_the_nearest_of_every_colour() {
    for rgb in 0..=0xFF_FFFF {
        let color = Rgb::from(rgb);
        assert_eq!(cube::nearest(color), cube::CUBE.nearest(color), "{color:?}");
    }
}

#[test]
fn the_cube_is_exact_on_the_dac_and_has_no_colour_twice() {
    assert_eq!(cube::CUBE.on_dac(), cube::CUBE);
    assert_eq!(distinct(cube::CUBE.colors()), 256);
    assert_eq!(cube::CUBE[36 + 12 + 3], Rgb::from_dac([13, 25, 38]));
    assert!(cube::CUBE.colors()[216..].is_sorted_by(|a, b| a.brightness() < b.brightness()));
}

// The built-ins

fn distinct(colors: &[Rgb]) -> usize {
    colors.iter().collect::<BTreeSet<_>>().len()
}

#[test]
fn every_ramp_rises_in_every_channel_from_near_black_to_near_white() {
    for builtin in &builtin::ALL {
        for i in 0..builtin.palette.ramps() {
            let ramp = builtin.palette.ramp(i).unwrap();
            let colors = &builtin.palette.colors()[usize::from(ramp.first())..=usize::from(ramp.last())];
            let name = builtin.name;
            assert!(colors.is_sorted_by(|a, b| a.r <= b.r && a.g <= b.g && a.b <= b.b), "{name}, ramp {i}");
            assert!(colors[0].brightness() < 16_000, "{name}, ramp {i} begins at {:?}", colors[0]);
            let light = colors[colors.len() - 1];
            assert!(light.brightness() > 230_000, "{name}, ramp {i} ends at {light:?}");
        }
    }
}

/// Name, ramps, and the number of different colours on the DAC.
#[test]
fn builtins_have_their_ramps_and_shades() {
    let found: Vec<_> =
        builtin::ALL.iter().map(|b| (b.name, b.palette.ramps(), distinct(b.palette.on_dac().colors()))).collect();
    let expected = [
        ("grey", 1, 64),
        ("silver", 1, 178),
        ("copper", 1, 156),
        ("phosphor", 1, 148),
        ("materials-4x64", 4, 255),
        ("materials-8x32", 8, 256),
        ("materials-16x16", 16, 256),
        ("cube", 0, 256),
        ("bios", 0, 246),
    ];
    assert_eq!(found, expected);
}

#[test]
fn ramps_are_found_again_in_the_colours() {
    for builtin in &builtin::ALL {
        assert_eq!(&Palette::from_colors(*builtin.palette.colors()), builtin.palette, "{}", builtin.name);
    }
    // A short palette from dark to light, with the rest black, is not one ramp.
    assert_eq!(palette_of(|i| if i < 16 { Rgb::new(i, i, i) } else { Rgb::BLACK }).ramps(), 0);
    assert_eq!(palette_of(|_| Rgb::BLACK).ramps(), 0);
}

#[test]
fn names_are_found_and_differ() {
    assert_eq!(builtin::ALL.iter().map(|b| b.name).collect::<BTreeSet<_>>().len(), builtin::ALL.len());
    for builtin in &builtin::ALL {
        assert_eq!(builtin::by_name(builtin.name), Some(builtin));
        assert!(!builtin.provenance.contains('\n'));
    }
    assert_eq!(builtin::by_name("Copper"), None);
}

fn palettes_folder() -> std::path::PathBuf {
    crate::support::workspace::root().join("palettes")
}

/// The constructors are the reference. `MODE13H_WRITE_PALETTES=1` writes the files from them, and fails the test that
/// did so.
#[test]
fn the_files_in_palettes_are_the_builtins() {
    let write = std::env::var_os("MODE13H_WRITE_PALETTES").is_some();
    let mut files: BTreeSet<_> = names_in(&palettes_folder()).into_iter().filter(|name| name != "README.md").collect();
    for builtin in &builtin::ALL {
        let file_name = format!("{}.gpl", builtin.name);
        let path = palettes_folder().join(&file_name);
        let bytes = format("gimp").write(builtin.palette, builtin.name);
        if write {
            std::fs::write(&path, &bytes).unwrap();
        }
        let stored = std::fs::read(&path).unwrap_or_default();
        assert!(stored == bytes, "{file_name} differs from the palette that is compiled in");
        assert_eq!(palette_file::parse_named(&file_name, &stored).as_ref(), Ok(builtin.palette));
        files.remove(&file_name);
    }
    assert!(files.is_empty(), "files of no built-in palette: {files:?}");
    assert!(!write, "palettes written: look at them, then run without MODE13H_WRITE_PALETTES");
}

#[test]
fn the_readme_of_palettes_gives_every_provenance() {
    let readme = std::fs::read_to_string(palettes_folder().join("README.md")).unwrap();
    for builtin in &builtin::ALL {
        let row = format!("| `{}.gpl` | {} |", builtin.name, builtin.provenance);
        assert!(readme.contains(&row), "palettes/README.md lacks the row\n{row}");
    }
}

// Files: round trips

/// What a format gives back for a palette: the palette itself, except for dark colours in a raw file.
fn expected_back(format: &Format, palette: &Palette) -> Palette {
    let dark = palette.colors().iter().all(|c| c.r < 64 && c.g < 64 && c.b < 64);
    let colors = if format.name == "vga" && dark { palette.on_dac() } else { palette.clone() };
    Palette::from_colors(*colors.colors())
}

fn assert_round_trip(palette: &Palette) {
    for format in &FORMATS {
        let bytes = format.write(palette, "a name");
        assert_eq!(format.read(&bytes), Ok(expected_back(format, palette)), "{}", format.name);
        let file_name = format!("some.thing.{}", format.extensions[0].to_uppercase());
        assert_eq!(palette_file::parse_named(&file_name, &bytes), format.read(&bytes), "{file_name}");
        if format.name != "act" {
            assert_eq!(Format::of_bytes(&bytes).map(|found| found.name), Some(format.name));
            assert_eq!(palette_file::parse(&bytes), format.read(&bytes));
        }
    }
}

#[test]
fn written_palettes_are_read_back() {
    for builtin in &builtin::ALL {
        assert_round_trip(builtin.palette);
        assert_round_trip(&builtin.palette.on_dac());
    }
    assert_round_trip(&palette_of(|i| Rgb::new(i / 4, 0, 63)));
    assert_round_trip(&palette_of(|_| Rgb::BLACK));
}

#[test]
fn raw_files_have_six_bits_where_that_keeps_every_colour() {
    let raw = format("vga");
    let six = raw.write(&BIOS, "");
    assert_eq!(six.len(), 768);
    assert!(six.iter().all(|&value| value <= 63));
    assert_eq!(&six[3 * 6..][..3], [42, 21, 0]);
    assert_eq!(raw.write(&builtin::GREY, "")[765..], [255, 255, 255]);
}

#[test]
fn a_raw_file_with_a_value_over_63_has_eight_bits() {
    let mut bytes = [63; 768];
    assert_eq!(format("vga").read(&bytes), Ok(palette_of(|_| Rgb::WHITE)));
    for at in [0, 767] {
        bytes[at] = 64;
        let palette = format("vga").read(&bytes).unwrap();
        assert_eq!(palette[1], Rgb::new(63, 63, 63), "64 at {at}");
        bytes[at] = 63;
    }
}

#[test]
fn extensions_lead_to_formats() {
    for (name, expected) in [
        ("a.pal", Some("jasc")),
        ("a.b.GPL", Some("gimp")),
        ("a.Hex", Some("hex")),
        ("a.act", Some("act")),
        ("dir/a.vga", Some("vga")),
        ("a.raw", Some("vga")),
        ("a.col", Some("vga")),
        ("palette.lmp", Some("vga")),
        ("pal", None),
        ("a.", None),
        ("a.png", None),
        ("", None),
    ] {
        assert_eq!(Format::of_file_name(name).map(|format| format.name), expected, "{name}");
    }
}

#[test]
fn a_name_decides_where_bytes_cannot() {
    let dark: Vec<u8> = (0..768).map(|i| (i % 64) as u8).collect();
    let second = |name| palette_file::parse_named(name, &dark).unwrap()[1];
    assert_eq!(second("a.act"), Rgb::new(3, 4, 5));
    for name in ["a.vga", "a.raw", "a.col", "a.lmp", "a.pal", "a", "a.bin"] {
        assert_eq!(second(name), Rgb::from_dac([3, 4, 5]), "{name}");
    }
}

#[test]
fn an_act_of_772_bytes_has_as_many_colours_as_it_says() {
    let mut bytes = vec![200; 768];
    bytes.extend([0, 2, 0, 1]);
    let palette = palette_file::parse_named("a.act", &bytes).unwrap();
    assert_eq!(palette, palette_of(|i| if i < 2 { Rgb::new(200, 200, 200) } else { Rgb::BLACK }));
    assert_eq!(palette_file::parse(&bytes), Ok(palette));
}

#[test]
fn a_gimp_name_of_two_lines_becomes_one() {
    let bytes = format("gimp").write(&BIOS, "two\nlines, ünïcode");
    assert!(bytes.starts_with("GIMP Palette\nName: two lines, ünïcode\nColumns: 16\n#\n  0   0   0\t0\n".as_bytes()));
    assert_eq!(palette_file::parse(&bytes), Ok(BIOS));
}

// P5

fn jasc_lines(count: &str, colors: usize) -> String {
    format!("JASC-PAL\n0100\n{count}\n{}", "1 2 3\n".repeat(colors))
}

#[test]
fn p5_text_is_read_whatever_ends_its_lines() {
    let mut tried = Tried::new("p5_text_is_read_whatever_ends_its_lines", 5 * 7);
    let texts = [
        ("jasc", "JASC-PAL\n0100\n2\n0 0 0\n 255\t128  7 \n"),
        ("jasc", "JASC-PAL\n0100\n2\n0 0 0 255\n255 128 7\t0\n"),
        ("gimp", "GIMP Palette\nName: x\nColumns: 2\n# note\n\n  0   0   0\tblack\n255 128 7 a name of words\n"),
        ("hex", "000000\nff8007\n"),
        ("hex", "#000000\n#FF8007\n"),
    ];
    let expected = palette_of(|i| if i == 1 { Rgb::new(255, 128, 7) } else { Rgb::BLACK });
    for (name, text) in texts {
        let endings = [
            text.to_owned(),
            text.replace('\n', "\r\n"),
            text.replace('\n', "\r"),
            text.trim_end_matches('\n').to_owned(),
            format!("{text}\n\n"),
            format!("\u{FEFF}{text}"),
            format!("\u{FEFF}{}", text.replace('\n', "\r\n")),
        ];
        for text in endings {
            assert_eq!(format(name).read(text.as_bytes()), Ok(expected.clone()), "{text:?}");
            assert_eq!(palette_file::parse(text.as_bytes()), Ok(expected.clone()), "{text:?}");
            tried.add(1);
        }
    }
}

/// Format, file, the whole message.
#[test]
fn p5_broken_files_are_refused_with_their_place() {
    let mut tried = Tried::new("p5_broken_files_are_refused_with_their_place", 43);
    let jasc = |text: &str| ("jasc", text.as_bytes().to_vec());
    let gimp = |text: &str| ("gimp", text.as_bytes().to_vec());
    let hex = |text: &str| ("hex", text.as_bytes().to_vec());
    let mut act_of_257 = vec![0; 768];
    act_of_257.extend([1, 1, 0xFF, 0xFF]);
    let mut act_of_0 = vec![0; 768];
    act_of_0.extend([0, 0, 0xFF, 0xFF]);
    let cases = [
        // Short.
        (jasc("JASC-PAL"), "line 2: expected \"0100\", found \"\""),
        (jasc("JASC-PAL\n0100\n"), "line 3: expected the number of colours, 1 to 256, found \"\""),
        (jasc(&jasc_lines("4", 3)), "line 7: the file ends after 3 of 4 colours"),
        (jasc(&(jasc_lines("4", 3) + "\n\n")), "line 7: the file ends after 3 of 4 colours"),
        (jasc(&jasc_lines("256", 0)), "line 4: the file ends after 0 of 256 colours"),
        (gimp("GIMP Palette\nName: x\n#\n"), "line 4: the file ends after 0 of 1 colours"),
        (hex("\n\n"), "line 3: the file ends after 0 of 1 colours"),
        (("vga", vec![0; 767]), "offset 767: expected 768 bytes, found 767"),
        (("act", vec![0; 767]), "offset 767: expected 768 or 772 bytes, found 767"),
        (("act-772", vec![0; 771]), "offset 771: expected 768 or 772 bytes, found 771"),
        // Long.
        (jasc(&jasc_lines("4", 5)), "line 8: more than the 4 colours that the file announces"),
        (jasc(&(jasc_lines("2", 2) + "the end\n")), "line 6: more than the 2 colours that the file announces"),
        (("vga", vec![0; 769]), "offset 768: expected 768 bytes, found 769"),
        (("act", vec![0; 773]), "offset 772: expected 768 or 772 bytes, found 773"),
        // 257 entries.
        (jasc(&jasc_lines("257", 257)), "line 3: expected the number of colours, 1 to 256, found \"257\""),
        (jasc(&jasc_lines("256", 257)), "line 260: more than the 256 colours that the file announces"),
        (gimp(&("GIMP Palette\n".to_owned() + &"1 2 3\n".repeat(257))), "line 258: more than 256 colours"),
        (hex(&"010203\r\n".repeat(257)), "line 257: more than 256 colours"),
        (("act", act_of_257), "offset 768: expected the number of colours, 1 to 256, found \"257\""),
        (("vga", vec![0; 771]), "offset 768: expected 768 bytes, found 771"),
        // No entries.
        (jasc(&jasc_lines("0", 0)), "line 3: expected the number of colours, 1 to 256, found \"0\""),
        (("act", act_of_0), "offset 768: expected the number of colours, 1 to 256, found \"0\""),
        // Text in numbers.
        (jasc("JASC-PAL\n0100\n2\n0 0 0\nred 0 0\n"), "line 5: expected three numbers 0 to 255, found \"red 0 0\""),
        (jasc("JASC-PAL\n0100\n1\n0 0\n"), "line 4: expected three numbers 0 to 255, found \"0 0\""),
        (jasc("JASC-PAL\n0100\n1\n0 0 0 256\n"), "line 4: expected three numbers 0 to 255, found \"0 0 0 256\""),
        (jasc("JASC-PAL\n0100\n1\n0 0 0 0 0\n"), "line 4: expected three numbers 0 to 255, found \"0 0 0 0 0\""),
        (jasc("JASC-PAL\n0100\n1\n0 0 256\n"), "line 4: expected three numbers 0 to 255, found \"0 0 256\""),
        (jasc("JASC-PAL\n0100\n1\n0 -1 0\n"), "line 4: expected three numbers 0 to 255, found \"0 -1 0\""),
        (jasc("JASC-PAL\n0100\n1\n0 +1 0\n"), "line 4: expected three numbers 0 to 255, found \"0 +1 0\""),
        (jasc("JASC-PAL\n0100\n1\n0 1.5 0\n"), "line 4: expected three numbers 0 to 255, found \"0 1.5 0\""),
        (jasc("JASC-PAL\n0100\nmany\n"), "line 3: expected the number of colours, 1 to 256, found \"many\""),
        (
            jasc("JASC-PAL\n0100\n99999999999999999999\n"),
            "line 3: expected the number of colours, 1 to 256, found \"99999999999999999999\"",
        ),
        (jasc("JASC-PAL\n0200\n1\n0 0 0\n"), "line 2: expected \"0100\", found \"0200\""),
        (
            gimp("GIMP Palette\r\nName: x\r\n0 0 0 ok\r\n0 0 red\r\n"),
            "line 4: expected three numbers 0 to 255, found \"0 0 red\"",
        ),
        (gimp("GIMP Palette\n1 2 3\nName: late\n"), "line 3: expected three numbers 0 to 255, found \"Name: late\""),
        (
            gimp("GIMP Palette\nhow it came to this is a longer story, and sad\n"),
            "line 2: expected three numbers 0 to 255, found \"how it came to this is a longer ...\"",
        ),
        (hex("0000g0\n"), "line 1: expected six hexadecimal digits, found \"0000g0\""),
        (hex("000000\n00000\n"), "line 2: expected six hexadecimal digits, found \"00000\""),
        (hex("000000\n+12345\n"), "line 2: expected six hexadecimal digits, found \"+12345\""),
        (hex("000000\nff000000\n"), "line 2: expected six hexadecimal digits, found \"ff000000\""),
        (hex("000000\n\0\u{7f}é\n"), "line 2: expected six hexadecimal digits, found \"????\""),
        // Another format's file.
        (jasc("RIFF"), "line 1: expected \"JASC-PAL\", found \"RIFF\""),
        (gimp("JASC-PAL\n"), "line 1: expected \"GIMP Palette\", found \"JASC-PAL\""),
    ];
    for ((name, bytes), message) in cases {
        let error = format(name).read(&bytes).expect_err(message);
        assert_eq!(error.to_string(), message);
        tried.add(1);
    }
}

#[test]
fn p5_an_empty_file_is_called_empty() {
    let mut tried = Tried::new("p5_an_empty_file_is_called_empty", 6 + 3);
    for format in &FORMATS {
        let error = format.read(b"").unwrap_err();
        assert_eq!((error.kind, error.place), (PaletteErrorKind::Empty, Place::Offset(0)));
        tried.add(1);
    }
    for error in
        [palette_file::parse(b""), palette_file::parse_named("a.gpl", b""), palette_file::parse_named("a", b"")]
    {
        assert_eq!(error.unwrap_err().to_string(), "offset 0: the file is empty");
        tried.add(1);
    }
}

#[test]
fn p5_what_looks_like_nothing_is_said_to() {
    let mut tried = Tried::new("p5_what_looks_like_nothing_is_said_to", 5 + 1);
    let utf16 = "\u{FEFF}JASC-PAL\n".encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    for bytes in [&b"hello\n"[..], &[0; 700], &[0xFF; 769], &utf16, b"\n"] {
        let error = palette_file::parse(bytes).unwrap_err();
        assert_eq!(error.to_string(), "offset 0: not a JASC, GIMP, Lospec, Adobe or raw VGA palette");
        tried.add(1);
    }
    // With a name given, the message is the format's own.
    let error: PaletteError = palette_file::parse_named("a.pal", &utf16).unwrap_err();
    assert_eq!(error.to_string(), "line 1: expected \"JASC-PAL\", found \"??J?A?S?C?-?P?A?L?\"");
    tried.add(1);
}

fn any_palette() -> impl Strategy<Value = Palette> {
    let dark = prop_oneof![Just(255_u8), Just(63)];
    (proptest::collection::vec(any::<[u8; 3]>(), 256), dark).prop_map(|(colors, mask)| {
        palette_of(|i| {
            let [r, g, b] = colors[usize::from(i)].map(|v| v & mask);
            Rgb::new(r, g, b)
        })
    })
}

/// Random bytes; a text's characters; a valid file with something changed.
fn any_file() -> impl Strategy<Value = Vec<u8>> {
    let any_bytes = proptest::collection::vec(any::<u8>(), 0..1000);
    let text =
        proptest::collection::vec(proptest::sample::select(&b"JASC-PAL0123456789 \r\n#GIMPalettef\t"[..]), 0..400);
    let damaged = (
        any_palette(),
        0..FORMATS.len(),
        proptest::collection::vec((any::<usize>(), any::<u8>()), 0..4),
        any::<usize>(),
    )
        .prop_map(|(palette, format, changes, length)| {
            let mut bytes = FORMATS[format].write(&palette, "x");
            for (at, byte) in changes {
                let at = at % bytes.len();
                bytes[at] = byte;
            }
            bytes.truncate(length % (2 * bytes.len()));
            bytes
        });
    prop_oneof![any_bytes, text, damaged]
}

proptest! {
    #[test]
    fn any_palette_is_read_back(palette in any_palette()) {
        assert_round_trip(&palette);
        assert_round_trip(&palette.on_dac());
    }
}

/// Whatever the file contains: a palette, or an error at a position in it.
#[test]
fn p5_no_bytes_make_a_reader_panic_and_errors_lie_in_the_file() {
    let tried = Tried::new("p5_no_bytes_make_a_reader_panic_and_errors_lie_in_the_file", 256);
    property(tried, any_file(), |bytes| {
        let mut results: Vec<_> = FORMATS.iter().map(|format| format.read(&bytes)).collect();
        results.push(palette_file::parse(&bytes));
        results.extend(
            ["a.pal", "a.gpl", "a.hex", "a.act", "a.vga", "a"].map(|name| palette_file::parse_named(name, &bytes)),
        );
        for error in results.into_iter().filter_map(Result::err) {
            match error.place {
                Place::Offset(offset) => prop_assert!(offset <= bytes.len()),
                Place::Line(line) => {
                    let ends = bytes.iter().filter(|byte| matches!(byte, b'\n' | b'\r')).count();
                    prop_assert!((1..=ends + 2).contains(&line));
                }
            }
            prop_assert!(!error.to_string().contains(['\n', '\r']));
        }
        Ok(())
    });
}

#[test]
fn a_file_is_loaded_by_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("two.hex"), "000000\nff8000\n").expect("written");
    assert_eq!(palette_file::load(path("two.hex")).expect("a palette")[1], Rgb::new(0xFF, 0x80, 0));

    std::fs::write(path("broken.gpl"), "nothing").expect("written");
    let error = palette_file::load(path("broken.gpl")).expect_err("broken");
    assert!(matches!(error.kind, LoadErrorKind::Palette(_)), "{error}");
    assert!(error.to_string().starts_with(&format!("{}: line 1", path("broken.gpl").display())), "{error}");

    let error = palette_file::load(path("none.gpl")).expect_err("no file");
    assert!(matches!(&error.kind, LoadErrorKind::Read(read) if read.kind() == io::ErrorKind::NotFound), "{error}");
    assert!(palette_file::load(folder.path()).is_err());
}

/// An endless device is read up to the greatest length of a palette file.
#[cfg(unix)]
#[test]
fn a_file_without_an_end_is_an_error() {
    let error = palette_file::load("/dev/zero").expect_err("no palette");
    assert!(matches!(error.kind, LoadErrorKind::Palette(_)), "{error}");
}
