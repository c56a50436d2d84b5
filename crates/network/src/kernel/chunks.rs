// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positions of a mask in the chunks in which they are computed.

use crate::mask::Mask;
use std::ops::Range;

/// The number of neighboring positions of a row that are computed at once.
pub(crate) const CHUNK_POSITIONS: usize = 8;

/// The first of [`CHUNK_POSITIONS`] neighboring positions. In a narrower row the chunk is the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PositionChunk {
    pub(crate) x: usize,
    pub(crate) y: usize,
}

impl PositionChunk {
    /// The memory indices of its positions, if rows have `width` positions.
    #[inline(always)]
    pub(super) fn memory_range(self, width: usize) -> Range<usize> {
        let start = self.y * width + self.x;
        start..start + CHUNK_POSITIONS.min(width)
    }
}

/// The share of all chunks, in sixteenths, from which computing all chunks is faster, because their
/// inputs are neighbors. It was measured with the example `break_even`.
const BREAK_EVEN_SIXTEENTHS: usize = 15;

/// Returns the positions of a mask as chunks. A chunk may hold positions that are not in the mask,
/// and two chunks may share positions. If nearly all chunks are needed, all are returned.
pub(crate) fn chunks_of_mask(at: &Mask) -> Vec<PositionChunk> {
    let mut found = Vec::new();
    for y in 0..at.height() {
        cut_runs(at.runs(y).map(|(x, length)| x..x + length), y, at.width(), &mut found);
    }
    let all = at.height() * at.width().div_ceil(CHUNK_POSITIONS);
    if found.len() < all && 16 * found.len() >= BREAK_EVEN_SIXTEENTHS * all {
        return chunks_of_mask(&Mask::full(at.height(), at.width()));
    }
    found
}

/// Returns the positions of a mask as chunks of a single row, in the order of memory. A chunk may
/// go on in the next row of the frame.
pub(crate) fn chunks_of_flat_mask(at: &Mask) -> Vec<PositionChunk> {
    let places = at.height() * at.width();
    let mut found = Vec::new();
    cut_runs(at.memory_ranges(), 0, places, &mut found);
    let all = places.div_ceil(CHUNK_POSITIONS);
    if found.len() < all && 16 * found.len() >= BREAK_EVEN_SIXTEENTHS * all {
        found.clear();
        cut_runs(std::iter::once(0..places), 0, places, &mut found);
    }
    found
}

/// Cuts the runs of positions of row `y`, which has `width` positions, into chunks.
fn cut_runs(
    runs: impl IntoIterator<Item = Range<usize>>,
    y: usize,
    width: usize,
    found: &mut Vec<PositionChunk>,
) {
    let last = width.saturating_sub(CHUNK_POSITIONS);
    let mut done = 0;
    for run in runs {
        let mut x = run.start.max(done);
        while x < run.end {
            found.push(PositionChunk { x: x.min(last), y });
            x += CHUNK_POSITIONS;
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
        // There are 288 chunks, 9 in each of 32 rows; a sixteenth is 18.
        assert_eq!(chunks_of_mask(&without(0)).len(), 288);
        assert_eq!(chunks_of_mask(&without(18)), chunks_of_mask(&Mask::full(32, 70)));
        assert_eq!(chunks_of_mask(&without(19)).len(), 288 - 19);
        assert!(chunks_of_mask(&Mask::empty(32, 70)).is_empty());
    }
}
