// SPDX-License-Identifier: MIT OR Apache-2.0
//! `mad` in whole grey levels.
//!
//! With the mean `mu = 2^f m + r`, `0 <= r < 2^f`, a pixel is above `mu` or not as it is above `m` or
//! not, and deviations above and below differ by `n mu - 2^f S` in all. So, with `Q` the sum of
//! `max(x - m, 0)` and `K` the number of pixels above `m`, the score is
//! `2 (2^f Q - r K) + n mu - 2^f S`: one saturating subtraction of bytes per pixel, whatever f.

use foveate_lanes::{BLOCK, Block, Lane};

/// Adds to every column what its pixels are above `mean`.
#[inline(always)]
pub(crate) fn add_above<T: Lane>(
    pixels: &[Block<T>],
    mean: &[Block<T>],
    above: &mut [Block<T::Sum>],
) {
    for ((pixels, mean), above) in pixels.iter().zip(mean).zip(above) {
        for i in 0..BLOCK {
            above[i] += T::Sum::from(pixels[i].minus(mean[i]));
        }
    }
}

/// Adds one to every lane that is above `mean`.
#[inline(always)]
pub(crate) fn count_above<T: Lane>(pixels: &[Block<T>], mean: &[Block<T>], hits: &mut [Block<T>]) {
    for ((pixels, mean), hits) in pixels.iter().zip(mean).zip(hits) {
        for i in 0..BLOCK {
            hits[i] += pixels[i].minus(mean[i]).min(T::ONE);
        }
    }
}

/// The rounded mean of a region in units of `2^-f` grey levels.
#[inline(always)]
pub(crate) fn mean(sum: u64, n: u64, fraction_bits: u32) -> u64 {
    ((sum << fraction_bits) + n / 2) / n
}

/// The score, from the sum of the pixels, what they are above the whole part of the mean, and how
/// many are above it.
#[inline(always)]
pub(crate) fn score(n: u64, fraction_bits: u32, sum: u64, above: u64, over: u64) -> u64 {
    let mean = mean(sum, n, fraction_bits);
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
                let mean = mean(sum, 4, fraction_bits);
                let whole = mean >> fraction_bits;
                let above = pixels.iter().map(|x| x.saturating_sub(whole)).sum();
                let over = pixels.iter().map(|&x| u64::from(x > whole)).sum();
                let plain: u64 = pixels.iter().map(|x| (x << fraction_bits).abs_diff(mean)).sum();
                let score = score(4, fraction_bits, sum, above, over);
                assert_eq!(score, plain, "{pixels:?} with {fraction_bits} bits");
            }
        }
    }
}
