// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesized netlist in a form that can be edited before it is placed: the cells, ports and
//! names of one module. All other fields stay as Yosys wrote them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::error::EstimateError;

const FILE: &str = "netlist.json";

#[derive(Serialize, Deserialize)]
struct NetlistFile {
    creator: Value,
    modules: BTreeMap<String, Value>,
}

/// The module that is placed.
#[derive(Serialize, Deserialize)]
pub(super) struct PlacementNetlist {
    pub(super) ports: BTreeMap<String, NetlistPort>,
    pub(super) cells: BTreeMap<String, NetlistCell>,
    pub(super) netnames: BTreeMap<String, NetName>,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct NetlistPort {
    pub(super) direction: String,
    pub(super) bits: Vec<NetlistBit>,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct NetlistCell {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) parameters: BTreeMap<String, Value>,
    pub(super) port_directions: BTreeMap<String, String>,
    pub(super) connections: BTreeMap<String, Vec<NetlistBit>>,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct NetName {
    hide_name: u8,
    bits: Vec<NetlistBit>,
    #[serde(default)]
    offset: usize,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

/// A net by its number, or a constant.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum NetlistBit {
    Net(u32),
    Constant(String),
}

impl PlacementNetlist {
    /// Returns the module `top` of a file that Yosys wrote, and the creator of the file.
    pub(super) fn parse(json: &[u8], top: &str) -> Result<(Self, Value), EstimateError> {
        let unreadable = |source| EstimateError::UnreadableFile { file: FILE, source };
        let mut file: NetlistFile = serde_json::from_slice(json).map_err(unreadable)?;
        let module = file.modules.remove(top).ok_or_else(|| EstimateError::MissingModule {
            module: top.to_owned(),
            present: file.modules.keys().cloned().collect::<Vec<_>>().join(", "),
        })?;
        Ok((serde_json::from_value(module).map_err(unreadable)?, file.creator))
    }

    /// Returns the file that nextpnr reads, with this module alone.
    pub(super) fn to_json(&self, top: &str, creator: Value) -> Result<Vec<u8>, EstimateError> {
        let module = serde_json::to_value(self).map_err(EstimateError::UnwritableReport)?;
        let file = NetlistFile { creator, modules: BTreeMap::from([(top.to_owned(), module)]) };
        serde_json::to_vec(&file).map_err(EstimateError::UnwritableReport)
    }

    /// Counts the cells whose type starts with `kind`.
    pub(super) fn count_cells(&self, kind: &str) -> u64 {
        self.cells.values().filter(|cell| cell.kind.starts_with(kind)).count() as u64
    }

    /// Returns the highest number of a net.
    pub(super) fn last_net(&self) -> u32 {
        let of_cells = self.cells.values().flat_map(|cell| cell.connections.values().flatten());
        let of_ports = self.ports.values().flat_map(|port| &port.bits);
        of_cells.chain(of_ports).filter_map(NetlistBit::net).max().unwrap_or(0)
    }

    /// Returns the net of that name, which may have an index.
    pub(super) fn net(&self, name: &str) -> Option<u32> {
        let whole = self.netnames.get(name).and_then(|entry| entry.bits.first()?.net());
        whole.or_else(|| {
            let (vector, index) = name.strip_suffix(']')?.rsplit_once('[')?;
            let entry = self.netnames.get(vector)?;
            entry.bits.get(index.parse::<usize>().ok()?.checked_sub(entry.offset)?)?.net()
        })
    }

    /// Returns the name of a net in the source, at the place where it is driven; see [`name_rank`].
    pub(super) fn name(&self, net: u32) -> Option<String> {
        let names = self.netnames.iter().filter(|(_, entry)| entry.hide_name == 0);
        let best = names
            .filter_map(|(name, entry)| {
                let index = entry.bits.iter().position(|bit| bit.net() == Some(net))?;
                Some((name, index, entry))
            })
            .min_by_key(|(name, ..)| (name_rank(name), *name));
        best.map(|(name, index, entry)| match entry.bits.len() {
            1 => name.clone(),
            _ => format!("{name}[{}]", index + entry.offset),
        })
    }
}

/// Returns the rank of a name of a net; the name with the lowest rank best describes where the net
/// is driven. The order is the name of a register (`_q`), then that of the innermost output (`_o`),
/// and last that of the outermost input (`_i`).
fn name_rank(name: &str) -> (bool, u8, isize, usize) {
    let depth = name.matches('.').count().cast_signed();
    let (kind, depth) = match name.rsplit_once('_') {
        Some((_, "q")) => (0, -depth),
        Some((_, "o")) => (1, -depth),
        Some((_, "i")) => (3, depth),
        _ => (2, -depth),
    };
    (is_generated_name(name), kind, depth, name.len())
}

/// Returns whether Yosys made the name from the names of nearby cells.
fn is_generated_name(name: &str) -> bool {
    ["_LUT4_", "_CCU2C_", "_TRELLIS_", "_SB_", "_PFUMX_", "_L6MUX21_", "_DFF", "_ALU_", "_MUX2_"]
        .iter()
        .any(|part| name.contains(part))
}

impl NetlistCell {
    /// Makes a cell that the source does not have.
    pub(super) fn new(
        kind: &str,
        parameters: &[(&str, &str)],
        pins: &[(&str, bool, NetlistBit)],
    ) -> Self {
        let direction = |output: bool| if output { "output" } else { "input" }.to_owned();
        let parameter = |&(name, value): &(&str, &str)| (name.to_owned(), value.into());
        Self {
            kind: kind.to_owned(),
            parameters: parameters.iter().map(parameter).collect(),
            port_directions: pins
                .iter()
                .map(|&(port, output, _)| (port.to_owned(), direction(output)))
                .collect(),
            connections: pins
                .iter()
                .map(|(port, _, bit)| ((*port).to_owned(), vec![bit.clone()]))
                .collect(),
            rest: Map::from_iter([
                ("hide_name".to_owned(), 1.into()),
                ("attributes".to_owned(), Map::new().into()),
            ]),
        }
    }

    pub(super) fn bit(&self, port: &str) -> Option<&NetlistBit> {
        self.connections.get(port)?.first()
    }

    /// Returns the net at a port of one bit.
    pub(super) fn net(&self, port: &str) -> Option<u32> {
        self.bit(port)?.net()
    }
}

impl NetlistBit {
    pub(super) fn net(&self) -> Option<u32> {
        match self {
            Self::Net(net) => Some(*net),
            Self::Constant(_) => None,
        }
    }
}
