// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist that synthesis makes of the RTL, to be simulated instead of it.
//!
//! It is the netlist that the area estimate counts, of the same Yosys run, under [models](crate::cells) of
//! its cells. Memories start unknown, and so do registers without an initial value, so that an X which
//! the RTL would not show does not hide; registers with one start with it, as on the device.

use crate::cells::{cell_models, wired_wrongly};
use crate::error::CosimError;
use foveate_design::{Array, Design};
use foveate_emit::{Prefix, Top};
use foveate_toolchain::{
    Cache, Source, SynthesisJob, ToolRecord, Toolchain, sources_sha256, yosys,
};
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

/// A netlist as a report describes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetlistRecord {
    /// What made it.
    pub tool: ToolRecord,
    /// SHA-256 of its Verilog and that of its cells.
    pub sha256: String,
}

impl Netlist {
    /// Synthesizes `top` of a design, that of the level, from Verilog for it. At the level of one RPU it is
    /// that of the array of the design, as in the estimate. Names of its modules begin with `prefix`.
    pub(crate) fn of(
        design: &Design,
        top: Top,
        prefix: &Prefix,
        mut verilog: Vec<Source>,
        toolchain: &Toolchain,
        cache: &Cache,
    ) -> Result<Self, CosimError> {
        match design.unit().array {
            Array::Copies => {
                // Verilog of one RPU lacks the array around it, which comes last.
                let array = prefix.apply(foveate_emit::verilog(design, Top::Rcm));
                let array = array.into_iter().next_back().map(Source::from);
                let is_new = |array: &Source| verilog.iter().all(|(name, _)| *name != array.0);
                verilog.extend(array.filter(is_new));
            }
            Array::Whole => {}
        }
        let array = top.array(design);
        let job = SynthesisJob {
            sources: verilog,
            unit: prefix.name(design.unit().module),
            array: prefix.name(array.module()),
            parameters: array.parameters(design),
        };
        let synthesis = job.run(toolchain, cache)?;
        if wired_wrongly(&synthesis.verilog) {
            return Err(CosimError::WiredWrongly { yosys: synthesis.tool.version });
        }
        let library = yosys::cell_models(toolchain, cache, "xilinx/cells_sim.v")?;
        let models = cell_models(&library, synthesis.cells())?;
        let verilog = chosen(&synthesis.verilog);
        let sources = vec![(MODELS_FILE.to_owned(), models), (NETLIST_FILE.to_owned(), verilog)];
        Ok(Self { tool: synthesis.tool, sources })
    }

    /// What a report says of it.
    pub(crate) fn record(&self) -> NetlistRecord {
        let sha256 = sources_sha256(&self.sources);
        NetlistRecord { tool: self.tool.clone(), sha256 }
    }
}

/// The memory of the leaf `raster_valid` in which any bits will do to begin with, if they are bits.
const ANY_BITS: &str = "lost_bits_q.";

/// The netlist with bits in that memory: the leaf makes them of an X in simulation, but a table cannot.
fn chosen(netlist: &str) -> String {
    let mut lines: Vec<String> = netlist.lines().map(str::to_owned).collect();
    let mut begins = 0;
    for at in 0..lines.len() {
        if lines[at].starts_with("  RAM") {
            begins = at;
        }
        if lines[at].starts_with("  ) ") && lines[at].contains(ANY_BITS) {
            for line in lines[begins..at].iter_mut().filter(|line| line.contains(".INIT")) {
                // Not all alike.
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
        assert_eq!(chosen(&text), expected);
    }
}
