//! Palettes and tables equal those of the engine.

use std::ffi::CStr;

use mode13h::palette::{Lut64K, Palette, Rgb, builtin};
use mode13h::vga::Vga;
use mode13h_capi::color::*;
use mode13h_conformance::random::Random;

fn bytes(colors: &[Rgb; 256]) -> Vec<u8> {
    colors.iter().flat_map(|color| [color.r, color.g, color.b]).collect()
}

fn random_colors(random: &mut Random) -> [Rgb; 256] {
    // Few greens, so that many colours are equally near.
    core::array::from_fn(|_| Rgb::new(random.below(256) as u8, (random.below(9) * 31) as u8, random.below(256) as u8))
}

#[test]
fn palettes_are_those_that_are_compiled_in() {
    for (i, builtin) in builtin::ALL.iter().enumerate() {
        let name = m13_palette_name(i as u32);
        // SAFETY: names end with a zero.
        assert_eq!(unsafe { CStr::from_ptr(name) }.to_str(), Ok(builtin.name));
        let mut copy = vec![0; 768];
        // SAFETY: a name, and 768 bytes.
        assert_eq!(unsafe { m13_palette_named(name, copy.as_mut_ptr()) }, 0);
        assert_eq!(copy, bytes(builtin.palette.colors()));
    }
    assert!(m13_palette_name(builtin::ALL.len() as u32).is_null());
    let mut copy = vec![5; 768];
    for name in [c"", c"gre", c"greyish", c"mauve"] {
        // SAFETY: as above.
        assert_eq!(unsafe { m13_palette_named(name.as_ptr(), copy.as_mut_ptr()) }, -16, "{name:?}");
    }
    assert_eq!(copy, vec![5; 768]);
}

#[test]
fn tables_are_those_of_the_engine() {
    let mut random = Random::named("tables of C");
    for palette in [builtin::MATERIALS_8X32.clone(), Palette::from_colors(random_colors(&mut random))] {
        let (colors, other) = (bytes(palette.colors()), random_colors(&mut random));
        let texels = bytes(&other);
        let fog = Rgb::new(90, 120, 140);
        let (from, mut table) = (colors.as_ptr(), vec![0; 65_536]);
        let mut is = |should: &Lut64K, make: &dyn Fn(*mut u8) -> i32| {
            assert_eq!(make(table.as_mut_ptr()), 0);
            assert!(table == should.as_array());
        };
        // SAFETY: 768 and 65,536 bytes.
        unsafe {
            is(&Lut64K::shades(&palette, palette.colors()), &|to| m13_table_shades(from, core::ptr::null(), to));
            is(&Lut64K::shades(&palette, &other), &|to| m13_table_shades(from, texels.as_ptr(), to));
            is(&Lut64K::fog(&palette, fog), &|to| m13_table_fog(from, fog.into(), to));
            for opacity in [0, 1, 128, 255] {
                is(&Lut64K::blend(&palette, opacity), &|to| m13_table_blend(from, opacity, to));
            }
            is(&Lut64K::add(&palette), &|to| m13_table_add(from, to));
        }
    }
}

#[test]
fn the_card_shows_the_same() {
    let mut random = Random::named("the card of C");
    let (a, b) = (random_colors(&mut random), random_colors(&mut random));
    let (from, other) = (bytes(&a), bytes(&b));
    let (palette, to) = (Palette::from_colors(a), Palette::from_colors(b));
    let mut out = vec![0; 768];
    for part in [0, 1, 100, 255, 256, 1_000] {
        let mut vga = Vga::new();
        vga.fade(&palette, &to, part);
        // SAFETY: 768 bytes each.
        assert_eq!(unsafe { m13_palette_fade(from.as_ptr(), other.as_ptr(), part.into(), out.as_mut_ptr()) }, 0);
        // The card rounds down to six bits.
        let mut six = vec![0; 768];
        // SAFETY: as above.
        assert_eq!(unsafe { m13_palette_to_dac(out.as_ptr(), six.as_mut_ptr()) }, 0);
        let should: Vec<u8> = (0..=255).flat_map(|index| vga.dac().entry(index)).collect();
        assert_eq!(six, should);
        // SAFETY: as above.
        assert_eq!(unsafe { m13_palette_from_dac(six.as_ptr(), out.as_mut_ptr()) }, 0);
        assert_eq!(out, bytes(vga.palette().colors()));
    }
    for (first, entries, steps) in [(0, 256, 1), (10, 20, -3), (255, 1, 5), (7, 0, 2), (16, 16, 1_000_003)] {
        let (mut vga, mut cycled) = (Vga::new(), from.clone());
        vga.set_palette(&palette);
        if entries > 0 {
            vga.cycle(first..=(first as u32 + entries - 1) as u8, steps);
        }
        // SAFETY: as above.
        assert_eq!(unsafe { m13_palette_cycle(cycled.as_mut_ptr(), first.into(), entries, steps) }, 0);
        // SAFETY: as above.
        unsafe { m13_palette_to_dac(cycled.as_ptr(), out.as_mut_ptr()) };
        let should: Vec<u8> = (0..=255).flat_map(|index| vga.dac().entry(index)).collect();
        assert_eq!(out, should);
    }
    for _ in 0..2_000 {
        let color = Rgb::new(random.below(256) as u8, random.below(256) as u8, random.below(256) as u8);
        // SAFETY: as above.
        let nearest = unsafe { m13_palette_nearest(from.as_ptr(), color.into()) };
        assert_eq!(nearest, i32::from(palette.nearest(color)));
    }
    let mut pixels: Vec<u8> = (0..7 * 5).map(|_| random.below(256) as u8).collect();
    let canvas = crate::target(&mut pixels, 6, 5, 7);
    let (mut wide, mut narrow) = (vec![1_u32; 8 * 5], vec![1_u16; 8 * 5]);
    // SAFETY: the buffers have the sizes that the header requires.
    unsafe {
        assert_eq!(m13_show_32(&canvas, from.as_ptr(), wide.as_mut_ptr(), 160, 32), 0);
        assert_eq!(m13_show_16(&canvas, from.as_ptr(), narrow.as_mut_ptr(), 80, 16), 0);
    }
    let shown = palette.on_dac();
    for (i, (wide, narrow)) in wide.iter().zip(&narrow).enumerate() {
        let (x, y) = (i % 8, i / 8);
        let color = shown[pixels[y * 7 + x.min(5)]];
        let should = if x < 6 { (u32::from(color), color.to_rgb565()) } else { (1, 1) };
        assert_eq!((*wide, *narrow), should, "{x}, {y}");
    }
}
