// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values of all nets of a netlist, of 64 simulations at a time. A gate takes no time, and is
//! computed only if one of its inputs has changed.

use foveate_estimate::{HIGH_NET, LogicFunction};

use crate::energy::simulated_netlist::SimulatedNetlist;

/// Simulations of one netlist; each has one bit of every value.
pub(crate) struct GateSimulation<'a> {
    netlist: &'a SimulatedNetlist<'a>,
    /// The value of each net.
    values: Vec<u64>,
    /// The state of each flip-flop, by gate.
    states: Vec<u64>,
    /// True for each gate whose inputs have changed. A flip-flop waits for the next edge.
    is_stale: Vec<bool>,
    /// The states after an edge; empty between edges.
    next_states: Vec<(usize, u64)>,
}

impl<'a> GateSimulation<'a> {
    /// Creates simulations in which all states are 0.
    pub(crate) fn new(netlist: &'a SimulatedNetlist<'a>) -> Self {
        let mut values = vec![0; netlist.nets];
        values[HIGH_NET] = u64::MAX;
        let gates = netlist.gates.len();
        let (states, is_stale) = (vec![0; gates], vec![true; gates]);
        let mut simulation = Self { netlist, values, states, is_stale, next_states: Vec::new() };
        for &gate in &netlist.flip_flops {
            // All changes come shortly after a rise of the clock.
            if let Some(clock) = netlist.gates[gate].clock() {
                simulation.values[netlist.gates[gate].nets[clock]] = u64::MAX;
            }
            simulation.compute_outputs(gate);
        }
        simulation
    }

    pub(crate) fn values(&self) -> &[u64] {
        &self.values
    }

    /// Changes the value of an input.
    pub(crate) fn set_net(&mut self, net: usize, value: u64) {
        if self.values[net] != value {
            self.values[net] = value;
            for &reader in &self.netlist.readers[net] {
                self.is_stale[reader] = true;
            }
        }
    }

    /// Computes all nets from the inputs and states.
    pub(crate) fn settle(&mut self) {
        let netlist = self.netlist;
        // Flip-flops that clear each other for ever would not settle.
        for _ in 0..=netlist.forced_flip_flops.len() {
            for &gate in &netlist.order {
                if self.is_stale[gate] {
                    self.is_stale[gate] = false;
                    self.compute_outputs(gate);
                }
            }
            // A state that is cleared or set at once may change what it drives.
            let mut has_changed = false;
            for &gate in &netlist.forced_flip_flops {
                if self.is_stale[gate] {
                    let forced = self.forced_state(gate, self.states[gate]);
                    has_changed |= self.change_state(gate, forced);
                }
            }
            if !has_changed {
                return;
            }
        }
    }

    /// Lets all clocks rise.
    pub(crate) fn clock(&mut self) {
        let mut next_states = std::mem::take(&mut self.next_states);
        for &gate in &self.netlist.flip_flops {
            if let Some(state) =
                self.netlist.gates[gate].model.state.as_ref().filter(|_| self.is_stale[gate])
            {
                let next = self.evaluate(gate, &state.next);
                next_states.push((gate, self.forced_state(gate, next)));
            }
        }
        for &(gate, _) in &next_states {
            self.is_stale[gate] = false;
        }
        for (gate, next) in next_states.drain(..) {
            // A state that has changed may change again, even if no input does.
            self.is_stale[gate] |= self.change_state(gate, next);
        }
        self.next_states = next_states;
    }

    /// Computes a function of the pins and the state of a gate.
    pub(crate) fn evaluate(&self, gate: usize, function: &LogicFunction) -> u64 {
        let nets = &self.netlist.gates[gate].nets;
        function.evaluate(&|input| match input.checked_sub(nets.len()) {
            None => self.values[nets[input]],
            Some(0) => self.states[gate],
            Some(_) => !self.states[gate],
        })
    }

    /// Returns a state of a flip-flop, or the one to which it is cleared or set.
    fn forced_state(&self, gate: usize, state: u64) -> u64 {
        let rules = self.netlist.gates[gate].model.state.as_ref();
        let condition =
            |rule: Option<&LogicFunction>| rule.map_or(0, |rule| self.evaluate(gate, rule));
        let clear = condition(rules.and_then(|rules| rules.clear.as_ref()));
        let preset = condition(rules.and_then(|rules| rules.preset.as_ref()));
        state & !clear | preset
    }

    /// Gives a flip-flop a state. Returns true if its state changes.
    fn change_state(&mut self, gate: usize, state: u64) -> bool {
        let has_changed = self.states[gate] != state;
        if has_changed {
            self.states[gate] = state;
            self.compute_outputs(gate);
        }
        has_changed
    }

    fn compute_outputs(&mut self, gate: usize) {
        let own = &self.netlist.gates[gate];
        for (pin, net) in own.outputs() {
            if let Some(function) = &own.model.pins[pin].function {
                let value = self.evaluate(gate, function);
                self.set_net(net, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::testing::{flat_netlist, tiny_library};

    /// In a chain of flip-flops, each takes the value that the one before had before the edge.
    #[test]
    fn a_value_moves_one_flip_flop_per_clock() {
        let flat = flat_netlist(
            "DFF f1 (.CLK(clk), .D(d), .Q(n1));
            DFF f2 (.CLK(clk), .D(n1), .Q(n2));
            INV g1 (.A(n2), .Y(n3));
            DFF f3 (.CLK(clk), .D(n3), .Q(q));",
        );
        let library = tiny_library("", "");
        let models = library.cell_models(["INV", "DFF"]).unwrap();
        let netlist = SimulatedNetlist::new(&flat, &models).unwrap();
        let mut simulation = GateSimulation::new(&netlist);
        let input = flat.gates[0].pins["D"];
        let output = flat.outputs["q"][0];
        let values: Vec<u64> =
            (0..40).map(|clock: u64| (clock / 2).wrapping_mul(0x9E37_79B9_7F4A_7C15)).collect();
        for (clock, &value) in values.iter().enumerate() {
            simulation.set_net(input, value);
            simulation.settle();
            simulation.clock();
            simulation.settle();
            if clock >= 2 {
                assert_eq!(simulation.values()[output], !values[clock - 2], "clock {clock}");
            }
        }
    }

    #[test]
    fn a_cleared_flip_flop_is_0_at_once_and_stays_it() {
        let flat = flat_netlist("DFFC f1 (.CLK(clk), .D(d), .R(r), .Q(q), .QN(n))");
        let library = tiny_library("", "");
        let models = library.cell_models(["DFFC"]).unwrap();
        let netlist = SimulatedNetlist::new(&flat, &models).unwrap();
        let mut simulation = GateSimulation::new(&netlist);
        let pin = |name: &str| flat.gates[0].pins[name];
        let outputs = |simulation: &GateSimulation<'_>| {
            [pin("Q"), pin("QN")].map(|net| simulation.values()[net] & 0b11)
        };
        simulation.set_net(pin("D"), 0b11);
        simulation.settle();
        simulation.clock();
        simulation.settle();
        assert_eq!(outputs(&simulation), [0b11, 0]);
        simulation.set_net(pin("R"), 0b01);
        simulation.settle();
        assert_eq!(outputs(&simulation), [0b10, 0b01]);
        simulation.clock();
        simulation.settle();
        assert_eq!(outputs(&simulation), [0b10, 0b01]);
        simulation.set_net(pin("R"), 0);
        simulation.settle();
        assert_eq!(outputs(&simulation), [0b10, 0b01]);
        simulation.clock();
        simulation.settle();
        assert_eq!(outputs(&simulation), [0b11, 0]);
    }
}
