// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of region events, column by column, as `events.parquet` has it.

use std::sync::Arc;

use foveate_engine::{EventColumnType, EventFrame, EventTable, EventValue};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::outcome::{FrameRecord, Outcome};

/// The values of a column.
enum Values {
    Long(Vec<i64>),
    Int(Vec<i32>),
    Flag(Vec<bool>),
    /// Numbers of texts, and the texts that they stand for.
    Text(Vec<u8>, Vec<&'static str>),
}

impl Values {
    fn of(kind: EventColumnType) -> Self {
        match kind {
            EventColumnType::Long => Self::Long(Vec::new()),
            EventColumnType::Int => Self::Int(Vec::new()),
            EventColumnType::Flag => Self::Flag(Vec::new()),
            EventColumnType::Text => Self::Text(Vec::new(), Vec::new()),
        }
    }

    fn push(&mut self, value: EventValue) {
        match (self, value) {
            (Self::Long(values), EventValue::Long(value)) => values.push(value),
            (Self::Int(values), EventValue::Int(value)) => values.push(value),
            (Self::Flag(values), EventValue::Flag(value)) => values.push(value),
            (Self::Text(values, texts), EventValue::Text(value)) => {
                let known = texts.iter().position(|&text| text == value);
                let number = known.unwrap_or_else(|| {
                    texts.push(value);
                    texts.len() - 1
                });
                values.push(u8::try_from(number).expect("there are three actions"));
            }
            (_, value) => unreachable!("{value:?} is not of its column's kind"),
        }
    }

    /// Returns a column as an array; a column of texts as their numbers and the texts.
    fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(match self {
            Self::Long(values) => values.into_pyarray(py).into_any(),
            Self::Int(values) => values.into_pyarray(py).into_any(),
            Self::Flag(values) => PyArray1::from_vec(py, values).into_any(),
            Self::Text(values, texts) => {
                let parts =
                    [values.into_pyarray(py).into_any(), PyTuple::new(py, texts)?.into_any()];
                PyTuple::new(py, parts)?.into_any()
            }
        })
    }
}

/// Returns the columns of the table by name.
#[pyfunction]
pub(crate) fn event_columns<'py>(
    outcomes: &Bound<'py, PyAny>,
    only_active: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let py = outcomes.py();
    let mut table: Option<(Arc<foveate_design::Design>, EventTable, Vec<Values>)> = None;
    for outcome in outcomes.try_iter()? {
        let outcome = outcome?;
        let outcome = outcome.cast::<Outcome>().map_err(|_| {
            PyTypeError::new_err("events are made of outcomes, those of Camera.step or simulate")
        })?;
        let record = outcome.get().record();
        let (design, rows, values) = table.get_or_insert_with(|| {
            let rows = EventTable::new(&record.design, only_active);
            let values =
                rows.columns().iter().map(|column| Values::of(column.value_type)).collect();
            (Arc::clone(&record.design), rows, values)
        });
        if **design != *record.design {
            return Err(PyValueError::new_err(format!(
                "the outcomes are of two designs, {} and {}; make a table of each",
                design.fingerprint(),
                record.design.fingerprint()
            )));
        }
        let FrameRecord { result: outcome, number, time_us, .. } = record;
        let moment =
            EventFrame { camera: design.camera(), number: *number, time_us: *time_us, outcome };
        rows.rows(&moment, |row| {
            values.iter_mut().zip(row).for_each(|(own, value)| own.push(value));
        });
    }
    let Some((_, rows, values)) = table else {
        return Err(PyValueError::new_err(
            "there are no outcomes; a table needs at least one, to know its columns",
        ));
    };
    let found = PyDict::new(py);
    for (column, values) in rows.columns().iter().zip(values) {
        found.set_item(&column.name, values.into_python(py)?)?;
    }
    Ok(found)
}
