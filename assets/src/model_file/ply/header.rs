//! The header of a PLY file.

use std::path::Path;

use crate::model_file::tokens::expected;
use crate::model_file::word::{name, without_mark, words};
use crate::model_file::{ModelFileError, ModelFileErrorKind};

/// How numbers are encoded.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn of_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// The number that represents a colour channel's full intensity.
    pub(super) fn full(self) -> f64 {
        match self {
            Self::I8 => i8::MAX.into(),
            Self::U8 => u8::MAX.into(),
            Self::I16 => i16::MAX.into(),
            Self::U16 => u16::MAX.into(),
            // Some programs' text files declare colours from 0 to 255 as `int`.
            Self::I32 | Self::U32 => 255.0,
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

/// The type of a property.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Scalar(Number),
    List { count: Number, item: Number },
}

/// A property of an element.
pub(super) struct Property {
    name: String,
    pub(super) kind: Kind,
}

/// An element: a table of `count` rows, with a column for each property.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The first property with one of these names, if it is a single number.
    pub(super) fn scalar(&self, names: &[&str]) -> Option<usize> {
        self.find(names).filter(|&property| matches!(self.properties[property].kind, Kind::Scalar(_)))
    }

    /// The first property with one of these names, if it is a list.
    pub(super) fn list(&self, names: &[&str]) -> Option<usize> {
        self.find(names).filter(|&property| matches!(self.properties[property].kind, Kind::List { .. }))
    }

    fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|property| names.contains(&property.name.as_str()))
    }
}

/// The header.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The line and name of each texture in a comment.
    pub(super) textures: Vec<(u64, String)>,
    /// The number of bytes before the first row.
    pub(super) length: usize,
    /// The number of lines before the first row.
    pub(super) lines: u64,
}

/// The maximum number of elements, and of properties per element, so that no property list takes for ever.
const MAX: usize = 1_000;

impl Header {
    /// Reads the header, including `end_header`.
    pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Self, ModelFileError> {
        let mut lines = HeaderLines { bytes, at: bytes.len() - without_mark(bytes).len(), number: 0 };
        let mut elements: Vec<Element> = Vec::new();
        let (mut encoding, mut textures) = (None, Vec::new());
        let mut is_first = true;
        loop {
            let line = lines.next();
            let number = lines.number;
            let at = |kind| ModelFileError::of_line(path, number.max(1), kind);
            let Some(line) = line else { return Err(at(ModelFileErrorKind::Ends("end_header"))) };
            let mut rest = words(line);
            let word = rest.next().unwrap_or_default();
            if core::mem::take(&mut is_first) {
                match word {
                    b"ply" => continue,
                    word => return Err(at(expected("ply", word))),
                }
            }
            match word {
                b"format" => {
                    encoding = Some(match rest.next().unwrap_or_default() {
                        b"ascii" => Encoding::Text,
                        b"binary_little_endian" => Encoding::LittleEndian,
                        b"binary_big_endian" => Encoding::BigEndian,
                        word => return Err(at(expected("ascii, binary_little_endian or binary_big_endian", word))),
                    });
                }
                b"comment" => {
                    let text = line.trim_ascii_start()[word.len()..].trim_ascii_start();
                    let file = text.strip_prefix(b"TextureFile").map(name);
                    textures.extend(file.filter(|file| !file.is_empty()).map(|file| (number, file)));
                }
                b"element" => {
                    let element = rest.next().unwrap_or_default();
                    let count = rest.next().unwrap_or_default();
                    let Some(count) = str::from_utf8(count).ok().and_then(|count| count.parse().ok()) else {
                        return Err(at(expected("a row count", count)));
                    };
                    elements.push(Element { name: name(element), count, properties: Vec::new() });
                }
                b"property" => {
                    let Some(element) = elements.last_mut() else {
                        return Err(at(ModelFileErrorKind::Fault("a property before any element".into())));
                    };
                    element.properties.push(property(&mut rest).map_err(at)?);
                }
                b"end_header" => break,
                b"" | b"obj_info" => {}
                word => return Err(at(expected("element, property, comment or end_header", word))),
            }
            if elements.len() > MAX || elements.last().is_some_and(|element| element.properties.len() > MAX) {
                return Err(at(ModelFileErrorKind::TooLarge("more than 1,000 elements or properties")));
            }
        }
        let Some(encoding) = encoding else {
            return Err(ModelFileError::of_line(path, lines.number, ModelFileErrorKind::Ends("a line `format`")));
        };
        if encoding == Encoding::Text && bytes[..lines.at].ends_with(b"\r") && bytes[lines.at..].starts_with(b"\n") {
            lines.at += 1;
        }
        Ok(Self { encoding, elements, textures, length: lines.at, lines: lines.number })
    }
}

fn property<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<Property, ModelFileErrorKind> {
    let number = |word: &[u8]| Number::of_name(word).ok_or_else(|| expected("a number type", word));
    let kind = match words.next().unwrap_or_default() {
        b"list" => Kind::List {
            count: number(words.next().unwrap_or_default())?,
            item: number(words.next().unwrap_or_default())?,
        },
        word => Kind::Scalar(number(word)?),
    };
    Ok(Property { name: name(words.next().unwrap_or_default()), kind })
}

/// The lines of a header, which may be followed by arbitrary bytes: a CR only ends a line together with the LF after it
/// if the first line ends like that.
struct HeaderLines<'b> {
    bytes: &'b [u8],
    at: usize,
    /// The number of the last line read, counted from 1.
    number: u64,
}

impl<'b> HeaderLines<'b> {
    fn next(&mut self) -> Option<&'b [u8]> {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'))?;
        let first = self.bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(0);
        let is_pair = self.bytes[first..].starts_with(b"\r\n") && rest[end..].starts_with(b"\r\n");
        // Where only some lines end in CR LF, an LF after a CR does not count as a line.
        let is_second = end == 0 && rest[0] == b'\n' && self.bytes[..self.at].ends_with(b"\r");
        self.at += end + 1 + usize::from(is_pair);
        self.number += u64::from(!is_second);
        Some(&rest[..end])
    }
}
