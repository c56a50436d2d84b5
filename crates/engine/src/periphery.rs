// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions, which are means of blocks: they are computed
//! ([`CurrentMeans`]), compared with what was sent last, and shown on the screen
//! ([`SentSummaries`]). The level of the comparison is the same for all elements unless regions
//! have classes ([`BlockLevels`]).

use crate::outcome::RegionResults;
use foveate_camera::RegionAction;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// The geometry of summaries. A region has q x q blocks of b x b pixels; `blocks` is q and `side`
/// is b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PeripheryPlan<T> {
    /// The number of blocks per side of a region.
    pub(crate) blocks: usize,
    /// The side of a block in pixels.
    pub(crate) side: usize,
    pub(crate) level: T,
    /// The number of pixels of a block.
    pub(crate) pixels: u32,
    /// The shift that divides by `pixels`, if that is a power of two.
    pub(crate) shift: Option<u32>,
}

/// The means of a band in the current frame.
#[derive(Debug)]
pub(crate) struct CurrentMeans<'a, T> {
    /// The means, row by row of blocks.
    pub(crate) means: &'a [T],
    /// An output with one value per column of blocks: the largest difference of a mean of the
    /// column from the mean that was sent last.
    pub(crate) differences: &'a mut [T],
    /// The regions whose pixels may have changed. The means of the other regions are not valid.
    pub(crate) affected: &'a [bool],
}

/// The summaries that the regions of a band sent last.
#[derive(Debug)]
pub(crate) struct SentSummaries<'a, T> {
    /// The regions whose summary the screen shows.
    pub(crate) is_shown: &'a mut [bool],
    /// The means that were sent last, row by row of blocks.
    pub(crate) means: &'a mut [T],
}

impl<T: VectorPixel> PeripheryPlan<T> {
    /// Computes the means of a row of blocks from the sums of their columns.
    #[inline(always)]
    pub(crate) fn compute_means(&self, columns: &[T::ColumnSum], means: &mut [T]) {
        // The usual sizes are constants, so that the loop vectorises.
        match self.side {
            1 => self.compute_means_of_side::<1>(columns, means),
            2 => self.compute_means_of_side::<2>(columns, means),
            4 => self.compute_means_of_side::<4>(columns, means),
            8 => self.compute_means_of_side::<8>(columns, means),
            16 => self.compute_means_of_side::<16>(columns, means),
            side => {
                for (columns, mean) in columns.chunks_exact(side).zip(means) {
                    *mean = self.mean(columns);
                }
            }
        }
    }

    #[inline(always)]
    fn compute_means_of_side<const SIDE: usize>(&self, columns: &[T::ColumnSum], means: &mut [T]) {
        let columns = columns.as_chunks::<SIDE>().0;
        match self.shift {
            Some(shift) => {
                for (columns, mean) in columns.iter().zip(means) {
                    *mean = T::from_low_bits((self.pixels / 2 + sum::<T>(columns)) >> shift);
                }
            }
            None => {
                for (columns, mean) in columns.iter().zip(means) {
                    *mean = self.mean(columns);
                }
            }
        }
    }

    #[inline(always)]
    fn mean(&self, columns: &[T::ColumnSum]) -> T {
        let sum = self.pixels / 2 + sum::<T>(columns);
        T::from_low_bits(self.shift.map_or_else(|| sum / self.pixels, |shift| sum >> shift))
    }

    /// Decides which irrelevant regions of a band send their means. A region that is not affected
    /// sends nothing, because its means are those of the last frame, from which the screen differs
    /// by no more than the level.
    /// `level` returns the level of a region.
    #[inline(always)]
    pub(crate) fn send_summaries(
        &self,
        level: impl Fn(usize) -> T,
        current: CurrentMeans<'_, T>,
        summaries: &mut SentSummaries<'_, T>,
        results: &mut RegionResults<'_>,
    ) {
        let CurrentMeans { means, differences: differs, affected } = current;
        differs.fill(T::default());
        let rows = means.chunks_exact(differs.len());
        for (current, sent) in rows.zip(summaries.means.chunks_exact(differs.len())) {
            for ((current, sent), differs) in current.iter().zip(sent).zip(differs.iter_mut()) {
                *differs = (*differs).max(current.absolute_difference(*sent));
            }
        }
        let regions = differs.chunks_exact(self.blocks).zip(affected).zip(&mut *summaries.is_shown);
        for (column, ((differs, &affected), shown)) in regions.enumerate() {
            *shown &= !results.active[column];
            let is_near = *shown && differs.iter().all(|&differs| differs <= level(column));
            if results.srs[column] || !affected || is_near {
                continue;
            }
            let region_blocks = column * self.blocks..(column + 1) * self.blocks;
            let sent = summaries.means.chunks_exact_mut(results.srs.len() * self.blocks);
            for (current, sent) in means.chunks_exact(results.srs.len() * self.blocks).zip(sent) {
                sent[region_blocks.clone()].copy_from_slice(&current[region_blocks.clone()]);
            }
            *shown = true;
            results.actions[column] = RegionAction::Summarize;
        }
    }

    /// Shows the means of one region of a band. `screen` begins with the region's first pixel.
    #[inline(always)]
    pub(crate) fn show_region(
        &self,
        means: &[T],
        (columns, column): (usize, usize),
        screen: &mut [T],
        (stride, width, height): (usize, usize, usize),
    ) {
        for (y, means) in means.chunks_exact(columns * self.blocks).enumerate() {
            let means = &means[column * self.blocks..][..self.blocks];
            for y in y * self.side..((y + 1) * self.side).min(height) {
                self.show_row(means, &mut screen[y * stride..][..width]);
            }
        }
    }

    /// Shows the means of a row of blocks in a row of pixels. The last block may be cut off by the
    /// frame's border.
    #[inline(always)]
    fn show_row(&self, means: &[T], row: &mut [T]) {
        // The usual sizes are constants, so that a fill is a few moves in place of a call.
        match self.side {
            2 => show_constant::<2, T>(means, row),
            4 => show_constant::<4, T>(means, row),
            8 => show_constant::<8, T>(means, row),
            16 => show_constant::<16, T>(means, row),
            side => row.chunks_mut(side).zip(means).for_each(|(row, &mean)| row.fill(mean)),
        }
    }
}

#[inline(always)]
fn show_constant<const SIDE: usize, T: Copy>(means: &[T], row: &mut [T]) {
    let (blocks, rest) = row.as_chunks_mut::<SIDE>();
    let (whole, partial_blocks) = means.split_at(blocks.len().min(means.len()));
    for (block, &mean) in blocks.iter_mut().zip(whole) {
        *block = [mean; SIDE];
    }
    if let Some(&mean) = partial_blocks.first() {
        rest.fill(mean);
    }
}

/// Returns the sum of a block, at most 4096 pixels, from the sums of its columns.
#[inline(always)]
fn sum<T: VectorPixel>(columns: &[T::ColumnSum]) -> u32 {
    columns.iter().map(|&column| -> u32 { column.into() }).sum()
}

/// The levels of the elements of a run of blocks.
pub(crate) trait BlockLevels<V>: Copy {
    /// Returns the level of element `i` of block `at`.
    fn level(self, at: usize, i: usize) -> V;
}

/// One level for all elements.
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
        debug_assert!(i < BLOCK_LENGTH, "a block has {BLOCK_LENGTH} elements");
        self[at][i]
    }
}
