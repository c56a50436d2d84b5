// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads a network from an ONNX file.

mod constant;
mod elementwise;
mod fold;
mod graph;
mod input;
mod made;
mod memory;
mod moves;
mod names;
mod node;
mod normal;
mod operators;
mod parts;
mod pointwise;
mod quantized;
mod rearrange;
mod scales;
mod sizes;
mod sums;
mod transposed;

use crate::error::NetworkError;
use crate::network::Network;
use crate::onnx::ModelProto;
use constant::Folder;
use prost::Message as _;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

pub use input::FrameSize;
pub use operators::operators;

/// Bytes of the largest file.
const MAX_FILE: u64 = 1 << 31;
/// Bytes that the messages of a file take in memory.
const MAX_MEMORY: u64 = 1 << 33;
/// The oldest version of the operators that is read: later ones broadcast as they do today.
const MIN_OPSET: i64 = 7;
/// The newest one: what later ones change is not known.
const MAX_OPSET: i64 = 28;

impl Network {
    /// Reads a network for frames of a size, or without one for frames of its own.
    ///
    /// # Errors
    /// When the file cannot be read, is not a valid ONNX model, or has an operator that is not supported; without a size when its own is open.
    pub fn read(path: &Path, frames: impl Into<Option<FrameSize>>) -> Result<Self, NetworkError> {
        let not_onnx = |problem: &str| NetworkError::NotOnnx {
            path: path.to_owned(),
            problem: problem.to_owned(),
        };
        if !path.metadata().map_err(NetworkError::io(path))?.is_file() {
            return Err(not_onnx("it is not a file"));
        }
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(NetworkError::io(path))?;
        file.take(MAX_FILE + 1).read_to_end(&mut bytes).map_err(NetworkError::io(path))?;
        if bytes.len() as u64 > MAX_FILE {
            return Err(not_onnx("it is larger than 2 GiB"));
        }
        Self::parse(&bytes, path, frames)
    }

    /// As [`Network::read`], with what the file `path` holds. Data outside of the file is looked for in its folder.
    ///
    /// # Errors
    /// As [`Network::read`].
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        frames: impl Into<Option<FrameSize>>,
    ) -> Result<Self, NetworkError> {
        let not_onnx = |problem| NetworkError::NotOnnx { path: path.to_owned(), problem };
        let memory = memory::of_model(bytes);
        if memory > MAX_MEMORY {
            return Err(NetworkError::Network(format!(
                "it may take {} MiB of memory to read; at most {} are supported",
                memory >> 20,
                MAX_MEMORY >> 20
            )));
        }
        let model = ModelProto::decode(bytes).map_err(|error| not_onnx(error.to_string()))?;
        let graph = model.graph.as_ref().ok_or_else(|| not_onnx("it has no graph".to_owned()))?;
        let own = model.opset_import.iter().find(|set| names::is_standard(set.domain.as_deref()));
        let opset = own.and_then(|set| set.version).unwrap_or(MAX_OPSET);
        if !(MIN_OPSET..=MAX_OPSET).contains(&opset) {
            return Err(NetworkError::Network(format!(
                "it uses version {opset} of the ONNX operators; versions {MIN_OPSET} to {MAX_OPSET} are supported"
            )));
        }
        graph::read(graph, &Folder::of(path), frames.into(), opset)
    }
}
