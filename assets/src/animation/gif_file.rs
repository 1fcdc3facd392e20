//! GIF animations as files that are either complete or absent.

use std::path::{Path, PathBuf};

use mode13h::export::{AtomicFile, Picture, Scale};

use super::{AnimationError, Film, FrameRate, GifFrame, GifWriter};

/// A looping GIF animation, written to a file frame by frame, like [`GifWriter`].
///
/// The file is written under a temporary name and renamed when the animation is finished. If it is dropped before that,
/// it is removed, and a previous file is unchanged.
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
/// for t in (0..=256).step_by(8) {
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
    /// Begins an animation without frames so far, in the file `path`.
    ///
    /// # Errors
    ///
    /// [`AnimationError`] if no file can be written there, for the reasons given at
    /// [`write_atomically`](mode13h::export::write_atomically).
    pub fn create(path: impl AsRef<Path>, scale: Scale, rate: FrameRate) -> Result<GifFile, AnimationError> {
        let path = path.as_ref();
        let file = AtomicFile::create(path)?;
        Ok(GifFile { path: path.to_path_buf(), writer: GifWriter::new(file, scale, rate) })
    }

    /// Adds a frame, like [`GifWriter::add`].
    ///
    /// # Errors
    ///
    /// [`AnimationErrorKind::Export`](super::AnimationErrorKind::Export) if writing failed and the animation cannot go
    /// on; any other if this frame cannot be part of the animation, which can go on without it.
    pub fn add(&mut self, picture: &Picture<'_>) -> Result<(), AnimationError> {
        self.writer.add(picture).map_err(|error| error.in_file(&self.path))
    }

    /// Adds a prepared frame, like [`GifWriter::add_frame`].
    ///
    /// # Errors
    ///
    /// Those of [`add`](Self::add).
    pub fn add_frame(&mut self, frame: GifFrame) -> Result<(), AnimationError> {
        self.writer.add_frame(frame).map_err(|error| error.in_file(&self.path))
    }

    /// Ends the animation and renames the file.
    ///
    /// # Errors
    ///
    /// [`AnimationError`] if the animation has no frame, or if writing fails or failed before: the file is then
    /// removed.
    pub fn finish(self) -> Result<Film, AnimationError> {
        let (file, film) = self.writer.finish().map_err(|error| error.in_file(&self.path))?;
        file.commit()?;
        Ok(film)
    }
}
