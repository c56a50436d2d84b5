// SPDX-License-Identifier: MIT OR Apache-2.0
//! Footage of the command line, shown frame by frame to a camera of its own.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foveate_engine::Engine;
use foveate_media::{ClipPlayer, PlaybackError, PlayedFrame};
use foveate_pixels::{ByteFrame, FramePixels};
use foveate_simulator::SentValues;
use numpy::ndarray::Axis;
use numpy::{
    Element, PyArray2, PyArray3, PyArrayDescrMethods, PyArrayMethods, PyUntypedArrayMethods,
    ToPyArray,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{self, conversion, untyped};
use crate::design::{Design, in_words};
use crate::error::raise;
use crate::inputs::{ClipRequest, problem_text, warn_of_problem};
use crate::outcome::{FrameRecord, KeptParts, Outcome, RegionClasses};
use crate::work::at_once;

/// A run over footage, made by `simulate`: an iterator of outcomes that holds one frame at a time.
///
/// Attributes
/// ----------
/// design : Design
///     The design, with the size of the frames.
/// total : int or None
///     Number of frames, if it is known. A damaged video may have fewer.
/// problem : str or None
///     The error that ended the footage before its end, if any. The end of the iterator then also gives a UserWarning.
#[pyclass(frozen, module = "foveate")]
pub(crate) struct Run {
    design: Arc<foveate_design::Design>,
    total: Option<u64>,
    state: Mutex<RunState>,
}

struct RunState {
    player: ClipPlayer,
    engine: Engine,
}

/// A frame, its outcome, the screen after it, and the values that it sends.
struct RunFrame {
    record: FrameRecord,
    frame: PlayedFrame,
    screen: ByteFrame,
    values: SentValues,
}

impl Run {
    /// Locks the state of the run. Another thread waits for it without holding the interpreter.
    fn state(&self) -> MutexGuard<'_, RunState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Run {
    /// The design, with the size of the frames.
    #[getter]
    fn design(&self) -> Design {
        foveate_design::Design::clone(&self.design).into()
    }

    /// Number of frames; None if it is not known. A damaged video may have fewer.
    #[getter]
    fn total(&self) -> Option<u64> {
        self.total
    }

    /// The error that ended the footage before its end; None without an error.
    #[getter]
    fn problem(&self, py: Python<'_>) -> Option<String> {
        py.detach(|| problem_text(&self.state().player))
    }

    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Outcome>> {
        py.check_signals()?;
        let design = Arc::clone(&self.design);
        let next = py.detach(|| self.state().next(design)).map_err(raise)?;
        let Some(RunFrame { record, frame, screen, values }) = next else {
            warn_of_problem(py, self.problem(py))?;
            return Ok(None);
        };
        let array = |frame: &ByteFrame| array::screen(py, &self.design, frame.borrowed_pixels());
        let kept = KeptParts { screen: array(&screen)?, values };
        Ok(Some(Outcome::new(py, record, Some(array(&frame.frame)?), None, Some(kept))))
    }

    fn __repr__(&self) -> String {
        let total = self.total.map_or("?".to_owned(), |total| total.to_string());
        format!("<foveate.Run of {total} frames: {}>", in_words(&self.design))
    }
}

impl RunState {
    fn next(
        &mut self,
        design: Arc<foveate_design::Design>,
    ) -> Result<Option<RunFrame>, PlaybackError> {
        let Some(frame) = self.player.next().transpose()? else { return Ok(None) };
        let result = frame.show_to(&mut self.engine)?.clone();
        // The run never changes the map of its configuration.
        let zones = design.zones();
        let classes = zones
            .map(|zones| RegionClasses { map: zones.configured_classes().to_vec(), maps_set: 0 });
        let record = FrameRecord {
            result,
            number: frame.number,
            time_us: frame.time_us,
            is_first: frame.is_first(),
            classes,
            name: Some(frame.name.clone()),
            label: frame.label.clone(),
            design,
        };
        let (width, height, bits) = (frame.frame.width(), frame.frame.height(), frame.frame.bits());
        let screen = match self.engine.rendered() {
            FramePixels::Bytes(pixels) => {
                ByteFrame::from_bytes(width, height, bits, pixels.to_vec())?
            }
            FramePixels::Words(pixels) => {
                ByteFrame::from_words(width, height, bits, pixels.to_vec())?
            }
        };
        let values = SentValues::of_engine(&self.engine);
        Ok(Some(RunFrame { record, frame, screen, values }))
    }
}

/// Run a camera over footage, frame by frame.
///
/// Parameters
/// ----------
/// inputs : path, pattern, "scene:NAME", a list of these, or frames
///     Inputs of the command line: a video, images, a set, a scene. Videos need ffmpeg. Or frames that you have as arrays: an
///     array of shape (frames, height, width), or a list of arrays (height, width), grey pixels as `Camera.step` takes them.
///     They are one clip, of which a copy is kept until the end, and have the times of `rate`.
/// camera : Camera, Design, preset, file or dict, optional
///     The camera. The run makes its own camera of this design, which has seen no frame; the state of `camera` is
///     neither used nor changed.
/// max_frames : int, optional
///     Largest number of frames; a scene is made with exactly this many, of which `start`, `end` and `input_fps` choose.
/// input_fps, rate : float or str, optional
///     Take at most this many frames per second; frame rate of images, which have no times (30).
/// start, end : float or str, optional
///     Take frames from this time and before this time: seconds, or "HH:MM:SS".
/// crop : (int, int, int, int), optional
///     Take this part of every frame: width, height, and its left and upper edge.
/// resize : (int, int), optional
///     Scale every frame by area to this width and height, after cropping.
/// luma : {"coded", "full"}, optional
///     The range of the luma of video: as it was coded (default), or expanded to all values.
/// orientation : {"stored", "upright"}, optional
///     Orientation of images and video: as they are stored (default), or upright, as their marks say.
/// video_stream : int, optional
///     Video stream that is read of a file with several, from 0. By default it is the one that players take.
/// raw : str, optional
///     Size and pixel format of raw video, such as "640x480,gray16le".
/// bayer : {"rggb", "bggr", "grbg", "gbrg"}, optional
///     Colours of the upper left 2x2 pixels of a mosaic, row by row.
/// timestamps : path, optional
///     File with the times of images or raw video, a line per frame.
/// timestamp_unit : {"s", "ms", "us", "ns"}, optional
///     Unit of these times (s).
/// images : {"clip", "set", "cifar-sheet"}, optional
///     How image files are read: as frames of a clip (default), as unrelated images, or as sheets with an image per row.
/// labels : path, optional
///     File of labels of an IDX file, if it is not beside that file.
///
/// Returns
/// -------
/// Run
///     An iterator of `Outcome`, each with its `frame` and `rendered`. Ctrl-C ends it between two frames.
///
/// Raises
/// ------
/// FileNotFoundError, ValueError
///     If an input cannot be read, or does not fit the configuration.
/// TypeError
///     If an option does not exist or has another type, or if `inputs` are neither footage nor frames.
/// ToolError
///     If ffmpeg is needed and missing.
///
/// Examples
/// --------
/// >>> active = numpy.stack([outcome.active for outcome in simulate("scene:street", "paper", max_frames=8)])
#[pyfunction]
#[pyo3(
    signature = (inputs, camera=None, **options),
    text_signature = "(inputs, camera=None, *, max_frames=None, input_fps=None, rate=None, start=None, end=None, crop=None, \
                      resize=None, luma=None, orientation=None, video_stream=None, raw=None, bayer=None, \
                      timestamps=None, timestamp_unit=None, images=None, labels=None)"
)]
pub(crate) fn simulate(
    py: Python<'_>,
    inputs: &Bound<'_, PyAny>,
    camera: Option<&Bound<'_, PyAny>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Run> {
    let mut request = ClipRequest::new(("simulate", &[]), inputs, camera, options)?;
    at_once(py, move || -> PyResult<Run> {
        let player = request.open()?;
        let (width, height) = player.size();
        let design = request.config.validate_for_frames(width, height).map_err(raise)?;
        let (total, engine) = (player.frames(), Engine::new(&design));
        let state = RunState { player, engine };
        Ok(Run { design: Arc::new(design), total, state: Mutex::new(state) })
    })?
}

/// Make a grey frame of red, green and blue, as footage is read: (77 R + 150 G + 29 B + 128) >> 8.
///
/// Parameters
/// ----------
/// frame : array of uint8, shape (height, width, 3)
///
/// Returns
/// -------
/// array of uint8, shape (height, width)
///
/// Raises
/// ------
/// TypeError
///     If the array has another dtype.
/// ValueError
///     If the array has another shape.
#[pyfunction]
pub(crate) fn luma<'py>(
    py: Python<'py>,
    frame: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray2<u8>>> {
    const RIGHT: &str =
        "a frame of red, green and blue is an array of uint8 with the shape (height, width, 3)";
    let array = untyped(frame, RIGHT)?;
    if array.ndim() != 3 || array.shape()[2] != 3 {
        let hint = match array.shape() {
            [_, _] => "; it is grey already",
            [_, _, 4] => "; leave the fourth channel out, frame[:, :, :3]",
            [3, _, _] => "; put the channels last, numpy.moveaxis(frame, 0, -1)",
            [_, _, _, 3] => "; give the frames one by one",
            _ => "",
        };
        let shape = array.getattr("shape")?;
        return Err(PyValueError::new_err(format!("{RIGHT}, not {shape}{hint}")));
    }
    let dtype = array.dtype();
    if !dtype.is_equiv_to(&u8::get_dtype(py)) {
        let hint = match dtype.kind() {
            b'u' if dtype.itemsize() == 2 => {
                "; for values of 16 bits, numpy.uint8(frame >> 8)".to_owned()
            }
            _ => conversion(&array, 8)?,
        };
        return Err(PyTypeError::new_err(format!("{RIGHT}, not of {}{hint}", dtype.str()?)));
    }
    let array = array.cast::<PyArray3<u8>>()?.try_readonly()?;
    let view = array.as_array();
    let grey = py.detach(|| {
        view.map_axis(Axis(2), |colour| {
            let grey = foveate_pixels::luma(colour[0].into(), colour[1].into(), colour[2].into());
            u8::try_from(grey).expect("the weights sum to 256")
        })
    });
    Ok(grey.to_pyarray(py))
}
