// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a mapping to cells.

use std::io;
use std::path::PathBuf;

use foveate_toolchain::ToolError;
use thiserror::Error;

use crate::EstimateError;

/// An error of a mapping to the cells of a library.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SiliconError {
    /// An external tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// A file cannot be read.
    #[error("cannot read the library `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system or of the decompression.
        source: io::Error,
    },
    /// A file is not a liberty file.
    #[error("`{}` is not a liberty file that can be read, line {line}: {problem}", path.display())]
    Liberty {
        /// The file.
        path: PathBuf,
        /// The line of the fault, from 1 on.
        line: usize,
        /// The fault.
        problem: String,
    },
    /// A library has no cells.
    #[error("the library `{}` has no cell; give the file of standard cells of a process", path.display())]
    NoCells {
        /// The file.
        path: PathBuf,
    },
    /// A library lacks a cell without which no figure is possible.
    #[error(
        "the library `{library}` has no {missing}; give the file of standard cells of a process"
    )]
    MissingCell {
        /// The name of the library.
        library: String,
        /// The kind of the cell.
        missing: &'static str,
    },
    /// A file of macros has no memory.
    #[error("`{}` has no memory with an area, `address_width` and `word_width`; give liberty files of memories to --macros", path.display())]
    NoMemory {
        /// The file.
        path: PathBuf,
    },
    /// Cells and memories have different voltages, or one voltage is not known.
    #[error(
        "`{first}` is for {first_voltage} and `{second}` for {second_voltage}; figures of different voltages cannot be added, so give files of one corner"
    )]
    Voltages {
        /// A library.
        first: String,
        /// Its voltage.
        first_voltage: String,
        /// Another library.
        second: String,
        /// Its voltage.
        second_voltage: String,
    },
    /// The netlist has cells that the library does not have.
    #[error(
        "module `{module}` has {count} cells `{cell}` that were not mapped to the library `{library}`; it may lack a flip-flop or a latch of that kind"
    )]
    Unmapped {
        /// The module.
        module: String,
        /// The type of the cells.
        cell: String,
        /// Their number.
        count: u64,
        /// The name of the library.
        library: String,
    },
    /// A cell of the netlist has no area.
    #[error("the cell `{cell}` of the library `{library}` has no area, so no sum can be given")]
    NoArea {
        /// The cell.
        cell: String,
        /// The name of the library.
        library: String,
    },
    /// A cell cannot be simulated, or its energy is not known.
    #[error("the cell `{cell}` of the library `{library}` cannot be simulated: {problem}")]
    CellModel {
        /// The cell.
        cell: String,
        /// The name of the library.
        library: String,
        /// The reason.
        problem: String,
    },
    /// A library does not say for which voltage it is.
    #[error(
        "the library `{library}` has no nominal voltage, so no energy can be given; add `nom_voltage : VOLTS;` to it"
    )]
    NoVoltage {
        /// The name of the library.
        library: String,
    },
    /// The unit of capacitances is not known.
    #[error(
        "the library `{library}` has capacitances in a unit of `{unit}`; `capacitive_load_unit` takes a number and `pf` or `ff`"
    )]
    LoadUnit {
        /// The name of the library.
        library: String,
        /// The unit.
        unit: String,
    },
    /// A netlist for a simulator would lack the words of a memory.
    #[error(
        "a memory of {bits} bits is above the limit of {limit}, so the netlist would lack it; give --memory-limit {bits}"
    )]
    MemoryTooLarge {
        /// The bits of the largest memory.
        bits: u64,
        /// The largest memory that becomes flip-flops.
        limit: u64,
    },
    /// A module is not in the netlist, or the netlist cannot be read.
    #[error("the netlist of Yosys cannot be used: {reason}; its format may have changed")]
    Netlist {
        /// The reason.
        reason: String,
    },
    /// OpenSTA has printed an error, or its report lacks a figure.
    #[error("OpenSTA cannot time the netlist: {reason}")]
    Timing {
        /// The message of OpenSTA, or what its report lacks.
        reason: String,
    },
}

impl From<EstimateError> for SiliconError {
    /// Makes an error of a netlist that cannot be used.
    fn from(error: EstimateError) -> Self {
        Self::Netlist { reason: error.to_string() }
    }
}
