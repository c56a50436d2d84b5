// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bit-accurate models of a Foveate design: the values that an RPU computes, and the clocks at
//! which its ports show them.
//!
//! [`functional`] is the reference: it takes whole frames and returns scores, decisions and the
//! rendered frame. [`pipelined`], [`serial`] and [`raster`] model every port of the hardware after
//! every clock edge, and [`FrameSync`] selects the frames that reach them. All models are written
//! from `docs/contract.md`, `docs/timing.md`, `docs/serial.md`, `docs/raster.md`, `docs/zones.md`
//! and `docs/sync.md` alone, never from the Verilog, so that agreement with the Verilog is evidence
//! for both. The models share only arithmetic without a state: that of one 3x3 window in
//! [`window`], [`denoising`] and [`feature`], and the scores and the decision of one region. All
//! arithmetic is in integers. The crate reads no files and no Verilog, and makes no packets: crate
//! `cosim` compares the packets of a core with the outcomes of [`functional`].
#![forbid(unsafe_code)]

mod class_memory;
mod conversions;
mod core_models;
mod cycle_model;
pub mod denoising;
mod error;
pub mod explanation;
pub mod feature;
mod frame_sync;
pub mod functional;
mod periphery;
pub mod pipelined;
pub mod raster;
mod region;
mod region_decision;
mod scorer;
pub mod serial;
mod temporal;
mod thresholds;
pub mod window;
mod window_filter;

pub use self::core_models::{rcm_model, rpu_model};
pub use cycle_model::{CoreInput, CycleModel, region_border, region_stream};
pub use error::ModelError;
pub use frame_sync::FrameSync;
pub use functional::{FunctionalCamera, FunctionalOutcome, RegionMemory};
pub use periphery::block_means;
pub use pipelined::{PipelinedRcm, PipelinedRpu, RpuInput, RpuOutput};
pub use raster::{RasterOutput, RasterRcm};
pub use region::{RegionView, pad, region_action, region_pixels};
pub use scorer::RegionScorer;
pub use serial::{SerialOutput, SerialRcm};
pub use temporal::changed_pixels;
pub use thresholds::{ClassMapInputs, ThresholdInputs, ZoneInputs};
pub use window_filter::filtered_pixel;
