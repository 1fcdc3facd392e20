//! Files that are either complete or absent: written under another name, flushed, then renamed.

use std::error::Error;
use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// The error for a file that could not be written. A previous file of that name is untouched.
#[non_exhaustive]
pub struct ExportError {
    /// The file that was to be written.
    pub path: PathBuf,
    /// The kind of the error.
    pub kind: ExportErrorKind,
}

impl ExportError {
    /// Makes an error about a file.
    #[must_use]
    pub fn new(path: &Path, kind: ExportErrorKind) -> ExportError {
        ExportError { path: path.to_path_buf(), kind }
    }
}

/// The kinds of error that can occur while a file is written.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExportErrorKind {
    /// The directory for the file does not exist.
    MissingDirectory,
    /// A path that was used as a directory is a file.
    NotADirectory,
    /// The directory exists, but no file can be created in it, because only the system creates files there.
    NoNewFiles,
    /// The name is that of a directory, ends like one, or is empty.
    IsDirectory,
    /// Permission is denied, or the file or the file system is read-only.
    NotPermitted,
    /// The disk, or the user's quota, is full.
    DiskFull,
    /// The picture itself cannot be written.
    #[cfg(feature = "png")]
    Picture(super::PictureError),
    /// Any other error reported by the system.
    Io(io::Error),
}

impl ExportErrorKind {
    /// Makes an error from opening or renaming a file with this name.
    fn from_opening(path: &Path, error: io::Error) -> ExportErrorKind {
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => match fs::metadata(directory_of(path)) {
                Ok(directory) if directory.is_dir() => ExportErrorKind::NoNewFiles,
                Ok(_) => ExportErrorKind::NotADirectory,
                Err(_) => ExportErrorKind::MissingDirectory,
            },
            io::ErrorKind::IsADirectory => ExportErrorKind::IsDirectory,
            io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => ExportErrorKind::NotPermitted,
            _ => ExportErrorKind::from_writing(error),
        }
    }

    /// Makes an error from writing into an open file. Here, "not found" says nothing about the directory.
    pub fn from_writing(error: io::Error) -> ExportErrorKind {
        match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => ExportErrorKind::DiskFull,
            _ => ExportErrorKind::Io(error),
        }
    }
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.path.as_os_str().is_empty() {
            return f.write_str("the file has no name");
        }
        write!(f, "{}: ", self.path.display())?;
        match &self.kind {
            ExportErrorKind::MissingDirectory => {
                write!(f, "the directory {} does not exist", directory_of(&self.path).display())
            }
            ExportErrorKind::NotADirectory => write!(f, "{} is not a directory", directory_of(&self.path).display()),
            ExportErrorKind::NoNewFiles => {
                write!(f, "no file can be created in the directory {}", directory_of(&self.path).display())
            }
            ExportErrorKind::IsDirectory => f.write_str("is a directory"),
            ExportErrorKind::NotPermitted => f.write_str("no permission to write there"),
            ExportErrorKind::DiskFull => f.write_str("the disk is full"),
            #[cfg(feature = "png")]
            ExportErrorKind::Picture(error) => write!(f, "{error}"),
            ExportErrorKind::Io(error) => write!(f, "{error}"),
        }
    }
}

crate::errors::debug_as_display!(ExportError);

impl Error for ExportError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.kind {
            #[cfg(feature = "png")]
            ExportErrorKind::Picture(error) => Some(error),
            ExportErrorKind::Io(error) => Some(error),
            _ => None,
        }
    }
}

/// Writes a file completely or not at all.
///
/// `write` fills a temporary file in the same directory (`.mode13h-` and two numbers), which is flushed to the disk and
/// then renamed to `path`. If `write` fails or panics, or the disk fails, the temporary file is removed and whatever
/// was at `path` before is unchanged. Symbolic links are followed, except that one whose target does not exist is
/// itself replaced by the file. The permissions of a replaced file are preserved; a read-only file is an error,
/// although a rename could replace it. An existing path that is not a regular file (a device, a pipe) is written to
/// directly, since renaming would replace it.
///
/// # Errors
///
/// [`ExportError`], with the path and the cause. If `write` returns an error other than a full disk, the cause is
/// [`ExportErrorKind::Io`].
///
/// ```
/// use std::io::Write as _;
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("note.txt");
/// mode13h::export::write_atomically(&path, |out| out.write_all(b"320 x 200"))?;
/// assert_eq!(std::fs::read(&path)?, b"320 x 200");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_atomically(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), ExportError> {
    let mut file = AtomicFile::create(path.as_ref())?;
    match write(&mut file) {
        Ok(()) => file.commit(),
        Err(error) => Err(ExportError::new(&file.path, ExportErrorKind::from_writing(error))),
    }
}

/// Tests whether [`write_atomically`] could write a file of this name, apart from a full disk, by
/// creating and removing a temporary file. An existing file is left alone; a device or a pipe is not tested.
///
/// # Errors
///
/// [`ExportError`], the one that `write_atomically` would return.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), ExportError> {
    // Opening a pipe would wait for its reader, who would then see its end.
    if is_stream(path.as_ref()) {
        return Ok(());
    }
    AtomicFile::create(path.as_ref()).map(drop)
}

/// An unfinished file, as used by [`write_atomically`]. It gets its name when it is committed, and is removed if it is
/// dropped before that.
pub struct AtomicFile {
    /// The path given by the caller, for errors.
    path: PathBuf,
    /// The path that the file is renamed to.
    target: PathBuf,
    out: BufWriter<File>,
    /// The temporary file; `None` for a device or a pipe.
    temporary: Option<Temporary>,
}

impl AtomicFile {
    /// Creates a file under a temporary name in the same folder.
    ///
    /// # Errors
    /// The folder does not exist, permission is denied, or the name is that of a folder.
    pub fn create(path: &Path) -> Result<AtomicFile, ExportError> {
        let fail = |error: io::Error| ExportError::new(path, ExportErrorKind::from_opening(path, error));
        let begun = |target: &Path, file, temporary| AtomicFile {
            path: path.to_path_buf(),
            target: target.to_path_buf(),
            out: BufWriter::new(file),
            temporary,
        };

        // A link is followed, so that its target is replaced and not the link. A dangling link is replaced itself. The path
        // is absolute, in case the current directory changes before the file is complete.
        let target = fs::canonicalize(path).or_else(|error| {
            let name = path.file_name().ok_or(error)?;
            fs::canonicalize(directory_of(path)).map(|directory| directory.join(name))
        });
        let target = target.unwrap_or_else(|_| path.to_path_buf());
        let before = fs::metadata(&target).ok();
        if let Some(before) = &before {
            if before.is_dir() {
                return Err(ExportError::new(path, ExportErrorKind::IsDirectory));
            }
            if !before.is_file() {
                let device = File::options().write(true).open(&target).map_err(fail)?;
                return Ok(begun(&target, device, None));
            }
            if before.permissions().readonly() {
                return Err(ExportError::new(path, ExportErrorKind::NotPermitted));
            }
        }
        let name = path.as_os_str().to_string_lossy();
        let named_as_directory = name.strip_suffix('.').unwrap_or(&name).ends_with(std::path::is_separator);
        if named_as_directory || target.file_name().is_none() {
            return Err(ExportError::new(path, ExportErrorKind::IsDirectory));
        }
        // A name that the system does not take, such as one that is too long, would otherwise fail only at the renaming.
        if let Err(error) = fs::symlink_metadata(&target)
            && error.kind() != io::ErrorKind::NotFound
        {
            return Err(fail(error));
        }

        let (temporary, file) = Temporary::create(directory_of(&target)).map_err(fail)?;
        if let Some(before) = before {
            // Before anything is written, which others may not be allowed to read.
            file.set_permissions(before.permissions()).map_err(fail)?;
        }
        Ok(begun(&target, file, Some(temporary)))
    }

    /// Flushes the file to the disk and renames it.
    ///
    /// # Errors
    /// The disk is full, or the file cannot be renamed.
    pub fn commit(self) -> Result<(), ExportError> {
        let AtomicFile { path, target, out, temporary } = self;
        let fail = |error: io::Error| ExportError::new(&path, ExportErrorKind::from_opening(&path, error));
        let fail_to_write = |error: io::Error| ExportError::new(&path, ExportErrorKind::from_writing(error));
        let file = out.into_inner().map_err(|error| fail_to_write(error.into_error()))?;
        let Some(temporary) = temporary else { return Ok(()) };
        file.sync_all().map_err(fail_to_write)?;
        drop(file);
        temporary.rename(&target).map_err(fail)
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Returns whether this is an existing device or pipe.
fn is_stream(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// The directory of a file with this name.
fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(directory) if !directory.as_os_str().is_empty() => directory,
        _ => Path::new("."),
    }
}

/// A file that is removed when it is dropped, unless it was renamed.
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// Creates a file with a unique name in `directory`.
    fn create(directory: &Path) -> io::Result<(Temporary, File)> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        loop {
            // The name does not include the file's own, which may already be as long as the system allows.
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = directory.join(OsString::from(format!(".mode13h-{}-{number}", std::process::id())));
            match File::options().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((Temporary { path }, file)),
                // Left behind by a killed process with the same id.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn rename(self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        // There is nothing under that name to remove any more.
        std::mem::forget(self);
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // A failure here can only be ignored; the error that led here is the one to report.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_stays_in_its_directory_if_the_current_one_changes() {
        let file = AtomicFile::create(Path::new("relative name")).expect("a file");
        let temporary = file.temporary.as_ref().expect("a file");
        assert!(file.target.is_absolute() && temporary.path.is_absolute(), "{:?}", file.target);
        assert_eq!(file.path, Path::new("relative name"));
    }
}
