// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps of classes from Python: arrays of codes.

use foveate_camera::RegionClass;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

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
