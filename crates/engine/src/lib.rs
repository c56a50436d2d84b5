// SPDX-License-Identifier: MIT OR Apache-2.0
//! A fast implementation of the functional model, for billions of pixels a second.
//!
//! [`Engine`] computes what the model's `FunctionalCamera` computes, bit for bit, for every camera.
//! The model defines the results; this crate only makes them fast:
//! - It makes one fused pass over a band of regions while the band is in the cache. A chain of
//!   whole-frame operations would go through memory once per step.
//! - It has plain loops over fixed blocks of elements, compiled for several instruction sets. The
//!   best one for the processor is chosen at run time.
//! - It shares bands among threads; the results do not depend on the number of threads. Several
//!   frames can be given to one call, [`Engine::step_batch_u8`].
//! - It finds regions that are bit-identical to the last frame and skips them.

mod band;
mod batch;
mod change;
mod decision;
mod denoised;
mod digest;
mod engine;
mod error;
mod events;
mod feature_passes;
mod kernel;
mod outcome;
mod periphery;
mod pixels;
mod plan;
mod policy;
mod receiver;
mod sent_values;
mod state_access;
mod state_copy;
mod strip;
mod typed_engine;
mod vector_levels;
mod workers;
mod working_memory;

pub use engine::{Engine, EngineOptions};
pub use error::EngineError;
pub use events::{EventColumn, EventColumnType, EventFrame, EventTable, EventValue};
pub use foveate_pixels::vectors::InstructionSet;
pub use outcome::FrameOutcome;
pub use receiver::{BatchScreens, Receiver};
pub use state_copy::RegionStateBefore;
pub use workers::MAX_THREADS;
