// SPDX-License-Identifier: MIT OR Apache-2.0
//! live, end to end: its link is printed with the settings, Ctrl-C ends it, and the page can be had as a file. What is served is
//! tested in the crate `view`, the page in Chromium.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Command, Stdio};

use crate::common::{fail_in, listening, run_in, succeed_in};

#[test]
fn frames_are_served_until_it_is_told_to_stop() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut child = listening()
            .args(["live", "scene:street", "--frames", "2", "--preset", "fovea"])
            .args(["--set", "region.size=16"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut link = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut link).unwrap();
        let (address, settings) = link.trim().split_once('#').unwrap();
        assert_eq!(settings, "preset=fovea&region.size=16");
        let (host, token) = address.strip_prefix("http://").unwrap().split_once('/').unwrap();
        let mut browser = TcpStream::connect(host).unwrap();
        write!(browser, "GET /{token}frames?after=-1 HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut status = [0; 15];
        browser.read_exact(&mut status).unwrap();
        assert_eq!(&status, b"HTTP/1.1 200 OK");

        let id = child.id().to_string();
        let killed = Command::new("kill").args([&format!("-{signal}"), &id]).status().unwrap();
        assert!(killed.success());
        assert_eq!(child.wait().unwrap().code(), Some(code));
        let mut told = String::new();
        child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
        assert_eq!(told, "foveate: interrupted after 1 frames\n");
    }
}

#[test]
fn the_page_is_one_file() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(succeed_in(dir.path(), &["live", "--page", "page.html"]), "");
    let page = std::fs::read_to_string(dir.path().join("page.html")).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.contains("Foveate, live"));
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    fail_in(dir.path(), 2, &["live", "--page", "no/page.html"], &["no/page.html"]);
    let both = run_in(dir.path(), &["live", "x.mp4", "--page", "page.html"]);
    assert!(both.code == 2 && both.stderr.contains("cannot be used with"), "{}", both.stderr);
}

#[test]
fn what_cannot_be_played_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], parts: &[&str]| {
        fail_in(dir.path(), 2, &[&["live"], args].concat(), parts);
    };
    refused(&["missing.mp4"], &["`missing.mp4` does not exist"]);
    refused(&["--set", "region.size=65"], &["region.size", "65"]);
    refused(&["--preset", "nonsense"], &["nonsense", "fovea"]);
    refused(&["--address", "0.0.0.0:8000"], &["0.0.0.0:8000", "127.0.0.1"]);
}
