// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks of a whole clip.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use foveate_design::DesignConfig;
use foveate_media::{InputOptions, RunMonitor};
use foveate_timed::TimedClip;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::clip_inputs::{ClipInputs, problem_text, warn_of_problem};
use crate::clock_table::ClockTable;
use crate::config;
use crate::core_surroundings::{ClockFrequency, CoreSurroundings, SinkRate, SinkStalls};
use crate::error::raise;
use crate::options::input_options;
use crate::work::{CancelFlag, interruptible};

/// Make the table of the clocks at which the hardware of a design decides, sends and loses the regions of a clip.
///
/// Parameters
/// ----------
/// inputs : path, pattern, "scene:NAME", a list of these, or frames
///     Inputs of the command line, or frames that you have as arrays: an array of shape (frames, height, width), or a list of
///     arrays (height, width). They are one clip.
/// camera : Camera, Design, preset, file or dict, optional
///     The camera. The run makes its own camera of this design, which has seen no frame; the state of `camera` is
///     neither used nor changed.
/// clock_hz, sink_rate, sink_stalls : optional
///     The clock of the core and the sink of its words, see `TimedCamera`.
/// max_frames, input_fps, rate, start, end, crop, resize, luma, orientation, video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
///     How inputs are read, see `simulate`. Frames from arrays have the times of `rate` (30 frames per second).
///
/// Returns
/// -------
/// numpy.ndarray
///     All rows, a structured array as `TimedCamera.step` returns it. The table of a long clip is large:
///     `TimedCamera` returns its rows frame by frame.
///
/// Raises
/// ------
/// FileNotFoundError, ValueError
///     If an input cannot be read, is a set of unrelated images, or does not fit the configuration, or if a rate or a
///     stall is not valid.
/// TypeError
///     If an option does not exist or has another type, or if `inputs` are neither footage nor frames.
/// ToolError
///     If ffmpeg is needed and missing.
///
/// Examples
/// --------
/// >>> rows = clocks("scene:street", "raster", clock_hz=100e6, sink_rate=(1, 4), max_frames=8)
/// >>> numpy.count_nonzero(rows["event"] == "loss")
#[pyfunction]
#[pyo3(
    signature = (inputs, camera=None, *, clock_hz=None, sink_rate=None, sink_stalls=None, **options),
    text_signature = "(inputs, camera=None, *, clock_hz=None, sink_rate=None, sink_stalls=None, max_frames=None, input_fps=None, \
                      rate=None, start=None, end=None, crop=None, resize=None, luma=None, orientation=None, video_stream=None, raw=None, bayer=None, \
                      timestamps=None, timestamp_unit=None, images=None, labels=None)"
)]
#[allow(clippy::too_many_arguments, reason = "they are the arguments of the function in Python")]
pub(crate) fn clocks<'py>(
    py: Python<'py>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    clock_hz: Option<ClockFrequency>,
    sink_rate: Option<SinkRate>,
    sink_stalls: Option<SinkStalls>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let surroundings = CoreSurroundings::from_options(clock_hz, sink_rate, sink_stalls)?;
    let options = input_options("clocks", &CoreSurroundings::OPTIONS, options)?;
    let config = config::read(camera, None)?;
    let inputs = ClipInputs::of("clocks", inputs, config.camera.frame.pixel_bits)?;
    inputs.warn_of_skipped(py, &options)?;
    let (rows, problem) = interruptible(py, |cancel| {
        rows_of_clip(inputs, &config, &surroundings, &options, cancel)
    })??;
    warn_of_problem(py, problem)?;
    rows.into_python(py)
}

/// Shows a clip to a core. Returns all rows, and the error that ended the footage before its end.
fn rows_of_clip(
    inputs: ClipInputs,
    config: &DesignConfig,
    surroundings: &CoreSurroundings,
    options: &InputOptions,
    cancel: Arc<AtomicBool>,
) -> PyResult<(ClockTable, Option<String>)> {
    let mut player = inputs.open_clip("clocks", &config.camera, options)?;
    let (width, height) = player.size();
    let design = config.validate_for_frames(width, height).map_err(raise)?;
    let mut clip = TimedClip::new(&design, surroundings.clock_hz, &surroundings.sink);
    let mut rows = ClockTable::default();
    let hooks = CancelFlag(cancel);
    let monitor = RunMonitor::of_frames(&hooks, player.frames());
    for frame in monitor.watch(&mut player) {
        let frame = frame.map_err(raise)?;
        let pixels = frame.frame.borrowed_pixels();
        clip.step(pixels, frame.time_us, &mut |row| rows.push(row)).map_err(raise)?;
    }
    clip.finish(&mut |row| rows.push(row)).for_each(drop);
    Ok((rows, problem_text(&player)))
}
