// SPDX-License-Identifier: MIT OR Apache-2.0
//! A check of whether a network can be run, which reports all its nodes at once.

use crate::InferenceError;
use foveate_network::{FrameSize, Network, NetworkCheck};
use foveate_tools::open_file;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The width and height of frames in pixels for the check of a network that takes any size.
pub const OPEN_SIZE: (u32, u32) = (224, 224);

/// The result of checking a network.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkReport {
    /// The number of nodes of the model.
    pub nodes: usize,
    /// A sentence for every node that cannot be run; empty if the network can be run.
    pub problems: Vec<String>,
    /// The facts about the network, if it can be run.
    pub network: Option<NetworkFacts>,
}

/// The facts about a network that can be run.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkFacts {
    /// The shape of the input with channels first, for the size of the check.
    pub input: Vec<usize>,
    /// The order of the axes in which the model takes its input: `nchw` or `nhwc`.
    pub layout: &'static str,
    /// The names and shapes of the outputs.
    pub outputs: Vec<(String, Vec<usize>)>,
    /// The number of nodes of each operator, after nodes have been merged into operators that do
    /// their work.
    pub operators: BTreeMap<String, usize>,
    /// The number of multiplications and additions for a frame.
    pub macs: u64,
    /// The size of all weights in bytes.
    pub weight_bytes: u64,
    /// The size in bytes of the tensors that are kept from frame to frame.
    pub kept_bytes: u64,
}

/// Checks all nodes of a network. A network that takes frames of any size is checked for the size
/// `open`, width and height in pixels.
///
/// # Errors
/// Fails if the file cannot be read or is not a valid ONNX model, or if the network does not have
/// exactly one input that takes frames.
pub fn check_network(path: &Path, open: (u32, u32)) -> Result<NetworkReport, InferenceError> {
    let open = FrameSize { width: open.0 as usize, height: open.1 as usize };
    let NetworkCheck { nodes, network } = Network::check(path, open_file, open)?;
    Ok(match network {
        Ok(network) => {
            NetworkReport { nodes, problems: Vec::new(), network: Some(facts(&network)) }
        }
        Err(problems) => {
            let problems = problems.iter().map(ToString::to_string).collect();
            NetworkReport { nodes, problems, network: None }
        }
    })
}

fn facts(network: &Network) -> NetworkFacts {
    let shape = |&value: &usize| network.form(value).shape().to_vec();
    let names = network.output_names().iter().cloned();
    let mut operators = BTreeMap::new();
    for node in network.nodes() {
        *operators.entry(node.operator_name().to_owned()).or_default() += 1;
    }
    NetworkFacts {
        input: network.input().shape().to_vec(),
        layout: network.layout().name(),
        outputs: names.zip(network.outputs().iter().map(shape)).collect(),
        operators,
        macs: network.total_macs(),
        weight_bytes: network.weight_bytes(),
        kept_bytes: network.kept_bytes(),
    }
}
