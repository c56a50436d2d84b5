// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of a run's frames, computed whole and computed where the masks say: time and energy
//! on an accelerator ([`NodeCosts`]), and the bytes that the layers read and write
//! ([`FrameTraffic`]).

use foveate_network::accelerator::{
    Accelerator, AcceleratorError, KernelWindow, Layer, LayerCost, LayerPlan, TensorShape,
};
use foveate_network::{AxisWindow as Taps, Executor, Network, ProductKind, TensorForm};
use serde::Serialize;
use std::ops::AddAssign;

/// The costs of a network's nodes on an accelerator.
pub(crate) struct NodeCosts<'a> {
    accelerator: &'a Accelerator,
    /// The plan of every node; `None` for a node that only renames values.
    plans: Vec<Option<LayerPlan<'a>>>,
    /// The cost of every node for a frame that is computed whole.
    whole: Vec<LayerCost>,
    /// The cost of every node for all counted frames so far, where they were needed.
    masked: Vec<LayerCost>,
    frames: u64,
}

/// The cost of a frame or of one of its layers, as a mean over the counted frames.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct FrameCost {
    /// The number of cycles, with the layers one after the other.
    pub cycles: f64,
    /// The time of the cycles in seconds.
    pub seconds: f64,
    /// The number of accesses to the memory off the chip, one value each.
    pub dram_accesses: f64,
    /// The number of accesses to weights in the memory off the chip.
    pub dram_weights: f64,
    /// The energy of chip and memory in millijoules.
    pub energy_mj: f64,
}

/// The cost of a run on an accelerator.
#[derive(Clone, Debug, Serialize)]
pub struct AcceleratorSummary {
    /// The accelerator's name, as the user gave it.
    pub name: String,
    /// The cost of a frame that is computed whole.
    pub whole: FrameCost,
    /// The cost of a frame that is computed where the masks say.
    pub masked: FrameCost,
}

impl<'a> NodeCosts<'a> {
    /// Maps the nodes of a network onto an accelerator.
    ///
    /// # Errors
    /// Fails if a layer cannot be mapped onto the accelerator. The error has the name of the node.
    pub(crate) fn new(
        accelerator: &'a Accelerator,
        network: &Network,
    ) -> Result<Self, (String, AcceleratorError)> {
        let plan = |node: usize| {
            let layer = accelerator_layer(network, node);
            let plan =
                layer.and_then(|layer| layer.map(|layer| accelerator.plan(layer)).transpose());
            plan.map_err(|error| (network.nodes()[node].name().to_owned(), error))
        };
        let plans = (0..network.nodes().len()).map(plan).collect::<Result<Vec<_>, _>>()?;
        let of = |plan: &Option<LayerPlan<'_>>| {
            plan.as_ref().map(LayerPlan::whole_cost).unwrap_or_default()
        };
        let whole: Vec<_> = plans.iter().map(of).collect();
        let masked = vec![LayerCost::default(); plans.len()];
        Ok(Self { accelerator, plans, whole, masked, frames: 0 })
    }

    /// Returns the cost of a node for the last frame, where it was needed.
    pub(crate) fn node_cost_of_frame(&self, executor: &Executor<'_>, node: usize) -> LayerCost {
        let Some(plan) = &self.plans[node] else { return LayerCost::default() };
        let wanted = executor.needed_mask(node);
        let shape = plan.layer().outputs();
        let fits = (shape.height, shape.width) == (wanted.height() as u64, wanted.width() as u64);
        // A product whose rows are not positions needs all its rows or none.
        if fits {
            plan.masked_cost(|x, y| wanted.contains(x, y))
        } else {
            plan.masked_cost(|_, _| !wanted.is_empty())
        }
    }

    /// Counts a frame, given the costs of its nodes.
    pub(crate) fn add_frame(&mut self, nodes: impl Iterator<Item = LayerCost>) {
        self.frames += 1;
        self.masked.iter_mut().zip(nodes).for_each(|(sum, cost)| *sum += cost);
    }

    /// Returns the whole and the masked cost of a node.
    pub(crate) fn mean_node_costs(&self, node: usize) -> (FrameCost, FrameCost) {
        (self.mean_cost(self.whole[node], 1), self.mean_cost(self.masked[node], self.frames))
    }

    pub(crate) fn whole_frame_cost(&self) -> FrameCost {
        self.mean_cost(self.whole.iter().copied().sum(), 1)
    }

    /// Returns the sums over all nodes.
    pub(crate) fn summary(&self, name: &str) -> AcceleratorSummary {
        let masked = self.masked.iter().copied().sum();
        AcceleratorSummary {
            name: name.to_owned(),
            whole: self.whole_frame_cost(),
            masked: self.mean_cost(masked, self.frames),
        }
    }

    /// Returns the mean over `frames` frames whose costs add up to `sum`.
    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub(crate) fn mean_cost(&self, sum: LayerCost, frames: u64) -> FrameCost {
        let frames = frames.max(1) as f64;
        FrameCost {
            cycles: sum.cycles as f64 / frames,
            seconds: self.accelerator.seconds(sum.cycles) / frames,
            dram_accesses: sum.dram.access_count() as f64 / frames,
            dram_weights: sum.dram.weights as f64 / frames,
            energy_mj: sum.energy.total() / 1e9 / frames,
        }
    }
}

/// Returns a node as a layer of an accelerator; `None` if it only renames values.
fn accelerator_layer(network: &Network, node: usize) -> Result<Option<Layer>, AcceleratorError> {
    let place = &network.nodes()[node];
    let (output, inputs) = (network.form(node + 1), place.inputs());
    Ok(Some(match place.products() {
        ProductKind::NoComputation => return Ok(None),
        ProductKind::Convolution { rows, columns, groups } => Layer::convolution(
            shape(network.form(inputs[0])),
            shape(output),
            [window(rows), window(columns)],
            groups as u64,
        )?,
        // Each output position is a product with the inputs that reach it.
        ProductKind::Transposed { inputs } => {
            let of = TensorShape { channels: inputs as u64, ..shape(output) };
            Layer::convolution(of, shape(output), [KernelWindow::SAME; 2], 1)?
        }
        ProductKind::Matrix { inputs } => {
            let columns = output.shape().last().map_or(1, |&columns| columns as u64);
            let rows = output.element_count() as u64 / columns;
            if rows == output.position_count() as u64 {
                let of = |channels| TensorShape { channels, ..shape(output) };
                Layer::convolution(of(inputs as u64), of(columns), [KernelWindow::SAME; 2], 1)?
            } else {
                Layer::product(rows, inputs as u64, columns)?
            }
        }
        // Every output takes an equal share of all inputs, wherever it is.
        ProductKind::None => {
            let values: usize =
                inputs.iter().map(|&input| network.form(input).element_count()).sum();
            let channels = values.div_ceil(output.position_count()) as u64;
            Layer::transfer(
                TensorShape { channels, ..shape(output) },
                shape(output),
                [KernelWindow::SAME; 2],
            )?
        }
    }))
}

fn shape(form: &TensorForm) -> TensorShape {
    TensorShape {
        channels: (form.element_count() / form.position_count()) as u64,
        height: form.height() as u64,
        width: form.width() as u64,
    }
}

fn window(taps: Taps) -> KernelWindow {
    KernelWindow {
        kernel: taps.kernel as u64,
        stride: taps.stride as u64,
        dilation: taps.dilation as u64,
        padding_before: taps.padding_before as u64,
    }
}

/// The traffic summed over frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TrafficTally {
    pub(crate) read: u64,
    pub(crate) halo: u64,
    pub(crate) written: u64,
    pub(crate) seconds: f64,
}

/// The mean traffic of a frame, or of a layer of it, without weights, over the counted frames.
/// Blocks that are computed beyond the needed positions are not counted.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct FrameTraffic {
    /// The bytes of the inputs that the needed outputs see, each input once.
    pub read_bytes: f64,
    /// The bytes of the unchanged inputs that the needed outputs see: the halo around changes.
    pub halo_bytes: f64,
    /// The bytes of the needed outputs.
    pub written_bytes: f64,
    /// The time in the operators in seconds.
    pub seconds: f64,
}

impl TrafficTally {
    /// Returns the traffic of a node for the last frame.
    pub(crate) fn of_node(network: &Network, executor: &Executor<'_>, node: usize) -> Self {
        let bytes = |form: &TensorForm, positions: usize| {
            form.bytes() / form.position_count() as u64 * positions as u64
        };
        let mut found = Self {
            written: bytes(network.form(node + 1), executor.needed_mask(node).count()),
            seconds: executor.operator_time(node).as_secs_f64(),
            ..Self::default()
        };
        for (value, seen) in executor.needed_inputs(node) {
            let form = network.form(value);
            found.read += bytes(form, seen.count());
            found.halo += bytes(form, seen.count_outside(executor.change_mask(value)));
        }
        found
    }

    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub(crate) fn mean(&self, frames: u64) -> FrameTraffic {
        let frames = frames.max(1) as f64;
        FrameTraffic {
            read_bytes: self.read as f64 / frames,
            halo_bytes: self.halo as f64 / frames,
            written_bytes: self.written as f64 / frames,
            seconds: self.seconds / frames,
        }
    }
}

impl AddAssign for TrafficTally {
    fn add_assign(&mut self, other: Self) {
        self.read += other.read;
        self.halo += other.halo;
        self.written += other.written;
        self.seconds += other.seconds;
    }
}
