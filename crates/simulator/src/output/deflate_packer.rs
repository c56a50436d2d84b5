// SPDX-License-Identifier: MIT OR Apache-2.0
//! Deflate for files whose first bytes are known only at the end. These bytes are a stored block of
//! their own before the compressed data, which can be overwritten at the end.

use std::io::Write as _;

use crc32fast::Hasher;
use flate2::Compression;
use flate2::write::DeflateEncoder;

/// The number of bytes before the content of a stored block: its kind, and its length twice.
pub(super) const STORED_BLOCK_HEADER_BYTES: usize = 5;

/// Returns the stored block of at most 65,535 bytes.
pub(super) fn stored_block(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).expect("a header has a few bytes");
    [&[0][..], &length.to_le_bytes(), &(!length).to_le_bytes(), bytes].concat()
}

/// The compressor of the data after the stored block.
pub(super) struct DeflatePacker {
    encoder: DeflateEncoder<Vec<u8>>,
    checksum: Hasher,
    /// The number of bytes before compression.
    length: u64,
}

impl DeflatePacker {
    pub(super) fn new(level: Compression) -> Self {
        let encoder = DeflateEncoder::new(Vec::new(), level);
        Self { encoder, checksum: Hasher::new(), length: 0 }
    }

    /// Compresses bytes, and appends the finished output to `packed`.
    pub(super) fn write(&mut self, bytes: &[u8], packed: &mut Vec<u8>) {
        self.checksum.update(bytes);
        self.length += bytes.len() as u64;
        // A write into memory cannot fail.
        let _ = self.encoder.write_all(bytes);
        packed.append(self.encoder.get_mut());
    }

    /// Returns the last packed bytes, the checksum of `header` and the data, and the length of
    /// both.
    pub(super) fn finish(self, header: &[u8]) -> (Vec<u8>, u32, u64) {
        let mut whole = Hasher::new();
        whole.update(header);
        whole.combine(&self.checksum);
        let last = self.encoder.finish().expect("memory takes everything");
        (last, whole.finalize(), self.length + header.len() as u64)
    }
}
