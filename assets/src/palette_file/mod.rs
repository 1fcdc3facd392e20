//! Reading and writing palette files, in the formats listed in [`FORMATS`].
//!
//! | format | extension | what |
//! |---|---|---|
//! | `jasc` | `.pal` | Paint Shop Pro: text, `JASC-PAL`, `0100`, the number of colours, then one per line |
//! | `gimp` | `.gpl` | GIMP, Inkscape, Krita, Aseprite: text, `GIMP Palette`, then one per line with a name |
//! | `hex` | `.hex` | Lospec: text, `rrggbb`, one per line |
//! | `act` | `.act` | Adobe: 768 bytes, red, green, blue, 8 bits |
//! | `act-772` | `.act` | the same with 4 more bytes: the number of colours in use, and the transparent one |
//! | `vga` | `.vga` | 768 bytes, red, green, blue, as the DAC takes them: 6 bits |
//!
//! Also read as `vga` are `.raw`, `.col` (Autodesk Animator), `.lmp` (Quake) and a `.pal` of 768 bytes that does not
//! begin like JASC. A raw file with a value over 63 has 8 bits.
//!
//! Text lines may end in LF, CR LF or CR, and a file may begin with a UTF-8 byte order mark; empty lines among the
//! colours are skipped. Fewer than 256 colours are allowed if the format can express that; the other entries are black.
//! More are an error. Palette files do not store ramps: [`Palette::from_colors`] finds them.
//!
//! ```
//! use mode13h_assets::palette_file;
//! let palette = palette_file::parse_named("two.hex", b"000000\r\nff8000\r\n")?;
//! assert_eq!(palette[1], 0xFF8000.into());
//!
//! let error = palette_file::parse(b"JASC-PAL\n0100\n2\n0 0 0\nred 0 0\n").unwrap_err();
//! assert_eq!(error.to_string(), "line 5: expected three numbers 0 to 255, found \"red 0 0\"");
//! # Ok::<(), palette_file::PaletteError>(())
//! ```

mod adobe;
mod colors;
mod error;
mod gimp;
mod hex;
mod jasc;
mod load;
mod text;
mod vga;

pub use error::Excerpt;
pub use error::{PaletteError, PaletteErrorKind, Place};
pub(crate) use load::{LONGEST_PICTURE, of_bytes};
pub use load::{LoadError, LoadErrorKind, load};

use mode13h::palette::Palette;

/// A file format: one row of [`FORMATS`].
#[derive(Debug)]
#[non_exhaustive]
pub struct Format {
    /// The name, as used on the command line.
    pub name: &'static str,
    /// The programs that use it, for display.
    pub description: &'static str,
    /// The extensions, in lower case without a dot; the first is the usual one.
    pub extensions: &'static [&'static str],
    /// Returns whether bytes look like a file of this format.
    recognizes: fn(&[u8]) -> bool,
    read: Read,
    write: Write,
}

/// All formats, the most reliably recognised first. Bytes belong to the first that recognises them, an extension to the
/// first that lists it.
pub static FORMATS: [Format; 6] = [
    format("jasc", "JASC (Paint Shop Pro)", &["pal"], jasc::recognizes, jasc::read, jasc::write),
    format("gimp", "GIMP", &["gpl"], gimp::recognizes, gimp::read, gimp::write),
    format("hex", "Lospec", &["hex"], hex::recognizes, hex::read, hex::write),
    format("vga", "raw VGA", &["vga", "raw", "col", "lmp"], vga::recognizes, vga::read, vga::write),
    // Its bytes look like those of a raw VGA file: only the name can distinguish them.
    format("act", "Adobe color table", &["act"], |_| false, adobe::read, adobe::write),
    format("act-772", ACT_772, &["act"], adobe::recognizes_772, adobe::read, adobe::write_772),
];

const ACT_772: &str = "Adobe color table with its number of colours";

type Read = fn(&[u8]) -> Result<Palette, PaletteError>;
type Write = fn(&Palette, &str, &mut Vec<u8>);

const fn format(
    name: &'static str,
    description: &'static str,
    extensions: &'static [&'static str],
    recognizes: fn(&[u8]) -> bool,
    read: Read,
    write: Write,
) -> Format {
    Format { name, description, extensions, recognizes, read, write }
}

impl Format {
    /// The format with this name in [`FORMATS`].
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.name == name)
    }

    /// The format for an extension, given without its dot, in upper or lower case.
    #[must_use]
    pub fn by_extension(extension: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.extensions.iter().any(|own| own.eq_ignore_ascii_case(extension)))
    }

    /// The format for a file name, by its extension, for writing such a file.
    #[must_use]
    pub fn of_file_name(name: &str) -> Option<&'static Self> {
        let (_, extension) = name.rsplit_once('.')?;
        Self::by_extension(extension)
    }

    /// The format that bytes look like.
    ///
    /// An 8-bit `.act` of 768 bytes looks like a raw VGA file, and gives the same colours when read as one, unless it
    /// has no value over 63.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| (format.recognizes)(bytes))
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// A `PaletteError` with the line or the offset.
    pub fn read(&self, bytes: &[u8]) -> Result<Palette, PaletteError> {
        if bytes.is_empty() {
            return Err(PaletteError::at_offset(0, PaletteErrorKind::Empty));
        }
        (self.read)(bytes)
    }

    /// Writes a file of this format with all 256 entries. Reading it returns the same colours, except for a `vga` file
    /// with colours below 64 that the DAC does not have, as described below.
    ///
    /// `name` is the palette's name, which `gimp` files contain; control characters become spaces.
    ///
    /// A `vga` file is written in 6 bits if that preserves every colour. Otherwise, if some value is over 63, it is
    /// written in 8 bits. If no value is over 63, 8 bits would be mistaken for 6 on reading; such a palette is rounded
    /// down to 6 bits, as the card would do.
    #[must_use]
    pub fn write(&self, palette: &Palette, name: &str) -> Vec<u8> {
        let mut out = Vec::new();
        (self.write)(palette, name, &mut out);
        out
    }
}

/// Reads a palette file without a name, by its contents ([`Format::of_bytes`]).
///
/// # Errors
/// [`PaletteErrorKind::UnknownFormat`] if it looks like none of [`FORMATS`], otherwise those of [`Format::read`].
pub fn parse(bytes: &[u8]) -> Result<Palette, PaletteError> {
    match Format::of_bytes(bytes) {
        Some(format) => format.read(bytes),
        None if bytes.is_empty() => Err(PaletteError::at_offset(0, PaletteErrorKind::Empty)),
        None => Err(PaletteError::at_offset(0, PaletteErrorKind::UnknownFormat)),
    }
}

/// Reads a palette file in the format of its name's extension. Without a known extension [`parse`] decides, and also
/// for `.pal`, which JASC and raw files share, if the bytes look like a raw file.
///
/// # Errors
/// Those of [`Format::read`]. The message does not include the name, which the caller has.
pub fn parse_named(name: &str, bytes: &[u8]) -> Result<Palette, PaletteError> {
    match Format::of_file_name(name) {
        Some(format) if format.name != "jasc" || !vga::recognizes(bytes) => format.read(bytes),
        _ => parse(bytes),
    }
}
