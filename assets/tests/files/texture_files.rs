//! Textures from files.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use mode13h::palette::{Lut64K, Palette, Rgb};
use mode13h::texture::{Texture, TextureError};
use mode13h_assets::texture::{LoadErrorKind, decode, load};
use mode13h_conformance::Random;
use png::{BitDepth, ColorType};

use crate::support::tried::Tried;

/// The colours of a texture in the order of a picture: from the top row down.
fn picture(texture: &Texture) -> Vec<Rgb> {
    (0..texture.height()).rev().flat_map(|y| (0..texture.width()).map(move |x| texture[(x, y)])).collect()
}

fn write_png(path: &Path, (width, height): (u32, u32), color: ColorType, depth: BitDepth, palette: &[u8], data: &[u8]) {
    let mut encoder = png::Encoder::new(fs::File::create(path).expect("a file"), width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if !palette.is_empty() {
        encoder.set_palette(palette.to_vec());
    }
    encoder.write_header().expect("a header").write_image_data(data).expect("a picture");
}

#[test]
fn pngs_of_every_kind_are_read() {
    let directory = tempfile::tempdir().expect("a directory");
    // The file's name does not matter.
    let path = directory.path().join("texture.jpg");
    let (red, dark) = (Rgb::new(255, 0, 0), Rgb::new(1, 2, 3));
    let grey = [Rgb::new(9, 9, 9), Rgb::new(200, 200, 200)];
    for (color, depth, palette, data, expected) in [
        (ColorType::Rgb, BitDepth::Eight, &[][..], &[255, 0, 0, 1, 2, 3][..], [red, dark]),
        (ColorType::Rgb, BitDepth::Sixteen, &[], &[255, 255, 0, 0, 0, 0, 1, 1, 2, 2, 3, 3], [red, dark]),
        (ColorType::Rgba, BitDepth::Eight, &[], &[255, 0, 0, 0, 1, 2, 3, 128], [red, dark]),
        (ColorType::Grayscale, BitDepth::Eight, &[], &[9, 200], grey),
        (ColorType::GrayscaleAlpha, BitDepth::Eight, &[], &[9, 0, 200, 255], grey),
        (ColorType::Grayscale, BitDepth::One, &[], &[0b0100_0000], [Rgb::BLACK, Rgb::WHITE]),
        (ColorType::Indexed, BitDepth::Eight, &[0, 0, 0, 1, 2, 3, 255, 0, 0], &[2, 1], [red, dark]),
        (ColorType::Indexed, BitDepth::Two, &[0, 0, 0, 1, 2, 3, 255, 0, 0], &[0b1001_0000], [red, dark]),
    ] {
        write_png(&path, (2, 1), color, depth, palette, data);
        assert_eq!(picture(&load(&path).expect("a texture")), expected, "{color:?}, {depth:?}");
    }
}

/// Sides of powers of two up to 256: nothing is averaged, and two entries with the same colour stay separate.
/// Palette animation distinguishes them.
#[test]
fn an_indexed_png_keeps_its_indices_and_a_palette_of_its_own_shows_them() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("texture.png");
    let plte = [0, 0, 0, 8, 16, 24, 255, 0, 0, 8, 16, 24];
    write_png(&path, (4, 2), ColorType::Indexed, BitDepth::Two, &plte, &[0b1110_0100, 0b0101_1010]);
    let texture = load(&path).expect("a texture");
    assert_eq!(texture.texels(), [1, 1, 2, 2, 3, 2, 1, 0]);
    let colors: Vec<Rgb> = plte.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2])).collect();
    assert_eq!(texture.colors()[..4], colors);
    let mut own = [Rgb::WHITE; 256];
    own[..4].copy_from_slice(&colors);
    let table = Lut64K::shades(&Palette::from_colors(own), texture.colors());
    assert_eq!([0, 1, 2, 3].map(|texel| table.get(255, texel)), [0, 1, 2, 3]);
    // Another palette gives its nearest entries, and other sides are averaged.
    own.swap(1, 9);
    assert_eq!(Lut64K::shades(&Palette::from_colors(own), texture.colors()).get(255, 1), 3);
    write_png(&path, (3, 1), ColorType::Indexed, BitDepth::Eight, &plte, &[1, 3, 2]);
    assert_eq!(load(&path).expect("a texture").width(), 4);
    // Without its palette, which a chunk of 12 bytes with a length, a name and a sum holds, there are no colours.
    let mut bytes = fs::read(&path).expect("read");
    let at = bytes.windows(4).position(|name| name == b"PLTE").expect("a palette") - 4;
    bytes.drain(at..at + 12 + plte.len());
    fs::write(&path, bytes).expect("written");
    let error = load(&path).expect_err("no palette").to_string();
    assert!(error.ends_with("not a picture that can be read: it has no palette"), "{error}");
}

#[test]
fn a_file_that_is_no_texture_is_one_line_with_its_name() {
    let mut tried = Tried::new("a_file_that_is_no_texture_is_one_line_with_its_name", 6 + 150);
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name);
    write_png(&path("wide.png"), (4097, 1), ColorType::Grayscale, BitDepth::Eight, &[], &[0; 4097]);
    fs::write(path("text.png"), "P3\n1 1\n255\n0 0 0\n").expect("written");
    fs::write(path("empty.png"), "").expect("written");
    fs::write(path("head.png"), b"\x89PNG\r\n\x1a\n").expect("written");
    let mut fails = |name: &str, is_right: &dyn Fn(&LoadErrorKind) -> bool| {
        let error = load(path(name)).expect_err(name);
        assert!(error.path == path(name) && is_right(&error.kind), "{error:?}");
        let line = error.to_string();
        assert!(line.starts_with(&format!("{}: ", path(name).display())) && !line.contains('\n'), "{line}");
        tried.add(1);
    };
    fails("none.png", &|kind| matches!(kind, LoadErrorKind::Read(_)));
    fails(".", &|kind| matches!(kind, LoadErrorKind::NotAFile));
    fails("wide.png", &|kind| matches!(kind, LoadErrorKind::Texture(TextureError::Size { width: 4097, height: 1 })));
    for name in ["text.png", "empty.png", "head.png"] {
        fails(name, &|kind| matches!(kind, LoadErrorKind::Picture(_)));
    }
    // Truncated anywhere it is refused, or read as far as it goes; never a panic.
    let noise: Vec<u8> = (0..32 * 32 * 3).map(|i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    write_png(&path("whole.png"), (32, 32), ColorType::Rgb, BitDepth::Eight, &[], &noise);
    let whole = fs::read(path("whole.png")).expect("read");
    for i in 0..150 {
        fs::write(path("cut.png"), &whole[..whole.len() * i / 150]).expect("written");
        let _ = load(path("cut.png"));
        tried.add(1);
    }
}

fn encoded(picture: &image::RgbImage, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("written");
    bytes.into_inner()
}

/// One picture in every file format gives the same texture; JPEG is close to it. No format is detected by name.
#[test]
fn every_kind_of_picture_is_read() {
    use image::ImageFormat::{Bmp, Gif, Jpeg, Png, Tga, WebP};

    // Few colours, which GIF holds exactly, in large blocks, which JPEG holds almost exactly.
    let picture = image::RgbImage::from_fn(64, 32, |x, y| {
        image::Rgb([if x < 32 { 200 } else { 40 }, if y < 16 { 180 } else { 60 }, if x < 16 { 220 } else { 30 }])
    });
    let decoded = |format| decode(Cursor::new(encoded(&picture, format))).expect("read");
    let right = decoded(Png);
    for format in [Tga, Bmp, WebP] {
        assert_eq!(decoded(format), right, "{format:?}");
    }
    let color = |texture: &Texture, i: usize| texture.colors()[usize::from(texture.texels()[i])];
    // A GIF has its own indices, so only its colours are the same.
    let gif = decoded(Gif);
    assert!((0..64 * 32).all(|i| color(&gif, i) == color(&right, i)), "Gif");
    let near = decoded(Jpeg);
    let off = (0..64 * 32).map(|i| color(&near, i).distance_squared(color(&right, i))).collect::<Vec<_>>();
    // Half of the colour resolution is lost at the blocks' edges, and little elsewhere.
    let share = off.iter().filter(|off| **off > 3 * 12 * 12).count() as f64 / off.len() as f64;
    assert!(share < 0.1, "{share} of the texels are off");
    for broken in [&b"GIF89a"[..], b"\xFF\xD8\xFF\xE0", b"RIFF....WEBP", b"BM", b"nothing", b"", &[0; 18]] {
        let error = decode(Cursor::new(broken)).expect_err("no picture").to_string();
        assert!(!error.contains(char::is_control), "{broken:?}: {error:?}");
    }
}

/// No picture is decoded just to find that it is too large.
#[test]
fn a_picture_too_large_is_refused_by_its_head() {
    let mut tga = [0; 18];
    (tga[2], tga[16]) = (2, 24);
    tga[12..16].copy_from_slice(&[0xFF, 0xFF, 0xFF, 0xFF]);
    let mut bmp = b"BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0".to_vec();
    bmp.extend([5000_i32, 3].map(i32::to_le_bytes).concat());
    bmp.extend([1, 0, 24, 0]);
    bmp.resize(54, 0);
    let gif = [&b"GIF89a\x88\x13\x03\0\0\0\0,\0\0\0\0\x88\x13\x03\0\0\x02"[..], &[0; 8]].concat();
    for (name, bytes, size) in
        [("TGA", tga.to_vec(), [65_535, 65_535]), ("BMP", bmp, [5000, 3]), ("GIF", gif, [5000, 3])]
    {
        let error = decode(Cursor::new(bytes)).expect_err(name);
        let expected = TextureError::Size { width: size[0], height: size[1] };
        assert!(matches!(error, LoadErrorKind::Texture(error) if error == expected), "{name}: {error}");
    }
}

/// A JPEG without its end is refused, wherever it is cut off, as a PNG is: the decoder would make the rest grey.
#[test]
fn a_jpeg_that_is_cut_off_is_refused() {
    let mut random = Random::new(7);
    let picture = image::RgbImage::from_fn(40, 24, |_, _| image::Rgb([random.next_u64() as u8; 3]));
    let mut bytes = encoded(&picture, image::ImageFormat::Jpeg);
    for length in 4..bytes.len() {
        decode(Cursor::new(&bytes[..length])).expect_err("cut off");
    }
    // A preview before it has an end of its own.
    let preview = [&[0xFF, 0xE1, 0, 8][..], &[0xFF, 0xDA, 0, 0, 0xFF, 0xD9]].concat();
    bytes.splice(2..2, preview);
    decode(Cursor::new(&bytes)).expect("whole");
    decode(Cursor::new(&bytes[..bytes.len() - 2])).expect_err("cut off");
    // Phones append a video; here one that looks like the beginning of another scan.
    bytes.extend([0xFF, 0xDA, 0, 4, 0xFF]);
    decode(Cursor::new(&bytes)).expect("whole");
    // Inside a larger file.
    bytes.splice(0..0, [0xFF, 0xC0, 0xFF, 0xFF]);
    let mut inside = Cursor::new(&bytes);
    inside.set_position(4);
    decode(inside).expect("whole");
}

/// An error in a picture is reported in one sentence, whatever its decoder says.
#[test]
fn what_is_wrong_with_a_picture_is_one_sentence() {
    use image::ImageFormat::{Bmp, Gif, Jpeg, Png, Tga, WebP};

    let mut tried = Tried::new("what_is_wrong_with_a_picture_is_one_sentence", 500);
    let mut random = Random::new(1);
    let picture = image::RgbImage::from_fn(16, 16, |x, y| image::Rgb([x as u8 * 16, y as u8 * 16, (x * y) as u8]));
    for format in [Tga, Bmp, Gif, WebP, Jpeg, Png] {
        let whole = encoded(&picture, format);
        for i in 0..600 {
            let mut bytes = whole.clone();
            if i % 3 == 0 {
                bytes.truncate(random.within(0, whole.len() as i64 - 1) as usize);
            } else {
                // Most faults are detected from the header.
                let most = if i % 3 == 1 { 64.min(whole.len()) } else { whole.len() };
                bytes[random.within(0, most as i64 - 1) as usize] = random.next_u64() as u8;
            }
            if let Err(error) = decode(Cursor::new(bytes)) {
                let said = error.to_string();
                let is_sentence = !said.ends_with(['.', ':', ';', ',', '!', ' '])
                    && !["  ", "\n", ". ", "; ", " {", "::", ": :"].iter().any(|wrong| said.contains(wrong));
                assert!(is_sentence, "{format:?}: {said}");
                tried.add(1);
            }
        }
    }
}
