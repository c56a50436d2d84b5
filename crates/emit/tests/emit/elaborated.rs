// SPDX-License-Identifier: MIT OR Apache-2.0
//! A design ships the modules that it may elaborate: Icarus finds every module below the tops,
//! without a warning, and every leaf in some design.

use std::collections::BTreeSet;
use std::fs;

use crate::common::{
    covering_designs, covering_values, design, every_design, every_design_on_a_bus,
};
use foveate_design::Organization;
use foveate_emit::{AXI_TOP, LEAVES, SourceFile, Top, axi_modules, verilog};
use foveate_tools::{
    Cache, Tool, ToolError, Toolchain,
    iverilog::{self, IverilogJob},
    testing::{require_tools, takes_whole_lists},
};
use rayon::prelude::*;

/// Returns the module names of the files.
fn shipped_modules(files: &[SourceFile]) -> BTreeSet<String> {
    let name = |file: &SourceFile| {
        let name = file.path.strip_prefix("rtl/").unwrap();
        name.strip_suffix(".v").unwrap().to_owned()
    };
    files.iter().map(name).collect()
}

/// Returns the modules at and below `top`, with the parameters of its own text: the scopes in the
/// program that Icarus compiles. Fails with the warning if Icarus has one.
fn elaborated_modules(files: &[SourceFile], top: &str) -> Result<BTreeSet<String>, ToolError> {
    let sources = files.iter().map(|file| (file.path.clone(), file.contents.clone())).collect();
    let job = IverilogJob { sources, top: top.to_owned(), strict: true, ..IverilogJob::default() };
    let (toolchain, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let compiled = iverilog::compile(&toolchain, &cache, &job)?;
    let text = fs::read_to_string(compiled).unwrap();
    let scopes = text.lines().filter_map(|line| line.split_once(".scope module, "));
    // A scope line has the name of the instance first, then that of its module.
    Ok(scopes.map(|(_, names)| names.split('"').nth(3).unwrap().to_owned()).collect())
}

/// Returns the modules that all tops of these designs elaborate, and the warnings of Icarus.
fn elaborated_by_all(designs: &[String]) -> (BTreeSet<String>, Vec<String>) {
    let elaborated = |toml: &String| {
        let design = design(toml);
        let tops = Top::all_of(&design).iter();
        let arrays = tops.map(|&top| elaborated_modules(&verilog(&design, top), top.module()));
        let on_axi = axi_modules(&design).map(|files| elaborated_modules(&files, AXI_TOP));
        let all = arrays.chain(on_axi);
        all.map(|found| found.map_err(|error| format!("{error}\n{toml}"))).collect::<Vec<_>>()
    };
    let (mut modules, mut warnings) = (BTreeSet::new(), Vec::new());
    for found in designs.par_iter().flat_map_iter(elaborated).collect::<Vec<_>>() {
        match found {
            Ok(found) => modules.extend(found),
            Err(warning) => warnings.push(warning),
        }
    }
    (modules, warnings)
}

#[test]
fn icarus_has_no_warning_and_elaborates_every_leaf_in_some_design() {
    if !require_tools(&[Tool::Iverilog]) {
        return;
    }
    let designs = [covering_designs(), covering_values(every_design_on_a_bus())];
    let (modules, warnings) = elaborated_by_all(&designs.concat());
    assert!(warnings.is_empty(), "{}", warnings.join("\n"));
    // A few leaves are elaborated only for certain pairs of values.
    for leaf in LEAVES.iter().filter(|_| takes_whole_lists()) {
        assert!(modules.contains(leaf.name), "{}", leaf.name);
    }
}

/// A smaller grid of the same core, as in benches and co-simulations, needs no module that is not
/// shipped.
#[test]
fn smaller_grids_need_no_other_modules() {
    for toml in every_design() {
        let design = design(&toml);
        let own = shipped_modules(&verilog(&design, Top::Rcm));
        let mut config = design.lone_unit().config();
        let is_small = design.organization() != Organization::Serial;
        if is_small {
            // The numbers of padding columns and rows stay the same.
            let side = design.region_size();
            let beyond = |regions: u32, length: u32| regions * side - length;
            let part = &mut config.camera.frame;
            part.width = part.width.map(|width| width - beyond(design.columns(), design.width()));
            part.height = part.height.map(|height| height - beyond(design.rows(), design.height()));
        }
        let part = if is_small { config.validate().unwrap() } else { design.lone_unit() };
        let needed = shipped_modules(&verilog(&part, Top::Rcm));
        assert!(needed.is_subset(&own), "{:?}: {toml}", needed.difference(&own));
    }
}
