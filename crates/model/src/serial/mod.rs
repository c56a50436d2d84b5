// SPDX-License-Identifier: MIT OR Apache-2.0
//! The serial organization, clock by clock: what every output port shows after every edge.
//!
//! One [`SerialRcm::step`] is one rising edge of the clock. `docs/serial.md` fixes the clock of
//! everything that is seen, whatever the pixels are; so this model is a schedule beside
//! the arithmetic:
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
//! A frame is judged as a whole at the edge that takes its last pixel, since thresholds stay
//! still; its scores, decisions, pixels and means are shown when they are due. A clock in which
//! nothing is seen costs nothing, and [`SerialRcm::skip`] leaves out any number of them.

mod intake;
mod ports;
mod raster;
mod rcm;
mod regions;
mod schedule;
mod streams;

pub use ports::SerialOutput;
pub use rcm::SerialRcm;
