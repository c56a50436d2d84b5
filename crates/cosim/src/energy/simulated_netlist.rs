// SPDX-License-Identifier: MIT OR Apache-2.0
//! A netlist whose gates are connected to the models of their cells, in an order of evaluation.

use std::collections::BTreeMap;

use foveate_estimate::{CellModel, CellModels, FlatNetlist};

use crate::energy::error::EnergyError;

#[derive(Debug)]
pub(crate) struct SimulatedNetlist<'a> {
    pub(crate) models: &'a CellModels,
    pub(crate) gates: Vec<SimulatedGate<'a>>,
    /// The number of nets. A pin that is not connected has a net of its own.
    pub(crate) nets: usize,
    /// The combinational gates, each behind those that drive its inputs.
    pub(crate) order: Vec<usize>,
    pub(crate) flip_flops: Vec<usize>,
    /// The flip-flops that can be cleared or set without a clock.
    pub(crate) forced_flip_flops: Vec<usize>,
    /// The gates that read each net, but for clocks.
    pub(crate) readers: Vec<Vec<usize>>,
    /// True for each net that a gate drives.
    pub(crate) is_driven: Vec<bool>,
    pub(crate) inputs: &'a BTreeMap<String, Vec<usize>>,
    pub(crate) outputs: &'a BTreeMap<String, Vec<usize>>,
}

#[derive(Debug)]
pub(crate) struct SimulatedGate<'a> {
    pub(crate) model: &'a CellModel,
    /// The net of each pin of the model.
    pub(crate) nets: Vec<usize>,
    pub(crate) is_in_unit: bool,
    /// True if an output is a bit of a word of a memory.
    pub(crate) is_memory_bit: bool,
}

impl SimulatedGate<'_> {
    /// Returns the pin of the clock of a flip-flop.
    pub(crate) fn clock(&self) -> Option<usize> {
        self.model.state.as_ref().map(|state| state.clock)
    }

    /// Returns the outputs with their nets.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = (usize, usize)> {
        self.pins_of(true)
    }

    /// Returns the inputs with their nets.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = (usize, usize)> {
        self.pins_of(false)
    }

    fn pins_of(&self, is_output: bool) -> impl Iterator<Item = (usize, usize)> {
        let pins = self.model.pins.iter().zip(&self.nets).enumerate();
        pins.filter(move |(_, (pin, _))| pin.is_output == is_output)
            .map(|(at, (_, &net))| (at, net))
    }
}

impl<'a> SimulatedNetlist<'a> {
    /// Connects the gates.
    ///
    /// # Errors
    /// Fails if an input is not connected, or if gates without a flip-flop between them form a
    /// loop.
    pub(crate) fn new(
        netlist: &'a FlatNetlist,
        models: &'a CellModels,
    ) -> Result<Self, EnergyError> {
        let mut nets = netlist.nets;
        let mut gates = Vec::with_capacity(netlist.gates.len());
        for gate in &netlist.gates {
            let model = &models.cells[&gate.cell];
            let mut own = Vec::with_capacity(model.pins.len());
            for pin in &model.pins {
                own.push(match gate.pins.get(&pin.name) {
                    Some(&net) => net,
                    None if pin.is_output => {
                        nets += 1;
                        nets - 1
                    }
                    None => {
                        let reason = format!(
                            "the input `{}` of a cell `{}` has no net",
                            pin.name, gate.cell
                        );
                        return Err(EnergyError::Netlist { reason });
                    }
                });
            }
            let outputs = model.pins.iter().zip(&own).filter(|(pin, _)| pin.is_output);
            let is_memory_bit =
                outputs.into_iter().any(|(_, net)| netlist.memory_nets.contains(net));
            gates.push(SimulatedGate {
                model,
                nets: own,
                is_in_unit: gate.is_in_unit,
                is_memory_bit,
            });
        }
        let mut is_driven = vec![false; nets];
        gates.iter().flat_map(SimulatedGate::outputs).for_each(|(_, net)| is_driven[net] = true);
        let mut readers = vec![Vec::new(); nets];
        for (number, gate) in gates.iter().enumerate() {
            for (_, net) in gate.inputs().filter(|(pin, _)| gate.clock() != Some(*pin)) {
                readers[net].push(number);
            }
        }
        let is_flip_flop = |gate: &usize| gates[*gate].model.state.is_some();
        let (flip_flops, combinational): (Vec<_>, Vec<_>) =
            (0..gates.len()).partition(is_flip_flop);
        let order = evaluation_order(&gates, &combinational, &readers)?;
        let is_forced = |gate: &usize| {
            let state = gates[*gate].model.state.as_ref();
            state.is_some_and(|state| state.clear.is_some() || state.preset.is_some())
        };
        let forced_flip_flops = flip_flops.iter().copied().filter(is_forced).collect();
        let (inputs, outputs) = (&netlist.inputs, &netlist.outputs);
        Ok(Self {
            models,
            gates,
            nets,
            order,
            flip_flops,
            forced_flip_flops,
            readers,
            is_driven,
            inputs,
            outputs,
        })
    }
}

/// Returns the combinational gates, each behind those that drive its inputs. `readers` are the
/// gates that read each net.
fn evaluation_order(
    gates: &[SimulatedGate<'_>],
    combinational: &[usize],
    readers: &[Vec<usize>],
) -> Result<Vec<usize>, EnergyError> {
    let driven = |gate: usize| gates[gate].outputs().flat_map(|(_, net)| &readers[net]).copied();
    // The number of inputs that wait for a gate.
    let mut waiting = vec![0_usize; gates.len()];
    combinational.iter().flat_map(|&gate| driven(gate)).for_each(|reader| waiting[reader] += 1);
    let mut order: Vec<usize> =
        combinational.iter().copied().filter(|&gate| waiting[gate] == 0).collect();
    let mut at = 0;
    while let Some(&gate) = order.get(at) {
        at += 1;
        for reader in driven(gate) {
            waiting[reader] -= 1;
            if waiting[reader] == 0 && gates[reader].model.state.is_none() {
                order.push(reader);
            }
        }
    }
    match order.len() == combinational.len() {
        true => Ok(order),
        false => Err(EnergyError::Netlist {
            reason: format!("{} gates form loops", combinational.len() - order.len()),
        }),
    }
}
