// SPDX-License-Identifier: MIT OR Apache-2.0
//! Emitted Verilog has no warning in Verilator and Yosys, over the matrix of designs.
//! `elaborated.rs` tests warnings of Icarus.

use crate::common::{covering_designs, covering_values, design, raster_matrix};
use foveate_design::RasterMemory;
use foveate_emit::{Top, verilog};
use foveate_tools::{
    Cache, Source, Tool, ToolError, Toolchain,
    iverilog::{self, IverilogJob},
    testing::{require_tools, sample},
    verilator,
    yosys::{self, YosysJob},
};
use rayon::prelude::*;

/// Runs `check` on the Verilog of every design and reports every failure.
fn check_each_design(
    designs: &[String],
    check: impl Fn(&[Source]) -> Result<(), ToolError> + Sync,
) {
    let failures: Vec<String> = designs
        .par_iter()
        .filter_map(|toml| {
            let files = verilog(&design(toml), Top::Rcm);
            let sources: Vec<Source> = files.into_iter().map(|f| (f.path, f.contents)).collect();
            check(&sources).err().map(|error| format!("{toml}{error}\n"))
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Returns the designs that are linted: those that cover the matrices, and a sixth of them in most
/// runs.
fn linted_designs() -> Vec<String> {
    sample(covering_designs(), 6)
}

#[test]
fn verilator_has_no_warning() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let toolchain = Toolchain::system();
    check_each_design(&linted_designs(), |sources| {
        verilator::lint(&toolchain, sources, "rcm", None)
    });
}

#[test]
fn yosys_has_no_warning() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (toolchain, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    check_each_design(&linted_designs(), |sources| {
        let names: Vec<&str> = sources.iter().map(|(name, _)| name.as_str()).collect();
        let script = format!(
            "read_verilog {}\nhierarchy -check -top rcm\nproc\ncheck -assert\n",
            names.join(" ")
        );
        let job = YosysJob { sources: sources.to_vec(), script, outputs: Vec::new() };
        let run = yosys::run(&toolchain, &cache, &job)?;
        let warnings: Vec<&str> =
            run.log.lines().filter(|line| line.starts_with("Warning")).collect();
        assert!(warnings.is_empty(), "{}", warnings.join("\n"));
        Ok(())
    });
}

/// The memories that a raster design lists are those that Yosys finds in its Verilog.
#[test]
fn the_memories_of_a_raster_core_are_those_that_it_says() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (toolchain, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    for toml in sample(covering_values(raster_matrix()), 6) {
        let design = design(&toml);
        let sources: Vec<Source> =
            verilog(&design, Top::Rcm).into_iter().map(|file| (file.path, file.contents)).collect();
        let names: Vec<&str> = sources.iter().map(|(name, _)| name.as_str()).collect();
        let script = format!(
            "read_verilog {}\nhierarchy -check -top rcm\nproc\nflatten\nopt_clean\n\
             memory_collect\ndump t:$mem*\n",
            names.join(" ")
        );
        let job = YosysJob { sources, script, outputs: Vec::new() };
        let log = yosys::run(&toolchain, &cache, &job).unwrap().log;
        let numbers = |name: &str| -> Vec<u64> {
            let named = log.lines().filter_map(|line| {
                line.trim().strip_prefix(&format!("parameter \\{name} "))?.parse().ok()
            });
            named.collect()
        };
        let mut found: Vec<_> = numbers("SIZE").into_iter().zip(numbers("WIDTH")).collect();
        let mut said: Vec<_> = RasterMemory::all_memories(design.as_raster().unwrap())
            .iter()
            .map(|memory| (memory.words, u64::from(memory.bits)))
            .collect();
        found.sort_unstable();
        said.sort_unstable();
        assert_eq!(found, said, "{toml}");
    }
}

/// The check can fail: Verilator and Icarus both find a width that does not fit.
#[test]
fn a_planted_flaw_is_seen() {
    if !require_tools(&[Tool::Verilator, Tool::Iverilog]) {
        return;
    }
    let files = verilog(&design(""), Top::Rpu);
    let mut sources: Vec<Source> = files.into_iter().map(|f| (f.path, f.contents)).collect();
    let rpu = sources.last_mut().unwrap();
    let flawed =
        rpu.1.replace("hit_counter #(.WIDTH(7)) u_edge", "hit_counter #(.WIDTH(6)) u_edge");
    assert_ne!(flawed, rpu.1);
    rpu.1 = flawed;
    let toolchain = Toolchain::system();
    assert!(verilator::lint(&toolchain, &sources, "rpu", None).is_err());
    let job =
        IverilogJob { sources, top: "rpu".to_owned(), strict: true, ..IverilogJob::default() };
    assert!(iverilog::compile(&toolchain, &Cache::temporary().unwrap(), &job).is_err());
}
