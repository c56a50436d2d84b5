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

mod delay_line;
mod frame_store;
mod isolated_window;
mod median;
mod pixel;
mod ports;
mod rcm;
mod region_sums;
mod relevance;
mod rpu;
mod rpu_parameters;
mod scores;
mod shared_window;
mod tail;
mod tail_summary;
mod temporal_counters;
mod window_center;
mod window_stage;

pub use ports::{RpuInput, RpuOutput};
pub use rcm::PipelinedRcm;
pub use rpu::PipelinedRpu;
