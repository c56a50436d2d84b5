// SPDX-License-Identifier: MIT OR Apache-2.0
//! Replaces ports by flip-flops. A core is usually inside a chip: its inputs are driven, and its
//! outputs are read, by nearby registers and not by pins, of which there are too few.
//!
//! An input bit comes from a flip-flop that holds its value; an output bit goes into a flip-flop
//! that nothing reads. So paths from and to ports are timed as in a chip where the neighbour
//! registers them, no pin affects the placement, and no logic is added. Constants at outputs need
//! no flip-flop.

use super::device::Family;
use super::netlist::{Bit, Cell, Netlist};
use crate::error::EstimateError;

/// Replaces every port except the clock, which keeps its pin. Returns the number of flip-flops in
/// place of ports.
///
/// # Errors
/// Fails if there is no clock.
pub(super) fn become_registers(
    netlist: &mut Netlist,
    clock_port: &'static str,
    family: Family,
) -> Result<u64, EstimateError> {
    let clock = netlist.ports.get(clock_port).and_then(|port| port.bits.first()).cloned();
    let clock = clock.ok_or(EstimateError::NoClock { port: clock_port })?;
    let mut net = netlist.last_net();
    let ports = std::mem::take(&mut netlist.ports);
    let before = netlist.cells.len();
    for (name, port) in ports {
        if name == clock_port {
            netlist.ports.insert(name, port);
            continue;
        }
        for (index, bit) in port.bits.iter().enumerate().filter(|(_, bit)| bit.net().is_some()) {
            let out = if port.direction == "input" {
                bit.clone()
            } else {
                net += 1;
                Bit::Net(net)
            };
            let cell = register(family, clock.clone(), bit.clone(), out);
            netlist.cells.insert(cell_name(&name, index), cell);
        }
    }
    let registers = netlist.cells.len() - before;
    if family == Family::Gowin {
        pad(netlist, clock_port, net + 1);
    }
    Ok(registers as u64)
}

/// Inserts the input buffer that nextpnr requires between the clock and its pin.
fn pad(netlist: &mut Netlist, clock_port: &str, outside: u32) {
    if let Some(bit) = netlist.ports.get_mut(clock_port).and_then(|port| port.bits.first_mut()) {
        let inside = std::mem::replace(bit, Bit::Net(outside));
        let joined = [("I", false, Bit::Net(outside)), ("O", true, inside)];
        netlist.cells.insert("$pad$".to_owned(), Cell::new("IBUF", &[], &joined));
    }
}

const PREFIX: &str = "$port$";

fn cell_name(port: &str, index: usize) -> String {
    format!("{PREFIX}{port}[{index}]")
}

/// Returns the port bit that a flip-flop replaces.
pub(super) fn port_of(cell: &str) -> Option<&str> {
    cell.strip_prefix(PREFIX)
}

/// Returns a flip-flop without enable and reset.
fn register(family: Family, clock: Bit, data: Bit, out: Bit) -> Cell {
    match family {
        Family::Ecp5 => {
            // A space after a text of digits marks it as text.
            let parameters = [
                ("CEMUX", "1 "),
                ("CLKMUX", "CLK"),
                ("GSR", "DISABLED"),
                ("LSRMUX", "LSR"),
                ("REGSET", "RESET"),
            ];
            let joined = [("CLK", false, clock), ("DI", false, data), ("Q", true, out)];
            Cell::new("TRELLIS_FF", &parameters, &joined)
        }
        Family::Ice40Up | Family::Ice40Hx => {
            let joined = [("C", false, clock), ("D", false, data), ("Q", true, out)];
            Cell::new("SB_DFF", &[], &joined)
        }
        Family::Gowin => {
            let joined = [("CLK", false, clock), ("D", false, data), ("Q", true, out)];
            Cell::new("DFF", &[], &joined)
        }
    }
}
