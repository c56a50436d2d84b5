// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of signals while the program waits for ffmpeg, a FIFO, standard input or a camera in the
//! network. It must end within a second with the complete results so far and the right exit code,
//! and no ffmpeg may remain.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::Write;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

use crate::common::foveate_with_signals;
use crate::signals::{SIGNALS, has_ended, has_temporary_file, kill, wait_for};

/// The time limit for the end of the program, long enough for a busy machine.
const END_LIMIT: Duration = Duration::from_secs(4);

/// A folder with a stub of ffmpeg: a script that records its process number, and then runs the
/// test's commands in place of the real ffmpeg or after it.
struct FfmpegStub {
    dir: tempfile::TempDir,
}

impl FfmpegStub {
    /// Makes the stub. `script` runs unless the version is asked for; `$REAL` is the real ffmpeg.
    fn new(script: &str) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let real = Command::new("sh").args(["-c", "command -v ffmpeg"]).output().unwrap();
        let real = String::from_utf8(real.stdout).unwrap();
        let text = format!(
            "#!/bin/sh\nREAL={}\n[ \"$1\" = -version ] && exec $REAL -version\necho $$ >> '{}'\n{script}\n",
            real.trim(),
            dir.path().join("pids").display(),
        );
        let path = dir.path().join("ffmpeg");
        fs::write(&path, text).unwrap();
        assert!(Command::new("chmod").arg("+x").arg(&path).status().unwrap().success());
        Self { dir }
    }

    /// Writes clips of five frames.
    fn clips(&self, names: &[&str]) {
        for name in names {
            let made = Command::new("ffmpeg")
                .args([
                    "-v",
                    "error",
                    "-f",
                    "lavfi",
                    "-i",
                    "testsrc=size=64x48:rate=10:duration=0.5",
                ])
                .args(["-c:v", "ffv1"])
                .arg(self.path_of(name))
                .status();
            assert!(made.unwrap().success());
        }
    }

    fn path_of(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = foveate_with_signals();
        command
            .args(args)
            .current_dir(self.dir.path())
            .env("FOVEATE_FFMPEG", self.path_of("ffmpeg"))
            .env("FOVEATE_PROGRESS", "0")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    fn start(&self, args: &[&str]) -> Child {
        self.command(args).spawn().unwrap()
    }

    /// Returns the process numbers of all started stubs.
    fn process_numbers(&self) -> Vec<String> {
        let text = fs::read_to_string(self.path_of("pids")).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }

    /// Waits until the stub runs, stops the program, and checks that it ends soon and that no stub
    /// remains. Returns its messages.
    fn stop_alone(&self, child: Child, signal: &str, code: i32) -> String {
        wait_for("ffmpeg", || !self.process_numbers().is_empty());
        std::thread::sleep(Duration::from_millis(300));
        let output = stop_and_check(child, signal, code);
        assert!(self.process_numbers().iter().all(|pid| has_ended(pid)), "an ffmpeg remains");
        let _ = fs::remove_file(self.path_of("pids"));
        String::from_utf8_lossy(&output.stderr).into_owned()
    }
}

/// Sends a signal to a waiting program, and checks that it ends soon with this exit code.
fn stop_and_check(mut child: Child, signal: &str, code: i32) -> Output {
    assert!(child.try_wait().unwrap().is_none(), "it does not wait");
    let start = Instant::now();
    kill(child.id(), signal);
    wait_for("end of the program", || child.try_wait().unwrap().is_some());
    let took = start.elapsed();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{signal}: {said}");
    assert!(took < END_LIMIT, "{signal}: {took:?}: {said}");
    output
}

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

fn interrupted_after(folder: &Path, frames: u64) {
    let summary = summary(folder);
    assert_eq!((&summary["complete"], &summary["problem"]), (&false.into(), &"interrupted".into()));
    assert_eq!(summary["frames"], frames);
}

fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

fn stream(frames: usize) -> Vec<u8> {
    let mut bytes = b"YUV4MPEG2 W64 H48 F25:1 Cmono\n".to_vec();
    for frame in 0..frames {
        bytes.extend(b"FRAME\n");
        bytes.resize(bytes.len() + 64 * 48, u8::try_from(frame).unwrap());
    }
    bytes
}

fn has_frames(folder: &Path, frames: usize) -> bool {
    let picture = format!("rendered/{:06}.png", frames - 1);
    has_temporary_file(folder, &picture)
}

const STALLED: &str = "exec sleep 600";
/// The stub gives all frames, and then neither an end nor more frames.
const STALLED_LATER: &str = "$REAL \"$@\"\nsleep 600";

#[test]
fn an_ffmpeg_that_stalls_ends_with_every_command() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let stub = FfmpegStub::new(STALLED);
    stub.clips(&["a.mkv", "b.mkv"]);
    let activity = ["analyze", "activity", "a.mkv", "b.mkv", "-o", "out"];
    let commands: [&[&str]; 8] = [
        &["simulate", "a.mkv", "-o", "out"],
        &["simulate", "a.mkv", "b.mkv", "-o", "out"],
        &["explain", "a.mkv", "--frame", "1", "--region", "0,0"],
        &activity,
        &["link", "a.mkv", "-o", "out"],
        &["live", "a.mkv"],
        &["bench", "a.mkv"],
        &["explore", "designs", "a.mkv", "-o", "explored", "--no-area"],
    ];
    for (turn, args) in commands.into_iter().enumerate() {
        let (signal, code) = SIGNALS[turn % 3];
        let said = stub.stop_alone(stub.start(args), signal, code);
        assert!(said.contains("interrupted"), "{args:?}: {said}");
        assert!(!stub.path_of("out").exists(), "{args:?}");
    }
}

#[test]
fn frames_before_an_ffmpeg_that_stalls_are_kept_and_so_are_finished_clips() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let stub = FfmpegStub::new(STALLED_LATER);
    stub.clips(&["a.mkv"]);
    for (signal, code) in SIGNALS {
        let child = stub.start(&["simulate", "a.mkv", "-o", "out"]);
        wait_for("frames", || has_frames(stub.dir.path(), 5));
        stub.stop_alone(child, signal, code);
        interrupted_after(&stub.path_of("out"), 5);
        fs::remove_dir_all(stub.path_of("out")).unwrap();
    }
    let batch = FfmpegStub::new("case \"$*\" in *b.mkv*) exec sleep 600;; esac\nexec $REAL \"$@\"");
    batch.clips(&["a.mkv", "b.mkv", "c.mkv"]);
    let clips = ["simulate", "a.mkv", "b.mkv", "c.mkv", "-o", "out", "--threads", "2"];
    let child = batch.start(&clips);
    let done = |name: &str| has_temporary_file(batch.dir.path(), &format!("{name}/summary.json"));
    wait_for("clips", || done("a") && done("c"));
    batch.stop_alone(child, "TERM", 143);
    let whole = summary(&batch.path_of("out"));
    assert_eq!((&whole["complete"], &whole["problem"]), (&false.into(), &"interrupted".into()));
    let clips = whole["clips"].as_array().unwrap();
    let complete: Vec<_> = clips.iter().map(|clip| clip["complete"].as_bool().unwrap()).collect();
    assert_eq!(complete, [true, false, true], "{clips:?}");
    assert_eq!(clips[1]["problem"], "interrupted");
}

#[test]
fn pipes_that_stall_end_with_the_program() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fifo(&at("in"));
    let start = |args: &[&str], stdin: Stdio| {
        let mut command = foveate_with_signals();
        command.args(args).current_dir(dir.path()).stdin(stdin).stdout(Stdio::null());
        command.stderr(Stdio::piped()).spawn().unwrap()
    };
    for (signal, code) in SIGNALS {
        // No process writes.
        for args in [
            &["simulate", "in", "-o", "out"][..],
            &["decode", "in", "-o", "out"],
            &["check", "--config", "in"],
        ] {
            let child = start(args, Stdio::null());
            std::thread::sleep(Duration::from_millis(300));
            stop_and_check(child, signal, code);
        }
        for args in [
            &["simulate", "-", "-o", "out"][..],
            &["decode", "-", "-o", "out"],
            &["check", "--config", "-"],
        ] {
            let mut child = start(args, Stdio::piped());
            let stdin = child.stdin.take();
            std::thread::sleep(Duration::from_millis(300));
            if child.try_wait().unwrap().is_none() {
                stop_and_check(child, signal, code);
            } else {
                assert_eq!(args[0], "check", "a configuration is a file");
            }
            drop(stdin);
        }
        // A process writes some frames.
        let mut child = start(&["simulate", "-", "-o", "out"], Stdio::piped());
        let mut stdin = child.stdin.take().unwrap();
        stdin.write_all(&stream(3)).unwrap();
        wait_for("frames", || has_frames(dir.path(), 3));
        stop_and_check(child, signal, code);
        interrupted_after(&at("out"), 3);
        fs::remove_dir_all(at("out")).unwrap();
        let child = start(&["simulate", "in", "-o", "out"], Stdio::null());
        let mut writer = File::create(at("in")).unwrap();
        writer.write_all(&stream(4)[..3 * 3078 + 100]).unwrap();
        wait_for("frames", || has_frames(dir.path(), 3));
        stop_and_check(child, signal, code);
        interrupted_after(&at("out"), 3);
        fs::remove_dir_all(at("out")).unwrap();
    }
}

#[test]
fn a_camera_in_the_network_that_never_answers_is_left() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("rtsp://me:secret@{}/live?key=secret", silent.local_addr().unwrap());
    let stub = FfmpegStub::new("exec $REAL \"$@\"");
    for (command, (signal, code)) in ["simulate", "analyze", "live"].into_iter().zip(SIGNALS) {
        let args: &[&str] = match command {
            "simulate" => &["simulate", &url, "-o", "out"],
            "analyze" => &["analyze", "activity", &url, "-o", "out"],
            _ => &["live", &url],
        };
        let child = stub.start(args);
        let _connected = silent.accept().unwrap();
        let said = stub.stop_alone(child, signal, code);
        assert!(!said.contains("secret"), "{said}");
        assert!(!stub.path_of("out").exists());
    }
}

/// These stubs never end by themselves. Two of them say that a wait is over, one nothing, and one something else.
#[test]
fn a_camera_in_the_network_that_is_silent_is_not_waited_for() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let lost = "Connection to tcp://10.9.9.9:554 failed: Connection timed out";
    let runs = [
        (
            "echo '[error] rtsp://cam/live: Connection timed out' >&2".to_owned(),
            0,
            ["it has sent nothing for 10 s", "it sends no pictures"],
        ),
        (format!("echo '[tcp @ 0x1] [error] {lost}' >&2"), 0, [lost, "can be reached from here"]),
        (String::new(), 15, ["it has sent nothing for 15 s", "it sends no pictures"]),
        // The lines that ffmpeg prints meanwhile are no pictures.
        (
            "(for _ in 1 2 3 4 5 6; do sleep 4; echo '[info] Input #0' >&2; done) &".to_owned(),
            15,
            ["it has sent nothing for 15 s", "it sends no pictures"],
        ),
    ];
    let start = Instant::now();
    let runs = runs.map(|(script, seconds, parts)| {
        let stub = FfmpegStub::new(&format!("{script}\nexec sleep 60"));
        let child = stub.start(&["simulate", "rtsp://cam/live", "-o", "out"]);
        (stub, child, Duration::from_secs(seconds), parts)
    });
    for (stub, mut child, silence, parts) in runs {
        let limit = silence + 2 * END_LIMIT;
        while child.try_wait().unwrap().is_none() {
            if start.elapsed() > limit {
                kill(child.id(), "TERM");
                panic!("it still waits after {limit:?}: {parts:?}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(start.elapsed() >= silence, "{:?}", start.elapsed());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
        assert!(stub.process_numbers().iter().all(|pid| has_ended(pid)), "an ffmpeg remains");
    }
}

/// This encoder takes every frame and never ends. The first Ctrl-C gives it time, the second none.
#[test]
fn a_second_ctrl_c_ends_everything_at_once() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let stub = FfmpegStub::new("cat > /dev/null\nsleep 600");
    let args = ["simulate", "scene:street", "-o", "out", "--frames", "100000", "--rendered", "mkv"];
    let child = stub.start(&args);
    wait_for("encoder", || !stub.process_numbers().is_empty());
    kill(child.id(), "INT");
    std::thread::sleep(Duration::from_millis(500));
    stub.stop_alone(child, "INT", 130);
}

/// This encoder takes nothing. The other results are kept, and the video is named.
#[test]
fn an_encoder_that_stalls_is_given_up() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let stub = FfmpegStub::new(STALLED);
    let set = ["--set", "frame.width=640", "--set", "frame.height=480"];
    let args = ["simulate", "scene:street", "-o", "out", "--frames", "100000", "--rendered", "mkv"];
    let child = stub.start(&[&args[..], &set].concat());
    stub.stop_alone(child, "TERM", 143);
    let problem = summary(&stub.path_of("out"))["problem"].as_str().unwrap().to_owned();
    assert!(problem.starts_with("interrupted"), "{problem}");
    assert!(!stub.path_of("out/rendered.mkv").exists());
}
