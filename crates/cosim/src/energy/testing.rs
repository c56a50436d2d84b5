// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small netlists and libraries for tests.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use foveate_estimate::{FlatNetlist, LOW_NET, LibertyLibrary, NetlistGate};

/// The library of Debian's package `qflow-tech-osu018`.
pub(crate) const OSU018: &str = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

/// Returns true if the library is there. Where tools are required, it must be.
pub(crate) fn has_library() -> bool {
    let is_there = Path::new(OSU018).exists();
    assert!(is_there || std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_none(), "no {OSU018}");
    is_there
}

/// Returns a netlist of instances in Verilog, one per line, all in a unit.
pub(crate) fn flat_netlist(gates: &str) -> FlatNetlist {
    let mut nets = BTreeMap::new();
    let mut gate_list = Vec::new();
    for line in gates.lines() {
        let (cell, pins) = line.trim().split_once(' ').unwrap();
        let pins = pins.split('.').skip(1).map(|pin| {
            let (pin, net) = pin.split_once('(').unwrap();
            let net = net.split(')').next().unwrap();
            let number = nets.len() + 2;
            (pin.to_owned(), *nets.entry(net.to_owned()).or_insert(number))
        });
        gate_list.push(NetlistGate {
            cell: cell.to_owned(),
            pins: pins.collect(),
            is_in_unit: true,
        });
    }
    let port = |name: &str| (name.to_owned(), vec![nets.get(name).copied().unwrap_or(LOW_NET)]);
    FlatNetlist {
        nets: nets.len() + 2,
        gates: gate_list,
        inputs: [port("clk")].into(),
        outputs: [port("q")].into(),
        memory_nets: BTreeSet::new(),
    }
}

/// Returns a library of an inverter and a flip-flop, in which no energy depends on times and loads.
/// The texts are added to the pin of the clock and to the output of the inverter. `DFFC` is a
/// flip-flop that R clears.
pub(crate) fn tiny_library(at_clock: &str, at_output: &str) -> LibertyLibrary {
    let energy = |related: &str, rise: &str, fall: &str| {
        format!(
            "internal_power () {{ {related} rise_power (scalar) {{ values (\"{rise}\"); }} \
             fall_power (scalar) {{ values (\"{fall}\"); }} }}"
        )
    };
    let text = format!(
        "library (tiny) {{ nom_voltage : 2; capacitive_load_unit (1, pf);
        cell (INV) {{ pin (A) {{ direction : input; capacitance : 2; }}
            pin (Y) {{ direction : output; function : \"!A\"; {at_output} {} }} }}
        cell (DFF) {{ ff (IQ, IQN) {{ clocked_on : \"CLK\"; next_state : \"D\"; }}
            pin (CLK) {{ direction : input; capacitance : 1; {at_clock} {} }}
            pin (D) {{ direction : input; capacitance : 4; {} }}
            pin (Q) {{ direction : output; function : \"IQ\"; {} }} }}
        cell (DFFC) {{ ff (IQ, IQN) {{ clocked_on : \"CLK\"; next_state : \"D\"; clear : \"R\"; }}
            pin (CLK) {{ direction : input; }} pin (D) {{ direction : input; }} pin (R) {{ direction : input; }}
            pin (Q) {{ direction : output; function : \"IQ\"; }} pin (QN) {{ direction : output; function : \"IQN\"; }} }} }}",
        energy("related_pin : \"A\";", "3", "5"),
        energy("", "1", "2"),
        energy("", "0.5", "0.25"),
        energy("related_pin : \"CLK\";", "7", "9"),
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tiny.lib");
    std::fs::write(&path, text).unwrap();
    LibertyLibrary::read(&path).unwrap()
}
