// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registers of a core on AXI, as the table of `foveate._registers`.

use foveate_emit::{Register, RegisterField, register_table};
use pyo3::prelude::*;

use crate::design::Design;
use crate::error::value_error;

/// A field of a register: name, lowest bit, width, access, value after a reset, and description.
type FieldRow = (String, u32, u32, &'static str, Option<u32>, String);
/// A register: name, address, description, and fields.
type Row = (String, u32, String, Vec<FieldRow>);

fn field(own: RegisterField) -> FieldRow {
    let RegisterField { name, low, width, kind, doc } = own;
    (name, low, width, kind.access(), kind.reset(), doc)
}

fn row(own: Register) -> Row {
    let Register { name, address, fields, doc } = own;
    (name, address, doc, fields.into_iter().map(field).collect())
}

/// Returns the table of a design's registers, or the reason why it has none.
pub(crate) fn registers_of<'py>(py: Python<'py>, design: &Design) -> PyResult<Bound<'py, PyAny>> {
    let inner = design.inner();
    let Some(table) = register_table(inner) else {
        return Err(value_error(format!(
            "design {} has no registers, because it is not on AXI: organization `{}`, interface \
             `{}`; only designs with hardware.organization = 'raster' and hardware.interface = \
             'axi' have registers",
            inner.fingerprint(),
            inner.organization().name(),
            inner.interface_kind().name(),
        )));
    };
    let rows: Vec<Row> = table.into_iter().map(row).collect();
    py.import("foveate._registers")?.call_method1("table", (rows,))
}
