// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of an activity ([`EnergySum`]): the sum over all pins of the energies that the
//! library gives for their changes, and of those that charge the inputs at each net. Both
//! depend on the loads and the transition times of nets ([`NetElectrics`]).

use crate::energy::activity::NetActivity;
use crate::energy::simulated_netlist::{SimulatedGate, SimulatedNetlist};
use foveate_estimate::{CellPin, InternalEnergy, TimingSense, count_to_f64};
use serde::{Deserialize, Serialize};

/// Energies of the parts of a circuit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartEnergies {
    /// The clock at the pins of flip-flops, without a clock tree.
    pub clock: f64,
    /// The flip-flops that are words of memories, without their clock.
    pub memory: f64,
    /// The other flip-flops, without their clock.
    pub flip_flops: f64,
    /// The gates.
    pub logic: f64,
}

impl PartEnergies {
    /// Returns the sum of all parts.
    #[must_use]
    pub fn total(self) -> f64 {
        self.clock + self.memory + self.flip_flops + self.logic
    }

    /// Returns all parts times a factor.
    #[must_use]
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            clock: self.clock * factor,
            memory: self.memory * factor,
            flip_flops: self.flip_flops * factor,
            logic: self.logic * factor,
        }
    }

    /// Returns the sums of the parts of two circuits.
    #[must_use]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            clock: self.clock + other.clock,
            memory: self.memory + other.memory,
            flip_flops: self.flip_flops + other.flip_flops,
            logic: self.logic + other.logic,
        }
    }
}

/// The energies of a unit and of the logic that units share, in picojoules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct EnergySum {
    pub(crate) unit: PartEnergies,
    pub(crate) shared: PartEnergies,
}

impl EnergySum {
    pub(crate) fn of_activity(
        netlist: &SimulatedNetlist<'_>,
        electrics: &NetElectrics,
        activity: &NetActivity,
    ) -> Self {
        let (voltage, unit_pj) = (netlist.models.voltage, netlist.models.load_unit_pf);
        let mut sum = Self::default();
        for (gate, energies) in netlist.gates.iter().zip(&activity.energies) {
            let parts = if gate.is_in_unit { &mut sum.unit } else { &mut sum.shared };
            let clock = gate.clock();
            for (at, pin) in gate.model.pins.iter().enumerate() {
                let net = gate.nets[at];
                let is_clock = clock == Some(at);
                let load = if pin.is_output { electrics.loads[net] } else { 0.0 };
                let internal = match pin.is_output {
                    true => {
                        output_energy(pin, &energies[at], activity.nets[net], |energy, edge| {
                            energy.of_edge(edge, input_slew(gate, energy, electrics), load)
                        })
                    }
                    false => input_energy(pin, &energies[at], electrics.slews[net]),
                };
                // Each change of a net takes or loses half of the energy of the charge of its
                // inputs. No gate drives the clock, which has two changes in a clock.
                let changes = match (is_clock, netlist.is_driven[net]) {
                    (true, _) => 2.0 * activity.clocks,
                    (false, true) => activity.nets[net].iter().sum(),
                    (false, false) => 0.0,
                };
                let part = if is_clock { &mut parts.clock } else { own_part(parts, gate) };
                *part += unit_pj * (internal + 0.5 * changes * pin.capacitance * voltage * voltage);
            }
        }
        sum
    }
}

/// Returns the part to which the pins of a gate belong, but for clocks.
fn own_part<'a>(parts: &'a mut PartEnergies, gate: &SimulatedGate<'_>) -> &'a mut f64 {
    match (gate.model.state.is_some(), gate.is_memory_bit) {
        (true, true) => &mut parts.memory,
        (true, false) => &mut parts.flip_flops,
        (false, _) => &mut parts.logic,
    }
}

/// Returns the energy of all changes of an input, in the unit of the library.
fn input_energy(pin: &CellPin, counts: &[[f64; 2]], slews: [f64; 2]) -> f64 {
    let of_edge = |(energy, count): (&InternalEnergy, &[f64; 2]), edge: usize| {
        count[edge] * energy.of_edge(edge, slews[edge], 0.0)
    };
    let energies = pin.energies.iter().zip(counts);
    energies.map(|own| of_edge(own, 0) + of_edge(own, 1)).sum()
}

/// Returns the energy of all changes of an output, in the unit of the library. `counts` are the
/// changes that belong to each energy, and `changes` all changes of the net. `each` returns an
/// energy for an edge.
fn output_energy(
    pin: &CellPin,
    counts: &[[f64; 2]],
    changes: [f64; 2],
    each: impl Fn(&InternalEnergy, usize) -> f64,
) -> f64 {
    let mut sum = 0.0;
    for (edge, changes) in changes.into_iter().enumerate() {
        let counted: f64 = counts.iter().map(|count| count[edge]).sum();
        for (energy, count) in pin.energies.iter().zip(counts) {
            // Where several inputs change at once, each has a share of the change of the output.
            let times = match counted > 0.0 {
                true => changes * count[edge] / counted,
                false => changes / count_to_f64(pin.energies.len() as u64),
            };
            sum += times * each(energy, edge);
        }
    }
    sum
}

/// Returns the transition time of the input that makes an output change. A fall of an input may
/// make the output rise, so the mean of both edges stands for each.
fn input_slew(gate: &SimulatedGate<'_>, energy: &InternalEnergy, electrics: &NetElectrics) -> f64 {
    let input = energy.related_pins.first();
    input.map_or(0.0, |&pin| electrics.slews[gate.nets[pin]].iter().sum::<f64>() / 2.0)
}

/// The loads and transition times of nets, in the units of the library.
pub(crate) struct NetElectrics {
    /// The sum of the capacitances of the inputs at a net.
    pub(crate) loads: Vec<f64>,
    /// The times of a rise and of a fall, the longest of all ways to the net. Ports of the netlist
    /// and the clock have a time of 0, as in OpenSTA.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::activity::ActivityCounter;
    use crate::energy::gate_simulation::GateSimulation;
    use crate::energy::testing::{OSU018, flat_netlist, has_library, tiny_library};
    use foveate_estimate::{FlatNetlist, LibertyLibrary};
    use foveate_tools::opensta::{self, OpenStaJob};
    use foveate_tools::testing::require_tools;
    use foveate_tools::{Cache, Tool, Toolchain};

    /// A flip-flop that changes at every clock.
    const DIVIDER: &str = "DFF f1 (.CLK(clk), .D(n2), .Q(q));
        INV g1 (.A(q), .Y(n2));";

    /// Returns the energies of some clocks of one simulation.
    fn simulated(netlist: &FlatNetlist, library: &LibertyLibrary, clocks: usize) -> EnergySum {
        let models =
            library.cell_models(netlist.gates.iter().map(|gate| gate.cell.as_str())).unwrap();
        let netlist = SimulatedNetlist::new(netlist, &models).unwrap();
        let mut simulation = GateSimulation::new(&netlist);
        let mut counter = ActivityCounter::new(&netlist);
        simulation.settle();
        // The first three clocks are not counted.
        for counted in [0; 3].into_iter().chain(std::iter::repeat_n(1, clocks)) {
            let before = simulation.values().to_vec();
            simulation.clock();
            simulation.settle();
            counter.count(&simulation, &before, counted);
        }
        EnergySum::of_activity(&netlist, &NetElectrics::of_netlist(&netlist), &counter.finish())
    }

    /// The energies are added up by hand: all nets have two rises and two falls in four clocks.
    #[test]
    fn the_sum_is_that_of_all_changes() {
        let netlist = flat_netlist(DIVIDER);
        let sum = simulated(&netlist, &tiny_library("", ""), 4).unit;
        let expected = PartEnergies {
            clock: 4.0 * (1.0 + 2.0) + 4.0 * 1.0 * 4.0,
            memory: 0.0,
            flip_flops: 2.0 * (0.5 + 0.25) + 2.0 * (7.0 + 9.0) + 4.0 * 0.5 * 4.0 * 4.0,
            logic: 2.0 * (3.0 + 5.0) + 4.0 * 0.5 * 2.0 * 4.0,
        };
        assert_eq!(sum, expected);
        let half = simulated(&netlist, &tiny_library("", ""), 2).unit;
        assert_eq!(half, expected.scaled(0.5));
    }

    #[test]
    fn an_energy_counts_only_under_its_condition() {
        // At half of the edges D is 1.
        let clock = "internal_power () { when : \"D\"; rise_power (scalar) { values (\"10\"); } }";
        // The inverter falls while A is 1. Rises belong to the energy without a condition.
        let output = "internal_power () { related_pin : \"A\"; when : \"A\"; fall_power (scalar) { values (\"100\"); } }";
        let sum = simulated(&flat_netlist(DIVIDER), &tiny_library(clock, output), 4).unit;
        let expected = PartEnergies {
            clock: 2.0 * 10.0 + 2.0 * (1.0 + 2.0) + 4.0 * 1.0 * 4.0,
            logic: 2.0 * (3.0 + 100.0) + 4.0 * 0.5 * 2.0 * 4.0,
            ..sum
        };
        assert_eq!(sum, expected);
    }

    /// OpenSTA of 2019 takes the energies of a rise and of a fall for each change of a pin, which
    /// is twice as much; it leaves the charge of the clock out. All else is as here.
    #[test]
    fn an_independent_tool_agrees_within_two_percent() {
        if !require_tools(&[Tool::OpenSta]) || !has_library() {
            return;
        }
        let gates = "DFFPOSX1 f1 (.CLK(clk), .D(n4), .Q(n1));
            DFFPOSX1 f2 (.CLK(clk), .D(n5), .Q(n2));
            NAND2X1 g1 (.A(n1), .B(n2), .Y(n3));
            XOR2X1 g2 (.A(n3), .B(n1), .Y(n4));
            INVX2 g3 (.A(n4), .Y(n5));
            NOR2X1 g4 (.A(n5), .B(n2), .Y(n6));
            BUFX4 g5 (.A(n6), .Y(q));";
        let library = LibertyLibrary::read(OSU018.as_ref()).unwrap();
        let flat = flat_netlist(gates);
        let models = library.cell_models(flat.gates.iter().map(|gate| gate.cell.as_str())).unwrap();
        let netlist = SimulatedNetlist::new(&flat, &models).unwrap();
        let electrics = NetElectrics::of_netlist(&netlist);
        let sum = |activity| {
            let uniform = NetActivity::uniform(&netlist, activity);
            EnergySum::of_activity(&netlist, &electrics, &uniform).unit.total()
        };
        let clock_charge =
            2.0 * models.cells["DFFPOSX1"].pins[0].capacitance * models.voltage.powi(2);
        let wires = "wire n1, n2, n3, n4, n5, n6;";
        let script = "read_liberty cells.lib\nread_verilog netlist.v\nlink_design top\n\
            create_clock -name clk -period 10 [get_ports clk]\n\
            set_power_activity -global -activity 0.1\nreport_power -digits 6\n";
        let files = vec![
            ("cells.lib".to_owned(), std::fs::read_to_string(OSU018).unwrap()),
            (
                "netlist.v".to_owned(),
                format!("module top (clk, q);\ninput clk; output q; {wires}\n{gates}\nendmodule\n"),
            ),
        ];
        let folder = tempfile::tempdir().unwrap();
        let (toolchain, cache) = (Toolchain::system(), Cache::in_folder(folder.path()).unwrap());
        let log =
            opensta::run(&toolchain, &cache, &OpenStaJob { files, script: script.to_owned() })
                .unwrap();
        let total = log.lines().find(|line| line.starts_with("Total")).unwrap();
        let watts: Vec<f64> =
            total.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let witness = (watts[0] / 2.0 + watts[1]) * 10e-9 * 1e12 + clock_charge;
        let own = sum(0.1);
        assert!((own / witness - 1.0).abs() < 0.02, "{own} pJ here, {witness} pJ by OpenSTA");
        assert!(sum(0.05) < own);
    }
}
