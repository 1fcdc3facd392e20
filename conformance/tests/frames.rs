//! Every kernel of this machine draws frames with the expected hashes, and the scenes match the shipped files.

use std::collections::BTreeSet;
use std::fs;

use mode13h::render::Renderer;
use mode13h::span::Kernel;
use mode13h_assets::shipped as files;
use mode13h_conformance::frames::{self, Frame, shipped};

/// The names of all frames that differ from what is expected, each with its first wrong pixel where the kernels differ.
fn wrong(kernel: Kernel, frames: &[Frame]) -> Vec<String> {
    // One renderer for all frames: its caches must not show.
    let mut renderer = Renderer::new();
    let differs = |frame: &Frame| {
        let drawn = match frame.draw_by(&mut renderer, kernel) {
            Ok(drawn) => drawn,
            Err(error) => return Some(format!("{}: {error}", frame.name)),
        };
        if frame.expected() == Some(drawn.hash) {
            return None;
        }
        let pixel = match frame.draw(Kernel::PORTABLE) {
            Ok(right) => drawn.difference(&right).map_or("as the portable kernel has it".into(), |at| at.to_string()),
            Err(error) => format!("the portable kernel says {error}"),
        };
        Some(format!("{} by {kernel}: {pixel}", frame.name))
    };
    frames.iter().filter_map(differs).collect()
}

#[test]
fn every_kernel_draws_the_frames_of_every_machine() {
    let frames = frames::all();
    if std::env::var_os("MODE13H_UPDATE").is_some() {
        let line = |frame: &Frame| {
            let hash = frame.draw(Kernel::PORTABLE).expect("a legal scene").hash;
            format!("{} {hash:#010x}\n", frame.name)
        };
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/frames/expected.txt");
        fs::write(path, frames.iter().map(line).collect::<String>()).expect("written");
        panic!("the hashes were written; look at what has changed, and test again");
    }
    for kernel in Kernel::available() {
        let wrong = wrong(kernel, &frames);
        assert!(wrong.is_empty(), "{} frames: {:#?}", wrong.len(), &wrong[..wrong.len().min(20)]);
    }
}

#[test]
fn names_and_pictures_are_distinct() {
    let frames = frames::all();
    let names: BTreeSet<&str> = frames.iter().map(|frame| frame.name.as_str()).collect();
    assert_eq!(names.len(), frames.len());
    // No hash is left of a frame that is no longer drawn.
    let listed = include_str!("../src/frames/expected.txt").lines().filter_map(|line| line.rsplit_once(" 0x"));
    let drawn: Vec<&str> = frames.iter().map(|frame| frame.name.as_str()).collect();
    assert_eq!(listed.map(|(name, _)| name).collect::<Vec<_>>(), drawn);
    // A frame equal to another tests nothing new, unless the pair shows that a setting changes nothing.
    let mut by_hash = std::collections::BTreeMap::<_, Vec<&str>>::new();
    for frame in &frames {
        by_hash.entry(frame.expected()).or_default().push(&frame.name);
    }
    let alike: Vec<_> = by_hash.values().filter(|names| names.len() > 1).collect();
    println!("{} frames, {} pictures; alike: {alike:#?}", frames.len(), by_hash.len());
    assert!(by_hash.len() * 20 >= frames.len() * 17, "{alike:#?}");
}

/// The scenes built in code equal those in the files, to the last bit.
#[test]
fn shipped_scenes_are_their_files() {
    assert_eq!(
        shipped::ALL.map(|(name, _)| name).to_vec(),
        files::ALL.iter().map(|file| file.name).collect::<Vec<_>>()
    );
    for ((name, make), file) in shipped::ALL.iter().zip(&files::ALL) {
        let mut value = make();
        value.set_time(0.0);
        let (value, file) = (format!("{value:#?}"), format!("{:#?}", file.load().expect("it loads").scene));
        if let Some((value, file)) = value.lines().zip(file.lines()).find(|(value, file)| value != file) {
            panic!("{name}: {value} in place of {file}");
        }
        assert_eq!(value.len(), file.len(), "{name}");
    }
}

/// A wrong byte is found, and its position is reported.
#[test]
fn a_difference_names_its_pixel() {
    let frames = frames::all();
    let frame = frames.iter().find(|frame| frame.name == "canvas/bands/plain").expect("it is there");
    let right = frame.draw(Kernel::PORTABLE).expect("a legal scene");
    let mut wrong = right.clone();
    assert_eq!(wrong.difference(&right), None);
    wrong.pixels[3 * 320 + 17] ^= 1;
    wrong.pixels[9 * 320] ^= 2;
    let found = wrong.difference(&right).expect("two pixels");
    assert_eq!((found.x, found.y, found.is, found.pixels), (17, 3, right.pixels[3 * 320 + 17] ^ 1, 2));
}
