// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network once on arrays, without a camera, so that its outputs can be compared with those
//! of other programs.

use super::optional_instant::OptionalInstant;
use crate::error::NetworkError;
use crate::executor::{ExecutionMode, Executor};
use crate::mask::Mask;
use crate::onnx::TensorProto;
use crate::reader::{OpenFile, read_for_arrays};
use std::path::Path;
use std::time::Duration;

/// The outputs of a network for some arrays, with the cost of computing them.
#[derive(Debug)]
pub struct NetworkEvaluation {
    /// The outputs in the order of the model, each with its name.
    pub outputs: Vec<(String, TensorProto)>,
    /// The number of multiply-accumulate operations.
    pub macs: u64,
    /// The bytes of all weights.
    pub weight_bytes: u64,
    /// The time of the computation, without the time of reading the file.
    pub time: Duration,
}

/// Runs the network of a file on one array for each of its inputs, in the order of the inputs. The
/// values of an array are in `raw_data`, in little-endian order. Outputs have the types that the
/// model declares. Values of 16 and 64 bits are computed with 32 bits.
///
/// # Errors
/// Fails if the network cannot be read, or if an array has another type or shape than its input.
pub fn evaluate(
    path: &Path,
    open: OpenFile,
    arrays: &[TensorProto],
) -> Result<NetworkEvaluation, NetworkError> {
    let read = read_for_arrays(path, open, arrays)?;
    let network = &read.network;
    let mut executor = Executor::new(network, ExecutionMode::Dense);
    let start = OptionalInstant::now();
    let whole = Mask::full(network.input().height(), network.input().width());
    executor.step(&read.input_values, &whole);
    let time = start.elapsed();
    let outputs = read.outputs(&executor)?;
    let (macs, weight_bytes) = (network.total_macs(), network.weight_bytes());
    Ok(NetworkEvaluation { outputs, macs, weight_bytes, time })
}
