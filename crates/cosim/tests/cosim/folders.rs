// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files that a run leaves on disk, and the files that it must not touch.

use crate::common::{cosimulate, design, directed_stimulus};
use foveate_cosim::{CosimError, CosimJob, CosimLevel, CosimProgress, CosimReport, Simulator};
use foveate_design::DesignConfig;
use foveate_tools::{
    Cache, StagingError, Toolchain,
    testing::{require_tools, sample},
};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

const SIMULATOR: Simulator = Simulator::Iverilog;

fn run(output: &Path, edit: impl FnOnce(&mut CosimJob)) -> Result<CosimReport, CosimError> {
    let mut config = DesignConfig::default();
    config.camera.region.size = 4;
    cosimulate(
        &design(&config, (1, 1)),
        SIMULATOR,
        directed_stimulus(CosimLevel::Rpu, 1),
        output,
        edit,
    )
}

fn plant_fault(job: &mut CosimJob) {
    for file in &mut job.sources {
        file.contents = file.contents.replace("score_i >= minimum_i", "score_i > minimum_i");
    }
}

fn file_names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_run_without_mismatch_leaves_nothing_but_waves_that_were_asked_for() {
    if !require_tools(SIMULATOR.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    let report = run(&output, |_| {}).unwrap();
    assert!(report.passed() && !output.exists());
    let report = run(&output, |job| job.trace = true).unwrap();
    assert_eq!(report.waves.as_deref(), Some(output.join("waves.fst").as_path()));
    assert_eq!(file_names(&output), [".foveate", "waves.fst"]);
    assert!(
        run(&output, plant_fault).unwrap().replay.is_some(),
        "a replay takes the place of waves"
    );
}

#[test]
fn a_replay_replaces_a_replay_and_nothing_else() {
    if !require_tools(SIMULATOR.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    for _ in 0..2 {
        let report = run(&output, plant_fault).unwrap();
        assert_eq!(report.replay.as_deref(), Some(output.as_path()));
    }
    let expected = [".foveate", "README.md", "replay.sh", "rpu_replay.v", "rtl", "vectors.hex"];
    assert_eq!(file_names(&output), expected);
    assert_eq!(file_names(dir.path()), ["out"]);

    let precious = dir.path().join("precious");
    fs::create_dir(&precious).unwrap();
    fs::write(precious.join("thesis.tex"), "").unwrap();
    let error = run(&precious, plant_fault).unwrap_err();
    assert!(matches!(error, CosimError::Output(StagingError::OtherContent { .. })), "{error}");
    assert_eq!(file_names(&precious), ["thesis.tex"]);
    assert_eq!(file_names(dir.path()), ["out", "precious"]);
}

#[test]
fn a_passing_run_leaves_no_earlier_replay() {
    if !require_tools(SIMULATOR.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    run(&output, plant_fault).unwrap();
    assert!(output.is_dir());
    assert!(run(&output, |_| {}).unwrap().passed());
    assert_eq!(file_names(dir.path()), Vec::<String>::new());
    run(&output, |job| job.trace = true).unwrap();
    run(&output, |_| {}).unwrap();
    assert_eq!(file_names(dir.path()), Vec::<String>::new());

    // A folder with files of the same names that Foveate did not write is not a replay.
    fs::create_dir(&output).unwrap();
    for name in ["replay.sh", "vectors.hex", "README.md", "waves.fst"] {
        fs::write(output.join(name), "mine").unwrap();
    }
    for edit in [|_: &mut CosimJob| {}, plant_fault] {
        let refused = run(&output, edit).unwrap_err();
        assert!(matches!(refused, CosimError::Output(StagingError::NoList { .. })), "{refused}");
    }
    assert_eq!(file_names(&output).len(), 4);
}

/// A file that a user adds to a replay, or changes in it, is kept; files that the replay's script
/// makes are removed with it.
#[test]
fn a_replay_that_a_user_changed_stays() {
    if !require_tools(SIMULATOR.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    run(&output, plant_fault).unwrap();
    let verilog = output.join("rtl").join(&file_names(&output.join("rtl"))[0]);
    let text = fs::read_to_string(&verilog).unwrap();
    for (path, mine, named) in [
        (output.join("notes.txt"), "mine".to_owned(), "notes.txt; move them".to_owned()),
        (verilog.clone(), text.clone() + "// mine\n", " (changed); move them".to_owned()),
    ] {
        fs::write(&path, &mine).unwrap();
        for edit in [|_: &mut CosimJob| {}, plant_fault, |job: &mut CosimJob| job.trace = true] {
            let refused = run(&output, edit).unwrap_err().to_string();
            assert!(refused.contains(&named), "{refused}");
            assert_eq!(fs::read_to_string(&path).unwrap(), mine);
        }
        if path == verilog { fs::write(path, &text) } else { fs::remove_file(path) }.unwrap();
    }
    let script =
        Command::new(output.join("replay.sh")).args(["iverilog", "waves"]).output().unwrap();
    assert_eq!(script.status.code(), Some(1));
    assert!(output.join("waves.fst").is_file());
    assert!(run(&output, |_| {}).unwrap().passed());
    assert!(!output.exists());
}

#[test]
fn an_interrupt_ends_the_simulation_and_leaves_nothing() {
    if !require_tools(SIMULATOR.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let flag = Arc::new(AtomicBool::new(false));
    let toolchain = Toolchain::system().with_cancel_flag(Arc::clone(&flag));
    let cache = Cache::in_folder(&dir.path().join("cache")).unwrap();
    let design = design(&DesignConfig::default(), (1, 1));
    let job =
        CosimJob::new(&design, directed_stimulus(CosimLevel::Rpu, 1), &dir.path().join("out"))
            .unwrap();
    let result = job.run(&toolchain, &cache, &mut |progress| {
        flag.store(matches!(progress, CosimProgress::Simulation { .. }), Ordering::Relaxed);
    });
    assert!(result.unwrap_err().is_interrupted());
    assert_eq!(file_names(dir.path()), ["cache"]);
    assert_eq!(file_names(cache.root()), Vec::<String>::new());
}

#[test]
fn waves_of_a_replay_are_written_when_asked_for() {
    for simulator in sample(Simulator::ALL.into_iter().rev(), 2) {
        if !require_tools(SIMULATOR.tools()) || !require_tools(simulator.tools()) {
            continue;
        }
        let dir = tempfile::tempdir().unwrap();
        let output = dir.path().join("with blank");
        run(&output, plant_fault).unwrap();
        let script =
            Command::new(output.join("replay.sh")).args([simulator.name(), "waves"]).output();
        let script = script.unwrap();
        assert_eq!(script.status.code(), Some(1), "{}", String::from_utf8_lossy(&script.stderr));
        let waves = ["waves.fst", "waves.vcd"][usize::from(simulator == Simulator::Verilator)];
        assert!(output.join(waves).is_file(), "{:?}", file_names(&output));
    }
}
