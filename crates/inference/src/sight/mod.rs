// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a network loses behind the camera: the same network on the frames as they were before the camera, and how much of what it says there it says
//! of what the receiver sees.

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
