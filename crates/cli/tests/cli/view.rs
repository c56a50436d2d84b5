// SPDX-License-Identifier: MIT OR Apache-2.0
//! view, end to end: its link is printed, and Ctrl-C ends it. What the page delivers is tested in its own crate.
#![cfg(unix)]

use std::io::BufRead as _;

use crate::common::{fail_in, succeed_in};
use crate::served::Served;

#[test]
fn a_stream_is_shown_until_it_is_told_to_stop() {
    let dir = tempfile::tempdir().unwrap();
    let sent = ["simulate", "scene:street", "-o", "sent", "--frames", "3", "--packets", "--quiet"];
    succeed_in(dir.path(), &sent);
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut view = Served::start(dir.path(), &["view", "sent/packets.bin"]);
        let mut told = String::new();
        while !told.contains("the stream has ended; frames shown: 3") {
            assert_ne!(view.errors.read_line(&mut told).unwrap(), 0, "{told}");
        }
        // It can be looked at after its end.
        view.gives("");
        let (stopped, last) = view.stopped_by(signal);
        assert_eq!(stopped, Some(code));
        assert!(last.ends_with("foveate: interrupted after 3 frames\n"), "{told}{last}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("packets.bin"), "").unwrap();
    let refused = |args: &[&str], parts: &[&str]| {
        fail_in(dir.path(), 2, &[&["view"], args].concat(), parts);
    };
    refused(&["missing.bin"], &["missing.bin"]);
    refused(&["."], &["folder", "packets.bin"]);
    refused(&["/dev/null"], &["/dev/null", "no serial port"]);
    refused(&["-", "--play", "looped"], &["no file", "--play"]);
    refused(&["packets.bin", "--address", "0.0.0.0:8000"], &["0.0.0.0:8000", "127.0.0.1"]);
}
