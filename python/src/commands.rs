// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functions of `_work.py`, for the commands other than `simulate`: why a region was sent, how
//! far a design is from the ideal camera, the events of an ordinary event camera, and the hardware
//! of a design. Results are JSON and text.

use std::path::PathBuf;

use foveate_camera::Decimal;
use foveate_cosim::write_core;
use foveate_emit::{Prefix, Top};
use foveate_estimate::EstimateJob;
use foveate_explore::compare;
use foveate_simulator::{PixelCamera, PixelEventOptions};
use foveate_tools::{Cache, Toolchain};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use crate::camera::Camera;
use crate::config;
use crate::error::{raise, value_error};
use crate::inputs::{ClipRequest, warn, warn_of_problem};
use crate::work::{CancelFlag, at_once, at_once_with, interruptible};

/// Returns a result as the JSON of the command line.
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
    let own = ("explain", &["frame", "region"][..]);
    let mut request = ClipRequest::new(own, inputs, camera, options)?;
    let explanation = at_once(py, move || {
        let player = request.open()?;
        foveate_simulator::explain_region(&request.config, player, frame, region).map_err(raise)
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
    // The ideal camera takes the frames as they are; the design takes them with its own depth.
    let own = ("fidelity", &["ideal"][..]);
    let mut request = ClipRequest::new(own, inputs, ideal.or(camera), options)?;
    let config = config::read(camera, None)?;
    let compared = interruptible(py, |cancel| {
        let (player, ideal) = (request.open()?, &request.config.camera);
        compare(player, &config.camera, ideal, &CancelFlag(cancel)).map_err(raise)
    })??;
    warn_of_problem(py, None)?;
    Ok((json(&compared.figures)?, compared.problem))
}

/// Returns the bytes of the records of all events, to which Python gives their type.
#[pyfunction]
#[pyo3(signature = (inputs, camera, contrast, log, **options))]
pub(crate) fn pixel_event_records<'py>(
    py: Python<'py>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = decimal_contrast)] contrast: Option<Decimal>,
    log: bool,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyArray1<u8>>> {
    let own = ("pixel_events", &["contrast", "log"][..]);
    let request = ClipRequest::new(own, inputs, camera, options)?;
    let kind = PixelEventOptions { contrast, is_logarithmic: log, ..PixelEventOptions::default() };
    let (_, records) = request.show_to(
        py,
        |design| Ok((PixelCamera::new(design, kind).map_err(raise)?, Vec::new())),
        |(camera, records), frame| {
            let pixels = frame.frame.to_frame().map_err(value_error)?;
            camera.step(&pixels, |event| event.append_record(frame.time_us, records));
            Ok(())
        },
    )?;
    Ok(records.into_pyarray(py))
}

/// Returns the contrast of a pixel camera.
fn decimal_contrast(value: &Bound<'_, PyAny>) -> PyResult<Option<Decimal>> {
    if value.is_none() {
        return Ok(None);
    }
    let wrong = format!(
        "contrast = {}: expected a number with at most nine digits after the point, for example 15",
        value.repr()?
    );
    match value.extract::<f64>() {
        Ok(contrast) if !value.is_instance_of::<PyBool>() => {
            let contrast = Decimal::from_f64(contrast);
            contrast.map(Some).ok_or_else(|| PyValueError::new_err(wrong))
        }
        _ => Err(PyTypeError::new_err(wrong)),
    }
}

/// Number of columns of a text report.
const WIDTH: usize = 100;

/// Returns the design of a camera or a configuration.
fn design(camera: &Bound<'_, PyAny>) -> PyResult<foveate_design::Design> {
    if let Ok(camera) = camera.cast::<Camera>() {
        return Ok(camera.get().sized()?.inner().clone());
    }
    config::read(Some(camera), None)?.validate().map_err(raise)
}

/// Writes the core of a design. Returns its files.
#[pyfunction]
#[pyo3(signature = (camera, folder, force, prefix=None))]
pub(crate) fn generate(
    py: Python<'_>,
    camera: &Bound<'_, PyAny>,
    folder: PathBuf,
    force: bool,
    prefix: Option<&str>,
) -> PyResult<Vec<String>> {
    let design = design(camera)?;
    let prefix = Prefix::from_request(prefix, &design).map_err(value_error)?;
    let core = interruptible(py, |cancel| write_core(&design, &prefix, &folder, force, &cancel))?;
    let core = core.map_err(raise)?;
    core.warnings().into_iter().try_for_each(|warning| warn(py, warning, 2))?;
    Ok(core.files)
}

/// Measures area and logic levels with Yosys. Returns them as JSON and as text.
#[pyfunction]
pub(crate) fn estimate(py: Python<'_>, camera: &Bound<'_, PyAny>) -> PyResult<(String, String)> {
    let design = design(camera)?;
    let report = at_once_with(py, move |cancel| {
        let toolchain = Toolchain::system().with_cancel_flag(cancel);
        let job = EstimateJob::for_design(&design, Top::Rcm).with_leaves(&design);
        let cache = Cache::from_env().map_err(raise)?;
        foveate_estimate::estimate(&toolchain, &cache, &job).map_err(raise)
    })??;
    Ok((json(&report)?, report.tables().text(WIDTH)))
}

/// Calls `foveate.generate` for a method of a camera or a design.
pub(crate) fn generate_of<'py>(
    camera: &Bound<'py, PyAny>,
    folder: &Bound<'py, PyAny>,
    force: bool,
    prefix: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let options = PyDict::new(camera.py());
    options.set_item("force", force)?;
    options.set_item("prefix", prefix)?;
    let work = camera.py().import("foveate._work")?;
    work.call_method("generate", (camera, folder), Some(&options))
}

/// Calls `foveate.estimate` for a method of a camera or a design.
pub(crate) fn estimate_of<'py>(camera: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    camera.py().import("foveate._work")?.call_method1("estimate", (camera,))
}
