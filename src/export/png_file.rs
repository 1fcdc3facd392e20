//! PNG files: indexed, with the frame's own bytes and the DAC's palette, or RGB; both with the shape of a pixel.

use std::io::{self, Write};
use std::path::Path;

use png::{BitDepth, ColorType, Encoder, EncodingError, PixelDimensions, Unit};

use super::scale::Scaled;
use super::{ExportError, ExportErrorKind, Picture, PictureError, Scale, write_atomically};
use crate::vga::Vga;

/// Writes the picture that `vga` shows as an indexed PNG of 320 × 200 pixels: the 64,000 bytes unchanged, the DAC's
/// palette in 8-bit colours, and `pHYs` 6:5 (6 pixels across are as long as 5 down), so that viewers that respect it
/// show 4:3. [`Png`] has other sizes and RGB.
///
/// # Errors
///
/// [`ExportError`] if the file cannot be written; a previous file with this name is then unchanged.
///
/// ```
/// use mode13h::{export, vga::Vga};
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("frame.png");
/// let mut vga = Vga::new();
/// vga.pixels_mut()[100 * 320 + 160] = 15;
/// export::png(&vga, &path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn png(vga: &Vga, path: impl AsRef<Path>) -> Result<(), ExportError> {
    let palette = vga.palette();
    Png::default().save(&Picture::mode_13h(vga.pixels(), &palette), path)
}

/// Options for writing a [`Picture`] as a PNG file.
///
/// ```
/// use mode13h::export::{Picture, Png, Scale};
/// use mode13h::vga::Vga;
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("frame.png");
/// let vga = Vga::new();
/// let palette = vga.palette();
/// let picture = Picture::mode_13h(vga.pixels(), &palette);
/// Png { scale: Scale::FiveBySix, rgb: true }.save(&picture, &path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Png {
    /// The enlargement. `pHYs` is the shape of the resulting pixels: 6:5 for a mode 13h frame at [`Scale::One`] and
    /// [`Scale::Double`], 1:1 at [`Scale::FiveBySix`] and 640 × 480.
    pub scale: Scale,
    /// Whether to write colours instead of indices, for programs without palette support.
    pub rgb: bool,
}

impl Png {
    /// Writes a picture.
    ///
    /// # Errors
    ///
    /// [`ExportError`] if the picture's sizes do not fit its bytes, or if the file cannot be written; a previous file
    /// with this name is then unchanged.
    pub fn save(self, picture: &Picture<'_>, path: impl AsRef<Path>) -> Result<(), ExportError> {
        let path = path.as_ref();
        let scaled = Scaled::new(picture, self.scale)
            .map_err(|error| ExportError::new(path, ExportErrorKind::Picture(error)))?;
        write_atomically(path, |out| self.write(picture, &scaled, out))
    }

    /// The bytes of the file that [`save`](Self::save) writes.
    ///
    /// # Errors
    ///
    /// [`PictureError`] if the picture's sizes do not fit its bytes, or if the file does not fit in memory.
    pub fn encode(self, picture: &Picture<'_>) -> Result<Vec<u8>, PictureError> {
        let scaled = Scaled::new(picture, self.scale)?;
        let mut file = InMemory(Vec::new());
        match self.write(picture, &scaled, &mut file) {
            Ok(()) => Ok(file.0),
            // Only for lack of memory: the sizes have been checked.
            Err(_) => Err(PictureError::Memory { bytes: scaled.width as usize * scaled.height as usize }),
        }
    }

    fn write(self, picture: &Picture<'_>, scaled: &Scaled<'_>, out: &mut dyn Write) -> io::Result<()> {
        let mut out = Remembered { out, error: None };
        let result = self.write_into(picture, scaled, &mut out);
        match out.error {
            Some(error) => Err(error),
            None => result,
        }
    }

    fn write_into(self, picture: &Picture<'_>, scaled: &Scaled<'_>, out: &mut dyn Write) -> io::Result<()> {
        let mut encoder = Encoder::new(out, scaled.width, scaled.height);
        encoder.set_depth(BitDepth::Eight);
        if self.rgb {
            encoder.set_color(ColorType::Rgb);
        } else {
            encoder.set_color(ColorType::Indexed);
            encoder.set_palette(picture.palette.iter().flat_map(|c| [c.r, c.g, c.b]).collect::<Vec<u8>>());
        }
        let (xppu, yppu) = scaled.density();
        encoder.set_pixel_dims(Some(PixelDimensions { xppu, yppu, unit: Unit::Unspecified }));
        let mut header = encoder.write_header().map_err(reason)?;
        // Row by row: an enlarged picture may be 4,096 times as large as the frame.
        let mut data = header.stream_writer().map_err(reason)?;
        for row in scaled.rows() {
            if self.rgb {
                let colors = row.iter().map(|&index| picture.palette[usize::from(index)]);
                data.write_all(&colors.flat_map(|c| [c.r, c.g, c.b]).collect::<Vec<u8>>())?;
            } else {
                data.write_all(&row)?;
            }
        }
        data.finish().map_err(reason)?;
        header.finish().map_err(reason)
    }
}

/// A file in memory. Writing to a vector would end the program for lack of it.
struct InMemory(Vec<u8>);

impl Write for InMemory {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.try_reserve(bytes.len())?;
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A writer that stores its first error. For an error within a picture's data the encoder only
/// passes on the text, so a full disk would look like any other error.
struct Remembered<'a> {
    out: &'a mut dyn Write,
    error: Option<io::Error>,
}

impl Remembered<'_> {
    fn keep<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            // An interrupted write is retried, and does not count as an error.
            if kind != io::ErrorKind::Interrupted {
                self.error.get_or_insert(error);
            }
            kind.into()
        })
    }
}

impl Write for Remembered<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.out.write(bytes);
        self.keep(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.out.flush();
        self.keep(result)
    }
}

/// The underlying I/O error. (The encoder's own conversion hides its kind.)
fn reason(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
