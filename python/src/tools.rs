// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hardware of a design: its core and its area.

use std::path::PathBuf;

use foveate_cosim::write_core;
use foveate_emit::{Prefix, Top};
use foveate_estimate::EstimateJob;
use foveate_tools::{Cache, Toolchain};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::camera::Camera;
use crate::config;
use crate::error::{raise, value_error};
use crate::study::json;
use crate::work::{at_once_with, interruptible};

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
    for warning in core.warnings() {
        let text = std::ffi::CString::new(warning).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 2)?;
    }
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
