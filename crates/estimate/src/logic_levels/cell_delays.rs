// SPDX-License-Identifier: MIT OR Apache-2.0
//! The delays of Xilinx cells in picoseconds, from the `specify` blocks of Yosys' cell models
//! (`xilinx/cells_sim.v`). Where a `specify` block has a delay for each bit, the delay of the
//! slowest bit is used for a whole group of bits.
//!
//! * The models are those of the 7 series. Yosys has none of UltraScale+, and uses these for it.
//! * Setup times are left out, as those of ECP5 are 0.

use super::path::PathWeight;
use super::pin_connection::PinConnection;
use super::raw_netlist::PathCell;
use crate::cells::CellKind;

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
pub(super) fn start_weight(kind: CellKind, cell: &PathCell) -> PathWeight {
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
