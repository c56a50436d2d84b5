// SPDX-License-Identifier: MIT OR Apache-2.0
//! Logic levels of the longest path, counted in the synthesized netlist.
//!
//! A path goes from a register, a memory or an input port to a register, a memory or an output port.
//! On its way a LUT is a level, an asynchronous read of distributed RAM is one, a multiplication
//! without registers is one, and a carry chain is one, however long: its blocks of four bits are
//! counted apart, because a block costs a fraction of a LUT. Multiplexers behind LUTs (MUXF7..9)
//! belong to their LUTs. Modules that were kept apart are entered, so that paths cross them.
//!
//! There are no nanoseconds in it: wires are most of the delay, and only placement knows them.

mod cell;
mod graph;
mod path;
mod raw;
mod search;

use crate::error::EstimateError;
use graph::Graph;
pub use path::LogicPath;
use raw::RawNetlist;

/// The longest path of each of the `tops`, with all modules inside them.
///
/// # Errors
/// When the netlist is not understood, a module is missing, or logic runs in a circle.
pub(crate) fn longest_paths(
    file: &'static str,
    json: &[u8],
    tops: &[&str],
) -> Result<Vec<LogicPath>, EstimateError> {
    let netlist: RawNetlist =
        serde_json::from_slice(json).map_err(|source| EstimateError::Format { file, source })?;
    tops.iter().map(|top| search::longest(&Graph::of(&netlist, top)?)).collect()
}

#[cfg(test)]
mod tests;
