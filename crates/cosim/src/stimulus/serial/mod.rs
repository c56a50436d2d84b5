// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for the serial array, at every level: one lane is an array, too.
//!
//! A recording is again a row of sequences that a reset begins. Frames of an array take thousands of
//! clocks, so that there are fewer of them: every region of a frame shows another motif, and the
//! thresholds of a frame are aimed at a region of it. These must stand still while the frame is under
//! way, so that its scores are computed [before](aim) it enters; between frames they are shaken. The
//! [driver] follows `ready_o`, and offers garbage while it is 0.

mod aim;
mod codec;
mod driver;
mod feed;
mod parts;
mod sequence;
mod session;

pub use codec::SerialCodec;
pub(super) use driver::Driver;
pub(super) use session::Session;
