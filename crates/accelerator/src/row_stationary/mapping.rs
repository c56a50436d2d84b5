// SPDX-License-Identifier: MIT OR Apache-2.0
//! Chooses the part of a layer that runs at once in a row-stationary array.

use super::{Cuts, Strip, count_strips};
use crate::accelerator::{Accelerator, Objective, RowStationary};
use crate::computed::Computed;
use crate::cost::Counts;
use crate::layer::{Layer, Products};
use crate::{AcceleratorError, Cost};

/// The part of a layer that runs at once, and the values that the buffer keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mapping {
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
    pub(crate) kept: u64,
    /// The number of images that share a load of weights.
    pub(crate) images: u64,
}

/// A kernel in parts that fit into the array and its elements.
#[derive(Clone, Copy, Debug)]
struct Parts {
    /// The number of rows of a part.
    rows: u64,
    /// The number of columns of a part.
    columns: u64,
    /// The number of parts.
    count: u64,
}

impl Parts {
    fn of(array: &RowStationary, layer: &Layer) -> Self {
        let [down, across] = layer.windows.map(|window| window.kernel);
        let (below, beside) = (down.div_ceil(array.rows), across.div_ceil(array.element_inputs));
        Self { rows: down.div_ceil(below), columns: across.div_ceil(beside), count: below * beside }
    }
}

impl Mapping {
    /// Returns the parts into which this mapping cuts a group.
    pub(crate) fn cuts(&self, array: &RowStationary, layer: &Layer, products: &Products) -> Cuts {
        let parts = Parts::of(array, layer);
        let (filters, channels) =
            (self.filters * self.filter_sets, self.channels * self.channel_sets);
        let weights = filters * channels * parts.rows * parts.columns;
        Cuts {
            kept: products.outputs.div_ceil(self.kept),
            filters: products.outputs.div_ceil(filters),
            channels: products.inputs.div_ceil(channels) * parts.count,
            images: layer.images.div_ceil(self.images),
            loading: weights.div_ceil(array.weights_per_cycle),
            busy: parts.columns * self.filters * self.channels,
            sums: filters,
            inputs: channels,
            inputs_per_cycle: array.inputs_per_cycle,
            sums_per_cycle: array.sums_per_cycle,
        }
    }
}

/// Returns the mapping that is best for its objective on a whole layer.
pub(crate) fn search(
    accelerator: &Accelerator,
    array: &RowStationary,
    layer: &Layer,
    products: &Products,
) -> Result<Mapping, AcceleratorError> {
    let parts = Parts::of(array, layer);
    let whole = Computed::all(layer);
    let mut best: Option<([f64; 2], Mapping)> = None;
    let mut needed = u64::MAX;
    for strip in strip_heights(layer.outputs.height, array, parts) {
        let strips = Strip::all(layer, strip, &whole);
        let room = Room::of(accelerator, array, &strips);
        needed = needed.min(room.needed(1, 1, 1));
        for pass in passes(array, layer, products, parts, strip) {
            let Some(mapping) = room.fill(pass, products) else { continue };
            let counts = count_strips(array, layer, products, &mapping, &strips);
            let price = price(accelerator, array.mapping, &counts);
            if best.as_ref().is_none_or(|(least, _)| price < *least) {
                best = Some((price, mapping));
            }
        }
    }
    let too_small = AcceleratorError::Room { buffer: array.buffer_bytes, needed };
    best.map(|(_, mapping)| mapping).ok_or(too_small)
}

/// Returns the quantity to minimize; the second number decides between equal first ones.
#[allow(clippy::cast_precision_loss, reason = "compared, not counted")]
fn price(accelerator: &Accelerator, objective: Objective, counts: &Counts) -> [f64; 2] {
    match objective {
        Objective::LeastDram => [counts.dram.accesses() as f64, counts.array_cycles as f64],
        Objective::LeastEnergyDelay => {
            let cost = Cost::of(counts, accelerator);
            [cost.energy.total() * cost.cycles as f64, cost.cycles as f64]
        }
    }
}

/// Returns the heights of strips that can run at once: of those that need the same number of
/// strips, the lowest.
fn strip_heights(height: u64, array: &RowStationary, parts: Parts) -> impl Iterator<Item = u64> {
    let most = (array.rows / parts.rows * array.columns).min(height);
    (1..=most).filter(move |&strip| strip == height.div_ceil(height.div_ceil(strip)))
}

/// Returns the number of sets of elements that fit into the array. A set that is wider than the
/// array continues below.
fn sets(array: &RowStationary, parts: Parts, strip: u64) -> u64 {
    let below = array.rows / parts.rows;
    if strip <= array.columns {
        below * (array.columns / strip)
    } else {
        below / strip.div_ceil(array.columns)
    }
}

/// Returns the passes that fit into the array and its elements, without the number of filters that
/// the buffer keeps.
fn passes(
    array: &RowStationary,
    layer: &Layer,
    products: &Products,
    parts: Parts,
    strip: u64,
) -> Vec<Mapping> {
    let sets = sets(array, parts, strip);
    // Each of these numbers leaves room for a different number of channel sets.
    let all_filter_sets = (1..=sets).filter(|&filters| filters == sets / (sets / filters));
    let mut all = Vec::new();
    for filter_sets in all_filter_sets.filter(|&filters| filters <= products.outputs) {
        for channels in 1..=(array.element_inputs / parts.columns).min(products.inputs) {
            let channel_sets = (sets / filter_sets).min(products.inputs.div_ceil(channels));
            let most = (array.element_weights / (channels * parts.columns))
                .min(array.element_sums)
                .min(products.outputs);
            for filters in 1..=most {
                let images = (1..=layer.images).filter(|&images| {
                    images == layer.images.div_ceil(layer.images.div_ceil(images))
                });
                all.extend(images.map(|images| Mapping {
                    strip,
                    filters,
                    channels,
                    filter_sets,
                    channel_sets,
                    kept: 0,
                    images,
                }));
            }
        }
    }
    all
}

/// The capacity of the buffer of inputs and sums.
struct Room<'a> {
    accelerator: &'a Accelerator,
    bytes: u64,
    /// The number of inputs of a channel and an image, in the strip that has most.
    inputs: u64,
    /// The number of sums of a filter and an image, in the strip that has most.
    sums: u64,
}

impl<'a> Room<'a> {
    fn of(accelerator: &'a Accelerator, array: &RowStationary, strips: &[Strip]) -> Self {
        let most = |of: fn(&Strip) -> u64| strips.iter().map(of).max().unwrap_or_default();
        Self {
            accelerator,
            bytes: array.buffer_bytes,
            inputs: most(|strip| strip.inputs),
            sums: most(|strip| strip.positions),
        }
    }

    /// Returns the number of bytes for these channels, filters and images.
    fn needed(&self, channels: u64, filters: u64, images: u64) -> u64 {
        images
            * (self.accelerator.value_bytes(channels * self.inputs)
                + self.accelerator.sum_bytes(filters * self.sums))
    }

    /// Returns the pass with as many kept filters as the buffer can hold; `None` if it cannot hold
    /// those of one pass.
    fn fill(&self, pass: Mapping, products: &Products) -> Option<Mapping> {
        let at_once = pass.filters * pass.filter_sets;
        let channels = pass.channels * pass.channel_sets;
        let fits = |passes: u64| self.needed(channels, passes * at_once, pass.images) <= self.bytes;
        let all = products.outputs.div_ceil(at_once);
        let inputs = self.needed(channels, 0, pass.images);
        let one = self.needed(0, at_once, pass.images);
        // Rounding up to bytes can make the quotient one too large or too small.
        let near = (self.bytes.saturating_sub(inputs) / one).min(all);
        let passes = [near + 1, near, near.saturating_sub(1)]
            .into_iter()
            .find(|&passes| (1..=all).contains(&passes) && fits(passes))?;
        Some(Mapping { kept: passes * at_once, ..pass })
    }
}
