// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one worker needs while it is at a band: a few rows that stay in the first-level cache.

use std::ops::Range;

use crate::kernel::Near;
use crate::plan::CameraPlan;
use foveate_lanes::Aligned;
use foveate_lanes::{BLOCK, Block, Lane};

/// A row with a block to spare on each side, so that it can be read shifted by one.
#[derive(Clone, Debug)]
pub(crate) struct BlockRow<T: Lane>(Aligned<T>);

impl<T: Lane> BlockRow<T> {
    fn new(blocks: usize) -> Self {
        Self(Aligned::new((blocks + 2) * BLOCK))
    }

    /// The blocks, to be written.
    #[inline(always)]
    pub(crate) fn blocks_mut(&mut self, span: &Range<usize>) -> &mut [Block<T>] {
        &mut self.0.blocks_mut()[1 + span.start..1 + span.end]
    }

    /// One block from any column on, to be written.
    #[inline(always)]
    pub(crate) fn blocks_at(&mut self, start: usize) -> &mut [Block<T>] {
        self.0[BLOCK + start..][..BLOCK].as_chunks_mut().0
    }

    /// The values, to be written; the first is that of column 0.
    #[inline(always)]
    pub(crate) fn values_mut(&mut self) -> &mut [T] {
        &mut self.0[BLOCK..]
    }

    /// The values of some blocks.
    #[inline(always)]
    pub(crate) fn blocks(&self, span: &Range<usize>) -> &[Block<T>] {
        &self.0.blocks()[1 + span.start..1 + span.end]
    }

    /// The same with one lane more on each side.
    #[inline(always)]
    pub(crate) fn near(&self, span: &Range<usize>) -> Near<'_, T> {
        &self.0[(1 + span.start) * BLOCK - 1..=(1 + span.end) * BLOCK]
    }

    /// Repeats the border pixels of a row of `width` outwards.
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
    /// Which row and blocks of the current frame this is.
    pub(crate) holds: Option<(usize, Range<usize>)>,
    pub(crate) pixels: BlockRow<T>,
}

/// Column sums of one band.
#[derive(Clone, Debug)]
pub(crate) struct Columns<T: Lane> {
    pub(crate) changed: Aligned<T>,
    pub(crate) edge: Aligned<T>,
    pub(crate) corner: Aligned<T>,
    pub(crate) sum: Aligned<T::Sum>,
    pub(crate) square: Aligned<T::Square>,
    /// The whole part of each column's region's mean.
    pub(crate) mean: Aligned<T>,
    pub(crate) above: Aligned<T::Sum>,
    pub(crate) over: Aligned<T>,
}

/// The same by region.
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

/// Working memory of one worker.
#[derive(Clone, Debug)]
pub(crate) struct Scratch<T: Lane> {
    /// Low, mid and high of the columns of each row of a batch.
    pub(crate) sorted: Vec<[BlockRow<T>; 3]>,
    /// A row short of a whole block, three rows of a window.
    pub(crate) tail: [Block<T>; 3],
    /// The rows of a batch and those around it.
    pub(crate) denoised: Vec<DenoisedRow<T>>,
    pub(crate) columns: Columns<T>,
    pub(crate) sums: Sums,
    /// A raw row with its padding, where summaries are made of raw pixels.
    pub(crate) raw: BlockRow<T>,
    /// The means of the band's blocks, row by row of blocks.
    pub(crate) means: Vec<T>,
    /// By column of blocks: not 0 where a mean differs from the one that was sent last.
    pub(crate) differs: Vec<T>,
    /// Blocks of the band that have to be computed.
    pub(crate) runs: Vec<Range<usize>>,
    /// Regions of the band whose results may have changed.
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
