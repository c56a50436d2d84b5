// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a cell: the inputs that each output depends on, and the pins at which paths
//! start and end ([`CellTiming`]).
//!
//! Delays are in picoseconds, from the `specify` blocks of Yosys' cell models
//! (`xilinx/cells_sim.v`). Where a `specify` block has a delay for each bit, the delay of the
//! slowest bit is used for a whole group of bits.
//!
//! * The models are those of the 7 series. Yosys has none of UltraScale+, and uses these for
//!   it.
//! * Setup times are left out, as those of ECP5 are 0.

use super::path::PathWeight;
use super::raw_netlist::{PathBit, PathCell};
use crate::cells::CellKind;

/// The parts of paths at one cell, in nets of its module.
#[derive(Default)]
pub(super) struct CellTiming {
    /// The input net and the output net of each arc, and the weight that it adds to a path.
    pub(super) arcs: Vec<(u32, u32, PathWeight)>,
    /// The outputs at which paths start, and their initial weights.
    pub(super) starts: Vec<(u32, PathWeight)>,
    /// The inputs at which paths end, and their pins.
    pub(super) ends: Vec<(u32, String)>,
}

impl CellTiming {
    /// Returns the timing of a cell of a kind. `chained` returns whether a net is the last carry of
    /// another block.
    pub(super) fn of(kind: CellKind, cell: &PathCell, is_last_carry: impl Fn(u32) -> bool) -> Self {
        let mut timing = Self::default();
        let outputs: Vec<_> =
            pin_connections(cell).filter(|pin| is_output(kind, pin.port)).collect();
        for input in pin_connections(cell).filter(|pin| !is_output(kind, pin.port)) {
            if is_clock(kind, input.port) {
                continue;
            }
            for output in &outputs {
                if let Some(weight) = arc_weight(kind, cell, &input, output, &is_last_carry) {
                    let time = PathWeight::with_wires(arc_delay(kind, cell, &input, output));
                    timing.arcs.push((input.net, output.net, weight.plus(time)));
                }
            }
            if is_end(kind, cell, input.port) {
                timing.ends.push((input.net, input.port.to_owned()));
            }
        }
        if let Some(weight) = start_weight(kind, cell) {
            let weight = weight.plus(delay_of_start(kind, cell));
            timing.starts.extend(outputs.iter().map(|output| (output.net, weight)));
        }
        timing
    }
}

/// Returns the net of the last carry of a block. The next block of the chain continues from it.
pub(super) fn carry_out(cell: &PathCell) -> Option<u32> {
    matches!(CellKind::from_type(&cell.kind), Some(CellKind::Carry(_)))
        .then(|| cell.connections.get("CO")?.last().and_then(PathBit::net))
        .flatten()
}

fn is_output(kind: CellKind, port: &str) -> bool {
    match kind {
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => {
            matches!(port, "O" | "O5" | "O6" | "CO" | "P" | "G")
        }
        CellKind::ShiftRegister16 | CellKind::FlipFlop => port.starts_with('Q'),
        CellKind::Memory(_) => {
            port == "O" || port.starts_with('Q') || port.starts_with("DO") || port.ends_with("PO")
        }
        CellKind::Dsp => {
            port == "P"
                || port == "UNDERFLOW"
                || port.ends_with("OUT")
                || port.contains("DETECT")
                || port == "OVERFLOW"
        }
        CellKind::BlockRam(_) | CellKind::UltraRam => {
            ["DO", "CASDO", "SBITERR", "DBITERR", "RDACCESS", "ECCPARITY"]
                .iter()
                .any(|start| port.starts_with(start))
        }
    }
}

fn is_clock(kind: CellKind, port: &str) -> bool {
    port.contains("CLK") || (kind == CellKind::FlipFlop && port == "C")
}

/// Returns the weight of the arc from this input to this output; `None` if the output does not
/// depend on the input.
fn arc_weight(
    kind: CellKind,
    cell: &PathCell,
    input: &PinConnection<'_>,
    output: &PinConnection<'_>,
    is_last_carry: impl Fn(u32) -> bool,
) -> Option<PathWeight> {
    match kind {
        CellKind::Lut(_) | CellKind::Inverter => Some(PathWeight::LEVEL),
        CellKind::Free => Some(PathWeight::NONE),
        CellKind::Carry(_) => {
            // Bit i of the sum does not depend on bit i of the data, but bit i of the carry does.
            let depends = match input.port {
                "S" => input.index <= output.index,
                "DI" if output.port == "O" => input.index < output.index,
                "DI" => input.index <= output.index,
                _ => true,
            };
            let is_chained = input.port == "CI" && is_last_carry(input.net);
            depends.then_some(if is_chained { PathWeight::BLOCK } else { PathWeight::CHAIN })
        }
        CellKind::ShiftRegister16 | CellKind::Memory(_) => {
            is_read_address(output.port, input.port).then_some(PathWeight::LEVEL)
        }
        CellKind::Dsp => {
            let is_combinational = is_unregistered(cell, "M") && is_unregistered(cell, "P");
            (is_combinational && is_data(cell, input.port)).then_some(PathWeight::LEVEL)
        }
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => None,
    }
}

/// Returns whether an input addresses the read of a distributed memory's output: `ADDRB` for `DOB`,
/// `DPRA` for `DPO`, and `A` for the others. The end of a shift register (`Q31`) is not addressed.
fn is_read_address(output: &str, input: &str) -> bool {
    let is_numbered = |name: &str, start: &str| {
        name.strip_prefix(start).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
    };
    match (output, output.strip_prefix("DO")) {
        (_, Some(letter)) => input.strip_prefix("ADDR") == Some(letter),
        ("DPO", _) => is_numbered(input, "DPRA"),
        ("O" | "SPO" | "Q", _) => is_numbered(input, "A"),
        _ => false,
    }
}

/// Returns whether a path ends at an input. Data of a multiplier without input registers pass
/// through, unless a register follows the multiplication.
fn is_end(kind: CellKind, cell: &PathCell, port: &str) -> bool {
    match kind {
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => true,
        CellKind::ShiftRegister16 => !port.starts_with('A'),
        CellKind::Memory(_) => {
            // The write address is also a read address; a shift register has no write address.
            let is_shift_address = cell.kind.starts_with("SRL") && port.starts_with('A');
            let is_read_only = port.starts_with("DPRA")
                || port.strip_prefix("ADDR").is_some_and(|letter| !is_written(cell, letter));
            !(is_read_only || is_shift_address)
        }
        CellKind::Dsp => {
            let is_combinational = is_unregistered(cell, "M") && is_unregistered(cell, "P");
            !(is_combinational && is_data(cell, port))
        }
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => false,
    }
}

/// Returns whether a memory is written at this address. Memories with several addresses are written
/// at the last one.
fn is_written(cell: &PathCell, letter: &str) -> bool {
    let addresses = cell.connections.keys().filter_map(|port| port.strip_prefix("ADDR"));
    addresses.max() == Some(letter)
}

/// Returns the initial weight of a path that starts at the outputs; `None` if no path starts there.
fn start_weight(kind: CellKind, cell: &PathCell) -> Option<PathWeight> {
    match kind {
        CellKind::FlipFlop
        | CellKind::ShiftRegister16
        | CellKind::BlockRam(_)
        | CellKind::UltraRam => Some(PathWeight::NONE),
        // A written word leaves the memory through the multiplexer that reads it.
        CellKind::Memory(_) if cell.kind.starts_with("SRL") => Some(PathWeight::NONE),
        CellKind::Memory(_) => Some(PathWeight::LEVEL),
        CellKind::Dsp => {
            Some(if is_unregistered(cell, "P") { PathWeight::LEVEL } else { PathWeight::NONE })
        }
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => None,
    }
}

/// Returns whether a DSP block lacks the register of that name; it has the register unless the
/// parameter is 0.
fn is_unregistered(cell: &PathCell, register: &str) -> bool {
    cell.number(&format!("{register}REG")) == Some(0)
}

/// Returns whether an input of a DSP block enters the multiplication or addition without a
/// register.
fn is_data(cell: &PathCell, port: &str) -> bool {
    matches!(port, "A" | "B" | "C" | "D") && is_unregistered(cell, port)
}

/// The delays from an input of a look-up table to its output, beginning with the last input, which
/// is the fastest.
const LUT_DELAYS: [u32; 6] = [127, 238, 407, 472, 631, 642];
/// The delay from the clock to the output of a flip-flop.
const FLIP_FLOP_START: u32 = 303;
/// The delay from the clock to the output of a shift register.
const SHIFT_START: u32 = 1472;
/// The delay from the clock to the output of distributed RAM.
const MEMORY_START: u32 = 1190;
/// The delays from the clock to the output of block RAM, without and with its output register.
const BLOCK_START: [u32; 2] = [2454, 882];

pub(super) fn arc_delay(
    kind: CellKind,
    cell: &PathCell,
    input: &PinConnection<'_>,
    output: &PinConnection<'_>,
) -> u32 {
    match kind {
        CellKind::Lut(inputs) => lut_delay(inputs.saturating_sub(1 + input_number(input))),
        CellKind::Inverter => LUT_DELAYS[0],
        CellKind::ShiftRegister16 => lut_delay(4_usize.saturating_sub(input_number(input))),
        CellKind::Memory(_) => lut_delay(5_usize.saturating_sub(input_number(input))),
        CellKind::Carry(_) => carry_delay(input, output),
        CellKind::Free => match (cell.kind.as_str(), input.port) {
            ("MUXF7", "S") => 296,
            ("MUXF7", _) => 223,
            ("MUXF8" | "MUXF9", "S") => 273,
            ("MUXF8" | "MUXF9", _) => 104,
            _ => 0,
        },
        CellKind::Dsp => match input.port {
            "A" => 2823,
            "B" => 2690,
            "D" => 3717,
            _ => 1325,
        },
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => 0,
    }
}

/// Returns the initial weight of a path at the outputs of a cell.
pub(super) fn delay_of_start(kind: CellKind, cell: &PathCell) -> PathWeight {
    let registered = ["DOA_REG", "DOB_REG"].iter().any(|name| cell.number(name) == Some(1));
    let clock_to_output = match kind {
        CellKind::ShiftRegister16 => SHIFT_START,
        CellKind::Memory(_) if cell.kind.starts_with("SRL") => SHIFT_START,
        CellKind::Memory(_) => MEMORY_START,
        // There is no model of UltraRAM, so that of block RAM is used.
        CellKind::BlockRam(_) | CellKind::UltraRam => BLOCK_START[usize::from(registered)],
        _ => FLIP_FLOP_START,
    };
    PathWeight::after_clock(clock_to_output, FLIP_FLOP_START)
}

fn lut_delay(behind_last: usize) -> u32 {
    LUT_DELAYS[behind_last.min(LUT_DELAYS.len() - 1)]
}

/// Returns the number of an input among those of its kind: `I3`, `DPRA3` and bit 3 of `ADDRA` are
/// 3.
fn input_number(input: &PinConnection<'_>) -> usize {
    let digits = input.port.trim_start_matches(|c: char| !c.is_ascii_digit());
    digits.parse().unwrap_or(input.index)
}

fn carry_delay(input: &PinConnection<'_>, output: &PinConnection<'_>) -> u32 {
    match (input.port, output.port, output.index) {
        ("CI", "CO", 3 | 7) => 114,
        ("CI", "CO", _) => 271,
        ("CI", ..) => 334,
        ("CYINIT", "CO", _) => 592,
        ("CYINIT", ..) => 642,
        (_, "CO", _) => 548,
        _ => 618,
    }
}

/// A net and the pin that it is connected to.
pub(super) struct PinConnection<'a> {
    pub(super) port: &'a str,
    pub(super) index: usize,
    pub(super) net: u32,
}

/// Returns every pin of a cell that is connected to a net, port by port.
pub(super) fn pin_connections(cell: &PathCell) -> impl Iterator<Item = PinConnection<'_>> {
    cell.connections.iter().flat_map(|(port, bits)| {
        let joint = move |(index, bit): (usize, &PathBit)| {
            Some(PinConnection { port, index, net: bit.net()? })
        };
        bits.iter().enumerate().filter_map(joint)
    })
}
