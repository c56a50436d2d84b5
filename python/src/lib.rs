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
mod commands;
mod config;
mod core_surroundings;
mod decoding;
mod design;
mod error;
mod footage;
mod frame;
mod inference;
mod inputs;
mod outcome;
mod table;
mod timed_camera;
mod work;

use pyo3::prelude::*;

/// The compiled part of `foveate`.
#[pymodule]
mod _foveate {
    use std::ffi::OsString;

    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::{
        array::{decisions_png, grey_png},
        camera::Camera,
        clip_run::run_clip,
        commands::{estimate, explain, fidelity, generate, pixel_event_records},
        decoding::{DecodedFrame, Decoding, decode},
        design::{Design, presets},
        error::ToolError,
        footage::{Run, luma, simulate},
        inference::infer,
        outcome::Outcome,
        table::event_columns,
        timed_camera::{TimedCamera, clocks},
    };

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
