// SPDX-License-Identifier: MIT OR Apache-2.0
//! One module per sub-command.

use foveate_spec::{Design, PipelinedTiming, SpecError};

pub(crate) mod analyze;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod cosim;
pub(crate) mod dataset;
pub(crate) mod estimate;
pub(crate) mod explain;
pub(crate) mod generate;
pub(crate) mod presets;
pub(crate) mod simulate;

/// The timing of the only organization that there is Verilog for.
fn pipelined(design: &Design) -> Result<PipelinedTiming, SpecError> {
    design.pipelined_timing("the Verilog")
}
