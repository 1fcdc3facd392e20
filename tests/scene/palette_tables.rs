//! Tables made from palettes, compared with a search through all 256 entries and mixtures in exact fractions.

use crate::support::tried::Tried;
use mode13h::palette::{InverseColormap, Lut64K, NearestColors, Palette, Rgb, builtin};
use mode13h_conformance::Random;

// The oracle

/// The first of the nearest of `colors`, by the sum of the squared differences.
fn naive_nearest(colors: &[Rgb], color: Rgb) -> u8 {
    let square = |a: u8, b: u8| (i32::from(a) - i32::from(b)).pow(2);
    let distance = |c: &Rgb| square(c.r, color.r) + square(c.g, color.g) + square(c.b, color.b);
    let least = colors.iter().map(distance).min().expect("colours");
    colors.iter().position(|c| distance(c) == least).expect("found") as u8
}

/// What the card shows: the upper 6 bits, with the highest of them repeated below.
fn shown(color: Rgb) -> Rgb {
    let channel = |v: u8| (v / 4 * 4) + v / 64;
    Rgb::new(channel(color.r), channel(color.g), channel(color.b))
}

fn all_shown(palette: &Palette) -> Vec<Rgb> {
    palette.colors().map(shown).to_vec()
}

/// floor((numerator / 255) + ½) of each channel.
fn nearest_255th(numerators: [u32; 3]) -> Rgb {
    let [r, g, b] = numerators.map(|n| u8::try_from((2 * n + 255) / 510).expect("a channel"));
    Rgb::new(r, g, b)
}

/// `a·(255 − share)/255 + b·share/255`, rounded once.
fn naive_mix(a: Rgb, b: Rgb, share: u8) -> Rgb {
    let share = u32::from(share);
    let channel = |a: u8, b: u8| u32::from(a) * (255 - share) + u32::from(b) * share;
    nearest_255th([channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)])
}

// Test cases

fn random_color(random: &mut Random) -> Rgb {
    Rgb::from(random.next_u64() as u32)
}

/// The built-in palettes, and extreme ones: one colour, two, twelve repeated, a single grey except for one channel, a
/// cluster in a corner with a few far from it, random.
fn palettes() -> Vec<(String, Palette)> {
    let mut palettes: Vec<_> =
        builtin::ALL.iter().map(|builtin| (builtin.name.to_string(), builtin.palette.clone())).collect();
    let mut random = Random::named("palettes");
    let one = random_color(&mut random);
    let twelve: Vec<Rgb> = (0..12).map(|_| random_color(&mut random)).collect();
    let cluster: [Rgb; 256] = core::array::from_fn(|i| {
        let color = random_color(&mut random);
        if i % 32 == 0 { color } else { Rgb::new(200 | color.r >> 4, 200 | color.g >> 4, 200 | color.b >> 4) }
    });
    let any: [Rgb; 256] = core::array::from_fn(|_| random_color(&mut random));
    for (name, colors) in [
        ("black", [Rgb::BLACK; 256]),
        ("one", [one; 256]),
        ("two", core::array::from_fn(|i| if i % 3 == 1 { Rgb::WHITE } else { one })),
        ("twelve", core::array::from_fn(|i| twelve[i % 12])),
        ("line", core::array::from_fn(|i| Rgb::new(90, i as u8, 90))),
        ("cluster", cluster),
        ("any", any),
    ] {
        palettes.push((name.to_string(), Palette::from_colors(colors)));
    }
    palettes
}

/// Compares every entry of `table` with `expected(high, low)`; columns of a row that have the same colours cost the
/// oracle one search.
#[track_caller]
fn assert_table(name: &str, table: &Lut64K, expected: impl Fn(u8, u8) -> u8) {
    for high in 0..=255 {
        for low in 0..=255 {
            let byte = table.as_array()[usize::from(high) * 256 + usize::from(low)];
            assert_eq!(byte, table.get(high, low));
            assert_eq!(byte, expected(high, low), "{name}: row {high}, column {low}");
        }
    }
}

// Colours

#[test]
fn p1_every_colour_has_a_nearest_one_on_the_dac() {
    let mut tried = Tried::new("p1_every_colour_has_a_nearest_one_on_the_dac", 256);
    let all: Vec<u8> = (0..64).map(|six: u8| six * 4 + six / 16).collect();
    for v in 0..=255_u8 {
        let nearest = Rgb::new(v, 255 - v, v).nearest_on_dac();
        assert_eq!(nearest, nearest.on_dac());
        for (v, found) in [(v, nearest.r), (255 - v, nearest.g), (v, nearest.b)] {
            let least = all.iter().map(|shown| shown.abs_diff(v)).min();
            assert!(all.contains(&found) && Some(found.abs_diff(v)) == least, "{v}: {found}");
        }
        tried.add(1);
    }
}

#[test]
fn mixtures_are_rounded_once() {
    for a in 0..=255 {
        for share in 0..=255 {
            let (from, to) = (Rgb::new(a, 255 - a, a / 2), Rgb::new(255, a, 77));
            assert_eq!(from.mix(to, share), naive_mix(from, to, share), "{a}, {share}");
        }
    }
}

// Searches

#[test]
fn a_search_finds_what_looking_at_all_finds() {
    let mut tried = Tried::new("a_search_finds_what_looking_at_all_finds", 16 * 40_000);
    let mut random = Random::named("search");
    for (name, palette) in palettes() {
        let (colors, search) = (all_shown(&palette), NearestColors::of_shown(&palette));
        // The corners of the search's boxes and their neighbours, then random ones.
        let edges: Vec<u8> = (0..8).flat_map(|i| [32 * i, 32 * i + 1, 32 * i + 30, 32 * i + 31]).collect();
        let on_edges = edges.iter().flat_map(|&r| edges.iter().map(move |&g| (r, g)));
        let on_edges = on_edges.flat_map(|(r, g)| edges.iter().map(move |&b| Rgb::new(r, g, b)));
        let anywhere = (0..8_000).map(|_| random_color(&mut random));
        for color in on_edges.chain(anywhere) {
            assert_eq!(search.nearest(color), naive_nearest(&colors, color), "{name}: {color:?}");
            tried.add(1);
        }
    }
}

#[test]
fn a_search_among_few_colours_or_none() {
    let mut random = Random::named("few");
    for count in 1..40 {
        let colors: Vec<Rgb> = (0..count).map(|_| random_color(&mut random)).collect();
        let search = NearestColors::new(&colors);
        for _ in 0..500 {
            let color = random_color(&mut random);
            assert_eq!(search.nearest(color), naive_nearest(&colors, color));
        }
    }
    assert_eq!(NearestColors::new(&[]).nearest(Rgb::WHITE), 0);
    // Beyond 256 an index would not fit.
    let mut many = vec![Rgb::BLACK; 256];
    many.push(Rgb::WHITE);
    assert_eq!(NearestColors::new(&many).nearest(Rgb::WHITE), 0);
}

// Tables

#[test]
fn shaded_texels_are_the_nearest_entries() {
    let mut tried = Tried::new("shaded_texels_are_the_nearest_entries", 16);
    let mut random = Random::named("shades");
    for (name, palette) in palettes() {
        // Repeats texel colours now and then, as in a texture of few colours.
        let few: Vec<Rgb> = (0..20).map(|_| random_color(&mut random)).collect();
        let texels: [Rgb; 256] = core::array::from_fn(|i| few[i * i % 20]);
        let shown = all_shown(&palette);
        let table = Lut64K::shades(&palette, &texels);
        let expected: Vec<Vec<u8>> = (0..=255)
            .map(|shade| few.iter().map(|&c| naive_nearest(&shown, naive_mix(Rgb::BLACK, c, shade))).collect())
            .collect();
        assert_table(&name, &table, |shade, texel| {
            expected[usize::from(shade)][usize::from(texel) * usize::from(texel) % 20]
        });
        tried.add(1);
    }
}

#[test]
fn fog_is_the_nearest_entry_to_the_mixture() {
    let mut tried = Tried::new("fog_is_the_nearest_entry_to_the_mixture", 6 * 65_536);
    for (name, palette) in palettes() {
        if !matches!(&*name, "copper" | "cube" | "bios" | "twelve" | "cluster" | "any") {
            continue;
        }
        let (colors, fog) = (all_shown(&palette), Rgb::new(120, 130, 151));
        assert_table(&name, &Lut64K::fog(&palette, fog), |level, byte| match level {
            0 => byte,
            _ => naive_nearest(&colors, naive_mix(colors[usize::from(byte)], fog, level)),
        });
        tried.add(65_536);
    }
}

#[test]
fn glass_is_the_nearest_entry_to_the_mixture_or_to_the_sum() {
    let mut tried = Tried::new("glass_is_the_nearest_entry_to_the_mixture_or_to_the_sum", 4 * 2 * 65_536);
    for (name, palette) in palettes() {
        if !matches!(&*name, "materials-8x32" | "bios" | "twelve" | "any") {
            continue;
        }
        let colors = all_shown(&palette);
        let color = |byte: u8| colors[usize::from(byte)];
        assert_table(&name, &Lut64K::blend(&palette, 90), |new, old| {
            if new == old { new } else { naive_nearest(&colors, naive_mix(color(old), color(new), 90)) }
        });
        assert_table(&name, &Lut64K::add(&palette), |new, old| {
            let (a, b) = (color(new), color(old));
            let sum = |a: u8, b: u8| (u32::from(a) + u32::from(b)).min(255) * 255;
            match (a == Rgb::BLACK, b == Rgb::BLACK) {
                (true, _) => old,
                (_, true) => new,
                _ => naive_nearest(&colors, nearest_255th([sum(a.r, b.r), sum(a.g, b.g), sum(a.b, b.b)])),
            }
        });
        tried.add(2 * 65_536);
    }
}

/// An effect with nothing to do changes no byte, even in a palette that holds every colour many times.
#[test]
fn neutral_rows_and_tables_are_the_identity() {
    for (name, palette) in palettes() {
        let fog = Lut64K::fog(&palette, Rgb::WHITE);
        let (opaque, clear) = (Lut64K::blend(&palette, 255), Lut64K::blend(&palette, 0));
        let half = Lut64K::blend(&palette, 128);
        for byte in 0..=255 {
            assert_eq!(fog.get(0, byte), byte, "{name}");
            assert_eq!(half.get(byte, byte), byte, "{name}");
            for other in 0..=255 {
                assert_eq!((opaque.get(byte, other), clear.get(other, byte)), (byte, byte), "{name}");
            }
        }
    }
}

#[test]
fn full_fog_and_full_light_show_their_own_colours() {
    let palette = builtin::by_name("cube").expect("built in").palette;
    let fog = Rgb::new(255, 203, 101);
    let table = Lut64K::fog(palette, fog);
    for byte in 0..=255 {
        assert_eq!(palette.on_dac()[table.get(255, byte)], fog, "a colour that the palette has");
    }
    let shades = Lut64K::shades(palette, palette.on_dac().colors());
    for texel in 0..=255 {
        let color = palette.on_dac()[shades.get(255, texel)];
        assert_eq!(color, palette.on_dac()[texel]);
        assert_eq!(palette[shades.get(0, texel)], Rgb::BLACK);
    }
}

#[test]
fn a_table_from_a_function_has_rows_of_256() {
    let table = Lut64K::from_fn(|high, low| high.wrapping_mul(7) ^ low);
    assert_table("function", &table, |high, low| high.wrapping_mul(7) ^ low);
}

// The map of 5 bits a channel

#[test]
fn the_map_holds_the_nearest_entry_for_the_middle_of_every_bin() {
    let mut tried = Tried::new("the_map_holds_the_nearest_entry_for_the_middle_of_every_bin", 16 * 32_768);
    for (name, palette) in palettes() {
        let (colors, map) = (all_shown(&palette), InverseColormap::new(&palette));
        for (i, &entry) in map.as_array().iter().enumerate() {
            let channel = |five: usize| (five % 32 * 8 + five % 32 / 4) as u8;
            let color = Rgb::new(channel(i / 1024), channel(i / 32), channel(i));
            assert_eq!(entry, naive_nearest(&colors, color), "{name}: {color:?}");
            assert_eq!(map.get(color), entry);
            tried.add(1);
        }
    }
}

#[test]
fn the_spread_is_the_median_distance_between_neighbours() {
    for (name, palette) in palettes() {
        let mut colors = all_shown(&palette);
        colors.sort();
        colors.dedup();
        let mut distances: Vec<u32> = Vec::new();
        for color in &colors {
            let others = colors.iter().filter(|other| *other != color);
            distances.extend(others.map(|other| color.distance_squared(*other)).min());
        }
        distances.sort_unstable();
        let expected = distances.get(distances.len() / 2).map_or(0.0, |&square| f64::from(square).sqrt().round());
        assert_eq!(f64::from(InverseColormap::new(&palette).spread()), expected.min(255.0), "{name}");
    }
    assert_eq!(InverseColormap::new(builtin::by_name("cube").expect("built in").palette).spread(), 49);
}

/// Ordered dither with the 64 thresholds of an 8 × 8 matrix, in any order, shifted by the spread: the mean of a block
/// comes closer to colours between neighbouring entries than the nearest entry does; with nine times the spread it does
/// not. In palettes whose colours are closer than 8/255 there is nothing to gain.
#[test]
fn dither_by_the_spread_hits_colours_between_entries() {
    let mut random = Random::named("dither");
    for name in ["materials-8x32", "materials-16x16", "cube", "bios"] {
        let palette = builtin::by_name(name).expect("built in").palette;
        let (colors, search) = (all_shown(palette), NearestColors::of_shown(palette));
        let spread = f64::from(InverseColormap::new(palette).spread());
        let mut off = [0.0; 3];
        for _ in 0..400 {
            let (i, share) = (random.within(0, 254) as usize, random.unit());
            let between = |a: u8, b: u8| f64::from(a) * (1.0 - share) + f64::from(b) * share;
            let (a, b) = (colors[i], colors[i + 1]);
            let wanted = [between(a.r, b.r), between(a.g, b.g), between(a.b, b.b)];
            for (off, spread) in off.iter_mut().zip([0.0, spread, 9.0 * spread]) {
                let mut mean = [0.0; 3];
                for threshold in 0..64 {
                    let by = ((f64::from(threshold) + 0.5) / 64.0 - 0.5) * spread;
                    let [r, g, b] = wanted.map(|v| (v + by).round().clamp(0.0, 255.0) as u8);
                    let Rgb { r, g, b } = colors[usize::from(search.nearest(Rgb::new(r, g, b)))];
                    for (mean, v) in mean.iter_mut().zip([r, g, b]) {
                        *mean += f64::from(v) / 64.0;
                    }
                }
                let square: f64 = mean.iter().zip(wanted).map(|(mean, wanted)| (mean - wanted).powi(2)).sum();
                *off += square.sqrt() / 400.0;
            }
        }
        let [none, own, ninefold] = off;
        println!("{name}: off by {none:.2} without dither, {own:.2} with {spread}, {ninefold:.2} with nine times that");
        assert!(own < none && own < ninefold, "{name}");
    }
}
