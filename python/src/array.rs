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
use numpy::ndarray::IntoDimension;
use numpy::{
    Element, PyArray1, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
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

/// Returns pixels as an array that owns its memory.
pub(crate) fn screen(
    py: Python<'_>,
    design: &Design,
    pixels: FramePixels<'_>,
) -> PyResult<Py<PyAny>> {
    let size = [design.height() as usize, design.width() as usize];
    let array = match pixels {
        FramePixels::Bytes(pixels) => stacked(py, pixels.to_vec(), size),
        FramePixels::Words(pixels) => stacked(py, pixels.to_vec(), size),
    };
    Ok(array?.unbind())
}

/// Returns values as an array of a shape.
pub(crate) fn stacked<T: Element>(
    py: Python<'_>,
    mut values: Vec<T>,
    shape: impl IntoDimension,
) -> PyResult<Bound<'_, PyAny>> {
    values.shrink_to_fit();
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
}

/// The arrays of a frame by the names of its attributes, as far as they have been read.
pub(crate) struct RegionArrays(Py<PyDict>);

impl RegionArrays {
    /// Makes no array yet.
    pub(crate) fn new(py: Python<'_>) -> Self {
        Self(PyDict::new(py).unbind())
    }

    /// Returns an array, which is made when it is first read.
    pub(crate) fn get<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        design: &Design,
        result: &FrameOutcome,
    ) -> PyResult<Bound<'py, PyAny>> {
        let held = self.0.bind(py);
        if let Some(array) = held.get_item(name)? {
            return Ok(array);
        }
        let size @ [rows, columns] = [design.rows() as usize, design.columns() as usize];
        let array = match name {
            "srs" => stacked(py, result.srs.clone(), size)?,
            "trs" => stacked(py, result.trs.clone(), size)?,
            "active" => stacked(py, result.active.clone(), size)?,
            "action" => stacked(py, action_codes(result).collect(), size)?,
            "changed" => stacked(py, changed_counts(result).collect(), size)?,
            "displacements" if design.displacement_feature().is_none() => py.None().into_bound(py),
            "displacements" => {
                stacked(py, displacement_numbers(result).collect(), [rows, columns, 2])?
            }
            "scores" => {
                let found = PyDict::new(py);
                for (feature, scores) in design.features().iter().zip(&result.scores) {
                    let scores = stacked(py, scores.iter().map(signed_score).collect(), size)?;
                    found.set_item(feature.kind().to_string(), scores)?;
                }
                found.into_any()
            }
            _ => unreachable!("every array of regions is above"),
        };
        held.call_method1("setdefault", (name, array))
    }
}

/// Returns the number of the action of each region, which is its index in `foveate.ACTIONS`.
pub(crate) fn action_codes(result: &FrameOutcome) -> impl Iterator<Item = u8> + '_ {
    result.actions.iter().map(|action| match action {
        RegionAction::Blank => 0,
        RegionAction::Hold => 1,
        RegionAction::Forward => 2,
        RegionAction::Summarize => 3,
    })
}

pub(crate) fn changed_counts(result: &FrameOutcome) -> impl Iterator<Item = i64> + '_ {
    result.temporal_count.iter().map(|&count| count.into())
}

pub(crate) fn signed_score(score: &u64) -> i64 {
    i64::try_from(*score).expect("scores are below 2^54")
}

/// Returns the displacement of each region, to the right and down.
pub(crate) fn displacement_numbers(result: &FrameOutcome) -> impl Iterator<Item = i8> + '_ {
    result.displacements.iter().flat_map(|one| [one.dx, one.dy])
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
