// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for the raster core, at every level: the lone core is that of the smallest frame.
//!
//! A recording is a row of sequences that a reset begins, as for the serial array: every region of a frame
//! shows another motif, and the thresholds of a frame are aimed at a region of it. They must stand still
//! while the frame is under way; between frames they are shaken. A core has a sink, too: the
//! [sink] is ready always, now and then, or in turns so long that regions are lost. Where the frame store is
//! outside, the driver plays the [memory] there, which in sequences of its own fails.

mod codec;
mod driver;
mod memory;
mod queue;
mod sequence;
mod session;
mod sink;
mod words;

use super::random::Random;
use super::run::Run;
use crate::error::CosimError;
pub use codec::RasterCodec;
use driver::Driver;
use foveate_design::RasterDesign;
pub(crate) use queue::Queue;
use session::Session;
pub(crate) use words::words;

pub(super) fn record(simulated: RasterDesign<'_>, run: Run<'_>) -> Result<(), CosimError> {
    let Run { level, seed, extent, frames, design, recorder, cancel, progress } = run;
    let mut random = Random::new(seed);
    let driver = Driver::new(simulated, recorder, random.fork(), cancel);
    Session::new(design, simulated, level, driver, random).run(extent, frames, progress)
}
