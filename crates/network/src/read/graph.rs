// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reading of the graph of a model, node by node.

use super::attributes::NodeAttributes;
use super::constant::Constant;
use super::fold;
use super::folder::ModelFolder;
use super::input::{FrameSize, arrays_of, frame_input, puts_channels_first};
use super::made::Made;
use super::names::{full_kind, name_of, shown_name};
use super::node::{Known, NodeReader, Operand};
use super::operators;
use super::pointwise;
use super::schema::OperatorSchema;
use crate::element::Element;
use crate::error::NetworkError;
use crate::layout::Layout;
use crate::network::Network;
use crate::onnx::{GraphProto, NodeProto, TensorProto};
use crate::operator::{Fixed, Operator, Placed, Quantize, Scales};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The source of the values of the inputs.
pub(super) enum InputSource<'a> {
    /// The only input takes frames of this size, or of the network's size if there is none.
    Frames(Option<FrameSize>),
    /// The only input takes frames of the network's size, or of this size if the network takes any.
    Open(FrameSize),
    /// Each input takes an array.
    Arrays(&'a [TensorProto]),
}

/// The reaction to a node that cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ProblemPolicy {
    /// Reading ends with the problem.
    Stop,
    /// The problem is recorded, and nodes that depend on this one are only checked for their
    /// operators and attributes.
    Note,
}

/// The result of reading a graph.
pub(super) struct GraphResult {
    pub(super) network: Network,
    /// The outputs in order, each with its name: a tensor of the network, or a constant.
    pub(super) outputs: Vec<(String, Known)>,
    /// The values of the network's input, if an array provides them.
    pub(super) picture: Vec<f32>,
    pub(super) problems: Vec<NetworkError>,
}

/// Reads a graph.
pub(super) fn read(
    graph: &GraphProto,
    folder: &ModelFolder,
    source: &InputSource<'_>,
    (opset, on_problem): (i64, ProblemPolicy),
) -> Result<GraphResult, NetworkError> {
    let (mut known, odd) = constants(graph, folder)?;
    let inputs: Vec<_> =
        graph.input.iter().filter(|input| !known.contains_key(name_of(input))).collect();
    let bound = match source {
        &InputSource::Frames(frames) => frame_input(&inputs, graph, frames, None)?,
        &InputSource::Open(open) => frame_input(&inputs, graph, None, Some(open))?,
        InputSource::Arrays(arrays) => arrays_of(&inputs, arrays, folder)?,
    };
    let network = Network::new(bound.form, bound.layout)?;
    known.extend(bound.known);
    let mut reading = GraphReader {
        network,
        known,
        unknown: HashSet::new(),
        folder,
        opset,
        on_problem,
        uses: uses(graph),
        aliased: HashSet::new(),
    };
    if let Some((name, element)) = bound.stored {
        reading.store(&name, element)?;
    }
    let first = inputs.first().map_or("", |input| name_of(input));
    let channels_last = (bound.layout == Layout::Nhwc).then_some(first);
    let problems = reading.nodes(graph, channels_last)?;
    let outputs = if problems.is_empty() { reading.outputs(graph)? } else { Vec::new() };
    let mut network = reading.network;
    network.finish(values_of(&outputs), odd);
    Ok(GraphResult { network, outputs, picture: bound.picture, problems })
}

/// All constants by their names, and the names of constants with values that are not finite, with
/// the number of such values.
type Constants = (HashMap<String, Known>, Vec<(String, usize)>);

fn constants(graph: &GraphProto, folder: &ModelFolder) -> Result<Constants, NetworkError> {
    let (mut known, mut odd) = (HashMap::new(), Vec::new());
    for tensor in &graph.initializer {
        let name = tensor.name.clone().unwrap_or_default();
        let constant = Constant::read(tensor, folder).map_err(|problem| {
            NetworkError::Network(format!("the constant `{name}`: {problem}"))
        })?;
        if constant.not_finite() > 0 {
            odd.push((name.clone(), constant.not_finite()));
        }
        known.insert(name, Known::Constant(Arc::new(constant)));
    }
    Ok((known, odd))
}

/// Returns the outputs that are tensors of the network, with their names.
fn values_of(outputs: &[(String, Known)]) -> Vec<(String, usize)> {
    let value = |(name, known): &(String, Known)| match known {
        &Known::Value(value) => Some((name.clone(), value)),
        Known::Constant(_) => None,
    };
    outputs.iter().filter_map(value).collect()
}

/// A graph of which some nodes have been read.
pub(super) struct GraphReader<'a> {
    pub(super) network: Network,
    pub(super) known: HashMap<String, Known>,
    /// The names of tensors that are not known, because a node before them cannot be read.
    unknown: HashSet<String>,
    folder: &'a ModelFolder,
    opset: i64,
    on_problem: ProblemPolicy,
    /// The number of uses of each name.
    pub(super) uses: HashMap<&'a str, usize>,
    /// The tensors that have a second name.
    pub(super) aliased: HashSet<usize>,
}

impl GraphReader<'_> {
    /// Reads all nodes, and returns the recorded problems. `channels_last` names an input whose
    /// transposition is skipped.
    fn nodes(
        &mut self,
        graph: &GraphProto,
        channels_last: Option<&str>,
    ) -> Result<Vec<NetworkError>, NetworkError> {
        let mut problems = Vec::new();
        for (index, node) in graph.node.iter().enumerate() {
            let is_transpose = channels_last.is_some_and(|name| puts_channels_first(node, name));
            let read =
                if is_transpose { self.same(node, index, 0) } else { self.node(node, index) };
            match read {
                Err(problem) if self.on_problem == ProblemPolicy::Note => {
                    problems.push(problem);
                    self.unknown.extend(node.output.iter().cloned());
                }
                read => read?,
            }
        }
        Ok(problems)
    }

    fn node(&mut self, node: &NodeProto, index: usize) -> Result<(), NetworkError> {
        let name = shown_name(node, index);
        let operator = full_kind(node);
        if !operators::is_known(&operator) {
            let advice = match self.on_problem {
                ProblemPolicy::Stop => {
                    "; `foveate infer --check MODEL` lists all nodes that are not"
                }
                ProblemPolicy::Note => "",
            };
            return Err(NetworkError::Operator { node: name, operator, advice });
        }
        let problem = |problem| NetworkError::Node {
            node: shown_name(node, index),
            operator: node.op_type.clone().unwrap_or_default(),
            problem,
        };
        OperatorSchema::check(node, self.opset).map_err(problem)?;
        if node.input.iter().any(|input| self.unknown.contains(input)) {
            self.unknown.extend(node.output.iter().cloned());
            return Ok(());
        }
        if let Some(value) = self.swish(node) {
            self.is_new(&node.output[0]).map_err(problem)?;
            self.known.insert(node.output[0].clone(), Known::Value(value));
            return Ok(());
        }
        let made = self.made(node).map_err(problem)?;
        let mut beyond = node.output.iter().enumerate().skip(made.len());
        if let Some((at, output)) =
            beyond.find(|(_, output)| self.uses.contains_key(output.as_str()))
        {
            return Err(problem(format!("its output {at}, `{output}`, is not supported")));
        }
        for (made, output) in made.into_iter().zip(&node.output) {
            self.is_new(output).map_err(problem)?;
            let known = self.known(node, &name, made)?;
            self.known.insert(output.clone(), known);
        }
        Ok(())
    }

    /// Adds the operator of an output of a node to the network, and returns the output.
    fn known(&mut self, node: &NodeProto, name: &str, made: Made) -> Result<Known, NetworkError> {
        let kind = node.op_type.clone().unwrap_or_default();
        Ok(match made {
            Made::Constant(constant) => Known::Constant(Arc::new(constant)),
            Made::Same(known) => {
                if let Known::Value(value) = known {
                    self.aliased.insert(value);
                }
                known
            }
            Made::Operator(operator, operands) => {
                Known::Value(self.push(name, &kind, operator, operands)?)
            }
            Made::Finish(activation, value) => {
                let fused = self.fuse(&kind, activation, value, &node.input[0]);
                let own = pointwise::pointwise(activation);
                Known::Value(match fused {
                    Some(value) => value,
                    None => self.network.push(name, &kind, own, vec![value])?,
                })
            }
        })
    }

    /// Adds a node that stores the input as 8-bit integers, and gives its output the name of the
    /// input.
    fn store(&mut self, name: &str, element: Element) -> Result<(), NetworkError> {
        let quantize = Arc::new(Quantize { scales: Scales::one(1.0, 0), to: element });
        let value = self.network.push(&format!("{name}/stored"), "Cast", quantize, vec![0])?;
        self.known.insert(name.to_owned(), Known::Value(value));
        Ok(())
    }

    /// Adds a node behind the nodes that make its constant inputs, and behind those that make its
    /// inputs features if it takes features.
    fn push(
        &mut self,
        name: &str,
        kind: &str,
        operator: Arc<dyn Operator>,
        operands: Vec<Operand>,
    ) -> Result<usize, NetworkError> {
        let mut inputs = Vec::new();
        for (at, operand) in operands.into_iter().enumerate() {
            let made_for = |what: &str| format!("{name}/{what}{at}");
            inputs.push(match operand {
                Operand::Constant(tensor) => {
                    let fixed = Arc::new(Fixed(tensor));
                    self.network.push(&made_for("constant"), "Constant", fixed, Vec::new())?
                }
                Operand::Value(value)
                    if operator.takes_features() && Placed::takes(self.network.form(value)) =>
                {
                    let placed = Arc::new(Placed);
                    self.network.push(&made_for("features"), "Reshape", placed, vec![value])?
                }
                Operand::Value(value) => value,
            });
        }
        self.network.push(name, kind, operator, inputs)
    }

    /// Makes the only output of a node a second name of a tensor.
    fn same(&mut self, node: &NodeProto, index: usize, value: usize) -> Result<(), NetworkError> {
        let output = &node.output[0];
        self.is_new(output).map_err(|problem| NetworkError::Node {
            node: shown_name(node, index),
            operator: full_kind(node),
            problem,
        })?;
        self.known.insert(output.clone(), Known::Value(value));
        self.aliased.insert(value);
        Ok(())
    }

    /// Fails if a tensor with this name exists.
    fn is_new(&self, output: &str) -> Result<(), String> {
        if !output.is_empty() && self.known.contains_key(output) {
            return Err(format!("its output `{output}` has the name of another tensor"));
        }
        Ok(())
    }

    /// Returns the outputs of a node.
    fn made(&self, node: &NodeProto) -> Result<Vec<Made>, String> {
        for input in node.input.iter().filter(|input| !input.is_empty()) {
            if !self.known.contains_key(input) {
                return Err(format!("its input `{input}` is made by no node before it"));
            }
        }
        let forms = |value: usize| self.network.form(value).clone();
        let attributes = NodeAttributes::of(node);
        let reader = NodeReader {
            node,
            attributes: &attributes,
            known: &self.known,
            folder: self.folder,
            opset: self.opset,
            forms: &forms,
        };
        let made = match fold::fold(&reader)? {
            Some(constant) => vec![Made::Constant(constant)],
            None => operators::make(&reader)?,
        };
        OperatorSchema::check_read(&attributes, self.opset)?;
        Ok(made)
    }

    /// Returns the outputs of the graph.
    fn outputs(&self, graph: &GraphProto) -> Result<Vec<(String, Known)>, NetworkError> {
        if graph.output.is_empty() {
            return Err(NetworkError::Network("it has no output".to_owned()));
        }
        let of = |output| {
            let name = name_of(output);
            let known = self.known.get(name).cloned().ok_or_else(|| {
                NetworkError::Network(format!("no node makes its output `{name}`"))
            })?;
            Ok((name.to_owned(), known))
        };
        graph.output.iter().map(of).collect()
    }
}

/// Counts the uses of each name, by nodes and as an output of the graph.
fn uses(graph: &GraphProto) -> HashMap<&str, usize> {
    let mut uses = HashMap::new();
    let of_nodes = graph.node.iter().flat_map(|node| node.input.iter().map(String::as_str));
    for name in of_nodes.chain(graph.output.iter().map(name_of)) {
        *uses.entry(name).or_default() += 1;
    }
    uses
}
