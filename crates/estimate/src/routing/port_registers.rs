// SPDX-License-Identifier: MIT OR Apache-2.0
//! Replaces ports by flip-flops. A core is usually inside a chip: its inputs are driven, and its
//! outputs are read, by nearby registers and not by pins, of which there are too few.
//!
//! An input bit comes from a flip-flop that holds its value; an output bit goes into a flip-flop
//! that nothing reads. Paths from and to ports thus have the timing of a chip in which the
//! neighbouring logic registers its signals. No pin affects the placement, and no logic is added.
//! Constants at outputs need no flip-flop.

use super::device::DeviceFamily;
use super::netlist::{NetlistBit, NetlistCell, PlacementNetlist};
use crate::error::EstimateError;

/// Replaces every port except the clock, which keeps its pin. Returns the number of flip-flops in
/// place of ports.
///
/// # Errors
/// Fails if there is no clock.
pub(super) fn replace_ports(
    netlist: &mut PlacementNetlist,
    clock_port: &'static str,
    family: DeviceFamily,
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
                NetlistBit::Net(net)
            };
            let cell = flip_flop(family, clock.clone(), bit.clone(), out);
            netlist.cells.insert(cell_name(&name, index), cell);
        }
    }
    let registers = netlist.cells.len() - before;
    if family == DeviceFamily::Gowin {
        add_clock_buffer(netlist, clock_port, net + 1);
    }
    Ok(registers as u64)
}

/// Inserts the input buffer that nextpnr requires between the clock and its pin.
fn add_clock_buffer(netlist: &mut PlacementNetlist, clock_port: &str, outside: u32) {
    if let Some(bit) = netlist.ports.get_mut(clock_port).and_then(|port| port.bits.first_mut()) {
        let inside = std::mem::replace(bit, NetlistBit::Net(outside));
        let pins = [("I", false, NetlistBit::Net(outside)), ("O", true, inside)];
        netlist.cells.insert("$pad$".to_owned(), NetlistCell::new("IBUF", &[], &pins));
    }
}

const PORT_CELL_PREFIX: &str = "$port$";

fn cell_name(port: &str, index: usize) -> String {
    format!("{PORT_CELL_PREFIX}{port}[{index}]")
}

/// Returns the port bit that a flip-flop replaces.
pub(super) fn replaced_port(cell: &str) -> Option<&str> {
    cell.strip_prefix(PORT_CELL_PREFIX)
}

/// Returns a flip-flop without enable and reset.
fn flip_flop(
    family: DeviceFamily,
    clock: NetlistBit,
    data: NetlistBit,
    out: NetlistBit,
) -> NetlistCell {
    match family {
        DeviceFamily::Ecp5 => {
            // A space after a text of digits marks it as text.
            let parameters = [
                ("CEMUX", "1 "),
                ("CLKMUX", "CLK"),
                ("GSR", "DISABLED"),
                ("LSRMUX", "LSR"),
                ("REGSET", "RESET"),
            ];
            let pins = [("CLK", false, clock), ("DI", false, data), ("Q", true, out)];
            NetlistCell::new("TRELLIS_FF", &parameters, &pins)
        }
        DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx => {
            let pins = [("C", false, clock), ("D", false, data), ("Q", true, out)];
            NetlistCell::new("SB_DFF", &[], &pins)
        }
        DeviceFamily::Gowin => {
            let pins = [("CLK", false, clock), ("D", false, data), ("Q", true, out)];
            NetlistCell::new("DFF", &[], &pins)
        }
    }
}
