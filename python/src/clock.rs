// SPDX-License-Identifier: MIT OR Apache-2.0
//! Times of frames that are given one by one. They never decrease.

use foveate_media::FrameRate;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// A time as Python passes it.
#[derive(Clone, Copy)]
pub(crate) struct MicroSeconds(pub(crate) u64);

impl<'py> FromPyObject<'_, 'py> for MicroSeconds {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let wrong = format!(
            "time_us = {}: expected a whole number of microseconds, 0 to {}",
            value.repr()?,
            u64::MAX
        );
        match value.extract() {
            Ok(time) => Ok(Self(time)),
            Err(_) if value.hasattr("__index__")? => Err(PyOverflowError::new_err(wrong)),
            Err(_) => Err(PyTypeError::new_err(wrong)),
        }
    }
}

/// The last frame with a given time, and the time of the last frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepClock {
    given: (u64, u64),
    last: u64,
}

impl StepClock {
    /// Returns the time of the next frame: the given time, if it is not before that of the last frame.
    pub(crate) fn next(&self, number: u64, time_us: Option<u64>) -> PyResult<u64> {
        let (since, from) = self.given;
        let Some(time_us) = time_us else {
            return Ok(from.saturating_add(FrameRate::default().time_us(number - since)));
        };
        if time_us < self.last {
            return Err(PyValueError::new_err(format!(
                "time_us = {time_us} is before the time of the frame before, {}; times never go back, so give the frames in \
                 their order, or call reset() before another clip",
                self.last
            )));
        }
        Ok(time_us)
    }

    /// Returns the time of the first frame of a clip that follows `number` frames, one period of
    /// `rate` after the last of them.
    pub(crate) fn continuation(&self, number: u64, rate: FrameRate) -> u64 {
        match number.checked_sub(1) {
            None => 0,
            // Periods are rounded, so a clip in two runs has the times of one run.
            Some(last) if self.last == rate.time_us(last) => rate.time_us(number),
            Some(_) => self.last.saturating_add(rate.time_us(1)),
        }
    }

    /// Records a frame that was taken. A given time becomes the start from which later times are counted.
    pub(crate) fn take(&mut self, number: u64, time_us: u64) {
        let (since, from) = self.given;
        if time_us != from.saturating_add(FrameRate::default().time_us(number - since)) {
            self.given = (number, time_us);
        }
        self.last = time_us;
    }
}
