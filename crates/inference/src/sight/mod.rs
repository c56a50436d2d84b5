// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera: the same network runs on the frames before the camera,
//! and its findings there are compared with its findings on the receiver's screen.

mod ceiling;
mod interval;
mod judge;
mod noise;
mod precision;
mod shots;
mod summary;

pub use ceiling::{NOISE_LEVELS, NoiseAgreement, NoiseCeiling};
pub use interval::{ConfidenceIntervals, has_places, wilson};
pub(crate) use judge::{Detected, DetectionRow, Judge, SightFrame};
pub(crate) use shots::{Shot, Shots};
pub use summary::{Sight, Truth};
