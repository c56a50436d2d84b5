// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist that synthesis makes of the RTL ([`Netlist`]), which is simulated instead of it
//! with models of its cells.
//!
//! It is the netlist that the area estimate counts, of the same Yosys run. Memories start
//! unknown, and so do registers without an initial value, so that an X shows even where the RTL
//! would not have one. Registers with an initial value start with it, as on the device.
//!
//! The models ([`cell_models`]) are those of Yosys, or our own where Yosys has none: for block
//! RAM and DSP, and only for the modes that Yosys uses for a design. Any other mode is refused
//! when the netlist is compiled.

use crate::error::CosimError;
use crate::harness::render;
use askama::Template;
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

/// The text of the model of a DSP slice that multiplies.
const DSP_MODEL: &str = include_str!("../tb/cells/dsp48e2.v");

/// A block RAM with one port for reads and one for writes, or with one port for both.
#[derive(Template)]
#[template(path = "cells/block_ram.v")]
struct BlockRam {
    name: &'static str,
    address_bits: u32,
    /// The number of bytes of the widest word of one port; each byte has a parity bit.
    bytes: u32,
    /// The names of the parameters with the initial contents.
    contents: Vec<String>,
}

impl BlockRam {
    /// Creates a block RAM with 2^`address_bits` data bits.
    fn new(name: &'static str, address_bits: u32, bytes: u32) -> Self {
        let slices = (1 << address_bits) / 256;
        let parity = (0..slices / 8).map(|slice| format!("INITP_{slice:02X}"));
        let contents = parity.chain((0..slices).map(|slice| format!("INIT_{slice:02X}"))).collect();
        Self { name, address_bits, bytes, contents }
    }
}

/// Returns our model of a cell, if there is one.
fn own_model(cell: &str) -> Option<String> {
    match cell {
        "DSP48E2" => Some(DSP_MODEL.to_owned()),
        "RAMB18E2" => Some(render(&BlockRam::new("RAMB18E2", 14, 2))),
        "RAMB36E2" => Some(render(&BlockRam::new("RAMB36E2", 15, 4))),
        _ => None,
    }
}

/// Returns the models of the cells, one after the other. `library` is the text of Yosys' models.
///
/// # Errors
/// Fails if a cell has no model.
pub fn cell_models(
    library: &str,
    cells: impl IntoIterator<Item = String>,
) -> Result<String, CosimError> {
    let mut text = "// Models of cells: those of Yosys (ISC license), and Foveate's.\n".to_owned();
    for cell in cells {
        let model = own_model(&cell).or_else(|| yosys::module_text(library, &cell));
        text.push('\n');
        text += &model.ok_or(CosimError::NoModel { cell })?;
    }
    Ok(text)
}

/// Returns true if a block RAM of this netlist has the upper half of a word's parity bits wired to
/// those of the lower half. Yosys did so before April 2026 if a word has more than 36 bits:
/// <https://github.com/YosysHQ/yosys/pull/5833>. Some of these bits hold data.
#[must_use]
pub fn has_miswired_block_ram(netlist: &str) -> bool {
    let port = |cell: &str, name: &str| {
        cell.lines().find_map(|line| line.trim().strip_prefix(name).map(str::to_owned))
    };
    let rams = netlist.split("  RAMB36E2 #(").skip(1);
    rams.filter_map(|text| text.split("\n  );").next()).any(|cell| {
        let is_wide = cell.contains(".WRITE_WIDTH_B(32'd72)");
        is_wide && port(cell, ".DINPADINP") == port(cell, ".DINPBDINP")
    })
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

    const LIBRARY: &str = "module INV(\n  output O);\nendmodule\n(* x *)\nmodule LUT1(output O);\nendmodule // LUT1\nmodule X; endmodule\n";

    #[test]
    fn models_are_found_by_name() {
        let text = cell_models(LIBRARY, ["LUT1".to_owned()]).unwrap();
        assert!(text.ends_with("\nmodule LUT1(output O);\nendmodule // LUT1\n"), "{text}");
        assert!(!text.contains("INV"));
        let text = cell_models(LIBRARY, ["RAMB36E2".to_owned()]).unwrap();
        assert!(text.contains("module RAMB36E2 #(") && text.contains("INIT_7F = 0\n"), "{text}");
    }

    #[test]
    fn a_cell_without_a_model_is_named() {
        let cells = ["INV".to_owned(), "LUT".to_owned()];
        let error = cell_models(LIBRARY, cells).unwrap_err().to_string();
        assert!(error.contains("`LUT`"), "{error}");
    }
}
