// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks that are read for arrays, with one array for each input.

use super::constant::Constant;
use super::graph::{InputSource, ProblemPolicy};
use super::model_folder::ModelFolder;
use super::node::{GraphValue, element_type};
use super::{OpenFile, decode_model, read_file, read_model_graph};
use crate::error::NetworkError;
use crate::executor::Executor;
use crate::network::Network;
use crate::onnx::TensorProto;
use std::path::Path;

pub(crate) struct ArrayNetwork {
    pub(crate) network: Network,
    /// The values of the network's input.
    pub(crate) input_values: Vec<f32>,
    outputs: Vec<ArrayOutput>,
}

struct ArrayOutput {
    name: String,
    /// The declared type, if the model declares one.
    data_type: Option<i32>,
    value: GraphValue,
}

/// Reads a network for arrays, one for each of its inputs.
pub(crate) fn read_for_arrays(
    path: &Path,
    open: OpenFile,
    arrays: &[TensorProto],
) -> Result<ArrayNetwork, NetworkError> {
    let model = decode_model(&read_file(path, open)?, path)?;
    let (folder, source) = (ModelFolder::of_model(path, open), InputSource::Arrays(arrays));
    let read = read_model_graph(&model, (path, &folder), &source, ProblemPolicy::Stop)?;
    let declared = model.graph.iter().flat_map(|graph| &graph.output);
    let outputs = read.outputs.into_iter().zip(declared).map(|((name, known), declared)| {
        let kind = element_type(declared);
        ArrayOutput { name, data_type: kind, value: known }
    });
    let outputs = outputs.collect();
    Ok(ArrayNetwork { network: read.network, input_values: read.input_values, outputs })
}

impl ArrayNetwork {
    /// Returns the outputs. Those that are not constant are taken from an executor, which has
    /// computed them.
    pub(crate) fn outputs(
        &self,
        executor: &Executor<'_>,
    ) -> Result<Vec<(String, TensorProto)>, NetworkError> {
        self.outputs
            .iter()
            .map(|output| Ok((output.name.clone(), output.tensor(executor)?)))
            .collect()
    }
}

impl ArrayOutput {
    fn tensor(&self, executor: &Executor<'_>) -> Result<TensorProto, NetworkError> {
        let computed;
        let constant = match &self.value {
            &GraphValue::Tensor(value) => {
                computed = Constant::from_tensor(executor.tensor(value));
                &computed
            }
            GraphValue::Constant(constant) => constant,
        };
        let tensor = constant.encode(self.data_type.unwrap_or(constant.data_type));
        tensor.map_err(|problem| {
            NetworkError::InvalidNetwork(format!("its output `{}`: {problem}", self.name))
        })
    }
}
