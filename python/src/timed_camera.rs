// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera that takes frames one by one, and returns when its hardware decides, sends and
//! loses regions. Times of frames that are given one by one. They never decrease. The table of
//! clocks, as `clocks.npy` has it. The clocks of a whole clip.

use crate::camera_state::lock_camera;
use crate::config;
use crate::core_surroundings::{CoreSurroundings, clock_frequency, sink_of_rate, sink_of_stalls};
use crate::design::{Design, in_words};
use crate::error::raise;
use crate::frame::{Grey, Scratch, check_size, design_of_size, size_of};
use crate::inputs::ClipRequest;
use foveate_design::DesignConfig;
use foveate_media::FrameRate;
use foveate_timed::{ClockRow, SinkPattern, TimedClip};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard};

/// A camera that takes frames one by one, and returns the clocks at which its hardware decides, sends and loses regions.
///
/// Parameters
/// ----------
/// config : str, path, dict, Design or Camera, optional
///     The name of a preset (`foveate.presets()`), a TOML file, a dict of its tables, or an object with a
///     configuration. The default is the paper's design.
/// clock_hz : float, optional
///     Clock of the core in Hz, a whole number up to 10^12. Each frame comes at its time, or as soon as the core is ready
///     after that. Without a clock each frame follows the one before without a pause. With `1e6`, times in microseconds
///     are clocks.
/// sink_rate : (int, int), optional
///     The sink takes this many words in this many clocks, such as `(1, 4)`. By default it takes a word at every clock.
///     Only a raster core waits for its sink.
/// sink_stalls : array of int, shape (stalls, 2), optional
///     Stalls of the sink, in place of a rate: the first clock at which it takes no word, and the number of these clocks.
///     They are in order and do not overlap.
/// frame, region, denoise, decision, temporal, render, periphery, zones, hardware : dict, optional
///     Keys to change, as in the file: `hardware={"organization": "raster"}`.
/// spatial : str, dict or list of these, optional
///     The features: `"mad"`, `{"feature": "edge", "level": 50}`, or a list.
///
/// Attributes
/// ----------
/// design : Design
///     The design. If the configuration gives no frame size, it has the size of the first frame.
/// frames : int
///     Number of frames since the camera was made or reset.
///
/// Notes
/// -----
/// The rows are those of `foveate simulate --clocks`. Those of one event are in the order of their clocks. A row is
/// returned as soon as nothing that follows can change it: by the step of its frame, by a later one, or by `finish`. So the
/// memory of the camera does not grow with the number of frames. A camera belongs to one thread at a time.
///
/// Raises
/// ------
/// ValueError
///     If the design, the clock, the rate or a stall is not valid. The message names the value, and a right one.
/// TypeError
///     If a value has another type, or if both a rate and stalls are given.
/// FileNotFoundError
///     If a file does not exist.
///
/// Examples
/// --------
/// >>> camera = TimedCamera("raster", clock_hz=100e6, sink_rate=(1, 4))
/// >>> rows = numpy.concatenate([*(camera.step(frame) for frame in clip), camera.finish()])
/// >>> rows["clock"][rows["event"] == "decision"]
#[pyclass(frozen, module = "foveate")]
pub(crate) struct TimedCamera {
    config: DesignConfig,
    surroundings: CoreSurroundings,
    state: Mutex<TimedState>,
}

/// The state of a camera. That after a reset is the default.
#[derive(Default)]
struct TimedState {
    /// The core for frames of the size of the first frame.
    core: Option<SizedCore>,
    /// Number of frames since the camera was made or reset.
    frames: u64,
    /// Times of the frames.
    clock: StepClock,
    scratch: Scratch,
}

/// A core, and the design that it has.
struct SizedCore {
    design: foveate_design::Design,
    clip: TimedClip,
}

#[pymethods]
impl TimedCamera {
    #[new]
    #[pyo3(
        signature = (config=None, /, *, clock_hz=None, sink_rate=None, sink_stalls=None, **sections),
        text_signature = "(config=None, /, *, clock_hz=None, sink_rate=None, sink_stalls=None, frame=None, region=None, \
                          denoise=None, spatial=None, decision=None, temporal=None, render=None, periphery=None, zones=None, hardware=None)"
    )]
    fn new(
        config: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = clock_frequency)] clock_hz: Option<u64>,
        #[pyo3(from_py_with = sink_of_rate)] sink_rate: Option<SinkPattern>,
        #[pyo3(from_py_with = sink_of_stalls)] sink_stalls: Option<SinkPattern>,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let surroundings = CoreSurroundings::from_options(clock_hz, sink_rate, sink_stalls)?;
        let config = config::read(config, sections)?;
        config.validate().map_err(raise)?;
        Ok(Self { config, surroundings, state: Mutex::default() })
    }

    /// The design. After the first frame it has the size of the frames.
    #[getter]
    fn design(&self) -> PyResult<Design> {
        let state = self.lock_state()?;
        match &state.core {
            Some(core) if state.frames > 0 => Ok(core.design.clone().into()),
            _ => Design::new(self.config.clone()),
        }
    }

    /// Number of frames since the camera was made or reset.
    #[getter]
    fn frames(&self) -> PyResult<u64> {
        Ok(self.lock_state()?.frames)
    }

    /// Take the next frame.
    ///
    /// Parameters
    /// ----------
    /// frame : array of shape (height, width)
    ///     Grey pixels, as `Camera.step` takes them.
    /// time_us : int, optional
    ///     Time of the frame in microseconds; not before that of the frame before. It needs `clock_hz`. The default
    ///     continues at 30 frames per second from the last given time.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Rows that are certain now, a structured array: `event` ("decision"; "pixels" or "means", words that leave at evenly
    ///     spaced clocks; "loss", a region that waited too long), `frame` (int64), `region` (int32, row by row),
    ///     `clock` and `last_clock` (int64, of the first and the last word of the row, or of the event), `first_word`
    ///     (int32, number of the first word in its region), `words` (int32, number of words of the row, 0 for other
    ///     events), `is_last` (bool, the region's last word is among them) and `is_aborted` (bool, no other word follows,
    ///     because the region was lost).
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the frame has another shape than the first one, or a pixel that does not fit into the design's bits, or if
    ///     `time_us` is before the time of the last frame.
    /// TypeError
    ///     If the frame is no array, or has another dtype or masked pixels, or if `time_us` is given without a clock.
    /// RuntimeError
    ///     If another thread is using the camera.
    #[pyo3(signature = (frame, /, *, time_us=None))]
    fn step<'py>(
        &self,
        frame: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = microseconds)] time_us: Option<u64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = frame.py();
        let grey = Grey::of(frame, self.config.camera.frame.pixel_bits)?;
        if let (Some(time_us), None) = (time_us, self.surroundings.clock_hz) {
            return Err(PyTypeError::new_err(format!(
                "time_us = {time_us}: a core without a clock takes its frames without a pause; give the camera a clock, \
                 clock_hz=100e6"
            )));
        }
        let mut guard = self.lock_state()?;
        let state = &mut *guard;
        let number = state.frames;
        let time_us = state.clock.next(number, time_us)?;
        self.fit(state, &grey)?;
        let TimedState { core, scratch, .. } = &mut *state;
        let clip = &mut core.as_mut().expect("it fits the frame").clip;
        let pixels = grey.packed(scratch);
        let mut rows = ClockTable::default();
        py.detach(|| clip.step(pixels, time_us, &mut |row| rows.push(row))).map_err(raise)?;
        state.clock.take(number, time_us);
        state.frames += 1;
        drop(guard);
        rows.into_python(py)
    }

    /// Return the rows that still come if no other frame follows, and forget every frame, as `reset` does.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Rows as those of `step`.
    fn finish<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let state = std::mem::take(&mut *self.lock_state()?);
        let mut rows = ClockTable::default();
        if let Some(SizedCore { clip, .. }) = state.core {
            py.detach(|| clip.finish(&mut |row| rows.push(row)).for_each(drop));
        }
        rows.into_python(py)
    }

    /// Forget every frame, and drop the rows that were not returned. The next frame is a first frame, and may have another
    /// size. Its clocks start at 0.
    fn reset(&self) -> PyResult<()> {
        *self.lock_state()? = TimedState::default();
        Ok(())
    }

    fn __repr__(&self) -> PyResult<String> {
        let design = in_words(self.design()?.inner());
        Ok(format!("<foveate.TimedCamera {design}, {} frames seen>", self.frames()?))
    }

    /// Shows the camera in a notebook.
    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("foveate._show")?.call_method1("design_card", (self.design()?,))
    }
}

impl TimedCamera {
    fn lock_state(&self) -> PyResult<MutexGuard<'_, TimedState>> {
        lock_camera(&self.state, "TimedCamera")
    }

    /// Makes the core for a first frame, or refuses a frame of another size or depth.
    fn fit(&self, state: &mut TimedState, frame: &Grey<'_>) -> PyResult<()> {
        if let (Some(SizedCore { design, .. }), 1..) = (&state.core, state.frames) {
            check_size(frame.size(), size_of(design))?;
        } else {
            let design = design_of_size(&self.config, frame.size())?;
            let clip = self.surroundings.clip(&design);
            state.core = Some(SizedCore { design, clip });
        }
        frame.check(self.config.camera.frame.pixel_bits)
    }
}

/// Returns a time as Python passes it.
pub(crate) fn microseconds(value: &Bound<'_, PyAny>) -> PyResult<Option<u64>> {
    if value.is_none() {
        return Ok(None);
    }
    let wrong = format!(
        "time_us = {}: expected a whole number of microseconds, 0 to {}",
        value.repr()?,
        u64::MAX
    );
    match value.extract() {
        Ok(time) => Ok(Some(time)),
        Err(_) if value.hasattr("__index__")? => Err(PyOverflowError::new_err(wrong)),
        Err(_) => Err(PyTypeError::new_err(wrong)),
    }
}

/// The last frame with a given time, and the time of the last frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepClock {
    given: (u64, u64),
    last: u64,
}

impl StepClock {
    /// Returns the time of the next frame: the given time, if it is not before that of the last frame.
    pub(crate) fn next(&self, number: u64, time_us: Option<u64>) -> PyResult<u64> {
        let (since, from) = self.given;
        let Some(time_us) = time_us else {
            return Ok(from.saturating_add(FrameRate::default().time_us(number - since)));
        };
        if time_us < self.last {
            return Err(PyValueError::new_err(format!(
                "time_us = {time_us} is before the time of the frame before, {}; times never go back, so give the frames in \
                 their order, or call reset() before another clip",
                self.last
            )));
        }
        Ok(time_us)
    }

    /// Returns the time of the first frame of a clip that follows `number` frames, one period of
    /// `rate` after the last of them.
    pub(crate) fn continuation(&self, number: u64, rate: FrameRate) -> u64 {
        match number.checked_sub(1) {
            None => 0,
            // Periods are rounded, so a clip in two runs has the times of one run.
            Some(last) if self.last == rate.time_us(last) => rate.time_us(number),
            Some(_) => self.last.saturating_add(rate.time_us(1)),
        }
    }

    /// Records a frame that was taken. A given time becomes the start from which later times are counted.
    pub(crate) fn take(&mut self, number: u64, time_us: u64) {
        let (since, from) = self.given;
        if time_us != from.saturating_add(FrameRate::default().time_us(number - since)) {
            self.given = (number, time_us);
        }
        self.last = time_us;
    }
}

/// The numbers of the columns, row by row.
#[derive(Default)]
pub(crate) struct ClockTable(Vec<i64>);

impl ClockTable {
    pub(crate) fn push(&mut self, row: &ClockRow) {
        self.0.extend(row.numbers().map(u64::cast_signed));
    }

    /// Returns the table as a structured array.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        const COLUMNS: usize = ClockRow::COLUMNS.len();
        let size = [self.0.len() / COLUMNS, COLUMNS];
        let numbers = self.0.into_pyarray(py).reshape(size)?;
        py.import("foveate._tables")?.call_method1("clock_rows", (numbers,))
    }
}

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
    #[pyo3(from_py_with = clock_frequency)] clock_hz: Option<u64>,
    #[pyo3(from_py_with = sink_of_rate)] sink_rate: Option<SinkPattern>,
    #[pyo3(from_py_with = sink_of_stalls)] sink_stalls: Option<SinkPattern>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let surroundings = CoreSurroundings::from_options(clock_hz, sink_rate, sink_stalls)?;
    let own = ("clocks", &CoreSurroundings::OPTIONS[..]);
    let request = ClipRequest::new(own, inputs, camera, options)?;
    let (clip, mut rows) = request.show_to(
        py,
        |design| Ok((surroundings.clip(design), ClockTable::default())),
        |(clip, rows), frame| {
            let pixels = frame.frame.borrowed_pixels();
            clip.step(pixels, frame.time_us, &mut |row| rows.push(row)).map_err(raise).map(drop)
        },
    )?;
    py.detach(|| clip.finish(&mut |row| rows.push(row)).for_each(drop));
    rows.into_python(py)
}
