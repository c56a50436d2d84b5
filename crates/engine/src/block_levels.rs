// SPDX-License-Identifier: MIT OR Apache-2.0
//! The level of each lane, which is the same one for all lanes unless regions have classes.

use foveate_pixels::lanes::{BLOCK_LANES, Block};

/// The levels of the lanes of a run of blocks.
pub(crate) trait BlockLevels<V>: Copy {
    /// Returns the level of lane `i` of block `at`.
    fn level(self, at: usize, i: usize) -> V;
}

/// One level for all lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UniformLevel<V>(pub(crate) V);

impl<V: Copy> BlockLevels<V> for UniformLevel<V> {
    #[inline(always)]
    fn level(self, _at: usize, _i: usize) -> V {
        self.0
    }
}

impl<V: Copy> BlockLevels<V> for &[Block<V>] {
    #[inline(always)]
    fn level(self, at: usize, i: usize) -> V {
        debug_assert!(i < BLOCK_LANES, "a block has {BLOCK_LANES} lanes");
        self[at][i]
    }
}
