// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks behind the camera.

use std::num::NonZeroU32;
use std::path::PathBuf;

use foveate_inference::{
    Computation, Inference, InferenceOptions, NOISE_LEVELS, PixelMapping, RecordOptions,
    VisionOptions, parse_detector, parse_framing, parse_goal, parse_mode, parse_noise,
    read_accelerator,
};
use foveate_media::{PlaybackError, source_from_memory};
use pyo3::exceptions::{PyIsADirectoryError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::clip_run::{ARRAY_NAME, ClipInputs, paths, warn_of_problem};
use crate::config;
use crate::error::raise;
use crate::options::input_options;
use crate::study::json;
use crate::work::{CancelFlag, interruptible};

/// Returns the choices of a run by their names on the command line. They are removed from `options`, which keeps the options
/// of inputs.
fn chosen(
    options: &Bound<'_, PyDict>,
) -> PyResult<(InferenceOptions, VisionOptions, Vec<PathBuf>)> {
    let text = |name: &str| -> PyResult<Option<String>> {
        let value = take(options, name)?;
        Ok(value.map(|value| value.str()).transpose()?.map(|text| text.to_string()))
    };
    let wrong = |name: &'static str, value: String| {
        move |problem: String| PyValueError::new_err(format!("{name} = {value:?}: {problem}"))
    };
    let (mode, goal) = (text("mode")?, text("tune")?);
    if mode.is_some() && goal.is_some() {
        return Err(PyTypeError::new_err(
            "give mode or tune, not both: tune chooses limits itself",
        ));
    }
    let mode = mode.unwrap_or_else(|| "exact".to_owned());
    let approximate = mode.starts_with("truncate") || mode == "fixed";
    let computed = match goal {
        Some(goal) => Computation::Tuned(parse_goal(&goal).map_err(wrong("tune", goal))?),
        None => Computation::Mode(parse_mode(&mode).map_err(wrong("mode", mode))?),
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
    let framing = text("framing")?.unwrap_or_else(|| "same".to_owned());
    let framing = parse_framing(&framing).map_err(wrong("framing", framing))?;
    let detect = text("detect")?;
    let detector = detect.map(|text| parse_detector(&text).map_err(wrong("detect", text)));
    let detector = detector.transpose()?;
    let boxes = take(options, "boxes")?.map_or(Ok(Vec::new()), |boxes| paths(&boxes))?;
    if !boxes.is_empty() && detector.is_none() {
        return Err(PyTypeError::new_err(
            "boxes are compared with detections: give detect, too, such as detect=\"yolox\"",
        ));
    }
    let noise = text("noise")?.map(|text| parse_noise(&text).map_err(wrong("noise", text)));
    let noise = noise.transpose()?;
    let every = text("every")?.map_or(Ok(NonZeroU32::MIN), |text| {
        let problem = "expected a whole number of at least 1".to_owned();
        text.parse().map_err(|_| wrong("every", text)(problem))
    })?;
    let options = InferenceOptions {
        computation: computed,
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
pub(crate) const OWN: [&str; 18] = [
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
    let input = input_options("infer", &OWN, Some(&options))?;
    let config = config::read(camera, None)?;
    let clip = ClipInputs::of("infer", inputs, config.camera.frame.pixel_bits)?;
    clip.warn_of_skipped(py, &input)?;
    let summary = interruptible(py, |cancel| {
        let inference = match clip {
            ClipInputs::Paths(paths) => {
                Inference::new(&config, &network, vision_options, (&paths, &boxes), &input)
            }
            ClipInputs::Frames(frames) => source_from_memory(ARRAY_NAME, frames, &input)
                .map_err(|error| PlaybackError::from(error).into())
                .and_then(|source| {
                    Inference::from_player(&config, &network, vision_options, (source, &boxes))
                }),
        }
        .map_err(raise)?;
        inference.run(&output, &chosen, &CancelFlag(cancel)).map_err(raise)
    })??;
    warn_of_problem(py, None)?;
    json(&summary)
}
