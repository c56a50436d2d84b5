// SPDX-License-Identifier: MIT OR Apache-2.0
//! Flip-flops behind a block RAM of ECP5 move into its output register, which Yosys leaves unused: a block
//! without it is slow to show what it has read.
//!
//! The register has one enable for all outputs of a side, and starts at 0. So a side is changed only where
//! each of its outputs goes into one flip-flop alone, without enable and reset, on the block's own clock,
//! and where the block itself is never reset.

use std::collections::HashMap;

use super::netlist::{Bit, Netlist};

/// Moves what can be moved; returns how many flip-flops that were.
pub(super) fn absorb(netlist: &mut Netlist) -> u64 {
    let loads = netlist.loads();
    let blocks = netlist.cells.iter().filter(|(_, cell)| cell.kind == "DP16KD");
    let sides = blocks.flat_map(|(name, _)| ["A", "B"].map(|side| (name.clone(), side)));
    let moves: Vec<_> = sides
        .filter_map(|(block, side)| {
            let registers = registers(netlist, &loads, &block, side)?;
            Some((block, side, registers))
        })
        .collect();
    let mut moved = 0;
    for (block, side, registers) in moves {
        for (port, register) in registers {
            let register = netlist.cells.remove(&register);
            let out = register.and_then(|cell| cell.bit("Q").cloned());
            let block = netlist.cells.get_mut(&block).expect("blocks are not removed");
            block.connections.insert(port, out.into_iter().collect());
            moved += 1;
        }
        let block = netlist.cells.get_mut(&block).expect("blocks are not removed");
        block.parameters.insert(format!("REGMODE_{side}"), "OUTREG".into());
        block.connections.insert(format!("OCE{side}"), vec![Bit::Constant("1".to_owned())]);
        block.port_directions.insert(format!("OCE{side}"), "input".to_owned());
    }
    moved
}

/// The flip-flop behind each output of a side that is read; nothing where one cannot be moved, or none is.
fn registers(
    netlist: &Netlist,
    loads: &HashMap<u32, Vec<(String, String)>>,
    block: &str,
    side: &str,
) -> Option<Vec<(String, String)>> {
    let cell = &netlist.cells[block];
    let clock = cell.bit(&format!("CLK{side}"))?;
    if cell.bit(&format!("RST{side}")).is_some_and(|reset| !reset.is_zero()) {
        return None;
    }
    let of_ports: Vec<u32> =
        netlist.ports.values().flat_map(|port| port.bits.iter().filter_map(Bit::net)).collect();
    let mut found = Vec::new();
    for port in cell.connections.keys().filter(|port| port.starts_with(&format!("DO{side}"))) {
        let Some(net) = cell.net(port) else { continue };
        if of_ports.contains(&net) {
            return None;
        }
        match loads.get(&net).map(Vec::as_slice) {
            None => {}
            Some([(register, pin)]) if pin == "DI" && is_plain(netlist, register, clock) => {
                found.push((port.clone(), register.clone()));
            }
            Some(_) => return None,
        }
    }
    (!found.is_empty()).then_some(found)
}

/// A flip-flop that takes its data at every edge of that clock, and is never reset.
fn is_plain(netlist: &Netlist, name: &str, clock: &Bit) -> bool {
    let cell = &netlist.cells[name];
    let never_reset = cell.bit("LSR").is_none_or(Bit::is_zero);
    cell.kind == "TRELLIS_FF"
        && cell.bit("CLK") == Some(clock)
        && cell.text("CLKMUX") != Some("INV")
        && cell.text("CEMUX") == Some("1")
        && cell.text("REGSET") != Some("SET")
        && never_reset
}
