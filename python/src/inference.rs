// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks behind the camera.

use std::num::NonZeroU32;
use std::path::PathBuf;

use foveate_inference::{
    Computation, Inference, InferenceOptions, NOISE_LEVELS, PixelMapping, RecordOptions,
    VisionOptions, parse_detector, parse_framing, parse_goal, parse_mode, parse_noise,
    read_accelerator,
};
use pyo3::exceptions::{PyIsADirectoryError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::commands::json;
use crate::error::{raise, value_error};
use crate::inputs::{ClipInputs, ClipRequest, paths, warn_of_problem};
use crate::work::{CancelFlag, interruptible};

/// Returns the choices of a run by their names on the command line. They are removed from `options`, which keeps the options
/// of inputs.
fn chosen(
    options: &Bound<'_, PyDict>,
) -> PyResult<(InferenceOptions, VisionOptions, Vec<PathBuf>)> {
    let text = |name: &str| -> PyResult<Option<String>> {
        Ok(take(options, name)?.map(|value| value.str()).transpose()?.map(|text| text.to_string()))
    };
    let (mode, goal) = (text("mode")?, text("tune")?);
    if mode.is_some() && goal.is_some() {
        return Err(PyTypeError::new_err(
            "give mode or tune, not both: tune chooses limits itself",
        ));
    }
    let mode = mode.unwrap_or_else(|| "exact".to_owned());
    let approximate = mode.starts_with("truncate") || mode == "fixed";
    let computation = match goal {
        Some(goal) => Computation::Tuned(parsed("tune", &goal, parse_goal)?),
        None => Computation::Mode(parsed("mode", &mode, parse_mode)?),
    };
    let accelerator = text("accelerator")?;
    let accelerator = accelerator.as_deref().map(read_accelerator).transpose().map_err(raise)?;
    let flag = |name: &str| -> PyResult<bool> {
        take(options, name)?.map_or(Ok(false), |value| value.extract())
    };
    let values = |name: &'static str, default: f32| -> PyResult<Vec<f32>> {
        let Some(value) = take(options, name)? else { return Ok(vec![default]) };
        value.extract::<f32>().map(|one| vec![one]).or_else(|_| {
            value.extract().map_err(|_| {
                PyTypeError::new_err(format!(
                    "{name} = {value}: expected a number, or one for each channel"
                ))
            })
        })
    };
    let mapping = PixelMapping { mean: values("mean", 0.0)?, scale: values("scale", 1.0)? };
    if let Some(wrong) = mapping.scale.iter().find(|&&value| !(value > 0.0 && value.is_finite())) {
        return Err(PyValueError::new_err(format!("scale = {wrong}: expected numbers above 0")));
    }
    if let Some(wrong) = mapping.mean.iter().find(|value| !value.is_finite()) {
        return Err(PyValueError::new_err(format!("mean = {wrong}: expected finite numbers")));
    }
    let framing = text("framing")?.map(|text| parsed("framing", &text, parse_framing));
    let detector = text("detect")?.map(|text| parsed("detect", &text, parse_detector));
    let (framing, detector) = (framing.transpose()?.unwrap_or_default(), detector.transpose()?);
    let boxes = take(options, "boxes")?.map_or(Ok(Vec::new()), |boxes| paths(&boxes))?;
    if !boxes.is_empty() && detector.is_none() {
        return Err(PyTypeError::new_err(
            "boxes are compared with detections: give detect, too, such as detect=\"yolox\"",
        ));
    }
    let noise = text("noise")?.map(|text| parsed("noise", &text, parse_noise)).transpose()?;
    let whole =
        |text: &str| text.parse().map_err(|_| "expected a whole number of at least 1".into());
    let every = text("every")?.map_or(Ok(NonZeroU32::MIN), |text| parsed("every", &text, whole))?;
    let options = InferenceOptions {
        computation,
        accelerator,
        with_whole_computation: flag("reference")? || approximate,
        record: RecordOptions { arrays: true, pictures: flag("pictures")? },
        command: Vec::new(),
        with_whole_frames: flag("whole_frames")? || detector.is_some() || noise.is_some(),
        noise: noise.unwrap_or_else(|| NOISE_LEVELS.to_vec()),
        frame_interval: every,
        overwrite: flag("force")?,
    };
    Ok((options, VisionOptions { framing, mapping, detector }, boxes))
}

/// Returns the names of all options that [`chosen`] takes, and of the arguments.
const OWN: [&str; 18] = [
    "network",
    "inputs",
    "camera",
    "output",
    "mode",
    "tune",
    "reference",
    "accelerator",
    "mean",
    "scale",
    "pictures",
    "force",
    "framing",
    "whole_frames",
    "noise",
    "every",
    "detect",
    "boxes",
];

/// Returns the meaning of an option.
fn parsed<T>(name: &str, text: &str, parse: impl FnOnce(&str) -> Result<T, String>) -> PyResult<T> {
    parse(text).map_err(|problem| value_error(format!("{name} = {text:?}: {problem}")))
}

/// Removes an option, and returns its value if it was given.
fn take<'py>(options: &Bound<'py, PyDict>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(value) = options.get_item(name)? else { return Ok(None) };
    options.del_item(name)?;
    Ok(Some(value).filter(|value| !value.is_none()))
}

/// Runs a network on the output of a camera, and writes a folder. Returns the summary as JSON.
#[pyfunction]
#[pyo3(signature = (network, inputs, camera, output, **options))]
pub(crate) fn infer(
    py: Python<'_>,
    network: PathBuf,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    output: PathBuf,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<String> {
    if network.is_dir() {
        let message = format!("cannot read the network `{}`: it is a folder", network.display());
        return Err(PyIsADirectoryError::new_err(message));
    }
    let options = options.map_or_else(|| Ok(PyDict::new(py)), |options| options.copy())?;
    let (chosen, vision_options, boxes) = chosen(&options)?;
    let mut request = ClipRequest::new(("infer", &OWN), inputs, camera, Some(&options))?;
    let summary = interruptible(py, |cancel| {
        let inference = match &request.inputs {
            // Several clips are several inputs of a network.
            ClipInputs::Paths(inputs) => {
                let inputs = (&inputs[..], &boxes[..]);
                Inference::new(&request.config, &network, vision_options, inputs, &request.options)
            }
            ClipInputs::Frames(_) => {
                let inputs = (request.open()?, &boxes[..]);
                Inference::from_player(&request.config, &network, vision_options, inputs)
            }
        };
        let inference = inference.map_err(raise)?;
        inference.run(&output, &chosen, &CancelFlag(cancel)).map_err(raise)
    })??;
    warn_of_problem(py, None)?;
    json(&summary)
}
