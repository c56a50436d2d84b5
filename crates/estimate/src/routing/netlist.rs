// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesized netlist on its way to the placement: one module whose cells, ports and names
//! can be edited ([`PlacementNetlist`]), and the modules that its instances had before it was
//! flattened ([`ModuleHierarchy`]), because only the names of nets and cells keep the
//! instances. All other fields stay as Yosys wrote them.
//!
//! Ports become flip-flops ([`replace_ports`]). A core is usually inside a chip: its inputs are
//! driven, and its outputs are read, by nearby registers and not by pins, of which there are
//! too few. An input bit comes from a flip-flop that holds its value; an output bit goes into a
//! flip-flop that nothing reads. Paths from and to ports thus have the timing of a chip in
//! which the neighbouring logic registers its signals. No pin affects the placement, and no
//! logic is added. Constants at outputs need no flip-flop.

use super::device::DeviceFamily;
use crate::error::EstimateError;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

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

/// The modules with their instances, before flattening.
#[derive(Deserialize)]
pub(super) struct ModuleHierarchy {
    modules: BTreeMap<String, HierarchyModule>,
}

#[derive(Deserialize)]
struct HierarchyModule {
    cells: BTreeMap<String, HierarchyCell>,
}

#[derive(Deserialize)]
struct HierarchyCell {
    #[serde(rename = "type")]
    kind: String,
}

impl ModuleHierarchy {
    pub(super) fn parse(file: &'static str, json: &[u8]) -> Result<Self, EstimateError> {
        serde_json::from_slice(json)
            .map_err(|source| EstimateError::UnreadableFile { file, source })
    }

    /// Returns the source name of the module in which a name below `top` is declared.
    pub(super) fn module_of(&self, top: &str, name: &str) -> String {
        let (mut module, mut rest) = (top, name);
        while let Some((kind, inner)) = self.first_instance(module, rest) {
            (module, rest) = (kind, inner);
        }
        source_name(module).to_owned()
    }

    /// Returns the module of the instance that a name begins with, and the rest of the name. Names
    /// of instances in generated blocks contain dots, so the name is compared with all instances.
    fn first_instance<'a>(&'a self, module: &str, name: &'a str) -> Option<(&'a str, &'a str)> {
        let cells = &self.modules.get(module)?.cells;
        cells.iter().find_map(|(instance, cell)| {
            let inner = name.strip_prefix(instance.as_str())?.strip_prefix('.')?;
            self.modules.contains_key(&cell.kind).then_some((cell.kind.as_str(), inner))
        })
    }
}

/// Returns the source name of a module; one with parameters is called `$paramod\adder\WIDTH=...` or
/// `$paramod$hash\adder`.
fn source_name(module: &str) -> &str {
    if !module.starts_with("$paramod") {
        return module;
    }
    module.split('\\').nth(1).unwrap_or(module)
}

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
