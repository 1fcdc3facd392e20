//! The files that were read, and those that were written. None of them is ever overwritten, whatever name leads to it.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::failure::Failure;

/// The files so far, the names that led to them, and whether they were read or written.
static USED: Mutex<Vec<(Identity, PathBuf, &str)>> = Mutex::new(Vec::new());

/// Device and inode number of a file, which are the same through hard and symbolic links.
#[cfg(unix)]
type Identity = (u64, u64);
/// The path without links.
#[cfg(not(unix))]
type Identity = PathBuf;

/// Identity of an ordinary file, whatever name leads to it; `None` for anything else. Writing to a device or a pipe
/// does not replace it, and a file that does not exist cannot be lost.
fn identity(path: &Path) -> Option<Identity> {
    let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some((metadata.dev(), metadata.ino()))
    }
    #[cfg(not(unix))]
    {
        drop(metadata);
        fs::canonicalize(path).ok()
    }
}

thread_local! {
    /// The files that this thread reads or looks for, while they are being noted.
    static NOTED: RefCell<Option<Vec<PathBuf>>> = const { RefCell::new(None) };
}

/// Calls `read`, and returns its result and the files that this thread read or looked for meanwhile.
pub(crate) fn noting<T>(read: impl FnOnce() -> T) -> (T, Vec<PathBuf>) {
    let outer = NOTED.replace(Some(Vec::new()));
    let result = read();
    (result, NOTED.replace(outer).unwrap_or_default())
}

/// Records that a file is read.
pub(crate) fn add(path: &Path) {
    NOTED.with_borrow_mut(|noted| noted.iter_mut().for_each(|noted| noted.push(path.to_path_buf())));
    note(path, "an input");
}

/// Records what a file is to this command.
pub(crate) fn note(path: &Path, what: &'static str) {
    if let Some(identity) = identity(path) {
        let mut used = USED.lock().unwrap_or_else(PoisonError::into_inner);
        if used.iter().all(|(other, ..)| *other != identity) {
            used.push((identity, path.to_path_buf(), what));
        }
    }
}

/// Fails if writing under this name would replace a file that this command has read or written.
/// [`output::file`](crate::output::file) checks this; a command that takes long also checks it before it begins, once
/// everything is read.
pub(crate) fn spare(out: &Path) -> Result<(), Failure> {
    let Some(identity) = identity(out) else { return Ok(()) };
    let used = USED.lock().unwrap_or_else(PoisonError::into_inner);
    let Some((_, path, what)) = used.iter().find(|(other, ..)| *other == identity) else { return Ok(()) };
    let out_name = out.display();
    let reason = match path == out {
        true => format!("{out_name}: is {what} and will not be overwritten; choose another output name"),
        false => format!(
            "{out_name}: is the same file as {}, {what}, and will not be overwritten; choose another output name",
            path.display()
        ),
    };
    Err(Failure::words(reason))
}
