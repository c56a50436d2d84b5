// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the sums of blocks become means: what of a sum leaves its lane, and what is done to that at the ports.

use super::feature;
use crate::SerialDesign;
use foveate_camera::Reciprocal;

/// Bits of the sum of a block on its way from the accumulator of a lane to a mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockSums {
    /// Bits of the sum and of half of the block's pixels.
    pub sum: u32,
    /// The lowest bits of it, which stay in the lane.
    pub dropped: u32,
    /// The others, which pass the ports.
    pub passing: u32,
    /// The constant factor that what passes is multiplied with.
    pub factor: u64,
    /// Bits that are dropped of the product.
    pub shift: u32,
}

impl BlockSums {
    /// A lane whose score takes the accumulator as it is anyway, for a feature, drops nothing: it would need a
    /// multiplexer.
    fn of(sum: u32, reciprocal: Reciprocal, takes_all: bool) -> Self {
        let is_shift = reciprocal.multiplier() == 1;
        let dropped = if is_shift && !takes_all { reciprocal.shift() } else { 0 };
        let (factor, shift) = (reciprocal.multiplier(), reciprocal.shift() - dropped);
        Self { sum, dropped, passing: sum - dropped, factor, shift }
    }
}

impl SerialDesign<'_> {
    /// The sums of blocks, where their means are sent.
    #[must_use]
    pub fn block_sums(&self) -> Option<BlockSums> {
        let periphery = self.periphery()?;
        let takes_all = self.features().iter().any(feature::makes_operand);
        Some(BlockSums::of(periphery.sum_bits, periphery.reciprocal, takes_all))
    }
}
