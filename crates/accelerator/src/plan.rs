// SPDX-License-Identifier: MIT OR Apache-2.0
//! A layer on an accelerator. The mapping is chosen once for the whole layer, and is used for every
//! mask.

use crate::accelerator::{Accelerator, Dataflow, RowStationary, Systolic};
use crate::computed::Computed;
use crate::cost::{Cost, Counts, Traffic};
use crate::layer::{Layer, Products};
use crate::row_stationary::{self, Mapping};
use crate::{AcceleratorError, systolic};

/// A layer that is mapped onto an accelerator.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    accelerator: &'a Accelerator,
    layer: Layer,
    way: Way<'a>,
}

/// The way in which a layer runs.
#[derive(Clone, Copy, Debug)]
enum Way<'a> {
    WeightStationary(&'a Systolic, Products),
    OutputStationary(&'a Systolic, Products),
    RowStationary(&'a RowStationary, Products, Mapping),
    /// The layer runs without the array.
    Transfer,
}

impl Accelerator {
    /// Maps a layer onto the array.
    ///
    /// # Errors
    /// Fails if the buffer of a row-stationary array is too small for any mapping, or if the
    /// accelerator was changed to values that [`Accelerator::from_toml`] rejects.
    pub fn plan(&self, layer: Layer) -> Result<Plan<'_>, AcceleratorError> {
        self.validate()?;
        let way = match (layer.products, &self.array) {
            (None, _) => Way::Transfer,
            (Some(products), Dataflow::WeightStationary(array)) => {
                Way::WeightStationary(array, products)
            }
            (Some(products), Dataflow::OutputStationary(array)) => {
                Way::OutputStationary(array, products)
            }
            (Some(products), Dataflow::RowStationary(array)) => {
                let mapping = row_stationary::search(self, array, &layer, &products)?;
                Way::RowStationary(array, products, mapping)
            }
        };
        Ok(Plan { accelerator: self, layer, way })
    }
}

impl Plan<'_> {
    /// Returns the layer.
    #[must_use]
    pub fn layer(&self) -> &Layer {
        &self.layer
    }

    /// Returns the cost of the whole layer.
    #[must_use]
    pub fn whole(&self) -> Cost {
        self.cost(&Computed::all(&self.layer))
    }

    /// Returns the cost of the needed positions of the output, rounded up to tiles. `is_needed`
    /// takes column and row. If the layer has several images, the mask applies to each of them.
    #[must_use]
    pub fn masked(&self, is_needed: impl Fn(usize, usize) -> bool) -> Cost {
        self.cost(&Computed::tiles(&self.layer, self.accelerator.tile, is_needed))
    }

    fn cost(&self, computed: &Computed<'_>) -> Cost {
        let (accelerator, layer) = (self.accelerator, &self.layer);
        if computed.positions(0..layer.outputs.height) == 0 {
            return Cost::default();
        }
        let counts = match &self.way {
            Way::WeightStationary(array, products) => {
                systolic::weight_stationary(accelerator, array, layer, products, computed)
            }
            Way::OutputStationary(array, products) => {
                systolic::output_stationary(accelerator, array, layer, products, computed)
            }
            Way::RowStationary(array, products, mapping) => {
                row_stationary::count(array, layer, products, mapping, computed)
            }
            Way::Transfer => transfer(layer, computed),
        };
        Cost::of(&counts, accelerator)
    }
}

/// Counts a layer without products: inputs come from the DRAM through the buffer, and outputs go
/// back.
fn transfer(layer: &Layer, computed: &Computed<'_>) -> Counts {
    let rows = 0..layer.outputs.height;
    let dram = Traffic {
        inputs: layer.images * layer.inputs.channels * computed.inputs(rows.clone()),
        outputs: layer.images * layer.outputs.channels * computed.positions(rows),
        ..Traffic::default()
    };
    let buffer =
        Traffic { inputs: 2 * dram.inputs, outputs: 2 * dram.outputs, ..Traffic::default() };
    Counts { dram, buffer, ..Counts::default() }
}
