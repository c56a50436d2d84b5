// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `check --clip`: its figures are those of `link`, and each clip or clock that it cannot
//! take is refused.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};
use serde_json::Value;

/// The options of a scene of six small frames.
const SCENE: [&str; 4] = ["--frames", "6", "--set", "frame={width=160,height=120}"];
/// A core that sends only decisions.
const SILENT: &str = "hardware={organization='raster',forward=false}";
const RASTER: [&str; 2] = ["--preset", "raster"];

/// Returns the object `clip` of the card for the scene.
fn clip(folder: &Path, more: &[&str]) -> Value {
    let args = [&["check", "--clip", "scene:street", "--json"], &SCENE[..], more].concat();
    let card: Value = serde_json::from_str(&run_successfully(folder, &args)).unwrap();
    card["clip"].clone()
}

/// Returns the text without the breaks of lines.
fn text(folder: &Path, more: &[&str]) -> String {
    let args = [&["check", "--clip", "scene:street"], &SCENE[..], more].concat();
    run_successfully(folder, &args).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_figures_of_a_clip_are_those_of_link() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let serial = ["--preset", "serial", "--set", "hardware.fold=3"];
    for design in [&[][..], &serial, &RASTER] {
        let options = [&["--clock", "90MHz", "--link", "1Mbit"][..], &[]];
        for more in sample(options, 2) {
            let args = ["link", "scene:street", "-o", "out", "--force", "--json"];
            let args = [&args[..], &["--codecs", "mjpeg"], &SCENE, design, more].concat();
            let link: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
            let expected = &link["clips"][0];
            let is_array = |sender: &&Value| sender["sender"] == "region array";
            let array = expected["senders"].as_array().unwrap().iter().find(is_array).unwrap();
            let found = clip(dir.path(), &[design, more].concat());
            for key in ["name", "inputs", "problem", "frames", "duration_ns"] {
                assert_eq!(found[key], expected[key], "{design:?} {more:?}: {key}");
            }
            for key in ["figures", "unbuffered"] {
                assert_eq!(found["array"][key], array[key], "{design:?} {more:?}: {key}");
            }
            for key in ["link_bits_per_second", "clock_hz"] {
                assert_eq!(found[key], link[key], "{design:?} {more:?}: {key}");
            }
            // A pipelined array needs a slower clock than the region camera by rows of `link`.
            if !design.is_empty() {
                assert_eq!(found["needed_clock_hz"], expected["needed_clock_hz"], "{design:?}");
                assert_eq!(found["array"]["added_clocks"], expected["array_clocks"], "{design:?}");
            }
        }
    }
}

#[test]
fn a_clip_says_which_clock_and_which_buffer_it_needs() {
    let dir = tempfile::tempdir().unwrap();
    let slow = ["--clock", "90MHz", "--link", "100kbit"];
    let slow = text(dir.path(), &[&RASTER[..], &slow].concat());
    for part in [
        "clip street: 6 frames in 200.000 ms, in front of a link with 0.1 Mbit/s",
        "is the slowest that keeps up; 90 MHz keeps up",
        "latency at most ",
        "and a longer clip needs more: it has ",
        "without buffer lost regions: ",
        "of 6 frames, first in frame 0 at 90 MHz; the link takes the last word",
    ] {
        assert!(slow.contains(part), "{part}: {slow}");
    }
    let fast = text(dir.path(), &[&RASTER[..], &["--clock", "90MHz"]].concat());
    for part in ["with 100 Mbit/s", "link lose nothing without", "no region is lost at 90 MHz"] {
        assert!(fast.contains(part), "{part}: {fast}");
    }
    // A pipelined array has no losses, and without a clock its clocks are left out.
    let pipelined = text(dir.path(), &[]);
    assert!(!pipelined.contains("without buffer"), "{pipelined}");
    // A frame is taken in 64 clocks, 30 times a second. 33,333 us are the shortest interval.
    let line = "clip clock 1.921 kHz is the slowest that keeps up latency";
    assert!(pipelined.contains(line), "{pipelined}");
    assert!(
        pipelined.contains("without --clock: at 1.921 kHz the array adds up to "),
        "{pipelined}"
    );
    // Without a clip the card has none.
    assert!(!run_successfully(dir.path(), &["check", "--json"]).contains("\"clip\""));
}

#[test]
fn a_clock_that_does_not_keep_up_with_a_clip_fails() {
    let dir = tempfile::tempdir().unwrap();
    let check = ["check", "--clip", "scene:street"];
    let at =
        |clock, more: &[&'static str]| [&check[..], &SCENE, &["--clock", clock], more].concat();
    let parts = ["1.92 kHz does not keep up with `street`", "at least 1.921 kHz"];
    let found = expect_failure(dir.path(), 1, &at("1920", &[]), &parts);
    let words = found.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = "1.921 kHz is the slowest that keeps up; 1.92 kHz does not keep up";
    assert!(words.contains(line), "{words}");
    assert!(!found.stdout.contains("\nlatency") && !found.stdout.contains("\nbuffer"));
    let found = expect_failure(dir.path(), 1, &at("1920", &["--json"]), &parts);
    let card: Value = serde_json::from_str(&found.stdout).unwrap();
    assert_eq!(card["clip"]["array"], Value::Null);
    assert_eq!(card["clip"]["needed_clock_hz"], 1921);
    assert_eq!(run_successfully(dir.path(), &at("1921", &["--quiet"])), "");
    assert_eq!(expect_failure(dir.path(), 1, &at("1920", &["--quiet"]), &parts).stdout, "");
    // Both checks fail, and both are named.
    let both = ["1000 frames/s are not reached", "1.92 kHz does not keep up"];
    expect_failure(dir.path(), 1, &at("1920", &["--min-fps", "1000"]), &both);
    let quiet = [&check[..], &SCENE, &["--quiet"]].concat();
    expect_failure(dir.path(), 2, &quiet, &["keeps up with --clip", "give --clock"]);
}

#[test]
fn what_is_no_clip_for_a_design_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let image = [&b"P5 16 16 255\n"[..], &[7; 256]].concat();
    fs::create_dir(dir.path().join("images")).unwrap();
    for name in ["one.pgm", "images/a.pgm", "images/b.pgm"] {
        fs::write(dir.path().join(name), &image).unwrap();
    }
    let clip = b"YUV4MPEG2 W16 H16 F30:1 Cmono\n".to_vec();
    let clip = [clip, [&b"FRAME\n"[..], &[7; 256]].concat().repeat(3)].concat();
    fs::create_dir(dir.path().join("clips")).unwrap();
    for name in ["clips/a.y4m", "clips/b.y4m"] {
        fs::write(dir.path().join(name), &clip).unwrap();
    }
    fs::write(dir.path().join("size.toml"), "frame = { width = 32, height = 16 }\n").unwrap();
    for (args, parts) in [
        (&["--clip", "one.pgm"][..], ["`one` has 1 frame", "at least 2 frames"]),
        (&["--clip", "images", "--images", "set"], ["unrelated images", "--images clip"]),
        (&["--clip", "clips"], ["`clips` has 2 clips", "clips/a.y4m"]),
        (&["--clip", "absent.mp4"], ["absent.mp4", "not"]),
        (&["--clip", "-"], ["`-` can be read only once", "record it to a file"]),
        (
            &["--clip", "scene:street", "--frames", "3", "--set", SILENT],
            ["hardware.forward = false", "leave the key out"],
        ),
        (&["size.toml", "--clip", "clips/a.y4m"], ["frame.width", "16"]),
    ] {
        expect_failure(dir.path(), 2, &[&["check"], args].concat(), &parts);
    }
    // Options about a clip have no meaning without it.
    for alone in [["--link", "1Mbit"], ["--frames", "3"], ["--resize", "32x32"]] {
        let found = run_in(dir.path(), &[&["check"], &alone[..]].concat());
        assert_eq!(found.code, 2, "{alone:?}");
        assert!(found.stderr.contains("--clip <INPUT>"), "{}", found.stderr);
    }
    let wrong = ["check", "--clip", "clips/a.y4m", "--link", "100"];
    let found = run_in(dir.path(), &wrong);
    assert_eq!((found.code, found.stderr.contains("100Mbit")), (2, true), "{}", found.stderr);
    // Images are a clip by default, and a clip may be cut.
    run_successfully(dir.path(), &["check", "--clip", "images", "--rate", "25"]);
    let last = ["check", "clip.toml", "--clip", "clips/a.y4m", "--max-frames", "2", "--json"];
    fs::write(dir.path().join("clip.toml"), "region.size = 4\n").unwrap();
    let card: Value = serde_json::from_str(&run_successfully(dir.path(), &last)).unwrap();
    assert_eq!((&card["clip"]["frames"], &card["grid"]["columns"]), (&2.into(), &4.into()));
}
