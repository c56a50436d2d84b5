// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of the layers of a neural network on an accelerator: cycles, accesses to registers,
//! array, buffer and DRAM, and energy.
//!
//! An [`Accelerator`] is read from TOML, or is one of the [`PRESETS`]. A [`Layer`] has the shapes
//! of a convolution or of a matrix product. [`Accelerator::plan`] maps the layer onto the array,
//! once. The [`LayerPlan`] then computes the [`LayerCost`] of the whole layer
//! ([`LayerPlan::whole_cost`]), or of the output positions that a mask needs
//! ([`LayerPlan::masked_cost`]).
//!
//! The counts depend on the number T of computed positions of the output, the number K of inputs of
//! each sum, the number M of channels of the output, and an array of R x C elements:
//!
//! * **Weight-stationary**: the array holds R x C weights, and T positions stream through. A fold
//!   takes `2R + C + T - 2` cycles, and there are `ceil(K / R) * ceil(M / C)` folds.
//! * **Output-stationary**: the array holds the sums of R positions and C channels. A fold takes
//!   `K + R + C - 2` cycles, and there are `ceil(T / R) * ceil(M / C)` folds.
//! * **Row-stationary**, as on Eyeriss (Chen et al., JSSC 2017): see the module `row_stationary`.
//!
//! The first two formulas agree with SCALE-Sim 3.0. It prints the number of the last cycle, counted
//! from 0, which is one less than the number of cycles.
//!
//! The positions that a mask needs are rounded up to tiles of the accelerator. All weights are
//! fetched if any position is computed, and none otherwise. The inputs that computed positions
//! depend on are fetched, so the halo is counted; a row-stationary array fetches them once for each
//! strip.
//!
//! A layer without sums of products (pooling, activation, addition) costs accesses to DRAM and
//! buffer, and no cycles of the array.
//!
//! ```
//! use foveate_network::accelerator::{Accelerator, KernelWindow, Layer, TensorShape};
//!
//! let accelerator = Accelerator::from_preset("systolic-ws")?;
//! let inputs = TensorShape { channels: 3, height: 224, width: 224 };
//! let outputs = TensorShape { channels: 64, ..inputs };
//! let layer = Layer::convolution(inputs, outputs, [KernelWindow::of(3, 1, 1); 2], 1)?;
//! let plan = accelerator.plan(layer)?;
//!
//! let (whole, corner) = (plan.whole_cost(), plan.masked_cost(|x, y| x < 32 && y < 32));
//! assert_eq!(corner.macs * 49, whole.macs);
//! assert_eq!(corner.dram.inputs, 3 * 33 * 33);
//! assert!(corner.energy.total() * 49.0 > whole.energy.total());
//! # Ok::<(), foveate_network::accelerator::AcceleratorError>(())
//! ```

mod computed_positions;
mod configuration;
mod cost;
mod error;
mod layer;
mod plan;
mod row_stationary;
mod systolic_array;

pub use configuration::{
    Accelerator, AcceleratorPreset, AccessEnergies, Dataflow, MappingObjective, PRESETS,
    RowStationaryArray, SystolicArray,
};
pub use cost::{EnergyCost, LayerCost, MemoryAccesses};
pub use error::AcceleratorError;
pub use layer::{KernelWindow, Layer, TensorShape};
pub use plan::LayerPlan;
