// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median of nine pixels: sort the three pixels of each column once, then combine three
//! columns.
//!
//! The median of the nine is the median of three values: the largest of the columns' lows, the
//! middle one of their mids and the smallest of their highs.

use crate::kernel::{ExtendedRow, WindowSides, extended_block};
use foveate_pixels::{
    vectors::prefetch,
    vectors::{BLOCK_LENGTH, Block, VectorPixel},
};

/// Sorts the three pixels of every column.
#[inline(always)]
pub(crate) fn sort_columns<T: VectorPixel>(rows: [&[Block<T>]; 3], sorted: [&mut [Block<T>]; 3]) {
    let ([a, b, c], [low, mid, high]) = (rows, sorted);
    let blocks = low.len();
    let (a, b, c) = (&a[..blocks], &b[..blocks], &c[..blocks]);
    let (mid, high) = (&mut mid[..blocks], &mut high[..blocks]);
    for at in 0..blocks {
        let (a, b, c) = (&a[at], &b[at], &c[at]);
        let (mut lows, mut mids, mut highs) = (
            [T::default(); BLOCK_LENGTH],
            [T::default(); BLOCK_LENGTH],
            [T::default(); BLOCK_LENGTH],
        );
        for i in 0..BLOCK_LENGTH {
            let (p, q, r) = (a[i], b[i], c[i]);
            let (p, q) = (p.min(q), p.max(q));
            let (q, r) = (q.min(r), q.max(r));
            (lows[i], mids[i], highs[i]) = (p.min(q), p.max(q), r);
        }
        (low[at], mid[at], high[at]) = (lows, mids, highs);
    }
}

/// Computes the median of every window from its three sorted columns. Prefetches `ahead`, raw
/// pixels that will be sorted some rows later.
#[inline(always)]
pub(crate) fn combine_columns<T: VectorPixel>(
    [low, mid, high]: [ExtendedRow<'_, T>; 3],
    sides: impl WindowSides<T>,
    ahead: &[Block<T>],
    out: &mut [Block<T>],
) {
    for (at, out) in out.iter_mut().enumerate() {
        if let Some(ahead) = ahead.get(at) {
            prefetch(ahead);
        }
        let (low, mid, high) =
            (extended_block(low, at), extended_block(mid, at), extended_block(high, at));
        let mut medians = [T::default(); BLOCK_LENGTH];
        for i in 0..BLOCK_LENGTH {
            medians[i] = median_of_columns(
                sides.window_row(low, at, i),
                sides.window_row(mid, at, i),
                sides.window_row(high, at, i),
            );
        }
        *out = medians;
    }
}

/// Returns the median of a window from the lows, mids and highs of its sorted columns.
#[inline(always)]
pub(crate) fn median_of_columns<T: VectorPixel>(
    low: (T, T, T),
    mid: (T, T, T),
    high: (T, T, T),
) -> T {
    middle((low.0.max(low.1).max(low.2), middle(mid), high.0.min(high.1).min(high.2)))
}

/// Returns the second of three values in sorted order.
#[inline(always)]
fn middle<T: VectorPixel>((a, b, c): (T, T, T)) -> T {
    a.min(b).max(a.max(b).min(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::SharedSides;

    /// The 0-1 principle: a network of minima and maxima is right for all values if it is right for
    /// zeros and ones.
    #[test]
    fn every_window_of_zeros_and_ones_has_its_median() {
        for bits in 0..512u32 {
            let pixel = |place: usize| u8::from(bits >> place & 1 == 1);
            // Element 0 sees the window, whose left column is the element before the first block.
            let rows = [0, 3, 6].map(|row| {
                let mut elements = [0; 3 * BLOCK_LENGTH];
                elements[BLOCK_LENGTH - 1] = pixel(row);
                elements[BLOCK_LENGTH] = pixel(row + 1);
                elements[BLOCK_LENGTH + 1] = pixel(row + 2);
                elements
            });
            let mut sorted = [[0; 3 * BLOCK_LENGTH]; 3];
            let [low, mid, high] = &mut sorted;
            let blocks = [low, mid, high].map(|row| row.as_chunks_mut().0);
            let rows = rows.each_ref().map(|row| row.as_chunks().0);
            sort_columns(rows, blocks);
            let mut out = [[9; BLOCK_LENGTH]];
            combine_columns(
                sorted.each_ref().map(|row| &row[BLOCK_LENGTH - 1..]),
                SharedSides,
                &[],
                &mut out,
            );
            assert_eq!(out[0][0], u8::from(bits.count_ones() >= 5), "window {bits:09b}");
        }
    }
}
