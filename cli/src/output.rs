//! Output of the program: standard output, pictures, and the end by Ctrl-C.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};

use mode13h::export::{Picture, Png, Scale};
use mode13h::vga::Vga;
use serde::Serialize;

use crate::failure::Failure;
use crate::read_files;

/// The version of all JSON that the program prints or writes.
pub(crate) const SCHEMA: u32 = 1;

/// Held while a file is written, by any number of threads.
static WRITING: RwLock<()> = RwLock::new(());

/// Held while a file is written that may take long, and is given up when the program is told to end.
static WRITING_LONG: Mutex<()> = Mutex::new(());

/// Set once the program has been told to end.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Set once by --quiet.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Lets the program print nothing but warnings, errors and what it is run for.
pub(crate) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Returns whether --quiet was given.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Prints to standard output, unless the program is to be quiet.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    if is_quiet() { Ok(()) } else { print(text) }
}

/// Makes Ctrl-C, and what else asks a program to end, wait for the files that are being written: each is then whole
/// under its name, or gone if it takes long, and none is left beside it.
pub(crate) fn finish_files_when_interrupted() {
    let end = || {
        INTERRUPTED.store(true, Ordering::Relaxed);
        // First the long file, which ends by the flag: while it does, others may still be begun.
        let _no_long = WRITING_LONG.lock().unwrap_or_else(PoisonError::into_inner);
        // No file is begun from here on; those begun are waited for. The locks are never given back.
        let _none = WRITING.write().unwrap_or_else(PoisonError::into_inner);
        eprintln!("mode13h: interrupted");
        // 128 + SIGINT, as shells count.
        std::process::exit(130);
    };
    // Without a handler the program ends as the system has it, at once.
    let _ = ctrlc::set_handler(end);
}

/// Writes a file, for all commands. Never overwrites what this command has read or written, whatever name leads to it.
/// The file is whole even if the program is interrupted meanwhile.
pub(crate) fn file<T, E: Into<Failure>>(path: &Path, write: impl FnOnce() -> Result<T, E>) -> Result<T, Failure> {
    read_files::spare(path)?;
    let _writing = WRITING.read().unwrap_or_else(PoisonError::into_inner);
    let written = write().map_err(Into::into)?;
    read_files::add_written(path);
    Ok(written)
}

/// Writes a file that takes long, or a stream if there is no path, under the rule of [`file`]. `write` looks at
/// [`is_interrupted`] every moment, and gives the file up then: in that case this never returns, and the program ends as
/// interrupted.
pub(crate) fn long_file<T>(path: Option<&Path>, write: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    path.map_or(Ok(()), read_files::spare)?;
    let writing = WRITING_LONG.lock().unwrap_or_else(PoisonError::into_inner);
    let result = write();
    drop(writing);
    while is_interrupted() {
        // The thread that was told ends the program.
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

/// Writes what `vga` shows under the first name that is free of `mode13h-0001.png`, `mode13h-0002.png` and so on in
/// the current directory. Nothing is overwritten.
pub(crate) fn numbered_picture(vga: &Vga) -> Result<PathBuf, Failure> {
    let mut names = (1_u64..).map(|number| PathBuf::from(format!("mode13h-{number:04}.png")));
    // Some number below 2⁶⁴ is free, as no directory holds so many files.
    let path = names.find(|path| path.symlink_metadata().is_err()).unwrap_or_default();
    picture(&Picture::mode_13h(vga.pixels(), &vga.palette()), &path, false, Scale::One)?;
    Ok(path)
}

/// Prints to standard output. A closed pipe does not count as a failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::file(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON, with a line end.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// A value as JSON, with a line end.
pub(crate) fn json(value: &impl Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// A failure if a file of this name exists. For names that the user did not give: `--force` overwrites those.
pub(crate) fn refuse_overwriting(path: &Path, force: bool) -> Result<(), Failure> {
    if force || path.symlink_metadata().is_err() {
        return Ok(());
    }
    Err(Failure::file(format!("{}: exists already; --force overwrites it, and -o names another place", path.display())))
}

/// Returns whether a person sees what [`print`] prints, with colours.
pub(crate) fn is_colored_terminal() -> bool {
    io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
