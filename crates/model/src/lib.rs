// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an RPU computes, and when: the bit-accurate models of a Foveate design.
//!
//! [`functional`] is the clear reference: whole frames in, scores, decisions and the rendered frame
//! out. [`pipelined`] and [`serial`] say what every port of the hardware shows after every clock edge.
//! All are written from `docs/contract.md`, `docs/timing.md` and `docs/serial.md` and from nothing
//! else, so that agreement with the Verilog proves something. They share only what has no state: the
//! arithmetic on one 3x3 window in [`window`], [`denoise`] and [`feature`]. Integers throughout; no
//! files, no Verilog.
#![forbid(unsafe_code)]

mod decision;
pub mod denoise;
mod error;
pub mod feature;
pub mod functional;
mod number;
pub mod pipelined;
mod region;
mod render;
pub mod serial;
mod stream;
mod temporal;
mod thresholds;
pub mod window;

pub use decision::action;
pub use error::ModelError;
pub use functional::{Camera, Outcome};
pub use pipelined::{PipelinedRcm, PipelinedRpu, RpuInput, RpuOutput};
pub use region::{pad, region_pixels};
pub use serial::{RegionScorer, SerialInput, SerialOutput, SerialRcm};
pub use stream::{region_border, region_stream};
pub use temporal::temporal_differences;
pub use thresholds::Thresholds;
