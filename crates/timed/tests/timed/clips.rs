// SPDX-License-Identifier: MIT OR Apache-2.0
//! Real clips, whose activity is not random.

use foveate_design::{Design, DesignConfig};
use foveate_media::{InputOptions, open};
use foveate_pixels::Frame;
use foveate_tools::{
    Tool,
    testing::{data_folder, require_tools},
};

use crate::comparison::{check, is_whole};
use crate::traffic::Traffic;

const CLIPS: [&str; 3] =
    ["video_hard/tree.avi", "video_moving/handheld_shaky.mp4", "video_static/vtest.avi"];

const DESIGNS: [&str; 7] = [
    "",
    "hardware.pipelining = 'deep'\nregion.neighborhood = 'shared'\ntemporal.reference = 'last-sent'",
    "hardware = { organization = 'serial', fold = 5 }\nrender.irrelevant = 'mean'",
    "hardware = { organization = 'serial', feed = 'raster', fold = 7 }\n\
     region.neighborhood = 'shared'",
    "hardware.organization = 'raster'",
    "hardware = { organization = 'raster', pixels_per_clock = 2, pipelining = 'deep' }\n\
     region.neighborhood = 'shared'\ntemporal.reference = 'last-sent'\nrender.irrelevant = 'mean'",
    "hardware.organization = 'raster'\ntemporal.reference = 'last-sent'\nrender.payload = 'raw'\n\
     [[spatial]]\nfeature = 'mad'\n[[spatial]]\nfeature = 'edge'",
];

fn frames(design: &Design, clip: &str, count: u32) -> Option<Vec<Frame>> {
    let path = data_folder()?.join(clip);
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return None;
    }
    let size = (design.width(), design.height());
    let options =
        InputOptions { frames: Some(count), resize: Some(size), ..InputOptions::default() };
    let mut source = open(&[path], design.camera().config(), &options).unwrap();
    let mut frames = Vec::new();
    while let Some(next) = source.next_frame().unwrap() {
        frames.push(next.frame.to_frame().unwrap());
    }
    Some(frames)
}

/// The clips are in the folder that the environment variable `FOVEATE_DATA` names. Every other
/// design has a sink that takes a word in two of three clocks and stalls from time to time.
#[test]
fn every_transaction_of_real_clips_has_its_clock() {
    let (size, count) = if is_whole() { ((320, 240), 60) } else { ((88, 72), 8) };
    for (number, keys) in DESIGNS.iter().enumerate() {
        let toml = format!("frame = {{ width = {}, height = {} }}\n{keys}", size.0, size.1);
        let design = DesignConfig::from_toml(&toml).unwrap().validate().unwrap();
        for clip in CLIPS {
            let Some(frames) = frames(&design, clip, count) else { return };
            let stalls = Traffic { longest_ready: 40, longest_stall: 20, ..Traffic::DENSE };
            let traffic = if number % 2 == 0 { stalls } else { Traffic::DENSE };
            let recorded = check(&design, traffic, &frames);
            assert!(recorded.events.len() > frames.len(), "{clip}, {keys}");
        }
    }
}
