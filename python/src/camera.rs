// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera that takes frames one by one.

use std::sync::{Arc, Mutex, MutexGuard};

use foveate_design::DesignConfig;
use foveate_engine::MAX_THREADS;
use foveate_simulator::SentValues;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::array::screen;
use super::outcome::{FrameRecord, classes_of};
use super::timed_camera::{StepClock, microseconds};
use crate::camera_state::{CameraState, NO_SIZE, PickledMap, SizedEngine, lock_camera};
use crate::design::{Design, in_words, registers_of};
use crate::error::raise;
use crate::frame::Grey;
use crate::outcome::{KeptParts, Outcome};
use crate::{commands, config};

/// A camera that takes frames one by one.
///
/// Parameters
/// ----------
/// config : str, path, dict, Design or Camera, optional
///     The name of a preset (`foveate.presets()`), a TOML file, a dict of its tables, or an object with a
///     configuration. The default is the paper's design.
/// threads : int, default 1
///     Number of threads of a step, up to 256; 0 takes one per processor. Results do not depend on it.
/// frame, region, denoise, decision, temporal, render, periphery, zones, hardware : dict, optional
///     Keys to change, as in the file: `region={"size": 16}`.
/// spatial : str, dict or list of these, optional
///     The features: `"mad"`, `{"feature": "edge", "level": 50}`, or a list.
///
/// Attributes
/// ----------
/// design : Design
///     The design. If the configuration gives no frame size, it has the size of the first frame.
/// frames : int
///     Number of frames since the camera was made or reset.
/// zones : array of shape (rows, columns), uint8, or None
///     The class of each region from the next frame on: 0 normal, 1 off, 2 keen, 3 always; None if the design has no
///     zones (`zones={}` gives it zones). Assign an array of this shape to change it; an assignment to a part of the array
///     changes nothing. A reset and a copy keep it; a first frame of another size starts with the classes of the configuration.
///     Before the first frame of a camera whose configuration has no size, it raises a ValueError.
///
/// Notes
/// -----
/// A camera belongs to one thread at a time: another thread that calls it meanwhile gets a RuntimeError. `step` does not
/// hold the interpreter, so cameras of several threads run in parallel. A camera can be pickled before its first frame;
/// later, pickle `camera.design`. After a fork, a camera with one thread continues in both processes.
///
/// Raises
/// ------
/// ValueError
///     If the design is not valid, or `threads` is out of range. The message names the key, its value, and a right
///     value.
/// FileNotFoundError
///     If a file does not exist.
///
/// Examples
/// --------
/// >>> camera = Camera("paper", region={"size": 16}, temporal={"reference": "last-sent"})
/// >>> outcome = camera.step(numpy.zeros((480, 640), "uint8"))
#[pyclass(frozen, module = "foveate")]
pub(crate) struct Camera {
    config: DesignConfig,
    threads: usize,
    state: Mutex<CameraState>,
}

/// Returns the number of threads of a step; 0 means one per processor.
fn thread_number(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    let right = format!("expected 1 to {MAX_THREADS}, or 0, which takes one per processor");
    let wrong = format!("threads = {}: {right}", value.repr()?);
    match value.extract() {
        Ok(threads @ ..=MAX_THREADS) => Ok(threads),
        _ if value.hasattr("__index__")? => Err(PyValueError::new_err(wrong)),
        _ => Err(PyTypeError::new_err(wrong)),
    }
}

impl Camera {
    pub(crate) fn config(&self) -> &DesignConfig {
        &self.config
    }

    /// Returns the design for hardware, which has the size of the frames.
    pub(crate) fn sized(&self) -> PyResult<Design> {
        let frame = &self.config.camera.frame;
        if self.frames()? == 0 && (frame.width.is_none() || frame.height.is_none()) {
            return Err(PyValueError::new_err(NO_SIZE));
        }
        self.design()
    }

    pub(crate) fn lock_state(&self) -> PyResult<MutexGuard<'_, CameraState>> {
        lock_camera(&self.state, "Camera")
    }

    /// Returns the screen after a step, if no later step has replaced it.
    pub(crate) fn screen(&self, py: Python<'_>, step: u64) -> PyResult<Py<PyAny>> {
        let state = self.lock_state()?;
        let own = state.engine_after(step, "rendered frame is", "rendered")?;
        screen(py, &own.design, own.engine.rendered())
    }

    /// Returns the values that were sent in a step, if no later step has replaced them.
    pub(crate) fn sent_values(&self, step: u64) -> PyResult<SentValues> {
        let state = self.lock_state()?;
        Ok(state.engine_after(step, "pixels are", "packets()")?.sent_values())
    }

    /// Prepares the state for a frame of this size, or refuses the frame.
    pub(crate) fn fit(&self, state: &mut CameraState, size: (usize, usize)) -> PyResult<()> {
        state.fit(&self.config, self.threads, size)
    }
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (config=None, /, *, threads=1, **sections), text_signature = "(config=None, /, *, threads=1, frame=None, region=None, denoise=None, spatial=None, decision=None, temporal=None, render=None, periphery=None, zones=None, hardware=None)")]
    fn new(
        config: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = thread_number)] threads: usize,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let config = config::read(config, sections)?;
        config.validate().map_err(raise)?;
        Ok(Self { config, threads, state: Mutex::default() })
    }

    /// The design. After the first frame it has the size of the frames.
    #[getter]
    fn design(&self) -> PyResult<Design> {
        let state = self.lock_state()?;
        match &state.sized_engine {
            Some(sized_engine) if state.frames > 0 => {
                Ok(foveate_design::Design::clone(&sized_engine.design).into())
            }
            _ => Design::new(self.config.clone()),
        }
    }

    /// Number of frames since the camera was made or reset.
    #[getter]
    fn frames(&self) -> PyResult<u64> {
        Ok(self.lock_state()?.frames)
    }

    /// The class of each region, as an array of shape (rows, columns); None if the design has no zones.
    #[getter]
    fn zones<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<u8>>>> {
        if self.config.camera.zones.is_none() {
            return Ok(None);
        }
        let mut state = self.lock_state()?;
        let SizedEngine { design, engine, .. } = state.engine_of(&self.config, self.threads)?;
        let codes = engine.classes().iter().map(|class| class.code()).collect();
        let shape = (design.rows() as usize, design.columns() as usize);
        let codes = Array2::from_shape_vec(shape, codes).expect("a class for each region");
        Ok(Some(codes.into_pyarray(py)))
    }

    /// Set the class of each region from the next frame on.
    #[setter]
    fn set_zones(&self, classes: &Bound<'_, PyAny>) -> PyResult<()> {
        if self.config.camera.zones.is_none() {
            return Err(PyValueError::new_err(
                "this design has no zones; make the camera with zones={}",
            ));
        }
        let mut state = self.lock_state()?;
        let sized_engine = state.engine_of(&self.config, self.threads)?;
        let size = (sized_engine.design.rows(), sized_engine.design.columns());
        sized_engine.set_classes(&classes_of(classes, size)?).map_err(raise)
    }

    /// Forget every frame. The next one is a first frame, and may have another size.
    fn reset(&self) -> PyResult<()> {
        let mut state = self.lock_state()?;
        state.frames = 0;
        state.steps += 1;
        state.clock = StepClock::default();
        if let Some(sized_engine) = &mut state.sized_engine {
            sized_engine.engine.reset();
        }
        Ok(())
    }

    /// Take the next frame.
    ///
    /// Parameters
    /// ----------
    /// frame : array of shape (height, width)
    ///     Grey pixels: uint8, or uint16 for designs of more than 8 bits per pixel, with values of the design's
    ///     bits. Any strides are allowed; the array is not copied if the pixels of a row are adjacent. A value that is no array
    ///     is converted by `numpy.asarray`, or by `numpy.from_dlpack` if it is in the memory of the processor.
    /// time_us : int, optional
    ///     Time of the frame in microseconds, for tables; not before that of the frame before. The default continues at 30
    ///     frames per second from the last given time.
    /// keep : bool, default False
    ///     Copy the rendered frame at once. Without it, read `outcome.rendered` before the next step.
    ///
    /// Returns
    /// -------
    /// Outcome
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the frame has another shape than the first one, or a pixel that does not fit into the design's bits, or if
    ///     `time_us` is before the time of the last frame.
    /// TypeError
    ///     If the frame is no array, or has another dtype or masked pixels. The message says how to convert it.
    /// RuntimeError
    ///     If another thread is using the camera.
    #[pyo3(signature = (frame, /, *, time_us=None, keep=false))]
    fn step(
        slf: &Bound<'_, Self>,
        frame: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = microseconds)] time_us: Option<u64>,
        keep: bool,
    ) -> PyResult<Outcome> {
        let (py, camera) = (slf.py(), slf.get());
        let grey = Grey::of(frame, camera.config.camera.frame.pixel_bits)?;
        let mut guard = camera.lock_state()?;
        let state = &mut *guard;
        let number = state.frames;
        let time_us = state.clock.next(number, time_us)?;
        // A frame of a wrong type is refused before it can change the size of the camera.
        grey.check(camera.config.camera.frame.pixel_bits)?;
        camera.fit(state, grey.size())?;
        state.take_array(py, &grey)?;
        state.clock.take(number, time_us);
        let sized_engine = state.sized_engine.as_ref().expect("it has taken a frame");
        let record = FrameRecord {
            design: Arc::clone(&sized_engine.design),
            result: sized_engine.engine.outcome().clone(),
            number,
            time_us,
            is_first: number == 0,
            name: None,
            label: None,
            classes: sized_engine.classes(),
        };
        let kept = keep.then(|| -> PyResult<_> {
            let screen = screen(py, &sized_engine.design, sized_engine.engine.rendered())?;
            Ok(KeptParts { screen, values: sized_engine.sent_values() })
        });
        let step = state.steps;
        drop(guard);
        let camera = Some((slf.clone().unbind(), step));
        Ok(Outcome::new(py, record, None, camera, kept.transpose()?))
    }

    /// Take the next frames, all of a clip, and stack the outcomes.
    ///
    /// Parameters
    /// ----------
    /// inputs : path, pattern, "scene:NAME", a list of these, or frames
    ///     Inputs as of `foveate.simulate`, of one clip. Frames are an array of shape (frames, height, width), or a list of
    ///     arrays (height, width); a copy of them is kept until the end.
    /// rendered : bool, default True
    ///     Keep the frames on the receiver's screen, which need most of the memory: as many bytes as the clip has pixels (twice
    ///     as many above 8 bits). Everything else needs 12 bytes per region and frame, 8 more for each feature, and 2 more
    ///     for the displacements of `flow`.
    /// progress : bool, optional
    ///     Show a line of progress on standard error. The default shows it on a terminal and in a notebook.
    /// max_frames, input_fps, rate, start, end, crop, resize, luma, orientation, video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
    ///     How inputs are read, see `foveate.simulate`. Frames from arrays have the times of `rate` (30 frames per second).
    ///
    /// Returns
    /// -------
    /// ClipOutcome
    ///     The outcomes of all frames as arrays whose first axis is the frame.
    ///
    /// Notes
    /// -----
    /// The camera continues from its state, as with `step`, and keeps its state afterwards: two runs over two halves of a clip
    /// give the outcomes of one run over the whole clip. Times of a later run continue from the last frame. Call `reset` first
    /// for a clip of its own. Ctrl-C ends the run after the frame at hand; the camera has then taken the frames so far, whose
    /// outcomes are dropped. The same is true if a frame cannot be read.
    ///
    /// Raises
    /// ------
    /// FileNotFoundError, ValueError
    ///     If an input cannot be read, is a set of unrelated images, has another size than frames before, or does not fit the
    ///     configuration.
    /// TypeError
    ///     If an option does not exist or has another type, or if `inputs` are neither footage nor frames.
    /// ToolError
    ///     If ffmpeg is needed and missing.
    /// RuntimeError
    ///     If another thread is using the camera.
    ///
    /// Examples
    /// --------
    /// >>> found = Camera("paper").run(clip, rendered=False)
    /// >>> found.active.mean(axis=(1, 2)), found.sent_bytes
    #[pyo3(
        signature = (inputs, *, rendered=true, progress=None, **options),
        text_signature = "($self, inputs, *, rendered=True, progress=None, max_frames=None, input_fps=None, rate=None, start=None, end=None, \
                          crop=None, resize=None, luma=None, orientation=None, video_stream=None, raw=None, bayer=None, \
                      timestamps=None, timestamp_unit=None, images=None, labels=None)"
    )]
    fn run<'py>(
        slf: &Bound<'py, Self>,
        inputs: &Bound<'py, PyAny>,
        rendered: bool,
        progress: Option<bool>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let options = options.map_or_else(|| Ok(PyDict::new(slf.py())), |own| own.copy())?;
        let arguments = (slf, inputs, rendered, progress, options);
        slf.py().import("foveate._clip")?.call_method1("run_camera", arguments)
    }

    fn __repr__(&self) -> PyResult<String> {
        let design = in_words(self.design()?.inner());
        Ok(format!("<foveate.Camera {design}, {} frames seen>", self.frames()?))
    }

    /// Shows the camera in a notebook.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("foveate._show")?.call_method1("design_card", (slf.get().design()?,))
    }

    /// Write the Verilog of the design to a folder; see `foveate.generate`. A camera without a size must have seen a frame.
    #[pyo3(signature = (folder, *, force=false, prefix=None))]
    fn generate<'py>(
        slf: &Bound<'py, Self>,
        folder: &Bound<'py, PyAny>,
        force: bool,
        prefix: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        commands::generate_of(slf, folder, force, prefix)
    }

    /// Estimate area and logic levels of the design; see `foveate.estimate`. A camera without a size must have seen a frame.
    fn estimate<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        commands::estimate_of(slf)
    }

    /// List the registers of a core of this design on AXI.
    ///
    /// Returns
    /// -------
    /// tuple of Register
    ///     By address: `name`, `address` in bytes, `doc`, and `fields`, each with `name`, `low` (its lowest bit), `width`,
    ///     `access` ("read", "read, write", "write 1" or "read, write 1 to clear"), `reset` (its value after a reset; None if
    ///     it depends on the state of the core) and `doc`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the design is not on AXI (it needs `hardware={"interface": "axi"}`), or if the camera has no size yet.
    fn registers<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        registers_of(slf.py(), &slf.get().sized()?)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let camera = slf.get();
        let (frames, map) = {
            let state = camera.lock_state()?;
            (state.frames, state.pickled_map())
        };
        if frames > 0 {
            return Err(PyTypeError::new_err(format!(
                "this camera has seen {frames} frames, which a copy would not have; copy camera.design, or reset the \
                 camera first"
            )));
        }
        let arguments = (camera.config.to_toml(), camera.threads, map).into_pyobject(slf.py())?;
        Ok((slf.get_type().getattr("_from_toml")?, arguments))
    }

    #[staticmethod]
    #[pyo3(signature = (text, threads, map=None))]
    fn _from_toml(
        text: &str,
        #[pyo3(from_py_with = thread_number)] threads: usize,
        map: Option<PickledMap>,
    ) -> PyResult<Self> {
        let config = DesignConfig::from_toml(text).map_err(raise)?;
        let state = map.map(|map| CameraState::with_map(&config, threads, map)).transpose()?;
        Ok(Self { config, threads, state: Mutex::new(state.unwrap_or_default()) })
    }
}
