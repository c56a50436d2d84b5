// SPDX-License-Identifier: MIT OR Apache-2.0
//! The simulation models of the cells of a netlist: those of Yosys, or our own where Yosys has
//! none.
//!
//! Our models are for block RAM and DSP, and only for the modes that Yosys uses for a design. Any
//! other mode is refused when the netlist is compiled.

use crate::error::CosimError;
use crate::harness::render;
use askama::Template;
use foveate_tools::yosys;

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
