// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counts the cost of a layer on a row-stationary array, as in Eyeriss (Chen et al., ISCA 2016 and
//! JSSC 2017).
//!
//! An element convolves one row of inputs with one row of weights. A *set* of elements, as high as
//! the kernel, computes a *strip* of `strip` rows of the output, one per column of elements: inputs
//! pass through it along diagonals, sums upwards. The part of a layer that runs at once is a
//! *pass*: `filters` filters and `channels` channels in each element, `filter_sets` times as many
//! filters and `channel_sets` times as many channels in several sets. The buffer keeps the inputs
//! of a pass, and the unfinished sums of `kept_filters` filters of a strip, for `images` images.
//!
//! There is a pass for each `kept_filters` filters, each strip, each part of the channels, and each
//! `filters * filter_sets` filters. With L the number of computed positions of the strip's longest
//! row, a pass takes:
//!
//! * the cycles that load its weights at `weights_per_cycle`, once for `images` images; the array
//!   waits for them;
//! * for each image, the longest of these: `L * columns of the kernel * filters * channels`
//!   multiplications in an element, its inputs at `inputs_per_cycle`, and its sums at
//!   `sums_per_cycle` (sums enter and leave in the same cycle).
//!
//! A strip without a computed position is left out. The strips of a layer are the same for every
//! mask.
//!
//! The mapping is chosen for the whole layer and is the same for every mask, so a mask never costs
//! more than a larger one.

mod mapping;

pub(crate) use mapping::{PassMapping, best_mapping};

use crate::accelerator::computed_positions::ComputedPositions;
use crate::accelerator::configuration::RowStationaryArray;
use crate::accelerator::cost::{LayerCounts, MemoryAccesses};
use crate::accelerator::layer::{ChannelGroups, Layer};
use std::ops::Range;

/// The computed part of a strip in one image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ComputedStrip {
    /// The number of computed positions of the output.
    positions: u64,
    /// The number of computed positions in the row with the most of them.
    longest: u64,
    /// The number of input positions that the computed positions depend on.
    inputs: u64,
}

impl ComputedStrip {
    /// Returns the strips with at least one computed position.
    fn all(layer: &Layer, height: u64, computed: &ComputedPositions<'_>) -> Vec<Self> {
        let rows = layer.outputs.height;
        (0..rows.div_ceil(height))
            .map(|at| Self::of(computed, at * height..((at + 1) * height).min(rows)))
            .filter(|strip| strip.positions > 0)
            .collect()
    }

    fn of(computed: &ComputedPositions<'_>, rows: Range<u64>) -> Self {
        Self {
            positions: computed.position_count(rows.clone()),
            longest: computed.longest_row(rows.clone()),
            inputs: computed.input_count(rows),
        }
    }
}

/// Counts the cycles and accesses of a layer.
pub(crate) fn count_layer(
    array: &RowStationaryArray,
    layer: &Layer,
    products: &ChannelGroups,
    mapping: &PassMapping,
    computed: &ComputedPositions<'_>,
) -> LayerCounts {
    count_strips(
        array,
        layer,
        products,
        mapping,
        &ComputedStrip::all(layer, mapping.strip, computed),
    )
}

fn count_strips(
    array: &RowStationaryArray,
    layer: &Layer,
    products: &ChannelGroups,
    mapping: &PassMapping,
    strips: &[ComputedStrip],
) -> LayerCounts {
    let cuts = mapping.cuts(array, layer, products);
    let dram = dram_accesses(layer, products, strips, &cuts);
    let positions: u64 = strips.iter().map(|strip| strip.positions).sum();
    let inputs: u64 = strips.iter().map(|strip| strip.inputs).sum();
    let (images, groups) = (layer.images, products.groups);
    let macs = images * positions * layer.macs_per_position();
    let sums = images * positions * groups * products.outputs;
    let kernel_rows = layer.windows[0].kernel;
    LayerCounts {
        array_cycles: strips.iter().map(|strip| strip_cycles(layer, products, strip, &cuts)).sum(),
        macs,
        // In each multiplication an element reads an input, a weight and a sum, and writes the sum.
        register: MemoryAccesses { inputs: macs, weights: macs, sums: 2 * macs, outputs: 0 },
        array: MemoryAccesses {
            // An element uses an input for every filter and every column of the kernel, or for
            // fewer columns if the stride is larger than 1.
            inputs: images
                * positions
                * groups
                * products.inputs
                * kernel_rows
                * layer.windows[1].stride.min(layer.windows[1].kernel)
                * products.outputs.div_ceil(mapping.filters),
            weights: dram.weights * mapping.strip,
            sums: sums * kernel_rows * products.inputs.div_ceil(mapping.channels),
            outputs: 0,
        },
        buffer: MemoryAccesses {
            inputs: dram.inputs + images * groups * products.inputs * inputs * cuts.filters,
            // Weights do not pass through the buffer of inputs and sums, but through one that only
            // holds the next weights.
            weights: 2 * dram.weights,
            sums: sums * 2 * (cuts.channels - 1),
            outputs: 2 * sums,
        },
        dram,
    }
}

/// The number of parts that a group is cut into, and the largest amounts of a pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MappingCuts {
    /// The number of parts of the filters whose sums are kept.
    kept_parts: u64,
    /// The number of parts of the filters that run at once.
    filters: u64,
    /// The number of parts of the channels, and of a kernel that is larger than the array.
    channels: u64,
    /// The number of parts of the images.
    images: u64,
    /// The cycles in which a pass loads its weights.
    loading_cycles: u64,
    /// The cycles of a position in an element.
    cycles_per_position: u64,
    /// The number of sums of a position.
    sums: u64,
    /// The number of channels of a pass.
    inputs: u64,
    inputs_per_cycle: u64,
    sums_per_cycle: u64,
}

/// Returns the cycles of all passes of a strip.
fn strip_cycles(
    layer: &Layer,
    products: &ChannelGroups,
    strip: &ComputedStrip,
    cuts: &MappingCuts,
) -> u64 {
    let busy = strip.longest * cuts.cycles_per_position;
    let inputs = (strip.inputs * cuts.inputs).div_ceil(cuts.inputs_per_cycle);
    let sums = (strip.positions * cuts.sums).div_ceil(cuts.sums_per_cycle);
    let pass = layer.images * busy.max(inputs).max(sums) + cuts.images * cuts.loading_cycles;
    products.groups * cuts.filters * cuts.channels * pass
}

/// Returns the accesses to the DRAM. Inputs are read once for each `kept_filters` filters, weights
/// once for each strip, and outputs are written once.
fn dram_accesses(
    layer: &Layer,
    products: &ChannelGroups,
    strips: &[ComputedStrip],
    cuts: &MappingCuts,
) -> MemoryAccesses {
    let inputs: u64 = strips.iter().map(|strip| strip.inputs).sum();
    let positions: u64 = strips.iter().map(|strip| strip.positions).sum();
    MemoryAccesses {
        inputs: layer.images * products.groups * products.inputs * inputs * cuts.kept_parts,
        weights: layer.weights() * strips.len() as u64 * cuts.images,
        sums: 0,
        outputs: layer.images * layer.outputs.channels * positions,
    }
}
