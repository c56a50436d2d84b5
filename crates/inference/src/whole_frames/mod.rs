// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera: the same network runs on the frames before the camera,
//! and its findings there are compared with its findings on the receiver's screen.

mod noise_comparison;
mod interval;
mod comparison;
mod noise;
mod precision;
mod kept_screens;
mod summary;

pub use noise_comparison::{NOISE_LEVELS, NoiseAgreement, NoiseComparison};
pub use interval::{ConfidenceIntervals, has_class_map, wilson_interval};
pub(crate) use comparison::{CountedDetections, DetectionRow, WholeFrameComparison, FrameAgreement};
pub(crate) use kept_screens::{KeptScreen, KeptScreens};
pub use summary::{WholeFrameAgreement, GroundTruthFigures};
