// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthesizes an array with Yosys, for the LUTs, carry chains and memories of Xilinx
//! UltraScale+ ([`SynthesisJob`]).
//!
//! Yosys gets a reduced library of Xilinx cells ([`reduced_cell_library`]). The full library
//! declares the ports of cells that Yosys does not model; the reduced library omits the cells
//! that no core can have. `synth_xilinx` begins with the ports of 328 cells, from pads to
//! processors, and carries them through all of its steps. Its rules for `UltraScale+` use four
//! of them. Without the others, a small core is synthesized in two thirds of the time.
//!
//! The netlist stays the same. Yosys orders nets by the numbers that names get when they are
//! first read, so all names of the file are read before the four cells.

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::source_files;
use crate::source_files::Source;
use crate::tool::Tool;
use crate::toolchain::Toolchain;
use crate::yosys::{self, YosysJob};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeSet, HashSet};
use std::fs;

const SYNTHESIS_COMMAND: &str = "synth_xilinx -family xcup -abc9 -nosrl -noiopad -noclkbuf";
/// The commands that make shift registers after the synthesis; `synth_xilinx` would make them in
/// the middle. The command `setparam` corrects a fault of Yosys up to 0.67
/// (<https://github.com/YosysHQ/yosys/issues/6058>): Yosys connects the enable of a shift register,
/// but records that the register has no enable. The enable is active high, as that of the FDRE from
/// which the shift register is made.
const SHIFT_REGISTERS: &str = "xilinx_srl -fixed -minlen 3\n\
    setparam -set ENPOL 1 t:$__XILINX_SHREG_\n\
    techmap -map +/xilinx/cells_map.v\n\
    clean\n";
/// The file with the cells that synthesis can use.
const CELLS: &str = "foveate_xilinx_cells.v";
const NETLIST: &str = "netlist.json";
const VERILOG: &str = "netlist.v";

/// An array to synthesize.
#[derive(Debug, Clone)]
pub struct SynthesisJob {
    /// The Verilog files; headers for `` `include `` may be among them if they end in `.vh`.
    pub sources: Vec<Source>,
    /// The module of which the array has many instances, an RPU or a lane. Its leaves are flattened
    /// into it. If it has parameters, its Verilog must have the attribute `keep_hierarchy`.
    pub unit: String,
    /// The module of the array.
    pub array: String,
    /// The parameters of the array and their values. Yosys names a module after parameters that are
    /// set, even to their defaults, and orders nets by names, so the same array without them may
    /// have a few LUTs more or fewer (305 in place of 299 in a raster core of 8x4 regions).
    pub parameters: Vec<(&'static str, u32)>,
}

/// The netlist of an array, as JSON for counts and as Verilog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SynthesisResult {
    /// The tool that made the netlist.
    pub tool: ToolRecord,
    /// The netlist as JSON.
    pub json: Vec<u8>,
    /// The netlist of `json` as Verilog, with a module for the array and one for the unit.
    pub verilog: String,
}

/// The tool that made a netlist or its figures, as stated in reports.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ToolRecord {
    /// The name of the tool, `Yosys`.
    pub name: String,
    /// The version as the tool prints it.
    pub version: String,
    /// The synthesis command.
    pub flags: String,
}

impl SynthesisResult {
    /// Returns the types of all primitive cells. A cell is primitive if its type is not a module of
    /// the netlist. The set is empty if the JSON is not a netlist.
    #[must_use]
    pub fn cell_types(&self) -> BTreeSet<String> {
        let netlist: Value = serde_json::from_slice(&self.json).unwrap_or_default();
        let Some(modules) = netlist["modules"].as_object() else { return BTreeSet::new() };
        let cells = modules.values().filter_map(|module| module["cells"].as_object());
        let types = cells.flat_map(|cells| cells.values()).filter_map(|cell| cell["type"].as_str());
        types.filter(|name| !modules.contains_key(*name)).map(str::to_owned).collect()
    }
}

impl SynthesisJob {
    /// Synthesizes the array and keeps the unit as a module: the leaves are flattened into the
    /// unit, but the unit is not flattened into the array.
    ///
    /// # Errors
    /// Fails if Yosys is missing or rejects the design.
    pub fn run(&self, toolchain: &Toolchain, cache: &Cache) -> Result<SynthesisResult, ToolError> {
        let version = toolchain.find(Tool::Yosys)?.banner;
        let cells = reduced_cell_library(toolchain, cache)?;
        let mut run = yosys::run(toolchain, cache, &self.array_job(cells))?;
        let mut file = |name| run.files.remove(name).expect("it is one of the wanted files");
        let flags = format!(
            "{SYNTHESIS_COMMAND} -flatten, then xilinx_srl; {} kept as a module",
            self.unit
        );
        Ok(SynthesisResult {
            tool: ToolRecord { name: "Yosys".into(), version, flags },
            json: file(NETLIST),
            verilog: String::from_utf8_lossy(&file(VERILOG)).into_owned(),
        })
    }

    /// Returns the netlist of a module as JSON, with its leaves as separate modules.
    ///
    /// # Errors
    /// Fails like [`SynthesisJob::run`].
    pub fn run_hierarchical(
        &self,
        top: &str,
        toolchain: &Toolchain,
        cache: &Cache,
    ) -> Result<Vec<u8>, ToolError> {
        let cells = reduced_cell_library(toolchain, cache)?;
        let job = self.script(&format!("hierarchy -check -top {top}\n"), top, "", cells);
        let mut run = yosys::run(toolchain, cache, &job)?;
        Ok(run.files.remove(NETLIST).expect("it is one of the wanted files"))
    }

    fn array_job(&self, cells: Option<String>) -> YosysJob {
        let Self { unit, array, .. } = self;
        let setting = |(name, value): &(&str, u32)| format!(" -set {name} {value}");
        let parameters: String = self.parameters.iter().map(setting).collect();
        let parameters = match parameters.as_str() {
            "" => String::new(),
            setting => format!("chparam{setting} {array}\n"),
        };
        // A unit with parameters has been renamed at this point, so its attribute must be in its
        // Verilog.
        let prepare = format!(
            "{parameters}hierarchy -check -top {array}\n\
             setattr -mod -set keep_hierarchy 1 {unit}\n"
        );
        let mut job = self.script(&prepare, array, " -flatten", cells);
        job.script += &format!("write_verilog -noattr {VERILOG}\n");
        job.outputs.push(VERILOG.to_owned());
        job
    }

    /// Returns a script that reads the sources, runs `prepare`, synthesizes, and writes the netlist
    /// without the library of cells.
    fn script(&self, prepare: &str, top: &str, options: &str, cells: Option<String>) -> YosysJob {
        let mut sources = self.sources.clone();
        let mut synthesis = format!("{SYNTHESIS_COMMAND}{options} -top {top}");
        if let Some(cells) = cells {
            sources.push((CELLS.to_owned(), cells));
            // These commands replace the first step of `synth_xilinx`, with fewer cells.
            let begin = format!(
                "read_verilog -lib -specify +/xilinx/cells_sim.v\n\
                 read_verilog -lib {CELLS}\n\
                 hierarchy -check -top {top}\n"
            );
            synthesis = format!("{begin}{synthesis} -run prepare:");
        }
        let script = format!(
            "{}{prepare}{synthesis}\n{SHIFT_REGISTERS}\
             delete =A:blackbox =A:whitebox\n\
             write_json {NETLIST}\n",
            self.read_commands()
        );
        YosysJob { sources, script, outputs: vec![NETLIST.to_owned()] }
    }

    fn read_commands(&self) -> String {
        let names = self.sources.iter().map(|(name, _)| name).filter(|name| !name.ends_with(".vh"));
        names.map(|name| format!("read_verilog -I. {name}\n")).collect()
    }
}

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

    #[test]
    fn primitive_cells_are_no_modules() {
        let tool = ToolRecord { name: String::new(), version: String::new(), flags: String::new() };
        let types = |json: &str| {
            let json = json.as_bytes().to_vec();
            SynthesisResult { tool: tool.clone(), json, verilog: String::new() }.cell_types()
        };
        let netlist = r#"{"modules": {"rcm": {"cells": {"a": {"type": "rpu"}, "b": {"type": "LUT4"}}},
            "rpu": {"cells": {"c": {"type": "FDRE"}, "d": {"type": "LUT4"}}}}}"#;
        assert_eq!(types(netlist), BTreeSet::from(["FDRE".to_owned(), "LUT4".to_owned()]));
        assert!(types("{}").is_empty() && types("no JSON").is_empty());
    }

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
