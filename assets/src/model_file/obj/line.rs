//! Lines and words of OBJ and MTL files.

use core::mem;
use std::io::{self, BufRead};
use std::str::FromStr;

use crate::model_file::ModelFileErrorKind;
use crate::model_file::word::parsed;

/// The maximum length of a line in bytes, after joining: a device or a small packed file may have no line ending.
const LONGEST: usize = 1 << 26;

/// A line reader that joins lines ending in a backslash, with or without spaces after it. LF, CR LF and CR end a line. A
/// single buffer is reused.
pub(crate) struct Lines<R> {
    reader: R,
    buffer: Vec<u8>,
    /// The number of the last line read, from 1. Joined lines have the number of the first.
    number: u64,
    /// The number of lines read so far.
    read: u64,
    /// True if the last line ended in CR, so that a following LF belongs to it.
    after_cr: bool,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self { reader, buffer: Vec::new(), number: 0, read: 0, after_cr: false }
    }

    /// The next line's number and its text without the line ending; `None` at the end.
    pub(crate) fn next(&mut self) -> io::Result<Option<(u64, &[u8])>> {
        self.buffer.clear();
        self.number = self.read + 1;
        // The start of the first word in the joined line: the blanks before it are scanned once, otherwise a file of
        // nothing but backslashes would take quadratic time.
        let mut first_word = 0;
        loop {
            if !self.append_line()? {
                // The file may end in a backslash.
                return Ok((self.read >= self.number).then_some((self.number, &self.buffer)));
            }
            if self.read == 1 && self.buffer.starts_with(b"\xEF\xBB\xBF") {
                self.buffer.drain(..3);
            }
            first_word += self.buffer[first_word..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            // There may be spaces after the backslash. A comment that ends in a path with one joins nothing.
            let length = self.buffer.trim_ascii_end().len();
            if length == 0 || self.buffer[length - 1] != b'\\' || self.buffer[first_word] == b'#' {
                return Ok(Some((self.number, &self.buffer)));
            }
            self.buffer.truncate(length - 1);
            self.buffer.push(b' ');
        }
    }

    /// Appends a line of the file to the buffer, without its line ending. Returns `false` if there is none.
    fn append_line(&mut self) -> io::Result<bool> {
        let mut begun = false;
        loop {
            let available = match self.reader.fill_buf() {
                Ok(available) => available,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            let Some(&first) = available.first() else {
                self.read += u64::from(begun);
                return Ok(begun);
            };
            if mem::take(&mut self.after_cr) && first == b'\n' {
                self.reader.consume(1);
                continue;
            }
            begun = true;
            let end = available.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let text = &available[..end.unwrap_or(available.len())];
            if self.buffer.len() + text.len() > LONGEST {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "a line of more than 64 MiB"));
            }
            self.buffer.try_reserve(text.len())?;
            self.buffer.extend_from_slice(text);
            let used = text.len() + usize::from(end.is_some());
            if let Some(end) = end {
                self.after_cr = available[end] == b'\r';
                self.reader.consume(used);
                self.read += 1;
                return Ok(true);
            }
            self.reader.consume(used);
        }
    }
}

/// Splits a line into its first word and the rest.
pub(crate) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii_start();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    line.split_at(end)
}

/// The next word as a finite number, or `None` at the end of the line.
pub(crate) fn number<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<Option<f32>, ModelFileErrorKind> {
    words.next().map(|word| parsed(word, f32::is_finite)).transpose()
}

/// Reads the `N` numbers that the statement needs, all finite.
pub(crate) fn numbers<'a, T: FromStr + Copy + Default, const N: usize>(
    words: &mut impl Iterator<Item = &'a [u8]>,
    is_finite: fn(T) -> bool,
    what: &'static str,
) -> Result<[T; N], ModelFileErrorKind> {
    let mut values = [T::default(); N];
    for value in &mut values {
        *value = parsed(words.next().ok_or(ModelFileErrorKind::Missing(what))?, is_finite)?;
    }
    Ok(values)
}
