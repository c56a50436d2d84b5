// SPDX-License-Identifier: MIT OR Apache-2.0
//! The goal of a fit with a network, and the agreement that the chosen design reaches.

use std::path::Path;

use foveate_inference::{NoiseAgreement, VisionOptions};
use serde::Serialize;

use super::agreement_estimate::AgreementEstimate;

/// The goal of a fit with a network: the network must agree, behind the camera, with its outputs
/// for whole frames.
#[derive(Clone, Copy, Debug)]
pub struct NetworkGoal<'a> {
    /// The network's file.
    pub path: &'a Path,
    /// The options for reading the network and for showing it frames.
    pub vision_options: &'a VisionOptions,
    /// The least agreement, 0..=1, defined as by `foveate infer --whole-frames`.
    pub min_agreement: f64,
    /// The most frames of each part of all clips that the network sees: of the part that cameras
    /// are searched by, of the part that confirms a camera, and of the second halves.
    pub frames: u64,
}

/// The agreement of a network behind the chosen design with the network on whole frames.
#[derive(Clone, Debug, Serialize)]
pub struct FittedNetwork {
    /// The network's file.
    pub network: String,
    /// The format of the detections, if they are read.
    pub detector: Option<String>,
    /// The least agreement that was wanted, 0..=1.
    pub min_agreement: f64,
    /// The agreement on the frames of the search: the first two thirds of the first half.
    pub fitted: AgreementEstimate,
    /// The agreement on the rest of the first half, which had no part in the search and confirmed
    /// its result.
    pub confirmed: AgreementEstimate,
    /// The agreement on the second half, which influenced no choice.
    pub held_out: AgreementEstimate,
    /// The agreement with whole frames of the second half under noise, level by level.
    pub noise: Vec<NoiseAgreement>,
    /// The size of a whole frame in bytes.
    pub bytes_per_whole_frame: f64,
}
