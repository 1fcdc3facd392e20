//! Lines and words, of OBJ and MTL alike.

use core::mem;
use std::io::{self, BufRead};

use crate::model_file::ModelFileErrorKind;
use crate::model_file::word::parsed;

/// Lines, with those joined that end in a backslash. LF, CR LF and CR end a line. One buffer serves them all.
pub(crate) struct Lines<R> {
    reader: R,
    buffer: Vec<u8>,
    /// The number of the line that was read last, from 1. Joined lines have the number of the first.
    number: u64,
    /// Lines read so far.
    read: u64,
    /// The last line ended in CR: an LF that follows belongs to it.
    after_cr: bool,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self { reader, buffer: Vec::new(), number: 0, read: 0, after_cr: false }
    }

    /// The next line's number and its text without the end-of-line; `None` at the end.
    pub(crate) fn next(&mut self) -> io::Result<Option<(u64, &[u8])>> {
        self.buffer.clear();
        self.number = self.read + 1;
        // Where the first word begins, as far as lines were joined: what stands before it is looked at once, or a
        // file of nothing but backslashes would take time by the square of its length.
        let mut first_word = 0;
        loop {
            if !self.append_line()? {
                // A backslash may stand at the very end.
                return Ok((self.read >= self.number).then_some((self.number, &self.buffer)));
            }
            if self.read == 1 && self.buffer.starts_with(b"\xEF\xBB\xBF") {
                self.buffer.drain(..3);
            }
            first_word += self.buffer[first_word..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            // A path at the end of a comment joins nothing.
            if !self.buffer.ends_with(b"\\") || self.buffer[first_word] == b'#' {
                return Ok(Some((self.number, &self.buffer)));
            }
            self.buffer.pop();
            self.buffer.push(b' ');
        }
    }

    /// Appends a line of the file to the buffer, without its end. Returns `false` if there is none.
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

/// The first word and the rest.
pub(crate) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii_start();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    line.split_at(end)
}

/// The next word as a finite number, or `None` at the end of the line.
pub(crate) fn number<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<Option<f32>, ModelFileErrorKind> {
    let Some(word) = words.next() else { return Ok(None) };
    parsed(word, f32::is_finite)
}

/// Reads the `N` numbers that the statement needs in f64; all are within the range of f32.
pub(crate) fn wide_numbers<'a, const N: usize>(
    words: &mut impl Iterator<Item = &'a [u8]>,
    what: &'static str,
) -> Result<[f64; N], ModelFileErrorKind> {
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words.next().ok_or(ModelFileErrorKind::Missing(what))?;
        *value = parsed(word, |value: f64| (value as f32).is_finite())?.ok_or(ModelFileErrorKind::Missing(what))?;
    }
    Ok(values)
}

/// Reads the `N` numbers that the statement needs.
pub(crate) fn numbers<'a, const N: usize>(
    words: &mut impl Iterator<Item = &'a [u8]>,
    what: &'static str,
) -> Result<[f32; N], ModelFileErrorKind> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = number(words)?.ok_or(ModelFileErrorKind::Missing(what))?;
    }
    Ok(values)
}
