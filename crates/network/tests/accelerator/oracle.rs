// SPDX-License-Identifier: MIT OR Apache-2.0
//! Simulates a systolic array element by element and clock by clock, and masks position by
//! position. This code follows drawings of such arrays, and does not use the formulas of the model.

use std::collections::BTreeSet;

/// The counts of a simulated array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SimulatedCounts {
    /// The number of clocks, counted from 1.
    pub(crate) clocks: u64,
    pub(crate) macs: u64,
    /// The number of inputs that entered the first column.
    pub(crate) inputs: u64,
    /// The number of weights that entered the array.
    pub(crate) weights: u64,
}

/// Simulates the product of `positions` x `inner` and `inner` x `channels`, with weights held in
/// the array.
pub(crate) fn weight_stationary(
    [rows, columns]: [u64; 2],
    positions: u64,
    inner: u64,
    channels: u64,
) -> SimulatedCounts {
    let mut counts = SimulatedCounts::default();
    for first_channel in (0..channels).step_by(size(columns)) {
        for first_inner in (0..inner).step_by(size(rows)) {
            let mut last = 0;
            // A row of weights enters per clock, until the array is full.
            let begin = counts.clocks + rows;
            for row in 0..rows {
                for column in 0..columns {
                    let has_weight = first_inner + row < inner && first_channel + column < channels;
                    counts.weights += u64::from(has_weight);
                    for position in 0..positions {
                        // An input enters each row one clock later than the row above, and advances
                        // by a column per clock.
                        let clock = begin + position + row + column;
                        last = last.max(clock);
                        counts.macs += u64::from(has_weight);
                        let enters = column == 0 && first_inner + row < inner;
                        counts.inputs += u64::from(enters);
                    }
                }
            }
            counts.clocks = last + 1;
        }
    }
    counts
}

/// Simulates the same product, with sums held in the array.
pub(crate) fn output_stationary(
    [rows, columns]: [u64; 2],
    positions: u64,
    inner: u64,
    channels: u64,
) -> SimulatedCounts {
    let mut counts = SimulatedCounts::default();
    for first_channel in (0..channels).step_by(size(columns)) {
        for first_position in (0..positions).step_by(size(rows)) {
            let (begin, mut last) = (counts.clocks, 0);
            for row in 0..rows {
                for column in 0..columns {
                    let has_position = first_position + row < positions;
                    let has_channel = first_channel + column < channels;
                    for tap in 0..inner {
                        // An input and a weight meet after they have passed the previous rows and
                        // columns.
                        last = last.max(begin + tap + row + column);
                        counts.macs += u64::from(has_position && has_channel);
                        counts.inputs += u64::from(column == 0 && has_position);
                        counts.weights += u64::from(row == 0 && has_channel);
                    }
                }
            }
            counts.clocks = last + 1;
        }
    }
    counts
}

fn size(value: u64) -> usize {
    usize::try_from(value).unwrap()
}

/// The kernel, stride, dilation and padding of one axis.
pub(crate) type AxisWindow = [u64; 4];

/// Returns the inputs that computed outputs depend on. A position is a row and a column.
pub(crate) fn needed_inputs(
    computed: &BTreeSet<[u64; 2]>,
    axes: [AxisWindow; 2],
    inputs: [u64; 2],
) -> BTreeSet<[u64; 2]> {
    let inputs_of_output = |axis: usize, output: u64| -> Vec<u64> {
        let [kernel, stride, dilation, padding_before] =
            axes[axis].map(|n| i64::try_from(n).unwrap());
        let output = i64::try_from(output).unwrap();
        let all = (0..kernel).map(|tap| output * stride - padding_before + tap * dilation);
        let inside = all.filter_map(|input| u64::try_from(input).ok());
        inside.filter(|&input| input < inputs[axis]).collect()
    };
    let mut needed = BTreeSet::new();
    for &[row, column] in computed {
        for y in inputs_of_output(0, row) {
            needed.extend(inputs_of_output(1, column).into_iter().map(|x| [y, x]));
        }
    }
    needed
}

/// Returns the positions whose tile has a needed one.
pub(crate) fn round_up_to_tiles(
    needed: &BTreeSet<[u64; 2]>,
    [height, width]: [u64; 2],
    tile: [u64; 2],
) -> BTreeSet<[u64; 2]> {
    let tile_of = |[row, column]: [u64; 2]| [row / tile[0], column / tile[1]];
    let active: BTreeSet<[u64; 2]> = needed.iter().copied().map(tile_of).collect();
    let all = (0..height).flat_map(|row| (0..width).map(move |column| [row, column]));
    all.filter(|&position| active.contains(&tile_of(position))).collect()
}
