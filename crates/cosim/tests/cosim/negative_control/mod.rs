// SPDX-License-Identifier: MIT OR Apache-2.0
//! The negative control: single edits of the emitted RTL, over all its modules. Every edited design
//! must still compile, and every edit must be found.

mod deep_faults;
mod fault_designs;
mod faults;
mod raster_faults;
mod serial_faults;
mod serial_summary_faults;
mod summary_faults;
mod sync_faults;

use crate::common::{
    check_agreement, cosimulate, directed_stimulus, has_simulators, in_parallel, sampled_faults,
};
use fault_designs::FaultDesign;
use faults::RtlFault;
use foveate_cosim::{CosimJob, CosimLevel, CosimReport, Recording, Simulator};
use foveate_toolchain::testing::{require_tools, sampling_step};
use foveate_toolchain::{Cache, Toolchain};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex, OnceLock};

/// The vectors that the first fault of a design makes for the later ones.
type SharedRecording = Arc<OnceLock<Recording>>;

/// The vectors of each design at each level.
#[derive(Default)]
struct DesignVectors(Mutex<HashMap<(FaultDesign, CosimLevel), SharedRecording>>);

impl DesignVectors {
    /// Calls `work` with the vectors of a design at a level.
    fn with_recording<T>(
        &self,
        planted: FaultDesign,
        level: CosimLevel,
        work: impl FnOnce(&Recording) -> T,
    ) -> T {
        let slot = Arc::clone(self.0.lock().unwrap().entry((planted, level)).or_default());
        let make =
            || directed_stimulus(level, 1).record(&planted.design(), &mut |_, _| {}).unwrap();
        work(slot.get_or_init(make))
    }
}

fn run_with_fault(
    fault: &RtlFault,
    vectors: &DesignVectors,
    output: &Path,
) -> Result<CosimReport, String> {
    let RtlFault { kind: what, module, from, to, .. } = fault;
    let path = format!("rtl/{module}.v");
    let level = fault.design.level(module);
    let mut job =
        CosimJob::new(&fault.design.design(), directed_stimulus(level, 1), output).unwrap();
    job.simulator = fault.design.simulator();
    match job.sources.iter_mut().find(|file| file.path == path) {
        None => return Err(format!("{module}: not in this design")),
        Some(file) if file.contents.matches(from).count() != 1 => {
            let count = file.contents.matches(from).count();
            return Err(format!("{module}: `{from}` is there {count} times"));
        }
        Some(file) => file.contents = file.contents.replace(from, to),
    }
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let run = |recording: &_| job.run_on(recording, &toolchain, &cache, &mut |_| {});
    let report = vectors.with_recording(fault.design, level, run);
    report.map_err(|error| format!("{module}, {what}: {error}"))
}

fn assert_all_caught<'a>(faults: impl IntoIterator<Item = &'a RtlFault>) {
    if !has_simulators() {
        return;
    }
    let (output, vectors) = (tempfile::tempdir().unwrap(), DesignVectors::default());
    let numbered: Vec<(usize, &RtlFault)> = faults.into_iter().enumerate().collect();
    let failures = in_parallel(&numbered, |(number, fault)| {
        let folder = output.path().join(number.to_string());
        let RtlFault { kind: what, module, from, to, .. } = fault;
        let report = run_with_fault(fault, &vectors, &folder)?;
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
        numbered.len(),
        failures.join("\n")
    );
}

/// Returns the faults that every run plants, from a list that takes long.
fn sampled_of(faults: &'static [RtlFault]) -> Vec<&'static RtlFault> {
    sampled_faults(faults, |fault| fault.module)
}

#[test]
fn every_planted_fault_is_caught() {
    assert_all_caught(faults::FAULTS);
}

#[test]
fn every_planted_fault_of_deep_pipelining_is_caught() {
    assert_all_caught(deep_faults::FAULTS);
}

#[test]
fn every_planted_fault_of_summaries_is_caught() {
    assert_all_caught(summary_faults::FAULTS);
}

#[test]
fn every_planted_fault_of_summaries_of_raster_cores_is_caught() {
    assert_all_caught(sampled_of(summary_faults::RASTER));
}

#[test]
fn every_planted_fault_of_the_serial_organization_is_caught() {
    assert_all_caught(sampled_of(serial_faults::FAULTS));
}

#[test]
fn every_planted_fault_of_serial_summaries_is_caught() {
    assert_all_caught(sampled_of(serial_summary_faults::FAULTS));
}

#[test]
fn every_planted_fault_of_the_raster_organization_is_caught() {
    assert_all_caught(sampled_of(raster_faults::FAULTS));
}

#[test]
fn every_planted_fault_of_frame_sync_is_caught() {
    assert_all_caught(sync_faults::FAULTS);
}

/// The lists that every run plants whole.
const ALWAYS: [&[RtlFault]; 4] =
    [faults::FAULTS, deep_faults::FAULTS, summary_faults::FAULTS, sync_faults::FAULTS];
/// The lists of which every run plants a part.
const SAMPLED: [&[RtlFault]; 4] = [
    summary_faults::RASTER,
    serial_faults::FAULTS,
    serial_summary_faults::FAULTS,
    raster_faults::FAULTS,
];

/// Returns the faults of every organization.
fn all_faults() -> impl Iterator<Item = &'static RtlFault> {
    ALWAYS.into_iter().chain(SAMPLED).flatten()
}

/// Returns the faults that this run plants.
fn planted_faults() -> impl Iterator<Item = &'static RtlFault> {
    ALWAYS.into_iter().flatten().chain(SAMPLED.into_iter().flat_map(sampled_of))
}

/// The unchanged designs pass, or the tests above would show nothing. Other tests simulate similar
/// designs, so a short run takes every fourth.
#[test]
fn every_design_passes_without_a_fault() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let mut designs = Vec::new();
    for fault in planted_faults() {
        if !designs.contains(&fault.design) {
            designs.push(fault.design);
        }
    }
    let designs: Vec<FaultDesign> = designs.into_iter().step_by(sampling_step(4)).collect();
    let failures = in_parallel(&designs, |planted| {
        let folder = output.path().join(format!("{planted:?}"));
        let stimulus = directed_stimulus(planted.level(""), 1);
        let name = format!("{planted:?}");
        check_agreement(&name, &planted.design(), planted.simulator(), stimulus, &folder)
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Every module has faults, also a new one.
#[test]
fn every_module_has_a_fault() {
    let on_buses = crate::bus::faults::FAULTS.iter().map(|fault| fault.module);
    let covered: BTreeSet<&str> = all_faults().map(|fault| fault.module).chain(on_buses).collect();
    let rendered = ["rpu", "rcm", "rcm_axi", "axi_registers"];
    let modules = foveate_emit::LEAVES.iter().map(|leaf| leaf.name).chain(rendered);
    let missing: Vec<&str> = modules.filter(|module| !covered.contains(module)).collect();
    assert!(missing.is_empty(), "no fault is planted in {missing:?}");
    let kinds: BTreeSet<&str> = all_faults().map(|fault| fault.kind).collect();
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
        let edit = |job: &mut CosimJob| {
            let vote = job.sources.iter_mut().find(|file| file.path == "rtl/vote.v").unwrap();
            vote.contents = vote.contents.replace("score_i >= minimum_i", "score_i > minimum_i");
            job.trace = true;
        };
        let design = FaultDesign::Constant.design();
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
