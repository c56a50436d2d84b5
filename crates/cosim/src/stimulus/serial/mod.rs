// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for the serial array, at every level: one lane is an array, too.
//!
//! A recording is again a row of sequences that a reset begins. Frames of an array take thousands of
//! clocks, so that there are fewer of them: every region of a frame shows another motif, and the
//! thresholds of a frame are aimed at a region of it. These must stand still while the frame is under
//! way, so that its scores are computed [before](super::ahead) it enters; between frames they are shaken. The
//! [driver] follows `ready_o`, and offers garbage while it is 0.

mod codec;
mod driver;
mod feed;
mod sequence;
mod session;

use super::random::Random;
use super::run::Run;
use crate::error::CosimError;
pub use codec::SerialCodec;
use driver::Driver;
pub(crate) use feed::Feed;
use foveate_design::{SerialDesign, SerialTiming};
use session::Session;

pub(super) fn record(simulated: SerialDesign<'_>, run: Run<'_>) -> Result<(), CosimError> {
    let Run { level, seed, extent, frames, design, recorder, cancel, progress } = run;
    let mut random = Random::new(seed);
    let driver = Driver::new(simulated, recorder, random.fork(), cancel);
    let timing = SerialTiming::of(simulated);
    let whole = design.on(simulated.own());
    Session::new(whole, simulated, level, &timing, driver, random).run(extent, frames, progress)
}
