// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of signals that ask the command to stop, as terminals, containers, Slurm and systemd send
//! them.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

use crate::common::foveate_with_signals;

/// The signals and their exit codes, which are 128 plus the number of the signal.
pub(crate) const SIGNALS: [(&str, i32); 3] = [("INT", 130), ("TERM", 143), ("HUP", 129)];

fn start(folder: &Path, args: &[&str]) -> Child {
    foveate_with_signals()
        .args(args)
        .current_dir(folder)
        .env("FOVEATE_PROGRESS", "0")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Sends a signal, waits for the end, and returns the output.
fn stop(child: Child, signal: &str) -> Output {
    kill(child.id(), signal);
    child.wait_with_output().unwrap()
}

pub(crate) fn kill(pid: u32, signal: &str) {
    let kill = Command::new("kill").args([format!("-{signal}"), pid.to_string()]).status();
    assert!(kill.unwrap().success());
}

pub(crate) fn wait_for(what: &str, mut there: impl FnMut() -> bool) {
    let patience = Instant::now() + Duration::from_secs(120);
    while !there() {
        assert!(Instant::now() < patience, "no {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Returns true if a temporary folder below `folder` holds this file.
pub(crate) fn has_temporary_file(folder: &Path, file: &str) -> bool {
    let entries = fs::read_dir(folder).unwrap().flatten();
    entries.filter(|e| e.path().is_dir()).any(|entry| entry.path().join("work").join(file).exists())
}

fn problem(folder: &Path) -> (bool, String) {
    let summary = fs::read(folder.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    (summary["complete"].as_bool().unwrap(), summary["problem"].as_str().unwrap().to_owned())
}

#[test]
fn every_signal_leaves_what_was_done() {
    for (signal, code) in SIGNALS {
        let dir = tempfile::tempdir().unwrap();
        let args = ["simulate", "scene:street", "-o", "out", "--frames", "100000"];
        let child = start(dir.path(), &args);
        wait_for("picture", || has_temporary_file(dir.path(), "rendered/000001.png"));
        let output = stop(child, signal);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{signal}: {said}");
        assert!(said.contains("interrupted") && said.contains("`out`"), "{signal}: {said}");
        let names: Vec<_> =
            fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(names, ["out"], "{signal}");
        assert_eq!(problem(&dir.path().join("out")), (false, "interrupted".to_owned()), "{signal}");
    }
}

/// `timeout` and job systems send more than one signal. Only a second Ctrl-C means that a person
/// wants the command to end at once.
#[test]
fn a_second_sigterm_changes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let child = start(dir.path(), &["simulate", "scene:street", "-o", "out", "--frames", "100000"]);
    wait_for("picture", || has_temporary_file(dir.path(), "rendered/000001.png"));
    for _ in 0..3 {
        kill(child.id(), "TERM");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(143));
    assert_eq!(problem(&dir.path().join("out")), (false, "interrupted".to_owned()));
}

/// `nohup` starts a command with this signal ignored.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_ignored_stays_ignored() {
    let dir = tempfile::tempdir().unwrap();
    let script = format!(
        "trap '' HUP; exec '{}' simulate scene:street -o out --frames 300 --no-rendered",
        env!("CARGO_BIN_EXE_foveate")
    );
    let child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(dir.path())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for("table", || has_temporary_file(dir.path(), "frames.csv"));
    assert_eq!(stop(child, "HUP").status.code(), Some(0));
}

/// The running tool ends, too, and no folder is left.
#[test]
fn sigterm_stops_a_tool() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let (temporary, tools) = (dir.path().join("tmp"), dir.path().join("tools"));
    for folder in [&temporary, &tools] {
        fs::create_dir(folder).unwrap();
    }
    // This Yosys starts another program, as verilator and iverilog do, and never ends.
    let wrapper = tools.join("yosys");
    let script =
        "#!/bin/sh\n[ \"$1\" = -V ] && exec yosys -V\nsleep 600 & echo $! > \"$PIDS\"; wait\n";
    fs::write(&wrapper, script).unwrap();
    assert!(Command::new("chmod").arg("+x").arg(&wrapper).status().unwrap().success());
    let pids = dir.path().join("pids");
    let child = foveate_with_signals()
        .args(["estimate", "--preset", "bare"])
        .env("FOVEATE_YOSYS", &wrapper)
        .env("FOVEATE_CACHE", "off")
        .env("TMPDIR", &temporary)
        .env("PIDS", &pids)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for("tool", || fs::read_to_string(&pids).is_ok_and(|text| text.ends_with('\n')));
    let output = stop(child, "TERM");
    assert_eq!(output.status.code(), Some(143), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
    let pid = fs::read_to_string(&pids).unwrap();
    wait_for("end of the tool", || has_ended(pid.trim()));
}

/// No part of a comparison is worth keeping; its temporary files are removed, too.
#[test]
fn a_comparison_of_links_leaves_nothing() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let temporary = dir.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    let child = foveate_with_signals()
        .args(["link", "scene:street", "-o", "out", "--max-frames", "200", "--codecs", "h264"])
        .current_dir(dir.path())
        .env("TMPDIR", &temporary)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for("stream", || has_temporary_file(&temporary, "clip.h264"));
    let output = stop(child, "INT");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.ends_with("foveate: interrupted; nothing was written\n"), "{said}");
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "only the folder for temporary files");
}

/// Returns true if no process has this number, or if only its parent has not yet noticed its end.
pub(crate) fn has_ended(pid: &str) -> bool {
    let state = Command::new("ps").args(["-o", "stat=", "-p", pid]).output();
    match state {
        Ok(output) => output.stdout.is_empty() || output.stdout.starts_with(b"Z"),
        Err(_) => {
            fs::read_to_string(format!("/proc/{pid}/stat")).map_or(true, |s| s.contains(") Z "))
        }
    }
}

/// Job systems signal every process of a job. This includes ffmpeg, which then ends as it does at
/// the end of a video.
#[test]
fn a_signal_to_the_whole_job_leaves_what_was_done() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    for rendered in ["png", "mkv"] {
        let dir = tempfile::tempdir().unwrap();
        let clip =
            ["-v", "error", "-f", "lavfi", "-i", "testsrc2=size=640x480:rate=25:duration=60"];
        let mut ffmpeg = Command::new("ffmpeg");
        let made =
            ffmpeg.args(clip).args(["-c:v", "mpeg4", "in.mkv"]).current_dir(dir.path()).status();
        assert!(made.unwrap().success());
        let child = start(dir.path(), &["simulate", "in.mkv", "-o", "out", "--rendered", rendered]);
        wait_for("frames", || {
            let entries = fs::read_dir(dir.path()).unwrap().flatten();
            entries
                .map(|e| e.path().join("work/srs.npy"))
                .any(|p| p.metadata().is_ok_and(|m| m.len() > 50_000))
        });
        let below = Command::new("pgrep").args(["-P", &child.id().to_string()]).output().unwrap();
        let below = String::from_utf8(below.stdout).unwrap();
        assert!(!below.trim().is_empty(), "no ffmpeg at work");
        let all: Vec<&str> = below.split_whitespace().collect();
        assert!(
            Command::new("kill")
                .arg("-TERM")
                .args(&all)
                .arg(child.id().to_string())
                .status()
                .unwrap()
                .success()
        );
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(143), "{rendered}: {said}");
        let (complete, problem) = problem(&dir.path().join("out"));
        assert!(!complete && problem.starts_with("interrupted"), "{rendered}: {problem}");
    }
}
