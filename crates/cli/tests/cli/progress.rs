// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of progress in a log: a line now and then, and no line if the command is quiet.

use std::io::Write as _;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Returns the messages of a run over two frames, of which the second comes after more than a
/// second.
fn messages(options: &[&str], every: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_foveate"))
        .args(["simulate", "-", "-o", "out", "--no-rendered"])
        .args(options)
        .current_dir(dir.path())
        .env("FOVEATE_PROGRESS", every)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"YUV4MPEG2 W16 H16 F1:1 Cmono\n").unwrap();
    for _ in 0..2 {
        input.write_all(b"FRAME\n").unwrap();
        input.write_all(&[7; 256]).unwrap();
        input.flush().unwrap();
        std::thread::sleep(Duration::from_millis(1500));
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    said
}

#[test]
fn a_log_gets_a_line_now_and_then() {
    let said = messages(&[], "1");
    assert!(said.lines().count() >= 1, "no line");
    for line in said.lines() {
        assert!(line.starts_with("foveate: ") && line.contains("frames after"), "{said}");
    }
}

#[test]
fn quiet_runs_and_users_who_want_no_lines_get_none() {
    assert_eq!(messages(&["--quiet"], "1"), "");
    assert_eq!(messages(&[], "0"), "");
    let wrong = messages(&[], "often");
    assert!(wrong.contains("FOVEATE_PROGRESS is `often`; expected seconds"), "{wrong}");
    assert_eq!(wrong.lines().count(), 1, "{wrong}");
}
