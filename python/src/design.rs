// SPDX-License-Identifier: MIT OR Apache-2.0
//! An immutable design, and the table of its registers.

use foveate_design::{DesignConfig, PRESETS};
use foveate_emit::{Register, RegisterField, register_table};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::error::{raise, value_error};
use crate::{commands, config};

/// A validated configuration with the numbers that follow from it. Immutable, hashable, and can be pickled.
///
/// Parameters
/// ----------
/// config : str, path, dict, Design or Camera, optional
///     The name of a preset (`foveate.presets()`), a TOML file, a dict of its tables, or an object with a
///     configuration. The default is the paper's design.
/// frame, region, denoise, decision, temporal, render, periphery, zones, hardware : dict, optional
///     Keys to change, as in the file: `region={"size": 16}`.
/// spatial : str, dict or list of these, optional
///     The features: `"mad"`, `{"feature": "edge", "level": 50}`, or a list.
///
/// Attributes
/// ----------
/// width, height : int
///     Size of a frame in pixels.
/// pixel_bits : int
///     Bits per pixel, 1 to 16.
/// region_size : int
///     Side of a region in pixels, 2 to 64.
/// columns, rows, regions : int
///     Number of columns and rows of regions, and of all regions.
/// features : tuple of str
///     Names of the spatial features.
/// organization : str
///     Organization of the hardware: "pipelined", "serial" or "raster".
/// cycles_per_frame : int
///     Clocks from one frame to the next.
/// fingerprint : str
///     16 hexadecimal digits, which are equal for equal configurations.
///
/// Raises
/// ------
/// ValueError
///     If the design is not valid. The message names the key, its value, and a right value.
/// FileNotFoundError
///     If a file does not exist.
#[pyclass(frozen, eq, hash, module = "foveate")]
#[derive(Clone, Debug)]
pub(crate) struct Design {
    inner: foveate_design::Design,
    /// The given configuration. If it has no frame size, a camera takes the size of its frames.
    written: DesignConfig,
}

impl PartialEq for Design {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl std::hash::Hash for Design {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.inner.fingerprint().hash(state);
    }
}

impl From<foveate_design::Design> for Design {
    fn from(inner: foveate_design::Design) -> Self {
        Self { written: inner.config().clone(), inner }
    }
}

impl Design {
    pub(crate) fn new(written: DesignConfig) -> PyResult<Self> {
        Ok(Self { inner: written.validate().map_err(raise)?, written })
    }

    pub(crate) fn config(&self) -> &DesignConfig {
        &self.written
    }

    pub(crate) fn inner(&self) -> &foveate_design::Design {
        &self.inner
    }
}

#[pymethods]
impl Design {
    #[new]
    #[pyo3(
        signature = (config=None, /, **sections),
        text_signature = "(config=None, /, *, frame=None, region=None, denoise=None, spatial=None, decision=None, \
                          temporal=None, render=None, periphery=None, zones=None, hardware=None)"
    )]
    fn made(
        config: Option<&Bound<'_, PyAny>>,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        Self::new(config::read(config, sections)?)
    }

    /// Width of a frame in pixels.
    #[getter]
    fn width(&self) -> u32 {
        self.inner.width()
    }

    /// Height of a frame in pixels.
    #[getter]
    fn height(&self) -> u32 {
        self.inner.height()
    }

    /// Bits per pixel.
    #[getter]
    fn pixel_bits(&self) -> u32 {
        self.inner.pixel_bits()
    }

    /// Side of a region in pixels.
    #[getter]
    fn region_size(&self) -> u32 {
        self.inner.region_size()
    }

    /// Number of columns of regions.
    #[getter]
    fn columns(&self) -> u32 {
        self.inner.columns()
    }

    /// Number of rows of regions.
    #[getter]
    fn rows(&self) -> u32 {
        self.inner.rows()
    }

    /// Number of regions of a frame.
    #[getter]
    fn regions(&self) -> u32 {
        self.inner.regions()
    }

    /// Names of the spatial features.
    #[getter]
    fn features<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let names = self.inner.features().iter().map(|feature| feature.kind().to_string());
        PyTuple::new(py, names.collect::<Vec<_>>())
    }

    /// Organization of the hardware: "pipelined", "serial" or "raster".
    #[getter]
    fn organization(&self) -> &'static str {
        self.inner.organization().name()
    }

    /// Clocks from one frame to the next.
    #[getter]
    fn cycles_per_frame(&self) -> u64 {
        self.inner.timing().clocks_per_frame()
    }

    /// 16 hexadecimal digits, which are equal for equal configurations.
    #[getter]
    fn fingerprint(&self) -> String {
        self.inner.fingerprint()
    }

    /// The configuration as a TOML file, every key filled in.
    fn toml(&self) -> String {
        self.inner.config().to_toml()
    }

    fn __repr__(&self) -> String {
        format!("<foveate.Design {}>", in_words(&self.inner))
    }

    /// Shows the design in a notebook.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("foveate._show")?.call_method1("design_card", (slf,))
    }

    /// Write the Verilog of the design to a folder; see `foveate.generate`.
    #[pyo3(signature = (folder, *, force=false, prefix=None))]
    fn generate<'py>(
        slf: &Bound<'py, Self>,
        folder: &Bound<'py, PyAny>,
        force: bool,
        prefix: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        commands::generate_of(slf, folder, force, prefix)
    }

    /// Estimate area and logic levels of the design; see `foveate.estimate`.
    fn estimate<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        commands::estimate_of(slf)
    }

    /// List the registers of a core of this design on AXI.
    ///
    /// Returns
    /// -------
    /// tuple of Register
    ///     By address: `name`, `address` in bytes, `doc`, and `fields`, each with `name`, `low` (its lowest bit), `width`,
    ///     `access` ("read", "read, write", "write 1" or "read, write 1 to clear"), `reset` (its value after a reset; None if
    ///     it depends on the state of the core) and `doc`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the design is not on AXI: it needs `hardware={"interface": "axi"}`.
    fn registers<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        registers_of(slf.py(), slf.get())
    }

    #[classmethod]
    fn _from_toml(_class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        Self::new(DesignConfig::from_toml(text).map_err(raise)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("_from_toml")?, (slf.get().written.to_toml(),)))
    }
}

/// Return the presets: a dict of their names and purposes.
#[pyfunction]
pub(crate) fn presets(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let found = PyDict::new(py);
    for preset in PRESETS {
        found.set_item(preset.name, preset.summary)?;
    }
    Ok(found)
}

/// Describes a design in one line.
pub(crate) fn in_words(design: &foveate_design::Design) -> String {
    let features: Vec<String> =
        design.features().iter().map(|feature| feature.kind().to_string()).collect();
    format!(
        "{} {}x{} pixels of {} bits, {}x{} regions of {n}x{n}, {}, reference {}, {}",
        design.fingerprint(),
        design.width(),
        design.height(),
        design.pixel_bits(),
        design.columns(),
        design.rows(),
        features.join(" + "),
        design.temporal().reference.name(),
        design.config().hardware.description(),
        n = design.region_size(),
    )
}

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
