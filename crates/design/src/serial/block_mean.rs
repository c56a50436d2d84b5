// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arithmetic with which a serial array makes a mean of the sum of a block
//! ([`BlockMeanDivision`]): the bits of the sum that leave a lane, and the division at the ports.

use crate::{FeatureHardware, SerialDesign};
use foveate_camera::Reciprocal;

/// The arithmetic that makes a mean of the sum of a block in the accumulator of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockMeanDivision {
    /// Bits of the sum of a block plus half of its number of pixels.
    pub sum_bits: u32,
    /// Number of low bits of the sum that stay in the lane.
    pub dropped_bits: u32,
    /// Number of the other bits of the sum, which pass the ports.
    pub passing_bits: u32,
    /// Constant factor of the bits that pass.
    pub factor: u64,
    /// Number of bits by which the product is shifted to the right.
    pub shift: u32,
}

impl BlockMeanDivision {
    /// Makes the arithmetic for a sum of `sum` bits. With `takes_all`, a lane also moves its whole
    /// accumulator to the score for a feature. It then drops no bits, because that would need a
    /// multiplexer.
    fn from_reciprocal(sum: u32, reciprocal: Reciprocal, takes_all: bool) -> Self {
        let is_shift = reciprocal.multiplier() == 1;
        let dropped = if is_shift && !takes_all { reciprocal.shift() } else { 0 };
        let (factor, shift) = (reciprocal.multiplier(), reciprocal.shift() - dropped);
        Self { sum_bits: sum, dropped_bits: dropped, passing_bits: sum - dropped, factor, shift }
    }
}

impl SerialDesign<'_> {
    /// Returns the arithmetic of the means of blocks, or `None` if no means are sent.
    #[must_use]
    pub fn block_mean_division(&self) -> Option<BlockMeanDivision> {
        let periphery = self.periphery()?;
        let mut features = self.features().iter().map(|f| FeatureHardware::in_serial(f.kind()));
        let takes_all = features.any(|feature| feature.takes_accumulator);
        Some(BlockMeanDivision::from_reciprocal(
            periphery.sum_bits,
            periphery.reciprocal,
            takes_all,
        ))
    }
}
