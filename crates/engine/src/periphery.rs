// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions: from the sums of blocks to means, which of them are sent, and what the screen shows.

use foveate_camera::Action;

use crate::outcome::Results;
use foveate_lanes::Lane;

/// How summaries are formed: q blocks per side of b pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PeripheryPlan<T> {
    /// Blocks per side of a region.
    pub(crate) blocks: usize,
    /// Side of a block.
    pub(crate) side: usize,
    pub(crate) level: T,
    /// Pixels of a block.
    pub(crate) pixels: u32,
    /// The shift that divides by them, where they are a power of two.
    pub(crate) shift: Option<u32>,
}

/// The means of a band in this frame.
#[derive(Debug)]
pub(crate) struct Means<'a, T> {
    /// Row by row of blocks.
    pub(crate) means: &'a [T],
    /// By column of blocks, to be written: not 0 where a mean differs from the one that was sent last.
    pub(crate) differs: &'a mut [T],
    /// Regions whose pixels may have changed; the means of others are not known.
    pub(crate) affected: &'a [bool],
}

/// What the regions of a band have sent of themselves last.
#[derive(Debug)]
pub(crate) struct Summaries<'a, T> {
    /// Regions whose summary the screen shows.
    pub(crate) shown: &'a mut [bool],
    /// Their means, row by row of blocks.
    pub(crate) means: &'a mut [T],
}

impl<T: Lane> PeripheryPlan<T> {
    /// The means of blocks side by side, from the sums of their columns.
    #[inline(always)]
    pub(crate) fn means(&self, columns: &[T::Sum], means: &mut [T]) {
        // The usual sizes as constants: then the loop is one of vectors.
        match self.side {
            1 => self.means_of::<1>(columns, means),
            2 => self.means_of::<2>(columns, means),
            4 => self.means_of::<4>(columns, means),
            8 => self.means_of::<8>(columns, means),
            16 => self.means_of::<16>(columns, means),
            side => {
                for (columns, mean) in columns.chunks_exact(side).zip(means) {
                    *mean = self.mean(columns);
                }
            }
        }
    }

    #[inline(always)]
    fn means_of<const SIDE: usize>(&self, columns: &[T::Sum], means: &mut [T]) {
        let columns = columns.as_chunks::<SIDE>().0;
        match self.shift {
            Some(shift) => {
                for (columns, mean) in columns.iter().zip(means) {
                    *mean = T::low((self.pixels / 2 + sum::<T>(columns)) >> shift);
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
    fn mean(&self, columns: &[T::Sum]) -> T {
        let sum = self.pixels / 2 + sum::<T>(columns);
        T::low(self.shift.map_or_else(|| sum / self.pixels, |shift| sum >> shift))
    }

    /// Decides which irrelevant regions of a band send their means. A region that is not affected is as it was, and what
    /// it shows is near enough.
    #[inline(always)]
    pub(crate) fn summarize(
        &self,
        now: Means<'_, T>,
        summaries: &mut Summaries<'_, T>,
        results: &mut Results<'_>,
    ) {
        let Means { means, differs, affected } = now;
        differs.fill(T::default());
        let rows = means.chunks_exact(differs.len());
        for (now, sent) in rows.zip(summaries.means.chunks_exact(differs.len())) {
            for ((now, sent), differs) in now.iter().zip(sent).zip(differs.iter_mut()) {
                *differs = (*differs).max(now.distance(*sent).minus(self.level));
            }
        }
        let regions = differs.chunks_exact(self.blocks).zip(affected).zip(&mut *summaries.shown);
        for (column, ((differs, &affected), shown)) in regions.enumerate() {
            *shown &= !results.active[column];
            let is_near = *shown && differs.iter().all(|&differs| differs == T::default());
            if results.srs[column] || !affected || is_near {
                continue;
            }
            let own = column * self.blocks..(column + 1) * self.blocks;
            let sent = summaries.means.chunks_exact_mut(results.srs.len() * self.blocks);
            for (now, sent) in means.chunks_exact(results.srs.len() * self.blocks).zip(sent) {
                sent[own.clone()].copy_from_slice(&now[own.clone()]);
            }
            *shown = true;
            results.actions[column] = Action::Summarize;
        }
    }

    /// Shows the means of a region of a band on the part of the screen that begins with it.
    #[inline(always)]
    pub(crate) fn show(
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

    /// Shows the means of blocks side by side in a row, the last of which may be cut off.
    #[inline(always)]
    fn show_row(&self, means: &[T], row: &mut [T]) {
        // The usual sizes as constants: a move in place of a call.
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
    let (whole, cut) = means.split_at(blocks.len().min(means.len()));
    for (block, &mean) in blocks.iter_mut().zip(whole) {
        *block = [mean; SIDE];
    }
    if let Some(&mean) = cut.first() {
        rest.fill(mean);
    }
}

/// The columns of a block, added up: at most 4096 pixels.
#[inline(always)]
fn sum<T: Lane>(columns: &[T::Sum]) -> u32 {
    columns.iter().map(|&column| -> u32 { column.into() }).sum()
}
