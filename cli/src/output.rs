//! Output of the program: standard output, pictures, and how Ctrl-C ends it.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};

use indicatif::{ProgressBar, ProgressStyle};
use mode13h::export::{ExportError, ExportErrorKind, Picture, Png, Scale, write_atomically};
use mode13h::vga::Vga;
use serde::Serialize;

use crate::failure::Failure;
use crate::read_files;

/// The version of all JSON that the program prints or writes.
pub(crate) const SCHEMA: u32 = 1;

/// Held while a file is written, by any number of threads.
static WRITING: RwLock<()> = RwLock::new(());

/// Held while a file that may take long is written, or the terminal shows frames; both are given up if the program is told
/// to end.
static WRITING_LONG: Mutex<()> = Mutex::new(());

/// Set once the program has been told to end.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Set once by --quiet.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves out progress, remarks and what [`say`] prints; warnings, errors and what the program is run for remain.
pub(crate) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Returns whether --quiet was given.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Prints to standard output, unless `--quiet` was given.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    if is_quiet() { Ok(()) } else { print(text) }
}

/// Prints a line to standard error, after the program's name. Nobody may read it: a pipe that has been closed, or a full
/// disk, must not end the program.
pub(crate) fn note(line: impl Display) {
    // At once, so that lines of several threads do not mix.
    let _ = io::stderr().write_all(format!("mode13h: {line}\n").as_bytes());
}

/// Prints a [`note`] that is not a warning, unless `--quiet` was given.
pub(crate) fn remark(line: impl Display) {
    if !is_quiet() {
        note(line);
    }
}

/// Makes Ctrl-C and other termination signals wait for the files being written. Each is completed, or removed if it
/// would take long, and no temporary file is left behind.
pub(crate) fn finish_files_when_interrupted() {
    let end = || {
        INTERRUPTED.store(true, Ordering::Relaxed);
        // First wait for the long file, which the flag makes end; meanwhile others may still be started.
        let _no_long = WRITING_LONG.lock().unwrap_or_else(PoisonError::into_inner);
        // No file is started from here on, and those already started are waited for. The locks are never released.
        let _none = WRITING.write().unwrap_or_else(PoisonError::into_inner);
        note("interrupted");
        // 128 + SIGINT, as in shells.
        std::process::exit(130);
    };
    // Without a handler the system ends the program at once.
    let _ = ctrlc::set_handler(end);
}

/// Writes a file, for all commands. Never overwrites a file that this command has read or written, whatever name leads
/// to it. The file is complete even if the program is interrupted meanwhile.
pub(crate) fn file<T, E: Into<Failure>>(path: &Path, write: impl FnOnce() -> Result<T, E>) -> Result<T, Failure> {
    read_files::spare(path)?;
    let _writing = (!is_stream(path)).then(|| WRITING.read().unwrap_or_else(PoisonError::into_inner));
    let written = write().map_err(Into::into)?;
    read_files::note(path, "an output of this command");
    Ok(written)
}

/// Returns whether this is a device or a pipe. An interrupted program does not wait for these: there is no file to keep
/// complete, and a pipe may never be read.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Writes bytes to a file, under the rule of [`file`].
pub(crate) fn bytes(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    file(path, || write_atomically(path, |file| file.write_all(bytes)))
}

/// Writes a file that takes long, or a stream if there is no path, under the rule of [`file`]. `write` checks
/// [`is_interrupted`] regularly, and abandons the file if it is set: in that case this never returns, and the
/// program ends as interrupted.
pub(crate) fn long_file<T>(path: Option<&Path>, write: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    path.map_or(Ok(()), read_files::spare)?;
    if path.is_some_and(|path| !is_stream(path)) { to_its_end(write) } else { unless_interrupted(write()) }
}

/// Does what the program must not leave half done when it is told to end. `work` checks [`is_interrupted`] regularly,
/// and undoes what it did if it is set: in that case this never returns, and the program ends as interrupted.
pub(crate) fn to_its_end<T>(work: impl FnOnce() -> T) -> T {
    let working = WRITING_LONG.lock().unwrap_or_else(PoisonError::into_inner);
    let result = work();
    drop(working);
    unless_interrupted(result)
}

fn unless_interrupted<T>(result: T) -> T {
    while is_interrupted() {
        // The thread that handles the signal ends the program.
        std::thread::park();
    }
    result
}

/// Returns whether the program has been told to end.
pub(crate) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Writes a picture as a PNG: indexed, or in true colour if `rgb`.
pub(crate) fn picture(picture: &Picture<'_>, path: &Path, rgb: bool, scale: Scale) -> Result<(), Failure> {
    file(path, || Png { scale, rgb }.save(picture, path))
}

/// Writes what `vga` shows under the first free name of `mode13h-0001.png`, `mode13h-0002.png` and so on in the current
/// directory. Nothing is overwritten.
pub(crate) fn numbered_picture(vga: &Vga) -> Result<PathBuf, Failure> {
    let mut names = (1_u64..).map(|number| PathBuf::from(format!("mode13h-{number:04}.png")));
    // Some number below 2⁶⁴ is free, as no directory has that many files.
    let path = names.find(|path| path.symlink_metadata().is_err()).unwrap_or_default();
    picture(&Picture::mode_13h(vga.pixels(), &vga.palette()), &path, false, Scale::One)?;
    Ok(path)
}

/// Prints to standard output. A closed pipe does not count as a failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(not_printed(error)),
        _ => Ok(()),
    }
}

/// The failure of writing to standard output.
pub(crate) fn not_printed(error: io::Error) -> Failure {
    ExportError::new("standard output".as_ref(), ExportErrorKind::from_writing(error)).into()
}

/// A number of things in words, such as "1 frame" and "2 frames".
pub(crate) fn counted(number: u64, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// Prints a value as JSON, followed by a newline.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// A value as JSON, followed by a newline.
pub(crate) fn json(value: &impl Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// The name that was given, or a default one, under the rule of [`refuse_overwriting`].
pub(crate) fn path_or(given: Option<&PathBuf>, default: String, force: bool) -> Result<PathBuf, Failure> {
    if let Some(given) = given {
        return Ok(given.clone());
    }
    let path = PathBuf::from(default);
    refuse_overwriting(&path, force).map(|()| path)
}

/// Fails if a file of this name exists, unless `force` is set. For names that the user did not give.
pub(crate) fn refuse_overwriting(path: &Path, force: bool) -> Result<(), Failure> {
    if force || path.symlink_metadata().is_err() {
        return Ok(());
    }
    Err(Failure::work(format!("{}: already exists; --force overwrites it, -o writes elsewhere", path.display())))
}

/// Returns whether a name ends in an extension, in upper or lower case.
pub(crate) fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Fails if the name of `what` does not end in its extension.
pub(crate) fn check_extension(path: &Path, wanted: &str, what: &str) -> Result<(), Failure> {
    match has_extension(path, wanted) {
        true => Ok(()),
        false => Err(Failure::words(format!("{}: the name of {what} must end in .{wanted}", path.display()))),
    }
}

/// A progress bar on standard error, if that is a terminal and `--quiet` was not given.
pub(crate) fn bar(length: u64, template: &str) -> ProgressBar {
    if is_quiet() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Returns whether [`print`] prints to a terminal that shows colours.
pub(crate) fn is_colored_terminal() -> bool {
    io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
