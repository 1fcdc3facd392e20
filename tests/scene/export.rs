//! Pictures on disk: their contents, read back by a decoder, and that files are either complete or absent (hard case
//! F4).

use std::fs;
use std::io::{self, Write};

use crate::support::picture;
use crate::support::tried::Tried;
use crate::support::workspace::names_in;
use mode13h::export::{
    self, ExportErrorKind, MAX_SIDE, Picture, PictureError, PixelShape, Png, Scale, Scaled, check_writable,
    write_atomically,
};
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::vga::Vga;
use png::ColorType;

/// Encodes a picture, and decodes the file.
fn decoded(picture: &Picture<'_>, scale: Scale, rgb: bool) -> picture::Png {
    picture::Png::decode(&Png { scale, rgb }.encode(picture).expect("encoded"))
}

/// A machine on which neighbouring pixels differ, with every index in use.
fn patterned() -> Vga {
    let mut vga = Vga::new();
    vga.set_palette(builtin::by_name("copper").expect("a built-in").palette);
    for (i, byte) in vga.pixels_mut().iter_mut().enumerate() {
        *byte = (i * 7 + i / 320 * 13) as u8;
    }
    vga
}

#[test]
fn a_frame_is_an_indexed_png_of_its_own_bytes_and_colors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("frame.png");
    let vga = patterned();
    export::png(&vga, &path).expect("written");

    let file = fs::read(&path).expect("read");
    let decoded = picture::Png::decode(&file);
    assert_eq!((decoded.size, decoded.kind), ((320, 200), ColorType::Indexed));
    assert_eq!(decoded.palette, vga.palette().colors());
    assert_eq!(decoded.pixels, vga.pixels());
    assert_eq!(decoded.density, Some((6, 5)));

    let palette = vga.palette();
    let picture = Picture::mode_13h(vga.pixels(), &palette);
    assert_eq!(Png { scale: Scale::One, rgb: false }.encode(&picture).expect("encoded"), file);

    let whole = vec![0; 65_536];
    let picture = Picture::mode_13h(&whole, &palette);
    assert_eq!([199, 200, usize::MAX].map(|y| picture.row(y).len()), [320, 0, 0]);
}

#[test]
fn enlarged_pictures_stay_indexed_and_keep_their_shape() {
    let vga = patterned();
    let palette = vga.palette();
    let picture = Picture::mode_13h(vga.pixels(), &palette);
    for (scale, (width, height), density) in [
        (Scale::One, (320, 200), (6, 5)),
        (Scale::Double, (640, 400), (6, 5)),
        (Scale::FiveBySix, (1600, 1200), (1, 1)),
        (Scale::To { width: 640, height: 480 }, (640, 480), (1, 1)),
        (Scale::To { width: 333, height: 77 }, (333, 77), (999, 308)),
        (Scale::To { width: 1, height: 1 }, (1, 1), (3, 4)),
        (Scale::To { width: 3, height: 16_384 }, (3, 16_384), (9, 65_536)),
    ] {
        // The pixel of the frame under the centre of each pixel of the result.
        let under = |at: usize, of: usize, frame: usize| (2 * at + 1) * frame / (2 * of);
        let expected: Vec<u8> = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| vga.pixels()[under(y, height, 200) * 320 + under(x, width, 320)])
            .collect();

        let size = (width as u32, height as u32);
        let indexed = decoded(&picture, scale, false);
        assert_eq!((indexed.size, indexed.kind), (size, ColorType::Indexed), "{scale}");
        assert_eq!(indexed.palette, palette.colors(), "{scale}");
        assert!(indexed.pixels == expected, "{scale}");
        assert_eq!(indexed.density, Some(density), "{scale}");

        let rgb = decoded(&picture, scale, true);
        assert_eq!((rgb.size, rgb.kind), (size, ColorType::Rgb), "{scale}");
        let colors = expected.iter().map(|&index| palette[index]).flat_map(|c| [c.r, c.g, c.b]);
        assert!(rgb.pixels.iter().copied().eq(colors), "{scale}");
        assert_eq!(rgb.density, Some(density), "{scale}");
    }
}

#[test]
fn five_by_six_makes_blocks() {
    let vga = patterned();
    let palette = vga.palette();
    let decoded = decoded(&Picture::mode_13h(vga.pixels(), &palette), Scale::FiveBySix, false);
    assert_eq!(decoded.pixels.len(), 1600 * 1200);
    for (i, &index) in decoded.pixels.iter().enumerate() {
        let (x, y) = (i % 1600, i / 1600);
        assert_eq!(index, vga.pixels()[y / 6 * 320 + x / 5], "{x}, {y}");
    }
}

#[test]
fn rgb_png_looks_right_where_pixels_are_square() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("frame.png");
    let vga = patterned();
    let palette = vga.palette();
    let picture = Picture::mode_13h(vga.pixels(), &palette);
    Png { scale: Scale::FiveBySix, rgb: true }.save(&picture, &path).expect("written");
    let decoded = picture::Png::decode(&fs::read(&path).expect("read"));
    assert_eq!((decoded.size, decoded.kind), ((1600, 1200), ColorType::Rgb));
    assert_eq!(decoded.density, Some((1, 1)));
}

#[test]
fn a_part_of_a_larger_frame_is_exported_by_its_pitch() {
    let bytes: Vec<u8> = (0..=255).collect();
    let palette = Palette::default();
    let picture = Picture {
        pixels: &bytes[17..],
        width: 3,
        height: 2,
        pitch: 16,
        palette: palette.colors(),
        shape: PixelShape::default(),
    };
    let decoded = decoded(&picture, Scale::One, false);
    assert_eq!(decoded.pixels, [17, 18, 19, 33, 34, 35]);
    assert_eq!(decoded.density, Some((1, 1)));
}

/// Files are the same on a big-endian machine.
#[test]
fn a_png_begins_with_these_bytes() {
    let bytes = [7; 258 * 3];
    let palette = core::array::from_fn(|i| Rgb::new(i as u8, (i + 1) as u8, (i + 2) as u8));
    let picture = Picture {
        pixels: &bytes,
        width: 258,
        height: 3,
        pitch: 258,
        palette: &palette,
        shape: PixelShape { width: 5, height: 6 },
    };
    let file = Png { scale: Scale::One, rgb: false }.encode(&picture).expect("encoded");
    let heading = b"\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\x01\x02\0\0\0\x03\x08\x03\0\0\0";
    assert_eq!(file[..heading.len()], *heading);
    let chunk = |name: &[u8]| {
        let at = file.windows(4).position(|four| four == name).expect("a chunk");
        &file[at - 4..]
    };
    // Pixels of 5:6 lie 6:5 as densely; then the check of the chunk.
    assert_eq!(chunk(b"pHYs")[..17], *b"\0\0\0\x09pHYs\0\0\0\x06\0\0\0\x05\0");
    assert_eq!(chunk(b"PLTE")[..14], *b"\0\0\x03\0PLTE\0\x01\x02\x01\x02\x03");
    assert_eq!(chunk(b"IEND"), b"\0\0\0\0IEND\xAEB\x60\x82");
}

/// The largest picture in three planes or in true colour has an offset for each byte on a 32-bit machine.
#[test]
fn the_largest_picture_has_offsets_of_32_bits() {
    assert!(3 * u64::from(MAX_SIDE).pow(2) + 1_000_000 <= i32::MAX as u64);
}

#[test]
fn pictures_whose_sizes_do_not_fit_are_refused() {
    let palette = Palette::default();
    let pixels = [0; 100];
    let good = Picture {
        pixels: &pixels,
        width: 10,
        height: 10,
        pitch: 10,
        palette: palette.colors(),
        shape: PixelShape { width: 5, height: 6 },
    };
    assert!(Png { scale: Scale::One, rgb: false }.encode(&good).is_ok());
    let side = usize::from(MAX_SIDE) + 1;
    for (what, picture) in [
        ("no width", Picture { width: 0, ..good }),
        ("no height", Picture { height: 0, ..good }),
        ("too wide", Picture { width: side, pitch: side, ..good }),
        ("too high", Picture { height: side, pitch: 0, ..good }),
    ] {
        for rgb in [false, true] {
            let encoded = Png { scale: Scale::One, rgb }.encode(&picture);
            assert!(matches!(encoded, Err(PictureError::Size { .. })), "{what}");
        }
    }
    for (width, height) in [(0, 1), (1, 0), (0, 0)] {
        let error = Picture { shape: PixelShape { width, height }, ..good }.check().expect_err("no size");
        assert_eq!(error.to_string(), format!("pixels of shape {width} x {height}: neither side may be 0"));
    }
    let scaled = Scaled::new(&good, Scale::One).expect("a picture");
    for (columns, rows) in [(0..11, 0..1), (0..1, 10..11)] {
        let error = scaled.part(columns, rows).expect_err("beyond it");
        assert_eq!(error.to_string(), "the part is not within the picture of 10 x 10 pixels");
    }
    for (what, picture) in [
        ("a byte short", Picture { pixels: &pixels[1..], ..good }),
        ("rows overlap", Picture { pitch: 9, ..good }),
        ("a pitch beyond memory", Picture { pitch: usize::MAX, ..good }),
    ] {
        let encoded = Png { scale: Scale::One, rgb: false }.encode(&picture);
        assert!(matches!(encoded, Err(PictureError::Bytes { .. })), "{what}");
    }
    let large = Picture { width: 10_000, height: 1, pitch: 10_000, pixels: &[0; 10_000], ..good };
    assert!(matches!(
        Png { scale: Scale::Double, rgb: false }.encode(&large),
        Err(PictureError::Size { width: 20_000, height: 2 })
    ));
}

#[test]
fn scales_are_read_from_words() {
    for (words, scale) in [
        ("1", Scale::One),
        ("2", Scale::Double),
        ("5x6", Scale::FiveBySix),
        ("640x480", Scale::To { width: 640, height: 480 }),
        ("1x1", Scale::To { width: 1, height: 1 }),
        ("16384x16384", Scale::To { width: MAX_SIDE, height: MAX_SIDE }),
    ] {
        assert_eq!(words.parse(), Ok(scale));
        assert_eq!(scale.to_string(), words);
    }
    for words in [
        "",
        "0",
        "3",
        "x",
        "1x",
        "x1",
        "0x1",
        "1x0",
        "16385x1",
        "1x16385",
        "99999x99999",
        "-1x1",
        "+1x1",
        "1x1x1",
        " 1",
        "1 x 1",
        "1X1",
        "5*6",
    ] {
        assert!(words.parse::<Scale>().is_err(), "{words:?}");
    }
}

#[test]
fn f4_a_file_that_fails_half_way_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_file_that_fails_half_way_leaves_the_old_one_whole", 15);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("frame.png");
    fs::write(&path, "what stood there").expect("written");
    for kind in [io::ErrorKind::StorageFull, io::ErrorKind::Interrupted, io::ErrorKind::Other] {
        let result = write_atomically(&path, |out| {
            out.write_all(&[1; 100_000])?;
            out.flush()?;
            assert_eq!(names_in(folder.path()).len(), 2, "written beside its name");
            tried.add(1);
            Err(kind.into())
        });
        let error = result.expect_err("failed");
        assert_eq!(error.path, path);
        assert_eq!(matches!(error.kind, ExportErrorKind::DiskFull), kind == io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).expect("read"), b"what stood there");
        assert_eq!(names_in(folder.path()), ["frame.png"]);
        tried.add(4);
    }
}

#[test]
fn f4_a_writer_that_panics_leaves_the_old_one_whole() {
    let mut tried = Tried::new("f4_a_writer_that_panics_leaves_the_old_one_whole", 3);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("frame.png");
    fs::write(&path, "what stood there").expect("written");
    let panic = std::panic::catch_unwind(|| {
        write_atomically(&path, |out| {
            out.write_all(&[1; 100_000])?;
            std::panic::panic_any("half-way");
        })
    });
    assert!(panic.is_err());
    assert_eq!(fs::read(&path).expect("read"), b"what stood there");
    assert_eq!(names_in(folder.path()), ["frame.png"]);
    tried.add(3);
}

#[test]
fn f4_each_reason_has_its_own_error_with_the_path() {
    let mut tried = Tried::new("f4_each_reason_has_its_own_error_with_the_path", 18);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "a file").expect("written");
    let nothing = |_: &mut dyn Write| Ok(());

    for (path, says, kind) in [
        (folder.path().join("none").join("frame.png"), "none does not exist", ExportErrorKind::MissingDirectory),
        (file.join("frame.png"), "file is not a directory", ExportErrorKind::NotADirectory),
    ] {
        let error = write_atomically(&path, nothing).expect_err("no such folder");
        assert_eq!(core::mem::discriminant(&error.kind), core::mem::discriminant(&kind), "{error}");
        assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
        assert!(error.to_string().ends_with(says), "{error}");
        tried.add(3);
    }
    let directories = [folder.path().to_path_buf(), folder.path().join(".."), "".into()];
    let unnamed = write_atomically("", nothing).expect_err("no name");
    assert_eq!(unnamed.to_string(), "the file has no name");
    for path in directories.into_iter().chain(["new/", "new/."].map(|name| folder.path().join(name))) {
        let error = write_atomically(&path, nothing).expect_err("a folder");
        assert!(matches!(error.kind, ExportErrorKind::IsDirectory), "{error}");
        tried.add(1);
    }
    // Names that no file can have are refused before the file is made.
    for name in ["a".repeat(70_000), String::from("a\0b")] {
        let path = folder.path().join(name);
        write_atomically(&path, |_| panic!("this would be work for nothing")).expect_err("no such name");
        check_writable(&path).expect_err("no such name");
        tried.add(2);
    }

    let mut permissions = fs::metadata(&file).expect("metadata").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).expect("set");
    let error = write_atomically(&file, nothing).expect_err("read-only");
    assert!(matches!(error.kind, ExportErrorKind::NotPermitted), "{error}");
    assert_eq!(fs::read(&file).expect("read"), b"a file");
    assert_eq!(names_in(folder.path()), ["file"]);
    tried.add(3);
}

/// A file that replaces a private one is private from its first byte.
#[cfg(unix)]
#[test]
fn a_private_file_is_replaced_by_a_private_one() {
    use std::os::unix::fs::PermissionsExt;

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("secret");
    fs::write(&path, "old").expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("set");
    let modes = || -> Vec<u32> {
        let files = fs::read_dir(folder.path()).expect("a folder");
        files.map(|file| file.and_then(|file| file.metadata()).expect("a file").permissions().mode() & 0o777).collect()
    };
    write_atomically(&path, |out| {
        assert_eq!(modes(), [0o600; 2]);
        out.write_all(b"new")
    })
    .expect("written");
    assert_eq!((modes(), fs::read(&path).expect("read")), (vec![0o600], b"new".to_vec()));
}

#[test]
fn f4_a_picture_that_cannot_be_written_names_the_file() {
    let mut tried = Tried::new("f4_a_picture_that_cannot_be_written_names_the_file", 2);
    let palette = Palette::default();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("frame.png");
    let error = Png::default().save(&Picture::mode_13h(&[], &palette), &path).expect_err("no bytes");
    assert!(matches!(error.kind, ExportErrorKind::Picture(PictureError::Bytes { .. })), "{error}");
    assert!(names_in(folder.path()).is_empty());
    tried.add(2);
}

#[cfg(target_os = "linux")]
#[test]
fn f4_a_full_disk_is_an_error() {
    let mut tried = Tried::new("f4_a_full_disk_is_an_error", 3);
    // A device that is always full. It is written to, not replaced.
    let error = export::png(&patterned(), "/dev/full").expect_err("full");
    assert!(matches!(error.kind, ExportErrorKind::DiskFull), "{error}");
    assert_eq!(error.to_string(), "/dev/full: the disk is full");
    export::png(&patterned(), "/dev/null").expect("written");
    assert!(!fs::metadata("/dev/null").expect("metadata").is_file());
    tried.add(3);
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_and_permissions_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("far")).expect("made");
    let target = folder.path().join("far").join("target");
    let link = folder.path().join("link");
    fs::write(&target, "old").expect("written");
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("set");
    symlink(&target, &link).expect("linked");

    write_atomically(&link, |out| out.write_all(b"new")).expect("written");
    assert!(link.is_symlink());
    assert_eq!(fs::read(&target).expect("read"), b"new");
    assert_eq!(fs::metadata(&target).expect("metadata").permissions().mode() & 0o777, 0o640);
    assert_eq!(names_in(&folder.path().join("far")), ["target"]);
}

#[cfg(unix)]
#[test]
fn the_longest_name_there_is_can_be_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("n".repeat(255));
    write_atomically(&path, |out| out.write_all(b"whole")).expect("written");
    assert_eq!(fs::read(&path).expect("read"), b"whole");
}
