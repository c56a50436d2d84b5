// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positions of a mask in the pieces in which they are computed.

use crate::mask::Mask;

/// Neighboring positions of a row that are computed at once.
pub(crate) const CHUNK: usize = 8;

/// The first of [`CHUNK`] neighboring positions, as far as the row has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub(crate) x: usize,
    pub(crate) y: usize,
}

/// The positions of a mask as chunks. A chunk may hold positions that are not in the mask, and two chunks may share some.
pub(crate) fn chunks(at: &Mask) -> Vec<Chunk> {
    let mut found = Vec::new();
    let last = at.width().saturating_sub(CHUNK);
    for y in 0..at.height() {
        let mut done = 0;
        for (start, length) in at.runs(y) {
            let mut x = start.max(done);
            while x < start + length {
                found.push(Chunk { x: x.min(last), y });
                x += CHUNK;
            }
            done = x;
        }
    }
    found
}
