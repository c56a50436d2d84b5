// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bit-accurate models of a Foveate design: the values that an RPU computes, and the clocks at
//! which its ports show them.
//!
//! [`functional`] is the reference: it takes whole frames and returns scores, decisions and the
//! rendered frame. [`pipelined`], [`serial`] and [`raster`] model every port of the hardware after
//! every clock edge, and [`FrameSync`] selects the frames that reach them. All models are written
//! from `docs/contract.md`, `docs/timing.md`, `docs/serial.md`, `docs/raster.md` and `docs/sync.md`
//! alone, never from the Verilog, so that agreement with the Verilog is evidence for both. The
//! models share only arithmetic without a state: that of one 3x3 window in [`window`], [`denoise`]
//! and [`feature`], and the scores and the decision of one region. All arithmetic is in integers.
//! The crate reads no files and no Verilog.
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
