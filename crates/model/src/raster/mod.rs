// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the raster organization: every output port after every edge.
//!
//! One [`RasterRcm::step`] is one rising edge of the clock. `docs/raster.md` defines how many
//! clocks after the advance of a word every event happens, whatever the pixels are. So the model
//! stores whole frames, and scores a region at once when its last word comes to the tail. The
//! events that follow are applied at the edges at which they are due:
//!
//! ```text
//! valid_i   +----------+ word  +---------+
//! pixel_i ->| advances |------>|  frame  |
//! ready_o <-|          |       +---------+
//!           +----------+            |  last word of a region
//!             | first word of       v
//!             | a row of regions  +---------+     +-----------+
//!             |                   | regions |---->| decisions |----> decision ports
//!             v                   +---------+     +-----------+
//!           +-----------+ due       ^ references     |  words
//!           | staleness |--------> +---------+       |
//!           +-----------+          | readout |<------+
//!           forward_ready_i ------>|         |---------------------> forward ports, lost_o
//!                                  +---------+
//! ```
//!
//! With an external frame store, a region is scored when the reference of its last word is taken.
//! In a core with zones, the class of a region is looked up when its last word comes to the tail,
//! because frames may use another map when the region is scored.

mod advances;
mod decisions;
mod external_store;
mod ports;
mod rcm;
mod readout;

pub use ports::RasterOutput;
pub use rcm::RasterRcm;
