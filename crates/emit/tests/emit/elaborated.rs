// SPDX-License-Identifier: MIT OR Apache-2.0
//! Only modules that a design elaborates are shipped: the modules that Icarus finds below the tops,
//! without a warning, are exactly the files.

use std::collections::BTreeSet;
use std::fs;

use crate::common::{covering_pairs, design, every_design, every_design_on_a_bus};
use foveate_design::{Design, Organization};
use foveate_emit::{AXI_TOP, LEAVES, SourceFile, Top, axi_modules, verilog};
use foveate_toolchain::iverilog::{self, IverilogJob};
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::{Cache, Tool, ToolError, Toolchain};
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

/// Returns the problem of a top, if any: a warning, a module that is shipped but not elaborated, or
/// one that is elaborated but not shipped.
fn top_problem(design: &Design, top: Top) -> Option<String> {
    files_problem(&verilog(design, top), top.module())
}

/// Returns the problem of these files and the module on top of them, if any.
fn files_problem(files: &[SourceFile], top: &str) -> Option<String> {
    let shipped = shipped_modules(files);
    match elaborated_modules(files, top) {
        Ok(found) if found == shipped => None,
        Ok(found) => {
            let unused: Vec<_> = shipped.difference(&found).collect();
            Some(format!("{top} never elaborates {unused:?}"))
        }
        Err(warning) => Some(format!("{top}: {warning}")),
    }
}

#[test]
fn every_shipped_module_is_elaborated_without_a_warning_of_icarus() {
    if !require_tools(&[Tool::Iverilog]) {
        return;
    }
    let found: Vec<String> = covering_pairs(every_design())
        .par_iter()
        .flat_map_iter(|toml| {
            let design = design(toml);
            let tops = Top::all_of(&design).iter();
            let problems = tops.filter_map(|&top| top_problem(&design, top));
            problems.map(|problem| format!("{problem}\n{toml}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_shipped_module_around_an_array_is_elaborated_without_a_warning_of_icarus() {
    if !require_tools(&[Tool::Iverilog]) {
        return;
    }
    let check = |toml: &String| {
        let files = axi_modules(&design(toml)).unwrap();
        let problem = files_problem(&files, AXI_TOP)?;
        Some(format!("{problem}\n{toml}"))
    };
    let designs = covering_pairs(every_design_on_a_bus());
    let found: Vec<String> = designs.par_iter().filter_map(check).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
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

/// Every leaf is in some design, so the comparison above covers each leaf.
#[test]
fn every_leaf_is_in_some_design() {
    let designs: Vec<Design> = every_design().iter().map(|toml| design(toml)).collect();
    let on_buses: Vec<Design> = every_design_on_a_bus().iter().map(|toml| design(toml)).collect();
    let arrays = designs.iter().map(|design| verilog(design, Top::Rcm));
    let all: BTreeSet<String> = arrays
        .chain(on_buses.iter().filter_map(axi_modules))
        .flat_map(|files| shipped_modules(&files))
        .collect();
    for leaf in LEAVES {
        assert!(all.contains(leaf.name), "{}", leaf.name);
    }
}
