// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads a network from an ONNX file.

mod constant;
mod fold;
mod node;
mod operators;

use crate::error::NetworkError;
use crate::form::Form;
use crate::network::Network;
use crate::onnx::{GraphProto, ModelProto, NodeProto, ValueInfoProto};
use constant::{Constant, Folder};
use node::NodeReader;
use operators::Made;
pub use operators::operators;
use prost::Message as _;
use std::collections::HashMap;
use std::path::Path;

/// Bytes of the largest file.
const MAX_FILE: u64 = 1 << 31;

/// Width and height of the frames, for a network that takes any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// What a name stands for.
#[derive(Clone, Debug)]
enum Known {
    /// A value of the network.
    Value(usize),
    Constant(Constant),
}

impl Network {
    /// Reads a network for frames of a size.
    ///
    /// # Errors
    /// When the file cannot be read, is not a valid ONNX model, or has an operator that is not supported.
    pub fn read(path: &Path, frames: FrameSize) -> Result<Self, NetworkError> {
        let length = std::fs::metadata(path).map_err(NetworkError::io(path))?.len();
        if length > MAX_FILE {
            return Err(NetworkError::NotOnnx {
                path: path.to_owned(),
                problem: "it is larger than 2 GiB".to_owned(),
            });
        }
        let bytes = std::fs::read(path).map_err(NetworkError::io(path))?;
        Self::parse(&bytes, path, frames)
    }

    /// As [`Network::read`], with what the file `path` holds. Data outside of the file is looked for in its folder.
    ///
    /// # Errors
    /// As [`Network::read`].
    pub fn parse(bytes: &[u8], path: &Path, frames: FrameSize) -> Result<Self, NetworkError> {
        let not_onnx = |problem| NetworkError::NotOnnx { path: path.to_owned(), problem };
        let model = ModelProto::decode(bytes).map_err(|error| not_onnx(error.to_string()))?;
        let graph = model.graph.as_ref().ok_or_else(|| not_onnx("it has no graph".to_owned()))?;
        read_graph(graph, &Folder::of(path), frames)
    }
}

fn read_graph(
    graph: &GraphProto,
    folder: &Folder,
    frames: FrameSize,
) -> Result<Network, NetworkError> {
    let mut known = HashMap::new();
    for tensor in &graph.initializer {
        let name = tensor.name.clone().unwrap_or_default();
        let constant = Constant::read(tensor, folder).map_err(|problem| {
            NetworkError::Network(format!("the constant `{name}`: {problem}"))
        })?;
        known.insert(name, Known::Constant(constant));
    }
    let inputs: Vec<_> =
        graph.input.iter().filter(|input| !known.contains_key(name_of(input))).collect();
    let &[input] = inputs.as_slice() else {
        let names: Vec<_> = inputs.iter().map(|input| name_of(input)).collect();
        return Err(NetworkError::Network(format!(
            "it must have one input, the picture, but it has {} ({})",
            names.len(),
            names.join(", ")
        )));
    };
    let mut network = Network::new(input_form(input, frames)?)?;
    known.insert(name_of(input).to_owned(), Known::Value(0));
    let uses = uses(graph);
    for (index, node) in graph.node.iter().enumerate() {
        read_node(&mut network, &mut known, node, index, folder, &uses)?;
    }
    let mut outputs = Vec::new();
    for output in &graph.output {
        match known.get(name_of(output)) {
            Some(&Known::Value(value)) => outputs.push(value),
            Some(Known::Constant(_)) => {
                return Err(NetworkError::Network(format!(
                    "its output `{}` is constant",
                    name_of(output)
                )));
            }
            None => {
                return Err(NetworkError::Network(format!(
                    "no node makes its output `{}`",
                    name_of(output)
                )));
            }
        }
    }
    if outputs.is_empty() {
        return Err(NetworkError::Network("it has no output".to_owned()));
    }
    network.finish(outputs);
    Ok(network)
}

fn read_node(
    network: &mut Network,
    known: &mut HashMap<String, Known>,
    node: &NodeProto,
    index: usize,
    folder: &Folder,
    uses: &HashMap<&str, usize>,
) -> Result<(), NetworkError> {
    let kind = node.op_type.clone().unwrap_or_default();
    let name = node
        .name
        .clone()
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| format!("{kind}_{index}"));
    let forms = |value: usize| network.form(value).clone();
    let problem =
        |problem| NetworkError::Node { node: name.clone(), operator: kind.clone(), problem };
    let reader = NodeReader { node, known, folder, forms: &forms };
    if !matches!(node.domain.as_deref(), None | Some("" | "ai.onnx")) || !operators::is_known(&kind)
    {
        let domain = node.domain.as_deref().filter(|domain| !domain.is_empty());
        let operator = domain.map_or_else(|| kind.clone(), |domain| format!("{domain}.{kind}"));
        let advice = "docs/guides/infer.md lists those that are";
        return Err(NetworkError::Operator { node: name, operator, advice });
    }
    for input in node.input.iter().filter(|input| !input.is_empty()) {
        if !known.contains_key(input) {
            return Err(problem(format!("its input `{input}` is made by no node before it")));
        }
    }
    let made = match fold::fold(&reader).map_err(problem)? {
        Some(constants) => constants.into_iter().map(Made::Constant).collect(),
        None => operators::make(&reader).map_err(problem)?,
    };
    for (made, output) in made.into_iter().zip(node.output.iter()) {
        let what = match made {
            Made::Constant(constant) => Known::Constant(constant),
            Made::Same(known) => known,
            Made::Operator(operator, inputs) => {
                Known::Value(network.push(&name, &kind, operator, inputs)?)
            }
            Made::Finish(activation, value) => {
                // The convolution just before applies it, if nobody else wants what it makes.
                let input = node.input[0].as_str();
                let alone = value == network.nodes().len() && uses.get(input) == Some(&1);
                let finished = network
                    .nodes()
                    .last()
                    .filter(|_| alone)
                    .and_then(|last| last.operator.finished(activation));
                match finished {
                    Some(operator) => {
                        let fused = format!(
                            "{}+{kind}",
                            network.nodes().last().map_or("", |last| last.kind())
                        );
                        network.replace_last(&fused, operator);
                        Known::Value(value)
                    }
                    None => Known::Value(network.push(
                        &name,
                        &kind,
                        operators::pointwise(activation),
                        vec![value],
                    )?),
                }
            }
        };
        known.insert(output.clone(), what);
    }
    Ok(())
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

fn name_of(value: &ValueInfoProto) -> &str {
    value.name.as_deref().unwrap_or_default()
}

/// The form of the input: features of which the size may be open.
fn input_form(input: &ValueInfoProto, frames: FrameSize) -> Result<Form, NetworkError> {
    let wrong = |what: String| {
        NetworkError::Network(format!(
            "its input `{}` must be [1, channels, height, width], {what}",
            name_of(input)
        ))
    };
    let tensor = input.r#type.as_ref().and_then(|of| of.tensor_type.as_ref());
    let shape = tensor
        .and_then(|tensor| tensor.shape.as_ref())
        .ok_or_else(|| wrong("but it has no shape".to_owned()))?;
    let lengths: Vec<Option<usize>> = shape
        .dim
        .iter()
        .map(|dim| {
            dim.dim_value
                .and_then(|length| usize::try_from(length).ok())
                .filter(|&length| length > 0)
        })
        .collect();
    let &[batch, channels, height, width] = lengths.as_slice() else {
        return Err(wrong(format!("but it has {} axes", lengths.len())));
    };
    if batch.is_some_and(|batch| batch != 1) {
        return Err(wrong(format!("but it takes {} pictures at once", batch.unwrap_or(0))));
    }
    let channels = channels.ok_or_else(|| wrong("but its channels are open".to_owned()))?;
    if channels != 1 && channels != 3 {
        return Err(wrong(format!("with 1 or 3 channels, but it has {channels}")));
    }
    let (own_height, own_width) = (height.unwrap_or(frames.height), width.unwrap_or(frames.width));
    if (own_height, own_width) != (frames.height, frames.width) {
        return Err(NetworkError::Size {
            wanted: format!("{own_width}x{own_height}"),
            found: format!("{}x{}", frames.width, frames.height),
        });
    }
    Ok(Form::features(vec![1, channels, own_height, own_width]))
}
