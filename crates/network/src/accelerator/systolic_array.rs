// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counts the cost of a layer on a systolic array, with the cycles of SCALE-Sim (Samajdar et al.,
//! ISPASS 2020).
//!
//! For each group, a layer is a product of a matrix of T positions by K inputs with a matrix of K
//! inputs by M channels. An array of R x C elements holds a part of it, a fold. A fold that fills
//! only a part of the array costs as much as a full one, so an array that is larger than a group of
//! channels is mostly idle: a depthwise layer has a fold for every channel.
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
//! A part has R positions in an output-stationary array. In a weight-stationary array it has as
//! many positions as the buffer holds sums for, so that no sum goes to the DRAM. Each further part
//! of the positions costs `2R + C - 2` cycles. SCALE-Sim does not cut the positions.

use crate::accelerator::computed_positions::ComputedPositions;
use crate::accelerator::configuration::{Accelerator, SystolicArray};
use crate::accelerator::cost::{LayerCounts, MemoryAccesses};
use crate::accelerator::layer::{ChannelGroups, Layer};

/// A layer as a product of matrices, once for each group.
struct MatrixProduct {
    /// The number of positions of all images.
    positions: u64,
    /// The number of inputs of a sum.
    inner: u64,
    /// The number of output channels of a group.
    channels: u64,
    groups: u64,
    /// The number of input values of all images that computed positions depend on, for one group.
    input_values: u64,
    /// The number of multiplications.
    macs: u64,
}

/// The number of parts that a layer is cut into.
struct ProductCuts {
    /// The number of parts of the output channels of a group.
    channels: u64,
    /// The number of parts of the positions.
    positions: u64,
    /// True if the inputs of a part of the positions fit into their buffer.
    part_fits: bool,
}

/// Counts the cycles and accesses of a layer on a weight-stationary array.
pub(crate) fn weight_stationary(
    accelerator: &Accelerator,
    array: &SystolicArray,
    layer: &Layer,
    products: &ChannelGroups,
    computed: &ComputedPositions<'_>,
) -> LayerCounts {
    let product = MatrixProduct::of(layer, products, computed);
    let (rows, columns) = (array.rows, array.columns);
    let row_folds = product.inner.div_ceil(rows);
    let sums = accelerator.sum_bytes(columns.min(product.channels));
    let positions_per_part = (array.output_bytes / sums).max(1);
    let cuts = ProductCuts {
        channels: product.channels.div_ceil(columns),
        positions: product.positions.div_ceil(positions_per_part),
        part_fits: share_fits(accelerator, array, layer, products, positions_per_part),
    };
    let folds = product.groups * cuts.channels * row_folds;
    let dram = product.dram_accesses(accelerator, array, &cuts);
    let weights = product.weights() * cuts.positions;
    let unfinished_sums = product.outputs() * 2 * (row_folds - 1);
    LayerCounts {
        array_cycles: folds * (cuts.positions * (2 * rows + columns - 2) + product.positions),
        macs: product.macs,
        register: MemoryAccesses { weights: weights + product.macs, ..MemoryAccesses::default() },
        array: MemoryAccesses {
            inputs: product.macs,
            sums: product.macs,
            ..MemoryAccesses::default()
        },
        buffer: MemoryAccesses {
            inputs: dram.inputs + product.streamed_inputs(&cuts),
            weights: dram.weights + weights,
            sums: unfinished_sums,
            outputs: 2 * product.outputs(),
        },
        dram,
    }
}

/// Counts the cycles and accesses of a layer on an output-stationary array.
pub(crate) fn output_stationary(
    accelerator: &Accelerator,
    array: &SystolicArray,
    layer: &Layer,
    products: &ChannelGroups,
    computed: &ComputedPositions<'_>,
) -> LayerCounts {
    let product = MatrixProduct::of(layer, products, computed);
    let (rows, columns) = (array.rows, array.columns);
    let cuts = ProductCuts {
        channels: product.channels.div_ceil(columns),
        positions: product.positions.div_ceil(rows),
        part_fits: share_fits(accelerator, array, layer, products, rows),
    };
    let folds = product.groups * cuts.channels * cuts.positions;
    let dram = product.dram_accesses(accelerator, array, &cuts);
    LayerCounts {
        array_cycles: folds * (product.inner + rows + columns - 2),
        macs: product.macs,
        register: MemoryAccesses { sums: 2 * product.macs, ..MemoryAccesses::default() },
        array: MemoryAccesses {
            inputs: product.macs,
            weights: product.macs,
            ..MemoryAccesses::default()
        },
        buffer: MemoryAccesses {
            inputs: dram.inputs + product.streamed_inputs(&cuts),
            weights: dram.weights + product.weights() * cuts.positions,
            sums: 0,
            outputs: 2 * product.outputs(),
        },
        dram,
    }
}

impl MatrixProduct {
    fn of(layer: &Layer, products: &ChannelGroups, computed: &ComputedPositions<'_>) -> Self {
        let rows = 0..layer.outputs.height;
        let positions = layer.images * computed.position_count(rows.clone());
        Self {
            positions,
            inner: layer.inputs_per_sum(products),
            channels: products.outputs,
            groups: products.groups,
            input_values: layer.images * computed.input_count(rows) * products.inputs,
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
    fn streamed_inputs(&self, cuts: &ProductCuts) -> u64 {
        self.groups * self.positions * self.inner * cuts.channels
    }

    /// Returns the accesses to the DRAM in the better of the two orders.
    fn dram_accesses(
        &self,
        accelerator: &Accelerator,
        array: &SystolicArray,
        cuts: &ProductCuts,
    ) -> MemoryAccesses {
        let weights_fit =
            |channels| accelerator.value_bytes(self.inner * channels) <= array.weight_bytes;
        let inputs_fit = accelerator.value_bytes(self.input_values) <= array.input_bytes;
        let once_if = |fits: bool, times_otherwise: u64| if fits { 1 } else { times_otherwise };
        let widest = array.columns.min(self.channels);
        let orders = [
            (once_if(inputs_fit, cuts.channels), once_if(weights_fit(widest), cuts.positions)),
            (
                once_if(cuts.part_fits, cuts.channels),
                once_if(weights_fit(self.channels), cuts.positions),
            ),
        ];
        let traffic = orders.map(|(inputs, weights)| MemoryAccesses {
            inputs: self.groups * self.input_values * inputs,
            weights: self.weights() * weights,
            sums: 0,
            outputs: self.outputs(),
        });
        let [channels_outside, positions_outside] = traffic;
        if positions_outside.access_count() < channels_outside.access_count() {
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
    array: &SystolicArray,
    layer: &Layer,
    products: &ChannelGroups,
    positions: u64,
) -> bool {
    let all = layer.images * layer.outputs.positions();
    let inputs = layer.images * layer.inputs.positions() * products.inputs;
    let inputs_of_share =
        (u128::from(inputs) * u128::from(positions.min(all))).div_ceil(all.into());
    inputs_of_share * u128::from(accelerator.value_bits) <= u128::from(array.input_bytes) * 8
}
