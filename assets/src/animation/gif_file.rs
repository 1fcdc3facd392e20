//! A GIF film as a file that is whole or not there.

use std::path::{Path, PathBuf};

use mode13h::export::AtomicFile;
use mode13h::export::{ExportError, ExportErrorKind, Picture, Scale};

use super::{Film, FrameRate, GifError, GifFrame, GifWriter};

/// A film that goes round for ever, written to a file frame by frame as [`GifWriter`] does.
///
/// The file is written beside its name and gets it when the film is finished. If it is dropped before, it is removed,
/// and the file that stood under the name is as it was.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h_assets::animation::{FrameRate, GifFile};
/// use mode13h::vga::Vga;
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("fade.gif");
/// let mut vga = Vga::new();
/// let (dark, light) = (vga.palette(), mode13h::palette::builtin::by_name("copper").unwrap().palette.clone());
/// vga.pixels_mut().iter_mut().enumerate().for_each(|(i, pixel)| *pixel = (i % 320 / 2) as u8);
/// let mut film = GifFile::create(&path, Scale::FiveBySix, FrameRate::try_from(25.0)?)?;
/// for t in 0..=256 {
///     vga.fade(&dark, &light, t);
///     film.add(&Picture::mode_13h(vga.pixels(), &vga.palette()))?;
/// }
/// let film = film.finish()?;
/// assert_eq!(std::fs::metadata(&path)?.len(), film.bytes);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct GifFile {
    path: PathBuf,
    writer: GifWriter<AtomicFile>,
}

impl GifFile {
    /// Begins a film of no frames yet, to stand under `path`.
    ///
    /// # Errors
    ///
    /// [`ExportError`] if no file can be written there, as [`write_atomically`](mode13h::export::write_atomically) has it.
    pub fn create(path: impl AsRef<Path>, scale: Scale, rate: FrameRate) -> Result<GifFile, ExportError> {
        let path = path.as_ref();
        let file = AtomicFile::create(path)?;
        Ok(GifFile { path: path.to_path_buf(), writer: GifWriter::new(file, scale, rate) })
    }

    /// Adds a frame, as [`GifWriter::add`] does.
    ///
    /// # Errors
    ///
    /// [`ExportErrorKind::Picture`] if this frame cannot be part of the film, which can go on without it; any other if
    /// writing failed and the film cannot go on.
    pub fn add(&mut self, picture: &Picture<'_>) -> Result<(), ExportError> {
        self.writer.add(picture).map_err(|error| failed(&self.path, error))
    }

    /// Adds a frame that was made ready, as [`GifWriter::add_frame`] does.
    ///
    /// # Errors
    ///
    /// Those of [`add`](Self::add).
    pub fn add_frame(&mut self, frame: GifFrame) -> Result<(), ExportError> {
        self.writer.add_frame(frame).map_err(|error| failed(&self.path, error))
    }

    /// Ends the film, and gives the file its name.
    ///
    /// # Errors
    ///
    /// [`ExportError`] if the film has no frame, or if writing fails or failed before: the file is then removed.
    pub fn finish(self) -> Result<Film, ExportError> {
        let (file, film) = self.writer.finish().map_err(|error| failed(&self.path, error))?;
        file.commit()?;
        Ok(film)
    }
}

fn failed(path: &Path, error: GifError) -> ExportError {
    let kind = match error {
        GifError::Picture(error) => ExportErrorKind::Picture(error),
        GifError::NoFrames => ExportErrorKind::NoFrames,
        GifError::Io(error) => ExportErrorKind::from_writing(error),
    };
    ExportError::new(path, kind)
}
