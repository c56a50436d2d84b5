// SPDX-License-Identifier: MIT OR Apache-2.0
//! `segment` with bounds in whole grey levels.
//!
//! Let the mean be `mu = 2^f m + r` with `0 <= r < 2^f`. A pixel is a whole number, so it is above
//! `mu + 2^f level` exactly if it is above `m + level`, and below `mu - 2^f level` exactly if it is
//! below `c - level`, where c is `m`, or `m + 1` if r is not 0. So one saturating subtraction per
//! pixel and bound is enough for any f.

use super::mad::region_mean;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// The parameters of `segment`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentPlan {
    /// The fraction bits of the mean.
    pub(crate) fraction_bits: u32,
    /// The largest distance from the mean that does not count, in grey levels.
    pub(crate) level: u32,
}

impl SegmentPlan {
    /// Returns the largest pixel that is not above, from the sum of the n pixels of a region. It
    /// may be larger than any pixel.
    #[inline(always)]
    pub(crate) fn upper_bound(self, sum: u64, n: u64) -> u64 {
        (region_mean(sum, n, self.fraction_bits) >> self.fraction_bits) + u64::from(self.level)
    }

    /// Returns the smallest pixel that is not below, from the sum of the n pixels of a region.
    #[inline(always)]
    pub(crate) fn lower_bound(self, sum: u64, n: u64) -> u64 {
        let mean = region_mean(sum, n, self.fraction_bits);
        mean.div_ceil(1 << self.fraction_bits).saturating_sub(self.level.into())
    }
}

/// Adds one to every element of `above` whose pixel is above its upper bound, and to every element
/// of `below` whose pixel is below its lower bound.
#[inline(always)]
pub(crate) fn count_parts<T: VectorPixel>(
    pixels: &[Block<T>],
    [upper, lower]: [&[Block<T>]; 2],
    [above, below]: [&mut [Block<T>]; 2],
) {
    let bounds = upper.iter().zip(lower);
    for ((pixels, (upper, lower)), (above, below)) in
        pixels.iter().zip(bounds).zip(above.iter_mut().zip(below))
    {
        for i in 0..BLOCK_LENGTH {
            above[i] += pixels[i].saturating_minus(upper[i]).min(T::ONE);
            below[i] += lower[i].saturating_minus(pixels[i]).min(T::ONE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bounds_are_those_of_the_contract() {
        for fraction_bits in 0..=3 {
            for level in 0..4 {
                let plan = SegmentPlan { fraction_bits, level };
                for sum in 0..=9 * 7 {
                    let mean = region_mean(sum, 9, fraction_bits);
                    let (upper, lower) = (plan.upper_bound(sum, 9), plan.lower_bound(sum, 9));
                    for pixel in 0..=7_u64 {
                        let [x, l] = [pixel, level.into()].map(|value| value << fraction_bits);
                        assert_eq!(pixel > upper, x > mean + l, "{pixel} {sum} {plan:?}");
                        assert_eq!(pixel < lower, x + l < mean, "{pixel} {sum} {plan:?}");
                    }
                }
            }
        }
    }
}
