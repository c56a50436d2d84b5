// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera, and what the camera sends for it.

use super::noise::NoiseAgreement;
use super::precision::ConfidenceIntervals;
use crate::camera::SentCount;
use foveate_camera::Camera;
use foveate_network::vision::{self, ClassAgreement, DetectionAgreement};
use serde::Serialize;

/// The network on the receiver's screen compared with the network on whole frames, over the counted
/// frames.
#[derive(Clone, Debug, Serialize)]
pub struct WholeFrameAgreement {
    /// The agreement in one number from 0 to 1. With detections it is the smaller of the share that
    /// is kept and the share that is right; otherwise the share of frames or of positions with the
    /// same class; otherwise 1 minus the relative RMS error.
    pub agreement: f64,
    /// The intervals in which the agreement and the shares of detections lie for other frames of
    /// this kind.
    pub intervals: ConfidenceIntervals,
    /// The agreement with whole frames under noise, level by level; no camera can be expected to
    /// reach more.
    pub noise: Vec<NoiseAgreement>,
    /// The root mean squared difference of the outputs, as a share of the root mean square of their
    /// values.
    pub relative_rms: f64,
    /// The comparison of classes for outputs that are one class, unless detections are read.
    pub classes: Option<ClassAgreement>,
    /// The share of the positions with the same class for outputs that have a class at every
    /// position, unless detections are read.
    pub same_places: Option<f64>,
    /// The detections that are kept, lost and added, if they are read.
    pub detections: Option<DetectionAgreement>,
    /// The comparison with ground truth, if there is any.
    pub truth: Option<GroundTruthFigures>,
    /// The peak signal-to-noise ratio of the receiver's screen against whole frames in decibels;
    /// `None` if they are equal.
    pub picture_psnr: Option<f64>,
    /// The bytes that the camera sends per frame: two bits per region, displacements, pixels of
    /// active regions, and means.
    pub sent_bytes: f64,
    /// The bytes that the camera sends, as a share of the bytes of whole frames.
    pub sent_share: f64,
    /// The mean time of the network on a whole frame in this run in seconds.
    pub seconds_per_frame: f64,
}

/// The detections of any counted class against ground truth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GroundTruthFigures {
    /// The number of objects that count.
    pub objects: u64,
    /// The average precision in whole frames at an overlap of 0.5.
    pub whole_ap50: f64,
    /// The average precision on the receiver's screen at an overlap of 0.5.
    pub seen_ap50: f64,
    /// The share of the objects that are found in whole frames with at least the score that counts.
    pub whole_recall: f64,
    /// The share of the objects that are found on the receiver's screen with at least the score
    /// that counts.
    pub seen_recall: f64,
}

/// The sums of what the camera sends and the receiver shows.
#[derive(Clone, Debug)]
pub(super) struct ReceiverTally {
    camera: Camera,
    pub(super) pixels: f64,
    pub(super) max: f64,
    /// The number of frames that the network saw; `sent_frames` counts the frames of the camera,
    /// which may be more.
    frames: u64,
    sent_frames: u64,
    values: u64,
    squared_error: f64,
}

impl ReceiverTally {
    pub(super) fn new(camera: &Camera) -> Self {
        Self {
            camera: camera.clone(),
            pixels: f64::from(camera.width()) * f64::from(camera.height()),
            max: f64::from(camera.pixel_max()),
            frames: 0,
            sent_frames: 0,
            values: 0,
            squared_error: 0.0,
        }
    }

    /// Adds a frame that the network sees, and what the camera has sent since the one before.
    pub(super) fn add(&mut self, sent: SentCount, squared_error: f64) {
        self.frames += 1;
        self.sent_frames += sent.frames;
        self.values += sent.values;
        self.squared_error += squared_error;
    }

    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    pub(super) fn mean_bytes(&self, sent: SentCount) -> f64 {
        self.camera.bits_sent(sent.frames, sent.values) as f64 / 8.0 / sent.frames.max(1) as f64
    }

    pub(super) fn bytes_per_frame(&self) -> f64 {
        self.mean_bytes(SentCount { frames: self.sent_frames, values: self.values })
    }

    pub(super) fn sent_share(&self) -> f64 {
        self.bytes_per_frame() * 8.0 / (self.pixels * f64::from(self.camera.pixel_bits()))
    }

    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    pub(super) fn psnr(&self) -> Option<f64> {
        psnr_of_error(self.squared_error, self.pixels * self.frames as f64, self.max)
    }
}

/// Returns the peak signal-to-noise ratio in decibels; `None` without a difference.
pub(super) fn psnr_of_error(squared_error: f64, pixels: f64, max: f64) -> Option<f64> {
    vision::psnr(max * max * pixels, squared_error)
}
