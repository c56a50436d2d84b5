// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that runs on arrays from files in place of frames, so that it can be compared with
//! other programs without a camera.

use crate::InferenceError;
use crate::inference::INFERENCE_FOLDER;
use crate::recording::{OUTPUTS_FOLDER, free_name};
use foveate_network::{
    NetworkEvaluation, evaluate,
    onnx::{TensorProto, data_type},
};
use foveate_output::npy::{self, NpyArray};
use foveate_tools::{StagedFolder, StagingError, open_file};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The result of a network that ran on arrays.
#[derive(Clone, Debug, Serialize)]
pub struct ArraySummary {
    /// The network's file.
    pub network: PathBuf,
    /// The arrays of the inputs, in the order of the model.
    pub inputs: Vec<ArrayFile>,
    /// The arrays of the outputs, in the order of the model.
    pub outputs: Vec<ArrayFile>,
    /// The number of multiplications and additions.
    pub macs: u64,
    /// The size of all weights in bytes.
    pub weight_bytes: u64,
    /// The time of the computation in seconds, without the time of reading.
    pub seconds: f64,
}

/// An array and its file.
#[derive(Clone, Debug, Serialize)]
pub struct ArrayFile {
    /// The name of an output in the model; `None` for an input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The type of a value, with NumPy's name.
    pub dtype: &'static str,
    /// The length of every axis.
    pub shape: Vec<usize>,
    /// The path of the file; for an output, relative to the folder that is written.
    pub file: String,
}

/// The types that both arrays and ONNX tensors have: NumPy's code in a file, NumPy's name, and
/// ONNX's number.
const VALUE_TYPES: [(&str, &str, i32); 8] = [
    ("<f4", "float32", data_type::FLOAT),
    ("<f2", "float16", data_type::FLOAT16),
    ("<f8", "float64", data_type::DOUBLE),
    ("|u1", "uint8", data_type::UINT8),
    ("|i1", "int8", data_type::INT8),
    ("<i4", "int32", data_type::INT32),
    ("<i8", "int64", data_type::INT64),
    ("|b1", "bool", data_type::BOOL),
];

/// Returns whether a path names a NumPy array, by its extension.
#[must_use]
pub fn is_array(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("npy"))
}

/// Runs a network once on arrays, one for each of its inputs in their order, and writes its outputs
/// as arrays to the folder `output`, which appears when everything is written. Nothing is
/// subtracted or scaled. Floating-point outputs have 32 bits.
///
/// # Errors
/// Fails if an array or the network cannot be read, an array has another type or shape than its
/// input, or the folder cannot be written.
pub fn infer_arrays(
    network: &Path,
    arrays: &[PathBuf],
    output: &Path,
    overwrite: bool,
) -> Result<ArraySummary, InferenceError> {
    let staging = StagedFolder::new(output, INFERENCE_FOLDER, overwrite)?;
    let (mut tensors, mut inputs) = (Vec::new(), Vec::new());
    for path in arrays {
        let array = npy::read_array(path)?;
        let (_, dtype, kind) = type_of(path, &array)?;
        let file = path.display().to_string();
        inputs.push(ArrayFile { name: None, dtype, shape: array.shape.clone(), file });
        tensors.push(tensor(array, kind));
    }
    let NetworkEvaluation { outputs, macs, weight_bytes, time } =
        evaluate(network, open_file, &tensors)?;
    let outputs = write(&staging, outputs).map_err(|error| staging.with_shown_path(error))?;
    let seconds = time.as_secs_f64();
    let network = network.to_owned();
    let summary = ArraySummary { network, inputs, outputs, macs, weight_bytes, seconds };
    let text = serde_json::to_string_pretty(&summary).expect("a summary has names and numbers");
    staging.write("inference.json", (text + "\n").as_bytes())?;
    staging.commit()?;
    Ok(summary)
}

/// Returns the entry of `VALUE_TYPES` for an array.
fn type_of(
    path: &Path,
    array: &NpyArray,
) -> Result<(&'static str, &'static str, i32), InferenceError> {
    let known = VALUE_TYPES.into_iter().find(|(dtype, ..)| *dtype == array.dtype);
    known.ok_or_else(|| {
        let known: Vec<_> = VALUE_TYPES.iter().map(|(_, name, _)| *name).collect();
        InferenceError::InvalidOption {
            problem: format!(
                "the array `{}` holds values of type {}, which no network here takes; the types are {}",
                path.display(),
                array.dtype,
                known.join(", ")
            ),
        }
    })
}

fn tensor(array: NpyArray, kind: i32) -> TensorProto {
    TensorProto {
        dims: array.shape.iter().map(|&length| length.try_into().expect("below 2^31")).collect(),
        data_type: Some(kind),
        raw_data: Some(array.bytes),
        ..TensorProto::default()
    }
}

fn write(
    staging: &StagedFolder,
    outputs: Vec<(String, TensorProto)>,
) -> Result<Vec<ArrayFile>, StagingError> {
    let folder = staging.folder().join(OUTPUTS_FOLDER);
    std::fs::create_dir(&folder)
        .map_err(|source| StagingError::Unwritable { path: folder, source })?;
    let mut files: Vec<ArrayFile> = Vec::new();
    for (name, tensor) in outputs {
        let taken: Vec<_> = files.iter().map(|file| file.file.clone()).collect();
        let file = format!("{OUTPUTS_FOLDER}/{}.npy", free_name(&name, &taken));
        let kind = tensor.data_type.unwrap_or_default();
        let (descr, dtype, _) = VALUE_TYPES
            .into_iter()
            .find(|known| known.2 == kind)
            .expect("outputs are of known types");
        let lengths = tensor.dims.iter().map(|length| format!("{length}, ")).collect::<String>();
        let mut bytes = npy::npy_header(256, &format!("'{descr}'"), &lengths);
        bytes.extend(tensor.raw_data.unwrap_or_default());
        staging.write(&file, &bytes)?;
        let length = |&length: &i64| length.try_into().expect("a length of an output");
        let shape = tensor.dims.iter().map(length).collect();
        files.push(ArrayFile { name: Some(name), dtype, shape, file });
    }
    Ok(files)
}
