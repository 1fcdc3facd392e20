//! The files of a study: checked before it is made, and not lost if they cannot be written afterwards.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::{env, fs, process};

use mode13h::export;

use crate::failure::Failure;
use crate::{output, read_files};

/// Their names.
const NAMES: [&str; 4] = ["samples.csv", "cost.json", "chart.svg", REPORT];
pub(super) const REPORT: &str = "report.html";

/// Text at the start of each file, by which it is recognized as a study's.
const MARKS: [&str; NAMES.len()] =
    ["round,order,kind,name,frames,ns", "\"schema\"", "<svg width=\"860\"", "content=\"mode13h cost\""];

/// Returns whether a file begins like one of a study.
fn is_of_a_study(path: &Path, mark: &str) -> bool {
    let mut beginning = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(512).read_to_end(&mut beginning));
    read.is_ok() && String::from_utf8_lossy(&beginning).contains(mark)
}

/// Checks that the files can be written into a directory, which need not exist yet, and that none of them was read.
/// Files of an earlier study are overwritten if the user named the directory, others only by force.
pub(super) fn check(directory: &Path, is_named: bool, forced: bool) -> Result<(), Failure> {
    if directory.exists() && !directory.is_dir() {
        return Err(Failure::work(format!("{}: is not a directory", directory.display())));
    }
    if directory.is_dir() {
        return NAMES.iter().zip(MARKS).try_for_each(|(name, mark)| {
            let path = directory.join(name);
            read_files::spare(&path)?;
            if is_named && !forced && path.symlink_metadata().is_ok() && !is_of_a_study(&path, mark) {
                let path = path.display();
                let reason = "already exists and is not part of a study; --force overwrites it";
                return Err(Failure::work(format!("{path}: {reason}")));
            }
            output::refuse_overwriting(&path, forced || is_named)?;
            export::check_writable(&path).map_err(Failure::from)
        });
    }
    // The outermost missing directory is inside one that exists.
    let missing = directory.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    missing.last().map_or(Ok(()), export::check_writable).map_err(Failure::from)
}

/// Writes the files or, if that fails, say because the disk has filled up, writes them into a directory for temporary
/// files. Returns where they are, if anywhere, and the failure.
pub(super) fn write(
    directory: &Path,
    input: &str,
    contents: &[String; NAMES.len()],
) -> (Option<PathBuf>, Result<(), Failure>) {
    let Err(failure) = write_into(directory, contents) else { return (Some(directory.to_path_buf()), Ok(())) };
    let elsewhere = env::temp_dir().join(format!("mode13h-cost-{input}-{}", process::id()));
    match write_into(&elsewhere, contents) {
        Ok(()) => {
            let failure = failure.saying(format!("{failure}; the study is in {}", elsewhere.display()));
            (Some(elsewhere), Err(failure))
        }
        Err(_) => (None, Err(failure)),
    }
}

fn write_into(directory: &Path, contents: &[String; NAMES.len()]) -> Result<(), Failure> {
    fs::create_dir_all(directory).map_err(|error| Failure::work(format!("{}: {error}", directory.display())))?;
    NAMES.iter().zip(contents).try_for_each(|(name, text)| {
        let path = directory.join(name);
        output::bytes(&path, text.as_bytes())
    })
}
