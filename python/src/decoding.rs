// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets as Python passes them, decoded frame by frame.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foveate_pixels::ByteFrame;
use foveate_simulator::{PacketStream, ShownFrame, SimulatorError, StreamItem, StreamLoss};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString, PyTuple};

use crate::array::{self, RegionArrays};
use crate::config;
use crate::design::Design;
use crate::error::raise;

/// Frames of a stream of packets, made by `decode`: an iterator that holds one frame at a time.
///
/// Attributes
/// ----------
/// design : Design or None
///     The design with the size of the frames; None until the first frame was read.
/// losses : tuple of StreamLoss
///     Everything that is missing or wrong in the stream so far; after the last frame, in the whole stream.
#[pyclass(frozen, module = "foveate")]
pub(crate) struct Decoding {
    state: Mutex<DecodingState>,
}

struct DecodingState {
    stream: PacketStream,
    losses: Vec<StreamLoss>,
}

/// A frame, and what was lost before it and in it.
struct ReceivedFrame {
    shown: ShownFrame,
    losses: Vec<StreamLoss>,
    design: Arc<foveate_design::Design>,
    has_scores: bool,
}

impl DecodingState {
    /// Returns the next frame, or `None` at the end of the stream.
    fn next(&mut self) -> Result<Option<ReceivedFrame>, SimulatorError> {
        let before = self.losses.len();
        while let Some(item) = self.stream.receive_past_foreign()? {
            match item {
                StreamItem::Loss(loss) => self.losses.push(loss),
                StreamItem::Register(_) => {}
                StreamItem::Frame(shown) => {
                    let design = self.stream.design().expect("a frame is one of a design");
                    return Ok(Some(ReceivedFrame {
                        shown: *shown,
                        losses: self.losses[before..].to_vec(),
                        design: Arc::new(design.clone()),
                        has_scores: self.stream.has_scores(),
                    }));
                }
            }
        }
        Ok(None)
    }
}

impl Decoding {
    /// Locks the stream. Another thread waits for it without holding the interpreter.
    fn state(&self) -> MutexGuard<'_, DecodingState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Decoding {
    /// The design, with the size of the frames; None until the first frame was read.
    #[getter]
    fn design(&self, py: Python<'_>) -> Option<Design> {
        py.detach(|| self.state().stream.design().cloned()).map(Design::from)
    }

    /// Everything that is missing or wrong in the stream so far: tuple of StreamLoss.
    #[getter]
    fn losses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let losses = py.detach(|| self.state().losses.clone());
        losses_in_python(py, &losses)
    }

    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<DecodedFrame>> {
        py.check_signals()?;
        let next = py.detach(|| self.state().next()).map_err(raise)?;
        next.map(|received| DecodedFrame::of(py, received)).transpose()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let losses = py.detach(|| self.state().losses.len());
        format!("<foveate.Decoding: {losses} losses so far>")
    }
}

/// A frame that was made of packets: the receiver's screen and the decisions.
///
/// Attributes
/// ----------
/// number : int
///     Number of the frame in the stream.
/// time_us : int or None
///     Time since the first frame in microseconds; None if the packet with it is lost. The files of `foveate decode` leave
///     such a frame out.
/// rendered : array of uint8 or uint16, shape (height, width)
///     Frame on the receiver's screen.
/// srs, trs, active : array of bool, shape (rows, columns)
///     Spatial relevance, temporal relevance, and both; False where it is lost.
/// action : array of uint8, shape (rows, columns)
///     Action of each region on the screen, an index into `foveate.ACTIONS`: what was received. A lost region is held.
/// changed : array of int64, shape (rows, columns), or None
///     Number of changed pixels of a region, 0 where it is lost; None for a stream without scores.
/// scores : dict of str to array of int64, shape (rows, columns), or None
///     Scores by feature, 0 where they are lost; None for a stream without scores.
/// displacements : array of int8, shape (rows, columns, 2), or None
///     Movement of the content of each region, 0 where it is lost; None for a design without the feature `flow`.
/// map_version : int or None
///     Version of the map of classes that the frame used; None for a design without zones, or if it is lost.
/// losses : tuple of StreamLoss
///     The losses in this frame, and between it and the one before.
/// design : Design
///     The design that the stream belongs to.
#[pyclass(frozen, module = "foveate")]
pub(crate) struct DecodedFrame {
    received: ReceivedFrame,
    screen: Py<PyAny>,
    losses: Py<PyTuple>,
    arrays: RegionArrays,
}

impl DecodedFrame {
    fn of(py: Python<'_>, received: ReceivedFrame) -> PyResult<Self> {
        let screen: &ByteFrame = &received.shown.screen;
        Ok(Self {
            screen: array::screen(py, &received.design, screen.borrowed_pixels())?,
            losses: losses_in_python(py, &received.losses)?.unbind(),
            arrays: RegionArrays::new(py),
            received,
        })
    }

    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.arrays.get(py, name, &self.received.design, &self.received.shown.outcome)
    }
}

#[pymethods]
impl DecodedFrame {
    /// The design that the stream belongs to.
    #[getter]
    fn design(&self) -> Design {
        foveate_design::Design::clone(&self.received.design).into()
    }

    /// Number of the frame in the stream.
    #[getter]
    fn number(&self) -> u32 {
        self.received.shown.number
    }

    /// Time of the frame in microseconds since the first; None if the packet with it is lost.
    #[getter]
    fn time_us(&self) -> Option<u64> {
        self.received.shown.time_us
    }

    /// Version of the map of classes that the frame used; None for a design without zones, or if it is lost.
    #[getter]
    fn map_version(&self) -> Option<u16> {
        self.received.shown.map_version
    }

    /// The frame on the receiver's screen: array of uint8 or uint16, shape (height, width).
    #[getter]
    fn rendered(&self, py: Python<'_>) -> Py<PyAny> {
        self.screen.clone_ref(py)
    }

    /// Spatial relevance, False where it is lost: array of bool, shape (rows, columns).
    #[getter]
    fn srs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "srs")
    }

    /// Temporal relevance, False where it is lost: array of bool, shape (rows, columns).
    #[getter]
    fn trs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "trs")
    }

    /// Regions that are relevant in space and in time: array of bool, shape (rows, columns).
    #[getter]
    fn active<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "active")
    }

    /// The action of each region on the screen, an index into `foveate.ACTIONS`: array of uint8, shape (rows, columns).
    #[getter]
    fn action<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "action")
    }

    /// Number of changed pixels of a region: array of int64, shape (rows, columns); None for a stream without scores.
    #[getter]
    fn changed<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.received.has_scores.then(|| self.array(py, "changed")).transpose()
    }

    /// Scores by feature: dict of str to array of int64, shape (rows, columns); None for a stream without scores.
    #[getter]
    fn scores<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.received.has_scores.then(|| self.array(py, "scores")).transpose()
    }

    /// Movement of the content of each region since its reference, [dx, dy] in pixels to the right and down: array of int8,
    /// shape (rows, columns, 2); None for a design without the feature `flow`.
    #[getter]
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, "displacements")
    }

    /// The losses in this frame, and between it and the one before: tuple of StreamLoss.
    #[getter]
    fn losses(&self, py: Python<'_>) -> Py<PyTuple> {
        self.losses.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        let (number, losses) = (self.number(), self.received.losses.len());
        format!("<foveate.DecodedFrame of frame {number}: {losses} losses>")
    }

    fn __reduce__(&self) -> PyResult<()> {
        Err(PyTypeError::new_err("a decoded frame cannot be pickled; pickle its arrays"))
    }
}

/// Returns losses as tuples with names.
fn losses_in_python<'py>(py: Python<'py>, losses: &[StreamLoss]) -> PyResult<Bound<'py, PyTuple>> {
    let class = py.import("foveate._results")?.getattr("StreamLoss")?;
    let made = losses.iter().map(|loss| {
        let [frame, row, column, count, offset] = loss.fields();
        class.call1((loss.kind(), frame, row, column, count, offset, loss.to_string()))
    });
    PyTuple::new(py, made.collect::<PyResult<Vec<_>>>()?)
}

/// Decode packets: make frames of what a camera has sent, as `foveate decode` does.
///
/// Parameters
/// ----------
/// data : bytes
///     The packets, in a bytes object, a bytearray, a memoryview or an array of bytes: the file `packets.bin`, packets of
///     `Outcome.packets` joined in the order of their frames, or what a board has sent. A copy is kept until the end.
/// camera : Camera, Design, preset, file or dict, optional
///     The camera that has sent them. Its state is neither used nor changed.
///
/// Returns
/// -------
/// Decoding
///     An iterator of `DecodedFrame`. Its `losses` are those of the whole stream after the last frame.
///
/// Notes
/// -----
/// Damage raises no error: all bytes, packets and frames that are missing or wrong are listed as losses, as in `losses.csv`
/// of `foveate decode`, and regions that are lost stay as they were on the screen. Without any frame the iterator is empty.
///
/// Raises
/// ------
/// TypeError
///     If the data are no bytes.
/// ValueError
///     If the first frame of the stream, which the iterator reads first, is one of another camera.
///
/// Examples
/// --------
/// >>> packets = b"".join(outcome.packets() for outcome in simulate("scene:street", "paper", max_frames=8))
/// >>> for frame in decode(packets, "paper"): print(frame.number, frame.rendered.mean(), frame.losses)
#[pyfunction]
#[pyo3(signature = (data, camera=None))]
pub(crate) fn decode(
    data: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
) -> PyResult<Decoding> {
    let py = data.py();
    let config = config::read(camera, None)?;
    let bytes = bytes_of(data)?;
    let mut stream = PacketStream::new(&config);
    let given = bytes.as_bytes();
    py.detach(|| {
        stream.feed(given);
        stream.complete();
    });
    Ok(Decoding { state: Mutex::new(DecodingState { stream, losses: Vec::new() }) })
}

/// Returns the bytes of an object that has some.
fn bytes_of<'py>(data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyBytes>> {
    if let Ok(bytes) = data.cast::<PyBytes>() {
        return Ok(bytes.clone());
    }
    let kind = data.get_type().name()?;
    let is_path = data.is_instance_of::<PyString>() || data.extract::<PathBuf>().is_ok();
    let hint = if is_path { "; read the file, pathlib.Path(path).read_bytes()" } else { "" };
    let wrong = || PyTypeError::new_err(format!("packets are bytes, not {kind}{hint}"));
    let view = data.py().import("builtins")?.getattr("memoryview")?.call1((data,));
    let view = view.map_err(|_| wrong())?;
    Ok(view.call_method0("tobytes")?.cast_into::<PyBytes>()?)
}
