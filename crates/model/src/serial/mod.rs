// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the serial organization: every output port after every edge.
//!
//! One [`SerialRcm::step`] is one rising edge of the clock. `docs/serial.md` fixes the clock of
//! every output, whatever the pixels are. So the model is a schedule and, apart from it, the
//! arithmetic:
//!
//! ```text
//! ready_o <------------+
//! valid_i   +--------+ |  full  +---------------------+
//! pixel_i ->| intake |-+------->| regions: scores,    |    +------+
//!           +--------+          | decision, reference,|--->| show |-> outputs
//!                               | summary, what leaves|    +------+
//!                               +---------------------+       ^
//!                               schedule: clock -> step ------+
//! ```
//!
//! A frame is scored and decided as a whole at the edge that takes its last pixel, because
//! thresholds stay constant. The outputs show its scores, decisions, pixels and means when they are
//! due. The classes of its regions in a core with zones come from the memory of classes, whose map
//! does not change while a frame is under way. [`SerialRcm::skip`] skips any number of clocks in
//! which the outputs do not change.

mod intake;
mod ports;
mod rcm;
mod regions;
mod schedule;

pub use ports::SerialOutput;
pub use rcm::SerialRcm;
