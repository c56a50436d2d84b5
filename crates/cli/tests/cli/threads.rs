// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `--threads` and RAYON_NUM_THREADS: the number of threads, the precedence, and equal
//! results.

use std::path::Path;

use crate::common::{files_below, foveate, run_successfully};

const VARIABLE: &str = "RAYON_NUM_THREADS";

#[test]
fn every_number_gives_the_same_files() {
    let dir = tempfile::tempdir().unwrap();
    let files = |threads: &[&str], variable: &str| {
        let args = ["simulate", "scene:street", "-o", "out", "--frames", "4", "--quiet", "--force"];
        let mut command = foveate(&[&args[..], threads].concat());
        let status = command.current_dir(dir.path()).env(VARIABLE, variable).output().unwrap();
        assert!(status.status.success(), "{status:?}");
        let mut files = files_below(&dir.path().join("out"));
        // This file has the duration of the run.
        files.retain(|(name, _)| name != Path::new("summary.json"));
        files
    };
    let one = files(&["--threads", "1"], "");
    for threads in ["0", "2", "256"] {
        assert!(files(&["--threads", threads], "") == one, "{threads}");
    }
    assert!(files(&[], "3") == one && files(&[], "0") == one);
    // The option takes precedence, even over an invalid variable.
    assert!(files(&["--threads", "2"], "100000") == one);
}

#[test]
fn every_command_that_shares_its_work_says_so() {
    let dir = tempfile::tempdir().unwrap();
    for command in ["simulate", "dataset", "analyze", "explore", "fit", "infer", "stress"] {
        assert!(
            run_successfully(dir.path(), &[command, "--help"]).contains("--threads <N>"),
            "{command}"
        );
    }
}

/// Returns the number of threads of a running simulation.
#[cfg(target_os = "linux")]
fn running_threads(folder: &Path, asked: &str, variable: &str) -> usize {
    use std::time::{Duration, Instant};
    let frames = ["--frames", "1000000", "--quiet", "--no-rendered"];
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_foveate"));
    command.args(["simulate", "scene:street", "-o", "out", "--threads", asked]).args(frames);
    let mut child = command.current_dir(folder).env(VARIABLE, variable).spawn().unwrap();
    let count = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("Threads:")).unwrap();
        line.trim().parse::<usize>().unwrap()
    };
    // This is the largest number of threads until it has not changed for a second.
    let (mut most, mut since) = (0, Instant::now());
    while since.elapsed() < Duration::from_secs(1) {
        if count() > most {
            (most, since) = (count(), Instant::now());
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    most
}

#[test]
#[cfg(target_os = "linux")]
fn there_are_as_many_as_were_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let one = running_threads(dir.path(), "1", "");
    assert_eq!(running_threads(dir.path(), "40", ""), one + 39);
    assert_eq!(running_threads(dir.path(), "1", "40"), one, "the option wins");
}
