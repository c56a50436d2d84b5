// SPDX-License-Identifier: MIT OR Apache-2.0
//! Only what a design elaborates is shipped: the modules that Verilator finds below the tops are the files.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::{design, every_design};
use foveate_design::{Design, Organization};
use foveate_emit::{LEAVES, SourceFile, Top, verilog};
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::{Tool, Toolchain};
use rayon::prelude::*;

/// The names of the files.
fn shipped(files: &[SourceFile]) -> BTreeSet<String> {
    let name = |file: &SourceFile| {
        let name = file.path.strip_prefix("rtl/").unwrap();
        name.strip_suffix(".v").unwrap().to_owned()
    };
    files.iter().map(name).collect()
}

/// The modules at and below `top`, with the parameters of its own text.
fn elaborated(files: &[SourceFile], top: &str) -> BTreeSet<String> {
    let dir = tempfile::tempdir().unwrap();
    let mut names = Vec::new();
    for file in files {
        let name = file.path.replace('/', "_");
        fs::write(dir.path().join(&name), &file.contents).unwrap();
        names.push(name);
    }
    let toolchain = Toolchain::system();
    let args = [
        "--xml-only",
        "--xml-output",
        "tree.xml",
        "--no-timing",
        "--Mdir",
        ".",
        "--top-module",
        top,
    ];
    let verilator = toolchain.invocation(Tool::Verilator).unwrap();
    toolchain.run_checked(&verilator.args(args).args(names).dir(dir.path())).unwrap();
    modules(&dir.path().join("tree.xml"))
}

/// The names in the source of all modules of a tree.
fn modules(xml: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(xml).unwrap();
    let attribute = |line: &str| {
        let (_, rest) = line.split_once(" origName=\"")?;
        Some(rest.split_once('"')?.0.to_owned())
    };
    let modules = text.lines().map(str::trim).filter(|line| line.starts_with("<module "));
    modules.filter_map(attribute).collect()
}

/// What is shipped for a top and not elaborated, or the other way round.
fn problems(design: &Design, top: Top) -> Option<String> {
    let files = verilog(design, top);
    let (shipped, found) = (shipped(&files), elaborated(&files, top.module()));
    let unused: Vec<_> = shipped.difference(&found).collect();
    (shipped != found).then(|| format!("{top:?} never elaborates {unused:?}"))
}

#[test]
fn every_shipped_module_is_elaborated() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let found: Vec<String> = every_design()
        .par_iter()
        .flat_map_iter(|toml| {
            let design = design(toml);
            let tops = [Top::Rpu, Top::Rcm];
            tops.map(|top| problems(&design, top).map(|problem| format!("{problem}\n{toml}")))
        })
        .flatten()
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A smaller grid of the same core, as benches and co-simulations use it, needs nothing that is not there.
#[test]
fn smaller_grids_need_no_other_modules() {
    for toml in every_design() {
        let design = design(&toml);
        let own = shipped(&verilog(&design, Top::Rcm));
        let mut config = design.lone_unit().config().clone();
        let is_small = design.organization() != Organization::Serial;
        if is_small {
            // What is beyond the frame stays as it is.
            let side = design.region_size();
            let beyond = |regions: u32, length: u32| regions * side - length;
            let part = &mut config.frame;
            part.width = part.width.map(|width| width - beyond(design.columns(), design.width()));
            part.height = part.height.map(|height| height - beyond(design.rows(), design.height()));
        }
        let part = if is_small { config.validate().unwrap() } else { design.lone_unit() };
        let needed = shipped(&verilog(&part, Top::Rcm));
        assert!(needed.is_subset(&own), "{:?}: {toml}", needed.difference(&own));
    }
}

/// Every leaf is in some design, so that each is compared.
#[test]
fn every_leaf_is_in_some_design() {
    let designs: Vec<Design> = every_design().iter().map(|toml| design(toml)).collect();
    let all: BTreeSet<String> =
        designs.iter().flat_map(|design| shipped(&verilog(design, Top::Rcm))).collect();
    for leaf in LEAVES {
        assert!(all.contains(leaf.name), "{}", leaf.name);
    }
}
