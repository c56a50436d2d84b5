// SPDX-License-Identifier: MIT OR Apache-2.0
//! view, end to end: its link is printed, and Ctrl-C ends it. What the page delivers is tested in its own crate.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Command, Stdio};

use crate::common::{fail_in, listening, succeed_in};

#[test]
fn a_stream_is_shown_until_it_is_told_to_stop() {
    let dir = tempfile::tempdir().unwrap();
    let sent = ["simulate", "scene:street", "-o", "sent", "--frames", "3", "--packets", "--quiet"];
    succeed_in(dir.path(), &sent);
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut child = listening()
            .args(["view", "sent/packets.bin"])
            .current_dir(dir.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (mut link, mut told) = (String::new(), String::new());
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut link).unwrap();
        let mut errors = BufReader::new(child.stderr.take().unwrap());
        while !told.contains("the stream has ended; frames shown: 3") {
            assert_ne!(errors.read_line(&mut told).unwrap(), 0, "{told}");
        }
        // It can be looked at after its end.
        let (host, token) = link.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
        let mut browser = TcpStream::connect(host).unwrap();
        write!(browser, "GET /{token} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut status = [0; 15];
        browser.read_exact(&mut status).unwrap();
        assert_eq!(&status, b"HTTP/1.1 200 OK");

        let id = child.id().to_string();
        assert!(
            Command::new("kill").args([&format!("-{signal}"), &id]).status().unwrap().success()
        );
        assert_eq!(child.wait().unwrap().code(), Some(code));
        errors.read_to_string(&mut told).unwrap();
        assert!(told.ends_with("foveate: interrupted after 3 frames\n"), "{told}");
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
