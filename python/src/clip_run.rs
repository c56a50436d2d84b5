// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera that takes all frames of a clip, with the outcomes as arrays whose first axis is
//! the frame. Clips as Python passes them: footage by its name, or frames as arrays.

use super::array::{action_code, displacement_numbers, signed_score};
use crate::array::untyped;
use crate::camera::Camera;
use crate::camera_state::{CameraState, SizedEngine};
use crate::design::Design;
use crate::error::{raise, value_error};
use crate::frame::Grey;
use crate::options::input_options;
use crate::work::at_once;
use foveate_camera::CameraConfig;
use foveate_media::{
    ClipPlan, ClipPlayer, InputOptions, InputWarnings, PlayedFrame, ProgressStage, RunProgress,
    SourceKind, plan, skipped_in_words, source_from_memory,
};
use foveate_pixels::{ByteFrame, FramePixels};
use foveate_simulator::{PacketContent, PacketLayout, SentCounts, packet_bytes, packet_layout};
use numpy::{Element, IntoPyArray, PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The names of the options, besides those of inputs.
const OWN: [&str; 2] = ["rendered", "progress"];

/// Shows a clip to a camera. Returns the design, the arrays by name, and the error that ended the footage before its end.
/// `report` is called with the number of frames, that of all, and the frames per second, as far as they are known.
#[pyfunction]
#[pyo3(signature = (camera, inputs, rendered, report, **options))]
pub(crate) fn run_clip<'py>(
    py: Python<'py>,
    camera: &Bound<'py, Camera>,
    inputs: &Bound<'py, PyAny>,
    rendered: bool,
    report: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Design, Bound<'py, PyDict>, Option<String>)> {
    let camera = camera.get();
    let options = input_options("run", &OWN, options)?;
    let config = camera.config().clone();
    let inputs = ClipInputs::of("run", inputs, config.camera.frame.pixel_bits)?;
    inputs.warn_of_skipped(py, &options)?;
    let rate = options.frame_rate;
    let mut player = at_once(py, move || inputs.open_clip("run", &config.camera, &options))??;
    let (width, height) = player.size();
    let mut guard = camera.lock_state()?;
    let state = &mut *guard;
    camera.fit(state, (width as usize, height as usize))?;
    let own = state.sized_engine.as_ref().expect("it fits the clip");
    let design = Arc::clone(&own.design);
    let mut columns = ClipColumns::new(&design, rendered)?;
    let mut stage = ProgressStage::new(Instant::now());
    let start_us = state.clock.continuation(state.frames, rate);
    loop {
        py.check_signals()?;
        let taken = py.detach(|| take_next(&mut player, state, start_us, &mut columns))?;
        if !taken {
            break;
        }
        if let Some(report) = report {
            let (done, total) = (columns.number.len() as u64, player.frames());
            stage.enter(&RunProgress::frames(done, total, ""), Instant::now());
            report.call1((done, stage.amount.total, stage.rate(Instant::now())))?;
        }
    }
    drop(guard);
    let problem = problem_text(&player);
    warn_of_problem(py, problem.clone())?;
    let columns = columns.into_python(py, &design)?;
    Ok((foveate_design::Design::clone(&design).into(), columns, problem))
}

/// Shows the next frame of a clip to a camera, and adds its outcome. Returns false at the end of the clip. Frames of a
/// camera that has seen no other have the times of the clip; those of any other follow its last frame, at `start_us`.
fn take_next(
    player: &mut ClipPlayer,
    state: &mut CameraState,
    start_us: u64,
    columns: &mut ClipColumns,
) -> PyResult<bool> {
    let Some(frame) = player.next().transpose().map_err(raise)? else { return Ok(false) };
    let number = state.frames;
    let first_us = *columns.first_us.get_or_insert(if number == 0 { 0 } else { frame.time_us });
    let since_us = frame.time_us.saturating_sub(first_us);
    let time_us = state.clock.next(number, Some(start_us.saturating_add(since_us)))?;
    state.take_frame(&frame.frame).map_err(raise)?;
    state.clock.take(number, time_us);
    let own = state.sized_engine.as_ref().expect("it has taken a frame");
    columns.push(own, &frame, (number, time_us));
    Ok(true)
}

/// The arrays, frame by frame.
struct ClipColumns {
    layout: PacketLayout,
    /// True if screens are kept.
    has_screens: bool,
    /// The time in the clip that is the beginning of the run.
    first_us: Option<u64>,
    number: Vec<i64>,
    time_us: Vec<i64>,
    sent_pixels: Vec<i64>,
    sent_bytes: Vec<i64>,
    names: Vec<String>,
    srs: Vec<bool>,
    trs: Vec<bool>,
    active: Vec<bool>,
    action: Vec<u8>,
    changed: Vec<i64>,
    scores: Vec<Vec<i64>>,
    displacements: Vec<i8>,
    /// Screens of up to 8 bits per pixel, and those of more.
    bytes: Vec<u8>,
    words: Vec<u16>,
}

impl ClipColumns {
    fn new(design: &foveate_design::Design, has_screens: bool) -> PyResult<Self> {
        Ok(Self {
            layout: packet_layout(design, PacketContent::Plain).map_err(raise)?,
            has_screens,
            first_us: None,
            number: Vec::new(),
            time_us: Vec::new(),
            sent_pixels: Vec::new(),
            sent_bytes: Vec::new(),
            names: Vec::new(),
            srs: Vec::new(),
            trs: Vec::new(),
            active: Vec::new(),
            action: Vec::new(),
            changed: Vec::new(),
            scores: Vec::new(),
            displacements: Vec::new(),
            bytes: Vec::new(),
            words: Vec::new(),
        })
    }

    /// Adds the outcome of the last frame of an engine.
    fn push(&mut self, own: &SizedEngine, frame: &PlayedFrame, (number, time_us): (u64, u64)) {
        let result = own.engine.outcome();
        self.number.push(number.cast_signed());
        self.time_us.push(time_us.cast_signed());
        let sent = SentCounts::of_actions(&own.design, &result.actions).pixels;
        self.sent_pixels.push(sent.cast_signed());
        self.sent_bytes.push(packet_bytes(&self.layout, &result.actions).cast_signed());
        self.names.push(frame.name.clone());
        self.srs.extend(&result.srs);
        self.trs.extend(&result.trs);
        self.active.extend(&result.active);
        self.action.extend(result.actions.iter().map(|&action| action_code(action)));
        self.changed.extend(result.temporal_count.iter().map(|&count| i64::from(count)));
        self.scores.resize_with(result.scores.len(), Vec::new);
        for (column, scores) in self.scores.iter_mut().zip(&result.scores) {
            column.extend(scores.iter().map(signed_score));
        }
        self.displacements.extend(displacement_numbers(result));
        match own.engine.rendered() {
            _ if !self.has_screens => {}
            FramePixels::Bytes(pixels) => self.bytes.extend(pixels),
            FramePixels::Words(pixels) => self.words.extend(pixels),
        }
    }

    /// Returns the arrays by the names of the attributes of an outcome.
    fn into_python<'py>(
        self,
        py: Python<'py>,
        design: &foveate_design::Design,
    ) -> PyResult<Bound<'py, PyDict>> {
        let frames = self.number.len();
        let regions = [frames, design.rows() as usize, design.columns() as usize];
        let pixels = [frames, design.height() as usize, design.width() as usize];
        let found = PyDict::new(py);
        found.set_item("number", self.number.into_pyarray(py))?;
        found.set_item("time_us", self.time_us.into_pyarray(py))?;
        found.set_item("sent_pixels", self.sent_pixels.into_pyarray(py))?;
        found.set_item("sent_bytes", self.sent_bytes.into_pyarray(py))?;
        found.set_item("names", self.names)?;
        found.set_item("srs", stacked(py, self.srs, regions)?)?;
        found.set_item("trs", stacked(py, self.trs, regions)?)?;
        found.set_item("active", stacked(py, self.active, regions)?)?;
        found.set_item("action", stacked(py, self.action, regions)?)?;
        found.set_item("changed", stacked(py, self.changed, regions)?)?;
        let scores = PyDict::new(py);
        for (feature, column) in design.features().iter().zip(self.scores) {
            scores.set_item(feature.kind().to_string(), stacked(py, column, regions)?)?;
        }
        found.set_item("scores", scores)?;
        let [_, rows, columns] = regions;
        let displacements = design.displacement_feature().map(|_| self.displacements);
        let pairs = displacements
            .map(|pairs| PyArray1::from_vec(py, pairs).reshape([frames, rows, columns, 2]));
        found.set_item("displacements", pairs.transpose()?)?;
        let screens = match (self.has_screens, design.pixel_bits()) {
            (false, _) => None,
            (true, ..=8) => Some(stacked(py, self.bytes, pixels)?),
            (true, _) => Some(stacked(py, self.words, pixels)?),
        };
        found.set_item("rendered", screens)?;
        Ok(found)
    }
}

/// Returns the values of all frames as an array.
fn stacked<T: Element>(
    py: Python<'_>,
    mut values: Vec<T>,
    shape: [usize; 3],
) -> PyResult<Bound<'_, PyAny>> {
    values.shrink_to_fit();
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
}

/// The name of frames from arrays in results.
pub(crate) const ARRAY_NAME: &str = "array";

/// Returns inputs as paths: one, or a list of several.
pub(crate) fn paths(inputs: &Bound<'_, PyAny>) -> PyResult<Vec<PathBuf>> {
    if let Ok(path) = inputs.extract::<PathBuf>() {
        return Ok(vec![path]);
    }
    let kind = inputs.get_type().name()?;
    inputs.extract::<Vec<PathBuf>>().map_err(|_| {
        PyTypeError::new_err(format!(
            "inputs are a path, a pattern or scene:NAME, or a list of these, not {kind}"
        ))
    })
}

/// Warns of files and folders among the inputs that are not read although they might have been meant.
fn warn_of_skipped(py: Python<'_>, inputs: &[PathBuf], options: &InputOptions) -> PyResult<()> {
    for sentence in py.detach(|| skipped_in_words(inputs, options)) {
        let text = CString::new(sentence).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// Returns the error that ended a clip before its end, with the names of its inputs.
pub(crate) fn problem_text(player: &ClipPlayer) -> Option<String> {
    let problem = player.problem()?;
    Some(format!("{}: {problem}", player.inputs().join(", ")))
}

/// Warns of the error that ended a clip before its end, if there is one, and of what was found while
/// inputs were read.
pub(crate) fn warn_of_problem(py: Python<'_>, problem: Option<String>) -> PyResult<()> {
    for sentence in InputWarnings::of_process().take().into_iter().chain(problem) {
        let text = CString::new(sentence).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// The inputs of a function that takes footage or arrays.
pub(crate) enum ClipInputs {
    Paths(Vec<PathBuf>),
    Frames(Vec<ByteFrame>),
}

impl ClipInputs {
    /// Returns footage by its name, or frames from arrays for a design of some bits per pixel. `function` is named in
    /// messages.
    pub(crate) fn of(function: &str, inputs: &Bound<'_, PyAny>, bits: u32) -> PyResult<Self> {
        match paths(inputs) {
            // An empty list has no frames either.
            Ok(paths) if !paths.is_empty() => return Ok(Self::Paths(paths)),
            _ => {}
        }
        let wrong = |what: String| {
            PyTypeError::new_err(format!(
                "{function} takes footage, which is a path, a pattern, scene:NAME or a list of these, or frames, which \
                 are an array of shape (frames, height, width) or a list of arrays (height, width); not {what}"
            ))
        };
        let kind = inputs.get_type().name()?;
        // A sequence that NumPy does not know is converted to an array first.
        let is_clip = !inputs.hasattr("__iter__")? && inputs.hasattr("__dlpack__")?;
        let clip =
            is_clip.then(|| untyped(inputs, "a clip is an array of shape (frames, height, width)"));
        let clip = clip.transpose()?;
        let inputs = clip.as_ref().map_or(inputs, |clip| clip.as_any());
        let frames = inputs.try_iter().map_err(|_| wrong(kind.to_string()))?;
        let mut rasters: Vec<ByteFrame> = Vec::new();
        for frame in frames {
            let frame = frame?;
            let array = untyped(&frame, "a frame is a 2-D array of grey pixels (height, width)");
            let array = match array {
                Err(_) if !frame.hasattr("shape")? => {
                    return Err(wrong(format!("a {kind} of {}", frame.get_type().name()?)));
                }
                array => array?,
            };
            if array.ndim() != 2 {
                let what = format!("a {kind} of arrays of shape {}", array.getattr("shape")?);
                return Err(wrong(what));
            }
            rasters.push(Grey::of(&frame, bits)?.raster(bits)?);
        }
        Ok(Self::Frames(rasters))
    }

    /// Warns of files and folders that are not read although they might have been meant.
    pub(crate) fn warn_of_skipped(&self, py: Python<'_>, options: &InputOptions) -> PyResult<()> {
        match self {
            Self::Paths(paths) => warn_of_skipped(py, paths, options),
            Self::Frames(_) => Ok(()),
        }
    }

    fn refuse_several(&self, options: &InputOptions) -> PyResult<()> {
        let Self::Paths(paths) = self else { return Ok(()) };
        match plan(paths, options).map_err(raise)? {
            ClipPlan::One => Ok(()),
            ClipPlan::Batch(clips) => Err(value_error(format!(
                "the inputs are {} clips; take them one after the other",
                clips.len()
            ))),
        }
    }

    /// Opens the inputs as a clip. A set of unrelated images is refused by `function`.
    pub(crate) fn open_clip(
        self,
        function: &str,
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> PyResult<ClipPlayer> {
        let player = self.open(camera, options)?;
        match player.kind() {
            SourceKind::Clip => Ok(player),
            SourceKind::Set => Err(value_error(format!(
                "images of a set do not follow one another; {function} needs a clip"
            ))),
        }
    }

    /// Opens the inputs as one clip or set. Several clips are refused.
    pub(crate) fn open(
        self,
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> PyResult<ClipPlayer> {
        self.refuse_several(options)?;
        match self {
            Self::Paths(paths) => ClipPlayer::open(&paths, camera, options).map_err(raise),
            Self::Frames(frames) => {
                Ok(source_from_memory(ARRAY_NAME, frames, options).map_err(raise)?.into())
            }
        }
    }
}
