// SPDX-License-Identifier: MIT OR Apache-2.0
//! A check that an array of copies connects each copy to the lanes of its own region.
//!
//! A simulation of a few copies shows what one copy does, and that neighbors are told apart. The
//! connections of the other copies are read from the elaborated array, however large it is.

use super::array_instance::{ArrayInstance, PortConnection};
use foveate_design::{Design, Port, PortDirection, PortRole};
use foveate_emit::Top;
use foveate_model::region_border;
use std::collections::BTreeMap;

/// The valid bit after `frame_sync`.
const BEAT_SIGNAL: &str = "beat";

/// Returns true if there is one copy of `unit_name` per region, in the order of the regions, and
/// each has the lanes of its own region: a port that the array has once is connected as a whole,
/// and a port that it has per region by its part.
pub(super) fn is_wired_correctly(
    design: &Design,
    tiles: &[ArrayInstance],
    unit_name: &str,
) -> bool {
    let (array, unit) = (Top::Rcm.ports(design), Top::Rpu.ports(design));
    let array: BTreeMap<&str, &Port> =
        array.iter().map(|port| (port.name.as_str(), port)).collect();
    let regions = 0..design.regions();
    // The other instances of the array are also in a small array.
    let copies: Vec<&ArrayInstance> =
        tiles.iter().filter(|tile| tile.module == unit_name).collect();
    copies.len() == regions.len()
        && regions.zip(copies).all(|(region, tile)| {
            let names: Vec<&str> = tile.ports.iter().map(|(name, _)| name.as_str()).collect();
            unit.iter().all(|port| names.contains(&port.name.as_str()))
                && names.len() == unit.len()
                && tile.ports.iter().all(|(name, connection)| {
                    let port = unit.iter().find(|port| port.name == *name);
                    port.is_some_and(|port| {
                        is_connected_correctly(design, region, port, &array, connection)
                    })
                })
        })
}

fn is_connected_correctly(
    design: &Design,
    region: u32,
    port: &Port,
    array: &BTreeMap<&str, &Port>,
    connection: &PortConnection,
) -> bool {
    let own = |width: u64| u64::from(region) * width;
    match connection {
        PortConnection::Constant(value) => {
            port.role == PortRole::Border && *value == u64::from(region_border(design, region))
        }
        PortConnection::WholeSignal(signal) => {
            let is_passed_on =
                design.has_frame_sync() && port.role == PortRole::Valid && signal == BEAT_SIGNAL;
            let is_shared = array.get(signal.as_str()).is_some_and(|whole| whole.lanes == 1);
            is_passed_on || (signal == &port.name && is_shared)
        }
        PortConnection::Bits { signal, from, width } => {
            let is_lane = *width == u64::from(port.bits()) && *from == own(*width);
            // The array collects outputs of all copies in a signal of its own.
            let is_collected =
                port.direction == PortDirection::Output && !array.contains_key(signal.as_str());
            let is_same = signal == &port.name
                && array.get(signal.as_str()).is_some_and(|whole| whole.width == port.width);
            is_lane && (is_same || is_collected)
        }
        PortConnection::Other => false,
    }
}
