// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a cell: the inputs that each output depends on, and the pins at which paths start
//! and end.

use super::delay;
use super::joint::{Joint, joints};
use super::path::Weight;
use super::raw::{Bit, RawCell};
use crate::cells::CellKind;

/// The parts of paths at one cell, in nets of its module.
#[derive(Default)]
pub(super) struct CellTiming {
    /// The input net and the output net of each arc, and the weight that it adds to a path.
    pub(super) arcs: Vec<(u32, u32, Weight)>,
    /// The outputs at which paths start, and their initial weights.
    pub(super) starts: Vec<(u32, Weight)>,
    /// The inputs at which paths end, and their pins.
    pub(super) ends: Vec<(u32, String)>,
}

impl CellTiming {
    /// Returns the timing of a cell of a kind. `chained` returns whether a net is the last carry of
    /// another block.
    pub(super) fn of(kind: CellKind, cell: &RawCell, chained: impl Fn(u32) -> bool) -> Self {
        let mut timing = Self::default();
        let outputs: Vec<_> = joints(cell).filter(|joint| is_output(kind, joint.port)).collect();
        for input in joints(cell).filter(|joint| !is_output(kind, joint.port)) {
            if is_clock(kind, input.port) {
                continue;
            }
            for output in &outputs {
                if let Some(weight) = arc(kind, cell, &input, output, &chained) {
                    let time = Weight::wired(delay::arc(kind, cell, &input, output));
                    timing.arcs.push((input.net, output.net, weight.plus(time)));
                }
            }
            if is_end(kind, cell, input.port) {
                timing.ends.push((input.net, input.port.to_owned()));
            }
        }
        if let Some(weight) = start(kind, cell) {
            let weight = weight.plus(delay::start(kind, cell));
            timing.starts.extend(outputs.iter().map(|output| (output.net, weight)));
        }
        timing
    }
}

/// Returns the last carry of a block, from which a chain continues.
pub(super) fn carry_out(cell: &RawCell) -> Option<u32> {
    matches!(CellKind::of(&cell.kind), Some(CellKind::Carry(_)))
        .then(|| cell.connections.get("CO")?.last().and_then(Bit::net))
        .flatten()
}

fn is_output(kind: CellKind, port: &str) -> bool {
    match kind {
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => {
            matches!(port, "O" | "O5" | "O6" | "CO" | "P" | "G")
        }
        CellKind::Srl16 | CellKind::FlipFlop => port.starts_with('Q'),
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
fn arc(
    kind: CellKind,
    cell: &RawCell,
    input: &Joint<'_>,
    output: &Joint<'_>,
    chained: impl Fn(u32) -> bool,
) -> Option<Weight> {
    match kind {
        CellKind::Lut(_) | CellKind::Inverter => Some(Weight::LEVEL),
        CellKind::Free => Some(Weight::NONE),
        CellKind::Carry(_) => {
            // Bit i of the sum does not depend on bit i of the data, but bit i of the carry does.
            let waits = match input.port {
                "S" => input.index <= output.index,
                "DI" if output.port == "O" => input.index < output.index,
                "DI" => input.index <= output.index,
                _ => true,
            };
            let inside = input.port == "CI" && chained(input.net);
            waits.then_some(if inside { Weight::BLOCK } else { Weight::CHAIN })
        }
        CellKind::Srl16 | CellKind::Memory(_) => {
            read_address(output.port, input.port).then_some(Weight::LEVEL)
        }
        CellKind::Dsp => {
            let through = is_unregistered(cell, "M") && is_unregistered(cell, "P");
            (through && is_data(cell, input.port)).then_some(Weight::LEVEL)
        }
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => None,
    }
}

/// Returns whether an input addresses the read of a distributed memory's output: `ADDRB` for `DOB`,
/// `DPRA` for `DPO`, and `A` for the others. The end of a shift register (`Q31`) is not addressed.
fn read_address(output: &str, input: &str) -> bool {
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
fn is_end(kind: CellKind, cell: &RawCell, port: &str) -> bool {
    match kind {
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => true,
        CellKind::Srl16 => !port.starts_with('A'),
        CellKind::Memory(_) => {
            // The write address is also a read address; a shift register has no write address.
            let is_shift_address = cell.kind.starts_with("SRL") && port.starts_with('A');
            let only_read = port.starts_with("DPRA")
                || port.strip_prefix("ADDR").is_some_and(|letter| !is_written(cell, letter));
            !(only_read || is_shift_address)
        }
        CellKind::Dsp => {
            let through = is_unregistered(cell, "M") && is_unregistered(cell, "P");
            !(through && is_data(cell, port))
        }
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => false,
    }
}

/// Returns whether a memory is written at this address. Memories with several addresses are written
/// at the last one.
fn is_written(cell: &RawCell, letter: &str) -> bool {
    let addresses = cell.connections.keys().filter_map(|port| port.strip_prefix("ADDR"));
    addresses.max() == Some(letter)
}

/// Returns the initial weight of a path that starts at the outputs; `None` if no path starts there.
fn start(kind: CellKind, cell: &RawCell) -> Option<Weight> {
    match kind {
        CellKind::FlipFlop | CellKind::Srl16 | CellKind::BlockRam(_) | CellKind::UltraRam => {
            Some(Weight::NONE)
        }
        // A written word leaves the memory through the multiplexer that reads it.
        CellKind::Memory(_) if cell.kind.starts_with("SRL") => Some(Weight::NONE),
        CellKind::Memory(_) => Some(Weight::LEVEL),
        CellKind::Dsp => {
            Some(if is_unregistered(cell, "P") { Weight::LEVEL } else { Weight::NONE })
        }
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => None,
    }
}

/// Returns whether a DSP block lacks the register of that name; it has the register unless the
/// parameter is 0.
fn is_unregistered(cell: &RawCell, register: &str) -> bool {
    cell.number(&format!("{register}REG")) == Some(0)
}

/// Returns whether an input of a DSP block enters the multiplication or addition without a
/// register.
fn is_data(cell: &RawCell, port: &str) -> bool {
    matches!(port, "A" | "B" | "C" | "D") && is_unregistered(cell, port)
}
