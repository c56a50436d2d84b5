// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of an ordinary event camera over a clip, as records in the layout of tonic.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use foveate_camera::Decimal;
use foveate_design::DesignConfig;
use foveate_media::{InputOptions, RunMonitor};
use foveate_simulator::{PixelCamera, PixelEventOptions};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use super::clip_run::{ClipInputs, problem_text, warn_of_problem};
use crate::config;
use crate::error::{raise, value_error};
use crate::options::input_options;
use crate::work::{CancelFlag, interruptible};

/// The names of the options, besides those of inputs.
pub(crate) const OWN: [&str; 2] = ["contrast", "log"];

/// The contrast of a pixel camera.
pub(crate) struct Contrast(Decimal);

impl<'py> FromPyObject<'_, 'py> for Contrast {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let wrong = format!(
            "contrast = {}: expected a number with at most nine digits after the point, for example 15",
            value.repr()?
        );
        match value.extract::<f64>() {
            Ok(contrast) if !value.is_instance_of::<PyBool>() => {
                let contrast = Decimal::from_f64(contrast);
                contrast.map(Self).ok_or_else(|| PyValueError::new_err(wrong))
            }
            _ => Err(PyTypeError::new_err(wrong)),
        }
    }
}

/// Returns the bytes of all records, to which Python gives their type.
#[pyfunction]
#[pyo3(signature = (inputs, camera, contrast, log, **options))]
pub(crate) fn pixel_event_records<'py>(
    py: Python<'py>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    contrast: Option<Contrast>,
    log: bool,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyArray1<u8>>> {
    let options = input_options("pixel_events", &OWN, options)?;
    let config = config::read(camera, None)?;
    let contrast = contrast.map(|Contrast(contrast)| contrast);
    let kind = PixelEventOptions { contrast, is_logarithmic: log, ..PixelEventOptions::default() };
    let inputs = ClipInputs::of("pixel_events", inputs, config.camera.frame.pixel_bits)?;
    inputs.warn_of_skipped(py, &options)?;
    let (records, problem) =
        interruptible(py, |cancel| records_of_clip(inputs, &config, kind, &options, cancel))??;
    warn_of_problem(py, problem)?;
    Ok(records.into_pyarray(py))
}

/// Shows a clip to a pixel camera. Returns all records, and the error that ended the footage before its end.
fn records_of_clip(
    inputs: ClipInputs,
    config: &DesignConfig,
    kind: PixelEventOptions,
    options: &InputOptions,
    cancel: Arc<AtomicBool>,
) -> PyResult<(Vec<u8>, Option<String>)> {
    let mut player = inputs.open_clip("pixel_events", &config.camera, options)?;
    let (width, height) = player.size();
    let design = config.validate_for_frames(width, height).map_err(raise)?;
    let mut camera = PixelCamera::new(&design, kind).map_err(raise)?;
    let mut records = Vec::new();
    let hooks = CancelFlag(cancel);
    let monitor = RunMonitor::of_frames(&hooks, player.frames());
    for frame in monitor.watch(&mut player) {
        let frame = frame.map_err(raise)?;
        let pixels = frame.frame.to_frame().map_err(value_error)?;
        camera.step(&pixels, |event| event.append_record(frame.time_us, &mut records));
    }
    Ok((records, problem_text(&player)))
}
