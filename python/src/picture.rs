// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pictures for notebooks.

use foveate_output::palette::{ACTIVE, CHANGED, RELEVANT};
use foveate_pixels::{convert_depth, display_depth};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::frame::Grey;
use crate::outcome::Outcome;

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
