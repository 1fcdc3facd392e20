//! Recorded frames: what is written is read again, what is broken is refused by its line, and what is
//! recorded is the frame that is drawn.

use crate::support::property::property;
use crate::support::triangles::triangle;
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::mesh::shapes;
use mode13h::palette::builtin;
use mode13h::raster::{Interpolation, Rect};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::{HiddenSurfaces, Shading};
use mode13h_conformance::Random;
use mode13h_lab::record::{Record, RecordErrorKind};
use mode13h_lab::replay;
use proptest::prelude::*;

fn scene(name: &str) -> Scene {
    let mut scene = crate::support::scenes::framed(shapes::by_name(name).expect("listed"));
    scene.objects_mut()[0].angles = [0.4, 0.5, 0.1].map(Angle::from_radians);
    scene
}

fn any_record(random: &mut Random) -> Record {
    let (width, height) = (random.within(1, 4096) as u32, random.within(1, 4096) as u32);
    let mut ends = |size: u32| {
        let (a, b) = (random.within(0, size.into()) as u32, random.within(0, size.into()) as u32);
        (a.min(b), a.max(b))
    };
    let ((x0, x1), (y0, y1)) = (ends(width), ends(height));
    let clip = random.one_of(&[None, Some(Rect { x0, y0, x1, y1 })]);
    let mut record = Record::new(width, height).expect("a frame").with_clip(clip);
    record.background = random.within(0, 255) as u8;
    record.hidden_surfaces = random.one_of(&HiddenSurfaces::ALL);
    record.palette = random.one_of(&[None, Some(0), Some(2)]).map(|i: usize| builtin::ALL[i].palette.clone());
    for _ in 0..random.within(0, 20) {
        let flat = Interpolation::Flat(random.within(0, 255) as u8);
        let interpolation = if random.within(0, 4) == 0 { flat } else { random.one_of(Interpolation::INTERPOLATED) };
        record.triangles.push((triangle(random, width.into(), height.into()), interpolation));
    }
    record
}

#[test]
fn what_is_written_is_read_again() {
    let mut tried = Tried::new("what_is_written_is_read_again", 300);
    let mut random = Random::named("records");
    while tried.more() {
        let record = any_record(&mut random);
        let text = record.to_string();
        assert_eq!(Record::read(text.as_bytes()).expect(&text), record);
        // By hand: indented, with empty lines, ended as DOS does.
        let edited = text.lines().map(|line| format!("\t{line} \r\n\r\n# a note\r\n")).collect::<String>();
        assert_eq!(Record::read(edited.as_bytes()).expect(&edited), record);
    }
}

const SMALL: &str = "mode13h record 1\nframe 8 4\nclip 1 0 8 4\nbackground 9\nhidden-surfaces painter\ntriangles\n\
                     flat 7  0 0 0 1  2048 0 0 1  0 1024 65280 4294967295\nend\n";

#[test]
fn f5_broken_records_are_refused_by_their_line() {
    let record = Record::read(SMALL.as_bytes()).expect("a record");
    assert_eq!((record.width(), record.height(), record.background), (8, 4, 9));
    assert_eq!(record.clip(), Some(Rect { x0: 1, y0: 0, x1: 8, y1: 4 }));
    assert_eq!((record.triangles[0].1, record.triangles[0].0[2].depth()), (Interpolation::Flat(7), u32::MAX));

    let mut tried = Tried::new("f5_broken_records_are_refused_by_their_line", 25);
    for (from, to, says) in [
        ("mode13h record 1", "", "line 2: no record: it would begin with"),
        ("mode13h record 1", "P6", "line 1: no record: it would begin with"),
        ("mode13h record 1", "mode13h record 2", "line 1: a record of version \"2\"; this program reads 1"),
        ("frame 8 4", "frame 8", "line 2: expected a height, found \"\""),
        ("frame 8 4", "frame 8 4 1", "line 2: expected the end of the line, found \"1\""),
        ("frame 8 4", "frame 0 4", "line 2: a frame of 0 × 4 pixels"),
        ("frame 8 4", "frame 4097 4", "line 2: a frame of 4097 × 4 pixels"),
        ("frame 8 4", "frame 8 4e0", "line 2: expected a height, found \"4e0\""),
        ("frame 8 4", "", "line 3: expected \"frame\", found \"clip\""),
        ("clip 1 0 8 4", "clip 1 0 9 4", "line 3: the clip rectangle must lie inside the frame"),
        ("clip 1 0 8 4", "clip 7 0 6 4", "line 3: the clip rectangle must lie inside the frame"),
        ("clip 1 0 8 4", "clap", "line 3: expected \"background\" or \"clip\", found \"clap\""),
        ("background 9", "background 256", "line 4: expected a palette index, found \"256\""),
        (
            "surfaces painter",
            "surfaces painters",
            "line 5: expected a way to leave out hidden surfaces, found \"painters\"",
        ),
        ("triangles", "palette 1\n012345", "line 7: expected a colour rrggbb, found \"\""),
        ("triangles", "palette 1\n01234g", "line 7: expected a colour rrggbb, found \"01234g\""),
        ("triangles", "palette 1\n+12345", "line 7: expected a colour rrggbb, found \"+12345\""),
        // The first coordinate is taken for the byte, the next for that, and so on.
        ("flat 7", "flat", "line 7: expected a shade in 1/256, found \"4294967295\""),
        ("flat 7", "flat -1", "line 7: expected a palette index, found \"-1\""),
        (
            "flat 7",
            "phong",
            "line 7: expected a shading (\"flat\", \"gouraud-reseeded\" …) or \"end\", found \"phong\"",
        ),
        ("2048 0 0 1", "1048577 0 0 1", "line 7: vertex at (1048577, 0) / 256 pixels lies outside the guard band"),
        ("1024 65280", "1024 65281", "line 7: vertex shade 0xff01 is above 0xff00"),
        ("4294967295", "4294967296", "line 7: expected a depth, found \"4294967296\""),
        ("4294967295", "", "line 7: expected a depth, found \"\""),
        ("end", "", "line 9: the file ends where a triangle or \"end\" should follow"),
        ("end", "end\nend", "line 9: expected nothing after \"end\", found \"end\""),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL);
        let error = Record::read(text.as_bytes()).expect_err(&text).to_string();
        assert!(error.starts_with(says), "{error}\nis not {says}");
        tried.add(1);
    }
    let ramps = builtin::ALL[0]
        .palette
        .colors()
        .chunks(8)
        .map(|eight| eight.iter().map(|color| format!("{:06x} ", color)).collect::<String>() + "\n");
    let text = SMALL.replace("triangles", &format!("palette 3\n{}triangles", ramps.collect::<String>()));
    let error = Record::read(text.as_bytes()).expect_err("three ramps").to_string();
    assert_eq!(error, "line 6: a palette has 0, 1, 2, 4 … 256 ramps, not 3");
    tried.add(1);
}

#[test]
fn f5_what_is_no_text_is_refused() {
    let mut tried = Tried::new("f5_what_is_no_text_is_refused", 4);
    for bytes in [&b"\x89PNG\r\n\x1a\n"[..], b"", &[0; 5000], &[b'm'; 5000]] {
        let error = Record::read(bytes).expect_err("no record");
        assert!(matches!(error.kind, RecordErrorKind::NoRecord), "{error}");
        tried.add(1);
    }
    // A line without end is not read to its end, wherever it stands.
    let long = SMALL.replace("flat 7", &"flat ".repeat(1000));
    assert!(matches!(Record::read(long.as_bytes()).expect_err("too long").kind, RecordErrorKind::NoText));
    let error = Record::load("no such file").expect_err("no such file");
    assert_eq!(error.line, 0);
    assert!(matches!(error.kind, RecordErrorKind::Read(_)), "{error}");
}

#[test]
fn f5_broken_off_anywhere_it_is_refused() {
    let mut tried = Tried::new("f5_broken_off_anywhere_it_is_refused", 100);
    let text = Record::of_scene(&mut Renderer::new(), &scene("cube"), Screen::MODE_13H).expect("a record").to_string();
    for length in 0..text.trim_end().len() {
        assert!(Record::read(&text.as_bytes()[..length]).is_err(), "{length} of {} bytes", text.len());
        tried.add(1);
    }
    assert!(Record::read(text.as_bytes()).is_ok());
}

/// A record with some of its bytes changed, left out or put in is refused or read, never more; what is
/// read can be written, drawn and replayed.
#[test]
fn f5_a_spoilt_record_never_panics() {
    let edits = proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>(), 0..4_u8), 1..4);
    property(Tried::new("f5_a_spoilt_record_never_panics", 2_000), edits, |edits| {
        let mut bytes = SMALL.as_bytes().to_vec();
        for (place, byte, kind) in edits {
            let place = place.index(bytes.len());
            let digit = b"0123456789- \n"[usize::from(byte) % 13];
            match kind {
                0 => bytes[place] = byte,
                1 => drop(bytes.remove(place)),
                2 => bytes.insert(place, digit),
                _ => bytes[place] = digit,
            }
        }
        if let Ok(record) = Record::read(&bytes[..]) {
            prop_assert_eq!(&Record::read(record.to_string().as_bytes()).expect("its own"), &record);
            if record.width() * record.height() < 1000 {
                let replay = replay::replay(&record);
                prop_assert!(replay.failures.is_empty(), "{:?}", replay.failures);
            }
        }
        Ok(())
    });
}

#[test]
fn f5_any_text_is_refused_or_read() {
    let text = "(mode13h record 1\n)?(frame|clip|background|flat|end|[0-9 -]{1,9}|\n){0,40}";
    property(Tried::new("f5_any_text_is_refused_or_read", 2_000), text, |text| {
        if let Err(error) = Record::read(text.as_bytes()) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
        Ok(())
    });
}

/// Replaying a record gives the frame that the renderer gives, by every kernel, every method and the oracle.
#[test]
fn d4_recorded_frames_replay() {
    let mut tried = Tried::new("d4_recorded_frames_replay", 7 * 8);
    for name in shapes::NAMES {
        for shading in Shading::ALL {
            let mut renderer = Renderer::new();
            renderer.settings.accuracy = Some(shading.into());
            if shading.lights_pixels() {
                assert!(Record::of_scene(&mut renderer, &scene(name), Screen::MODE_13H).is_err());
                continue;
            }
            let record = Record::of_scene(&mut renderer, &scene(name), Screen::MODE_13H).expect("legal");
            let mut vga = mode13h::vga::Vga::new();
            let stats = renderer.draw(&scene(name), &mut vga).expect("legal");
            assert_eq!((record.triangles.len() as u64, record.hidden_surfaces), (stats.drawn, stats.hidden_surfaces));
            let replay = replay::replay(&record);
            assert!(replay.failures.is_empty(), "{name}, {shading}: {:#?}", replay.failures);
            let by_line = replay.comparisons.iter().find(|c| c.hidden_surfaces == HiddenSurfaces::ScanLine);
            assert_eq!(by_line.map(|c| c.must_agree), Some(shading.has_exact_cover()), "{name}, {shading}");
            let drawn = vga.pixels().iter().filter(|pixel| **pixel != 0).count() as u64;
            assert!(replay.covered >= drawn && drawn > 1000, "{name}: {drawn} of {}", replay.covered);
            tried.add(1);
        }
    }
    // A frame's sides are a renderer's error, not a panic.
    let screen = Screen { width: 0, height: 200, pixel_aspect: (1, 1) };
    assert!(Record::of_scene(&mut Renderer::new(), &scene("cube"), screen).is_err());
}
