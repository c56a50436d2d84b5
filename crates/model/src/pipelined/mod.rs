// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the pipelined organization: every output port after every edge.
//!
//! One [`PipelinedRpu::step`] is one rising edge of the clock. The blocks are those of
//! `docs/timing.md`, one file each:
//!
//! ```text
//! valid_i    +--------+   m   +---------+    d    +------------------------------------+
//! pixel_i -->| median |--||-->| feature |---||--->| tail: counts, second pass, store,  |--> outputs
//!            | window |       | window  |         | temporal score, decision, forward  |
//!            +--------+       +---------+         +------------------------------------+
//! ```
//!
//! A stage that the design does not need is left out. At an edge a stage takes one pixel or none.

mod center;
mod decide;
mod isolated;
mod line;
mod median;
mod moments;
mod periphery;
mod pixel;
mod plan;
mod ports;
mod rcm;
mod rpu;
mod scores;
mod shared;
mod store;
mod tail;
mod temporal;
mod window;

pub use ports::{RpuInput, RpuOutput};
pub use rcm::PipelinedRcm;
pub use rpu::PipelinedRpu;
