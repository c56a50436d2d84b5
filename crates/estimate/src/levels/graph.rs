// SPDX-License-Identifier: MIT OR Apache-2.0
//! A module with everything inside it as one graph of nets, numbered across all instances.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;

use super::Library;
use super::cell::{CellTiming, carry_out};
use super::ecp5;
use super::path::Weight;
use super::raw::{Bit, RawModule, RawNetlist};
use crate::cells::CellKind;
use crate::error::EstimateError;

/// The nets of a module, with the places where paths go, start and end.
pub(super) struct Graph<'a> {
    pub(super) arcs: Vec<Arc<'a>>,
    pub(super) starts: Vec<Start>,
    pub(super) ends: Vec<End<'a>>,
    nets: Vec<Net<'a>>,
}

pub(super) struct Arc<'a> {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) weight: Weight,
    /// The type of the cell; `None` where a module connects two nets.
    pub(super) cell: Option<&'a str>,
}

pub(super) struct Start {
    pub(super) net: u32,
    pub(super) weight: Weight,
}

pub(super) struct End<'a> {
    pub(super) net: u32,
    /// The type of the cell and its pin; `None` for an output port.
    pub(super) pin: Option<(&'a str, String)>,
    /// The net whose name identifies the register, memory or port.
    pub(super) named: u32,
}

/// A net, with its name in one of the instances that it belongs to.
struct Net<'a> {
    instance: Instance<'a>,
    local: u32,
}

#[derive(Clone)]
struct Instance<'a> {
    path: Rc<str>,
    module: &'a RawModule,
    cells: Rc<[Timed<'a>]>,
}

/// A cell with its timing and its first output.
struct Timed<'a> {
    kind: &'a str,
    timing: CellTiming,
    output: Option<u32>,
}

/// The nets of an instance: local numbers, and the numbers in the graph.
type Nets = HashMap<u32, u32>;

impl<'a> Graph<'a> {
    pub(super) fn of(
        netlist: &'a RawNetlist,
        top: &str,
        library: Library,
    ) -> Result<Self, EstimateError> {
        let mut graph =
            Self { arcs: Vec::new(), starts: Vec::new(), ends: Vec::new(), nets: Vec::new() };
        let mut builder = Builder { netlist, library, cells: BTreeMap::new() };
        let instance = builder.instance(top, "")?;
        let mut nets = Nets::new();
        for local in port_nets(instance.module, false) {
            let net = graph.net(&instance, &mut nets, local);
            graph.starts.push(Start { net, weight: Weight::NONE });
        }
        builder.fill(&mut graph, &instance, &mut nets)?;
        for local in port_nets(instance.module, true) {
            let net = graph.net(&instance, &mut nets, local);
            graph.ends.push(End { net, pin: None, named: net });
        }
        Ok(graph)
    }

    pub(super) fn net_count(&self) -> usize {
        self.nets.len()
    }

    /// Returns the name of a net, preceded by the instances that contain it.
    pub(super) fn name(&self, net: u32) -> String {
        let Net { instance, local } = &self.nets[net as usize];
        inside(&instance.path, &instance.module.net_name(*local))
    }

    /// Returns the graph's number of a net of an instance.
    fn net(&mut self, instance: &Instance<'a>, nets: &mut Nets, local: u32) -> u32 {
        *nets.entry(local).or_insert_with(|| {
            self.nets.push(Net { instance: instance.clone(), local });
            u32::try_from(self.nets.len() - 1).expect("fewer than 2^32 nets fit into memory")
        })
    }
}

/// Makes instances of modules.
struct Builder<'a> {
    netlist: &'a RawNetlist,
    library: Library,
    cells: BTreeMap<String, Rc<[Timed<'a>]>>,
}

impl<'a> Builder<'a> {
    fn instance(&mut self, name: &str, path: &str) -> Result<Instance<'a>, EstimateError> {
        let Self { netlist, library, .. } = *self;
        let module = netlist.modules.get(name).ok_or_else(|| EstimateError::MissingModule {
            module: name.to_owned(),
            present: netlist.modules.keys().cloned().collect::<Vec<_>>().join(", "),
        })?;
        let cells = match self.cells.get(name) {
            Some(cells) => cells.clone(),
            None => Rc::from(timed(netlist, name, module, library)?),
        };
        self.cells.insert(name.to_owned(), cells.clone());
        Ok(Instance { path: path.into(), module, cells })
    }

    /// Adds the cells of an instance and all modules inside it. `nets` has the nets that its ports
    /// are connected to.
    fn fill(
        &mut self,
        graph: &mut Graph<'a>,
        instance: &Instance<'a>,
        nets: &mut Nets,
    ) -> Result<(), EstimateError> {
        for Timed { kind, timing, output } in instance.cells.iter() {
            for &(from, to, weight) in &timing.arcs {
                let from = graph.net(instance, nets, from);
                let to = graph.net(instance, nets, to);
                graph.arcs.push(Arc { from, to, weight, cell: Some(*kind) });
            }
            for &(net, weight) in &timing.starts {
                let net = graph.net(instance, nets, net);
                graph.starts.push(Start { net, weight });
            }
            for (net, pin) in &timing.ends {
                let net = graph.net(instance, nets, *net);
                let named = output.map_or(net, |output| graph.net(instance, nets, output));
                graph.ends.push(End { net, pin: Some((*kind, pin.clone())), named });
            }
        }
        for (name, cell) in &instance.module.cells {
            if self.netlist.modules.contains_key(&cell.kind) {
                let inner = self.instance(&cell.kind, &inside(&instance.path, name))?;
                let mut bound = Nets::new();
                let again = bind(graph, (instance, nets), (&inner, &mut bound), &cell.connections);
                self.fill(graph, &inner, &mut bound)?;
                graph.arcs.extend(again);
            }
        }
        Ok(())
    }
}

/// Connects the ports of an inner instance to the nets outside. Returns an arc for every output
/// that comes from an input or leaves under a second name.
fn bind<'a>(
    graph: &mut Graph<'a>,
    (outer, nets): (&Instance<'a>, &mut Nets),
    (inner, bound): (&Instance<'a>, &mut Nets),
    connections: &BTreeMap<String, Vec<Bit>>,
) -> Vec<Arc<'a>> {
    let mut again = Vec::new();
    for output in [false, true] {
        let ports = inner.module.ports.iter().filter(|(_, port)| port.is_output() == output);
        for (name, port) in ports {
            for (local, outside) in
                port.bits.iter().zip(connections.get(name).into_iter().flatten())
            {
                if let (Some(local), Some(outside)) = (local.net(), outside.net()) {
                    let to = graph.net(outer, nets, outside);
                    let from = *bound.entry(local).or_insert(to);
                    if from != to {
                        again.push(Arc { from, to, weight: Weight::NONE, cell: None });
                    }
                }
            }
        }
    }
    again
}

/// Returns the primitive cells of a module.
fn timed<'a>(
    netlist: &RawNetlist,
    name: &str,
    module: &'a RawModule,
    library: Library,
) -> Result<Vec<Timed<'a>>, EstimateError> {
    let carries: HashSet<u32> = module.cells.values().filter_map(carry_out).collect();
    let primitive = module.cells.values().filter(|cell| !netlist.modules.contains_key(&cell.kind));
    primitive
        .map(|cell| {
            let timing = match library {
                Library::Xilinx => CellKind::of(&cell.kind)
                    .map(|kind| CellTiming::of(kind, cell, |net| carries.contains(&net))),
                Library::Ecp5 => ecp5::timing(cell),
            };
            let timing = timing.ok_or_else(|| EstimateError::UnknownCell {
                cell: cell.kind.clone(),
                module: name.to_owned(),
                count: 1,
            })?;
            let output = timing.starts.first().map(|&(net, _)| net);
            Ok(Timed { kind: &cell.kind, timing, output })
        })
        .collect()
}

fn port_nets(module: &RawModule, output: bool) -> impl Iterator<Item = u32> {
    let ports = module.ports.values().filter(move |port| port.is_output() == output);
    ports.flat_map(|port| port.bits.iter().filter_map(Bit::net))
}

fn inside(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}
