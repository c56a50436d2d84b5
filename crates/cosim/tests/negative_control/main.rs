// SPDX-License-Identifier: MIT OR Apache-2.0
//! The negative control: single edits of the emitted RTL, over all its modules. Every one must
//! still compile, and every one must be caught.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

#[path = "../common/mod.rs"]
mod common;
mod faults;

use common::{cosimulate, design, directed, in_parallel};
use faults::{FAULTS, Fault};
use foveate_cosim::{CosimReport, Level, Simulator};
use foveate_spec::{Config, Design};
use foveate_toolchain::testing::require_tools;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// Designs that between them use every module.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Planted {
    /// Median, edges, previous frame.
    Paper,
    /// Edges and corners, no filter, so that the counter of positions is the window's.
    Corner,
    /// Mean absolute deviation and variance, nothing with a window.
    Moments,
    /// Variance alone, whose result register is a port.
    Variance,
    /// Regions that do not fit into one bank of the frame store, nor fill two.
    Banked,
    /// Mean absolute deviation against the pixels last sent: two candidates for the count.
    MadSent,
    /// Edges against the pixels last sent, raw pixels forwarded.
    Sent,
    /// Median and edges that see across the border.
    Shared,
    /// The paper's design with its thresholds built in.
    Constant,
}

impl Planted {
    fn design(self) -> Design {
        let toml = match self {
            Self::Paper => "",
            Self::Corner => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 [[spatial]]\nfeature = \"corner\"\n[decision]\ncombine = \"all\"\n"
            }
            Self::Moments => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 mean_fraction_bits = 2\n[[spatial]]\nfeature = \"variance\"\n"
            }
            Self::Variance => "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"variance\"\n",
            Self::MadSent => {
                "[region]\nsize = 5\n[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 1\n\
                 [temporal]\nreference = \"last-sent\"\n"
            }
            Self::Sent => "[temporal]\nreference = \"last-sent\"\n[render]\npayload = \"raw\"\n",
            Self::Banked => "[region]\nsize = 17\n",
            Self::Shared => "[region]\nneighborhood = \"shared\"\n",
            Self::Constant => "[region]\nsize = 5\n[hardware]\nthresholds = \"constant\"\n",
        };
        design(&Config::from_toml(toml).unwrap(), (1, 1))
    }
}

fn plant(fault: &Fault, output: &Path) -> Result<CosimReport, String> {
    let design = fault.design.design();
    let Fault { what, module, from, to, .. } = fault;
    let path = format!("rtl/{module}.v");
    let level = match *module {
        "rcm" => Level::Rcm { columns: 3, rows: 2 },
        _ => Level::Rpu,
    };
    let mut problem = None;
    let report = cosimulate(&design, Simulator::Iverilog, directed(level, 1), output, |job| {
        match job.sources.iter_mut().find(|file| file.path == path) {
            None => problem = Some(format!("{module}: not in this design")),
            Some(file) if file.contents.matches(from).count() != 1 => {
                let count = file.contents.matches(from).count();
                problem = Some(format!("{module}: `{from}` is there {count} times"));
            }
            Some(file) => file.contents = file.contents.replace(from, to),
        }
    });
    match (problem, report) {
        (Some(problem), _) => Err(problem),
        (None, Err(error)) => Err(format!("{module}, {what}: {error}")),
        (None, Ok(report)) => Ok(report),
    }
}

#[test]
fn every_planted_fault_is_caught() {
    if !require_tools(Simulator::Iverilog.tools()) {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let numbered: Vec<(usize, &Fault)> = FAULTS.iter().enumerate().collect();
    let failures = in_parallel(&numbered, |(number, fault)| {
        let folder = output.path().join(number.to_string());
        let Fault { what, module, from, to, .. } = fault;
        let report = plant(fault, &folder)?;
        if report.passed() {
            return Err(format!("{module}, {what}: not caught: `{from}` -> `{to}`: {report}"));
        }
        assert!(report.replay.as_deref().is_some_and(|replay| replay.join("replay.sh").is_file()));
        Ok(())
    });
    assert!(
        failures.is_empty(),
        "{} of {}:\n{}",
        failures.len(),
        FAULTS.len(),
        failures.join("\n")
    );
}

/// A module that nobody has thought of needs faults of its own.
#[test]
fn every_module_has_a_fault() {
    let covered: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.module).collect();
    let modules = foveate_emit::LEAVES.iter().map(|leaf| leaf.name).chain(["rpu", "rcm"]);
    let missing: Vec<&str> = modules.filter(|module| !covered.contains(module)).collect();
    assert!(missing.is_empty(), "no fault is planted in {missing:?}");
    let kinds: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.what).collect();
    assert_eq!(kinds, BTreeSet::from(["constant", "index", "operator", "reset", "width"]));
}

#[test]
fn the_replay_of_a_fault_shows_it_again() {
    for simulator in Simulator::ALL {
        if !require_tools(simulator.tools()) {
            continue;
        }
        let output = tempfile::tempdir().unwrap();
        let folder = output.path().join("replay");
        let edit = |job: &mut foveate_cosim::Job| {
            let vote = job.sources.iter_mut().find(|file| file.path == "rtl/vote.v").unwrap();
            vote.contents = vote.contents.replace("score_i >= minimum_i", "score_i > minimum_i");
            job.trace = true;
        };
        let design = Planted::Constant.design();
        let report =
            cosimulate(&design, simulator, directed(Level::Rpu, 1), &folder, edit).unwrap();
        let mismatch = report.mismatch.unwrap();
        assert!(folder.join("waves.fst").is_file());
        let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
        assert!(readme.contains(&mismatch.to_string()), "{readme}");
        let again = Command::new(folder.join("replay.sh")).output().unwrap();
        let log = String::from_utf8_lossy(&again.stdout).into_owned();
        assert_eq!(again.status.code(), Some(1), "{log}");
        let line = format!("MISMATCH clock {} port {} ", mismatch.clock, mismatch.port);
        assert!(log.contains(&line), "{line}\n{log}");

        // Repaired by hand, the replay passes.
        let vote = folder.join("rtl/vote.v");
        let text = std::fs::read_to_string(&vote).unwrap();
        std::fs::write(&vote, text.replace("score_i > minimum_i", "score_i >= minimum_i")).unwrap();
        let again = Command::new(folder.join("replay.sh")).arg(simulator.name()).output().unwrap();
        assert_eq!(again.status.code(), Some(0), "{}", String::from_utf8_lossy(&again.stdout));
    }
}
