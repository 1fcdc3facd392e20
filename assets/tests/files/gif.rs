//! GIF animations, read back by a decoder and composed frame by frame: every colour, every delay, nothing drawn
//! unnecessarily, and no incomplete file (hard case F4).

use std::cell::Cell;
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;

use mode13h::export::{ExportError, ExportErrorKind, Picture, PictureError, PixelShape, Scale};
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::vga::Vga;
use mode13h_assets::animation::{AnimationError, AnimationErrorKind, Film, FrameRate, GifFile, GifFrame, GifWriter};
use mode13h_conformance::Random;
use num_bigint::BigInt;
use num_rational::BigRational;

use crate::support::film::{Image, decode};
use crate::support::tried::Tried;
use crate::support::workspace::names_in;

// The oracle

/// One frame as passed to the writer.
#[derive(Clone)]
struct Given {
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    pitch: usize,
    palette: [Rgb; 256],
}

impl Given {
    fn picture(&self) -> Picture<'_> {
        let Given { pixels, width, height, pitch, palette } = self;
        Picture { pixels, width: *width, height: *height, pitch: *pitch, palette, shape: PixelShape::default() }
    }

    /// The colour of each pixel of the animation at this scale.
    fn colors(&self, scale: Scale) -> Vec<Rgb> {
        let (width, height) = scale.size(self.width, self.height);
        // The pixel of the frame under the centre of a pixel of the animation.
        let under = |at: usize, of: usize, frame: usize| (2 * at + 1) * frame / (2 * of);
        let mut colors = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let index = self.pixels[under(y, height, self.height) * self.pitch + under(x, width, self.width)];
                colors.push(self.palette[usize::from(index)]);
            }
        }
        colors
    }
}

/// The different colours of a palette, in the order of its entries.
fn different(palette: &[Rgb; 256]) -> Vec<Rgb> {
    (0..256).filter(|&i| !palette[..i].contains(&palette[i])).map(|i| palette[i]).collect()
}

fn write(frames: &[Given], scale: Scale, rate: FrameRate) -> (Vec<u8>, Film) {
    let mut film = GifWriter::new(Vec::new(), scale, rate);
    for frame in frames {
        film.add(&frame.picture()).expect("added");
    }
    film.finish().expect("finished")
}

/// Writes the same animation, with each frame prepared before the ones that precede it.
fn write_made_ready(frames: &[Given], scale: Scale, rate: FrameRate) -> Vec<u8> {
    let ready = (0..frames.len()).rev().map(|i| {
        let picture = frames[i].picture();
        match i.checked_sub(1) {
            None => GifFrame::first(&picture, scale),
            Some(before) => GifFrame::after(&frames[before].picture(), &picture, scale, &frames[0].palette),
        }
    });
    let ready: Vec<GifFrame> = ready.collect::<Result<_, _>>().expect("made ready");
    let mut film = GifWriter::new(Vec::new(), scale, rate);
    ready.into_iter().rev().for_each(|frame| film.add_frame(frame).expect("added"));
    film.finish().expect("finished").0
}

#[test]
fn a_frame_that_was_made_ready_for_another_place_is_still_a_frame() {
    let mut random = Random::named("a_frame_that_was_made_ready_for_another_place_is_still_a_frame");
    let frame = noise(&mut random, 9, 7, 9);
    // A frame that follows itself changes nothing, but as an animation's first frame it must be written whole.
    let alone = GifFrame::after(&frame.picture(), &frame.picture(), Scale::Double, &frame.palette).expect("made");
    let mut film = GifWriter::new(Vec::new(), Scale::Double, FrameRate::default());
    film.add_frame(alone).expect("added");
    // A frame of another size is rejected, and the animation continues.
    let other = GifFrame::first(&frame.picture(), Scale::One).expect("made");
    let refused = film.add_frame(other).expect_err("refused");
    assert!(matches!(refused.kind, AnimationErrorKind::OtherSize { .. }), "{refused}");
    let (file, _) = film.finish().expect("finished");
    assert!(file == write(&[frame], Scale::Double, FrameRate::default()).0);

    // A frame that omits unchanged pixels, although its rectangle is the whole picture, cannot start an animation
    // either.
    let before = Given { pixels: vec![7; 60 * 9], width: 60, height: 9, pitch: 60, palette: grey() };
    let mut frame = before.clone();
    (frame.pixels[0], frame.pixels[60 * 9 - 1]) = (90, 91);
    (1..50).for_each(|i| frame.pixels[60 * 4 + i] = 100 + i as u8);
    let made = GifFrame::after(&before.picture(), &frame.picture(), Scale::One, &frame.palette).expect("made");
    let mut film = GifWriter::new(Vec::new(), Scale::One, FrameRate::default());
    film.add_frame(made).expect("added");
    let (file, _) = film.finish().expect("finished");
    assert!(file == write(&[frame], Scale::One, FrameRate::default()).0);
}

/// The pictures seen, and for how long, in 1/100 s; unchanged ones are merged.
fn seen<'a>(shown: impl Iterator<Item = (&'a [Rgb], u64)>) -> Vec<(&'a [Rgb], u64)> {
    let mut seen: Vec<(&[Rgb], u64)> = Vec::new();
    for (colors, delay) in shown {
        match seen.last_mut() {
            Some((last, sum)) if *last == colors => *sum += delay,
            _ => seen.push((colors, delay)),
        }
    }
    seen
}

/// Writes an animation, decodes it, and checks the picture at each moment, that each image's rectangle is the smallest
/// that holds all changing pixels, and that an image has a palette only if it needs one. Returns the images.
fn check(frames: &[Given], scale: Scale, rate: FrameRate) -> (Vec<Image>, Film) {
    let (file, film) = write(frames, scale, rate);
    assert!(write_made_ready(frames, scale, rate) == file, "frames that were made ready beforehand");
    let decoded = decode(&file);
    let (width, height) = scale.size(frames[0].width, frames[0].height);
    assert_eq!((decoded.width, decoded.height), (width, height));
    // Each colour once, with black filling up a table whose length is a power of two.
    let first = different(&frames[0].palette);
    assert_eq!(decoded.palette[..first.len()], first);
    assert!(decoded.palette[first.len()..].iter().all(|color| *color == Rgb::BLACK));

    let given: Vec<Vec<Rgb>> = frames.iter().map(|frame| frame.colors(scale)).collect();
    // At the rates here no quotient is so close to another that f64 would round it across a whole number.
    let begins = |number: usize| (100.0 * number as f64 / rate.frames_per_second()).ceil() as u64;
    let expected = seen(given.iter().enumerate().map(|(i, colors)| (colors.as_slice(), begins(i + 1) - begins(i))));
    let shown = seen(decoded.images.iter().map(|image| (image.shown.as_slice(), image.delay)));
    assert_eq!(shown.len(), expected.len());
    for (i, (shown, expected)) in shown.iter().zip(&expected).enumerate() {
        assert_eq!(shown.1, expected.1, "how long image {i} stays");
        assert!(shown.0 == expected.0, "the colours of image {i}");
    }

    let mut before: Option<&Image> = None;
    for (i, image) in decoded.images.iter().enumerate() {
        let Image { left, top, width: w, height: h, .. } = *image;
        let changed = |at: &usize| before.is_none_or(|before| before.shown[*at] != image.shown[*at]);
        let (xs, ys): (Vec<usize>, Vec<usize>) =
            (0..width * height).filter(changed).map(|at| (at % width, at / width)).unzip();
        match before {
            // Nothing changes, but the image before could stay no longer.
            Some(before) if xs.is_empty() => {
                assert!(before.delay + image.delay > 65_535, "image {i} is not needed");
                assert_eq!((left, top, w, h), (0, 0, 1, 1));
            }
            _ => {
                let least = |at: &[usize]| *at.iter().min().expect("a change");
                let most = |at: &[usize]| at.iter().max().expect("a change") + 1;
                assert_eq!((left, top, left + w, top + h), (least(&xs), least(&ys), most(&xs), most(&ys)));
            }
        }
        let at = |k: usize| (top + k / w) * width + left + k % w;
        let all_global = (0..w * h).all(|k| first.contains(&image.shown[at(k)]));
        assert_eq!(image.has_palette, !all_global, "the palette of image {i}");
        assert!(image.delay >= 2);
        before = Some(image);
    }

    assert_eq!((usize::from(film.width), usize::from(film.height)), (width, height));
    assert_eq!((film.frames, film.images), (frames.len() as u64, decoded.images.len() as u64));
    assert_eq!(film.bytes, file.len() as u64);
    let hundredths = begins(frames.len());
    assert_eq!(film.seconds(), hundredths as f64 / 100.0);
    for (&delay, &images) in &film.delays {
        let counted = decoded.images.iter().filter(|image| image.delay == u64::from(delay)).count();
        assert_eq!(images, counted as u64);
    }
    assert_eq!(film.delays.values().sum::<u64>(), film.images);
    (decoded.images, film)
}

// Frames to try it with

fn grey() -> [Rgb; 256] {
    std::array::from_fn(|i| Rgb::new(i as u8, i as u8, i as u8))
}

fn noise(random: &mut Random, width: usize, height: usize, pitch: usize) -> Given {
    let pixels = (0..pitch * height).map(|_| random.next_u64() as u8).collect();
    Given { pixels, width, height, pitch, palette: grey() }
}

fn random_palette(random: &mut Random) -> [Rgb; 256] {
    std::array::from_fn(|_| Rgb::from(random.next_u64() as u32 & 0xFF_FFFF))
}

/// The next frame of a random animation: nothing changes, or some pixels, or all, or the palette, or both, or the
/// indices while the colours stay the same.
fn next(random: &mut Random, before: &Given) -> Given {
    let mut frame = before.clone();
    let pixels = frame.pixels.len() as i64;
    let some_pixels = |random: &mut Random, frame: &mut Given| {
        for _ in 0..random.within(1, 4) {
            frame.pixels[random.within(0, pixels - 1) as usize] = random.next_u64() as u8;
        }
    };
    match random.within(0, 8) {
        0 => {}
        1 | 2 => some_pixels(random, &mut frame),
        3 => frame.pixels.iter_mut().for_each(|pixel| *pixel = random.next_u64() as u8),
        4 => frame.palette = random_palette(random),
        5 => frame.palette[random.within(0, 255) as usize] = Rgb::from(random.next_u64() as u32 & 0xFF_FFFF),
        6 => {
            frame.palette = random_palette(random);
            some_pixels(random, &mut frame);
        }
        // Half of the entries have the colours of the other half.
        7 => {
            for i in 0..128 {
                frame.palette[i + 128] = frame.palette[i];
            }
        }
        _ => frame.pixels.iter_mut().for_each(|pixel| *pixel ^= 128),
    }
    frame
}

fn random_scale(random: &mut Random) -> Scale {
    match random.within(0, 3) {
        0 => Scale::One,
        1 => Scale::Double,
        2 => Scale::FiveBySix,
        _ => Scale::To { width: random.within(1, 50) as u16, height: random.within(1, 50) as u16 },
    }
}

// The films

#[test]
fn random_films_show_what_was_given() {
    let mut tried = Tried::new("random_films_show_what_was_given", 400);
    let mut random = Random::named("random_films_show_what_was_given");
    let mut images = 0;
    while tried.more() {
        let (width, height) = (random.within(1, 24) as usize, random.within(1, 24) as usize);
        let pitch = width + random.within(0, 3) as usize;
        let scale = random_scale(&mut random);
        let rate = FrameRate::try_from(random.one_of(&[50.0, 49.9, 35.0, 30.0, 29.97, 24.0, 12.5, 7.0, 0.25, 0.1]));
        let mut frames = vec![noise(&mut random, width, height, pitch)];
        for _ in 1..random.within(1, 12) {
            frames.push(next(&mut random, &frames[frames.len() - 1]));
        }
        images += check(&frames, scale, rate.expect("a rate")).0.len();
    }
    assert!(images > 1_000, "{images} images");
}

/// A still background of noise, which cannot be compressed, with something moving over it: unchanged pixels are
/// transparent if an index is free, and written if none is.
#[test]
fn what_stays_is_transparent_where_that_is_shorter() {
    let mut random = Random::named("what_stays_is_transparent_where_that_is_shorter");
    for colors in [200, 256] {
        let ground: Vec<u8> = (0..100 * 60).map(|_| random.within(0, colors - 1) as u8).collect();
        let frames: Vec<Given> = (0..6)
            .map(|i| {
                let mut pixels = ground.clone();
                // In opposite corners, so that the rectangle is almost the whole picture.
                (0..5).for_each(|k| pixels[i * 100 + k] ^= 1);
                (0..5).for_each(|k| pixels[(59 - i) * 100 + 95 + k] ^= 1);
                Given { pixels, width: 100, height: 60, pitch: 100, palette: grey() }
            })
            .collect();
        let (images, film) = check(&frames, Scale::One, FrameRate::default());
        let transparent: Vec<bool> = images.iter().map(|image| image.transparent > 0).collect();
        let whole = (100 * 60 * images.len()) as u64;
        if colors == 200 {
            assert_eq!(transparent, [false, true, true, true, true, true]);
            assert!(film.bytes < whole / 3, "{} bytes", film.bytes);
        } else {
            assert!(transparent.iter().all(|any| !any) && film.bytes > whole, "{} bytes", film.bytes);
        }
    }
}

/// 256 entries of 64 colours, as a 6-bit DAC shows greys: pixels that differ only in their index are written the same
/// way.
#[test]
fn indices_of_one_color_are_one() {
    let mut random = Random::named("indices_of_one_color_are_one");
    let palette: [Rgb; 256] = std::array::from_fn(|i| Rgb::new(i as u8 / 4 * 4, 9, 9));
    let frames: Vec<Given> = (0..3)
        .map(|level| {
            let pixels = (0..50 * 40).map(|_| level * 4 + random.within(0, 3) as u8).collect();
            Given { pixels, width: 50, height: 40, pitch: 50, palette }
        })
        .collect();
    let (images, film) = check(&frames, Scale::One, FrameRate::default());
    assert!(images.iter().all(|image| image.indices.iter().all(|index| *index == image.indices[0])));
    assert!(film.bytes < 1_200, "{} bytes", film.bytes);
}

#[test]
fn one_frame_is_a_film() {
    let mut random = Random::named("one_frame_is_a_film");
    for (width, height) in [(1, 1), (1, 200), (320, 1), (3, 5), (320, 200)] {
        let frame = noise(&mut random, width, height, width);
        let (images, film) = check(&[frame], Scale::One, FrameRate::default());
        assert_eq!((images.len(), film.seconds()), (1, 0.03));
    }
}

/// Files are the same on big-endian machines.
#[test]
fn a_film_has_these_bytes() {
    let frame = Given { pixels: vec![0; 258 * 3], width: 258, height: 3, pitch: 258, palette: grey() };
    let rate = FrameRate::try_from(1.0).expect("a rate");
    let (file, _) = write(&[frame.clone(), frame.clone(), frame], Scale::One, rate);
    // 258 = 102h columns, 3 rows.
    assert_eq!(file[..10], *b"GIF89a\x02\x01\x03\0");
    let at = |bytes: &[u8]| file.windows(bytes.len()).position(|part| part == bytes);
    // It is shown for 300 = 12Ch hundredths of a second; the image has 102h columns and 3 rows, too.
    let control = at(b"!\xF9\x04").expect("a delay");
    assert_eq!(file[control + 4..control + 6], *b"\x2C\x01");
    let image = at(b",\0\0\0\0").expect("an image");
    assert_eq!(file[image + 5..image + 9], *b"\x02\x01\x03\0");
    assert!(file.ends_with(b";"));
}

/// Few indices, so that the encoder's codes start short.
#[test]
fn frames_of_few_colors() {
    for colors in [1, 2, 3, 4, 5, 16, 17, 128, 129, 255] {
        let frame = |offset: usize| {
            let pixels = (0..60 * 50).map(|i| ((i * i / 7 + offset) % colors) as u8).collect();
            Given { pixels, width: 60, height: 50, pitch: 60, palette: grey() }
        };
        check(&[frame(0), frame(1), frame(2)], Scale::Double, FrameRate::default());
    }
}

#[test]
fn a_change_is_cropped_to_its_rectangle() {
    let frame = |dots: &[(usize, usize)]| {
        let mut pixels = vec![0; 320 * 200];
        dots.iter().for_each(|(x, y)| pixels[y * 320 + x] = 9);
        Given { pixels, width: 320, height: 200, pitch: 320, palette: grey() }
    };
    let frames = [frame(&[]), frame(&[(10, 20)]), frame(&[(12, 20), (10, 23)]), frame(&[(319, 199), (10, 23)])];
    let size = Scale::To { width: 640, height: 480 };
    let (images, _) = check(&frames, size, FrameRate::default());
    let rectangles: Vec<_> = images.iter().map(|image| (image.left, image.top, image.width, image.height)).collect();
    // Columns are two wide. Rows: ceil(20·2.4 − ½) = 48 to before ceil(21·2.4 − ½) = 50, and so on.
    assert_eq!(rectangles, [(0, 0, 640, 480), (20, 48, 2, 2), (20, 48, 6, 10), (24, 48, 616, 432)]);
}

/// The frame's bytes stay; the DAC fades. Black pixels stay as they are, and surround the others.
#[test]
fn a_fade_redraws_what_fades() {
    let mut vga = Vga::new();
    let mut light = *builtin::by_name("copper").expect("a built-in").palette.colors();
    light[0] = Rgb::BLACK;
    let light = Palette::from_colors(light);
    let dark = Palette::from_colors([Rgb::BLACK; 256]);
    for y in 50..60 {
        vga.pixels_mut()[y * 320 + 100..][..30].fill(200);
    }
    let frames: Vec<Given> = [256, 128, 64, 0, 0, 128, 256]
        .map(|t| {
            vga.fade(&dark, &light, t);
            let palette = *vga.palette().colors();
            Given { pixels: vga.pixels().to_vec(), width: 320, height: 200, pitch: 320, palette }
        })
        .into();
    let (images, film) = check(&frames, Scale::One, FrameRate::default());
    assert_eq!((film.frames, film.images), (7, 6));
    for image in &images[1..] {
        assert_eq!((image.left, image.top, image.width, image.height), (100, 50, 30, 10));
    }
    let palettes: Vec<bool> = images.iter().map(|image| image.has_palette).collect();
    // Black is one of the first frame's colours, and the last frame has them all again.
    assert_eq!(palettes, [false, true, true, false, true, false]);
    // What the DAC shows: 6 bits expanded to 8.
    assert!(images.iter().flat_map(|image| &image.shown).all(|color| *color == color.on_dac()));
}

/// A palette that changes only where no pixel has its index changes nothing; nor does another index with the same
/// colour.
#[test]
fn what_is_not_seen_is_not_written() {
    let palette = grey();
    let frame = Given { pixels: vec![7; 12], width: 4, height: 3, pitch: 4, palette };
    let mut unused = frame.clone();
    unused.palette[8] = Rgb::WHITE;
    let mut twin = unused.clone();
    twin.palette[9] = twin.palette[7];
    twin.pixels[5] = 9;
    let (images, film) = check(&[frame, unused, twin], Scale::Double, FrameRate::default());
    assert_eq!(images.len(), 1);
    assert_eq!((film.frames, images[0].delay), (3, 9));
}

/// Pixels that an animation of a smaller size does not show.
#[test]
fn a_change_that_falls_between_the_pixels_of_a_smaller_film() {
    let frame = |at: Option<usize>| {
        let mut pixels = vec![0; 64];
        at.into_iter().for_each(|at| pixels[at] = 200);
        Given { pixels, width: 8, height: 8, pitch: 8, palette: grey() }
    };
    let film = Scale::To { width: 2, height: 2 };
    // Its pixels are those at (2, 2), (6, 2), (2, 6) and (6, 6).
    let (images, _) = check(&[frame(None), frame(Some(0)), frame(Some(63))], film, FrameRate::default());
    assert_eq!(images.len(), 1);
    let (images, _) = check(&[frame(None), frame(Some(2 * 8 + 6)), frame(Some(63))], film, FrameRate::default());
    assert_eq!(images.len(), 3);
    assert_eq!((images[1].left, images[1].top, images[1].width, images[1].height), (1, 0, 1, 1));
}

#[test]
fn a_film_that_stands_still_keeps_its_time() {
    let frame = Given { pixels: vec![7; 4], width: 2, height: 2, pitch: 2, palette: grey() };
    let mut last = frame.clone();
    last.pixels[3] = 8;
    let mut frames = vec![frame; 200];
    frames.push(last);
    let (images, film) = check(&frames, Scale::One, FrameRate::LOWEST);
    // An image can stay for at most 65,535: 65 frames of 1,000.
    let delays: Vec<u64> = images.iter().map(|image| image.delay).collect();
    assert_eq!(delays, [65_000, 65_000, 65_000, 5_000, 1_000]);
    assert_eq!(film.seconds(), 2010.0);
    assert_eq!((images[4].left, images[4].top), (1, 1));
}

// Rates

#[test]
fn delays_at_35_frames_a_second() {
    let rate = FrameRate::default();
    assert_eq!(rate.frames_per_second(), 35.0);
    for number in 0..1_400 {
        assert_eq!(rate.delay(number), if number % 7 == 6 { 2 } else { 3 }, "frame {number}");
    }
}

/// Each frame begins at the first hundredth not before its time: in rationals, for any rate.
#[test]
fn delays_add_up_to_the_exact_time() {
    let mut tried = Tried::new("delays_add_up_to_the_exact_time", 100_000);
    let mut random = Random::named("delays_add_up_to_the_exact_time");
    while tried.more() {
        let rate = match random.within(0, 2) {
            0 => random.within(1, 500) as f64 / 10.0,
            1 => 0.1 + 49.9 * random.unit(),
            // Just below 50, where a rounded quotient would give 1/100 s, which browsers turn into 10/100 s.
            _ => f64::from_bits(50_f64.to_bits() - random.log_uniform(40) as u64),
        };
        let number = random.log_uniform(63) as u64;
        let exact = BigRational::from_float(rate).expect("finite");
        let begins = |number: u64| (BigRational::from_integer(100 * BigInt::from(number)) / &exact).ceil();
        let delay = FrameRate::try_from(rate).expect("a rate").delay(number);
        assert!((2..=1_000).contains(&delay), "{rate}, frame {number}: {delay}");
        let expected = begins(number + 1) - begins(number);
        assert_eq!(BigRational::from_integer(BigInt::from(delay)), expected, "{rate}, frame {number}");
    }
    assert!(FrameRate::LOWEST.delay(u64::MAX) == 1_000 && FrameRate::HIGHEST.delay(u64::MAX) == 2);
}

#[test]
fn rates_that_no_gif_has_are_refused() {
    for (rate, says) in [
        (60.0, "an animation shows 0.1 to 50 frames a second, not 60: browsers slow down anything faster"),
        (50.000_000_1, "not 50.0000001: browsers"),
        (f64::INFINITY, "not inf: browsers"),
        (0.0, "not 0"),
        (0.099, "not 0.099"),
        (-35.0, "not -35"),
        (f64::NAN, "not NaN"),
    ] {
        let error = FrameRate::try_from(rate).expect_err("refused").to_string();
        assert!(error.contains(says), "{error}");
    }
    for rate in [FrameRate::LOWEST, FrameRate::HIGHEST] {
        assert_eq!(FrameRate::try_from(rate.frames_per_second()).expect("a rate"), rate);
    }
    assert_eq!((FrameRate::LOWEST.delay(5), FrameRate::HIGHEST.delay(5)), (1_000, 2));
}

// What cannot be written

#[test]
fn frames_that_do_not_fit_are_refused_and_the_film_goes_on() {
    let mut random = Random::named("frames_that_do_not_fit_are_refused_and_the_film_goes_on");
    let (first, last) = (noise(&mut random, 8, 6, 8), noise(&mut random, 8, 6, 8));
    let size = Scale::To { width: 16, height: 12 };
    let mut film = GifWriter::new(Vec::new(), size, FrameRate::default());
    film.add(&first.picture()).expect("added");
    // Frames of another size, even if the animation's size would be the same.
    for (width, height) in [(8, 5), (6, 8), (16, 12), (4, 3)] {
        let other = noise(&mut random, width, height, width);
        let error = film.add(&other.picture()).expect_err("refused");
        let AnimationErrorKind::OtherSize { first, now } = error.kind else { panic!("{error}") };
        assert_eq!((first, now), ((8, 6), (width, height)));
    }
    let short = Picture { pixels: &last.pixels[1..], ..last.picture() };
    let error = film.add(&short).expect_err("refused");
    assert!(matches!(error.kind, AnimationErrorKind::Picture(PictureError::Bytes { .. })), "{error}");
    film.add(&last.picture()).expect("added");
    let (file, _) = film.finish().expect("finished");
    assert_eq!(file, write(&[first, last], size, FrameRate::default()).0);
}

#[test]
fn a_film_without_a_frame_is_refused() {
    let film = GifWriter::new(Vec::new(), Scale::One, FrameRate::default());
    let error = film.finish().expect_err("refused");
    assert!(matches!(error.kind, AnimationErrorKind::NoFrames) && error.path.is_none(), "{error}");
    assert_eq!(error.to_string(), "an animation without frames");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("film.gif");
    let film = GifFile::create(&path, Scale::One, FrameRate::default()).expect("created");
    let error = film.finish().expect_err("refused");
    assert_eq!(error.to_string(), format!("{}: an animation without frames", path.display()));
    assert!(names_in(folder.path()).is_empty());
}

fn export_error(error: AnimationError) -> ExportError {
    match error.kind {
        AnimationErrorKind::Export(error) => error,
        _ => panic!("{error}"),
    }
}

/// A disk that takes this many bytes and is then full.
struct Disk {
    room: Rc<Cell<usize>>,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.room.get());
        if taken == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.room.set(self.room.get() - taken);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn f4_a_film_that_runs_out_of_room_at_any_byte_never_ends_well() {
    let mut tried = Tried::new("f4_a_film_that_runs_out_of_room_at_any_byte_never_ends_well", 1_000);
    let mut random = Random::named("f4_a_film_that_runs_out_of_room_at_any_byte_never_ends_well");
    let mut frames = vec![noise(&mut random, 7, 5, 7)];
    frames.push(Given { palette: random_palette(&mut random), ..frames[0].clone() });
    frames.push(noise(&mut random, 7, 5, 7));
    let whole = write(&frames, Scale::One, FrameRate::default()).0.len();
    for room in 0..=whole {
        let left = Rc::new(Cell::new(room));
        let mut film = GifWriter::new(Disk { room: Rc::clone(&left) }, Scale::One, FrameRate::default());
        let mut failed = 0;
        for frame in &frames {
            let result = film.add(&frame.picture());
            let kind = result.as_ref().err().map(|error| &error.kind);
            let full =
                matches!(kind, Some(AnimationErrorKind::Io(error)) if error.kind() == io::ErrorKind::StorageFull);
            assert!(result.is_ok() || full, "{room} of {whole}: {result:?}");
            // There is room again, but the lost bytes stay lost.
            if full {
                failed += 1;
                left.set(1 << 20);
            } else {
                assert_eq!(failed, 0, "{room} of {whole}: it goes on after a failure");
            }
        }
        let result = film.finish();
        assert_eq!(result.is_ok(), room == whole, "{room} of {whole}");
        tried.add(1);
    }
}

#[test]
fn f4_a_film_that_is_not_finished_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_film_that_is_not_finished_leaves_the_old_one_whole", 4);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("film.gif");
    fs::write(&path, "what stood there").expect("written");
    let mut random = Random::named("f4_a_film_that_is_not_finished_leaves_the_old_one_whole");
    let frames: Vec<Given> = (0..3).map(|_| noise(&mut random, 40, 30, 40)).collect();
    let begin = || {
        let mut film = GifFile::create(&path, Scale::FiveBySix, FrameRate::default()).expect("created");
        frames.iter().for_each(|frame| film.add(&frame.picture()).expect("added"));
        assert_eq!(names_in(folder.path()).len(), 2, "written beside its name");
        film
    };
    drop(begin());
    assert_eq!(names_in(folder.path()), ["film.gif"]);
    tried.add(1);
    let panic = std::panic::catch_unwind(|| {
        let _film = begin();
        std::panic::panic_any("half-way");
    });
    assert!(panic.is_err());
    assert_eq!(names_in(folder.path()), ["film.gif"]);
    tried.add(1);
    assert_eq!(fs::read(&path).expect("read"), b"what stood there");
    tried.add(1);
    begin().finish().expect("finished");
    assert_eq!(names_in(folder.path()), ["film.gif"]);
    assert_eq!(fs::read(&path).expect("read"), write(&frames, Scale::FiveBySix, FrameRate::default()).0);
    tried.add(1);
}

#[test]
fn f4_a_film_that_cannot_be_written_names_the_file() {
    let mut tried = Tried::new("f4_a_film_that_cannot_be_written_names_the_file", 3);
    let folder = tempfile::tempdir().expect("a folder");
    let create = |path: &Path| GifFile::create(path, Scale::One, FrameRate::default());
    let missing = folder.path().join("none").join("film.gif");
    let error = create(&missing).err().expect("no such folder");
    assert_eq!(error.path.as_ref(), Some(&missing));
    assert!(matches!(export_error(error).kind, ExportErrorKind::MissingDirectory));
    tried.add(1);
    let error = create(folder.path()).err().expect("a folder");
    assert_eq!(error.path.as_deref(), Some(folder.path()));
    assert!(matches!(export_error(error).kind, ExportErrorKind::IsDirectory));
    tried.add(1);
    let path = folder.path().join("film.gif");
    let mut film = create(&path).expect("created");
    let error = film.add(&Picture::mode_13h(&[], &Palette::default())).expect_err("no bytes");
    assert!(matches!(error.kind, AnimationErrorKind::Picture(PictureError::Bytes { .. })), "{error}");
    assert!(error.source().is_some() && error.path == Some(path), "{error}");
    tried.add(1);
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_film_on_a_full_disk_is_an_error() {
    let mut tried = Tried::new("f4_a_film_on_a_full_disk_is_an_error", 2);
    let mut random = Random::named("f4_a_film_on_a_full_disk_is_an_error");
    // A device that is always full. It is written to, not replaced.
    let mut film = GifFile::create("/dev/full", Scale::One, FrameRate::default()).expect("opened");
    film.add(&noise(&mut random, 320, 200, 320).picture()).expect("held");
    let error = film.add(&noise(&mut random, 320, 200, 320).picture()).expect_err("full");
    assert!(matches!(export_error(error).kind, ExportErrorKind::DiskFull));
    tried.add(1);
    let error = film.finish().expect_err("failed before");
    assert_eq!(error.to_string(), "/dev/full: the disk is full");
    tried.add(1);
}
