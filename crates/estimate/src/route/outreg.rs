// SPDX-License-Identifier: MIT OR Apache-2.0
//! Flip-flops behind a block RAM of ECP5 move into its output register, which Yosys leaves unused: a block
//! without it is slow to show what it has read.
//!
//! The register has one enable for all outputs of a side, and starts at 0. So a side is changed only where
//! each of its outputs goes into one flip-flop alone, all with the same enable or none, without reset, on
//! the block's own clock, and where the block itself is never reset.

use std::collections::HashMap;

use super::netlist::{Bit, Cell, Netlist};

/// A side of a block whose outputs can be registered inside.
struct Side {
    block: String,
    letter: &'static str,
    /// Each output that is read, and the flip-flop behind it.
    registers: Vec<(String, String)>,
    enable: Bit,
}

/// Moves what can be moved; returns how many flip-flops that were.
pub(super) fn absorb(netlist: &mut Netlist) -> u64 {
    let loads = netlist.loads();
    let blocks = netlist.cells.iter().filter(|(_, cell)| cell.kind == "DP16KD");
    let sides = blocks.flat_map(|(name, _)| ["A", "B"].map(|letter| (name, letter)));
    let sides: Vec<Side> =
        sides.filter_map(|(block, letter)| side(netlist, &loads, block, letter)).collect();
    let mut moved = 0;
    for Side { block, letter, registers, enable } in sides {
        let count = registers.len() as u64;
        let outs: Vec<_> = registers
            .into_iter()
            .filter_map(|(port, register)| Some((port, netlist.cells.remove(&register)?)))
            .collect();
        let block = netlist.cells.get_mut(&block).expect("blocks are not removed");
        for (port, register) in outs {
            block.connections.insert(port, register.bit("Q").cloned().into_iter().collect());
        }
        block.parameters.insert(format!("REGMODE_{letter}"), "OUTREG".into());
        block.connections.insert(format!("OCE{letter}"), vec![enable]);
        block.port_directions.insert(format!("OCE{letter}"), "input".to_owned());
        moved += count;
    }
    moved
}

/// A side of a block; nothing where one of its outputs has no such flip-flop, or none is read.
fn side(
    netlist: &Netlist,
    loads: &HashMap<u32, Vec<(String, String)>>,
    block: &str,
    letter: &'static str,
) -> Option<Side> {
    let cell = &netlist.cells[block];
    let clock = cell.bit(&format!("CLK{letter}"))?;
    if cell.bit(&format!("RST{letter}")).is_some_and(|reset| !reset.is_zero()) {
        return None;
    }
    let at_ports: Vec<u32> =
        netlist.ports.values().flat_map(|port| port.bits.iter().filter_map(Bit::net)).collect();
    let (mut registers, mut enables) = (Vec::new(), Vec::new());
    for port in cell.connections.keys().filter(|port| port.starts_with(&format!("DO{letter}"))) {
        let Some(net) = cell.net(port) else { continue };
        if at_ports.contains(&net) {
            return None;
        }
        match loads.get(&net).map(Vec::as_slice) {
            None => {}
            Some([(register, pin)]) if pin == "DI" => {
                enables.push(plain_enable(&netlist.cells[register], clock)?);
                registers.push((port.clone(), register.clone()));
            }
            Some(_) => return None,
        }
    }
    let enable = enables.first()?.clone();
    let same = enables.iter().all(|other| *other == enable);
    same.then(|| Side { block: block.to_owned(), letter, registers, enable })
}

/// The enable of a flip-flop on that clock which is never reset and starts at 0; nothing for another cell.
fn plain_enable(cell: &Cell, clock: &Bit) -> Option<Bit> {
    let is_plain = cell.kind == "TRELLIS_FF"
        && cell.bit("CLK") == Some(clock)
        && cell.text("CLKMUX") != Some("INV")
        && cell.text("REGSET") != Some("SET")
        && cell.bit("LSR").is_none_or(Bit::is_zero);
    match cell.text("CEMUX") {
        Some("1") if is_plain => Some(Bit::Constant("1".to_owned())),
        Some("CE") if is_plain => cell.bit("CE").cloned(),
        _ => None,
    }
}
