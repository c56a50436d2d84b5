// SPDX-License-Identifier: MIT OR Apache-2.0
//! `flow`: the sums of differences between the regions of a band and their references, displaced,
//! and the choice of the best displacement.

use std::ops::Range;

use foveate_camera::Displacement;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// A displacement and its errors by region.
#[derive(Clone, Debug)]
pub(crate) struct DisplacedErrors {
    pub(crate) displacement: Displacement,
    /// The number of pixels of a region whose partner lies in the region too.
    pairs: u64,
    /// The sum of differences of each region of the band.
    pub(crate) errors: Vec<u64>,
}

impl DisplacedErrors {
    /// Makes one entry per displacement, in the order of preference, for bands of `columns`
    /// regions.
    pub(crate) fn for_search(radius: u32, side: u32, columns: usize) -> Vec<Self> {
        let entry = |displacement: Displacement| Self {
            displacement,
            pairs: displacement.pixel_pairs(side),
            errors: vec![0; columns],
        };
        Displacement::search_order(radius).into_iter().map(entry).collect()
    }
}

/// Returns the lines of a region, or the columns, whose partner exists: the partner lies `shift`
/// before them.
pub(crate) fn paired_range(side: usize, shift: i8) -> Range<usize> {
    let by = usize::from(shift.unsigned_abs());
    if shift < 0 { 0..side - by } else { by..side }
}

#[inline(always)]
pub(crate) fn add_differences<T: VectorPixel>(
    row: &[Block<T>],
    partners: &[Block<T>],
    sums: &mut [Block<T::ColumnSum>],
) {
    for ((row, partners), sums) in row.iter().zip(partners).zip(sums) {
        for i in 0..BLOCK_LENGTH {
            sums[i] += T::ColumnSum::from(row[i].absolute_difference(partners[i]));
        }
    }
}

/// Adds up the columns of every region that have a partner in it.
#[inline(always)]
pub(crate) fn sum_paired_columns<V: Copy + Into<u64>>(
    columns: &[V],
    side: usize,
    shift: i8,
    regions: &mut [u64],
) {
    let paired = paired_range(side, shift);
    for (columns, region) in columns.chunks_exact(side).zip(regions) {
        *region = columns[paired.clone()].iter().map(|&column| column.into()).sum();
    }
}

/// Returns the best displacement of a region and its score.
pub(crate) fn best_match(search: &[DisplacedErrors], region: usize) -> (Displacement, u64) {
    let Some(still) = search.first() else { return (Displacement::default(), 0) };
    let mut best = still;
    for next in search {
        if next.errors[region] * best.pairs < best.errors[region] * next.pairs {
            best = next;
        }
    }
    let gain = still.errors[region] * best.pairs - best.errors[region] * still.pairs;
    (best.displacement, gain / best.pairs)
}
