// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outcome of one frame. Arrays own their memory, and are made when they are first read. A
//! frame and its results as numbers, and everything that follows from them alone. Maps of
//! classes from Python: arrays of codes.

use crate::array::RegionArrays;
use crate::camera::Camera;
use crate::commands::json;
use crate::design::Design;
use crate::error::raise;
use crate::frame::{Grey, size_of};
use foveate_camera::RegionClass;
use foveate_engine::FrameOutcome;
use foveate_simulator::{
    DecidedRegion, DecisionExplanation, FrameStart, OverlayFrame, OverlayStyle, PacketContent,
    SentCounts, SentValues, SimulatorError, active_groups, draw_overlay, packet_bytes,
    packet_layout, wrapped_number, write_kept_packets,
};
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyBytes;
use std::sync::Arc;

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
///     Scores by feature as the contract defines them, before they are divided by the number of pixels.
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
/// time_us : int
///     Time since the first frame in microseconds.
/// sent_pixels : int
///     Number of pixels that the active regions forward, without padding beyond the frame; `pixels_forwarded` of `frames.csv`.
/// sent_bytes : int
///     Number of bytes of the packets of the frame without scores, as `foveate simulate --packets` writes them: decisions of
///     all regions, pixels, means and what is around them. It follows from the decisions, so it is there at any time.
/// name, label : str or None
///     Name of the frame and class of the image, if there are any.
/// design : Design
///     The design that the frame was shown to.
#[pyclass(frozen, module = "foveate")]
pub(crate) struct Outcome {
    record: FrameRecord,
    /// The frame itself, if it was read from footage.
    frame: Option<Py<PyAny>>,
    /// The camera whose screen shows the rendered frame, and the number of its step.
    camera: Option<(Py<Camera>, u64)>,
    rendered: PyOnceLock<Py<PyAny>>,
    /// The values that the regions send, of which packets are made.
    values: PyOnceLock<SentValues>,
    arrays: RegionArrays,
}

/// The parts of an outcome that the next frame of its camera overwrites.
pub(crate) struct KeptParts {
    pub(crate) screen: Py<PyAny>,
    pub(crate) values: SentValues,
}

impl Outcome {
    /// Makes the outcome of a camera's step, which reads the rendered frame later unless it is kept, or
    /// that of a run, with the frame.
    pub(crate) fn new(
        py: Python<'_>,
        record: FrameRecord,
        frame: Option<Py<PyAny>>,
        camera: Option<(Py<Camera>, u64)>,
        kept: Option<KeptParts>,
    ) -> Self {
        let (rendered, values) = (PyOnceLock::new(), PyOnceLock::new());
        if let Some(kept) = kept {
            rendered.get_or_init(py, || kept.screen);
            values.get_or_init(py, || kept.values);
        }
        Self { record, frame, camera, rendered, values, arrays: RegionArrays::new(py) }
    }

    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.arrays.get(py, name, &self.record.design, &self.record.result)
    }

    pub(crate) fn record(&self) -> &FrameRecord {
        &self.record
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
    fn srs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "srs")
    }

    /// Temporal relevance: array of bool, shape (rows, columns).
    #[getter]
    fn trs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "trs")
    }

    /// Regions that are relevant in space and in time, whose pixels are sent: array of bool, shape (rows, columns).
    #[getter]
    fn active<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "active")
    }

    /// The action of each region on the screen, an index into `foveate.ACTIONS`: array of uint8, shape (rows, columns).
    #[getter]
    fn action<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "action")
    }

    /// Number of changed pixels of a region, all of its pixels without a valid reference: array of int64, shape (rows, columns).
    #[getter]
    fn changed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "changed")
    }

    /// Scores by feature, in the units of the contract: dict of str to array of int64, shape (rows, columns).
    #[getter]
    fn scores<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "scores")
    }

    /// Movement of the content of each region since its reference, [dx, dy] in pixels to the right and down: array of int8,
    /// shape (rows, columns, 2); None for a design without the feature `flow`.
    #[getter]
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "displacements")
    }

    /// The frame as the camera saw it: array of uint8 or uint16, shape (height, width); None for a frame that was given as an
    /// array, because the caller has it.
    #[getter]
    fn frame(&self) -> Option<&Py<PyAny>> {
        self.frame.as_ref()
    }

    /// The frame on the receiver's screen: array of uint8 or uint16, shape (height, width). Read it before the next step, unless it was kept.
    #[getter]
    fn rendered(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let read = || {
            let (camera, step) = self.camera.as_ref().expect("what no camera has is kept");
            camera.get().screen(py, *step)
        };
        Ok(self.rendered.get_or_try_init(py, read)?.clone_ref(py))
    }

    /// Number of pixels that the active regions forward, without padding beyond the frame.
    #[getter]
    fn sent_pixels(&self) -> u64 {
        self.record.sent_counts().pixels
    }

    /// Number of bytes of the packets of the frame, without scores; it is known at any time, also after the next step.
    #[getter]
    fn sent_bytes(&self) -> PyResult<u64> {
        self.record.sent_bytes().map_err(raise)
    }

    /// Make the packets that the camera sends for the frame, as `foveate simulate --packets` writes them.
    ///
    /// Parameters
    /// ----------
    /// scores : bool, default False
    ///     Also send the scores of all regions, as with `--packets=scores`.
    ///
    /// Returns
    /// -------
    /// bytes
    ///     The packets, which `foveate.decode` reads. Those of the frames of a clip, joined, are the file `packets.bin`.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     If this is an outcome of `Camera.step`, and the camera has taken another frame since or was reset: the pixels are
    ///     read from the camera at the first use, as `rendered` is, unless the step was called with `keep`.
    #[pyo3(signature = (*, scores=false))]
    fn packets<'py>(&self, py: Python<'py>, scores: bool) -> PyResult<Bound<'py, PyBytes>> {
        let read = || {
            let (camera, step) = self.camera.as_ref().expect("what no camera has is kept");
            camera.get().sent_values(*step)
        };
        let values = self.values.get_or_try_init(py, read)?;
        let content = if scores { PacketContent::WithScores } else { PacketContent::Plain };
        let packets = py.detach(|| self.record.packets(values, content)).map_err(raise)?;
        Ok(PyBytes::new(py, &packets))
    }

    /// Draw the frame with what is sent of it, as `foveate simulate --overlay` does, without the legend and the chart below.
    ///
    /// Parameters
    /// ----------
    /// frame : array of shape (height, width), optional
    ///     Grey pixels to draw over, as `Camera.step` takes them. The default is `frame` of the outcome. An outcome of
    ///     `Camera.step` has none, so give the frame that the camera took. Another frame of its size, such as `rendered`, is
    ///     allowed.
    /// outlines : bool
    ///     Whether each decision has a colour, with outlines: active regions green, relevant but unchanged ones orange,
    ///     changed but irrelevant ones blue. Otherwise what is sent is bright, what is not sent is dark, and means are
    ///     tinted.
    ///
    /// Returns
    /// -------
    /// array of uint8, shape (scale * height, scale * width, 3)
    ///     Red, green and blue. Small frames are enlarged by a whole number, the scale. Marks of classes are drawn unless `Camera.zones` was
    ///     assigned.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the outcome has no frame and none is given, or if the frame is no array of pixels of the design.
    /// ValueError
    ///     If the frame has another size.
    #[pyo3(signature = (frame=None, *, outlines=false))]
    fn overlay<'py>(
        &self,
        py: Python<'py>,
        frame: Option<&Bound<'py, PyAny>>,
        outlines: bool,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let own = self.frame.as_ref().map(|own| own.bind(py));
        let Some(frame) = frame.or(own) else {
            return Err(PyTypeError::new_err(
                "this outcome has no frame, because Camera.step does not keep the frame that it takes; give that frame, \
                 outcome.overlay(frame)",
            ));
        };
        let design = &self.record.design;
        let grey = Grey::of(frame, design.pixel_bits())?;
        let size = size_of(design);
        if grey.size() != size {
            let ((width, height), (own_width, own_height)) = (grey.size(), size);
            return Err(PyValueError::new_err(format!(
                "the frame has {width}x{height} pixels, but this outcome is that of a frame of {own_width}x{own_height}; give \
                 the frame that the camera took"
            )));
        }
        let frame = grey.raster(design.pixel_bits())?;
        let (width, height, colours) = py.detach(|| {
            draw_overlay(OverlayFrame {
                camera: design,
                outcome: &self.record.result,
                frame: &frame,
                has_own_map: self.record.has_own_map(),
                style: if outlines { OverlayStyle::Outlines } else { OverlayStyle::Sent },
            })
        });
        let shape = (height as usize, width as usize, 3);
        let colours = Array3::from_shape_vec(shape, colours).expect("three values for each pixel");
        Ok(colours.into_pyarray(py))
    }

    /// Explain the decision for a region from its scores: why it was sent or dropped.
    ///
    /// Parameters
    /// ----------
    /// region : (int, int)
    ///     Column and row of the region.
    ///
    /// Returns
    /// -------
    /// Explanation
    ///     A dict with the keys of `foveate.explain`, and the same values, as far as scores tell them: scores, thresholds, votes,
    ///     counts, class and rule. An outcome has no pixels of regions and references, so keys that hold pixels or follow from
    ///     them (`raw`, `denoised`, `hits`, `mean`, `parts`, `displacements`, `differences`, `reference`, `summary`) are
    ///     missing; `foveate.explain` has them.
    ///
    /// Raises
    /// ------
    /// IndexError
    ///     If the region does not exist.
    fn explain<'py>(&self, py: Python<'py>, region: (u32, u32)) -> PyResult<Bound<'py, PyAny>> {
        let explanation = self.record.explain(region).map_err(raise)?;
        let values = py.import("json")?.call_method1("loads", (json(&explanation)?,))?;
        let text = explanation.to_string();
        py.import("foveate._results")?.call_method1("Explanation", (values, text))
    }

    /// Find the boxes around groups of active regions that touch, also at corners.
    ///
    /// Returns
    /// -------
    /// array of float32, shape (boxes, 4)
    ///     Left, upper, right and lower edge of each box in pixels, within the frame, in the order of the groups' first regions.
    fn boxes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        #[allow(clippy::cast_precision_loss, reason = "sides of frames are below 2^15")]
        let edge = |&edge: &u32| edge as f32;
        let groups = active_groups(&self.record.design, &self.record.result.active);
        let edges: Vec<f32> = groups.as_flattened().iter().map(edge).collect();
        let boxes = Array2::from_shape_vec((groups.len(), 4), edges).expect("four edges each");
        boxes.into_pyarray(py)
    }

    /// Return the boxes around groups of active regions as `supervision.Detections`.
    ///
    /// Returns
    /// -------
    /// supervision.Detections
    ///     Detections whose `xyxy` are `boxes()`, without classes and confidences.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     If the package supervision is not installed.
    fn detections<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("foveate._detections")?.call_method1("detections_of", (slf,))
    }

    fn __repr__(&self) -> String {
        let FrameRecord { result, number, .. } = &self.record;
        let (columns, rows) = (self.record.design.columns(), self.record.design.rows());
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

/// A frame and its results.
pub(crate) struct FrameRecord {
    pub(crate) design: Arc<foveate_design::Design>,
    pub(crate) result: FrameOutcome,
    pub(crate) number: u64,
    pub(crate) time_us: u64,
    pub(crate) is_first: bool,
    pub(crate) name: Option<String>,
    pub(crate) label: Option<String>,
    /// The classes of the regions in this frame, of a design with zones.
    pub(crate) classes: Option<RegionClasses>,
}

/// The map of classes that a frame used.
pub(crate) struct RegionClasses {
    pub(crate) map: Vec<RegionClass>,
    /// The number of maps that were set since the camera had that of its configuration.
    pub(crate) maps_set: u64,
}

impl FrameRecord {
    /// Returns true if the frame used the map of classes of the configuration, or if there are no classes.
    pub(crate) fn has_own_map(&self) -> bool {
        self.maps_set() == 0
    }

    fn maps_set(&self) -> u64 {
        self.classes.as_ref().map_or(0, |classes| classes.maps_set)
    }

    /// Returns what the frame sends, as `frames.csv` counts it.
    pub(crate) fn sent_counts(&self) -> SentCounts {
        SentCounts::of_actions(&self.design, &self.result.actions)
    }

    /// Returns the number of bytes of the packets of the frame, without scores.
    pub(crate) fn sent_bytes(&self) -> Result<u64, SimulatorError> {
        let layout = packet_layout(&self.design, PacketContent::Plain)?;
        Ok(packet_bytes(&layout, &self.result.actions))
    }

    /// Makes the packets of the frame of the values that its regions send.
    pub(crate) fn packets(
        &self,
        values: &SentValues,
        content: PacketContent,
    ) -> Result<Vec<u8>, SimulatorError> {
        let layout = packet_layout(&self.design, content)?;
        let start = FrameStart {
            number: wrapped_number(self.number),
            time: self.time_us,
            is_first: self.is_first,
            // Versions of maps wrap around, see the page on packets.
            map_version: u16::try_from(self.maps_set() & u64::from(u16::MAX)).unwrap_or_default(),
        };
        let mut bytes = Vec::new();
        write_kept_packets(&mut bytes, &layout, &self.result, values, start)?;
        Ok(bytes)
    }

    /// Explains the decision for the region at this column and row from its scores.
    pub(crate) fn explain(
        &self,
        (x, y): (u32, u32),
    ) -> Result<DecisionExplanation, SimulatorError> {
        let (columns, rows) = (self.design.columns(), self.design.rows());
        if x >= columns || y >= rows {
            return Err(SimulatorError::NoSuchRegion { x, y, columns, rows });
        }
        let region = y * columns + x;
        let (at, result) = (region as usize, &self.result);
        let decided = DecidedRegion {
            class: self.classes.as_ref().map_or(RegionClass::Normal, |classes| classes.map[at]),
            scores: result.scores.iter().map(|scores| scores[at]).collect(),
            displacement: result.displacements.get(at).copied(),
            changed: result.temporal_count[at],
            srs: result.srs[at],
            trs: result.trs[at],
            action: result.actions[at],
        };
        let moment = (self.number, self.name.as_deref(), self.time_us);
        Ok(DecisionExplanation::from_scores(&self.design, moment, region, &decided))
    }
}

/// Returns the classes of an array of codes, row by row.
pub(crate) fn classes_of(
    codes: &Bound<'_, PyAny>,
    (rows, columns): (u32, u32),
) -> PyResult<Vec<RegionClass>> {
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
