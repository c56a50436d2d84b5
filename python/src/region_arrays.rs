// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of all regions of a frame as arrays, which are made when they are first read and own their memory.

use foveate_camera::RegionAction;
use foveate_design::Design;
use foveate_engine::FrameOutcome;
use foveate_pixels::FramePixels;
use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArray};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

/// A frame of pixels as an array that owns its memory.
pub(crate) struct Screen(pub(crate) Py<PyUntypedArray>);

impl Screen {
    /// Returns the pixels of a frame of a design.
    pub(crate) fn of(py: Python<'_>, design: &Design, pixels: FramePixels<'_>) -> Self {
        let size = [design.height() as usize, design.width() as usize];
        Self(match pixels {
            FramePixels::Bytes(pixels) => untyped(py, pixels, size),
            FramePixels::Words(pixels) => untyped(py, pixels, size),
        })
    }
}

fn untyped<T: Element + Copy>(
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

/// Returns a score as arrays have it.
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
