// SPDX-License-Identifier: MIT OR Apache-2.0
//! `binomial3x3`: sum the three pixels of each column once, then the sums of three columns, both
//! with the weights 1, 2, 1.

use crate::kernel::{ExtendedRow, WindowSides, extended_block};
use foveate_pixels::{
    vectors::prefetch,
    vectors::{BLOCK_LENGTH, Block, VectorPixel},
};

/// Computes the weighted sum of the three pixels of every column.
#[inline(always)]
pub(crate) fn sum_columns<T: VectorPixel>(
    [a, b, c]: [&[Block<T>]; 3],
    sums: &mut [Block<T::ColumnSum>],
) {
    for (sums, ((a, b), c)) in sums.iter_mut().zip(a.iter().zip(b).zip(c)) {
        for i in 0..BLOCK_LENGTH {
            sums[i] = weighted_sum(
                T::ColumnSum::from(a[i]),
                T::ColumnSum::from(b[i]),
                T::ColumnSum::from(c[i]),
            );
        }
    }
}

/// Computes the mean of every window from the sums of its columns. Prefetches `ahead`, raw pixels
/// that will be summed some rows later.
#[inline(always)]
pub(crate) fn combine_columns<T: VectorPixel>(
    sums: ExtendedRow<'_, T::ColumnSum>,
    sides: impl WindowSides<T>,
    ahead: &[Block<T>],
    out: &mut [Block<T>],
) {
    for (at, out) in out.iter_mut().enumerate() {
        if let Some(ahead) = ahead.get(at) {
            prefetch(ahead);
        }
        let sums = extended_block(sums, at);
        for i in 0..BLOCK_LENGTH {
            let (left, center, right) = sides.window_sums(sums, at, i);
            out[i] = T::rounded_sixteenth(weighted_sum(left, center, right));
        }
    }
}

/// Returns `a + 2 b + c`.
#[inline(always)]
fn weighted_sum<S: Copy + std::ops::AddAssign>(a: S, b: S, c: S) -> S {
    let mut sum = a;
    sum += b;
    sum += b;
    sum += c;
    sum
}
