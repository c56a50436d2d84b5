// SPDX-License-Identifier: MIT OR Apache-2.0
//! The working memory of a worker for one band: a few rows that stay in the first-level cache.

use std::ops::Range;

use crate::kernel::Near;
use crate::plan::CameraPlan;
use foveate_lanes::Aligned;
use foveate_lanes::{BLOCK, Block, Lane};

/// A row with a spare block on each side, so that it can be read shifted by one lane.
#[derive(Clone, Debug)]
pub(crate) struct BlockRow<T: Lane>(Aligned<T>);

impl<T: Lane> BlockRow<T> {
    fn new(blocks: usize) -> Self {
        Self(Aligned::new((blocks + 2) * BLOCK))
    }

    /// Returns some blocks, to be written.
    #[inline(always)]
    pub(crate) fn blocks_mut(&mut self, span: &Range<usize>) -> &mut [Block<T>] {
        &mut self.0.blocks_mut()[1 + span.start..1 + span.end]
    }

    /// Returns the block that begins at any column, to be written.
    #[inline(always)]
    pub(crate) fn blocks_at(&mut self, start: usize) -> &mut [Block<T>] {
        self.0[BLOCK + start..][..BLOCK].as_chunks_mut().0
    }

    /// Returns the values from column 0 on, to be written.
    #[inline(always)]
    pub(crate) fn values_mut(&mut self) -> &mut [T] {
        &mut self.0[BLOCK..]
    }

    /// Returns some blocks.
    #[inline(always)]
    pub(crate) fn blocks(&self, span: &Range<usize>) -> &[Block<T>] {
        &self.0.blocks()[1 + span.start..1 + span.end]
    }

    /// Returns some blocks with one more lane on each side.
    #[inline(always)]
    pub(crate) fn near(&self, span: &Range<usize>) -> Near<'_, T> {
        &self.0[(1 + span.start) * BLOCK - 1..=(1 + span.end) * BLOCK]
    }

    /// Repeats the border pixels of a row of `width` pixels outwards.
    #[inline(always)]
    pub(crate) fn repeat_border(&mut self, width: usize, padded: usize) {
        let values = &mut self.0[..];
        values[BLOCK - 1] = values[BLOCK];
        let last = values[BLOCK + width - 1];
        values[BLOCK + padded] = last;
        if padded > width {
            values[BLOCK + width..BLOCK + padded].fill(last);
        }
    }
}

/// A denoised row.
#[derive(Clone, Debug)]
pub(crate) struct DenoisedRow<T: Lane> {
    /// The row of the current frame and the run of blocks that are in `pixels`.
    pub(crate) holds: Option<(usize, Range<usize>)>,
    pub(crate) pixels: BlockRow<T>,
}

/// The column sums of one band.
#[derive(Clone, Debug)]
pub(crate) struct Columns<T: Lane> {
    pub(crate) changed: Aligned<T>,
    pub(crate) edge: Aligned<T>,
    pub(crate) corner: Aligned<T>,
    pub(crate) sum: Aligned<T::Sum>,
    pub(crate) square: Aligned<T::Square>,
    /// The whole part of the mean of each column's region.
    pub(crate) mean: Aligned<T>,
    pub(crate) above: Aligned<T::Sum>,
    pub(crate) over: Aligned<T>,
}

/// The sums of one band by region.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    pub(crate) changed: Vec<u64>,
    pub(crate) edge: Vec<u64>,
    pub(crate) corner: Vec<u64>,
    pub(crate) sum: Vec<u64>,
    pub(crate) square: Vec<u64>,
    pub(crate) above: Vec<u64>,
    pub(crate) over: Vec<u64>,
}

/// The working memory of one worker.
#[derive(Clone, Debug)]
pub(crate) struct Scratch<T: Lane> {
    /// The low, mid and high values of the columns, for each row of a batch.
    pub(crate) sorted: Vec<[BlockRow<T>; 3]>,
    /// Three rows of a window in a frame that is narrower than a block.
    pub(crate) tail: [Block<T>; 3],
    /// The denoised rows of a batch and the rows around it.
    pub(crate) denoised: Vec<DenoisedRow<T>>,
    pub(crate) columns: Columns<T>,
    pub(crate) sums: Sums,
    /// A raw row with its padding, for summaries of raw pixels.
    pub(crate) raw: BlockRow<T>,
    /// The means of the band's blocks, row by row of blocks.
    pub(crate) means: Vec<T>,
    /// One value per column of blocks: not 0 if a mean differs too much from the one that was sent
    /// last.
    pub(crate) differs: Vec<T>,
    /// The runs of blocks of the band that have to be computed.
    pub(crate) runs: Vec<Range<usize>>,
    /// The regions of the band whose results may have changed.
    pub(crate) affected: Vec<bool>,
}

impl<T: Lane> Scratch<T> {
    pub(crate) fn new(plan: &CameraPlan<T>) -> Self {
        let (rows, row) = (plan.slots(1), || BlockRow::new(plan.blocks));
        let denoised = || DenoisedRow { holds: None, pixels: row() };
        let regions = || vec![0; plan.columns];
        let width = plan.stride();
        Self {
            sorted: (0..rows).map(|_| [row(), row(), row()]).collect(),
            tail: [[T::default(); BLOCK]; 3],
            denoised: (0..rows).map(|_| denoised()).collect(),
            columns: Columns {
                changed: Aligned::new(width),
                edge: Aligned::new(width),
                corner: Aligned::new(width),
                sum: Aligned::new(width),
                square: Aligned::new(width),
                mean: Aligned::new(width),
                above: Aligned::new(width),
                over: Aligned::new(width),
            },
            sums: Sums {
                changed: regions(),
                edge: regions(),
                corner: regions(),
                sum: regions(),
                square: regions(),
                above: regions(),
                over: regions(),
            },
            raw: row(),
            means: vec![T::default(); plan.band_means()],
            differs: vec![T::default(); plan.means_in_row()],
            runs: Vec::with_capacity(plan.blocks),
            affected: vec![true; plan.columns],
        }
    }
}
