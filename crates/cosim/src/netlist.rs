// SPDX-License-Identifier: MIT OR Apache-2.0
//! What synthesis makes of the RTL, to be simulated in its place.
//!
//! It is the netlist that the area estimate counts, of the same Yosys run, under Yosys' own models of
//! the cells. Memories start unknown, and so do registers without an initial value, so that an X which
//! the RTL would not show does not hide; registers with one start with it, as on the device.

use crate::error::CosimError;
use crate::job::Job;
use foveate_emit::Top;
use foveate_estimate::{EstimateJob, ToolRecord, sources};
use foveate_toolchain::{Cache, Source, Toolchain, sources_sha256, yosys};
use serde::{Deserialize, Serialize};

/// The netlist itself, as a file.
const NETLIST_FILE: &str = "netlist/netlist.v";
/// The models of its cells.
const MODELS_FILE: &str = "netlist/cells.v";

/// A synthesized design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Netlist {
    /// What made it.
    pub tool: ToolRecord,
    /// Its Verilog and that of its cells.
    pub sources: Vec<Source>,
}

/// What a report says of a netlist.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetlistRecord {
    /// What made it.
    pub tool: ToolRecord,
    /// SHA-256 of its Verilog and that of its cells.
    pub sha256: String,
}

impl Netlist {
    /// Synthesizes what a job would simulate. At the level of one RPU it is that of the array of the
    /// design, as in the estimate.
    ///
    /// # Errors
    /// When Yosys is missing or refuses the Verilog, or a cell has no model.
    pub fn of(job: &Job, toolchain: &Toolchain, cache: &Cache) -> Result<Self, CosimError> {
        let design = job.stimulus.level.design(&job.design)?;
        let top = job.stimulus.level.top();
        let mut verilog = job.named_sources();
        if design.unit().rpu_in_rcm {
            // Verilog of one RPU lacks the array around it, which comes last.
            let array = sources(foveate_emit::verilog(&design, Top::Rcm)).pop();
            let is_new = |array: &Source| verilog.iter().all(|(name, _)| *name != array.0);
            verilog.extend(array.filter(is_new));
        }
        let synthesis =
            EstimateJob::with_sources(&design, top, verilog).synthesize(toolchain, cache)?;
        let library = yosys::cell_models(toolchain, cache, "xilinx/cells_sim.v")?;
        let models = models(&library, synthesis.cells()?)?;
        let sources =
            vec![(MODELS_FILE.to_owned(), models), (NETLIST_FILE.to_owned(), synthesis.verilog)];
        Ok(Self { tool: synthesis.tool, sources })
    }

    /// What a report says of it.
    pub(crate) fn record(&self) -> NetlistRecord {
        let sha256 = sources_sha256(&self.sources);
        NetlistRecord { tool: self.tool.clone(), sha256 }
    }
}

/// Of a library the models of these cells.
fn models(library: &str, cells: impl IntoIterator<Item = String>) -> Result<String, CosimError> {
    let mut text = "// Models of cells, from the library of Yosys (ISC license).\n".to_owned();
    for cell in cells {
        let begins = |line: &str| {
            let rest = line.strip_prefix("module ").and_then(|rest| rest.strip_prefix(&cell));
            rest.is_some_and(|rest| {
                rest.trim_start().starts_with(['(', '#', ';']) || rest.is_empty()
            })
        };
        let mut lines = library.lines().skip_while(|line| !begins(line)).peekable();
        if lines.peek().is_none() {
            return Err(CosimError::NoModel { cell });
        }
        text.push('\n');
        for line in lines {
            text += line;
            text.push('\n');
            if line.starts_with("endmodule") {
                break;
            }
        }
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIBRARY: &str = "module INV(\n  output O);\nendmodule\n(* x *)\nmodule LUT1(output O);\nendmodule // LUT1\nmodule X; endmodule\n";

    #[test]
    fn models_are_found_by_name() {
        let text = models(LIBRARY, ["LUT1".to_owned()]).unwrap();
        assert!(text.ends_with("\nmodule LUT1(output O);\nendmodule // LUT1\n"), "{text}");
        assert!(!text.contains("INV"));
    }

    #[test]
    fn a_cell_without_a_model_is_named() {
        let error = models(LIBRARY, ["INV".to_owned(), "LUT".to_owned()]).unwrap_err().to_string();
        assert!(error.contains("`LUT`"), "{error}");
    }
}
