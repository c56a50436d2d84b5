// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model's integers at billions of pixels a second.
//!
//! [`Engine`] computes what the model's `Camera` computes, bit for bit, for every design. The
//! model says what; this crate only makes it fast:
//! - one fused pass over a band of regions while it is in the cache, where a chain of whole-frame
//!   operations would go through memory once per step;
//! - plain loops over fixed blocks of lanes, compiled for several instruction sets and entered
//!   through the best that the processor has;
//! - bands shared among threads, with the same bits however many there are; several frames at once
//!   are handed over once, [`Engine::step_batch_u8`];
//! - regions that are bit-identical to the last frame are proved so and skipped.

mod band;
mod batch;
mod change;
mod core;
mod decide;
mod denoised;
mod engine;
mod error;
mod kernel;
mod look;
mod outcome;
mod pixels;
mod plan;
mod policy;
mod render;
mod scratch;
mod screens;
mod strip;
mod workers;

pub use engine::{Engine, Options};
pub use error::EngineError;
pub use foveate_lanes::Level;
pub use outcome::Outcome;
pub use screens::Screens;
