// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reading of networks from ONNX files.

mod activation_fusion;
mod arrays;
mod constant;
mod constant_arithmetic;
mod constant_folding;
mod constant_selection;
mod constant_values;
mod graph;
mod memory;
mod model_folder;
mod network_input;
mod node;
mod operators;
mod pointwise_operators;
mod quantized_operators;
mod reductions;
mod reshaping;
mod scales;
mod schema;
mod transposed_conv;

use crate::error::NetworkError;
use crate::network::Network;
use crate::onnx::ModelProto;
use graph::{GraphResult, InputSource, ProblemPolicy};
use model_folder::ModelFolder;
use node::GraphValue;
use prost::Message as _;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

pub(crate) use arrays::read_for_arrays;
pub use network_input::FrameSize;
pub use operators::operators;

/// Opens an input file. The executor runs in the browser, too, so the caller knows how files are
/// opened.
pub type OpenFile = fn(&Path) -> io::Result<File>;

/// The bytes of the largest file.
const MAX_FILE_BYTES: u64 = 1 << 31;
/// The largest number of bytes that the messages of a file may take in memory.
const MAX_MESSAGE_BYTES: u64 = 1 << 33;
/// The oldest supported version of the operators. Since this version operators broadcast as they do
/// in later ones.
const MIN_OPSET: i64 = 7;
/// The newest supported version of the operators. Changes in later versions are not known.
const MAX_OPSET: i64 = 28;

impl Network {
    /// Reads a network for frames of this size, or without a size for frames of the network's own
    /// size.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is not a valid ONNX model, or has an operator that is not
    /// supported. Without a size it also fails if the network takes frames of any size.
    pub fn read(
        path: &Path,
        open: OpenFile,
        frames: impl Into<Option<FrameSize>>,
    ) -> Result<Self, NetworkError> {
        Self::read_bytes(&read_file(path, open)?, &ModelFolder::of_model(path, open), path, frames)
    }

    /// Reads a network as [`Network::read`] does, from the content of the file `path`. Data outside
    /// of the file are read from its folder.
    ///
    /// # Errors
    /// Fails as [`Network::read`] does.
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        frames: impl Into<Option<FrameSize>>,
    ) -> Result<Self, NetworkError> {
        let open = |path: &Path| File::open(path);
        Self::read_bytes(bytes, &ModelFolder::of_model(path, open), path, frames)
    }

    fn read_bytes(
        bytes: &[u8],
        folder: &ModelFolder,
        path: &Path,
        frames: impl Into<Option<FrameSize>>,
    ) -> Result<Self, NetworkError> {
        let (model, source) = (decode_model(bytes, path)?, InputSource::Frames(frames.into()));
        let read = read_model_graph(&model, (path, folder), &source, ProblemPolicy::Stop)?;
        let constant = read.outputs.iter().find(|(_, of)| matches!(of, GraphValue::Constant(_)));
        match constant {
            None => Ok(read.network),
            Some((name, _)) => {
                Err(NetworkError::InvalidNetwork(format!("its output `{name}` is constant")))
            }
        }
    }

    /// Reads a network, and continues after a node that cannot be read. `size` is the size of
    /// frames if the network takes any. Of a node that depends on one that cannot be read, only the
    /// operator and the attributes are checked.
    ///
    /// # Errors
    /// Fails as [`Network::read`] does, except for problems of nodes.
    pub fn check(
        path: &Path,
        open: OpenFile,
        size: FrameSize,
    ) -> Result<NetworkCheck, NetworkError> {
        let model = decode_model(&read_file(path, open)?, path)?;
        let folder = ModelFolder::of_model(path, open);
        let source = InputSource::DefaultFrames(size);
        let read = read_model_graph(&model, (path, &folder), &source, ProblemPolicy::Note)?;
        let nodes = model.graph.map_or(0, |graph| graph.node.len());
        let network = if read.problems.is_empty() { Ok(read.network) } else { Err(read.problems) };
        Ok(NetworkCheck { nodes, network })
    }
}

/// The result of a check of all nodes of a network.
#[derive(Debug)]
pub struct NetworkCheck {
    /// The number of nodes of the model. The network has fewer nodes where an operator does the
    /// work of several.
    pub nodes: usize,
    /// The network, or the problems of the nodes that cannot be read.
    pub network: Result<Network, Vec<NetworkError>>,
}

/// Reads the bytes of a file, and fails if they exceed the limit.
fn read_file(path: &Path, open: OpenFile) -> Result<Vec<u8>, NetworkError> {
    if !path.metadata().map_err(NetworkError::io(path))?.is_file() {
        return Err(not_onnx(path, "it is not a file"));
    }
    let mut bytes = Vec::new();
    let file = open(path).map_err(NetworkError::io(path))?;
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(NetworkError::io(path))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(not_onnx(path, "it is larger than 2 GiB"));
    }
    Ok(bytes)
}

fn not_onnx(path: &Path, problem: &str) -> NetworkError {
    NetworkError::NotOnnx { path: path.to_owned(), problem: problem.to_owned() }
}

fn read_model_graph(
    model: &ModelProto,
    (path, folder): (&Path, &ModelFolder),
    source: &InputSource<'_>,
    on_problem: ProblemPolicy,
) -> Result<GraphResult, NetworkError> {
    let graph = model.graph.as_ref().ok_or_else(|| not_onnx(path, "it has no graph"))?;
    let own = model.opset_import.iter().find(|set| node::is_standard(set.domain.as_deref()));
    let opset = own.and_then(|set| set.version).unwrap_or(MAX_OPSET);
    if !(MIN_OPSET..=MAX_OPSET).contains(&opset) {
        return Err(NetworkError::InvalidNetwork(format!(
            "it uses version {opset} of the ONNX operators; versions {MIN_OPSET} to {MAX_OPSET} are supported"
        )));
    }
    let functions = model.functions.iter().map(node::full_function_name).collect();
    graph::read_graph(graph, functions, folder, source, (opset, on_problem))
}

fn decode_model(bytes: &[u8], path: &Path) -> Result<ModelProto, NetworkError> {
    let memory = memory::model_memory(bytes);
    if memory > MAX_MESSAGE_BYTES {
        return Err(NetworkError::InvalidNetwork(format!(
            "it may take {} MiB of memory to read; at most {} are supported",
            memory >> 20,
            MAX_MESSAGE_BYTES >> 20
        )));
    }
    ModelProto::decode(bytes).map_err(|error| not_onnx(path, &error.to_string()))
}
