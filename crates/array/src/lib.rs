// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of a whole pipelined RCM, which computes a clock of all RPUs at once.
//!
//! [`foveate_model::PipelinedRcm`] steps one RPU after the other and is easy to trust;
//! [`PipelinedArray`] shows the same outputs after every edge and is fast. All RPUs of an RCM work in
//! step: the position of a window, its flushes and the end of a frame are the same in each of them, and
//! are computed once per clock. Only the data differ. They are kept in one lane per RPU, so the compiler
//! turns every operation of a clock into vector instructions over all regions.
//!
//! ```text
//!               lane:   0    1    2  ..  783
//! place p of a frame  [x0] [x0] [x0] .. [x0]     a row of lanes per place; a 3x3 window is nine rows
//! counters            [c ] [c ] [c ] .. [c ]     a row of lanes per register
//! ```
//!
//! The model is written from `docs/timing.md`. Property tests compare the two at every clock.

mod array;
mod borders;
mod core;
mod counts;
mod kernel;
mod median;
mod moments;
mod plan;
mod rows;
mod store;
mod tail;
mod temporal;
mod view;
mod wide;
mod window;

pub use array::PipelinedArray;
pub use view::Outputs;
