// SPDX-License-Identifier: MIT OR Apache-2.0
//! `mad` with a mean in whole grey levels.
//!
//! Let the mean be `mu = 2^f m + r` with `0 <= r < 2^f`. A pixel is above `mu` exactly if it is
//! above `m`, and the sums of the deviations above and below `mu` differ by `n mu - 2^f S`, where
//! `S` is the sum of the pixels. With `Q` the sum of `max(x - m, 0)` and `K` the number of pixels
//! above `m`, the score is `2 (2^f Q - r K) + n mu - 2^f S`. So one saturating subtraction per
//! pixel is enough for any f.

use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// Adds to every column the amounts by which its pixels exceed `mean`.
#[inline(always)]
pub(crate) fn add_above<T: VectorPixel>(
    pixels: &[Block<T>],
    mean: &[Block<T>],
    above: &mut [Block<T::ColumnSum>],
) {
    for ((pixels, mean), above) in pixels.iter().zip(mean).zip(above) {
        for i in 0..BLOCK_LENGTH {
            above[i] += T::ColumnSum::from(pixels[i].saturating_minus(mean[i]));
        }
    }
}

/// Adds one to every element whose pixel is above `mean`.
#[inline(always)]
pub(crate) fn count_above<T: VectorPixel>(
    pixels: &[Block<T>],
    mean: &[Block<T>],
    hits: &mut [Block<T>],
) {
    for ((pixels, mean), hits) in pixels.iter().zip(mean).zip(hits) {
        for i in 0..BLOCK_LENGTH {
            hits[i] += pixels[i].saturating_minus(mean[i]).min(T::ONE);
        }
    }
}

/// Returns the rounded mean of a region in units of `2^-f` grey levels.
#[inline(always)]
pub(crate) fn region_mean(sum: u64, n: u64, fraction_bits: u32) -> u64 {
    ((sum << fraction_bits) + n / 2) / n
}

/// Returns the score. `sum` is the sum of the pixels, `above` the sum of the amounts by which
/// pixels exceed the whole part of the mean, and `over` the number of pixels that exceed it.
#[inline(always)]
pub(crate) fn mad_score(n: u64, fraction_bits: u32, sum: u64, above: u64, over: u64) -> u64 {
    let mean = region_mean(sum, n, fraction_bits);
    let fraction = mean - ((mean >> fraction_bits) << fraction_bits);
    2 * ((above << fraction_bits) - fraction * over) + n * mean - (sum << fraction_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_identity_holds_for_every_small_region() {
        for code in 0..7usize.pow(4) {
            let pixels = [code % 7, code / 7 % 7, code / 49 % 7, code / 343].map(|x| x as u64);
            for fraction_bits in 0..=2 {
                let sum = pixels.iter().sum();
                let mean = region_mean(sum, 4, fraction_bits);
                let whole = mean >> fraction_bits;
                let above = pixels.iter().map(|x| x.saturating_sub(whole)).sum();
                let over = pixels.iter().map(|&x| u64::from(x > whole)).sum();
                let plain: u64 = pixels.iter().map(|x| (x << fraction_bits).abs_diff(mean)).sum();
                let score = mad_score(4, fraction_bits, sum, above, over);
                assert_eq!(score, plain, "{pixels:?} with {fraction_bits} bits");
            }
        }
    }
}
