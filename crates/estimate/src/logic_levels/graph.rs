// SPDX-License-Identifier: MIT OR Apache-2.0
//! A module with everything inside it as one graph of nets, numbered across all instances.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;

use super::CellLibrary;
use super::cell::{CellTiming, carry_out};
use super::ecp5;
use super::path::PathWeight;
use super::raw_netlist::{PathBit, PathModule, PathNetlist};
use crate::cells::CellKind;
use crate::error::EstimateError;

/// The nets of a module, with the places where paths go, start and end.
pub(super) struct NetGraph<'a> {
    pub(super) arcs: Vec<TimingArc<'a>>,
    pub(super) starts: Vec<PathStart>,
    pub(super) ends: Vec<PathEndpoint<'a>>,
    nets: Vec<GraphNet<'a>>,
}

pub(super) struct TimingArc<'a> {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) weight: PathWeight,
    /// The type of the cell; `None` where a module connects two nets.
    pub(super) cell: Option<&'a str>,
}

/// The output of a register or memory, or an input port, at which a path starts.
pub(super) struct PathStart {
    pub(super) net: u32,
    pub(super) weight: PathWeight,
}

/// The input of a register or memory, or an output port, at which a path ends.
pub(super) struct PathEndpoint<'a> {
    pub(super) net: u32,
    /// The type of the cell and its pin; `None` for an output port.
    pub(super) pin: Option<(&'a str, String)>,
    /// The net whose name identifies the register, memory or port.
    pub(super) named_net: u32,
}

/// A net, with its name in one of the instances that it belongs to.
struct GraphNet<'a> {
    instance: ModuleInstance<'a>,
    local: u32,
}

#[derive(Clone)]
struct ModuleInstance<'a> {
    path: Rc<str>,
    module: &'a PathModule,
    cells: Rc<[TimedCell<'a>]>,
}

/// A cell with its timing and its first output.
struct TimedCell<'a> {
    kind: &'a str,
    timing: CellTiming,
    output: Option<u32>,
}

/// The nets of an instance: local numbers, and the numbers in the graph.
type NetNumbers = HashMap<u32, u32>;

impl<'a> NetGraph<'a> {
    pub(super) fn of(
        netlist: &'a PathNetlist,
        top: &str,
        library: CellLibrary,
    ) -> Result<Self, EstimateError> {
        let mut graph =
            Self { arcs: Vec::new(), starts: Vec::new(), ends: Vec::new(), nets: Vec::new() };
        let mut builder = GraphBuilder { netlist, library, cells: BTreeMap::new() };
        let instance = builder.instance(top, "")?;
        let mut nets = NetNumbers::new();
        for local in port_nets(instance.module, false) {
            let net = graph.net(&instance, &mut nets, local);
            graph.starts.push(PathStart { net, weight: PathWeight::NONE });
        }
        builder.fill(&mut graph, &instance, &mut nets)?;
        for local in port_nets(instance.module, true) {
            let net = graph.net(&instance, &mut nets, local);
            graph.ends.push(PathEndpoint { net, pin: None, named_net: net });
        }
        Ok(graph)
    }

    pub(super) fn net_count(&self) -> usize {
        self.nets.len()
    }

    /// Returns the name of a net, preceded by the instances that contain it.
    pub(super) fn name(&self, net: u32) -> String {
        let GraphNet { instance, local } = &self.nets[net as usize];
        nested_name(&instance.path, &instance.module.net_name(*local))
    }

    fn net(&mut self, instance: &ModuleInstance<'a>, nets: &mut NetNumbers, local: u32) -> u32 {
        *nets.entry(local).or_insert_with(|| {
            self.nets.push(GraphNet { instance: instance.clone(), local });
            u32::try_from(self.nets.len() - 1).expect("fewer than 2^32 nets fit into memory")
        })
    }
}

/// Makes instances of modules.
struct GraphBuilder<'a> {
    netlist: &'a PathNetlist,
    library: CellLibrary,
    cells: BTreeMap<String, Rc<[TimedCell<'a>]>>,
}

impl<'a> GraphBuilder<'a> {
    fn instance(&mut self, name: &str, path: &str) -> Result<ModuleInstance<'a>, EstimateError> {
        let Self { netlist, library, .. } = *self;
        let module = netlist.modules.get(name).ok_or_else(|| EstimateError::MissingModule {
            module: name.to_owned(),
            present: netlist.modules.keys().cloned().collect::<Vec<_>>().join(", "),
        })?;
        let cells = match self.cells.get(name) {
            Some(cells) => cells.clone(),
            None => Rc::from(timed_cells(netlist, name, module, library)?),
        };
        self.cells.insert(name.to_owned(), cells.clone());
        Ok(ModuleInstance { path: path.into(), module, cells })
    }

    /// Adds the cells of an instance and all modules inside it. `nets` has the nets that its ports
    /// are connected to.
    fn fill(
        &mut self,
        graph: &mut NetGraph<'a>,
        instance: &ModuleInstance<'a>,
        nets: &mut NetNumbers,
    ) -> Result<(), EstimateError> {
        for TimedCell { kind, timing, output } in instance.cells.iter() {
            for &(from, to, weight) in &timing.arcs {
                let from = graph.net(instance, nets, from);
                let to = graph.net(instance, nets, to);
                graph.arcs.push(TimingArc { from, to, weight, cell: Some(*kind) });
            }
            for &(net, weight) in &timing.starts {
                let net = graph.net(instance, nets, net);
                graph.starts.push(PathStart { net, weight });
            }
            for (net, pin) in &timing.ends {
                let net = graph.net(instance, nets, *net);
                let named_net = output.map_or(net, |output| graph.net(instance, nets, output));
                graph.ends.push(PathEndpoint { net, pin: Some((*kind, pin.clone())), named_net });
            }
        }
        for (name, cell) in &instance.module.cells {
            if self.netlist.modules.contains_key(&cell.kind) {
                let inner = self.instance(&cell.kind, &nested_name(&instance.path, name))?;
                let mut inner_nets = NetNumbers::new();
                let alias_arcs = connect_ports(
                    graph,
                    (instance, nets),
                    (&inner, &mut inner_nets),
                    &cell.connections,
                );
                self.fill(graph, &inner, &mut inner_nets)?;
                graph.arcs.extend(alias_arcs);
            }
        }
        Ok(())
    }
}

/// Connects the ports of an inner instance to the nets outside. Each inner net becomes one of the
/// nets to which its ports are connected. If an inner net has several ports, as an output that is
/// wired to an input, an arc without a cell leads to each of the other nets; these arcs are
/// returned.
fn connect_ports<'a>(
    graph: &mut NetGraph<'a>,
    (outer, nets): (&ModuleInstance<'a>, &mut NetNumbers),
    (inner, inner_nets): (&ModuleInstance<'a>, &mut NetNumbers),
    connections: &BTreeMap<String, Vec<PathBit>>,
) -> Vec<TimingArc<'a>> {
    let mut alias_arcs = Vec::new();
    for output in [false, true] {
        let ports = inner.module.ports.iter().filter(|(_, port)| port.is_output() == output);
        for (name, port) in ports {
            for (local, outside) in
                port.bits.iter().zip(connections.get(name).into_iter().flatten())
            {
                if let (Some(local), Some(outside)) = (local.net(), outside.net()) {
                    let to = graph.net(outer, nets, outside);
                    let from = *inner_nets.entry(local).or_insert(to);
                    if from != to {
                        alias_arcs.push(TimingArc {
                            from,
                            to,
                            weight: PathWeight::NONE,
                            cell: None,
                        });
                    }
                }
            }
        }
    }
    alias_arcs
}

/// Returns the primitive cells of a module.
fn timed_cells<'a>(
    netlist: &PathNetlist,
    name: &str,
    module: &'a PathModule,
    library: CellLibrary,
) -> Result<Vec<TimedCell<'a>>, EstimateError> {
    let carries: HashSet<u32> = module.cells.values().filter_map(carry_out).collect();
    let primitive = module.cells.values().filter(|cell| !netlist.modules.contains_key(&cell.kind));
    primitive
        .map(|cell| {
            let timing = match library {
                CellLibrary::Xilinx => CellKind::from_type(&cell.kind)
                    .map(|kind| CellTiming::of(kind, cell, |net| carries.contains(&net))),
                CellLibrary::Ecp5 => ecp5::timing(cell),
            };
            let timing = timing.ok_or_else(|| EstimateError::UnknownCell {
                cell: cell.kind.clone(),
                module: name.to_owned(),
                count: 1,
            })?;
            let output = timing.starts.first().map(|&(net, _)| net);
            Ok(TimedCell { kind: &cell.kind, timing, output })
        })
        .collect()
}

fn port_nets(module: &PathModule, output: bool) -> impl Iterator<Item = u32> {
    let ports = module.ports.values().filter(move |port| port.is_output() == output);
    ports.flat_map(|port| port.bits.iter().filter_map(PathBit::net))
}

fn nested_name(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}
