//! The progress of reading a file.

use std::io::{self, Read};

/// A reader that reports how many bytes it has read.
pub(super) struct Counted<R, P> {
    reader: R,
    read: u64,
    total: u64,
    progress: P,
}

impl<R: Read, P: FnMut(u64, u64)> Counted<R, P> {
    pub(super) fn new(reader: R, total: u64, progress: P) -> Self {
        Self { reader, read: 0, total, progress }
    }
}

impl<R: Read, P: FnMut(u64, u64)> Read for Counted<R, P> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = self.reader.read(buffer)?;
        // A length always fits into 64 bits.
        self.read += bytes as u64;
        (self.progress)(self.read, self.total);
        Ok(bytes)
    }
}
