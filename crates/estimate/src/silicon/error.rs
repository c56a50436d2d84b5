// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a mapping to cells.

use std::io;
use std::path::PathBuf;

use foveate_tools::ToolError;
use thiserror::Error;

use crate::EstimateError;

/// An error of a mapping to the cells of a library.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum SiliconError {
    /// An external tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// A file cannot be read.
    #[error("cannot read the library `{}`: {source}", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    /// A file is not a liberty file.
    #[error("`{}` is not a liberty file that can be read, line {line}: {problem}", path.display())]
    Liberty { path: PathBuf, line: usize, problem: String },
    /// A library has no cells.
    #[error("the library `{}` has no cell; give the file of standard cells of a process", path.display())]
    NoCells { path: PathBuf },
    /// A library lacks a cell without which no figure is possible.
    #[error(
        "the library `{library}` has no {missing}; give the file of standard cells of a process"
    )]
    MissingCell { library: String, missing: &'static str },
    /// A file of macros has no memory.
    #[error("`{}` has no memory with an area, `address_width` and `word_width`; give liberty files of memories to --macros", path.display())]
    NoMemory { path: PathBuf },
    /// Cells and memories have different voltages, or one voltage is not known.
    #[error(
        "`{first}` is for {first_voltage} and `{second}` for {second_voltage}; figures of different voltages cannot be added, so give files of one corner"
    )]
    Voltages { first: String, first_voltage: String, second: String, second_voltage: String },
    /// The netlist has cells that the library does not have.
    #[error(
        "module `{module}` has {count} cells `{cell}` that were not mapped to the library `{library}`; it may lack a flip-flop or a latch of that kind"
    )]
    Unmapped { module: String, cell: String, count: u64, library: String },
    /// A cell of the netlist has no area.
    #[error("the cell `{cell}` of the library `{library}` has no area, so no sum can be given")]
    NoArea { cell: String, library: String },
    /// A cell cannot be simulated, or its energy is not known.
    #[error("the cell `{cell}` of the library `{library}` cannot be simulated: {problem}")]
    CellModel { cell: String, library: String, problem: String },
    /// A library does not say for which voltage it is.
    #[error(
        "the library `{library}` has no nominal voltage, so no energy can be given; add `nom_voltage : VOLTS;` to it"
    )]
    NoVoltage { library: String },
    /// The unit of capacitances is not known.
    #[error(
        "the library `{library}` has capacitances in a unit of `{unit}`; `capacitive_load_unit` takes a number and `pf` or `ff`"
    )]
    LoadUnit { library: String, unit: String },
    /// A netlist for a simulator would lack the words of a memory.
    #[error(
        "a memory of {bits} bits is above the limit of {limit}, so the netlist would lack it; give --memory-limit {bits}"
    )]
    MemoryTooLarge { bits: u64, limit: u64 },
    /// A module is not in the netlist, or the netlist cannot be read.
    #[error("the netlist of Yosys cannot be used: {reason}; its format may have changed")]
    Netlist { reason: String },
    /// OpenSTA has printed an error, or its report lacks a figure.
    #[error("OpenSTA cannot time the netlist: {reason}")]
    Timing { reason: String },
}

impl From<EstimateError> for SiliconError {
    /// Makes an error of a netlist that cannot be used.
    fn from(error: EstimateError) -> Self {
        Self::Netlist { reason: error.to_string() }
    }
}
