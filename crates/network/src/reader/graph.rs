// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reading of the graph of a model, node by node ([`read_graph`]).

use super::constant::Constant;
use super::model_folder::ModelFolder;
use super::network_input::{FrameSize, array_inputs, frame_input, puts_channels_first};
use super::node::{
    GraphValue, NodeAttributes, NodeOutput, NodeReader, Operand, full_operator_name, node_name,
    value_name,
};
use super::schema::OperatorSchema;
use super::{constant_folding, operators, pointwise_operators};
use crate::element::ElementType;
use crate::error::NetworkError;
use crate::network::Network;
use crate::onnx::{GraphProto, NodeProto, TensorProto};
use crate::operator::{ConstantTensor, FeatureView, Operator, QuantizationScales, Quantize};
use crate::tensor::InputLayout;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

pub(super) enum InputSource<'a> {
    /// The only input takes frames of this size, or of the network's size if there is none.
    Frames(Option<FrameSize>),
    /// The only input takes frames of the network's size, or of this size if the network takes any.
    DefaultFrames(FrameSize),
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

pub(super) struct GraphResult {
    pub(super) network: Network,
    /// The outputs in order, each with its name: a tensor of the network, or a constant.
    pub(super) outputs: Vec<(String, GraphValue)>,
    /// The values of the network's input, if an array provides them.
    pub(super) input_values: Vec<f32>,
    pub(super) problems: Vec<NetworkError>,
}

/// Reads a graph. `functions` are the names of the functions of the model, with their domains.
pub(super) fn read_graph(
    graph: &GraphProto,
    functions: HashSet<String>,
    folder: &ModelFolder,
    source: &InputSource<'_>,
    (opset, on_problem): (i64, ProblemPolicy),
) -> Result<GraphResult, NetworkError> {
    let (mut known, non_finite) = read_constants(graph, folder)?;
    let inputs: Vec<_> =
        graph.input.iter().filter(|input| !known.contains_key(value_name(input))).collect();
    let binding = match source {
        &InputSource::Frames(frames) => frame_input(&inputs, graph, frames, None)?,
        &InputSource::DefaultFrames(default_size) => {
            frame_input(&inputs, graph, None, Some(default_size))?
        }
        InputSource::Arrays(arrays) => array_inputs(&inputs, arrays, folder)?,
    };
    let network = Network::new(binding.form, binding.layout)?;
    known.extend(binding.values);
    let mut reader = GraphReader {
        network,
        values: known,
        unknown_names: HashSet::new(),
        folder,
        functions,
        given_advice: HashSet::new(),
        opset,
        on_problem,
        use_counts: count_uses(graph),
        aliased_tensors: HashSet::new(),
    };
    if let Some((name, element)) = binding.stored_input {
        reader.add_stored_input(&name, element)?;
    }
    let first = inputs.first().map_or("", |input| value_name(input));
    let channels_last = (binding.layout == InputLayout::Nhwc).then_some(first);
    let problems = reader.read_nodes(graph, channels_last)?;
    let outputs = if problems.is_empty() { reader.graph_outputs(graph)? } else { Vec::new() };
    let mut network = reader.network;
    network.set_outputs(tensor_outputs(&outputs), non_finite);
    Ok(GraphResult { network, outputs, input_values: binding.input_values, problems })
}

/// All constants by their names, and the names of constants with values that are not finite, with
/// the number of such values.
type GraphConstants = (HashMap<String, GraphValue>, Vec<(String, usize)>);

fn read_constants(
    graph: &GraphProto,
    folder: &ModelFolder,
) -> Result<GraphConstants, NetworkError> {
    let (mut known, mut non_finite) = (HashMap::new(), Vec::new());
    for tensor in &graph.initializer {
        let name = tensor.name.clone().unwrap_or_default();
        let constant = Constant::decode(tensor, folder).map_err(|problem| {
            NetworkError::InvalidNetwork(format!("the constant `{name}`: {problem}"))
        })?;
        if constant.count_not_finite() > 0 {
            non_finite.push((name.clone(), constant.count_not_finite()));
        }
        known.insert(name, GraphValue::Constant(Arc::new(constant)));
    }
    Ok((known, non_finite))
}

/// Returns the outputs that are tensors of the network, with their names.
fn tensor_outputs(outputs: &[(String, GraphValue)]) -> Vec<(String, usize)> {
    let value = |(name, known): &(String, GraphValue)| match known {
        &GraphValue::Tensor(value) => Some((name.clone(), value)),
        GraphValue::Constant(_) => None,
    };
    outputs.iter().filter_map(value).collect()
}

/// The advice on an operator that selects detections.
const SELECTION_ADVICE: &str = "; in most models it selects detections behind the network, so export without it \
    (Ultralytics: `nms=False` and `end2end=False`; other YOLO: without `--end2end`), or cut the model before it with \
    `onnx.utils.extract_model`";
const FUNCTION_ADVICE: &str = ", because it is a function of the model itself; replace functions by their nodes: \
    `onnx.save(onnx.inliner.inline_local_functions(onnx.load(\"MODEL\")), \"INLINED\")`";

/// A graph of which some nodes have been read.
pub(super) struct GraphReader<'a> {
    pub(super) network: Network,
    pub(super) values: HashMap<String, GraphValue>,
    /// The names of tensors that are not known, because a node before them cannot be read.
    unknown_names: HashSet<String>,
    folder: &'a ModelFolder,
    /// The names of the functions of the model, with their domains.
    functions: HashSet<String>,
    /// The advice that recorded problems have given.
    given_advice: HashSet<&'static str>,
    opset: i64,
    on_problem: ProblemPolicy,
    /// The number of uses of each name.
    pub(super) use_counts: HashMap<&'a str, usize>,
    /// The tensors that have a second name.
    pub(super) aliased_tensors: HashSet<usize>,
}

impl GraphReader<'_> {
    /// Returns the end of the message for an operator that is not supported.
    fn advice_on_operator(&self, operator: &str) -> &'static str {
        if self.functions.contains(operator) {
            return FUNCTION_ADVICE;
        }
        if operator == "TopK" || operator.contains("NMS") || operator == "NonMaxSuppression" {
            return SELECTION_ADVICE;
        }
        match self.on_problem {
            ProblemPolicy::Stop => "; `foveate infer --check MODEL` lists all such nodes",
            ProblemPolicy::Note => "",
        }
    }

    /// Reads all nodes, and returns the recorded problems. `channels_last` names an input whose
    /// transposition is skipped.
    fn read_nodes(
        &mut self,
        graph: &GraphProto,
        channels_last: Option<&str>,
    ) -> Result<Vec<NetworkError>, NetworkError> {
        let mut problems = Vec::new();
        for (index, node) in graph.node.iter().enumerate() {
            let is_transpose = channels_last.is_some_and(|name| puts_channels_first(node, name));
            let read = if is_transpose {
                self.alias_output(node, index, 0)
            } else {
                self.read_node(node, index)
            };
            match read {
                Err(problem) if self.on_problem == ProblemPolicy::Note => {
                    problems.push(problem);
                    self.unknown_names.extend(node.output.iter().cloned());
                }
                read => read?,
            }
        }
        Ok(problems)
    }

    fn read_node(&mut self, node: &NodeProto, index: usize) -> Result<(), NetworkError> {
        let name = node_name(node, index);
        let operator = full_operator_name(node);
        if !operators::is_supported(&operator) {
            let mut advice = self.advice_on_operator(&operator);
            if self.on_problem == ProblemPolicy::Note && !self.given_advice.insert(advice) {
                advice = "";
            }
            return Err(NetworkError::UnsupportedOperator { node: name, operator, advice });
        }
        let problem = |problem| NetworkError::InvalidNode {
            node: node_name(node, index),
            operator: node.op_type.clone().unwrap_or_default(),
            problem,
        };
        OperatorSchema::check(node, self.opset).map_err(problem)?;
        if node.input.iter().any(|input| self.unknown_names.contains(input)) {
            self.unknown_names.extend(node.output.iter().cloned());
            return Ok(());
        }
        if let Some(value) = self.fuse_swish(node) {
            self.check_name_is_new(&node.output[0]).map_err(problem)?;
            self.values.insert(node.output[0].clone(), GraphValue::Tensor(value));
            return Ok(());
        }
        let outputs = self.node_outputs(node).map_err(problem)?;
        let mut unread_outputs = node.output.iter().enumerate().skip(outputs.len());
        if let Some((at, output)) =
            unread_outputs.find(|(_, output)| self.use_counts.contains_key(output.as_str()))
        {
            return Err(problem(format!("its output {at}, `{output}`, is not supported")));
        }
        for (output, output_name) in outputs.into_iter().zip(&node.output) {
            self.check_name_is_new(output_name).map_err(problem)?;
            let known = self.add_output(node, &name, output)?;
            self.values.insert(output_name.clone(), known);
        }
        Ok(())
    }

    /// Adds the operator of an output of a node to the network, and returns the output.
    fn add_output(
        &mut self,
        node: &NodeProto,
        name: &str,
        output: NodeOutput,
    ) -> Result<GraphValue, NetworkError> {
        let kind = node.op_type.clone().unwrap_or_default();
        Ok(match output {
            NodeOutput::Constant(constant) => GraphValue::Constant(Arc::new(constant)),
            NodeOutput::Alias(known) => {
                if let GraphValue::Tensor(value) = known {
                    self.aliased_tensors.insert(value);
                }
                known
            }
            NodeOutput::Operator(operator, operands) => {
                GraphValue::Tensor(self.push_with_operands(name, &kind, operator, operands)?)
            }
            NodeOutput::Activated(activation, value) => {
                let fused = self.fuse_activation(&kind, activation, value, &node.input[0]);
                let activation_operator = pointwise_operators::activation_operator(activation);
                GraphValue::Tensor(match fused {
                    Some(value) => value,
                    None => self.network.push(name, &kind, activation_operator, vec![value])?,
                })
            }
        })
    }

    /// Adds a node that stores the input as 8-bit integers, and gives its output the name of the
    /// input.
    fn add_stored_input(&mut self, name: &str, element: ElementType) -> Result<(), NetworkError> {
        let quantize =
            Arc::new(Quantize { scales: QuantizationScales::per_tensor(1.0, 0), to: element });
        let value = self.network.push(&format!("{name}/stored"), "Cast", quantize, vec![0])?;
        self.values.insert(name.to_owned(), GraphValue::Tensor(value));
        Ok(())
    }

    /// Adds a node behind the nodes that make its constant inputs, and behind those that make its
    /// inputs features if it takes features.
    fn push_with_operands(
        &mut self,
        name: &str,
        kind: &str,
        operator: Arc<dyn Operator>,
        operands: Vec<Operand>,
    ) -> Result<usize, NetworkError> {
        let mut inputs = Vec::new();
        for (at, operand) in operands.into_iter().enumerate() {
            let helper_name = |what: &str| format!("{name}/{what}{at}");
            inputs.push(match operand {
                Operand::Constant(tensor) => {
                    let constant = Arc::new(ConstantTensor(tensor));
                    self.network.push(&helper_name("constant"), "Constant", constant, Vec::new())?
                }
                Operand::Tensor(value)
                    if operator.takes_features()
                        && FeatureView::applies_to(self.network.form(value)) =>
                {
                    let view = Arc::new(FeatureView);
                    self.network.push(&helper_name("features"), "Reshape", view, vec![value])?
                }
                Operand::Tensor(value) => value,
            });
        }
        self.network.push(name, kind, operator, inputs)
    }

    /// Makes the only output of a node a second name of a tensor.
    fn alias_output(
        &mut self,
        node: &NodeProto,
        index: usize,
        value: usize,
    ) -> Result<(), NetworkError> {
        let output = &node.output[0];
        self.check_name_is_new(output).map_err(|problem| NetworkError::InvalidNode {
            node: node_name(node, index),
            operator: full_operator_name(node),
            problem,
        })?;
        self.values.insert(output.clone(), GraphValue::Tensor(value));
        self.aliased_tensors.insert(value);
        Ok(())
    }

    /// Fails if a tensor with this name exists.
    fn check_name_is_new(&self, output: &str) -> Result<(), String> {
        if !output.is_empty() && self.values.contains_key(output) {
            return Err(format!("its output `{output}` has the name of another tensor"));
        }
        Ok(())
    }

    fn node_outputs(&self, node: &NodeProto) -> Result<Vec<NodeOutput>, String> {
        for input in node.input.iter().filter(|input| !input.is_empty()) {
            if !self.values.contains_key(input) {
                return Err(format!("no earlier node makes its input `{input}`"));
            }
        }
        let forms = |value: usize| self.network.form(value).clone();
        let attributes = NodeAttributes::new(node);
        let reader = NodeReader {
            node,
            attributes: &attributes,
            values: &self.values,
            folder: self.folder,
            opset: self.opset,
            forms: &forms,
        };
        let outputs = match constant_folding::fold_node(&reader)? {
            Some(constant) => vec![NodeOutput::Constant(constant)],
            None => operators::read_outputs(&reader)?,
        };
        OperatorSchema::check_unread(&attributes, self.opset)?;
        Ok(outputs)
    }

    fn graph_outputs(&self, graph: &GraphProto) -> Result<Vec<(String, GraphValue)>, NetworkError> {
        if graph.output.is_empty() {
            return Err(NetworkError::InvalidNetwork("it has no output".to_owned()));
        }
        let output_value = |output| {
            let name = value_name(output);
            let known = self.values.get(name).cloned().ok_or_else(|| {
                NetworkError::InvalidNetwork(format!("no node makes its output `{name}`"))
            })?;
            Ok((name.to_owned(), known))
        };
        graph.output.iter().map(output_value).collect()
    }
}

/// Counts the uses of each name, by nodes and as an output of the graph.
fn count_uses(graph: &GraphProto) -> HashMap<&str, usize> {
    let mut uses = HashMap::new();
    let of_nodes = graph.node.iter().flat_map(|node| node.input.iter().map(String::as_str));
    for name in of_nodes.chain(graph.output.iter().map(value_name)) {
        *uses.entry(name).or_default() += 1;
    }
    uses
}
