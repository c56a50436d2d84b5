// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file that starts with what is known last, such as a count; plain or gzipped.
//!
//! Gzipped, the header is a stored block of its own before the compressed rest, so that it can be
//! written in place at the end; the checksum is combined from both. The bytes hold no time or name.

use std::fs::OpenOptions;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;
use flate2::Compression;
use flate2::write::DeflateEncoder;

use super::cannot_write;
use crate::SimulatorError;

/// Magic, deflate, no flags, no time, no level, no system.
const GZIP: [u8; 10] = [0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0xFF];

/// The file, open; `HEADER` bytes are reserved.
pub(super) struct HeadedFile<const HEADER: usize> {
    path: PathBuf,
    body: Body,
}

enum Body {
    Plain(BufWriter<std::fs::File>),
    Packed {
        encoder: DeflateEncoder<BufWriter<std::fs::File>>,
        checksum: Hasher,
        /// Modulo 2^32, as gzip has it.
        length: u32,
    },
}

impl<const HEADER: usize> HeadedFile<HEADER> {
    /// Creates a file that is not there yet.
    pub(super) fn create(path: &Path, packed: bool) -> Result<Self, SimulatorError> {
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let file = BufWriter::new(file.map_err(cannot_write(path))?);
        let body = if packed { Body::packed::<HEADER>(file) } else { Body::plain::<HEADER>(file) };
        Ok(Self { path: path.to_owned(), body: body.map_err(cannot_write(path))? })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), SimulatorError> {
        let written = match &mut self.body {
            Body::Plain(file) => file.write_all(bytes),
            Body::Packed { encoder, checksum, length } => {
                checksum.update(bytes);
                *length = length.wrapping_add(low_word(bytes.len()));
                encoder.write_all(bytes)
            }
        };
        written.map_err(cannot_write(&self.path))
    }

    /// Completes the file with its header.
    pub(super) fn finish(self, header: &[u8; HEADER]) -> Result<(), SimulatorError> {
        self.body.finish(header).map_err(cannot_write(&self.path))
    }
}

impl Body {
    fn plain<const HEADER: usize>(mut file: BufWriter<std::fs::File>) -> io::Result<Self> {
        file.write_all(&[0; HEADER])?;
        Ok(Self::Plain(file))
    }

    fn packed<const HEADER: usize>(mut file: BufWriter<std::fs::File>) -> io::Result<Self> {
        // A header has a few bytes; a stored block takes 65,535.
        let length = u16::try_from(HEADER).unwrap_or(u16::MAX);
        file.write_all(&GZIP)?;
        file.write_all(&[0])?;
        file.write_all(&length.to_le_bytes())?;
        file.write_all(&(!length).to_le_bytes())?;
        file.write_all(&[0; HEADER])?;
        let encoder = DeflateEncoder::new(file, Compression::default());
        Ok(Self::Packed { encoder, checksum: Hasher::new(), length: 0 })
    }

    fn finish(self, header: &[u8]) -> io::Result<()> {
        let (mut file, start) = match self {
            Self::Plain(file) => (file, 0),
            Self::Packed { encoder, checksum, length } => {
                let mut file = encoder.finish()?;
                let mut whole = Hasher::new();
                whole.update(header);
                whole.combine(&checksum);
                file.write_all(&whole.finalize().to_le_bytes())?;
                file.write_all(&length.wrapping_add(low_word(header.len())).to_le_bytes())?;
                (file, GZIP.len() as u64 + 5)
            }
        };
        file.seek(SeekFrom::Start(start))?;
        file.write_all(header)?;
        file.flush()
    }
}

/// A length modulo 2^32.
fn low_word(length: usize) -> u32 {
    let [a, b, c, d, ..] = (length as u64).to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn the_header_comes_last_and_gzip_reads_it() {
        let dir = tempfile::tempdir().unwrap();
        for (name, packed) in [("plain", false), ("packed", true)] {
            let path = dir.path().join(name);
            let mut file = HeadedFile::<4>::create(&path, packed).unwrap();
            let body: Vec<u8> = (0..7).cycle().take(200_000).collect();
            body.chunks(999).for_each(|chunk| file.write(chunk).unwrap());
            file.finish(b"head").unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let mut seen = Vec::new();
            if packed {
                assert!(bytes.len() < 10_000);
                // One member, with checksum and length.
                flate2::read::GzDecoder::new(&bytes[..]).read_to_end(&mut seen).unwrap();
            } else {
                seen = bytes;
            }
            assert_eq!(seen, [&b"head"[..], &body].concat());
            assert!(HeadedFile::<4>::create(&path, packed).is_err(), "nothing is written over");
        }
    }
}
