// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counts the cost of a layer on a systolic array, with the cycles of SCALE-Sim (Samajdar et al.,
//! ISPASS 2020).
//!
//! For each group, a layer is a product of a matrix of T positions by K inputs with a matrix of K
//! inputs by M channels. An array of R x C elements holds a part of it, a fold. A part of a fold
//! costs as much as a whole one, so an array that is larger than a group of channels is mostly
//! idle: a depthwise layer has a fold for every channel.
//!
//! Inputs and weights are fetched once from the DRAM if their buffer holds them. Otherwise those of
//! one kind are fetched again for each part of the other kind. There are two orders, and the one
//! with less traffic is used:
//!
//! * Channels are the outer loop: for each C channels, all positions are computed. Weights are
//!   fetched once if those of C channels fit.
//! * Positions are the outer loop: for each part of the positions, all channels are computed.
//!   Inputs are fetched once if those of a part fit.
//!
//! A part of the positions is R of them in an output-stationary array. In a weight-stationary one
//! it is as many as the buffer holds sums of, so that no sum goes to the DRAM. Cutting the
//! positions costs `2R + C - 2` cycles for each further part; SCALE-Sim does not cut them.

use crate::accelerator::{Accelerator, Systolic};
use crate::computed::Computed;
use crate::cost::{Counts, Traffic};
use crate::layer::{Layer, Products};

/// A layer as a product of matrices, once for each group.
struct Product {
    /// The number of positions of all images.
    positions: u64,
    /// The number of inputs of a sum.
    inner: u64,
    /// The number of output channels of a group.
    channels: u64,
    groups: u64,
    /// The number of input values of all images that computed positions depend on, for one group.
    seen: u64,
    /// The number of multiplications.
    macs: u64,
}

/// The number of parts that a layer is cut into.
struct Cuts {
    /// The number of parts of the output channels of a group.
    channels: u64,
    /// The number of parts of the positions.
    positions: u64,
    /// Whether the inputs of a part of the positions fit into their buffer.
    part_fits: bool,
}

/// Counts the cycles and accesses of a layer on a weight-stationary array.
pub(crate) fn weight_stationary(
    accelerator: &Accelerator,
    array: &Systolic,
    layer: &Layer,
    products: &Products,
    computed: &Computed<'_>,
) -> Counts {
    let product = Product::of(layer, products, computed);
    let (rows, columns) = (array.rows, array.columns);
    let row_folds = product.inner.div_ceil(rows);
    let sums = accelerator.sum_bytes(columns.min(product.channels));
    let part = (array.output_bytes / sums).max(1);
    let cuts = Cuts {
        channels: product.channels.div_ceil(columns),
        positions: product.positions.div_ceil(part),
        part_fits: share_fits(accelerator, array, layer, products, part),
    };
    let folds = product.groups * cuts.channels * row_folds;
    let dram = product.dram(accelerator, array, &cuts);
    let weights = product.weights() * cuts.positions;
    let unfinished = product.outputs() * 2 * (row_folds - 1);
    Counts {
        array_cycles: folds * (cuts.positions * (2 * rows + columns - 2) + product.positions),
        macs: product.macs,
        register: Traffic { weights: weights + product.macs, ..Traffic::default() },
        array: Traffic { inputs: product.macs, sums: product.macs, ..Traffic::default() },
        buffer: Traffic {
            inputs: dram.inputs + product.streamed(&cuts),
            weights: dram.weights + weights,
            sums: unfinished,
            outputs: 2 * product.outputs(),
        },
        dram,
    }
}

/// Counts the cycles and accesses of a layer on an output-stationary array.
pub(crate) fn output_stationary(
    accelerator: &Accelerator,
    array: &Systolic,
    layer: &Layer,
    products: &Products,
    computed: &Computed<'_>,
) -> Counts {
    let product = Product::of(layer, products, computed);
    let (rows, columns) = (array.rows, array.columns);
    let cuts = Cuts {
        channels: product.channels.div_ceil(columns),
        positions: product.positions.div_ceil(rows),
        part_fits: share_fits(accelerator, array, layer, products, rows),
    };
    let folds = product.groups * cuts.channels * cuts.positions;
    let dram = product.dram(accelerator, array, &cuts);
    Counts {
        array_cycles: folds * (product.inner + rows + columns - 2),
        macs: product.macs,
        register: Traffic { sums: 2 * product.macs, ..Traffic::default() },
        array: Traffic { inputs: product.macs, weights: product.macs, ..Traffic::default() },
        buffer: Traffic {
            inputs: dram.inputs + product.streamed(&cuts),
            weights: dram.weights + product.weights() * cuts.positions,
            sums: 0,
            outputs: 2 * product.outputs(),
        },
        dram,
    }
}

impl Product {
    fn of(layer: &Layer, products: &Products, computed: &Computed<'_>) -> Self {
        let rows = 0..layer.outputs.height;
        let positions = layer.images * computed.positions(rows.clone());
        Self {
            positions,
            inner: layer.inputs_per_sum(products),
            channels: products.outputs,
            groups: products.groups,
            seen: layer.images * computed.inputs(rows) * products.inputs,
            macs: positions * layer.macs_per_position(),
        }
    }

    fn weights(&self) -> u64 {
        self.groups * self.inner * self.channels
    }

    fn outputs(&self) -> u64 {
        self.positions * self.groups * self.channels
    }

    /// Returns the number of inputs that enter the array: those of each position, once for each
    /// part of the channels.
    fn streamed(&self, cuts: &Cuts) -> u64 {
        self.groups * self.positions * self.inner * cuts.channels
    }

    /// Returns the accesses to the DRAM in the better of the two orders.
    fn dram(&self, accelerator: &Accelerator, array: &Systolic, cuts: &Cuts) -> Traffic {
        let weights_fit =
            |channels| accelerator.value_bytes(self.inner * channels) <= array.weight_bytes;
        let inputs_fit = accelerator.value_bytes(self.seen) <= array.input_bytes;
        let once_if = |fits: bool, else_times: u64| if fits { 1 } else { else_times };
        let widest = array.columns.min(self.channels);
        let orders = [
            (once_if(inputs_fit, cuts.channels), once_if(weights_fit(widest), cuts.positions)),
            (
                once_if(cuts.part_fits, cuts.channels),
                once_if(weights_fit(self.channels), cuts.positions),
            ),
        ];
        let traffic = orders.map(|(inputs, weights)| Traffic {
            inputs: self.groups * self.seen * inputs,
            weights: self.weights() * weights,
            sums: 0,
            outputs: self.outputs(),
        });
        let [channels_outside, positions_outside] = traffic;
        if positions_outside.accesses() < channels_outside.accesses() {
            positions_outside
        } else {
            channels_outside
        }
    }
}

/// Returns whether the buffer holds the inputs of this number of positions if all positions are
/// computed. The result does not depend on a mask, so that a smaller mask never costs more.
fn share_fits(
    accelerator: &Accelerator,
    array: &Systolic,
    layer: &Layer,
    products: &Products,
    positions: u64,
) -> bool {
    let all = layer.images * layer.outputs.positions();
    let inputs = layer.images * layer.inputs.positions() * products.inputs;
    let share = (u128::from(inputs) * u128::from(positions.min(all))).div_ceil(all.into());
    share * u128::from(accelerator.value_bits) <= u128::from(array.input_bytes) * 8
}
