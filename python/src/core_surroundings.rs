// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surroundings of a core, as Python passes them: its clock, and the sink of its words.

use std::fmt::Display;
use std::ops::Range;
use std::path::PathBuf;

use foveate_design::Design;
use foveate_timed::{SinkPattern, TimedClip};
use numpy::{
    Element, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The largest frequency of a clock in Hz, as on the command line.
const MAX_CLOCK_HZ: u64 = 1_000_000_000_000;

/// The clock of a core, and when the sink of its words takes them.
pub(crate) struct CoreSurroundings {
    pub(crate) clock_hz: Option<u64>,
    pub(crate) sink: SinkPattern,
}

impl CoreSurroundings {
    /// The names of the options.
    pub(crate) const OPTIONS: [&'static str; 3] = ["clock_hz", "sink_rate", "sink_stalls"];

    pub(crate) fn from_options(
        clock_hz: Option<u64>,
        sink_rate: Option<SinkPattern>,
        sink_stalls: Option<SinkPattern>,
    ) -> PyResult<Self> {
        if sink_rate.is_some() && sink_stalls.is_some() {
            return Err(PyTypeError::new_err("give sink_rate or sink_stalls, not both"));
        }
        let sink = sink_rate.or(sink_stalls).unwrap_or(SinkPattern::Always);
        Ok(Self { clock_hz, sink })
    }

    /// Makes a core that has seen no frame.
    pub(crate) fn clip(&self, design: &Design) -> TimedClip {
        TimedClip::new(design, self.clock_hz, &self.sink)
    }
}

/// Returns the frequency of a clock in Hz.
pub(crate) fn clock_frequency(value: &Bound<'_, PyAny>) -> PyResult<Option<u64>> {
    if value.is_none() {
        return Ok(None);
    }
    let wrong = format!(
        "clock_hz = {}: expected a whole number of Hz, 1 to {MAX_CLOCK_HZ}, for example 100e6",
        value.repr()?
    );
    // Numbers up to the largest frequency are exact.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "the number is whole and in the range"
    )]
    match value.extract::<f64>() {
        Ok(hz) if hz.fract() == 0.0 && (1.0..=MAX_CLOCK_HZ as f64).contains(&hz) => {
            Ok(Some(hz as u64))
        }
        Err(_) if !value.hasattr("__index__")? => Err(PyTypeError::new_err(wrong)),
        _ => Err(PyValueError::new_err(wrong)),
    }
}

/// Returns a sink that takes words at a rate: words and clocks.
pub(crate) fn sink_of_rate(value: &Bound<'_, PyAny>) -> PyResult<Option<SinkPattern>> {
    if value.is_none() {
        return Ok(None);
    }
    let wrong = format!(
        "sink_rate = {}: expected (words, clocks), whole numbers with at most as many words as clocks, for \
         example (1, 4)",
        value.repr()?
    );
    if !value.is_instance_of::<PyTuple>() {
        return Err(PyTypeError::new_err(wrong));
    }
    let rate = value.extract().ok();
    let sink = rate.and_then(|(words, clocks)| SinkPattern::from_rate(words, clocks));
    sink.map(Some).ok_or_else(|| PyValueError::new_err(wrong))
}

/// The right form of stalls, for messages.
const STALL_FORM: &str = "sink_stalls are an array of whole numbers of the shape (stalls, 2): the first clock of each \
                          stall, and its number of clocks";

/// Returns a sink with stalls, which are in order and do not overlap.
pub(crate) fn sink_of_stalls(value: &Bound<'_, PyAny>) -> PyResult<Option<SinkPattern>> {
    if value.is_none() {
        return Ok(None);
    }
    if value.extract::<PathBuf>().is_ok() {
        return Err(PyTypeError::new_err(format!(
            "{STALL_FORM}; not a path: numpy.loadtxt(path, int, delimiter=\",\", skiprows=1, ndmin=2) reads a table"
        )));
    }
    let array = value.py().import("numpy")?.call_method1("asarray", (value,));
    let array = array
        .map_err(|error| {
            PyValueError::new_err(format!("{STALL_FORM}; {}", error.value(value.py())))
        })?
        .cast_into::<PyUntypedArray>()?;
    let is_empty = array.ndim() > 0 && array.len() == 0;
    if !is_empty && (array.ndim() != 2 || array.shape()[1] != 2) {
        let shape = array.getattr("shape")?;
        return Err(PyValueError::new_err(format!("{STALL_FORM}; not of the shape {shape}")));
    }
    let stalls = match array.dtype().kind() {
        _ if is_empty => Vec::new(),
        b'i' => stalls_of::<i64>(&array, "int64")?,
        b'u' => stalls_of::<u64>(&array, "uint64")?,
        _ => {
            return Err(PyTypeError::new_err(format!(
                "{STALL_FORM}; not of {}; convert them, for example with stalls.astype(int)",
                array.dtype().str()?
            )));
        }
    };
    Ok(Some(SinkPattern::Stalls(stalls.into())))
}

/// Returns the stalls in an array with two columns, whose values have the type `dtype` after a conversion without loss.
fn stalls_of<T: Element + Copy + Display>(
    array: &Bound<'_, PyUntypedArray>,
    dtype: &str,
) -> PyResult<Vec<Range<u64>>>
where
    u64: TryFrom<T>,
{
    let array = array.call_method1("astype", (dtype,))?.cast_into::<PyArray2<T>>()?;
    let array = array.try_readonly()?;
    let mut stalls: Vec<Range<u64>> = Vec::new();
    for (place, row) in array.as_array().rows().into_iter().enumerate() {
        let (clock, clocks) = (row[0], row[1]);
        let (Ok(first), Ok(length @ 1..)) = (u64::try_from(clock), u64::try_from(clocks)) else {
            return Err(PyValueError::new_err(format!(
                "sink_stalls[{place}] = ({clock}, {clocks}): expected a clock from 0 and a number of clocks from 1"
            )));
        };
        let before = stalls.last().map_or(0, |stall| stall.end);
        if first < before {
            return Err(PyValueError::new_err(format!(
                "sink_stalls[{place}] begins at clock {first}, but the stall before it ends at clock {before}; list stalls \
                 in order, without overlaps"
            )));
        }
        stalls.push(first..first.saturating_add(length));
    }
    Ok(stalls)
}
