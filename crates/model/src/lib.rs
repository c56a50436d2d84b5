// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an RPU computes, and when: the bit-accurate models of a Foveate design.
//!
//! [`functional`] is the clear reference: whole frames in, scores, decisions and the rendered frame
//! out. [`pipelined`], [`serial`] and [`raster`] say what every port of the hardware shows after every
//! clock edge, and [`FrameSync`] which frames reach them. All are written from `docs/contract.md`, `docs/timing.md`,
//! `docs/serial.md`, `docs/raster.md` and `docs/sync.md` and from nothing else, so that agreement with the Verilog proves something. They share
//! only what has no state: the arithmetic on one 3x3 window in [`window`], [`denoise`] and [`feature`], and
//! the scores and decision of one region. Integers throughout; no files, no Verilog.
#![forbid(unsafe_code)]

mod core;
mod cycle;
mod decision;
pub mod denoise;
mod error;
pub mod explain;
pub mod feature;
pub mod functional;
mod number;
mod periphery;
pub mod pipelined;
pub mod raster;
mod region;
mod render;
mod scorer;
pub mod serial;
mod square;
mod stream;
mod sync;
mod temporal;
mod thresholds;
mod verdict;
mod view;
pub mod window;

pub use self::core::{rcm, rpu};
pub use cycle::{CoreInput, CycleModel};
pub use decision::action;
pub use error::ModelError;
pub use functional::{FunctionalCamera, FunctionalOutcome, Remembered};
pub use periphery::block_means;
pub use pipelined::{PipelinedRcm, PipelinedRpu, RpuInput, RpuOutput};
pub use raster::{RasterOutput, RasterRcm};
pub use region::{pad, region_pixels};
pub use scorer::RegionScorer;
pub use serial::{SerialOutput, SerialRcm};
pub use stream::{region_border, region_stream};
pub use sync::FrameSync;
pub use temporal::{changed_pixels, temporal_differences};
pub use thresholds::Thresholds;
pub use view::RegionView;
