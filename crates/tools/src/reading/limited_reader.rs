// SPDX-License-Identifier: MIT OR Apache-2.0
//! A reader that fails at a limit.

use std::io::{self, Read};

use crate::reading::size_text::size_text;

/// A reader that fails with [`io::ErrorKind::FileTooLarge`] if its source has more bytes than the
/// limit. [`Read::take`] would instead end the document at the limit, as if it were complete.
#[derive(Debug)]
pub struct LimitedReader<R> {
    source: R,
    limit: u64,
    remaining: u64,
}

impl<R: Read> LimitedReader<R> {
    /// Makes a reader of at most `limit` bytes.
    pub fn new(source: R, limit: u64) -> Self {
        Self { source, limit, remaining: limit }
    }
}

impl<R: Read> Read for LimitedReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        if self.remaining == 0 {
            // The source may end exactly at the limit.
            return match self.source.read(&mut [0])? {
                0 => Ok(0),
                _ => Err(self.too_large()),
            };
        }
        let allowed = buffer.len().min(usize::try_from(self.remaining).unwrap_or(usize::MAX));
        let count = self.source.read(&mut buffer[..allowed])?;
        self.remaining -= count as u64;
        Ok(count)
    }
}

impl<R> LimitedReader<R> {
    fn too_large(&self) -> io::Error {
        let message = format!("it is larger than {}, which is the limit", size_text(self.limit));
        io::Error::new(io::ErrorKind::FileTooLarge, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(length: usize, limit: u64) -> io::Result<usize> {
        let source = vec![1; length];
        LimitedReader::new(source.as_slice(), limit).read_to_end(&mut Vec::new())
    }

    #[test]
    fn a_source_beyond_the_limit_is_an_error_and_does_not_end_early() {
        assert_eq!(read(4, 5).unwrap(), 4);
        assert_eq!(read(5, 5).unwrap(), 5);
        assert_eq!(read(6, 5).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
    }
}
