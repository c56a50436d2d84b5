// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the figures of `check --clip` are those of `link`.

use std::path::Path;

use crate::common::run_successfully;
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};
use serde_json::Value;

/// The options of a scene of six small frames.
const SCENE: [&str; 4] = ["--frames", "6", "--set", "frame={width=160,height=120}"];
const RASTER: [&str; 2] = ["--preset", "raster"];

/// Returns the object `clip` of the card for the scene.
fn clip(folder: &Path, more: &[&str]) -> Value {
    let args = [&["check", "--clip", "scene:street", "--json"], &SCENE[..], more].concat();
    let card: Value = serde_json::from_str(&run_successfully(folder, &args)).unwrap();
    card["clip"].clone()
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
