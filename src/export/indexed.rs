//! Indexed PNG: colour type 3, the frame's own bytes, the DAC's palette, the pixel's shape.

use std::io::{self, Write};
use std::path::Path;

use png::{BitDepth, ColorType, Encoder, EncodingError, PixelDimensions, Unit};

use super::scale::Scaled;
use super::{ExportError, ExportErrorKind, Picture, PictureError, Scale, write_atomically};
use crate::vga::Vga;

/// Writes what `vga` shows as an indexed PNG of 320 × 200 pixels: the 64,000 bytes as they are, the DAC's palette in
/// 8-bit colours, and `pHYs` 6:5 (6 pixels across are as long as 5 down), so that viewers which heed it show 4:3.
///
/// # Errors
///
/// [`ExportError`] if the file cannot be written; what stood there before is then whole.
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
    picture_png(&Picture::mode_13h(vga.pixels(), &palette), Scale::One, path)
}

/// Writes any picture as an indexed PNG, enlarged by `scale`. Its `pHYs` says the shape that the pixels then have: 6:5
/// for a mode 13h frame at [`Scale::One`] and [`Scale::Double`], 1:1 at [`Scale::FiveBySix`] and 640 × 480.
///
/// # Errors
///
/// [`ExportError`] if the picture's sizes do not fit its bytes, or if the file cannot be written.
pub fn picture_png(picture: &Picture<'_>, scale: Scale, path: impl AsRef<Path>) -> Result<(), ExportError> {
    let path = path.as_ref();
    let scaled =
        Scaled::new(picture, scale).map_err(|error| ExportError::new(path, ExportErrorKind::Picture(error)))?;
    write_atomically(path, |out| encode(picture, &scaled, out))
}

/// The bytes of the file that [`picture_png`] writes.
///
/// # Errors
///
/// [`PictureError`] if the picture's sizes do not fit its bytes.
pub fn encode_png(picture: &Picture<'_>, scale: Scale) -> Result<Vec<u8>, PictureError> {
    let scaled = Scaled::new(picture, scale)?;
    let mut file = Vec::new();
    match encode(picture, &scaled, &mut file) {
        Ok(()) => Ok(file),
        // A vector takes whatever is written to it, and the sizes have been checked; memory alone can run out.
        Err(_) => Err(PictureError::Memory { bytes: scaled.width as usize * scaled.height as usize }),
    }
}

fn encode(picture: &Picture<'_>, scaled: &Scaled<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut out = Remembered { out, error: None };
    let result = encode_into(picture, scaled, &mut out);
    match out.error {
        Some(error) => Err(error),
        None => result,
    }
}

/// A writer that keeps its first error: of those that arise amid a picture's data the encoder passes on the words alone,
/// and a full disk would be an error like any other.
struct Remembered<'a> {
    out: &'a mut dyn Write,
    error: Option<io::Error>,
}

impl Remembered<'_> {
    fn keep<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            // One that is to be tried again is no failure.
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

fn encode_into(picture: &Picture<'_>, scaled: &Scaled<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut encoder = Encoder::new(out, scaled.width, scaled.height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(picture.palette.iter().flat_map(|c| [c.r, c.g, c.b]).collect::<Vec<u8>>());
    let (xppu, yppu) = scaled.density();
    encoder.set_pixel_dims(Some(PixelDimensions { xppu, yppu, unit: Unit::Unspecified }));
    let mut header = encoder.write_header().map_err(reason)?;
    // Row by row: an enlarged picture may be 4,096 times as large as the frame.
    let mut data = header.stream_writer().map_err(reason)?;
    for row in scaled.rows() {
        data.write_all(&row)?;
    }
    data.finish().map_err(reason)?;
    header.finish().map_err(reason)
}

/// What the disk said. (The encoder's own conversion hides the kind of an error.)
fn reason(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
