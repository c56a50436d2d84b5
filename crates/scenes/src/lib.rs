// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthetic frames: small, deterministic, one scene per hard case.
//!
//! A [`Scene`] is computed, not read. `street` is for looking at; each other scene is one situation that
//! is hard for a region-based camera. Everything is integer arithmetic on hashes of position and time, so
//! every machine makes the same bytes. Any size and any depth work. This crate does no I/O.

mod canvas;
mod error;
mod frames;
mod noise;
mod patterns;
mod scene;
mod street;

pub use error::SceneError;
pub use frames::SceneFrames;
pub use scene::{Scene, SceneSize};
