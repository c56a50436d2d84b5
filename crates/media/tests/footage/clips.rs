// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers that make clips with ffmpeg, and read all frames of a clip.

use std::path::{Path, PathBuf};
use std::process::Command;

use foveate_camera::CameraConfig;
use foveate_media::{FootageError, FrameSource, InputOptions, SourceFrame, open};
use foveate_tools::{Tool, testing::require_tools};

pub(crate) fn tools() -> bool {
    require_tools(&[Tool::Ffmpeg, Tool::Ffprobe])
}

pub(crate) fn ffmpeg(args: &[&str]) {
    let done = Command::new("ffmpeg").args(["-v", "error", "-nostdin", "-y"]).args(args).status();
    assert!(done.unwrap().success(), "{args:?}");
}

/// Makes a clip of ffmpeg's test source, with 100 frames at 25 per second unless `more` changes
/// that.
pub(crate) fn clip(folder: &Path, name: &str, more: &[&str]) -> PathBuf {
    let path = folder.join(name);
    let source = ["-f", "lavfi", "-i", "testsrc=size=80x60:rate=25:duration=4"];
    ffmpeg(&[&source[..], more, &[path.to_str().unwrap()]].concat());
    path
}

pub(crate) fn opened(
    path: &Path,
    bits: u32,
    options: &InputOptions,
) -> Result<Box<dyn FrameSource>, FootageError> {
    let bits = format!("frame.pixel_bits={bits}");
    let overrides = [bits.as_str(), "spatial.0.level=0"];
    open(&[path], &CameraConfig::from_toml_with("", &overrides).unwrap(), options)
}

pub(crate) fn frames(
    path: &Path,
    bits: u32,
    options: &InputOptions,
) -> (Vec<SourceFrame>, Option<String>) {
    let mut source = opened(path, bits, options).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = source.next_frame().unwrap() {
        frames.push(frame);
    }
    (frames, source.problem())
}

pub(crate) fn all(path: &Path) -> (Vec<SourceFrame>, Option<String>) {
    frames(path, 8, &InputOptions::default())
}
