// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pins of a cell that are connected to a net.

use super::raw_netlist::{PathBit, PathCell};

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
