// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loads and transition times of nets.

use foveate_estimate::TimingSense;

use crate::energy::simulated_netlist::SimulatedNetlist;

/// The loads and transition times of nets, in the units of the library.
pub(crate) struct NetElectrics {
    /// The sum of the capacitances of the inputs at a net.
    pub(crate) loads: Vec<f64>,
    /// The times of a rise and of a fall, the longest of all ways to the net. Ports of the netlist and the
    /// clock have a time of 0, as in OpenSTA.
    pub(crate) slews: Vec<[f64; 2]>,
}

impl NetElectrics {
    pub(crate) fn of_netlist(netlist: &SimulatedNetlist<'_>) -> Self {
        let mut loads = vec![0.0; netlist.nets];
        for gate in &netlist.gates {
            for (pin, net) in gate.inputs() {
                loads[net] += gate.model.pins[pin].capacitance;
            }
        }
        let mut slews = vec![[0.0_f64; 2]; netlist.nets];
        for &number in netlist.flip_flops.iter().chain(&netlist.order) {
            let gate = &netlist.gates[number];
            for (pin, net) in gate.outputs() {
                let mut longest = [0.0_f64; 2];
                for transition in &gate.model.pins[pin].transitions {
                    let input = slews[gate.nets[transition.related_pin]];
                    for (edge, table) in transition.tables.iter().enumerate() {
                        let from = match transition.sense {
                            TimingSense::Same => input[edge],
                            TimingSense::Opposite => input[1 - edge],
                            TimingSense::Any => input[0].max(input[1]),
                        };
                        let slew =
                            table.as_ref().map_or(0.0, |table| table.value(from, loads[net]));
                        longest[edge] = longest[edge].max(slew);
                    }
                }
                slews[net] = longest;
            }
        }
        Self { loads, slews }
    }
}
