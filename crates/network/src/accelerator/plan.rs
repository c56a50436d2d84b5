// SPDX-License-Identifier: MIT OR Apache-2.0
//! A layer on an accelerator. The mapping is chosen once for the whole layer, and is used for every
//! mask.

use crate::accelerator::computed_positions::ComputedPositions;
use crate::accelerator::configuration::{Accelerator, Dataflow, RowStationaryArray, SystolicArray};
use crate::accelerator::cost::{LayerCost, LayerCounts, MemoryAccesses};
use crate::accelerator::layer::{ChannelGroups, Layer};
use crate::accelerator::row_stationary::{self, PassMapping};
use crate::accelerator::{AcceleratorError, systolic_array};

/// A layer that is mapped onto an accelerator.
#[derive(Clone, Debug)]
pub struct LayerPlan<'a> {
    accelerator: &'a Accelerator,
    layer: Layer,
    execution: LayerExecution<'a>,
}

/// The way in which a layer runs.
#[derive(Clone, Copy, Debug)]
enum LayerExecution<'a> {
    WeightStationary(&'a SystolicArray, ChannelGroups),
    OutputStationary(&'a SystolicArray, ChannelGroups),
    RowStationary(&'a RowStationaryArray, ChannelGroups, PassMapping),
    /// The layer runs without the array.
    Transfer,
}

impl Accelerator {
    /// Maps a layer onto the array.
    ///
    /// # Errors
    /// Fails if the buffer of a row-stationary array is too small for any mapping, or if the
    /// accelerator was changed to values that [`Accelerator::from_toml`] rejects.
    pub fn plan(&self, layer: Layer) -> Result<LayerPlan<'_>, AcceleratorError> {
        self.validate()?;
        let way = match (layer.products, &self.array) {
            (None, _) => LayerExecution::Transfer,
            (Some(products), Dataflow::WeightStationary(array)) => {
                LayerExecution::WeightStationary(array, products)
            }
            (Some(products), Dataflow::OutputStationary(array)) => {
                LayerExecution::OutputStationary(array, products)
            }
            (Some(products), Dataflow::RowStationary(array)) => {
                let mapping = row_stationary::best_mapping(self, array, &layer, &products)?;
                LayerExecution::RowStationary(array, products, mapping)
            }
        };
        Ok(LayerPlan { accelerator: self, layer, execution: way })
    }
}

impl LayerPlan<'_> {
    /// Returns the layer.
    #[must_use]
    pub fn layer(&self) -> &Layer {
        &self.layer
    }

    /// Returns the cost of the whole layer.
    #[must_use]
    pub fn whole_cost(&self) -> LayerCost {
        self.cost(&ComputedPositions::all(&self.layer))
    }

    /// Returns the cost of the needed positions of the output, rounded up to tiles. `is_needed`
    /// takes column and row. If the layer has several images, the mask applies to each of them.
    #[must_use]
    pub fn masked_cost(&self, is_needed: impl Fn(usize, usize) -> bool) -> LayerCost {
        self.cost(&ComputedPositions::in_tiles(&self.layer, self.accelerator.tile, is_needed))
    }

    fn cost(&self, computed: &ComputedPositions<'_>) -> LayerCost {
        let (accelerator, layer) = (self.accelerator, &self.layer);
        if computed.position_count(0..layer.outputs.height) == 0 {
            return LayerCost::default();
        }
        let counts = match &self.execution {
            LayerExecution::WeightStationary(array, products) => {
                systolic_array::weight_stationary(accelerator, array, layer, products, computed)
            }
            LayerExecution::OutputStationary(array, products) => {
                systolic_array::output_stationary(accelerator, array, layer, products, computed)
            }
            LayerExecution::RowStationary(array, products, mapping) => {
                row_stationary::count_layer(array, layer, products, mapping, computed)
            }
            LayerExecution::Transfer => transfer_counts(layer, computed),
        };
        LayerCost::from_counts(&counts, accelerator)
    }
}

/// Counts a layer without products: inputs come from the DRAM through the buffer, and outputs go
/// back.
fn transfer_counts(layer: &Layer, computed: &ComputedPositions<'_>) -> LayerCounts {
    let rows = 0..layer.outputs.height;
    let dram = MemoryAccesses {
        inputs: layer.images * layer.inputs.channels * computed.input_count(rows.clone()),
        outputs: layer.images * layer.outputs.channels * computed.position_count(rows),
        ..MemoryAccesses::default()
    };
    let buffer = MemoryAccesses {
        inputs: 2 * dram.inputs,
        outputs: 2 * dram.outputs,
        ..MemoryAccesses::default()
    };
    LayerCounts { dram, buffer, ..LayerCounts::default() }
}
