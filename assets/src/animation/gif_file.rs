//! A GIF film as a file that is whole or not there.

use std::path::{Path, PathBuf};

use mode13h::export::{AtomicFile, Picture, Scale};

use super::{AnimationError, Film, FrameRate, GifFrame, GifWriter};

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
    /// [`AnimationError`] if no file can be written there, as [`write_atomically`](mode13h::export::write_atomically) has
    /// it.
    pub fn create(path: impl AsRef<Path>, scale: Scale, rate: FrameRate) -> Result<GifFile, AnimationError> {
        let path = path.as_ref();
        let file = AtomicFile::create(path)?;
        Ok(GifFile { path: path.to_path_buf(), writer: GifWriter::new(file, scale, rate) })
    }

    /// Adds a frame, as [`GifWriter::add`] does.
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::Export`](super::AnimationErrorKind::Export) if writing failed and the film cannot go on; any
    /// other if this frame cannot be part of the film, which can go on without it.
    pub fn add(&mut self, picture: &Picture<'_>) -> Result<(), AnimationError> {
        self.writer.add(picture).map_err(|error| error.in_file(&self.path))
    }

    /// Adds a frame that was made ready, as [`GifWriter::add_frame`] does.
    ///
    /// # Errors
    ///
    /// Those of [`add`](Self::add).
    pub fn add_frame(&mut self, frame: GifFrame) -> Result<(), AnimationError> {
        self.writer.add_frame(frame).map_err(|error| error.in_file(&self.path))
    }

    /// Ends the film, and gives the file its name.
    ///
    /// # Errors
    ///
    /// [`AnimationError`] if the film has no frame, or if writing fails or failed before: the file is then removed.
    pub fn finish(self) -> Result<Film, AnimationError> {
        let (file, film) = self.writer.finish().map_err(|error| error.in_file(&self.path))?;
        file.commit()?;
        Ok(film)
    }
}
