// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a network can be run, said of all its nodes at once.

use crate::InferenceError;
use foveate_network::{FrameSize, Network, NetworkCheck};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Width and height of the frames for which a network is looked at that takes any size.
pub const OPEN_SIZE: (u32, u32) = (224, 224);

/// A network that was looked at.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkReport {
    /// Nodes of the model.
    pub nodes: usize,
    /// A sentence for every node that cannot be run; none if the network can.
    pub problems: Vec<String>,
    /// Facts about the network, if it can be run.
    pub network: Option<NetworkFacts>,
}

/// A network that can be run.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkFacts {
    /// Shape of the input with channels first, for the size that was looked at.
    pub input: Vec<usize>,
    /// The order in which the model takes the axes of the input: nchw or nhwc.
    pub layout: &'static str,
    /// Names and shapes of the outputs.
    pub outputs: Vec<(String, Vec<usize>)>,
    /// Nodes of each operator, after operators that do the work of several nodes have taken it over.
    pub operators: BTreeMap<String, usize>,
    /// Multiplications and additions for a frame.
    pub macs: u64,
    /// Bytes of all weights.
    pub weight_bytes: u64,
    /// Bytes of the tensors that are kept from frame to frame.
    pub kept_bytes: u64,
}

/// Looks at all nodes of a network, for frames of a size where it takes any.
///
/// # Errors
/// When the file cannot be read, is not a valid ONNX model, or its inputs are not one that takes frames.
pub fn check_network(path: &Path, open: (u32, u32)) -> Result<NetworkReport, InferenceError> {
    let open = FrameSize { width: open.0 as usize, height: open.1 as usize };
    let NetworkCheck { nodes, network } = Network::check(path, open)?;
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
        *operators.entry(node.kind().to_owned()).or_default() += 1;
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
