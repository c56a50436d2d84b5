// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pins of a cell that are connected to a net.

use super::raw::{Bit, RawCell};

/// A net and the pin that it is connected to.
pub(super) struct Joint<'a> {
    pub(super) port: &'a str,
    pub(super) index: usize,
    pub(super) net: u32,
}

/// Returns every pin of a cell that is connected to a net, port by port.
pub(super) fn joints(cell: &RawCell) -> impl Iterator<Item = Joint<'_>> {
    cell.connections.iter().flat_map(|(port, bits)| {
        let joint = move |(index, bit): (usize, &Bit)| Some(Joint { port, index, net: bit.net()? });
        bits.iter().enumerate().filter_map(joint)
    })
}
