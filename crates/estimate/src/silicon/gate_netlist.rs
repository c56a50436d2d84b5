// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist of a design in the cells of a library, for a simulation of its gates: as Verilog
//! with models of the cells, for a simulator ([`gate_netlist`]), or, for one unit of an array,
//! as a list of cells without modules ([`FlatNetlist`]).

use super::error::SiliconError;
use super::job::SiliconJob;
use super::library::{CELLS, LibertyLibrary};
use super::mapping::map_array;
use crate::EstimateJob;
use foveate_design::Design;
use foveate_emit::Top;
use foveate_tools::yosys::{self, YosysJob};
use foveate_tools::{Cache, SynthesisJob, Toolchain};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

const MODELS: &str = "models.v";

/// Maps a design as [`map_to_silicon`](super::map_to_silicon) does, and returns the netlist as
/// Verilog: the modules of the array and of its units, and a model of each cell that they use, by
/// its function in the library.
///
/// # Errors
/// Fails if Yosys is missing or fails, if a cell has no model, and if a memory is too large for
/// flip-flops, because the netlist would not have its words.
pub fn gate_netlist(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &SiliconJob,
    library: &LibertyLibrary,
) -> Result<String, SiliconError> {
    let synthesis = job.design.top_synthesis();
    let mapped = map_array(toolchain, cache, synthesis, library, job.memory_limit)?;
    mapped.check_memories(job.memory_limit)?;
    let script =
        format!("read_liberty -ignore_miss_func {CELLS}\nwrite_verilog -noattr {MODELS}\n");
    let job =
        YosysJob { sources: vec![library.source()], script, outputs: vec![MODELS.to_owned()] };
    let mut run = yosys::run(toolchain, cache, &job)?;
    let models = run.files.remove(MODELS).expect("it is the wanted file");
    let models = String::from_utf8_lossy(&models).into_owned();
    let texts = mapped.netlist.cell_types().into_iter().map(|cell| {
        yosys::module_text(&models, cell).ok_or_else(|| SiliconError::Netlist {
            reason: format!("there is no model of the cell `{cell}`"),
        })
    });
    let texts: String = texts.collect::<Result<_, _>>()?;
    Ok(with_parameters(mapped.gates, synthesis) + &texts)
}

/// Gives the array the parameters that its source has. They have one value, for which the netlist
/// was made.
fn with_parameters(gates: String, synthesis: &SynthesisJob) -> String {
    let parameters = synthesis.parameters.iter();
    let parameters = parameters.map(|(name, value)| format!("parameter {name} = {value}"));
    let parameters = parameters.collect::<Vec<_>>().join(", ");
    if parameters.is_empty() {
        return gates;
    }
    let head = format!("module {}(", synthesis.array);
    gates.replacen(&head, &format!("module {} #({parameters}) (", synthesis.array), 1)
}

/// The net that is always 0.
pub const LOW_NET: usize = 0;
/// The net that is always 1.
pub const HIGH_NET: usize = 1;

/// The cells and nets of a unit: an RPU of `pipelined`, or a lane of `serial` with its sequencer.
#[derive(Clone, Debug)]
pub struct FlatNetlist {
    /// The number of nets; [`LOW_NET`] and [`HIGH_NET`] are the first two.
    pub nets: usize,
    /// The cells.
    pub gates: Vec<NetlistGate>,
    /// The nets of each input port, the lowest bit first.
    pub inputs: BTreeMap<String, Vec<usize>>,
    /// The nets of each output port, the lowest bit first.
    pub outputs: BTreeMap<String, Vec<usize>>,
    /// The nets that are bits of the words of memories.
    pub memory_nets: BTreeSet<usize>,
}

/// A cell of a netlist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetlistGate {
    /// The cell of the library.
    pub cell: String,
    /// The net at each connected pin.
    pub pins: BTreeMap<String, usize>,
    /// True if the cell is in the unit, and false if it is in the logic that the units of an array
    /// share.
    pub is_in_unit: bool,
}

/// Maps one unit of a design: an RPU by itself, or a lane with the logic that lanes share.
///
/// # Errors
/// Fails if Yosys is missing or fails, and if a memory has more than `limit` bits.
pub fn map_unit(
    toolchain: &Toolchain,
    cache: &Cache,
    design: &Design,
    (library, limit): (&LibertyLibrary, u64),
) -> Result<FlatNetlist, SiliconError> {
    let array = Top::Rpu.array_top(design);
    let job = EstimateJob::for_design(design, array);
    let mapped = map_array(toolchain, cache, &job.synthesis, library, limit)?;
    mapped.check_memories(limit)?;
    let units = job.units(&mapped.netlist, &job.synthesis)?;
    let top = match array {
        Top::Rpu => &job.synthesis.array,
        Top::Rcm => &units[0],
    };
    flatten(&mapped.json, top, &units)
        .ok_or_else(|| SiliconError::Netlist { reason: format!("module `{top}` cannot be read") })
}

/// Returns the cells of a module and of all modules inside it. A cell inside one of the modules
/// `units` is in a unit.
fn flatten(json: &Value, top: &str, units: &[String]) -> Option<FlatNetlist> {
    let mut flattener = NetlistFlattener {
        json,
        units,
        merged: vec![LOW_NET, HIGH_NET],
        gates: Vec::new(),
        memory_nets: BTreeSet::new(),
    };
    let is_unit = units.iter().any(|unit| unit == top);
    let nets = flattener.add_module(top, BTreeMap::new(), is_unit)?;
    let (mut inputs, mut outputs) = (BTreeMap::new(), BTreeMap::new());
    for (name, port) in json["modules"][top]["ports"].as_object()? {
        let ports = match port["direction"].as_str()? {
            "input" => &mut inputs,
            _ => &mut outputs,
        };
        let (bus, first) = bus_bit(name);
        let bus: &mut Vec<usize> = ports.entry(bus.to_owned()).or_default();
        for (place, bit) in (first..).zip(port["bits"].as_array()?) {
            bus.resize(bus.len().max(place + 1), LOW_NET);
            bus[place] = flattener.root(net_of_bit(bit, &nets)?);
        }
    }
    let nets = flattener.merged.len();
    let roots: Vec<usize> = (0..nets).map(|net| flattener.root(net)).collect();
    let mut gates = flattener.gates;
    for net in gates.iter_mut().flat_map(|gate| gate.pins.values_mut()) {
        *net = roots[*net];
    }
    let memory_nets = flattener.memory_nets.iter().map(|&net| roots[net]).collect();
    Some(FlatNetlist { nets, gates, inputs, outputs, memory_nets })
}

/// The state of a flattener.
struct NetlistFlattener<'a> {
    json: &'a Value,
    units: &'a [String],
    /// For each net, itself or another net with which it is one.
    merged: Vec<usize>,
    gates: Vec<NetlistGate>,
    memory_nets: BTreeSet<usize>,
}

impl NetlistFlattener<'_> {
    /// Adds the cells of a module. `nets` are the nets of its ports by their numbers in the module;
    /// all nets of the module are returned.
    fn add_module(
        &mut self,
        name: &str,
        mut nets: BTreeMap<u64, usize>,
        is_in_unit: bool,
    ) -> Option<BTreeMap<u64, usize>> {
        let module = &self.json["modules"][name];
        let ports = module["ports"].as_object()?.values().map(|port| &port["bits"]);
        let cells = module["cells"].as_object()?;
        let pins = cells.values().filter_map(|cell| cell["connections"].as_object());
        let bits = ports.chain(pins.flat_map(|pins| pins.values()));
        for id in bits.filter_map(Value::as_array).flatten().filter_map(Value::as_u64) {
            nets.entry(id).or_insert_with(|| {
                self.merged.push(self.merged.len());
                self.merged.len() - 1
            });
        }
        let of_memory = memory_bits(module)?.into_iter().filter_map(|id| nets.get(&id).copied());
        self.memory_nets.extend(of_memory);
        for cell in cells.values() {
            let kind = cell["type"].as_str()?;
            let pins = cell["connections"].as_object()?;
            if self.json["modules"].get(kind).is_some() {
                let is_unit = self.units.iter().any(|unit| unit == kind);
                self.add_instance(kind, pins, &nets, is_in_unit || is_unit)?;
                continue;
            }
            let connected = pins.iter().filter_map(|(pin, bits)| Some((pin.clone(), bits.get(0)?)));
            let pins = connected.map(|(pin, bit)| Some((pin, net_of_bit(bit, &nets)?)));
            let pins = pins.collect::<Option<_>>()?;
            self.gates.push(NetlistGate { cell: kind.to_owned(), pins, is_in_unit });
        }
        Some(nets)
    }

    /// Adds an instance of a module, whose ports are connected to these nets of the module around
    /// it.
    fn add_instance(
        &mut self,
        kind: &str,
        pins: &serde_json::Map<String, Value>,
        outer: &BTreeMap<u64, usize>,
        is_in_unit: bool,
    ) -> Option<()> {
        let (mut inner, mut equal) = (BTreeMap::new(), Vec::new());
        for (port, bits) in pins {
            let own = self.json["modules"][kind]["ports"][port.as_str()]["bits"].as_array()?;
            for (own, bit) in own.iter().zip(bits.as_array()?) {
                let net = net_of_bit(bit, outer)?;
                match own.as_u64() {
                    Some(id) if !inner.contains_key(&id) => drop(inner.insert(id, net)),
                    _ => equal.push((own, net)),
                }
            }
        }
        // Several ports of the instance are one net in it, or a port is constant.
        for (own, net) in equal {
            let (a, b) = (self.root(net_of_bit(own, &inner)?), self.root(net));
            self.merged[a.max(b)] = a.min(b);
        }
        self.add_module(kind, inner, is_in_unit).map(drop)
    }

    fn root(&self, mut net: usize) -> usize {
        while self.merged[net] != net {
            net = self.merged[net];
        }
        net
    }
}

/// Returns the net of a bit of a netlist: a number, or a text for a constant. An unknown bit is 0.
fn net_of_bit(bit: &Value, nets: &BTreeMap<u64, usize>) -> Option<usize> {
    match bit.as_str() {
        Some("1") => Some(HIGH_NET),
        Some(_) => Some(LOW_NET),
        None => nets.get(&bit.as_u64()?).copied(),
    }
}

/// Returns the numbers of the nets that are bits of the words of memories: nets with two indexes,
/// such as `u_store.words_q[12][3]`.
fn memory_bits(module: &Value) -> Option<BTreeSet<u64>> {
    let names = module["netnames"].as_object()?.iter();
    let of_memory = names.filter(|(name, net)| {
        let width = net["bits"].as_array().map_or(0, Vec::len);
        let indexes = name.rsplit('.').next().unwrap_or(name).matches('[').count();
        indexes == 2 || indexes == 1 && width > 1
    });
    let bits = of_memory.filter_map(|(_, net)| net["bits"].as_array()).flatten();
    Some(bits.filter_map(Value::as_u64).collect())
}

/// Splits `level_i[3]` into the name of a bus and a bit of it.
fn bus_bit(name: &str) -> (&str, usize) {
    let parts = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
    parts.and_then(|(bus, bit)| Some((bus, bit.parse().ok()?))).unwrap_or((name, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_replaced_by_their_cells() {
        let json = serde_json::json!({ "modules": {
            "rpu": {
                "ports": { "a_i[0]": { "direction": "input", "bits": [2] }, "a_i[1]": { "direction": "input", "bits": [3] },
                    "y_o": { "direction": "output", "bits": [9] }, "z_o": { "direction": "output", "bits": [8] } },
                "cells": {
                    "u_lane": { "type": "lane", "connections": { "d_i": [2], "e_i": ["1"], "q_o": [9], "p_o": [7], "l_o": [8] } },
                    "cell_1": { "type": "INV", "connections": { "A": [7], "Y": [5] } } },
                "netnames": {} },
            "lane": {
                "ports": { "d_i": { "direction": "input", "bits": [4] }, "e_i": { "direction": "input", "bits": [5] },
                    "q_o": { "direction": "output", "bits": [6] }, "p_o": { "direction": "output", "bits": [4] },
                    "l_o": { "direction": "output", "bits": ["0"] } },
                "cells": { "cell_1": { "type": "DFF", "connections": { "D": [4], "E": [5], "Q": [6], "QN": [] } } },
                "netnames": { "u_store.words_q[3][0]": { "bits": [6] }, "count_q[0]": { "bits": [5] } } },
        } });
        let flat = flatten(&json, "rpu", &["lane".to_owned()]).unwrap();
        let a = &flat.inputs["a_i"];
        assert_eq!(flat.outputs["z_o"], [LOW_NET]);
        let pins = |gate: usize| flat.gates[gate].pins.clone();
        // `p_o` leads `d_i` through the lane.
        assert_eq!(pins(0)["A"], a[0]);
        assert_eq!(
            (pins(1)["D"], pins(1)["E"], pins(1)["Q"]),
            (a[0], HIGH_NET, flat.outputs["y_o"][0])
        );
        let kinds: Vec<_> =
            flat.gates.iter().map(|gate| (gate.cell.as_str(), gate.is_in_unit)).collect();
        assert_eq!(kinds, [("INV", false), ("DFF", true)]);
        assert_eq!(flat.memory_nets, [flat.outputs["y_o"][0]].into());
        assert!(!pins(1).contains_key("QN"), "a pin without a net is left out");
    }
}
