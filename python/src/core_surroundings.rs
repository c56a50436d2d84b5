// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surroundings of a core, as Python passes them: its clock, and the sink of its words.

use std::fmt::Display;
use std::ops::Range;
use std::path::PathBuf;

use foveate_timed::SinkPattern;
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
        clock_hz: Option<ClockFrequency>,
        sink_rate: Option<SinkRate>,
        sink_stalls: Option<SinkStalls>,
    ) -> PyResult<Self> {
        let sink = match (sink_rate, sink_stalls) {
            (Some(_), Some(_)) => {
                return Err(PyTypeError::new_err("give sink_rate or sink_stalls, not both"));
            }
            (Some(SinkRate(sink)), None) => sink,
            (None, Some(SinkStalls(stalls))) => SinkPattern::Stalls(stalls.into()),
            (None, None) => SinkPattern::Always,
        };
        Ok(Self { clock_hz: clock_hz.map(|ClockFrequency(hz)| hz), sink })
    }
}

/// The frequency of a clock in Hz.
pub(crate) struct ClockFrequency(u64);

impl<'py> FromPyObject<'_, 'py> for ClockFrequency {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
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
                Ok(Self(hz as u64))
            }
            Err(_) if !value.hasattr("__index__")? => Err(PyTypeError::new_err(wrong)),
            _ => Err(PyValueError::new_err(wrong)),
        }
    }
}

/// The rate of a sink: words and clocks.
pub(crate) struct SinkRate(SinkPattern);

impl<'py> FromPyObject<'_, 'py> for SinkRate {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let wrong = format!(
            "sink_rate = {}: expected (words, clocks), whole numbers with at most as many words as clocks, for \
             example (1, 4)",
            value.repr()?
        );
        if !value.is_instance_of::<PyTuple>() {
            return Err(PyTypeError::new_err(wrong));
        }
        let rate = value.extract().ok();
        rate.and_then(|(words, clocks)| SinkPattern::from_rate(words, clocks))
            .map(Self)
            .ok_or_else(|| PyValueError::new_err(wrong))
    }
}

/// The stalls of a sink, in order and without overlaps.
pub(crate) struct SinkStalls(Vec<Range<u64>>);

/// The right form of stalls, for messages.
const STALL_FORM: &str = "sink_stalls are an array of whole numbers of the shape (stalls, 2): the first clock of each \
                          stall, and its number of clocks";

impl<'py> FromPyObject<'_, 'py> for SinkStalls {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
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
        if array.ndim() > 0 && array.len() == 0 {
            return Ok(Self(Vec::new()));
        }
        if array.ndim() != 2 || array.shape()[1] != 2 {
            let shape = array.getattr("shape")?;
            return Err(PyValueError::new_err(format!("{STALL_FORM}; not of the shape {shape}")));
        }
        match array.dtype().kind() {
            b'i' => stalls_of::<i64>(&array, "int64").map(Self),
            b'u' => stalls_of::<u64>(&array, "uint64").map(Self),
            _ => Err(PyTypeError::new_err(format!(
                "{STALL_FORM}; not of {}; convert them, for example with stalls.astype(int)",
                array.dtype().str()?
            ))),
        }
    }
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
