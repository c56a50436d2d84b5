// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `live`, end to end: its link is printed with the settings, Ctrl-C ends it, and the page
//! can be written as a file. The crate `view` tests what is served, and Chromium runs the page.
#![cfg(unix)]

use crate::common::run_successfully;
use crate::served::ServedCommand;

#[test]
fn frames_are_served_until_it_is_told_to_stop() {
    let dir = tempfile::tempdir().unwrap();
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let frames = ["live", "scene:street", "--frames", "2"];
        let design = ["--preset", "fovea", "--set", "region.size=16"];
        let live = ServedCommand::start(dir.path(), &[&frames[..], &design].concat());
        let (_, settings) = live.link.split_once('#').unwrap();
        assert_eq!(settings, "preset=fovea&region.size=16");
        live.assert_serves("frames?after=-1");
        let (stopped, told) = live.stop_with(signal);
        assert_eq!(stopped, Some(code));
        assert_eq!(told, "foveate: interrupted after 1 frames\n");
    }
}

#[test]
fn the_page_is_one_file() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(run_successfully(dir.path(), &["live", "--page", "page.html"]), "");
    let page = std::fs::read_to_string(dir.path().join("page.html")).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.contains("Foveate, live"));
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
}
