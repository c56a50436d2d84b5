// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area, timing and leakage of a design in the cells of a process.
//!
//! Yosys maps the Verilog to the cells of a liberty file, and OpenSTA times the netlist. The files
//! are the user's own: those of open processes, or of a foundry.

mod cell_model;
mod cell_totals;
mod error;
mod gate_netlist;
mod job;
mod leaves;
mod liberty_text;
mod library;
mod logic_function;
mod lookup_table;
mod mapping;
mod net_names;
mod report;
mod timing;
mod unit_instances;

pub use cell_model::{
    CellModel, CellModels, CellPin, FlipFlopState, InternalEnergy, OutputTransition, TimingSense,
};
pub use cell_totals::CellTotals;
pub use error::SiliconError;
pub use gate_netlist::{FlatNetlist, HIGH_NET, LOW_NET, NetlistGate, gate_netlist, map_unit};
pub use job::{SiliconJob, check_libraries, map_to_silicon};
pub use leaves::SiliconLeaf;
pub use library::LibertyLibrary;
pub use logic_function::LogicFunction;
pub use lookup_table::LookupTable;
pub use mapping::{MacroChoice, MemoryFigures};
pub use report::{
    LibraryFigures, MemoryTotals, NOT_INCLUDED, SILICON_FORMAT_VERSION, SiliconReport, UnitFigures,
};
pub use timing::SiliconPath;
