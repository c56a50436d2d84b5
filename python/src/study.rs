// SPDX-License-Identifier: MIT OR Apache-2.0
//! Questions about a design over footage: why a region was sent, and how far the design is from the ideal camera.

use foveate_explore::compare;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::clip_run::{ClipInputs, warn_of_problem};
use crate::config;
use crate::error::{raise, value_error};
use crate::options::input_options;
use crate::work::{CancelFlag, at_once, interruptible};

pub(crate) fn json(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(value_error)
}

/// Explains why a region was sent or dropped, as JSON and as text.
#[pyfunction]
#[pyo3(signature = (inputs, camera=None, *, frame, region, **options))]
pub(crate) fn explain(
    py: Python<'_>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    frame: u64,
    region: (u32, u32),
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<(String, String)> {
    let options = input_options("explain", &[], options)?;
    let config = config::read(camera, None)?;
    let inputs = ClipInputs::of("explain", inputs, config.camera.frame.pixel_bits)?;
    inputs.warn_of_skipped(py, &options)?;
    let explanation = at_once(py, move || {
        let player = inputs.open(&config.camera, &options)?;
        foveate_simulator::explain_region(&config, player, frame, region).map_err(raise)
    })??;
    warn_of_problem(py, None)?;
    Ok((json(&explanation)?, explanation.to_string()))
}

/// Measures the errors of a design against the ideal camera. Returns them as JSON, and the error that ended the footage early.
#[pyfunction]
#[pyo3(signature = (inputs, camera=None, *, ideal=None, **options))]
pub(crate) fn fidelity(
    py: Python<'_>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    ideal: Option<&Bound<'_, PyAny>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<(String, Option<String>)> {
    let options = input_options("fidelity", &["ideal"], options)?;
    let config = config::read(camera, None)?;
    let ideal =
        ideal.map_or_else(|| Ok(config.clone()), |ideal| config::read(Some(ideal), None))?;
    // The ideal camera takes the frames as they are; the design takes them with its own depth.
    let inputs = ClipInputs::of("fidelity", inputs, ideal.camera.frame.pixel_bits)?;
    inputs.warn_of_skipped(py, &options)?;
    let compared = interruptible(py, |cancel| {
        let player = inputs.open(&ideal.camera, &options)?;
        compare(player, &config.camera, &ideal.camera, &CancelFlag(cancel)).map_err(raise)
    })??;
    warn_of_problem(py, None)?;
    Ok((json(&compared.figures)?, compared.problem))
}
