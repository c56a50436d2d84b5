// SPDX-License-Identifier: MIT OR Apache-2.0
//! The compiled part of the Python package `foveate`: the camera, its footage, its hardware and its networks.
//!
//! No result is computed here. Every function converts Python's values, calls the crate that does the work without holding
//! the interpreter, and converts the result. Parts that need no Rust, such as tables of pandas, are in the Python files of
//! the package.

mod array;
mod camera;
mod camera_state;
mod clip_run;
mod config;
mod core_surroundings;
mod decoding;
mod design;
mod error;
mod footage;
mod frame;
mod inference;
mod options;
mod outcome;
mod pixel_events;
mod registers;
mod study;
mod table;
mod timed_camera;
mod tools;
mod work;

use pyo3::prelude::*;

/// The compiled part of `foveate`.
#[pymodule]
mod _foveate {
    use std::ffi::OsString;

    use pyo3::prelude::*;

    #[pymodule_export]
    use super::array::{decisions_png, grey_png};
    #[pymodule_export]
    use super::timed_camera::clocks;
    #[pymodule_export]
    use crate::camera::Camera;
    #[pymodule_export]
    use crate::clip_run::run_clip;
    #[pymodule_export]
    use crate::decoding::{DecodedFrame, Decoding, decode};
    #[pymodule_export]
    use crate::design::{Design, presets};
    #[pymodule_export]
    use crate::error::ToolError;
    #[pymodule_export]
    use crate::footage::{Run, luma, simulate};
    #[pymodule_export]
    use crate::inference::infer;
    #[pymodule_export]
    use crate::options::refuse_option;
    #[pymodule_export]
    use crate::outcome::Outcome;
    #[pymodule_export]
    use crate::pixel_events::pixel_event_records;
    #[pymodule_export]
    use crate::study::{explain, fidelity};
    #[pymodule_export]
    use crate::table::event_columns;
    #[pymodule_export]
    use crate::timed_camera::TimedCamera;
    #[pymodule_export]
    use crate::tools::{estimate, generate};

    /// Run the command `foveate` with these words, the first of which is its name. Return its exit code.
    #[pyfunction]
    fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
        py.detach(|| foveate_cli::run(words))
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
