// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of lanes: a register, or a place of a memory, of every RPU.

use foveate_lanes::{Aligned, BLOCK, Block};

/// One value per RPU, rounded up to whole blocks.
pub(crate) type Row<T> = Aligned<T>;

/// A row of `lanes` values, rounded up.
pub(crate) fn row<T: Copy + Default>(lanes: usize) -> Row<T> {
    Aligned::new(lanes.next_multiple_of(BLOCK))
}

/// A memory of every RPU: a row per place.
#[derive(Clone, Debug)]
pub(crate) struct Memory<T: Copy + Default> {
    values: Aligned<T>,
    /// Blocks of a row.
    blocks: usize,
}

impl<T: Copy + Default> Memory<T> {
    pub(crate) fn new(places: usize, lanes: usize) -> Self {
        let padded = lanes.next_multiple_of(BLOCK);
        Self { values: Aligned::new(places * padded), blocks: padded / BLOCK }
    }

    #[inline(always)]
    pub(crate) fn row(&self, place: usize) -> &[Block<T>] {
        &self.values.blocks()[place * self.blocks..][..self.blocks]
    }

    #[inline(always)]
    pub(crate) fn row_mut(&mut self, place: usize) -> &mut [Block<T>] {
        &mut self.values.blocks_mut()[place * self.blocks..][..self.blocks]
    }

    /// Every place, one after the other.
    pub(crate) fn all(&self) -> &[Block<T>] {
        self.values.blocks()
    }

    /// Every place, to be written.
    pub(crate) fn all_mut(&mut self) -> &mut [Block<T>] {
        self.values.blocks_mut()
    }
}
