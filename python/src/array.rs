// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of Python values: tests whether a value is an array, conversion of other values to arrays, and of arrays to pixels.

use std::path::PathBuf;

use numpy::{PyArrayDescrMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

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

/// Refuses an array with masked values.
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
