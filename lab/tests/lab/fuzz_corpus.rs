//! Hard case F5 in the normal run: all corpora, and every crash that a fuzzer found, through the properties that the
//! fuzz targets check; the same with each file truncated, repeated and damaged.
//!
//! `.ci/fuzz` runs the fuzzers themselves.

#[expect(unreachable_pub, reason = "the fuzz package shares it")]
mod properties;

use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};

use crate::support::tried::Tried;
use mode13h_conformance::Random;
use properties::PROPERTIES;

/// Name and bytes of each file in the corpus of a property.
fn corpus(property: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = crate::support::workspace::root().join("tests/corpus").join(property);
    let mut paths: Vec<PathBuf> = fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read(path).expect("a file"))).collect()
}

/// Runs a check, and on failure says on which bytes.
fn check(check: fn(&[u8]), of: &Path, bytes: &[u8]) {
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| check(bytes))) {
        println!("{}:\n{:?}\n{bytes:?}", of.display(), String::from_utf8_lossy(bytes));
        resume_unwind(panic);
    }
}

#[test]
fn f5_every_file_of_every_corpus() {
    let mut tried = Tried::new("f5_every_file_of_every_corpus", 137);
    for (name, property) in PROPERTIES {
        let files = corpus(name);
        assert!(files.len() >= 5, "{name} has {} files", files.len());
        for (path, bytes) in files {
            check(property, &path, &bytes);
            tried.add(1);
        }
    }
}

/// Files truncated anywhere, as after an interrupted copy.
#[test]
fn f5_files_cut_short_at_every_byte() {
    let mut tried = Tried::new("f5_files_cut_short_at_every_byte", 4_500);
    for (name, property) in PROPERTIES {
        for (path, bytes) in corpus(name) {
            // In a long file, every byte at the end and some before it.
            let step = bytes.len() / 200 + 1;
            let lengths = (0..bytes.len()).filter(|at| at % step == 0 || at + 20 > bytes.len());
            for length in lengths {
                check(property, &path, &bytes[..length]);
                tried.add(1);
            }
        }
    }
}

/// A few random changes: bytes, numbers, pieces of other files, pieces removed, pieces repeated.
#[test]
fn f5_damaged_files() {
    let mut tried = Tried::new("f5_damaged_files", 10_000);
    for (stream, (name, property)) in PROPERTIES.into_iter().enumerate() {
        let files = corpus(name);
        let mut random = Random::new(500 + stream as u64);
        for _ in 0..10_000 / PROPERTIES.len() + 1 {
            let (path, bytes) = damaged(&files, &mut random);
            check(property, &path, &bytes);
            tried.add(1);
        }
    }
}

/// One of the files with some damage.
fn damaged(files: &[(PathBuf, Vec<u8>)], random: &mut Random) -> (PathBuf, Vec<u8>) {
    let (path, mut bytes) = files[random.within(0, files.len() as i64 - 1) as usize].clone();
    for _ in 0..random.log_uniform(4) {
        damage(&mut bytes, files, random);
    }
    (path, bytes)
}

fn damage(bytes: &mut Vec<u8>, files: &[(PathBuf, Vec<u8>)], random: &mut Random) {
    let piece = |random: &mut Random, of: &[u8]| {
        let from = random.within(0, of.len() as i64) as usize;
        let length = random.log_uniform(6).min(of.len() - from);
        from..from + length
    };
    let here = piece(random, bytes);
    match random.within(0, 5) {
        0 => bytes[here].iter_mut().take(1).for_each(|byte| *byte = random.within(0, 255) as u8),
        1 => drop(bytes.drain(here)),
        2 => {
            let copy = bytes[here.clone()].to_vec();
            bytes.splice(here.end..here.end, copy);
        }
        3 => {
            let other = &files[random.within(0, files.len() as i64 - 1) as usize].1;
            let there = piece(random, other);
            bytes.splice(here, other[there].iter().copied());
        }
        4 => {
            let word = ["0", "-1", "256", "1e39", "nan", "2147483648", "\\\n", "\r", "\n", "#", "/", "\u{FEFF}", "\0"];
            let word = random.one_of(&word);
            bytes.splice(here.start..here.start, word.bytes());
        }
        _ => {
            let at = here.start;
            bytes.truncate(at);
        }
    }
}

/// The most memory that reading a model may hold at once, in bytes per byte of the file. A face whose corners are all `
/// 1` makes a triangle of every two bytes, and a triangle takes 200 (`cli/tests/cli/files.rs`, F2).
const BYTES_PER_BYTE: usize = 100;

/// The reader's buffers, messages, and tables that are never empty.
const BYTES_FOR_NOTHING: usize = 16 << 10;

/// Memory is proportional to the file's size, whatever numbers and names it contains.
#[test]
fn f5_no_file_takes_memory_out_of_proportion() {
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let mut tried = Tried::new("f5_no_file_takes_memory_out_of_proportion", 2_000);
    let mut worst = 0;
    let mut measure = |what: &Path, bytes: &[u8]| {
        let parse = || drop(mode13h_assets::model_file::obj::parse(bytes, "model.obj", none));
        let peak = allocation_counter::measure(parse).bytes_max as usize;
        let most = BYTES_FOR_NOTHING + BYTES_PER_BYTE * bytes.len();
        assert!(peak <= most, "{}: {peak} bytes for a file of {}", what.display(), bytes.len());
        worst = worst.max(peak.saturating_sub(BYTES_FOR_NOTHING) / bytes.len().max(1));
        tried.add(1);
    };
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let names: String = (0..5_000).map(|i| format!("usemtl {i}\nf 1 2 3\n")).collect();
    for (what, text) in [
        ("a great index", format!("{triangle}f 1 2 2147483647\n")),
        ("a greater index", format!("{triangle}f 1 2 9223372036854775807\n")),
        ("a face of 10⁶ corners", format!("{triangle}f{}", " 1".repeat(1_000_000))),
        ("10⁵ faces", format!("{triangle}{}", "f 1 2 3\n".repeat(100_000))),
        ("a sheet folded 10⁴ times", format!("{triangle}{}", "f 1 2 3\nf 3 2 1\n".repeat(10_000))),
        ("a face wound 6,000 times", format!("{triangle}f{}", " 1 2 3".repeat(6_000))),
        ("5,000 materials", format!("{triangle}{names}")),
        ("10⁵ libraries", format!("{triangle}{}f 1 2 3\n", "mtllib a\n".repeat(100_000))),
        ("a library of 10⁵ names", format!("{triangle}mtllib{}\nf 1 2 3\n", " a".repeat(100_000))),
        ("a long name", format!("{triangle}usemtl {}\nf 1 2 3\n", "m".repeat(1 << 20))),
        ("backslashes", "\\\n".repeat(100_000)),
    ] {
        measure(Path::new(what), text.as_bytes());
    }
    let files = corpus("obj");
    let mut random = Random::new(510);
    for _ in 0..2_000 {
        let (path, bytes) = damaged(&files, &mut random);
        measure(&path, &bytes);
    }
    println!("at most {worst} bytes of memory for a byte of a file");
}
