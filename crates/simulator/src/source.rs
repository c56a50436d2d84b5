// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where frames come from: image files and scenes here; video fits behind the same trait.

use std::path::{Path, PathBuf};

use foveate_model::Frame;
use foveate_scenes::{Scene, SceneFrames, SceneSize};

use crate::{SimulatorError, picture};

/// A frame with its name and time.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// File name, or the name of the scene.
    pub name: String,
    /// Time since the first frame in microseconds.
    pub time_us: u64,
    /// The pixels.
    pub frame: Frame,
}

/// Frames of one size and depth, one at a time.
pub trait Source: Send {
    /// Width and height of every frame.
    fn size(&self) -> (u32, u32);

    /// What the user named, for the summary.
    fn inputs(&self) -> &[String];

    /// How many frames there are in all, if that is known.
    fn frames(&self) -> Option<u64>;

    /// The next frame, or `None` after the last.
    ///
    /// # Errors
    /// When it cannot be read or does not have the size of the others.
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SimulatorError>;
}

/// Frames per second as a fraction; frame t of a set of images is at t / rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    frames: u32,
    seconds: u32,
}

impl FrameRate {
    /// `frames` in `seconds`: 30 in 1, or 30000 in 1001.
    ///
    /// # Errors
    /// When one of them is zero.
    pub fn new(frames: u32, seconds: u32) -> Result<Self, SimulatorError> {
        if frames == 0 || seconds == 0 {
            return Err(SimulatorError::FrameRate { frames, seconds });
        }
        Ok(Self { frames, seconds })
    }

    /// Time of a frame in microseconds, rounded to the nearest.
    #[must_use]
    pub fn time_us(self, frame: u64) -> u64 {
        let scaled = u128::from(frame) * u128::from(self.seconds) * 1_000_000;
        let rounded = (scaled + u128::from(self.frames) / 2) / u128::from(self.frames);
        u64::try_from(rounded).unwrap_or(u64::MAX)
    }
}

impl Default for FrameRate {
    fn default() -> Self {
        Self { frames: 30, seconds: 1 }
    }
}

/// Image files in a given order.
pub(crate) struct ImageFiles {
    inputs: Vec<String>,
    paths: Vec<PathBuf>,
    next: usize,
    /// The first frame, read to learn the size.
    first: Option<Frame>,
    size: (u32, u32),
    bits: u32,
    rate: FrameRate,
}

impl ImageFiles {
    pub(crate) fn new(
        inputs: Vec<String>,
        paths: Vec<PathBuf>,
        bits: u32,
        rate: FrameRate,
    ) -> Result<Self, SimulatorError> {
        let first = match paths.first() {
            Some(path) => picture::read(path, bits)?,
            None => return Err(SimulatorError::NoFrames { inputs: inputs.join(", ") }),
        };
        let size = (first.width(), first.height());
        Ok(Self { inputs, paths, next: 0, first: Some(first), size, bits, rate })
    }

    fn refuse_other_size(&self, path: &Path, frame: &Frame) -> Result<(), SimulatorError> {
        let other_size = (frame.width(), frame.height());
        if other_size == self.size {
            return Ok(());
        }
        Err(SimulatorError::MixedSizes {
            first: self.paths.first().map(|path| path.display().to_string()).unwrap_or_default(),
            first_size: self.size,
            other: path.display().to_string(),
            other_size,
        })
    }
}

impl Source for ImageFiles {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn inputs(&self) -> &[String] {
        &self.inputs
    }

    fn frames(&self) -> Option<u64> {
        u64::try_from(self.paths.len()).ok()
    }

    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SimulatorError> {
        let Some(path) = self.paths.get(self.next) else {
            return Ok(None);
        };
        let frame = match self.first.take() {
            Some(first) => first,
            None => picture::read(path, self.bits)?,
        };
        self.refuse_other_size(path, &frame)?;
        let time_us = self.rate.time_us(u64::try_from(self.next).unwrap_or(u64::MAX));
        let name = path.display().to_string();
        self.next += 1;
        Ok(Some(SourceFrame { name, time_us, frame }))
    }
}

/// The frames of a scene.
pub(crate) struct SceneSource {
    inputs: [String; 1],
    size: SceneSize,
    frames: SceneFrames,
    next: u64,
    rate: FrameRate,
}

impl SceneSource {
    pub(crate) fn new(scene: Scene, size: SceneSize, rate: FrameRate) -> Self {
        let inputs = [format!("scene:{scene}")];
        Self { inputs, size, frames: scene.frames(size), next: 0, rate }
    }
}

impl Source for SceneSource {
    fn size(&self) -> (u32, u32) {
        (self.size.width, self.size.height)
    }

    fn inputs(&self) -> &[String] {
        &self.inputs
    }

    fn frames(&self) -> Option<u64> {
        Some(self.size.frames.into())
    }

    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SimulatorError> {
        let time_us = self.rate.time_us(self.next);
        self.next += 1;
        let [name] = self.inputs.clone();
        Ok(self.frames.next().map(|frame| SourceFrame { name, time_us, frame }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_rounded_to_the_nearest_microsecond_without_drift() {
        let rate = FrameRate::default();
        assert_eq!([0, 1, 2, 3].map(|t| rate.time_us(t)), [0, 33_333, 66_667, 100_000]);
        assert_eq!(FrameRate::new(30_000, 1_001).unwrap().time_us(30_000), 1_001_000_000);
        assert_eq!(rate.time_us(u64::MAX), u64::MAX);
        let message = FrameRate::new(0, 1).unwrap_err().to_string();
        assert!(message.starts_with("0 frames in 1 s are no frame rate"));
    }
}
