// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthetic scenes: small, deterministic, one for each hard case.
//!
//! The frames of a [`Scene`] are computed, not read. `street` is made to be looked at. Every other
//! scene is one situation that is hard for a region-based camera. All arithmetic is in integers, on
//! hashes of position and time, so the bytes are the same on every machine. A scene can have any
//! size and any depth. This module does no I/O.

mod canvas;
mod error;
mod frames;
mod noise;
mod patterns;
mod scene;
mod street;

pub use error::SceneError;
pub use frames::SceneFrames;
pub use scene::{Scene, SceneParameters};
