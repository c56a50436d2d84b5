// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file, plain or gzipped, with a header that is known only at the end, such as a count.
//!
//! In a gzipped file the header is a stored block of its own before the compressed data, so that it
//! can be written in place at the end. The checksum is combined from both parts. The bytes contain
//! no time and no name.

use super::npz::{DeflatePacker, STORED_BLOCK_HEADER_BYTES, stored_block};
use crate::SimulatorError;
use flate2::Compression;
use foveate_tools::GrowingFile;
use std::path::Path;

/// The gzip header: magic number, deflate, no flags, no time, no level, no system.
const GZIP_HEADER: [u8; 10] = [0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0xFF];

/// The open file, with `HEADER` bytes reserved at its start.
pub(super) struct HeadedFile<const HEADER: usize> {
    file: GrowingFile,
    packer: Option<DeflatePacker>,
}

impl<const HEADER: usize> HeadedFile<HEADER> {
    /// Creates a file that does not exist yet.
    pub(super) fn create(path: &Path, packed: bool) -> Result<Self, SimulatorError> {
        let mut file = GrowingFile::create_new(path)?;
        if packed {
            file.append(&GZIP_HEADER);
            file.append(&stored_block(&[0; HEADER]));
        } else {
            file.append(&[0; HEADER]);
        }
        Ok(Self { file, packer: packed.then(|| DeflatePacker::new(Compression::default())) })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) {
        match &mut self.packer {
            None => self.file.append(bytes),
            Some(packer) => packer.write(bytes, self.file.pending_mut()),
        }
    }

    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending()?)
    }

    /// Completes the file with its header.
    pub(super) fn finish(mut self, header: &[u8; HEADER]) -> Result<(), SimulatorError> {
        let Some(packer) = self.packer else {
            return Ok(self.file.overwrite(0, header)?);
        };
        let (last, checksum, length) = packer.finish(header);
        self.file.append(&last);
        self.file.append(&checksum.to_le_bytes());
        self.file.append(&low_32_bits(length).to_le_bytes());
        Ok(self.file.overwrite((GZIP_HEADER.len() + STORED_BLOCK_HEADER_BYTES) as u64, header)?)
    }
}

/// Returns a length modulo 2^32, as gzip stores it.
fn low_32_bits(length: u64) -> u32 {
    let [a, b, c, d, ..] = length.to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn the_header_comes_last_and_gzip_reads_it() {
        let dir = tempfile::tempdir().unwrap();
        for (name, packed) in [("plain", false), ("packed", true)] {
            let path = dir.path().join(name);
            let mut file = HeadedFile::<4>::create(&path, packed).unwrap();
            let body: Vec<u8> = (0..7).cycle().take(200_000).collect();
            body.chunks(999).for_each(|chunk| file.write(chunk));
            file.finish(b"head").unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let mut unpacked = Vec::new();
            if packed {
                assert!(bytes.len() < 10_000);
                // The file has one gzip member, with checksum and length.
                flate2::read::GzDecoder::new(&bytes[..]).read_to_end(&mut unpacked).unwrap();
            } else {
                unpacked = bytes;
            }
            assert_eq!(unpacked, [&b"head"[..], &body].concat());
            assert!(HeadedFile::<4>::create(&path, packed).is_err(), "nothing is written over");
        }
    }
}
