// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera that takes frames one by one.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use foveate_design::{DesignConfig, RegionClass};
use foveate_engine::{Engine, EngineOptions, MAX_THREADS};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::clock::{MicroSeconds, StepClock};
use crate::config;
use crate::design::{Design, in_words};
use crate::error::raise;
use crate::frame::{Grey, rows};
use crate::outcome::{FrameRecord, Outcome, Screen};
use crate::registers::registers_of;
use crate::tools;

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
///     zones (`zones={}` gives it zones). Assign an array of this shape to change it. A reset keeps it; a first frame of
///     another size starts with the areas of the configuration.
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
#[derive(Clone, Copy)]
struct Threads(usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let right = format!("expected 1 to {MAX_THREADS}, or 0, which takes one per processor");
        let wrong = format!("threads = {}: {right}", value.repr()?);
        match value.extract() {
            Ok(threads @ ..=MAX_THREADS) => Ok(Self(threads)),
            _ if value.hasattr("__index__")? => Err(PyValueError::new_err(wrong)),
            _ => Err(PyTypeError::new_err(wrong)),
        }
    }
}

/// The engine for frames of the size of the first frame.
struct SizedEngine {
    /// The design of the engine, which outcomes share.
    design: Arc<foveate_design::Design>,
    engine: Engine,
}

impl SizedEngine {
    fn new(design: foveate_design::Design, threads: usize) -> PyResult<Self> {
        let options = EngineOptions { threads, ..EngineOptions::default() };
        let engine = Engine::with_options(&design, options).map_err(raise)?;
        Ok(Self { design: Arc::new(design), engine })
    }
}

/// The message of a camera that has no size yet.
const NO_SIZE: &str = "this camera has no size yet: it takes that of its first frame, so show it one, or give the size, \
                       frame={\"width\": 640, \"height\": 480}";

/// The state of a camera.
struct CameraState {
    /// The engine, which is kept after a reset for frames of the same size.
    sized_engine: Option<SizedEngine>,
    /// Number of frames since the camera was made or reset.
    frames: u64,
    /// Number of frames in all, which says to which outcome the screen belongs.
    steps: u64,
    /// Times of the frames.
    clock: StepClock,
    /// The process to which the threads belong.
    process: u32,
    bytes: Vec<u8>,
    words: Vec<u16>,
}

impl Camera {
    /// Makes a camera that has seen no frame.
    fn of(config: DesignConfig, threads: usize) -> Self {
        let state = CameraState {
            sized_engine: None,
            frames: 0,
            steps: 0,
            clock: StepClock::default(),
            process: std::process::id(),
            bytes: Vec::new(),
            words: Vec::new(),
        };
        Self { config, threads, state: Mutex::new(state) }
    }

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

    fn lock_state(&self) -> PyResult<MutexGuard<'_, CameraState>> {
        lock_camera(&self.state, "Camera")
    }

    /// Returns the screen after a step, if no later step has replaced it.
    pub(crate) fn screen(&self, py: Python<'_>, step: u64) -> PyResult<Screen> {
        let state = self.lock_state()?;
        match &state.sized_engine {
            Some(sized_engine) if state.steps == step => {
                Ok(Screen::of(py, &sized_engine.design, sized_engine.engine.rendered()))
            }
            _ => Err(PyRuntimeError::new_err(
                "this outcome's rendered frame is gone, because the camera has taken another frame or was reset; \
                 read outcome.rendered before the next step, or keep it with step(frame, keep=True)",
            )),
        }
    }
}

/// Locks the state of a camera of this class, for one thread at a time.
pub(crate) fn lock_camera<'a, T>(state: &'a Mutex<T>, class: &str) -> PyResult<MutexGuard<'a, T>> {
    match state.try_lock() {
        Ok(state) => Ok(state),
        Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(format!(
            "another thread is using this camera; give each thread a camera of its own, {class}(camera.design)"
        ))),
    }
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (config=None, /, *, threads=Threads(1), **sections), text_signature = "(config=None, /, *, threads=1, frame=None, region=None, denoise=None, spatial=None, decision=None, temporal=None, render=None, periphery=None, zones=None, hardware=None)")]
    fn new(
        config: Option<&Bound<'_, PyAny>>,
        threads: Threads,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let config = config::read(config, sections)?;
        config.validate().map_err(raise)?;
        Ok(Self::of(config, threads.0))
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
        let SizedEngine { design, engine } = state.engine_of(self)?;
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
        let SizedEngine { design, engine } = state.engine_of(self)?;
        let classes = classes_of(classes, (design.rows(), design.columns()))?;
        engine.set_classes(&classes).map_err(raise)
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
        time_us: Option<MicroSeconds>,
        keep: bool,
    ) -> PyResult<Outcome> {
        let (py, camera) = (slf.py(), slf.get());
        let grey = Grey::of(frame, camera.config.camera.frame.pixel_bits)?;
        let mut guard = camera.lock_state()?;
        let state = &mut *guard;
        let number = state.frames;
        let time_us = state.clock.next(number, time_us.map(|MicroSeconds(time)| time))?;
        state.fit(&camera.config, camera.threads, &grey)?;
        match &grey {
            Grey::Bytes(array) => {
                let view = array.as_array();
                py.detach(|| state.take_bytes(&view))
            }
            Grey::Words(array) => {
                let view = array.as_array();
                py.detach(|| state.take_words(&view))
            }
        }
        .map_err(raise)?;
        state.clock.take(number, time_us);
        let SizedEngine { design, engine } =
            state.sized_engine.as_ref().expect("it has taken a frame");
        let record = FrameRecord {
            design: Arc::clone(design),
            result: engine.outcome().clone(),
            number,
            time_us,
            name: None,
            label: None,
        };
        let screen = keep.then(|| Screen::of(py, design, engine.rendered()));
        let step = state.steps;
        drop(guard);
        Ok(Outcome::of_camera(py, record, slf.clone().unbind(), step, screen))
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
        tools::generate_of(slf, folder, force, prefix)
    }

    /// Estimate area and logic levels of the design; see `foveate.estimate`. A camera without a size must have seen a frame.
    fn estimate<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        tools::estimate_of(slf)
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
        let frames = camera.frames()?;
        if frames > 0 {
            return Err(PyTypeError::new_err(format!(
                "this camera has seen {frames} frames, which a copy would not have; copy camera.design, or reset the \
                 camera first"
            )));
        }
        let arguments = (camera.config.to_toml(), camera.threads).into_pyobject(slf.py())?;
        Ok((slf.get_type().getattr("_from_toml")?, arguments))
    }

    #[staticmethod]
    fn _from_toml(text: &str, threads: Threads) -> PyResult<Self> {
        let config = DesignConfig::from_toml(text).map_err(raise)?;
        Ok(Self::of(config, threads.0))
    }
}

/// Returns the classes of an array of codes, row by row.
fn classes_of(codes: &Bound<'_, PyAny>, (rows, columns): (u32, u32)) -> PyResult<Vec<RegionClass>> {
    let numpy = codes.py().import("numpy")?;
    let codes = numpy.call_method1("asarray", (codes,))?;
    let expected = format!(
        "zones takes an array of shape ({rows}, {columns}) of whole numbers: 0 normal, 1 off, 2 keen, 3 always"
    );
    let kind: String = codes.getattr("dtype")?.getattr("kind")?.extract()?;
    if !matches!(kind.as_str(), "u" | "i") {
        let given = codes.getattr("dtype")?;
        return Err(PyTypeError::new_err(format!("{expected}; not of {given}")));
    }
    let shape: Vec<usize> = codes.getattr("shape")?.extract()?;
    if shape != [rows as usize, columns as usize] {
        let given = codes.getattr("shape")?;
        return Err(PyValueError::new_err(format!("{expected}; not of shape {given}")));
    }
    let codes: Vec<i128> = codes.call_method0("ravel")?.call_method0("tolist")?.extract()?;
    let class = |code: i128| {
        let class = u8::try_from(code).ok().and_then(RegionClass::from_code);
        class.ok_or_else(|| PyValueError::new_err(format!("{expected}; {code} is no class")))
    };
    codes.into_iter().map(class).collect()
}

impl CameraState {
    /// Returns the engine of a camera, and makes it first if the configuration has the size of frames.
    fn engine_of(&mut self, camera: &Camera) -> PyResult<&mut SizedEngine> {
        if self.sized_engine.is_none() {
            let frame = &camera.config.camera.frame;
            if frame.width.is_none() || frame.height.is_none() {
                return Err(PyValueError::new_err(NO_SIZE));
            }
            let design = camera.config.validate().map_err(raise)?;
            self.sized_engine = Some(SizedEngine::new(design, camera.threads)?);
            self.process = std::process::id();
        }
        Ok(self.sized_engine.as_mut().expect("it has just been made"))
    }

    /// Prepares the camera for a frame, or refuses the frame.
    fn fit(&mut self, config: &DesignConfig, threads: usize, frame: &Grey<'_>) -> PyResult<()> {
        let own_size = self
            .sized_engine
            .as_ref()
            .map(|own| (own.design.width() as usize, own.design.height() as usize));
        if self.frames > 0 {
            if threads != 1 && self.process != std::process::id() {
                return Err(PyRuntimeError::new_err(
                    "this camera has threads, which do not exist after a fork; make the camera in the new process",
                ));
            }
            frame.check_size(own_size.expect("it has seen a frame"))?;
        } else if own_size != Some(frame.size()) || self.process != std::process::id() {
            self.sized_engine = Some(SizedEngine::new(frame.design(config)?, threads)?);
            self.process = std::process::id();
        }
        frame.check(config.camera.frame.pixel_bits)
    }

    fn take_bytes(
        &mut self,
        view: &numpy::ndarray::ArrayView2<'_, u8>,
    ) -> Result<(), foveate_engine::EngineError> {
        let Self { sized_engine, bytes, .. } = self;
        let (pixels, stride) = rows(view, bytes);
        sized_engine.as_mut().expect("made ready").engine.step_u8(pixels, stride)?;
        self.count();
        Ok(())
    }

    fn take_words(
        &mut self,
        view: &numpy::ndarray::ArrayView2<'_, u16>,
    ) -> Result<(), foveate_engine::EngineError> {
        let Self { sized_engine, words, .. } = self;
        let (pixels, stride) = rows(view, words);
        sized_engine.as_mut().expect("made ready").engine.step_u16(pixels, stride)?;
        self.count();
        Ok(())
    }

    fn count(&mut self) {
        self.frames += 1;
        self.steps += 1;
    }
}
