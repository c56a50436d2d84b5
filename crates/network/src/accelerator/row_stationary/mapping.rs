// SPDX-License-Identifier: MIT OR Apache-2.0
//! Chooses the part of a layer that runs at once in a row-stationary array.

use super::{ComputedStrip, MappingCuts, count_strips};
use crate::accelerator::computed_positions::ComputedPositions;
use crate::accelerator::configuration::{Accelerator, MappingObjective, RowStationaryArray};
use crate::accelerator::cost::LayerCounts;
use crate::accelerator::layer::{ChannelGroups, Layer};
use crate::accelerator::{AcceleratorError, LayerCost};

/// The part of a layer that runs at once, and the values that the buffer keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PassMapping {
    /// The number of rows of the output.
    pub(crate) strip: u64,
    /// The number of filters in an element.
    pub(crate) filters: u64,
    /// The number of channels in an element.
    pub(crate) channels: u64,
    /// The number of sets of elements with different filters.
    pub(crate) filter_sets: u64,
    /// The number of sets of elements with different channels.
    pub(crate) channel_sets: u64,
    /// The number of filters whose sums the buffer keeps.
    pub(crate) kept_filters: u64,
    /// The number of images that share a load of weights.
    pub(crate) images: u64,
}

/// A kernel in parts that fit into the array and its elements.
#[derive(Clone, Copy, Debug)]
struct KernelParts {
    rows: u64,
    columns: u64,
    count: u64,
}

impl KernelParts {
    fn of(array: &RowStationaryArray, layer: &Layer) -> Self {
        let [down, across] = layer.windows.map(|window| window.kernel);
        let row_parts = down.div_ceil(array.rows);
        let column_parts = across.div_ceil(array.element_inputs);
        // The parts are about equal, so that the last one is not much smaller than the others.
        Self {
            rows: down.div_ceil(row_parts),
            columns: across.div_ceil(column_parts),
            count: row_parts * column_parts,
        }
    }
}

impl PassMapping {
    /// Returns the parts into which this mapping cuts a group.
    pub(crate) fn cuts(
        &self,
        array: &RowStationaryArray,
        layer: &Layer,
        products: &ChannelGroups,
    ) -> MappingCuts {
        let parts = KernelParts::of(array, layer);
        let (filters, channels) =
            (self.filters * self.filter_sets, self.channels * self.channel_sets);
        let weights = filters * channels * parts.rows * parts.columns;
        MappingCuts {
            kept_parts: products.outputs.div_ceil(self.kept_filters),
            filters: products.outputs.div_ceil(filters),
            channels: products.inputs.div_ceil(channels) * parts.count,
            images: layer.images.div_ceil(self.images),
            loading_cycles: weights.div_ceil(array.weights_per_cycle),
            cycles_per_position: parts.columns * self.filters * self.channels,
            sums: filters,
            inputs: channels,
            inputs_per_cycle: array.inputs_per_cycle,
            sums_per_cycle: array.sums_per_cycle,
        }
    }
}

/// Returns the mapping that is best for its objective on a whole layer.
pub(crate) fn best_mapping(
    accelerator: &Accelerator,
    array: &RowStationaryArray,
    layer: &Layer,
    products: &ChannelGroups,
) -> Result<PassMapping, AcceleratorError> {
    let parts = KernelParts::of(array, layer);
    let whole = ComputedPositions::all(layer);
    let mut best: Option<([f64; 2], PassMapping)> = None;
    let mut needed = u64::MAX;
    for strip in strip_heights(layer.outputs.height, array, parts) {
        let strips = ComputedStrip::all(layer, strip, &whole);
        let capacity = BufferCapacity::of(accelerator, array, &strips);
        needed = needed.min(capacity.needed_bytes(1, 1, 1));
        for pass in possible_passes(array, layer, products, parts, strip) {
            let Some(mapping) = capacity.with_most_kept(pass, products) else { continue };
            let counts = count_strips(array, layer, products, &mapping, &strips);
            let objective = objective_values(accelerator, array.mapping, &counts);
            if best.as_ref().is_none_or(|(least, _)| objective < *least) {
                best = Some((objective, mapping));
            }
        }
    }
    let too_small = AcceleratorError::BufferTooSmall { buffer: array.buffer_bytes, needed };
    best.map(|(_, mapping)| mapping).ok_or(too_small)
}

/// Returns the numbers to minimize. The second one decides if the first ones are equal.
#[allow(clippy::cast_precision_loss, reason = "compared, not counted")]
fn objective_values(
    accelerator: &Accelerator,
    objective: MappingObjective,
    counts: &LayerCounts,
) -> [f64; 2] {
    match objective {
        MappingObjective::LeastDram => {
            [counts.dram.access_count() as f64, counts.array_cycles as f64]
        }
        MappingObjective::LeastEnergyDelay => {
            let cost = LayerCost::from_counts(counts, accelerator);
            [cost.energy.total() * cost.cycles as f64, cost.cycles as f64]
        }
    }
}

/// Returns the heights of strips that can run at once. If several heights need the same number of
/// strips, only the lowest is returned.
fn strip_heights(
    height: u64,
    array: &RowStationaryArray,
    parts: KernelParts,
) -> impl Iterator<Item = u64> {
    let most = (array.rows / parts.rows * array.columns).min(height);
    (1..=most).filter(move |&strip| strip == height.div_ceil(height.div_ceil(strip)))
}

/// Returns the number of sets of elements that fit into the array. A set that is wider than the
/// array continues below.
fn set_count(array: &RowStationaryArray, parts: KernelParts, strip: u64) -> u64 {
    let sets_per_column = array.rows / parts.rows;
    if strip <= array.columns {
        sets_per_column * (array.columns / strip)
    } else {
        sets_per_column / strip.div_ceil(array.columns)
    }
}

/// Returns the passes that fit into the array and its elements, without the number of filters that
/// the buffer keeps.
fn possible_passes(
    array: &RowStationaryArray,
    layer: &Layer,
    products: &ChannelGroups,
    parts: KernelParts,
    strip: u64,
) -> Vec<PassMapping> {
    let sets = set_count(array, parts, strip);
    // Several numbers of filter sets can leave room for the same number of channel sets. Only the
    // largest of them is tried.
    let all_filter_sets = (1..=sets).filter(|&filters| filters == sets / (sets / filters));
    let mut all = Vec::new();
    for filter_sets in all_filter_sets.filter(|&filters| filters <= products.outputs) {
        for channels in 1..=(array.element_inputs / parts.columns).min(products.inputs) {
            let channel_sets = (sets / filter_sets).min(products.inputs.div_ceil(channels));
            let most = (array.element_weights / (channels * parts.columns))
                .min(array.element_sums)
                .min(products.outputs);
            for filters in 1..=most {
                // Several numbers of images can need the same number of parts. Only the smallest of
                // them is tried.
                let images = (1..=layer.images).filter(|&images| {
                    images == layer.images.div_ceil(layer.images.div_ceil(images))
                });
                all.extend(images.map(|images| PassMapping {
                    strip,
                    filters,
                    channels,
                    filter_sets,
                    channel_sets,
                    kept_filters: 0,
                    images,
                }));
            }
        }
    }
    all
}

/// The capacity of the buffer of inputs and sums.
struct BufferCapacity<'a> {
    accelerator: &'a Accelerator,
    bytes: u64,
    /// The number of inputs of a channel and an image, in the strip with the most inputs.
    inputs: u64,
    /// The number of sums of a filter and an image, in the strip with the most sums.
    sums: u64,
}

impl<'a> BufferCapacity<'a> {
    fn of(
        accelerator: &'a Accelerator,
        array: &RowStationaryArray,
        strips: &[ComputedStrip],
    ) -> Self {
        let largest =
            |size: fn(&ComputedStrip) -> u64| strips.iter().map(size).max().unwrap_or_default();
        Self {
            accelerator,
            bytes: array.buffer_bytes,
            inputs: largest(|strip| strip.inputs),
            sums: largest(|strip| strip.positions),
        }
    }

    fn needed_bytes(&self, channels: u64, filters: u64, images: u64) -> u64 {
        images
            * (self.accelerator.value_bytes(channels * self.inputs)
                + self.accelerator.sum_bytes(filters * self.sums))
    }

    /// Returns the pass with as many kept filters as the buffer can hold; `None` if it cannot hold
    /// those of one pass.
    fn with_most_kept(&self, pass: PassMapping, products: &ChannelGroups) -> Option<PassMapping> {
        let filters_at_once = pass.filters * pass.filter_sets;
        let channels = pass.channels * pass.channel_sets;
        let fits = |passes: u64| {
            self.needed_bytes(channels, passes * filters_at_once, pass.images) <= self.bytes
        };
        let all_passes = products.outputs.div_ceil(filters_at_once);
        let input_bytes = self.needed_bytes(channels, 0, pass.images);
        let bytes_per_pass = self.needed_bytes(0, filters_at_once, pass.images);
        // Rounding up to bytes can make the quotient one too large or too small.
        let estimate = (self.bytes.saturating_sub(input_bytes) / bytes_per_pass).min(all_passes);
        let passes = [estimate + 1, estimate, estimate.saturating_sub(1)]
            .into_iter()
            .find(|&passes| (1..=all_passes).contains(&passes) && fits(passes))?;
        Some(PassMapping { kept_filters: passes * filters_at_once, ..pass })
    }
}
