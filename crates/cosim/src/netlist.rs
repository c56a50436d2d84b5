// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist that synthesis makes of the RTL, which is simulated instead of it.
//!
//! It is the netlist that the area estimate counts, of the same Yosys run, with
//! [models](crate::cells) of its cells. Memories start unknown, and so do registers without an
//! initial value, so that an X shows even where the RTL would not have one. Registers with an
//! initial value start with it, as on the device.

use crate::cells::{cell_models, has_miswired_block_ram};
use crate::error::CosimError;
use foveate_design::{ArrayStructure, Design};
use foveate_emit::{Prefix, Top};
use foveate_tools::{Cache, Source, SynthesisJob, ToolRecord, Toolchain, sources_sha256, yosys};
use serde::{Deserialize, Serialize};

const NETLIST_FILE: &str = "netlist/netlist.v";
const MODELS_FILE: &str = "netlist/cells.v";

/// A synthesized design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Netlist {
    /// The tool that made the netlist.
    pub tool: ToolRecord,
    /// The Verilog of the netlist and of its cells.
    pub sources: Vec<Source>,
}

/// The description of a netlist in a report.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetlistRecord {
    /// The tool that made the netlist.
    pub tool: ToolRecord,
    /// The SHA-256 of the Verilog of the netlist and of its cells.
    pub sha256: String,
}

impl Netlist {
    /// Synthesizes `top` of the design at a level, from Verilog for it. At the level of one RPU the
    /// netlist is that of the design's array, as in the estimate. Module names begin with `prefix`.
    pub(crate) fn synthesize(
        design: &Design,
        top: Top,
        prefix: &Prefix,
        mut verilog: Vec<Source>,
        toolchain: &Toolchain,
        cache: &Cache,
    ) -> Result<Self, CosimError> {
        match design.unit().array {
            ArrayStructure::RpuCopies => {
                // The Verilog of one RPU lacks the array around it, which comes last.
                let array = prefix.apply(foveate_emit::verilog(design, Top::Rcm));
                let array = array.into_iter().next_back().map(Source::from);
                let is_new = |array: &Source| verilog.iter().all(|(name, _)| *name != array.0);
                verilog.extend(array.filter(is_new));
            }
            ArrayStructure::SharedLogic => {}
        }
        let array = top.array_top(design);
        let job = SynthesisJob {
            sources: verilog,
            unit: prefix.prefixed_name(design.unit().module),
            array: prefix.prefixed_name(array.module()),
            parameters: array.parameters(design),
        };
        let synthesis = job.run(toolchain, cache)?;
        if has_miswired_block_ram(&synthesis.verilog) {
            return Err(CosimError::MiswiredBlockRam { yosys: synthesis.tool.version });
        }
        let library = yosys::cell_models(toolchain, cache, "xilinx/cells_sim.v")?;
        let models = cell_models(&library, synthesis.cell_types())?;
        let verilog = with_initial_bits(&synthesis.verilog);
        let sources = vec![(MODELS_FILE.to_owned(), models), (NETLIST_FILE.to_owned(), verilog)];
        Ok(Self { tool: synthesis.tool, sources })
    }

    /// Returns the description of the netlist for a report.
    pub(crate) fn to_record(&self) -> NetlistRecord {
        let sha256 = sources_sha256(&self.sources);
        NetlistRecord { tool: self.tool.clone(), sha256 }
    }
}

/// The memory of the leaf `raster_valid` that may start with any bits, but not with X.
const MEMORY_WITH_ANY_BITS: &str = "lost_bits_q.";

/// Returns the netlist with fixed initial bits in that memory. In a simulation the leaf turns an X
/// into bits, but a lookup table cannot.
fn with_initial_bits(netlist: &str) -> String {
    let mut lines: Vec<String> = netlist.lines().map(str::to_owned).collect();
    let mut begins = 0;
    for at in 0..lines.len() {
        if lines[at].starts_with("  RAM") {
            begins = at;
        }
        if lines[at].starts_with("  ) ") && lines[at].contains(MEMORY_WITH_ANY_BITS) {
            for line in lines[begins..at].iter_mut().filter(|line| line.contains(".INIT")) {
                // The bits must not be all equal.
                *line = line.replace("xx", "59").replace('x', "0");
            }
        }
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_memory_begins_with_bits() {
        let cell = |name: &str, init: &str| {
            format!("  RAM32M16 #(\n    .INIT_A(64'h{init})\n  ) \\{name}.0.0  (\n  );\n")
        };
        let text = [cell("a.words_q", "xxxx"), cell("a.lost_bits_q", "xxxx")].concat();
        let expected = [cell("a.words_q", "xxxx"), cell("a.lost_bits_q", "5959")].concat();
        assert_eq!(with_initial_bits(&text), expected);
    }
}
