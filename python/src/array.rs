// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of Python values: tests whether a value is an array, conversion of other values to
//! arrays, and of arrays to pixels. The results of all regions of a frame as arrays, which are
//! made when they are first read and own their memory. Pictures for notebooks.

use crate::frame::Grey;
use crate::outcome::Outcome;
use foveate_camera::RegionAction;
use foveate_design::Design;
use foveate_engine::FrameOutcome;
use foveate_output::palette::{ACTIVE, CHANGED, RELEVANT};
use foveate_pixels::{FramePixels, convert_depth, display_depth};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use numpy::{
    Element, PyArray1, PyArray2, PyArray3, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict, PyString};
use std::path::PathBuf;

/// The DLPack device whose memory is that of the processor.
const PROCESSOR: i64 = 1;

/// Returns a value as an array, if it has no masked pixels. A value that is no array is converted by NumPy, or by DLPack if
/// it is in the memory of the processor. `right` says which array is expected.
pub(crate) fn untyped<'py>(
    value: &Bound<'py, PyAny>,
    right: &str,
) -> PyResult<Bound<'py, PyUntypedArray>> {
    if let Ok(array) = value.cast::<PyUntypedArray>() {
        refuse_masks(value)?;
        return Ok(array.clone());
    }
    let kind = value.get_type().name()?;
    let wrong = |why: String| PyTypeError::new_err(format!("{right}, not {kind}{why}"));
    if value.is_instance_of::<PyString>() || value.extract::<PathBuf>().is_ok() {
        return Err(wrong("; foveate.simulate reads files".to_owned()));
    }
    if value.is_none() || value.is_instance_of::<PyBytes>() {
        return Err(wrong(String::new()));
    }
    refuse_devices(value, right)?;
    let numpy = value.py().import("numpy")?;
    let is_exchanged = !value.hasattr("__array__")?
        && !value.hasattr("__array_interface__")?
        && value.hasattr("__dlpack__")?;
    let how = if is_exchanged { "from_dlpack" } else { "asarray" };
    let asked = numpy.call_method1(how, (value,)).map_err(|error| {
        let py = value.py();
        // Lists of rows of several lengths raise such errors. Any other error has another type.
        let message = format!("{right}; {kind} cannot be read as one: {}", error.value(py));
        match error.is_instance_of::<PyValueError>(py) {
            true => PyValueError::new_err(message),
            false => PyTypeError::new_err(message),
        }
    })?;
    let array = asked.cast_into::<PyUntypedArray>()?;
    // NumPy makes an array without a shape of any object.
    if array.ndim() == 0 {
        return Err(wrong(String::new()));
    }
    Ok(array)
}

fn refuse_masks(value: &Bound<'_, PyAny>) -> PyResult<()> {
    let masked = value.py().import("numpy.ma")?.getattr("MaskedArray")?;
    if !value.is_instance(&masked)? {
        return Ok(());
    }
    let mask = value.getattr("mask")?;
    let count: usize = mask.call_method0("sum")?.extract()?;
    if count == 0 {
        return Ok(());
    }
    Err(PyTypeError::new_err(format!(
        "{count} values of the masked array are masked, and a camera has no pixels without a value; fill them, for example with \
         frame.filled(0)"
    )))
}

/// Refuses an array in the memory of another device, such as a graphics processor.
fn refuse_devices(value: &Bound<'_, PyAny>, right: &str) -> PyResult<()> {
    if !value.hasattr("__dlpack_device__")? {
        return Ok(());
    }
    let Ok((device, _)) = value.call_method0("__dlpack_device__")?.extract::<(i64, i64)>() else {
        return Ok(());
    };
    if device == PROCESSOR {
        return Ok(());
    }
    Err(PyTypeError::new_err(format!(
        "{right} in the memory of the processor; this {} lies on another device (DLPack device type {device}), so copy it first, \
         for example with frame.cpu()",
        value.get_type().name()?
    )))
}

/// Describes how to convert an array to pixels of some bits, from its type and its values.
pub(crate) fn conversion(array: &Bound<'_, PyUntypedArray>, bits: u32) -> PyResult<String> {
    let dtype = array.dtype();
    let (largest, pixels) = ((1u32 << bits) - 1, if bits > 8 { "uint16" } else { "uint8" });
    match dtype.kind() {
        b'b' => {
            let scaled = format!("frame.astype(\"{pixels}\") * {largest}");
            return Ok(format!("; for black and white, {scaled}"));
        }
        // The array has another byte order.
        b'u' if dtype.itemsize() == 2 => {
            return Ok("; convert it, for example with frame.astype(\"uint16\")".to_owned());
        }
        b'f' | b'i' | b'u' => {}
        _ => return Ok(String::new()),
    }
    let Some((least, most)) = range(array)? else {
        return Ok(
            "; it has values that are not numbers (NaN), so replace them first, for example \
                   with numpy.nan_to_num"
                .to_owned(),
        );
    };
    let top = f64::from(largest);
    let rounded = if dtype.kind() == b'f' { ".round()" } else { "" };
    let values = format!("; its values are {} to {}", short(least), short(most));
    Ok(if rounded.is_empty() && least >= 0.0 && most <= top {
        format!("; convert it, for example with frame.astype(\"{pixels}\")")
    } else if least >= 0.0 && most <= 1.0 {
        format!(
            "{values}: for values from 0 to 1, (frame * {largest}).round().astype(\"{pixels}\")"
        )
    } else if least >= 0.0 && most <= top {
        format!("{values}: for values from 0 to {largest}, frame{rounded}.astype(\"{pixels}\")")
    } else if !rounded.is_empty() && least >= -1.0 && most <= 1.0 {
        let half = top / 2.0;
        format!(
            "{values}: for values from -1 to 1, ((frame + 1) * {half}).round().astype(\"{pixels}\")"
        )
    } else {
        format!(
            "{values}: pixels of {bits} bits are 0 to {largest}, so scale them first, and then .astype(\"{pixels}\")"
        )
    })
}

/// Returns the smallest and the largest value, or `None` if a value is not a number or is infinite.
fn range(array: &Bound<'_, PyUntypedArray>) -> PyResult<Option<(f64, f64)>> {
    if array.len() == 0 {
        return Ok(Some((0.0, 0.0)));
    }
    let value = |name: &str| -> PyResult<f64> {
        array.call_method0(name)?.call_method0("__float__")?.extract()
    };
    let (least, most) = (value("min")?, value("max")?);
    Ok((least.is_finite() && most.is_finite()).then_some((least, most)))
}

/// Writes a number with no more digits than a message needs.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A frame of pixels as an array that owns its memory.
pub(crate) struct Screen(pub(crate) Py<PyUntypedArray>);

impl Screen {
    pub(crate) fn of(py: Python<'_>, design: &Design, pixels: FramePixels<'_>) -> Self {
        let size = [design.height() as usize, design.width() as usize];
        Self(match pixels {
            FramePixels::Bytes(pixels) => untyped_regions(py, pixels, size),
            FramePixels::Words(pixels) => untyped_regions(py, pixels, size),
        })
    }
}

fn untyped_regions<T: Element + Copy>(
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

/// The arrays of a frame, as far as they have been read.
pub(crate) struct RegionArrays {
    srs: PyOnceLock<Py<PyArray2<bool>>>,
    trs: PyOnceLock<Py<PyArray2<bool>>>,
    active: PyOnceLock<Py<PyArray2<bool>>>,
    action: PyOnceLock<Py<PyArray2<u8>>>,
    changed: PyOnceLock<Py<PyArray2<i64>>>,
    scores: PyOnceLock<Py<PyDict>>,
    displacements: PyOnceLock<Py<PyArray3<i8>>>,
}

/// The design and the results of a frame, of which arrays are made.
#[derive(Clone, Copy)]
pub(crate) struct RegionResults<'a> {
    pub(crate) design: &'a Design,
    pub(crate) result: &'a FrameOutcome,
}

impl RegionResults<'_> {
    fn size(self) -> [usize; 2] {
        [self.design.rows() as usize, self.design.columns() as usize]
    }

    /// Returns an array of regions, which is made once.
    fn once<T: Element>(
        self,
        py: Python<'_>,
        held: &PyOnceLock<Py<PyArray2<T>>>,
        values: impl ExactSizeIterator<Item = T>,
    ) -> Py<PyArray2<T>> {
        held.get_or_init(py, || array(py, values, self.size()).unbind()).clone_ref(py)
    }
}

impl RegionArrays {
    /// Makes no array yet.
    pub(crate) fn new() -> Self {
        Self {
            srs: PyOnceLock::new(),
            trs: PyOnceLock::new(),
            active: PyOnceLock::new(),
            action: PyOnceLock::new(),
            changed: PyOnceLock::new(),
            scores: PyOnceLock::new(),
            displacements: PyOnceLock::new(),
        }
    }

    pub(crate) fn srs(&self, py: Python<'_>, own: RegionResults<'_>) -> Py<PyArray2<bool>> {
        own.once(py, &self.srs, own.result.srs.iter().copied())
    }

    pub(crate) fn trs(&self, py: Python<'_>, own: RegionResults<'_>) -> Py<PyArray2<bool>> {
        own.once(py, &self.trs, own.result.trs.iter().copied())
    }

    pub(crate) fn active(&self, py: Python<'_>, own: RegionResults<'_>) -> Py<PyArray2<bool>> {
        own.once(py, &self.active, own.result.active.iter().copied())
    }

    pub(crate) fn action(&self, py: Python<'_>, own: RegionResults<'_>) -> Py<PyArray2<u8>> {
        own.once(py, &self.action, own.result.actions.iter().map(|&action| action_code(action)))
    }

    pub(crate) fn changed(&self, py: Python<'_>, own: RegionResults<'_>) -> Py<PyArray2<i64>> {
        own.once(py, &self.changed, own.result.temporal_count.iter().map(|&count| count.into()))
    }

    pub(crate) fn scores(&self, py: Python<'_>, own: RegionResults<'_>) -> PyResult<Py<PyDict>> {
        let make = || -> PyResult<Py<PyDict>> {
            let found = PyDict::new(py);
            for (feature, scores) in own.design.features().iter().zip(&own.result.scores) {
                let scores = array(py, scores.iter().map(signed_score), own.size());
                found.set_item(feature.kind().to_string(), scores)?;
            }
            Ok(found.unbind())
        };
        Ok(self.scores.get_or_try_init(py, make)?.clone_ref(py))
    }

    /// Returns the displacements, or `None` for a design without the feature `flow`.
    pub(crate) fn displacements(
        &self,
        py: Python<'_>,
        own: RegionResults<'_>,
    ) -> Option<Py<PyArray3<i8>>> {
        own.design.displacement_feature()?;
        let make = || {
            let [rows, columns] = own.size();
            let numbers = displacement_numbers(own.result).collect();
            let array = PyArray1::from_vec(py, numbers).reshape([rows, columns, 2]);
            array.expect("two numbers for every region").unbind()
        };
        Some(self.displacements.get_or_init(py, make).clone_ref(py))
    }
}

/// Returns the number of an action, which is its index in `foveate.ACTIONS`.
pub(crate) fn action_code(action: RegionAction) -> u8 {
    match action {
        RegionAction::Blank => 0,
        RegionAction::Hold => 1,
        RegionAction::Forward => 2,
        RegionAction::Summarize => 3,
    }
}

pub(crate) fn signed_score(score: &u64) -> i64 {
    i64::try_from(*score).expect("scores are below 2^54")
}

/// Returns the displacement of each region, to the right and down.
pub(crate) fn displacement_numbers(result: &FrameOutcome) -> impl Iterator<Item = i8> + '_ {
    result.displacements.iter().flat_map(|one| [one.dx, one.dy])
}

/// Returns the values of all regions, row by row.
fn array<T: Element>(
    py: Python<'_>,
    values: impl ExactSizeIterator<Item = T>,
    size: [usize; 2],
) -> Bound<'_, PyArray2<T>> {
    PyArray1::from_iter(py, values).reshape(size).expect("a value for every place")
}

/// Returns a grey frame of some bits per pixel as a PNG.
#[pyfunction]
#[pyo3(signature = (frame, bits=8))]
pub(crate) fn grey_png<'py>(
    py: Python<'py>,
    frame: &Bound<'py, PyAny>,
    bits: u32,
) -> PyResult<Bound<'py, PyBytes>> {
    if !(1..=16).contains(&bits) {
        return Err(PyValueError::new_err(format!("bits = {bits}: expected 1 to 16")));
    }
    let grey = Grey::of(frame, bits)?;
    let depth = display_depth(bits);
    let shown = |value: u16| convert_depth(value, bits, depth);
    let values = grey.values().into_iter().map(shown);
    let bytes: Vec<u8> = if depth == 8 {
        values.map(|value| u8::try_from(value).unwrap_or(u8::MAX)).collect()
    } else {
        // The encoder takes native byte order and writes the byte order of PNG.
        values.flat_map(u16::to_ne_bytes).collect()
    };
    let colour = if depth == 8 { ExtendedColorType::L8 } else { ExtendedColorType::L16 };
    png(py, &bytes, grey.size(), colour)
}

/// Returns the decisions of an outcome as a PNG with one pixel per region, in the colours of overlays with outlines.
#[pyfunction]
pub(crate) fn decisions_png<'py>(
    py: Python<'py>,
    outcome: &Bound<'py, Outcome>,
) -> PyResult<Bound<'py, PyBytes>> {
    const NOTHING: [u8; 3] = [64, 64, 64];
    let record = outcome.get().record();
    let bits = record.result.srs.iter().zip(&record.result.trs);
    let colour = bits.flat_map(|bits| match bits {
        (true, true) => ACTIVE,
        (true, false) => RELEVANT,
        (false, true) => CHANGED,
        (false, false) => NOTHING,
    });
    let size = (record.design.columns() as usize, record.design.rows() as usize);
    png(py, &colour.collect::<Vec<u8>>(), size, ExtendedColorType::Rgb8)
}

fn png<'py>(
    py: Python<'py>,
    bytes: &[u8],
    (width, height): (usize, usize),
    colour: ExtendedColorType,
) -> PyResult<Bound<'py, PyBytes>> {
    let side =
        |side: usize| u32::try_from(side).map_err(|error| PyValueError::new_err(error.to_string()));
    let mut encoded = Vec::new();
    PngEncoder::new(&mut encoded)
        .write_image(bytes, side(width)?, side(height)?, colour)
        .map_err(|error| PyValueError::new_err(format!("this is not a picture: {error}")))?;
    Ok(PyBytes::new(py, &encoded))
}
