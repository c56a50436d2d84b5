// SPDX-License-Identifier: MIT OR Apache-2.0
//! The working memory of a worker for one band: a few rows that stay in the first-level cache.

use std::ops::Range;

use crate::kernel::ExtendedRow;
use crate::kernel::flow::DisplacedErrors;
use crate::kernel::surface::DISPLACEMENTS;
use crate::plan::CameraPlan;
use crate::vector_levels::VectorLevels;
use foveate_pixels::{
    vectors::AlignedBuffer,
    vectors::{BLOCK_LENGTH, Block, VectorPixel},
};

/// A row with a spare block on each side, so that it can be read shifted by one element.
#[derive(Clone, Debug)]
pub(crate) struct BlockRow<T: Copy + Default>(AlignedBuffer<T>);

impl<T: Copy + Default> BlockRow<T> {
    fn new(blocks: usize) -> Self {
        Self(AlignedBuffer::new((blocks + 2) * BLOCK_LENGTH))
    }

    /// Returns some blocks, to be written.
    #[inline(always)]
    pub(crate) fn blocks_mut(&mut self, span: &Range<usize>) -> &mut [Block<T>] {
        &mut self.0.blocks_mut()[1 + span.start..1 + span.end]
    }

    /// Returns some blocks from any column on, to be written.
    #[inline(always)]
    pub(crate) fn blocks_at(&mut self, start: usize, count: usize) -> &mut [Block<T>] {
        self.0[BLOCK_LENGTH + start..][..count * BLOCK_LENGTH].as_chunks_mut().0
    }

    /// Returns the values from column 0 on, to be written.
    #[inline(always)]
    pub(crate) fn values_mut(&mut self) -> &mut [T] {
        &mut self.0[BLOCK_LENGTH..]
    }

    /// Returns some blocks.
    #[inline(always)]
    pub(crate) fn blocks(&self, span: &Range<usize>) -> &[Block<T>] {
        &self.0.blocks()[1 + span.start..1 + span.end]
    }

    /// Returns some blocks with one more element on each side.
    #[inline(always)]
    pub(crate) fn blocks_with_neighbors(&self, span: &Range<usize>) -> ExtendedRow<'_, T> {
        &self.0[(1 + span.start) * BLOCK_LENGTH - 1..=(1 + span.end) * BLOCK_LENGTH]
    }

    /// Returns blocks whose columns lie `shift` columns, at most a block, before those of `span`.
    #[inline(always)]
    pub(crate) fn shifted_blocks(&self, span: &Range<usize>, shift: i8) -> &[Block<T>] {
        let start = ((1 + span.start) * BLOCK_LENGTH).saturating_add_signed(-isize::from(shift));
        self.0[start..][..span.len() * BLOCK_LENGTH].as_chunks().0
    }

    /// Repeats the border pixels of a row of `width` pixels outwards.
    #[inline(always)]
    pub(crate) fn repeat_border(&mut self, width: usize, padded: usize) {
        let values = &mut self.0[..];
        values[BLOCK_LENGTH - 1] = values[BLOCK_LENGTH];
        let last = values[BLOCK_LENGTH + width - 1];
        values[BLOCK_LENGTH + padded] = last;
        if padded > width {
            values[BLOCK_LENGTH + width..BLOCK_LENGTH + padded].fill(last);
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct DenoisedRow<T: VectorPixel> {
    /// The row of the current frame and the run of blocks that are in `pixels`.
    pub(crate) row_and_run: Option<(usize, Range<usize>)>,
    pub(crate) pixels: BlockRow<T>,
}

/// The sums and extremes of the columns of one band.
#[derive(Clone, Debug)]
pub(crate) struct ColumnSums<T: VectorPixel> {
    pub(crate) changed: AlignedBuffer<T>,
    pub(crate) edge: AlignedBuffer<T>,
    pub(crate) corner: AlignedBuffer<T>,
    pub(crate) sum: AlignedBuffer<T::ColumnSum>,
    pub(crate) square: AlignedBuffer<T::SquareSum>,
    pub(crate) smallest: AlignedBuffer<T>,
    pub(crate) largest: AlignedBuffer<T>,
    /// The sums of differences for each displacement of `surface`.
    pub(crate) differences: [AlignedBuffer<T::ColumnSum>; DISPLACEMENTS],
    /// The whole part of the mean of each column's region.
    pub(crate) mean: AlignedBuffer<T>,
    pub(crate) above: AlignedBuffer<T::ColumnSum>,
    pub(crate) count_above: AlignedBuffer<T>,
    /// The upper and the lower bound of `segment` of each column's region.
    pub(crate) segment_bounds: [AlignedBuffer<T>; 2],
    /// The numbers of pixels above and below the bounds of `segment`.
    pub(crate) segment: [AlignedBuffer<T>; 2],
}

/// The sums and ranges of one band by region.
#[derive(Clone, Debug, Default)]
pub(crate) struct RegionSums {
    pub(crate) changed: Vec<u64>,
    pub(crate) edge: Vec<u64>,
    pub(crate) corner: Vec<u64>,
    pub(crate) sum: Vec<u64>,
    pub(crate) square: Vec<u64>,
    pub(crate) range: Vec<u64>,
    pub(crate) differences: [Vec<u64>; DISPLACEMENTS],
    pub(crate) above: Vec<u64>,
    pub(crate) count_above: Vec<u64>,
    pub(crate) segment: [Vec<u64>; 2],
}

#[derive(Clone, Debug)]
pub(crate) struct WorkingMemory<T: VectorPixel> {
    /// The low, mid and high values of the columns, for each row of a batch.
    pub(crate) sorted: Vec<[BlockRow<T>; 3]>,
    /// The weighted sums of the columns, for each row of a batch.
    pub(crate) column_sums: Vec<BlockRow<T::ColumnSum>>,
    /// Three rows of a window in a frame that is narrower than a block.
    pub(crate) narrow_window: [Block<T>; 3],
    /// The denoised rows of a batch and the rows around it.
    pub(crate) denoised: Vec<DenoisedRow<T>>,
    pub(crate) columns: ColumnSums<T>,
    pub(crate) region_sums: RegionSums,
    pub(crate) levels: VectorLevels<T>,
    /// The rows of the band's references, for `flow`.
    pub(crate) references: Vec<BlockRow<T>>,
    /// The errors of each displacement of `flow`, in the order of preference.
    pub(crate) flow_errors: Vec<DisplacedErrors>,
    /// The sums of differences of the columns at one displacement.
    pub(crate) flow_columns: AlignedBuffer<T::ColumnSum>,
    /// A raw row with its padding, for summaries of raw pixels.
    pub(crate) raw: BlockRow<T>,
    /// The means of the band's blocks, row by row of blocks.
    pub(crate) means: Vec<T>,
    /// One value per column of blocks; see [`CurrentMeans`](crate::periphery::CurrentMeans).
    pub(crate) mean_differences: Vec<T>,
    /// The runs of blocks of the band that have to be computed.
    pub(crate) runs: Vec<Range<usize>>,
    /// The regions of the band whose results may have changed.
    pub(crate) affected: Vec<bool>,
}

impl<T: VectorPixel> WorkingMemory<T> {
    pub(crate) fn new(plan: &CameraPlan<T>) -> Self {
        let (rows, row) = (plan.row_slots(1), || BlockRow::new(plan.blocks));
        let denoised = || DenoisedRow { row_and_run: None, pixels: row() };
        let regions = || vec![0; plan.columns];
        let width = plan.stride();
        Self {
            sorted: (0..rows).map(|_| [row(), row(), row()]).collect(),
            column_sums: (0..rows).map(|_| BlockRow::new(plan.blocks)).collect(),
            narrow_window: [[T::default(); BLOCK_LENGTH]; 3],
            denoised: (0..rows).map(|_| denoised()).collect(),
            columns: ColumnSums {
                changed: AlignedBuffer::new(width),
                edge: AlignedBuffer::new(width),
                corner: AlignedBuffer::new(width),
                sum: AlignedBuffer::new(width),
                square: AlignedBuffer::new(width),
                smallest: AlignedBuffer::new(width),
                largest: AlignedBuffer::new(width),
                differences: std::array::from_fn(|_| AlignedBuffer::new(width)),
                mean: AlignedBuffer::new(width),
                above: AlignedBuffer::new(width),
                count_above: AlignedBuffer::new(width),
                segment_bounds: std::array::from_fn(|_| AlignedBuffer::new(width)),
                segment: std::array::from_fn(|_| AlignedBuffer::new(width)),
            },
            region_sums: RegionSums {
                changed: regions(),
                edge: regions(),
                corner: regions(),
                sum: regions(),
                square: regions(),
                range: regions(),
                differences: std::array::from_fn(|_| regions()),
                above: regions(),
                count_above: regions(),
                segment: [regions(), regions()],
            },
            levels: VectorLevels::new(plan),
            references: match plan.flow_radius {
                Some(_) => (0..plan.side).map(|_| row()).collect(),
                None => Vec::new(),
            },
            flow_errors: plan.flow_radius.map_or(Vec::new(), |radius| {
                DisplacedErrors::for_search(radius, plan.side_pixels(), plan.columns)
            }),
            flow_columns: AlignedBuffer::new(plan.flow_radius.map_or(0, |_| width)),
            raw: row(),
            means: vec![T::default(); plan.band_means()],
            mean_differences: vec![T::default(); plan.means_in_row()],
            runs: Vec::with_capacity(plan.blocks),
            affected: vec![true; plan.columns],
        }
    }
}
