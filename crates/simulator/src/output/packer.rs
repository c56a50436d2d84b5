// SPDX-License-Identifier: MIT OR Apache-2.0
//! Deflate for files whose first bytes are known last: these are a stored block of their own, which can be
//! written over at the end, before the compressed rest.

use std::io::Write as _;

use crc32fast::Hasher;
use flate2::Compression;
use flate2::write::DeflateEncoder;

/// Bytes before those of a stored block: its kind and its length, twice.
pub(super) const BEFORE_STORED: usize = 5;

/// The stored block of some bytes, at most 65,535.
pub(super) fn stored(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).expect("a header has a few bytes");
    [&[0][..], &length.to_le_bytes(), &(!length).to_le_bytes(), bytes].concat()
}

/// The rest, in memory until it is taken.
pub(super) struct Packer {
    encoder: DeflateEncoder<Vec<u8>>,
    checksum: Hasher,
    /// Bytes before compression.
    length: u64,
}

impl Packer {
    pub(super) fn new(level: Compression) -> Self {
        let encoder = DeflateEncoder::new(Vec::new(), level);
        Self { encoder, checksum: Hasher::new(), length: 0 }
    }

    /// Takes bytes, and appends to `packed` what is ready.
    pub(super) fn write(&mut self, bytes: &[u8], packed: &mut Vec<u8>) {
        self.checksum.update(bytes);
        self.length += bytes.len() as u64;
        // Memory takes everything.
        let _ = self.encoder.write_all(bytes);
        packed.append(self.encoder.get_mut());
    }

    /// The last packed bytes, the checksum of `header` with the rest, and the length of both.
    pub(super) fn finish(self, header: &[u8]) -> (Vec<u8>, u32, u64) {
        let mut whole = Hasher::new();
        whole.update(header);
        whole.combine(&self.checksum);
        let last = self.encoder.finish().expect("memory takes everything");
        (last, whole.finalize(), self.length + header.len() as u64)
    }
}
