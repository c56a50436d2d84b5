// SPDX-License-Identifier: MIT OR Apache-2.0
//! The camera of `docs/contract.md` in real numbers: the yardstick that other cameras are compared
//! with.
//!
//! [`IdealCamera`] has the regions, filter, features, thresholds, reference and rendering of a
//! configured camera, without the limits of hardware. Its windows always contain their real
//! neighbors, its means are real means, and its thresholds are the decimal numbers of the
//! configuration. It is written from the contract in `f64`, independently of the integers of the
//! other models, and does no I/O.
#![forbid(unsafe_code)]

mod binomial;
mod camera;
mod error;
mod feature;
mod median;
mod memory;
mod periphery;
mod plane;
mod rules;
mod switching;
mod view;

pub use camera::{IdealCamera, IdealOutcome};
pub use error::IdealError;
