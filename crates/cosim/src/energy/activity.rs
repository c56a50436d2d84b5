// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rises and falls of nets, and the conditions under which cells take energy.

use foveate_estimate::{CellPin, HIGH_NET, InternalEnergy, LOW_NET, LogicFunction, count_to_f64};

use crate::energy::gate_simulation::GateSimulation;
use crate::energy::simulated_netlist::SimulatedNetlist;

/// The activity of a netlist over a number of clocks. A pair of counts is of rises and falls.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NetActivity {
    /// The number of clocks of all simulations together.
    pub(crate) clocks: f64,
    /// The changes of each net.
    pub(crate) nets: Vec<[f64; 2]>,
    /// For each energy of each pin of each gate, the number of changes of the pin under its
    /// condition. A change of an output counts only if a related input changes at the same clock.
    pub(crate) energies: Vec<Vec<Vec<[f64; 2]>>>,
}

pub(crate) struct ActivityCounter<'a> {
    netlist: &'a SimulatedNetlist<'a>,
    clocks: u64,
    nets: Vec<[u64; 2]>,
    pins: Vec<CountedPin<'a>>,
    /// The numbers of the pins at each net; a pin of a clock is at all nets of its cell.
    pins_of_net: Vec<Vec<usize>>,
    clock_pins: Vec<usize>,
    /// True if the conditions at clocks are those of the last clock.
    knows_conditions: bool,
}

struct CountedPin<'a> {
    gate: usize,
    /// The number of the pin in its cell.
    at: usize,
    pin: &'a CellPin,
    is_clock: bool,
    /// The changes that belong to each energy.
    counts: Vec<[u64; 2]>,
    /// For a clock, the simulations in which the condition of each energy is met.
    met: Vec<u64>,
}

impl NetActivity {
    /// Returns an activity of one clock in which every net changes equally often.
    pub(crate) fn uniform(netlist: &SimulatedNetlist<'_>, changes_per_clock: f64) -> Self {
        let is_constant = |net| net == LOW_NET || net == HIGH_NET;
        let half = |net| if is_constant(net) { 0.0 } else { changes_per_clock / 2.0 };
        let energies = netlist.gates.iter().map(|gate| {
            let pins = gate.model.pins.iter().enumerate();
            let pins = pins.map(|(at, pin)| {
                let changes = if gate.clock() == Some(at) { 1.0 } else { half(gate.nets[at]) };
                let can_cause = |energy: &InternalEnergy| {
                    let mut related = energy.related_pins.iter();
                    energy.related_pins.is_empty()
                        || related.any(|&pin| !is_constant(gate.nets[pin]))
                };
                // Without the values of the pins each condition is as likely as another.
                let possible = pin.energies.iter().filter(|energy| can_cause(energy)).count();
                let each = changes / count_to_f64(possible.max(1) as u64);
                let share = |energy| if can_cause(energy) { [each; 2] } else { [0.0; 2] };
                pin.energies.iter().map(share).collect()
            });
            pins.collect()
        });
        Self {
            clocks: 1.0,
            nets: (0..netlist.nets).map(|net| [half(net); 2]).collect(),
            energies: energies.collect(),
        }
    }
}

impl<'a> ActivityCounter<'a> {
    pub(crate) fn new(netlist: &'a SimulatedNetlist<'a>) -> Self {
        let mut counter = Self {
            netlist,
            clocks: 0,
            nets: vec![[0; 2]; netlist.nets],
            pins: Vec::new(),
            pins_of_net: vec![Vec::new(); netlist.nets],
            clock_pins: Vec::new(),
            knows_conditions: false,
        };
        for (number, gate) in netlist.gates.iter().enumerate() {
            for (at, pin) in gate.model.pins.iter().enumerate() {
                if pin.energies.is_empty() {
                    continue;
                }
                let (place, is_clock) = (counter.pins.len(), gate.clock() == Some(at));
                if is_clock {
                    counter.clock_pins.push(place);
                    gate.nets.iter().for_each(|&net| counter.pins_of_net[net].push(place));
                } else {
                    counter.pins_of_net[gate.nets[at]].push(place);
                }
                let energies = pin.energies.len();
                let (counts, met) = (vec![[0; 2]; energies], vec![0; energies]);
                counter.pins.push(CountedPin { gate: number, at, pin, is_clock, counts, met });
            }
        }
        counter
    }

    /// Counts the changes from one clock to the next, in the simulations whose bit in `counted`
    /// is 1. `before` are the values of the nets at the clock before. It is called at every clock,
    /// also if no simulation is counted.
    pub(crate) fn count(&mut self, simulation: &GateSimulation<'_>, before: &[u64], counted: u64) {
        if counted == 0 {
            self.knows_conditions = false;
            return;
        }
        if !self.knows_conditions {
            self.knows_conditions = true;
            for &place in &self.clock_pins {
                self.pins[place].find_conditions(simulation);
            }
        }
        let after = simulation.values();
        self.clocks += u64::from(counted.count_ones());
        for (net, (&old, &new)) in before.iter().zip(after).enumerate() {
            if old == new {
                continue;
            }
            let changes = [new & !old & counted, old & !new & counted];
            add(&mut self.nets[net], changes);
            for &place in &self.pins_of_net[net] {
                let pin = &mut self.pins[place];
                match pin.is_clock {
                    true => pin.find_conditions(simulation),
                    false => pin.count(self.netlist, simulation, (before, changes)),
                }
            }
        }
        for &place in &self.clock_pins {
            let CountedPin { counts, met, .. } = &mut self.pins[place];
            counts.iter_mut().zip(met).for_each(|(count, met)| add(count, [*met & counted; 2]));
        }
    }

    pub(crate) fn finish(self) -> NetActivity {
        let pins = self.netlist.gates.iter().map(|gate| vec![Vec::new(); gate.model.pins.len()]);
        let mut energies: Vec<Vec<Vec<[f64; 2]>>> = pins.collect();
        for CountedPin { gate, at, counts, .. } in self.pins {
            energies[gate][at] =
                counts.into_iter().map(|counts| counts.map(count_to_f64)).collect();
        }
        NetActivity {
            clocks: count_to_f64(self.clocks),
            nets: self.nets.into_iter().map(|counts| counts.map(count_to_f64)).collect(),
            energies,
        }
    }
}

impl CountedPin<'_> {
    /// Counts rises and falls of the net by the energies to which they belong.
    fn count(
        &mut self,
        netlist: &SimulatedNetlist<'_>,
        simulation: &GateSimulation<'_>,
        (before, [rises, falls]): (&[u64], [u64; 2]),
    ) {
        let gate = &netlist.gates[self.gate];
        let after = simulation.values();
        let change = |&pin: &usize| match gate.clock() == Some(pin) {
            true => u64::MAX,
            false => before[gate.nets[pin]] ^ after[gate.nets[pin]],
        };
        let value = |when: &LogicFunction| simulation.evaluate(self.gate, when);
        for (energy, count) in self.pin.energies.iter().zip(&mut self.counts) {
            let related = match self.pin.is_output && !energy.related_pins.is_empty() {
                true => energy.related_pins.iter().map(change).fold(0, |any, change| any | change),
                false => u64::MAX,
            };
            let met = condition_of(energy, &self.pin.energies, value);
            add(count, [rises & related & met, falls & related & met]);
        }
    }

    /// Finds the simulations in which the condition of each energy is met.
    fn find_conditions(&mut self, simulation: &GateSimulation<'_>) {
        let value = |when: &LogicFunction| simulation.evaluate(self.gate, when);
        for (energy, met) in self.pin.energies.iter().zip(&mut self.met) {
            *met = condition_of(energy, &self.pin.energies, value);
        }
    }
}

/// Returns the simulations that meet the condition of an energy. Without one, these are all that
/// meet no condition of the other energies of the same related pins, which are in `all`.
fn condition_of(
    energy: &InternalEnergy,
    all: &[InternalEnergy],
    value: impl Fn(&LogicFunction) -> u64,
) -> u64 {
    if let Some(when) = &energy.when {
        return value(when);
    }
    let of_pins = all.iter().filter(|own| own.related_pins == energy.related_pins);
    !of_pins.filter_map(|own| own.when.as_ref()).fold(0, |any, when| any | value(when))
}

fn add(count: &mut [u64; 2], changes: [u64; 2]) {
    for (count, changes) in count.iter_mut().zip(changes) {
        *count += u64::from(changes.count_ones());
    }
}
