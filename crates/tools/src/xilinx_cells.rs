// SPDX-License-Identifier: MIT OR Apache-2.0
//! A reduced library of Xilinx cells for Yosys. The full library declares the ports of cells that
//! Yosys does not model; the reduced library omits the cells that no core can have.
//!
//! `synth_xilinx` begins with the ports of 328 cells, from pads to processors, and carries them
//! through all of its steps. Its rules for `UltraScale+` use four of them. Without the others, a
//! small core is synthesized in two thirds of the time.
//!
//! The netlist stays the same. Yosys orders nets by the numbers that names get when they are first
//! read, so all names of the file are read before the four cells.

use std::collections::HashSet;
use std::fs;

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::source_files;
use crate::tool::Tool;
use crate::toolchain::Toolchain;
use crate::yosys;

/// The file of the cells in the library of Yosys.
const LIBRARY: &str = "xilinx/cells_xtra.v";
/// The cells that the rules use: block RAM, `UltraRAM` and DSP blocks.
const USED_CELLS: [&str; 4] = ["RAMB18E2", "RAMB36E2", "URAM288", "DSP48E2"];
/// The keywords of Verilog in the file, which are not names.
const KEYWORDS: [&str; 8] =
    ["module", "endmodule", "parameter", "input", "output", "inout", "integer", "real"];
const REDUCED_FILE: &str = "cells.v";

/// Returns the Verilog of the cells, to be read in place of the file. Returns `None` if the library
/// of this Yosys cannot be read or has another form.
///
/// # Errors
/// Fails if Yosys is missing or the cache cannot be used.
pub(crate) fn reduced_cell_library(
    toolchain: &Toolchain,
    cache: &Cache,
) -> Result<Option<String>, ToolError> {
    let key = CacheKey::builder("cells")
        .field("version", toolchain.find(Tool::Yosys)?.identity())
        .field("file", LIBRARY)
        .list("cells", &USED_CELLS)
        .finish();
    let entry = cache.get_or_build(&key, REDUCED_FILE, |dir| {
        let library = match yosys::cell_models(toolchain, cache, LIBRARY) {
            Err(ToolError::Io { .. }) => String::new(),
            found => found?,
        };
        source_files::write_file(
            dir,
            REDUCED_FILE,
            used_part(&library).unwrap_or_default().as_bytes(),
        )
    })?;
    let text = fs::read_to_string(&entry).map_err(ToolError::io("read", &entry))?;
    Ok((!text.is_empty()).then_some(text))
}

/// Returns the reduced library: first every name of the file, as attributes of an empty module,
/// because Yosys orders nets by the first occurrence of names; then the cells that the rules use.
/// Returns `None` if the library lacks one of these cells.
fn used_part(library: &str) -> Option<String> {
    let cells = USED_CELLS
        .iter()
        .map(|name| yosys::module_text(library, name))
        .collect::<Option<String>>()?;
    Some(format!("(* {} *)\nmodule names;\nendmodule\n{cells}", names(library).join(", ")))
}

/// Returns the names in a text, each once, in the order of their first occurrence.
fn names(library: &str) -> Vec<&str> {
    let mut known_words: HashSet<_> = KEYWORDS.into();
    let mut names = Vec::new();
    for line in library.lines() {
        let code = line.split("//").next().unwrap_or_default();
        // Text between two quotes is a value.
        for text in code.split('"').step_by(2) {
            let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "_'".contains(c)));
            let is_name =
                |word: &&str| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
            names.extend(words.filter(is_name).filter(|word| known_words.insert(*word)));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// Of a device.\nmodule PAD (...);\n    parameter MODE = \"NO_NAME\";\n    input I;\nendmodule\n\
        \nmodule RAMB18E2 (...);\n    parameter [7:0] INIT = 8'h0A; // Or else.\n    output DO;\n    input I;\nendmodule\n";

    #[test]
    fn names_are_in_order_and_once() {
        assert_eq!(names(TEXT), ["PAD", "MODE", "I", "RAMB18E2", "INIT", "DO"]);
    }

    #[test]
    fn a_library_without_one_of_the_cells_is_not_taken() {
        assert_eq!(used_part(TEXT), None);
        let all = USED_CELLS.map(|name| format!("module {name} (...);\nendmodule\n")).concat();
        assert_eq!(
            used_part(&all).unwrap(),
            format!("(* {} *)\nmodule names;\nendmodule\n{all}", USED_CELLS.join(", "))
        );
    }
}
