// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positions of a mask in the pieces in which they are computed.

use crate::mask::Mask;
use std::ops::Range;

/// Neighboring positions of a row that are computed at once.
pub(crate) const CHUNK: usize = 8;

/// The first of [`CHUNK`] neighboring positions, as far as the row has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub(crate) x: usize,
    pub(crate) y: usize,
}

impl Chunk {
    /// Its positions in memory, where rows have `width`.
    #[inline(always)]
    pub(super) fn places(self, width: usize) -> Range<usize> {
        let start = self.y * width + self.x;
        start..start + CHUNK.min(width)
    }
}

/// From how many sixteenths of all chunks on it is faster to compute all of them, whose inputs are neighbors: measured by the example `break_even`.
const BREAK_EVEN: usize = 15;

/// The positions of a mask as chunks. A chunk may hold positions that are not in the mask, and two chunks may share some. If nearly all chunks are
/// wanted, all are there.
pub(crate) fn chunks(at: &Mask) -> Vec<Chunk> {
    let mut found = Vec::new();
    for y in 0..at.height() {
        cut(at.runs(y).map(|(x, length)| x..x + length), y, at.width(), &mut found);
    }
    let all = at.height() * at.width().div_ceil(CHUNK);
    if found.len() < all && 16 * found.len() >= BREAK_EVEN * all {
        return chunks(&Mask::full(at.height(), at.width()));
    }
    found
}

/// The same of positions that are all in one row, as they are in memory: no chunk ends with a row of the picture.
pub(crate) fn chunks_in_a_row(at: &Mask) -> Vec<Chunk> {
    let places = at.height() * at.width();
    let mut found = Vec::new();
    cut(at.ranges(), 0, places, &mut found);
    let all = places.div_ceil(CHUNK);
    if found.len() < all && 16 * found.len() >= BREAK_EVEN * all {
        found.clear();
        cut(std::iter::once(0..places), 0, places, &mut found);
    }
    found
}

/// Cuts the runs of positions of row `y`, which has `width`.
fn cut(
    runs: impl IntoIterator<Item = Range<usize>>,
    y: usize,
    width: usize,
    found: &mut Vec<Chunk>,
) {
    let last = width.saturating_sub(CHUNK);
    let mut done = 0;
    for run in runs {
        let mut x = run.start.max(done);
        while x < run.end {
            found.push(Chunk { x: x.min(last), y });
            x += CHUNK;
        }
        done = x;
    }
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
