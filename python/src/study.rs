// SPDX-License-Identifier: MIT OR Apache-2.0
//! Questions about a design over footage: why a region was sent, and how far the design is from the ideal camera.

use foveate_explore::compare;
use foveate_playback::ClipPlayer;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::config;
use crate::error::{raise, value_error};
use crate::footage::{paths, warn_of_skipped};
use crate::options::input_options;
use crate::work::{CancelFlag, at_once, interruptible};

/// Returns a value as JSON, from which Python makes its own value.
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
    let (inputs, options) = (paths(inputs)?, input_options("explain", &[], options)?);
    warn_of_skipped(py, &inputs, &options)?;
    let config = config::read(camera, None)?;
    let explanation = at_once(py, move || {
        let player = ClipPlayer::open(&inputs, &config.camera, &options).map_err(raise)?;
        foveate_simulator::explain_region(&config, player, frame, region).map_err(raise)
    })??;
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
    let (inputs, options) = (paths(inputs)?, input_options("fidelity", &["ideal"], options)?);
    warn_of_skipped(py, &inputs, &options)?;
    let config = config::read(camera, None)?;
    let ideal =
        ideal.map_or_else(|| Ok(config.clone()), |ideal| config::read(Some(ideal), None))?;
    let compared = interruptible(py, |cancel| {
        compare(&inputs, &options, &config.camera, &ideal.camera, &CancelFlag(cancel))
    })?
    .map_err(raise)?;
    Ok((json(&compared.figures)?, compared.problem))
}
