// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera: the same network runs on the frames before the camera,
//! and its findings there are compared with its findings on the receiver's screen.

mod comparison;
mod interval;
mod kept_screens;
mod noise;
mod noise_comparison;
mod precision;
mod summary;

pub(crate) use comparison::{
    CountedDetections, DetectionRow, FrameAgreement, WholeFrameComparison,
};
pub use interval::{ConfidenceIntervals, has_class_map, wilson_interval};
pub(crate) use kept_screens::{KeptScreen, KeptScreens};
pub use noise::GaussianNoise;
pub use noise_comparison::{NOISE_LEVELS, NoiseAgreement, NoiseComparison};
pub use summary::{GroundTruthFigures, WholeFrameAgreement};
