//! Instructions, counted by valgrind's callgrind: a figure without noise.
//!
//! The program runs itself under callgrind, with the same arguments and one more. There it draws each shading's frames
//! in a call of [`draw_counted`], after drawing them once. Callgrind counts only inside that function, and writes its
//! counts before each call of [`shading_is_done`].

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::hint::black_box;
use std::io::ErrorKind;
use std::process::Command;
use std::{env, fs};

use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h::vga::Vga;

use crate::failure::Failure;
use crate::output;

/// Pattern for the function inside which callgrind counts.
const COUNTED: &str = "*draw_counted*";

/// Pattern for the function before which callgrind writes its counts.
const DONE: &str = "*shading_is_done*";

/// Draws all frames with each shading, for callgrind to count, and prints which kernel drew them.
pub(super) fn draw(frames: &[Scene], shadings: &[Shading], renderer: &dyn Fn() -> Renderer) -> Result<(), Failure> {
    let mut vga = Vga::new();
    let mut kernel = renderer().kernel;
    for shading in shadings {
        let mut renderer = renderer();
        renderer.settings.accuracy = Some((*shading).into());
        renderer.force(Effect::Transform, Some(true));
        for scene in frames {
            renderer.draw(scene, &mut vga)?;
        }
        draw_counted(frames, &mut renderer, &mut vga)?;
        shading_is_done(shading);
        kernel = renderer.kernel;
    }
    let level = if kernel.name() == "simd" { format!("simd-{}", kernel.level()) } else { kernel.name().to_string() };
    output::print(&format!("{level}\n"))
}

#[inline(never)]
fn draw_counted(frames: &[Scene], renderer: &mut Renderer, vga: &mut Vga) -> Result<(), Failure> {
    for scene in frames {
        black_box(renderer.draw(scene, vga)?);
    }
    Ok(())
}

#[inline(never)]
fn shading_is_done(shading: &Shading) {
    black_box(shading);
}

/// Counts the instructions of every shading by running this program again with its own arguments. Returns the kernel
/// that ran, by the name that forces it, and the instructions per frame.
pub(super) fn count(shadings: &[Shading], frames: usize) -> Result<(String, BTreeMap<Shading, u64>), Failure> {
    let directory = tempfile::Builder::new().prefix("mode13h-").tempdir()?;
    let program = env::current_exe()?;
    let out = Command::new("valgrind")
        .args(["--tool=callgrind", "--quiet", "--collect-atstart=no"])
        .args([format!("--toggle-collect={COUNTED}"), format!("--dump-before={DONE}")])
        .arg(format!("--callgrind-out-file={}", directory.path().join("counts").display()))
        .arg(program)
        .args(own_arguments(env::args_os().skip(1)))
        .output();
    let out = out.map_err(|error| match error.kind() {
        ErrorKind::NotFound => Failure::work("--instructions needs valgrind, which was not found"),
        _ => Failure::work(format!("valgrind: {error}")),
    })?;
    if !out.status.success() {
        let said = String::from_utf8_lossy(&out.stderr);
        let said = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it failed without a message");
        return Err(Failure::work(format!("valgrind: {}", said.trim_start_matches("mode13h: "))));
    }
    let mut of = BTreeMap::new();
    for (shading, number) in shadings.iter().zip(1..) {
        // Numbered from 1.
        let path = directory.path().join(format!("counts.{number}"));
        let all = fs::read_to_string(&path).ok().and_then(|text| sum(&text));
        let all = all
            .ok_or_else(|| Failure::work("valgrind counted nothing: has the program been stripped of its symbols?"))?;
        of.insert(*shading, all / frames.max(1) as u64);
    }
    Ok((String::from_utf8_lossy(&out.stdout).trim().to_string(), of))
}

/// The arguments of the program that is counted: these and `--counted`, which must precede a `--`.
fn own_arguments(given: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut all: Vec<OsString> = given.collect();
    let end = all.iter().position(|word| word == "--").unwrap_or(all.len());
    all.insert(end, "--counted".into());
    all
}

/// The total instructions in a callgrind file, if it has any.
fn sum(text: &str) -> Option<u64> {
    let of = |key: &str| text.lines().find_map(|line| line.strip_prefix(key)?.trim().parse().ok());
    of("totals:").or_else(|| of("summary:")).filter(|sum| *sum > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_may_follow_two_dashes() {
        let own = |words: &[&str]| own_arguments(words.iter().map(OsString::from));
        assert_eq!(own(&["cost", "a.obj"]), ["cost", "a.obj", "--counted"]);
        assert_eq!(own(&["cost", "--", "--a.obj"]), ["cost", "--counted", "--", "--a.obj"]);
    }

    #[test]
    fn the_sum_is_read_where_callgrind_writes_it() {
        assert_eq!(sum("events: Ir\nsummary: 12\n\nfn=(1) x\n3 4\n\ntotals: 12\n"), Some(12));
        assert_eq!(sum("events: Ir\nsummary: 12\n"), Some(12));
        assert_eq!(sum("totals: 0\n"), None);
        assert_eq!(sum(""), None);
    }
}
