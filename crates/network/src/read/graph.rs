// SPDX-License-Identifier: MIT OR Apache-2.0
//! The graph of a model, node by node.

use super::constant::{Constant, Folder};
use super::fold;
use super::input::{FrameSize, input_form, puts_channels_first};
use super::made::Made;
use super::names::{full_kind, name_of, shown_name};
use super::node::{Known, NodeReader, Operand};
use super::operators;
use super::pointwise;
use crate::error::NetworkError;
use crate::layout::Layout;
use crate::network::Network;
use crate::onnx::{GraphProto, NodeProto};
use crate::operator::{Activation, Fixed, Operator, Placed};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Reads a graph for frames of a size, or of its own.
pub(super) fn read(
    graph: &GraphProto,
    folder: &Folder,
    frames: Option<FrameSize>,
    opset: i64,
) -> Result<Network, NetworkError> {
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
    let inputs: Vec<_> =
        graph.input.iter().map(name_of).filter(|name| !known.contains_key(*name)).collect();
    let &[name] = inputs.as_slice() else {
        return Err(NetworkError::Network(format!(
            "it must have one input, the picture, but it has {} ({})",
            inputs.len(),
            inputs.join(", ")
        )));
    };
    let input = graph.input.iter().find(|input| name_of(input) == name).expect("it is one of them");
    let (form, layout) = input_form(input, graph, frames)?;
    let network = Network::new(form, layout)?;
    known.insert(name.to_owned(), Known::Value(0));
    let mut reading =
        Reading { network, known, folder, opset, uses: uses(graph), aliased: HashSet::new() };
    for (index, node) in graph.node.iter().enumerate() {
        if layout == Layout::Nhwc && puts_channels_first(node, name) {
            // The input is read as what this makes of it.
            reading.same(node, index, 0)?;
        } else {
            reading.node(node, index)?;
        }
    }
    let named = |name: &str| Ok::<_, NetworkError>((name.to_owned(), reading.output(name)?));
    let outputs = graph.output.iter().map(|output| named(name_of(output)));
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    if outputs.is_empty() {
        return Err(NetworkError::Network("it has no output".to_owned()));
    }
    reading.network.finish(outputs, odd);
    Ok(reading.network)
}

/// A graph of which some nodes have been read.
struct Reading<'a> {
    network: Network,
    known: HashMap<String, Known>,
    folder: &'a Folder,
    opset: i64,
    /// How often each name is taken.
    uses: HashMap<&'a str, usize>,
    /// Values that have a second name.
    aliased: HashSet<usize>,
}

impl Reading<'_> {
    fn node(&mut self, node: &NodeProto, index: usize) -> Result<(), NetworkError> {
        let kind = node.op_type.clone().unwrap_or_default();
        let name = shown_name(node, index);
        let operator = full_kind(node);
        if !operators::is_known(&operator) {
            return Err(NetworkError::Operator {
                node: name,
                operator,
                advice: "docs/guides/infer.md lists those that are",
            });
        }
        if let Some(value) = self.swish(node) {
            self.is_new(&node.output[0]).map_err(|problem| NetworkError::Node {
                node: name.clone(),
                operator: kind.clone(),
                problem,
            })?;
            self.known.insert(node.output[0].clone(), Known::Value(value));
            return Ok(());
        }
        let made = self.made(node).map_err(|problem| NetworkError::Node {
            node: name.clone(),
            operator: kind.clone(),
            problem,
        })?;
        for (made, output) in made.into_iter().zip(&node.output) {
            self.is_new(output).map_err(|problem| NetworkError::Node {
                node: name.clone(),
                operator: kind.clone(),
                problem,
            })?;
            let what = match made {
                Made::Constant(constant) => Known::Constant(Arc::new(constant)),
                Made::Same(what) => {
                    if let Known::Value(value) = what {
                        self.aliased.insert(value);
                    }
                    what
                }
                Made::Operator(operator, operands) => {
                    Known::Value(self.push(&name, &kind, operator, operands)?)
                }
                Made::Finish(activation, value) => {
                    let fused = self.fuse(&kind, activation, value, &node.input[0]);
                    Known::Value(match fused {
                        Some(value) => value,
                        None => self.network.push(
                            &name,
                            &kind,
                            pointwise::pointwise(activation),
                            vec![value],
                        )?,
                    })
                }
            };
            self.known.insert(output.clone(), what);
        }
        Ok(())
    }

    /// Adds a node behind those that make its inputs what it takes: constants, and features.
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

    /// Lets the only output of a node be a value that there is.
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

    /// Refuses a name that something has.
    fn is_new(&self, output: &str) -> Result<(), String> {
        if !output.is_empty() && self.known.contains_key(output) {
            return Err(format!("its output `{output}` has the name of another tensor"));
        }
        Ok(())
    }

    /// What the outputs of a node are.
    fn made(&self, node: &NodeProto) -> Result<Vec<Made>, String> {
        for input in node.input.iter().filter(|input| !input.is_empty()) {
            if !self.known.contains_key(input) {
                return Err(format!("its input `{input}` is made by no node before it"));
            }
        }
        let forms = |value: usize| self.network.form(value).clone();
        let reader = NodeReader {
            node,
            known: &self.known,
            folder: self.folder,
            opset: self.opset,
            forms: &forms,
        };
        match fold::fold(&reader)? {
            Some(constant) => Ok(vec![Made::Constant(constant)]),
            None => operators::make(&reader),
        }
    }

    /// Lets the operator just before apply an activation itself, if nobody else wants what it makes.
    fn fuse(
        &mut self,
        kind: &str,
        activation: Activation,
        value: usize,
        input: &str,
    ) -> Option<usize> {
        let is_alone = value == self.network.nodes().len()
            && self.uses.get(input) == Some(&1)
            && !self.aliased.contains(&value);
        let last = self.network.nodes().last().filter(|_| is_alone)?;
        let operator = last.operator.finished(activation)?;
        let fused = format!("{}+{kind}", last.kind());
        self.network.replace_last(&fused, operator);
        Some(value)
    }

    /// Lets a value times its own `Sigmoid`, which is the last node, be one activation, and the operator before apply it, if nobody else wants
    /// what it makes.
    fn swish(&mut self, node: &NodeProto) -> Option<usize> {
        let ([a, b], [_]) = (node.input.as_slice(), node.output.as_slice()) else { return None };
        let value = |name: &str| match self.known.get(name) {
            Some(&Known::Value(value)) => Some(value),
            Some(Known::Constant(_)) | None => None,
        };
        let (of_a, of_b) = (value(a)?, value(b)?);
        let gate = self.network.nodes().len();
        let (input, input_name, gate_name) = match (of_a, of_b) {
            (input, other) if other == gate => (input, a, b),
            (other, input) if other == gate => (input, b, a),
            _ => return None,
        };
        let last = self.network.nodes().last()?;
        let is_swish = full_kind(node) == "Mul"
            && last.kind() == "Sigmoid"
            && last.inputs() == [input]
            && self.uses.get(gate_name.as_str()) == Some(&1)
            && !self.aliased.contains(&gate);
        if !is_swish {
            return None;
        }
        let swish = Activation::Swish { alpha: 1.0 };
        let is_alone = input > 0
            && input + 1 == gate
            && self.uses.get(input_name.as_str()) == Some(&2)
            && !self.aliased.contains(&input);
        let before = is_alone.then(|| &self.network.nodes()[input - 1]);
        let finished =
            before.and_then(|before| Some((before.kind(), before.operator.finished(swish)?)));
        match finished {
            Some((kind, operator)) => {
                let kind = format!("{kind}+Sigmoid+Mul");
                self.network.remove_last();
                self.network.replace_last(&kind, operator);
                Some(input)
            }
            None => {
                self.network.replace_last("Sigmoid+Mul", pointwise::pointwise(swish));
                Some(gate)
            }
        }
    }

    fn output(&self, name: &str) -> Result<usize, NetworkError> {
        match self.known.get(name) {
            Some(&Known::Value(value)) => Ok(value),
            Some(Known::Constant(_)) => {
                Err(NetworkError::Network(format!("its output `{name}` is constant")))
            }
            None => Err(NetworkError::Network(format!("no node makes its output `{name}`"))),
        }
    }
}

/// How often each name is taken: by nodes, and as an output of the network.
fn uses(graph: &GraphProto) -> HashMap<&str, usize> {
    let mut uses = HashMap::new();
    let of_nodes = graph.node.iter().flat_map(|node| node.input.iter().map(String::as_str));
    for name in of_nodes.chain(graph.output.iter().map(name_of)) {
        *uses.entry(name).or_default() += 1;
    }
    uses
}
