// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the pipelined organization: every output port after every edge.
//!
//! One [`PipelinedRcm::step`] is one rising edge of the clock of all RPUs. The blocks are those of
//! `docs/timing.md`, one file each:
//!
//! ```text
//! valid_i    +--------+   m   +---------+    d    +------------------------------------+
//! pixel_i -->| filter |--||-->| feature |---||--->| tail: counts, second pass, store,  |--> outputs
//!            | window |       | window  |         | temporal score, decision, forward  |
//!            +--------+       +---------+         +------------------------------------+
//! ```
//!
//! A stage that the design does not need is left out. At an edge a stage takes one pixel of every
//! lane or none: all RPUs take their pixels at the same edges, so the model steps each stage in all
//! lanes at once. A lane is one RPU.

mod frame_store;
mod pixel;
mod ports;
mod rcm;
mod rpu_array;
mod rpu_parameters;
mod scores;
mod tail;
mod window_stage;

pub use ports::{RpuInput, RpuOutput};
pub use rcm::PipelinedRcm;
pub use rpu_array::PipelinedRpu;
