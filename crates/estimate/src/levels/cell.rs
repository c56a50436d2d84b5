// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which inputs of a cell its outputs wait for, what starts at it and what ends at it.

use super::delay;
use super::joint::{Joint, joints};
use super::path::Weight;
use super::raw::{Bit, RawCell};
use crate::cells::CellKind;

/// What paths do at one cell, in nets of its module.
#[derive(Default)]
pub(super) struct CellTiming {
    /// From an input to an output, and what that adds to the path.
    pub(super) arcs: Vec<(u32, u32, Weight)>,
    /// Outputs at which paths start, and what they start with.
    pub(super) starts: Vec<(u32, Weight)>,
    /// Inputs at which paths end, and their pins.
    pub(super) ends: Vec<(u32, String)>,
}

impl CellTiming {
    /// The timing of a cell of that kind. `chained` says of a net whether it is the last carry of
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

/// The last carry of a block, from which the chain goes on.
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

/// What a path from this input to this output passes; `None` where the output does not wait for it.
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
            // Bit i of the sum comes before bit i of the data enters, bit i of the carry behind it.
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

/// Whether a distributed memory's output is read at this input: `DOB` at `ADDRB`, `DPO` at `DPRA`,
/// the others at `A`. What leaves a shift register at its end (`Q31`) is not addressed.
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

/// Inputs at which a path ends. Data of a multiplier without input registers goes on instead, unless
/// a register behind the multiplication takes it.
fn is_end(kind: CellKind, cell: &RawCell, port: &str) -> bool {
    match kind {
        CellKind::FlipFlop | CellKind::BlockRam(_) | CellKind::UltraRam => true,
        CellKind::Srl16 => !port.starts_with('A'),
        CellKind::Memory(_) => {
            // The address that is written is one of those that are read; of a shift register, none.
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

/// Memories with several addresses are written at the last one.
fn is_written(cell: &RawCell, letter: &str) -> bool {
    let addresses = cell.connections.keys().filter_map(|port| port.strip_prefix("ADDR"));
    addresses.max() == Some(letter)
}

/// What a path that starts at the outputs starts with.
fn start(kind: CellKind, cell: &RawCell) -> Option<Weight> {
    match kind {
        CellKind::FlipFlop | CellKind::Srl16 | CellKind::BlockRam(_) | CellKind::UltraRam => {
            Some(Weight::NONE)
        }
        // What was written leaves through the multiplexer that reads it.
        CellKind::Memory(_) if cell.kind.starts_with("SRL") => Some(Weight::NONE),
        CellKind::Memory(_) => Some(Weight::LEVEL),
        CellKind::Dsp => {
            Some(if is_unregistered(cell, "P") { Weight::LEVEL } else { Weight::NONE })
        }
        CellKind::Lut(_) | CellKind::Inverter | CellKind::Free | CellKind::Carry(_) => None,
    }
}

/// Whether a DSP block has no register of that name; it has one unless the parameter says 0.
fn is_unregistered(cell: &RawCell, register: &str) -> bool {
    cell.number(&format!("{register}REG")) == Some(0)
}

/// Whether an input of a DSP block goes into the multiplication or addition without a register.
fn is_data(cell: &RawCell, port: &str) -> bool {
    matches!(port, "A" | "B" | "C" | "D") && is_unregistered(cell, port)
}
