// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames with the most lost and added detections, as the receiver shows them.

use std::io::Cursor;

use crate::camera::ReceivedFrame;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use foveate_camera::Camera;
use foveate_network::vision::{DetectionCounts, DetectionPairs};
use foveate_pixels::convert_depth;
use image::{ImageFormat, ImageResult, Luma};

/// The number of frames that are kept.
const MAX_SCREENS: usize = 6;

/// A frame with its detections.
#[derive(Clone, Debug)]
pub(crate) struct KeptScreen {
    pub(crate) clip: String,
    pub(crate) number: u64,
    pub(crate) name: String,
    pub(crate) pairs: DetectionPairs,
    screen: Vec<u16>,
}

/// The frames with the most differences.
#[derive(Debug)]
pub(crate) struct KeptScreens {
    width: u32,
    height: u32,
    bits: u32,
    kept: Vec<KeptScreen>,
}

impl KeptScreen {
    pub(crate) fn detection_counts(&self) -> DetectionCounts {
        self.pairs.total_counts()
    }

    /// Returns the number of detections that are lost or added.
    fn differences(&self) -> u64 {
        let found = self.detection_counts();
        found.whole - found.kept + found.added
    }
}

impl KeptScreens {
    pub(super) fn new(camera: &Camera) -> Self {
        let (width, height, bits) = (camera.width(), camera.height(), camera.pixel_bits());
        Self { width, height, bits, kept: Vec::new() }
    }

    /// Keeps a frame if it has more lost and added detections than one of the kept frames.
    pub(super) fn add(&mut self, clip: &str, seen: ReceivedFrame<'_>, pairs: DetectionPairs) {
        let shot = KeptScreen {
            clip: clip.to_owned(),
            number: seen.number,
            name: seen.name.to_owned(),
            pairs,
            screen: Vec::new(),
        };
        let least = self.kept.last().map_or(0, KeptScreen::differences);
        if self.kept.len() == MAX_SCREENS && shot.differences() <= least {
            return;
        }
        let before = self.kept.iter().take_while(|one| one.differences() >= shot.differences());
        let at = before.count();
        self.kept.insert(at, KeptScreen { screen: seen.screen.to_vec(), ..shot });
        self.kept.truncate(MAX_SCREENS);
    }

    /// Returns the kept frames, those with the most differences first.
    pub(crate) fn screens(&self) -> &[KeptScreen] {
        &self.kept
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Returns the screen of a frame as a PNG in base64.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub(crate) fn png_base64(&self, shot: &KeptScreen) -> ImageResult<String> {
        let byte = |&pixel: &u16| {
            u8::try_from(convert_depth(pixel, self.bits, 8)).expect("a pixel of 8 bits is a byte")
        };
        let pixels = shot.screen.iter().map(byte).collect();
        let picture =
            image::ImageBuffer::<Luma<u8>, Vec<u8>>::from_raw(self.width, self.height, pixels);
        let mut bytes = Cursor::new(Vec::new());
        picture.expect("a screen has all pixels").write_to(&mut bytes, ImageFormat::Png)?;
        Ok(STANDARD.encode(bytes.into_inner()))
    }
}
