// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of the cells of an ECP5, with the delays of Yosys' cell models (`ecp5/cells_sim.v`)
//! in picoseconds. The models give reads of distributed RAM a delay of 0. The delays that the
//! models lack are those of nextpnr 0.11 for speed grade 6.

use super::cell::{CellTiming, pin_connections};
use super::path::PathWeight;
use super::raw_netlist::PathCell;

/// The delays from inputs to outputs.
type DelayTable = &'static [(&'static str, &'static str, u32)];

pub(super) const LUT4: DelayTable =
    &[("A", "Z", 141), ("B", "Z", 275), ("C", "Z", 379), ("D", "Z", 379)];
/// The delays of the multiplexer of two tables.
pub(super) const PFUMX: DelayTable = &[("ALUT", "Z", 98), ("BLUT", "Z", 98), ("C0", "Z", 151)];
/// The delays of the multiplexer of two `PFUMX`.
pub(super) const L6MUX21: DelayTable = &[("D0", "Z", 140), ("D1", "Z", 141), ("SD", "Z", 148)];
/// The delays of two bits of a carry chain; the upper inputs do not reach the lower sum.
#[rustfmt::skip]
pub(super) const CCU2C: DelayTable = &[
    ("A0", "S0", 379), ("B0", "S0", 379), ("C0", "S0", 275), ("D0", "S0", 141), ("CIN", "S0", 257),
    ("A0", "S1", 630), ("B0", "S1", 630), ("C0", "S1", 526), ("D0", "S1", 392), ("CIN", "S1", 273),
    ("A1", "S1", 379), ("B1", "S1", 379), ("C1", "S1", 275), ("D1", "S1", 141),
    ("A0", "COUT", 516), ("B0", "COUT", 516), ("C0", "COUT", 412), ("D0", "COUT", 278),
    ("A1", "COUT", 516), ("B1", "COUT", 516), ("C1", "COUT", 412), ("D1", "COUT", 278),
    ("CIN", "COUT", 43),
];
/// The delay from the clock to the output of a flip-flop, from nextpnr.
const FLIP_FLOP_START: u32 = 525;
/// The delays from the clock to the output of block RAM, without and with its output register, from
/// nextpnr.
const BLOCK_START: [u32; 2] = [5830, 960];
/// The delay through a multiplier, from nextpnr.
const MULTIPLIER: u32 = 3930;

/// Returns the timing of a cell; `None` if the cell is not known.
pub(super) fn timing(cell: &PathCell) -> Option<CellTiming> {
    match cell.kind.as_str() {
        "LUT4" => Some(combinational_timing(cell, LUT4)),
        "PFUMX" => Some(combinational_timing(cell, PFUMX)),
        "L6MUX21" => Some(combinational_timing(cell, L6MUX21)),
        "CCU2C" => Some(combinational_timing(cell, CCU2C)),
        "TRELLIS_FF" => Some(registered_timing(cell, "Q", |_| FLIP_FLOP_START)),
        "DP16KD" => Some(registered_timing(cell, "DO", |port| block_ram_start(cell, port))),
        "TRELLIS_DPR16X4" => Some(memory_timing(cell)),
        "MULT18X18D" => Some(multiplier_timing(cell)),
        "VLO" | "VHI" => Some(CellTiming::default()),
        _ => None,
    }
}

fn combinational_timing(cell: &PathCell, table: DelayTable) -> CellTiming {
    let net = |port: &str| pin_connections(cell).find(|pin| pin.port == port).map(|pin| pin.net);
    let arc = |&(from, to, ps): &(&str, &str, u32)| {
        Some((net(from)?, net(to)?, PathWeight::with_wires(ps)))
    };
    CellTiming { arcs: table.iter().filter_map(arc).collect(), ..CellTiming::default() }
}

/// Returns the timing of a registered cell. Paths end at all inputs except clocks, and start at the
/// outputs, each after its delay.
fn registered_timing(cell: &PathCell, output: &str, ps: impl Fn(&str) -> u32) -> CellTiming {
    let mut timing = CellTiming::default();
    for pin in pin_connections(cell).filter(|pin| !pin.port.contains("CLK")) {
        if pin.port.starts_with(output) {
            timing.starts.push((pin.net, PathWeight::after_clock(ps(pin.port), FLIP_FLOP_START)));
        } else {
            timing.ends.push((pin.net, pin.port.to_owned()));
        }
    }
    timing
}

/// Returns the delay from the clock to an output of block RAM; `DOA3` is an output of side A.
fn block_ram_start(cell: &PathCell, output: &str) -> u32 {
    let side = &output["DO".len().."DO?".len()];
    let registered = cell.text(&format!("REGMODE_{side}")) == Some("OUTREG");
    BLOCK_START[usize::from(registered)]
}

/// Returns the timing of distributed RAM, which is written at the clock and read at any time.
fn memory_timing(cell: &PathCell) -> CellTiming {
    let mut timing = CellTiming::default();
    let outputs = || pin_connections(cell).filter(|pin| pin.port == "DO").map(|pin| pin.net);
    for pin in pin_connections(cell) {
        match pin.port {
            "DO" => timing.starts.push((pin.net, PathWeight::with_wires(FLIP_FLOP_START))),
            "RAD" => timing.arcs.extend(outputs().map(|out| (pin.net, out, PathWeight::NONE))),
            "WCK" => {}
            port => timing.ends.push((pin.net, port.to_owned())),
        }
    }
    timing
}

/// Returns the timing of a multiplier. Multipliers have no registers here, because `synth_ecp5`
/// leaves registers in the fabric.
fn multiplier_timing(cell: &PathCell) -> CellTiming {
    let is_output = |port: &str| port.starts_with('P') || port.starts_with("RO");
    let is_input = |port: &str| port.starts_with('A') || port.starts_with('B');
    let outputs = || pin_connections(cell).filter(|pin| is_output(pin.port)).map(|pin| pin.net);
    let inputs = pin_connections(cell).filter(|pin| is_input(pin.port)).map(|pin| pin.net);
    let each = |from| outputs().map(move |to| (from, to, PathWeight::without_wires(MULTIPLIER)));
    CellTiming { arcs: inputs.flat_map(each).collect(), ..CellTiming::default() }
}
