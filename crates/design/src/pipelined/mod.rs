// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pipelined organization: one RPU per region, each with one pixel per clock; see
//! `docs/timing.md`.

mod hardware;
mod ports;
mod rules;
mod timing;

pub use hardware::PipelinedHardware;
pub use timing::PipelinedTiming;
