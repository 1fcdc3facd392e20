//! The numbers of a PLY file, text or binary, all as f64.

use super::header::{Element, Encoding, Header, Kind, Number};
use crate::model_file::tokens::{Tokens, expected};
use crate::model_file::word::parsed;
use crate::model_file::{ModelFileErrorKind, Place};

/// The numbers after a header, in order.
pub(super) struct Values<'b> {
    source: Source<'b>,
}

enum Source<'b> {
    Text(Tokens<'b>),
    Binary {
        bytes: &'b [u8],
        at: usize,
        /// The offset of the last number read.
        last: usize,
        is_big_endian: bool,
    },
}

impl<'b> Values<'b> {
    pub(super) fn new(header: &Header, bytes: &'b [u8]) -> Self {
        let (at, is_big_endian) = (header.length, header.encoding == Encoding::BigEndian);
        let source = match header.encoding {
            Encoding::Text => Source::Text(Tokens::new(&bytes[at..], header.lines + 1)),
            _ => Source::Binary { bytes, at, last: at, is_big_endian },
        };
        Self { source }
    }

    /// The position of the last number read.
    pub(super) fn place(&self) -> Place {
        match &self.source {
            Source::Text(words) => Place::Line(words.word_line),
            Source::Binary { last, .. } => Place::Offset(*last as u64),
        }
    }

    /// The position of the next number; in a text file, the line of the one before it or a later one.
    pub(super) fn place_of_next(&mut self) -> Place {
        match &mut self.source {
            Source::Text(words) => Place::Line(words.line_of_next()),
            Source::Binary { at, .. } => Place::Offset(*at as u64),
        }
    }

    fn number(&mut self, number: Number) -> Result<f64, ModelFileErrorKind> {
        match &mut self.source {
            Source::Text(words) => {
                let word = words.next().ok_or(ModelFileErrorKind::Ends("a number"))?;
                // Any type is accepted, since some programs write 255.0 for a colour declared as `uchar`. Infinities
                // and NaN are left to the code that uses the number.
                parsed(word, |_: f64| true)
            }
            Source::Binary { bytes, at, last, is_big_endian } => {
                *last = *at;
                fn take<const N: usize>(bytes: &[u8], at: &mut usize, is_big: bool) -> Option<[u8; N]> {
                    let mut own: [u8; N] = *bytes[*at..].first_chunk()?;
                    *at += N;
                    if is_big {
                        own.reverse();
                    }
                    Some(own)
                }
                let is_big = *is_big_endian;
                let value = match number {
                    Number::I8 => take(bytes, at, is_big).map(|own| i8::from_le_bytes(own).into()),
                    Number::U8 => take(bytes, at, is_big).map(|own| u8::from_le_bytes(own).into()),
                    Number::I16 => take(bytes, at, is_big).map(|own| i16::from_le_bytes(own).into()),
                    Number::U16 => take(bytes, at, is_big).map(|own| u16::from_le_bytes(own).into()),
                    Number::I32 => take(bytes, at, is_big).map(|own| i32::from_le_bytes(own).into()),
                    Number::U32 => take(bytes, at, is_big).map(|own| u32::from_le_bytes(own).into()),
                    Number::F32 => take(bytes, at, is_big).map(|own| f32::from_le_bytes(own).into()),
                    Number::F64 => take(bytes, at, is_big).map(f64::from_le_bytes),
                };
                value.ok_or(ModelFileErrorKind::Ends("a number"))
            }
        }
    }

    /// Reads a row. `row` gets a number for each property, 0 for a list, whose items are passed to `item` with the
    /// property's index.
    pub(super) fn row(
        &mut self,
        element: &Element,
        row: &mut Vec<f64>,
        mut item: impl FnMut(usize, f64) -> Result<(), ModelFileErrorKind>,
    ) -> Result<(), ModelFileErrorKind> {
        row.clear();
        for (i, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(number) => row.push(self.number(number)?),
                Kind::List { count, item: number } => {
                    let count = self.number(count)?;
                    if !(count >= 0.0 && count.fract() == 0.0 && count <= f64::from(u32::MAX)) {
                        return Err(expected("the length of a list", count.to_string().as_bytes()));
                    }
                    for _ in 0..count as u64 {
                        item(i, self.number(number)?)?;
                    }
                    row.push(0.0);
                }
            }
        }
        Ok(())
    }

    /// Skips a row.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), ModelFileErrorKind> {
        self.row(element, &mut Vec::new(), |_, _| Ok(()))
    }
}
