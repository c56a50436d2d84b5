// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of a run's frames on an accelerator, computed whole and computed where the masks say.

use foveate_accelerator::{Accelerator, AcceleratorError, Cost, Layer, Plan, Shape, Window};
use foveate_network::{Executor, Form, Network, Products, Window as Taps};
use serde::Serialize;

/// The costs of a network's nodes on an accelerator.
pub(crate) struct Costs<'a> {
    accelerator: &'a Accelerator,
    /// The plan of every node; `None` for a node that only renames values.
    plans: Vec<Option<Plan<'a>>>,
    /// The cost of every node for a frame that is computed whole.
    whole: Vec<Cost>,
    /// The cost of every node for all counted frames so far, where they were needed.
    masked: Vec<Cost>,
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
pub struct Accelerated {
    /// The accelerator's name, as the user gave it.
    pub name: String,
    /// The cost of a frame that is computed whole.
    pub whole: FrameCost,
    /// The cost of a frame that is computed where the masks say.
    pub masked: FrameCost,
}

impl<'a> Costs<'a> {
    /// Maps the nodes of a network onto an accelerator.
    ///
    /// # Errors
    /// Fails if a layer cannot be mapped onto the accelerator. The error has the name of the node.
    pub(crate) fn new(
        accelerator: &'a Accelerator,
        network: &Network,
    ) -> Result<Self, (String, AcceleratorError)> {
        let plan = |node: usize| {
            let layer = layer(network, node);
            let plan =
                layer.and_then(|layer| layer.map(|layer| accelerator.plan(layer)).transpose());
            plan.map_err(|error| (network.nodes()[node].name().to_owned(), error))
        };
        let plans = (0..network.nodes().len()).map(plan).collect::<Result<Vec<_>, _>>()?;
        let of = |plan: &Option<Plan<'_>>| plan.as_ref().map(Plan::whole).unwrap_or_default();
        let whole: Vec<_> = plans.iter().map(of).collect();
        let masked = vec![Cost::default(); plans.len()];
        Ok(Self { accelerator, plans, whole, masked, frames: 0 })
    }

    /// Returns the cost of a node for the last frame, where it was needed.
    pub(crate) fn of_frame(&self, executor: &Executor<'_>, node: usize) -> Cost {
        let Some(plan) = &self.plans[node] else { return Cost::default() };
        let wanted = executor.wanted(node);
        let shape = plan.layer().outputs();
        let fits = (shape.height, shape.width) == (wanted.height() as u64, wanted.width() as u64);
        // A product whose rows are not positions needs all its rows or none.
        if fits {
            plan.masked(|x, y| wanted.contains(x, y))
        } else {
            plan.masked(|_, _| !wanted.is_empty())
        }
    }

    /// Counts a frame, given the costs of its nodes.
    pub(crate) fn add(&mut self, nodes: impl Iterator<Item = Cost>) {
        self.frames += 1;
        self.masked.iter_mut().zip(nodes).for_each(|(sum, cost)| *sum += cost);
    }

    /// Returns the whole and the masked cost of a node.
    pub(crate) fn of_node(&self, node: usize) -> (FrameCost, FrameCost) {
        (self.mean(self.whole[node], 1), self.mean(self.masked[node], self.frames))
    }

    /// Returns the cost of a frame that is computed whole.
    pub(crate) fn whole(&self) -> FrameCost {
        self.mean(self.whole.iter().copied().sum(), 1)
    }

    /// Returns the sums over all nodes.
    pub(crate) fn summary(&self, name: &str) -> Accelerated {
        let masked = self.masked.iter().copied().sum();
        Accelerated {
            name: name.to_owned(),
            whole: self.whole(),
            masked: self.mean(masked, self.frames),
        }
    }

    /// Returns the mean over `frames` frames whose costs add up to `sum`.
    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub(crate) fn mean(&self, sum: Cost, frames: u64) -> FrameCost {
        let frames = frames.max(1) as f64;
        FrameCost {
            cycles: sum.cycles as f64 / frames,
            seconds: self.accelerator.seconds(sum.cycles) / frames,
            dram_accesses: sum.dram.accesses() as f64 / frames,
            dram_weights: sum.dram.weights as f64 / frames,
            energy_mj: sum.energy.total() / 1e9 / frames,
        }
    }
}

/// Returns a node as a layer of an accelerator; `None` if it only renames values.
fn layer(network: &Network, node: usize) -> Result<Option<Layer>, AcceleratorError> {
    let place = &network.nodes()[node];
    let (output, inputs) = (network.form(node + 1), place.inputs());
    Ok(Some(match place.products() {
        Products::Renamed => return Ok(None),
        Products::Convolution { rows, columns, groups } => Layer::convolution(
            shape(network.form(inputs[0])),
            shape(output),
            [window(rows), window(columns)],
            groups as u64,
        )?,
        // Each output position is a product with the inputs that reach it.
        Products::Transposed { inputs } => {
            let of = Shape { channels: inputs as u64, ..shape(output) };
            Layer::convolution(of, shape(output), [Window::SAME; 2], 1)?
        }
        Products::Matrix { inputs } => {
            let columns = output.shape().last().map_or(1, |&columns| columns as u64);
            let rows = output.elements() as u64 / columns;
            if rows == output.places() as u64 {
                let of = |channels| Shape { channels, ..shape(output) };
                Layer::convolution(of(inputs as u64), of(columns), [Window::SAME; 2], 1)?
            } else {
                Layer::product(rows, inputs as u64, columns)?
            }
        }
        // Every output takes an equal share of all inputs, wherever it is.
        Products::None => {
            let values: usize = inputs.iter().map(|&input| network.form(input).elements()).sum();
            let channels = values.div_ceil(output.places()) as u64;
            Layer::transfer(Shape { channels, ..shape(output) }, shape(output), [Window::SAME; 2])?
        }
    }))
}

fn shape(form: &Form) -> Shape {
    Shape {
        channels: (form.elements() / form.places()) as u64,
        height: form.height() as u64,
        width: form.width() as u64,
    }
}

fn window(taps: Taps) -> Window {
    Window {
        kernel: taps.kernel as u64,
        stride: taps.stride as u64,
        dilation: taps.dilation as u64,
        before: taps.before as u64,
    }
}
