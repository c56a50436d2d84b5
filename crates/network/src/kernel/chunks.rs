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

/// From how many sixteenths of all chunks on it is faster to compute all of them, whose inputs are neighbors: measured by the example `break_even`.
const BREAK_EVEN: usize = 15;

/// The positions of a mask as chunks. A chunk may hold positions that are not in the mask, and two chunks may share some. If nearly all chunks are
/// wanted, all are there.
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
    let all = at.height() * at.width().div_ceil(CHUNK);
    if found.len() < all && 16 * found.len() >= BREAK_EVEN * all {
        return chunks(&Mask::full(at.height(), at.width()));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_all_chunks_become_all() {
        let without = |holes: usize| Mask::from_fn(32, 70, |x, y| x / 8 != 3 || y >= holes);
        // 32 rows of 9 chunks: 288, of which 18 are a sixteenth.
        assert_eq!(chunks(&without(0)).len(), 288);
        assert_eq!(chunks(&without(18)), chunks(&Mask::full(32, 70)));
        assert_eq!(chunks(&without(19)).len(), 288 - 19);
        assert!(chunks(&Mask::empty(32, 70)).is_empty());
    }
}
