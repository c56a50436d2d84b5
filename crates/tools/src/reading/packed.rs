// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files that may be gzipped.

use std::io::{self, BufRead, BufReader, Read};

use flate2::bufread::MultiGzDecoder;

/// The first bytes of a gzipped file.
pub const GZIP_MAGIC: [u8; 2] = [0x1F, 0x8B];

/// Returns the content of a file, unpacked if it is gzipped. The content may be much larger than the
/// file, so the caller limits it.
///
/// # Errors
/// Fails if the first bytes cannot be read.
pub fn unpacked(input: impl Read + Send + 'static) -> io::Result<Box<dyn BufRead + Send>> {
    let mut input = BufReader::new(input);
    if input.fill_buf()?.starts_with(&GZIP_MAGIC) {
        return Ok(Box::new(BufReader::new(MultiGzDecoder::new(input))));
    }
    Ok(Box::new(input))
}
