// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera: the same network runs on the frames before the camera,
//! and its findings there are compared with its findings on the receiver's screen.

mod comparison;
mod noise;
mod precision;
mod summary;

pub(crate) use comparison::{
    CountedDetections, DetectionRow, FrameAgreement, KeptScreen, KeptScreens, WholeFrameComparison,
};
pub use noise::{GaussianNoise, NOISE_LEVELS, NoiseAgreement, NoiseComparison};
pub use precision::{ConfidenceIntervals, has_class_map, wilson_interval};
pub use summary::{GroundTruthFigures, WholeFrameAgreement};
