// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outcome of one frame. Arrays own their memory, and are made when they are first read.

use std::sync::Arc;

use foveate_design::RegionAction;
use foveate_engine::FrameOutcome;
use foveate_frame::FramePixels;
use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArray};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::camera::Camera;
use crate::design::Design;

/// A frame and its results, as numbers.
pub(crate) struct FrameRecord {
    pub(crate) design: Arc<foveate_design::Design>,
    pub(crate) result: FrameOutcome,
    pub(crate) number: u64,
    pub(crate) time_us: u64,
    pub(crate) name: Option<String>,
    pub(crate) label: Option<String>,
}

/// A frame of pixels as an array that owns its memory.
pub(crate) struct Screen(Py<PyUntypedArray>);

impl Screen {
    /// Returns the pixels of a frame of a design.
    pub(crate) fn of(
        py: Python<'_>,
        design: &foveate_design::Design,
        pixels: FramePixels<'_>,
    ) -> Self {
        let size = [design.height() as usize, design.width() as usize];
        Self(match pixels {
            FramePixels::Bytes(pixels) => untyped(py, pixels, size),
            FramePixels::Words(pixels) => untyped(py, pixels, size),
        })
    }
}

fn untyped<T: Element + Copy>(
    py: Python<'_>,
    pixels: &[T],
    size: [usize; 2],
) -> Py<PyUntypedArray> {
    let array = PyArray1::from_slice(py, pixels).reshape(size);
    array
        .expect("a pixel for every place")
        .into_any()
        .cast_into()
        .expect("an array is one")
        .unbind()
}

/// The outcome of one frame: decisions, scores and the screen. Its arrays own their memory.
///
/// Attributes
/// ----------
/// srs, trs, active : array of bool, shape (rows, columns)
///     Spatial relevance, temporal relevance, and both: the region's pixels are forwarded.
/// action : array of uint8, shape (rows, columns)
///     Action of each region on the screen, an index into `foveate.ACTIONS`.
/// changed : array of int64, shape (rows, columns)
///     Number of changed pixels of a region; all of its pixels without a valid reference.
/// scores : dict of str to array of int64, shape (rows, columns)
///     Scores by feature, in the units of the contract: pixels for `edge`, `corner` and `segment`, grey levels for `range`. In a region of n pixels `surface` and `flow` are n times grey levels, `mad` is n * 2^f times grey levels with f `mean_fraction_bits`, and `variance` is n * n times squared grey levels.
/// displacements : array of int8, shape (rows, columns, 2), or None
///     Movement of the content of each region since its reference, [dx, dy]: pixels to the right and down. None for a design
///     without the feature `flow`.
/// rendered : array of uint8 or uint16, shape (height, width)
///     Frame on the receiver's screen. An outcome of `Camera.step` reads it from the camera at the first use, and
///     raises a RuntimeError if the camera has taken another frame since, unless the step was called with `keep`.
/// frame : array of uint8 or uint16, shape (height, width), or None
///     The frame as the camera saw it; None for `Camera.step`, whose caller has the frame.
/// number : int
///     Number of the frame, from 0.
/// Time of the frame in microseconds since the first.
///     Time since the first frame in microseconds.
/// name, label : str or None
///     Name of the frame and class of the image, if there are any.
/// design : Design
///     The design that the frame was shown to.
#[pyclass(frozen, module = "foveate")]
pub(crate) struct Outcome {
    record: FrameRecord,
    /// The frame itself, if it was read from footage.
    frame: Option<Screen>,
    /// The camera whose screen shows the rendered frame, and the number of its step.
    camera: Option<(Py<Camera>, u64)>,
    rendered: PyOnceLock<Screen>,
    srs: PyOnceLock<Py<PyArray2<bool>>>,
    trs: PyOnceLock<Py<PyArray2<bool>>>,
    active: PyOnceLock<Py<PyArray2<bool>>>,
    action: PyOnceLock<Py<PyArray2<u8>>>,
    changed: PyOnceLock<Py<PyArray2<i64>>>,
    scores: PyOnceLock<Py<PyDict>>,
    displacements: PyOnceLock<Py<PyArray3<i8>>>,
}

impl Outcome {
    fn new(
        py: Python<'_>,
        record: FrameRecord,
        frame: Option<Screen>,
        camera: Option<(Py<Camera>, u64)>,
        screen: Option<Screen>,
    ) -> Self {
        let rendered = PyOnceLock::new();
        if let Some(screen) = screen {
            rendered.get_or_init(py, || screen);
        }
        Self {
            record,
            frame,
            camera,
            rendered,
            srs: PyOnceLock::new(),
            trs: PyOnceLock::new(),
            active: PyOnceLock::new(),
            action: PyOnceLock::new(),
            changed: PyOnceLock::new(),
            scores: PyOnceLock::new(),
            displacements: PyOnceLock::new(),
        }
    }

    /// Makes the outcome of a camera's step, which reads the rendered frame later unless it is kept.
    pub(crate) fn of_camera(
        py: Python<'_>,
        record: FrameRecord,
        camera: Py<Camera>,
        step: u64,
        screen: Option<Screen>,
    ) -> Self {
        Self::new(py, record, None, Some((camera, step)), screen)
    }

    /// Makes the outcome of a run, with frame and rendered frame.
    pub(crate) fn of_run(
        py: Python<'_>,
        record: FrameRecord,
        frame: Screen,
        screen: Screen,
    ) -> Self {
        Self::new(py, record, Some(frame), None, Some(screen))
    }

    pub(crate) fn record(&self) -> &FrameRecord {
        &self.record
    }

    fn size(&self) -> [usize; 2] {
        [self.record.design.rows() as usize, self.record.design.columns() as usize]
    }

    /// Returns an array of regions, which is made once.
    fn once<T: Element>(
        &self,
        py: Python<'_>,
        held: &PyOnceLock<Py<PyArray2<T>>>,
        values: impl ExactSizeIterator<Item = T>,
    ) -> Py<PyArray2<T>> {
        held.get_or_init(py, || array(py, values, self.size()).unbind()).clone_ref(py)
    }
}

#[pymethods]
impl Outcome {
    /// The design that the frame was shown to.
    #[getter]
    fn design(&self) -> Design {
        foveate_design::Design::clone(&self.record.design).into()
    }

    /// Number of the frame, from 0.
    #[getter]
    fn number(&self) -> u64 {
        self.record.number
    }

    /// Time of the frame in microseconds since the first.
    #[getter]
    fn time_us(&self) -> u64 {
        self.record.time_us
    }

    /// Name of the frame; None for a frame given as an array.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.record.name.as_deref()
    }

    /// Class of the image; None without a label.
    #[getter]
    fn label(&self) -> Option<&str> {
        self.record.label.as_deref()
    }

    /// Spatial relevance: array of bool, shape (rows, columns).
    #[getter]
    fn srs(&self, py: Python<'_>) -> Py<PyArray2<bool>> {
        self.once(py, &self.srs, self.record.result.srs.iter().copied())
    }

    /// Temporal relevance: array of bool, shape (rows, columns).
    #[getter]
    fn trs(&self, py: Python<'_>) -> Py<PyArray2<bool>> {
        self.once(py, &self.trs, self.record.result.trs.iter().copied())
    }

    /// Regions that are relevant in space and in time, whose pixels are sent: array of bool, shape (rows, columns).
    #[getter]
    fn active(&self, py: Python<'_>) -> Py<PyArray2<bool>> {
        self.once(py, &self.active, self.record.result.active.iter().copied())
    }

    /// The action of each region on the screen, an index into `foveate.ACTIONS`: array of uint8, shape (rows, columns).
    #[getter]
    fn action(&self, py: Python<'_>) -> Py<PyArray2<u8>> {
        self.once(py, &self.action, self.record.result.actions.iter().map(|&action| code(action)))
    }

    /// Number of changed pixels of a region, all of its pixels without a valid reference: array of int64, shape (rows, columns).
    #[getter]
    fn changed(&self, py: Python<'_>) -> Py<PyArray2<i64>> {
        let counts = self.record.result.temporal_count.iter();
        self.once(py, &self.changed, counts.map(|&count| count.into()))
    }

    /// Scores by feature, in the units of the contract: dict of str to array of int64, shape (rows, columns).
    #[getter]
    fn scores(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        let make = || -> PyResult<Py<PyDict>> {
            let found = PyDict::new(py);
            let features = self.record.design.features().iter();
            for (feature, scores) in features.zip(&self.record.result.scores) {
                let signed = |&score: &u64| i64::try_from(score).expect("scores are below 2^54");
                let scores = array(py, scores.iter().map(signed), self.size());
                found.set_item(feature.kind().to_string(), scores)?;
            }
            Ok(found.unbind())
        };
        Ok(self.scores.get_or_try_init(py, make)?.clone_ref(py))
    }

    /// Movement of the content of each region since its reference, [dx, dy] in pixels to the right and down: array of int8,
    /// shape (rows, columns, 2); None for a design without the feature `flow`.
    #[getter]
    fn displacements(&self, py: Python<'_>) -> Option<Py<PyArray3<i8>>> {
        self.record.design.displacement_feature()?;
        let make = || {
            let pairs = self.record.result.displacements.iter();
            let numbers = pairs.flat_map(|one| [one.dx, one.dy]).collect();
            let [rows, columns] = self.size();
            let array = PyArray1::from_vec(py, numbers).reshape([rows, columns, 2]);
            array.expect("two numbers for every region").unbind()
        };
        Some(self.displacements.get_or_init(py, make).clone_ref(py))
    }

    /// The frame as the camera saw it: array of uint8 or uint16, shape (height, width); None for a frame that was given as an
    /// array, because the caller has it.
    #[getter]
    fn frame(&self, py: Python<'_>) -> Option<Py<PyUntypedArray>> {
        self.frame.as_ref().map(|frame| frame.0.clone_ref(py))
    }

    /// The frame on the receiver's screen: array of uint8 or uint16, shape (height, width). Read it before the next step, unless it was kept.
    #[getter]
    fn rendered(&self, py: Python<'_>) -> PyResult<Py<PyUntypedArray>> {
        let read = || {
            let (camera, step) = self.camera.as_ref().expect("what no camera has is kept");
            camera.get().screen(py, *step)
        };
        Ok(self.rendered.get_or_try_init(py, read)?.0.clone_ref(py))
    }

    fn __repr__(&self) -> String {
        let FrameRecord { result, number, .. } = &self.record;
        let [rows, columns] = self.size();
        let active = result.active.iter().filter(|&&active| active).count();
        format!("<foveate.Outcome of frame {number}: {active} of {columns}x{rows} regions active>")
    }

    /// Shows the outcome in a notebook.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("foveate._show")?.call_method1("outcome_card", (slf,))
    }

    fn __reduce__(&self) -> PyResult<()> {
        Err(PyTypeError::new_err(
            "an outcome cannot be pickled; pickle its arrays, or the table that foveate.events makes",
        ))
    }
}

/// Returns the number of an action, which is its index in `foveate.ACTIONS`.
fn code(action: RegionAction) -> u8 {
    match action {
        RegionAction::Blank => 0,
        RegionAction::Hold => 1,
        RegionAction::Forward => 2,
        RegionAction::Summarize => 3,
    }
}

/// Returns the values of all regions, row by row.
fn array<T: Element>(
    py: Python<'_>,
    values: impl ExactSizeIterator<Item = T>,
    size: [usize; 2],
) -> Bound<'_, PyArray2<T>> {
    PyArray1::from_iter(py, values).reshape(size).expect("a value for every place")
}
