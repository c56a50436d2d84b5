// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a network loses behind the camera, and what the camera sends for it.

use super::ceiling::NoiseAgreement;
use super::interval::ConfidenceIntervals;
use crate::camera::SentCount;
use foveate_design::Camera;
use foveate_network::sight::{self, ClassKept, DetectionsKept};
use serde::Serialize;

/// The network on what the receiver sees beside the network on whole frames, over the counted frames.
#[derive(Clone, Debug, Serialize)]
pub struct Sight {
    /// The agreement in one number, 0 to 1. Of detections the smaller of the share that is kept and the share that is right; else the share of
    /// frames, or of places, with the same class; else what the relative RMS error leaves of 1.
    pub agreement: f64,
    /// Intervals in which the agreement and the shares of detections lie for other frames of this kind.
    pub intervals: ConfidenceIntervals,
    /// The agreement with whole frames under noise, level by level: no camera can be asked for more.
    pub noise: Vec<NoiseAgreement>,
    /// Root of the mean squared difference of the outputs, as a share of that of their values.
    pub relative_rms: f64,
    /// Of outputs that are one class, unless detections are read.
    pub classes: Option<ClassKept>,
    /// Share of the places with the same class, of outputs that have a class at every place, unless detections are read.
    pub same_places: Option<f64>,
    /// Detections that are kept, lost and added, if they are read.
    pub detections: Option<DetectionsKept>,
    /// Against ground truth, if there is any.
    pub truth: Option<Truth>,
    /// Peak signal-to-noise ratio of what the receiver sees against whole frames in decibels; nothing where they are equal.
    pub picture_psnr: Option<f64>,
    /// Bytes that the camera sends per frame: two bits per region, pixels of active regions and means.
    pub sent_bytes: f64,
    /// The same as a share of the bytes of whole frames.
    pub sent_share: f64,
    /// Mean time of the network on a whole frame in this run in seconds.
    pub seconds_per_frame: f64,
}

/// Detections against ground truth, of any class that counts.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Truth {
    /// Objects that count.
    pub objects: u64,
    /// Average precision at an overlap of 0.5, of whole frames.
    pub whole_ap50: f64,
    /// The same of what the receiver sees.
    pub seen_ap50: f64,
    /// Share of the objects that are found in whole frames with the score that counts.
    pub whole_recall: f64,
    /// The same of what the receiver sees.
    pub seen_recall: f64,
}

/// What is sent and shown.
#[derive(Clone, Debug)]
pub(super) struct Received {
    camera: Camera,
    /// Of a frame.
    pub(super) pixels: f64,
    pub(super) max: f64,
    /// Frames that the network looked at, and frames of the camera, of which it may have looked at some alone.
    frames: u64,
    sent_frames: u64,
    values: u64,
    squared_error: f64,
}

impl Received {
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

    /// A frame that the network looks at, and what the camera has sent since the one before.
    pub(super) fn add(&mut self, sent: SentCount, squared_error: f64) {
        self.frames += 1;
        self.sent_frames += sent.frames;
        self.values += sent.values;
        self.squared_error += squared_error;
    }

    /// Mean bytes of some frames.
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    pub(super) fn bytes(&self, sent: SentCount) -> f64 {
        self.camera.bits_sent(sent.frames, sent.values) as f64 / 8.0 / sent.frames.max(1) as f64
    }

    pub(super) fn bytes_per_frame(&self) -> f64 {
        self.bytes(SentCount { frames: self.sent_frames, values: self.values })
    }

    pub(super) fn share(&self) -> f64 {
        self.bytes_per_frame() * 8.0 / (self.pixels * f64::from(self.camera.pixel_bits()))
    }

    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    pub(super) fn psnr(&self) -> Option<f64> {
        psnr(self.squared_error, self.pixels * self.frames as f64, self.max)
    }
}

/// Peak signal-to-noise ratio in decibels; nothing without a difference.
pub(super) fn psnr(squared_error: f64, pixels: f64, max: f64) -> Option<f64> {
    sight::psnr(max * max * pixels, squared_error)
}
