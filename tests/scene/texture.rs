//! Textures: from pictures of any size, and the compiled-in ones.

use std::collections::BTreeSet;

use mode13h::Angle;
use mode13h::glam::Vec2;
use mode13h::internals::span::texture::{Levels, TexelsError};
use mode13h::mesh::shapes;
use mode13h::palette::{Lut64K, Palette, Rgb};
use mode13h::scene::Shared;
use mode13h::settings::Mapping;
use mode13h::texture::{Mipmap, Texture, TextureError};
use mode13h_conformance::Random;

use crate::support::tried::Tried;

fn random_color(random: &mut Random) -> Rgb {
    Rgb::from(random.next_u64() as u32)
}

/// The colours of a texture in the order of a picture: from the top row down.
fn picture(texture: &Texture) -> Vec<Rgb> {
    (0..texture.height()).rev().flat_map(|y| (0..texture.width()).map(move |x| texture[(x, y)])).collect()
}

fn used_colors(texture: &Texture) -> BTreeSet<Rgb> {
    texture.texels().iter().map(|&texel| texture.colors()[usize::from(texel)]).collect()
}

/// An image shifted by any whole number of images looks the same: coordinates are reduced before they exceed what 16.16
/// can hold.
#[test]
fn images_far_from_their_corner_are_brought_back() {
    let offsets = [1.0, 100.0, 250.0, 257.0, 300.0, 511.0, 513.0, 520.0, 600.0, 1_000.0, 15_000.0];
    let mut tried = Tried::new("images_far_from_their_corner_are_brought_back", 2 * 3 * offsets.len() as u64);
    let texture = Shared::new("crate".parse::<Texture>().expect("compiled in"));
    let size = texture.width() as f32;
    assert!(offsets.iter().any(|k| k * size < 16_384.0) && offsets.iter().any(|k| k * size > 32_768.0));
    let frame = |mapping: Mapping, at: Vec2| {
        let mesh = shapes::wall(2, 2);
        // Within one image: in exact quarters and eighths.
        let inner = mesh.texcoords().expect("a wall has them").iter().map(|&uv| uv * 0.5 + 0.25 + at).collect();
        let mut scene = crate::support::scenes::framed(mesh.with_texcoords(inner).expect("as many"));
        scene.objects_mut()[0].materials[0].texture = Some(Shared::clone(&texture));
        scene.objects_mut()[0].angles = [0.2, 0.9, 0.1].map(Angle::from_radians);
        scene.settings.mapping = Some(mapping);
        crate::support::scenes::frame(&scene)
    };
    for mapping in [Mapping::Affine, Mapping::Perspective] {
        let expected = frame(mapping, Vec2::ZERO);
        assert!(expected.iter().collect::<BTreeSet<_>>().len() > 10, "a picture");
        for k in offsets {
            for at in [Vec2::new(k, 0.0), Vec2::new(-k, k), Vec2::new(0.0, -k)] {
                assert!(frame(mapping, at) == expected, "{mapping}, {at} images away");
                tried.add(1);
            }
        }
    }
}

// From a picture

/// The power of two from 1 to 256 at which the greater of side/power and power/side is least.
fn naive_side(side: u32) -> u32 {
    let ratio = |power: u32| f64::from(side.max(power)) / f64::from(side.min(power));
    (0..=8).map(|bits| 1 << bits).min_by(|a, b| ratio(*a).total_cmp(&ratio(*b))).expect("nine powers")
}

/// How much of texel `i` of `to` lies in pixel `pixel` of `from`, if both rows are from·to long.
fn overlap(i: u64, to: u64, pixel: u64, from: u64) -> u64 {
    let (start, end) = ((i * from).max(pixel * to), ((i + 1) * from).min((pixel + 1) * to));
    end.saturating_sub(start)
}

/// The mean over the area of a texel, asking every pixel of the picture for its share.
fn naive_average(
    pixels: &[Rgb],
    (width, height): (u64, u64),
    (to_width, to_height): (u64, u64),
    x: u64,
    y: u64,
) -> Rgb {
    let mut sums = [0_u64; 3];
    for (i, pixel) in (0..).zip(pixels) {
        let part = overlap(x, to_width, i % width, width) * overlap(y, to_height, i / width, height);
        for (sum, v) in sums.iter_mut().zip([pixel.r, pixel.g, pixel.b]) {
            *sum += part * u64::from(v);
        }
    }
    let [r, g, b] = sums.map(|sum| u8::try_from((2 * sum + width * height) / (2 * width * height)).expect("a mean"));
    Rgb::new(r, g, b)
}

#[test]
fn sides_become_the_nearest_power_of_two() {
    let mut tried = Tried::new("sides_become_the_nearest_power_of_two", 2 * 4096);
    for side in 1..=4096 {
        let pixels = vec![Rgb::BLACK; side as usize];
        let wide = Texture::from_rgb(side, 1, &pixels).expect("a texture");
        assert_eq!((wide.width(), wide.height()), (naive_side(side), 1));
        assert_eq!((1 << wide.width_bits(), 1 << wide.height_bits()), (wide.width(), wide.height()));
        let high = Texture::from_rgb(1, side, &pixels).expect("a texture");
        assert_eq!((high.width(), high.height()), (1, naive_side(side)));
        tried.add(2);
    }
}

/// Small enough that no colour is dropped, so the result is the mean over each texel's area.
#[test]
fn texels_are_means_over_their_areas() {
    let mut tried = Tried::new("texels_are_means_over_their_areas", 400);
    let mut random = Random::named("areas");
    while tried.more() {
        let (width, height) = (random.within(1, 23) as u32, random.within(1, 23) as u32);
        let to = (naive_side(width), naive_side(height));
        if to.0 * to.1 > 256 {
            continue;
        }
        let pixels: Vec<Rgb> = (0..width * height).map(|_| random_color(&mut random)).collect();
        let texture = Texture::from_rgb(width, height, &pixels).expect("a texture");
        assert_eq!((texture.width(), texture.height()), to);
        let (from, to) = ((width.into(), height.into()), (to.0.into(), to.1.into()));
        let expected: Vec<Rgb> = (0..to.1)
            .flat_map(|y| (0..to.0).map(move |x| (x, y)))
            .map(|(x, y)| naive_average(&pixels, from, to, x, y))
            .collect();
        assert_eq!(picture(&texture), expected, "{width} × {height}");
    }
}

#[test]
fn the_largest_and_brightest_picture_is_averaged_without_overflow() {
    let texture = Texture::from_rgb(4096, 4096, &vec![Rgb::WHITE; 4096 * 4096]).expect("a texture");
    assert_eq!((texture.width(), texture.height()), (256, 256));
    assert_eq!(used_colors(&texture), BTreeSet::from([Rgb::WHITE]));
    let odd = Texture::from_rgb(4095, 4093, &vec![Rgb::WHITE; 4095 * 4093]).expect("a texture");
    assert_eq!(used_colors(&odd), BTreeSet::from([Rgb::WHITE]));
}

#[test]
fn v_runs_up_and_texels_repeat() {
    let pixels: Vec<Rgb> = (0..8 * 4).map(|i| Rgb::new(i, 0, 0)).collect();
    let texture = Texture::from_rgb(8, 4, &pixels).expect("a texture");
    for (i, &color) in (0_u32..).zip(&pixels) {
        let (x, y) = (i % 8, 3 - i / 8);
        assert_eq!(texture.colors()[usize::from(texture.texels()[(y << texture.width_bits() | x) as usize])], color);
        assert_eq!(texture[(x + 8 * 5, y + 4 * 3)], color);
    }
}

#[test]
fn up_to_256_colours_stay_what_they_are() {
    let mut random = Random::named("kept");
    for count in [1, 2, 17, 255, 256] {
        let few: Vec<Rgb> = (0..count).map(|i| Rgb::new(i as u8, random.next_u64() as u8, 7)).collect();
        let pixels: Vec<Rgb> = (0..64 * 32).map(|i| few[i % count]).collect();
        let texture = Texture::from_rgb(64, 32, &pixels).expect("a texture");
        assert_eq!(picture(&texture), pixels, "{count} colours");
    }
}

#[test]
fn more_colours_are_reduced_and_each_texel_has_the_nearest() {
    let mut tried = Tried::new("more_colours_are_reduced_and_each_texel_has_the_nearest", 5 * 64 * 64);
    let mut random = Random::named("reduced");
    let pixels: Vec<Rgb> = (0..64 * 64).map(|_| random_color(&mut random)).collect();
    let whole = Texture::from_rgb(64, 64, &pixels).expect("a texture");
    assert_eq!(used_colors(&whole).len(), 256);
    for (most, texture) in [1, 5, 32, 200, 256].map(|most| (most, whole.with_colors(most))) {
        let colors = used_colors(&texture);
        assert!(colors.len() <= usize::from(most), "{} of {most}", colors.len());
        for (before, after) in picture(&whole).iter().zip(picture(&texture)) {
            let nearest = colors.iter().map(|color| color.distance_squared(*before)).min();
            assert_eq!(Some(after.distance_squared(*before)), nearest);
            tried.add(1);
        }
    }
    assert_eq!(picture(&whole.with_colors(256)), picture(&whole));
    assert_eq!(used_colors(&whole.with_colors(0)).len(), 1);
}

/// More colours mean less error; each is the mean of a part, so a single colour is the mean of all.
#[test]
fn one_colour_is_the_mean_and_more_are_nearer() {
    let crate_ = "crate".parse::<Texture>().expect("built in");
    let pixels = picture(&crate_);
    let off =
        |texture: &Texture| -> u32 { picture(texture).iter().zip(&pixels).map(|(a, b)| a.distance_squared(*b)).sum() };
    let errors = [1, 2, 4, 8, 16, 32, 64, 128].map(|most| off(&crate_.with_colors(most)));
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
    let mean = |channel: fn(&Rgb) -> u8| {
        let sum: u32 = pixels.iter().map(|color| u32::from(channel(color))).sum();
        (f64::from(sum) / pixels.len() as f64).round() as u8
    };
    let expected = Rgb::new(mean(|c| c.r), mean(|c| c.g), mean(|c| c.b));
    assert_eq!(used_colors(&crate_.with_colors(1)), BTreeSet::from([expected]));
}

#[test]
fn what_is_no_texture_is_refused() {
    let colors = [Rgb::BLACK; 256];
    for (width, height) in [(0, 1), (1, 0), (3, 4), (512, 1), (1, 257), (u32::MAX, u32::MAX), (1 << 31, 2)] {
        let error = Texture::new(width, height, Vec::new(), colors).expect_err("sides");
        assert_eq!(error, TextureError::Side { width, height });
        assert_eq!(
            error.to_string(),
            format!("a texture of {width} × {height} texels: each side must be a power of two up to 256")
        );
    }
    for (width, height) in [(0, 1), (1, 0), (4097, 1), (1, u32::MAX)] {
        let error = Texture::from_rgb(width, height, &[Rgb::BLACK]).expect_err("sides");
        assert_eq!(error, TextureError::Size { width, height });
        assert_eq!(error.to_string(), format!("a picture of {width} × {height} pixels: each side must be 1 to 4096"));
    }
    let short = Err(TextureError::Count { given: 5, needed: 6 });
    assert_eq!(Texture::from_rgb(2, 3, &[Rgb::BLACK; 5]), short);
    let long = TextureError::Count { given: 5, needed: 4 };
    assert_eq!(Texture::new(2, 2, vec![0; 5], colors), Err(long));
    assert_eq!(long.to_string(), "5 texels given, 4 needed");
}

// Compiled in

#[test]
fn every_name_has_a_texture_of_its_own() {
    let mut seen = Vec::new();
    for name in Texture::NAMES {
        let texture = name.parse::<Texture>().expect("listed");
        assert!(used_colors(&texture).len() >= 2, "{name}");
        assert_eq!(texture.histogram().iter().sum::<u32>(), texture.width() * texture.height());
        for (texel, &count) in texture.histogram().iter().enumerate() {
            assert_eq!(texture.texels().iter().filter(|&&t| usize::from(t) == texel).count(), count as usize);
        }
        assert!(!seen.contains(&texture), "{name}");
        seen.push(texture);
    }
    assert!("marble".parse::<Texture>().is_err());
}

/// A wall repeats seamlessly: across the seam its colours change no more than at the most abrupt line within.
#[test]
fn walls_repeat_without_a_seam() {
    for name in ["checker", "bricks"] {
        let texture = name.parse::<Texture>().expect("built in");
        let change =
            |of: &dyn Fn(u32) -> [Rgb; 2]| -> u32 { (0..128).map(of).map(|[a, b]| a.distance_squared(b)).sum() };
        let right_of = |x: u32| change(&|y| [texture[(x, y)], texture[(x + 1, y)]]);
        let above = |y: u32| change(&|x| [texture[(x, y)], texture[(x, y + 1)]]);
        let (last_column, last_row) = (texture.width() - 1, texture.height() - 1);
        assert!(right_of(last_column) <= (0..last_column).map(right_of).max().expect("columns"), "{name}");
        assert!(above(last_row) <= (0..last_row).map(above).max().expect("rows"), "{name}");
    }
}

/// A mirror that faces up a little shows bright colours, one that faces down dark ones: the horizon.
#[test]
fn the_sky_has_a_bright_horizon_over_dark_ground() {
    let sky = "sky".parse::<Texture>().expect("built in");
    let half = sky.height() / 2;
    for x in 0..sky.width() {
        let (above, below) = (sky[(x, half)], sky[(x, half - 1)]);
        assert!(above.brightness() > 230_000 && below.brightness() < 64_000, "{x}: {above:?} over {below:?}");
    }
    // Straight up, halfway to the top, it is bluest.
    let up = sky[(sky.width() / 2, half + sky.height() * 45 / 128)];
    assert!(u32::from(up.b) > 2 * u32::from(up.r), "{up:?}");
}

/// A plain texture leaves a surface unchanged: shade s shows the colour at s.
#[test]
fn a_plain_texture_has_one_colour() {
    let plain = Texture::plain(Rgb::new(200, 100, 0));
    assert_eq!((plain.width(), plain.height(), plain.texels()), (1, 1, &[0][..]));
    let palette = Palette::from_colors(core::array::from_fn(|i| Rgb::BLACK.mix(Rgb::new(200, 100, 0), i as u8)));
    let (table, shown) = (Lut64K::shades(&palette, plain.colors()), palette.on_dac());
    for shade in 0..=255 {
        let color = shown[table.get(shade, 0)];
        assert!(color.distance_squared(palette[shade]) <= shown[shade].distance_squared(palette[shade]));
    }
}

// Mipmaps

/// The mean colour of the texels that texel (x, y) of a level represents, visiting every texel of level 0.
fn naive_mean(texture: &Texture, level: u32, (x, y): (u32, u32)) -> Rgb {
    let is_part = |at: u32, side: u32, of: u32| at >> level.min(side.ilog2()) == of;
    let (width, height) = (texture.width(), texture.height());
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let parts: Vec<Rgb> =
        all.filter(|&(i, j)| is_part(i, width, x) && is_part(j, height, y)).map(|(i, j)| texture[(i, j)]).collect();
    let mean = |channel: fn(&Rgb) -> u8| {
        let sum: usize = parts.iter().map(|color| usize::from(channel(color))).sum();
        ((2 * sum + parts.len()) / (2 * parts.len())) as u8
    };
    Rgb::new(mean(|c| c.r), mean(|c| c.g), mean(|c| c.b))
}

/// Every texel of every level has the texel colour nearest to the mean, or the mean itself if there is room for all
/// means. Level 0 keeps its texels and their colours.
#[test]
fn levels_are_means_of_colours() {
    let mut tried = Tried::new("levels_are_means_of_colours", 120);
    let mut random = Random::named("mipmaps");
    let (mut exact, mut matched) = (0, 0);
    while tried.more() {
        let (width, height) = (1 << random.within(0, 5), 1 << random.within(0, 5));
        let count = random.one_of(&[1, 2, 20, 250, 256]);
        let few: Vec<Rgb> = (0..count).map(|_| random_color(&mut random)).collect();
        let pixels: Vec<Rgb> = (0..width * height).map(|_| random.one_of(&few)).collect();
        let texture = Texture::from_rgb(width, height, &pixels).expect("a texture");
        let mipmap = Mipmap::new(&texture);
        let own = used_colors(&texture);
        let mut shown = BTreeSet::new();
        for &texel in texture.texels() {
            assert_eq!(mipmap.colors()[usize::from(texel)], texture.colors()[usize::from(texel)]);
            shown.insert(mipmap.colors()[usize::from(texel)]);
        }
        let mut wanted = own.clone();
        let mut texels = Vec::new();
        let last = mipmap.levels().last();
        assert_eq!(1 << last, width.max(height));
        for level in 1..=last {
            let of_level = mipmap.levels().get(level).expect("a level");
            let (columns, rows) = ((width >> level).max(1), (height >> level).max(1));
            assert_eq!((of_level.width(), of_level.height()), (columns as usize, rows as usize));
            for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
                let color = mipmap.colors()[usize::from(of_level.at(x << 16, y << 16))];
                let mean = naive_mean(&texture, level, (x, y));
                wanted.insert(mean);
                shown.insert(color);
                texels.push((color, mean));
            }
        }
        for (color, mean) in texels {
            let nearest = shown.iter().map(|other| other.distance_squared(mean)).min();
            assert_eq!(Some(color.distance_squared(mean)), nearest, "{width} × {height}, {count} colours");
            if wanted.len() <= 256 {
                assert_eq!(color, mean, "{width} × {height}, {count} colours");
                exact += 1;
            } else {
                matched += 1;
            }
        }
    }
    assert!(exact > 1_000 && matched > 1_000, "{exact} means shown, {matched} matched");
}

/// A third of a square texture's texels, whatever its size, and no level for one texel.
#[test]
fn levels_take_a_third_of_the_texels() {
    for bits in 0..=8 {
        assert_eq!(Levels::length(bits, bits), (1 << (2 * bits)) / 3);
        assert_eq!(Levels::deepest(bits, 0), bits);
    }
    assert_eq!(Levels::length(3, 1), 4 + 2 + 1);
    assert_eq!(Levels::length(70, 3), Levels::length(8, 3));
    let bytes: Vec<u8> = (0..7).collect();
    let levels = Levels::new(&bytes, 3, 1).expect("4 × 1, 2 × 1 and 1 × 1");
    assert!(levels.get(0).is_none());
    let row = |level: u32| -> Vec<u8> {
        let texels = levels.get(level).expect("a level");
        (0..texels.width() as u32).map(|x| texels.at(x << 16, 0)).collect()
    };
    assert_eq!([1, 2, 3, 9].map(row), [vec![0, 1, 2, 3], vec![4, 5], vec![6], vec![6]]);
    assert_eq!(Levels::new(&bytes, 9, 1).unwrap_err(), TexelsError::Bits { ubits: 9, vbits: 1 });
    assert_eq!(Levels::new(&bytes, 2, 1).unwrap_err(), TexelsError::Length { is: 7, should: 3 });
    assert!(Levels::new(&[], 0, 0).expect("none").get(1).is_none());
}
