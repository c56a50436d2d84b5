// SPDX-License-Identifier: MIT OR Apache-2.0
//! The negative control: twelve faults in the Verilog of each organization show that every kind of
//! check finds a fault. Mutation (`scripts/mutation.sh`) changes every line of every module.

mod pipelined_faults;
mod planted_fault;
mod raster_faults;
mod serial_faults;

use crate::common::{
    check_agreement, cosimulate, design, directed_stimulus, has_simulators, in_parallel,
};
use foveate_cosim::{CosimJob, CosimLevel, CosimReport, Simulator};
use foveate_design::DesignConfig;
use foveate_tools::testing::{require_tools, sampling_step};
use planted_fault::{FaultDesign, PlantedFault};
use std::path::Path;
use std::process::Command;

/// Returns the faults of every organization.
fn all_faults() -> impl Iterator<Item = &'static PlantedFault> {
    [&pipelined_faults::FAULTS, &serial_faults::FAULTS, &raster_faults::FAULTS]
        .into_iter()
        .flatten()
}

/// Runs a co-simulation with the fault.
fn run_with_fault(fault: &PlantedFault, output: &Path) -> Result<CosimReport, String> {
    let PlantedFault { design, module, from, to, .. } = fault;
    let path = format!("rtl/{module}.v");
    let mut found = None;
    let edit = |job: &mut CosimJob| {
        let file = job.sources.iter_mut().find(|file| file.path == path);
        found = file.map(|file| {
            let count = file.contents.matches(from).count();
            file.contents = file.contents.replace(from, to);
            count
        });
    };
    let stimulus = directed_stimulus(design.level(), 2);
    let report = cosimulate(&design.design(), design.simulator(), stimulus, output, edit);
    match found {
        Some(1) => report.map_err(|error| error.to_string()),
        Some(count) => Err(format!("`{from}` is there {count} times")),
        None => Err("the module is not in this design".to_owned()),
    }
}

/// Every fault differs first at the port of the check that it proves, and leaves a folder that
/// replays it.
#[test]
fn every_kind_of_check_finds_its_planted_fault() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let numbered: Vec<(usize, &PlantedFault)> = all_faults().enumerate().collect();
    let failures = in_parallel(&numbered, |(number, fault)| {
        let folder = output.path().join(number.to_string());
        let PlantedFault { check, port, module, .. } = fault;
        let named = |problem: String| format!("{module}, {check}: {problem}");
        let report = run_with_fault(fault, &folder).map_err(named)?;
        let Some(mismatch) = report.mismatch else {
            return Err(named("not caught".to_owned()));
        };
        let mut first = mismatch.ports.iter().filter(|found| found.clock == mismatch.clock);
        if !first.any(|found| found.port == *port) {
            return Err(named(format!("{port} does not differ first: {mismatch}")));
        }
        match report.replay.is_some_and(|replay| replay.join("replay.sh").is_file()) {
            true => Ok(()),
            false => Err(named("no replay".to_owned())),
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The unchanged designs pass, or the test above would show nothing.
#[test]
fn every_design_passes_without_a_fault() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let mut designs: Vec<FaultDesign> = Vec::new();
    for fault in all_faults() {
        if !designs.contains(&fault.design) {
            designs.push(fault.design);
        }
    }
    // A design that fails without a fault differs first at a port that few of its faults name, so a
    // sample is enough in most runs.
    let sampled = designs.into_iter().enumerate().step_by(sampling_step(15));
    let numbered: Vec<(usize, FaultDesign)> = sampled.collect();
    let failures = in_parallel(&numbered, |(number, planted)| {
        let folder = output.path().join(number.to_string());
        let stimulus = directed_stimulus(planted.level(), 2);
        let name = format!("{planted:?}");
        check_agreement(&name, &planted.design(), planted.simulator(), stimulus, &folder)
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_replay_of_a_fault_shows_it_again() {
    for simulator in Simulator::ALL {
        if !require_tools(simulator.tools()) {
            continue;
        }
        let output = tempfile::tempdir().unwrap();
        let folder = output.path().join("replay");
        let edit = |job: &mut CosimJob| {
            let vote = job.sources.iter_mut().find(|file| file.path == "rtl/vote.v").unwrap();
            vote.contents = vote.contents.replace("score_i >= minimum_i", "score_i > minimum_i");
            job.trace = true;
        };
        let toml = "region.size = 5\nhardware.thresholds = 'constant'\n";
        let design = design(&DesignConfig::from_toml(toml).unwrap(), (1, 1));
        let report =
            cosimulate(&design, simulator, directed_stimulus(CosimLevel::Rpu, 1), &folder, edit)
                .unwrap();
        let mismatch = report.mismatch.unwrap();
        assert!(folder.join("waves.fst").is_file());
        let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
        assert!(readme.contains(&mismatch.to_string()), "{readme}");
        assert!(mismatch.ports.len() > 1, "the decision is wrong, and what follows: {mismatch:?}");
        assert!(mismatch.activity.contains("of frame "), "{mismatch:?}");
        let again = Command::new(folder.join("replay.sh")).output().unwrap();
        let log = String::from_utf8_lossy(&again.stdout).into_owned();
        assert_eq!(again.status.code(), Some(1), "{log}");
        for port in &mismatch.ports {
            assert!(readme.contains(&port.to_string()), "{port}\n{readme}");
            let line = format!("MISMATCH clock {} port {} ", port.clock, port.port);
            assert!(log.contains(&line), "{line}\n{log}");
        }

        // After a repair by hand, the replay passes.
        let vote = folder.join("rtl/vote.v");
        let text = std::fs::read_to_string(&vote).unwrap();
        std::fs::write(&vote, text.replace("score_i > minimum_i", "score_i >= minimum_i")).unwrap();
        let again = Command::new(folder.join("replay.sh")).arg(simulator.name()).output().unwrap();
        assert_eq!(again.status.code(), Some(0), "{}", String::from_utf8_lossy(&again.stdout));
    }
}
