// SPDX-License-Identifier: MIT OR Apache-2.0
//! The number of channels and positions in a pass of the inner loop: as many as possible while all
//! sums fit into the registers.

use foveate_pixels::vectors::InstructionSet;
use std::ops::Range;

/// The block sizes of the inner loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BlockSizes {
    /// The positions of a panel: as many values as two registers hold.
    pub(crate) values: usize,
    /// The possible numbers of channels of a block, each with its measured time. The unit is a
    /// tenth of the time that a channel takes in the best block.
    sizes: &'static [(usize, usize)],
}

impl BlockSizes {
    pub(crate) const BITS_128: Self = Self { values: 8, sizes: &[(4, 40)] };
    pub(crate) const BITS_256: Self = Self { values: 16, sizes: &[(6, 60), (4, 46)] };
    pub(crate) const BITS_512: Self =
        Self { values: 32, sizes: &[(12, 120), (10, 103), (6, 62), (4, 50)] };

    pub(crate) fn for_instruction_set(level: InstructionSet) -> Self {
        match level.register_bits() {
            512 => Self::BITS_512,
            256 => Self::BITS_256,
            _ => Self::BITS_128,
        }
    }

    /// Returns the blocks that are fastest for a number of channels. The last block may have more
    /// channels than remain.
    pub(crate) fn blocks(self, channels: usize) -> Vec<Range<usize>> {
        // The smallest time for each number of channels, with the size of the first block. It
        // follows from the times for fewer channels.
        let mut best = vec![(0, 0)];
        for left in 1..=channels {
            let time =
                |&(size, time): &(usize, usize)| (best[left.saturating_sub(size)].0 + time, size);
            best.push(self.sizes.iter().map(time).min().expect("there are sizes"));
        }
        let mut blocks = Vec::new();
        let mut first = 0;
        while first < channels {
            let size = best[channels - first].1;
            blocks.push(first..first + size);
            first += size;
        }
        blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_all_channels() {
        for blocking in [BlockSizes::BITS_128, BlockSizes::BITS_256, BlockSizes::BITS_512] {
            for channels in 1..300 {
                let blocks = blocking.blocks(channels);
                assert!(blocks.windows(2).all(|pair| pair[0].end == pair[1].start));
                let end = blocks.last().unwrap().end;
                assert!(
                    blocks[0].start == 0 && (channels..channels + 4).contains(&end),
                    "{channels}: {blocks:?}"
                );
            }
        }
    }

    #[test]
    fn usual_numbers_of_channels_need_no_padding() {
        let sizes = |channels| {
            BlockSizes::BITS_512
                .blocks(channels)
                .into_iter()
                .map(|block| block.len())
                .collect::<Vec<_>>()
        };
        assert_eq!(sizes(24), [12, 12]);
        for channels in [16, 32, 64, 96, 128, 256, 512] {
            assert_eq!(sizes(channels).iter().sum::<usize>(), channels);
        }
    }
}
