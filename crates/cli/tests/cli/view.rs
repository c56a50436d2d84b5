// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `view`, end to end: its link is printed, and Ctrl-C ends it. The crate `view` tests the
//! page.
#![cfg(unix)]

use std::fs::File;
use std::io::BufRead as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::run_successfully;
use crate::served::ServedCommand;

#[test]
fn a_stream_is_shown_until_it_is_told_to_stop() {
    let dir = tempfile::tempdir().unwrap();
    let sent = ["simulate", "scene:street", "-o", "sent", "--frames", "3", "--packets", "--quiet"];
    run_successfully(dir.path(), &sent);
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut view = ServedCommand::start(dir.path(), &["view", "sent/packets.bin"]);
        let mut told = String::new();
        while !told.contains("the stream has ended; frames shown: 3") {
            assert_ne!(view.errors.read_line(&mut told).unwrap(), 0, "{told}");
        }
        // The page is served after the end of the stream, too.
        view.assert_serves("");
        let (stopped, last) = view.stop_with(signal);
        assert_eq!(stopped, Some(code));
        assert!(last.ends_with("foveate: interrupted after 3 frames\n"), "{told}{last}");
    }
}

/// The time within which a command must react to a signal.
const REACTION_LIMIT: Duration = Duration::from_secs(1);

fn fifo(folder: &Path) {
    assert!(Command::new("mkfifo").arg(folder.join("fifo")).status().unwrap().success());
}

#[test]
fn a_source_that_sends_nothing_or_noise_without_end_is_left_at_once() {
    let dir = tempfile::tempdir().unwrap();
    fifo(dir.path());
    let device = |name: &str| Stdio::from(File::open(name).unwrap());
    for signal in ["INT", "TERM"] {
        for (input, stdin) in [
            // No process writes to the FIFO.
            ("fifo", Stdio::null()),
            // A process has the pipe open and writes nothing.
            ("-", Stdio::piped()),
            ("-", device("/dev/zero")),
            ("-", device("/dev/urandom")),
        ] {
            let view = ServedCommand::start_with_input(dir.path(), &["view", input], stdin);
            view.assert_serves("next?after=0");
            std::thread::sleep(Duration::from_millis(500));
            let memory = view.memory().unwrap_or(0);
            assert!(memory < 100 << 10, "{memory} KiB");
            let start = Instant::now();
            let (code, told) = view.stop_with(signal);
            assert!(start.elapsed() < REACTION_LIMIT, "{input}: {:?}", start.elapsed());
            assert_eq!(code, Some(if signal == "INT" { 130 } else { 143 }));
            assert!(told.ends_with("foveate: interrupted after 0 frames\n"), "{told}");
        }
    }
}
