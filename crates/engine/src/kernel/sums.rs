// SPDX-License-Identifier: MIT OR Apache-2.0
//! Column sums of pixels and of their squares, and the sums of columns by region.

use std::ops::Range;

use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// Adds every pixel to the sum of its column.
#[inline(always)]
pub(crate) fn add_to_columns<T: VectorPixel>(
    pixels: &[Block<T>],
    sums: &mut [Block<T::ColumnSum>],
) {
    for (pixels, sums) in pixels.iter().zip(sums) {
        for i in 0..BLOCK_LENGTH {
            sums[i] += T::ColumnSum::from(pixels[i]);
        }
    }
}

/// Computes the column sums of some rows of a plane. `plane` begins at the first column of `sums`.
#[inline(always)]
pub(crate) fn add_rows<T: VectorPixel>(
    plane: &[T],
    stride: usize,
    rows: Range<usize>,
    sums: &mut [Block<T::ColumnSum>],
) {
    for (at, sums) in sums.iter_mut().enumerate() {
        // The sums stay in registers over all rows.
        let mut own = [T::ColumnSum::default(); BLOCK_LENGTH];
        for row in rows.clone() {
            if let Some(pixels) =
                plane[row * stride + at * BLOCK_LENGTH..].first_chunk::<BLOCK_LENGTH>()
            {
                for i in 0..BLOCK_LENGTH {
                    own[i] += T::ColumnSum::from(pixels[i]);
                }
            }
        }
        *sums = own;
    }
}

/// Adds the square of every pixel to the sum of its column.
#[inline(always)]
pub(crate) fn add_squares<T: VectorPixel>(pixels: &[Block<T>], sums: &mut [Block<T::SquareSum>]) {
    for (pixels, sums) in pixels.iter().zip(sums) {
        for i in 0..BLOCK_LENGTH {
            sums[i] += pixels[i].square();
        }
    }
}

/// Adds up the columns of every region. A region has `side` columns.
#[inline(always)]
pub(crate) fn sum_by_region<V: Copy + Into<u64>>(columns: &[V], side: usize, regions: &mut [u64]) {
    // The small sizes are constants, so that the inner loop has no counter.
    match side {
        4 => by_constant::<4, V>(columns, regions),
        8 => by_constant::<8, V>(columns, regions),
        16 => by_constant::<16, V>(columns, regions),
        _ => {
            for (columns, region) in columns.chunks_exact(side).zip(regions) {
                *region = columns.iter().map(|&column| column.into()).sum();
            }
        }
    }
}

#[inline(always)]
fn by_constant<const SIDE: usize, V: Copy + Into<u64>>(columns: &[V], regions: &mut [u64]) {
    for (columns, region) in columns.as_chunks::<SIDE>().0.iter().zip(regions) {
        *region = columns.iter().map(|&column| column.into()).sum();
    }
}

/// Writes a value of each region into all of its columns. `value` gets the number of the region in
/// its band, and the region's number of `regions`.
#[inline(always)]
pub(crate) fn spread_over_columns<T: Copy>(
    regions: &[u64],
    side: usize,
    value: impl Fn(usize, u64) -> T,
    columns: &mut [T],
) {
    match side {
        8 => spread_constant::<8, T>(regions, value, columns),
        16 => spread_constant::<16, T>(regions, value, columns),
        _ => {
            for (at, (columns, &region)) in columns.chunks_exact_mut(side).zip(regions).enumerate()
            {
                columns.fill(value(at, region));
            }
        }
    }
}

#[inline(always)]
fn spread_constant<const SIDE: usize, T: Copy>(
    regions: &[u64],
    value: impl Fn(usize, u64) -> T,
    columns: &mut [T],
) {
    let regions = columns.as_chunks_mut::<SIDE>().0.iter_mut().zip(regions);
    for (at, (columns, &region)) in regions.enumerate() {
        *columns = [value(at, region); SIDE];
    }
}
