// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network run once on arrays, without a camera, so that its outputs can be compared with those of other programs.

use crate::error::NetworkError;
use crate::executor::{Executor, Mode};
use crate::mask::Mask;
use crate::moment::Moment;
use crate::onnx::TensorProto;
use crate::read::read_for_arrays;
use std::path::Path;
use std::time::Duration;

/// The outputs of a network for some arrays.
#[derive(Debug)]
pub struct NetworkEvaluation {
    /// The outputs in the order of the model, each with its name.
    pub outputs: Vec<(String, TensorProto)>,
    /// Multiplications and additions.
    pub macs: u64,
    /// Bytes of all weights.
    pub weight_bytes: u64,
    /// Time of the computation, without that of reading.
    pub time: Duration,
}

/// Runs the network of a file on arrays, one for each of its inputs in their order, with values as bytes (`raw_data`), the lowest first.
/// Outputs have the type that the model says. Values of 16 and 64 bits are computed with 32.
///
/// # Errors
/// When the network cannot be read, or an array has another type or shape than its input.
pub fn evaluate(path: &Path, arrays: &[TensorProto]) -> Result<NetworkEvaluation, NetworkError> {
    let read = read_for_arrays(path, arrays)?;
    let network = &read.network;
    let mut executor = Executor::new(network, Mode::Dense);
    let start = Moment::now();
    let whole = Mask::full(network.input().height(), network.input().width());
    executor.step(&read.picture, &whole);
    let time = start.elapsed();
    let outputs = read.outputs(&executor)?;
    let (macs, weight_bytes) = (network.total_macs(), network.weight_bytes());
    Ok(NetworkEvaluation { outputs, macs, weight_bytes, time })
}
