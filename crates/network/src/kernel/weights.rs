// SPDX-License-Identifier: MIT OR Apache-2.0
//! Weights in the order in which the inner loop reads them.

use super::blocking::BlockSizes;
use std::ops::Range;

/// The weights of a group of output channels, block by block. A block holds one weight per channel
/// for the first input, then for the second, and so on. Channels that only fill the last block have
/// weights of 0.
#[derive(Clone, Debug)]
pub(crate) struct PackedWeights<T = f32> {
    blocking: BlockSizes,
    blocks: Vec<Range<usize>>,
    /// The number of products of an output.
    depth: usize,
    packed: Vec<T>,
    bias: Vec<T>,
}

impl<T: Copy + Default> PackedWeights<T> {
    /// Packs a row of `depth` weights per channel.
    pub(crate) fn new(rows: &[T], depth: usize, bias: &[T], blocking: BlockSizes) -> Self {
        let channels = rows.len() / depth;
        let blocks = blocking.blocks(channels);
        let mut packed = Vec::with_capacity(rows.len());
        for block in &blocks {
            for input in 0..depth {
                packed.extend(
                    block.clone().map(|channel| {
                        rows.get(channel * depth + input).copied().unwrap_or_default()
                    }),
                );
            }
        }
        Self { blocking, blocks, depth, packed, bias: bias.to_vec() }
    }

    pub(crate) fn blocking(&self) -> BlockSizes {
        self.blocking
    }

    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    /// The ranges of channels of all blocks.
    pub(crate) fn blocks(&self) -> &[Range<usize>] {
        &self.blocks
    }

    /// The weights of a block for some inputs.
    pub(super) fn block_weights(&self, block: &Range<usize>, inputs: &Range<usize>) -> &[T] {
        let start = block.start * self.depth;
        &self.packed[start + inputs.start * block.len()..start + inputs.end * block.len()]
    }

    /// The bias of a channel, or 0 if there is none.
    pub(super) fn bias(&self, channel: usize) -> T {
        self.bias.get(channel).copied().unwrap_or_default()
    }
}
