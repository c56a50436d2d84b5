// SPDX-License-Identifier: MIT OR Apache-2.0
//! The raster organization, clock by clock: what every output port shows after every edge.
//!
//! One [`RasterRcm::step`] is one rising edge of the clock. `docs/raster.md` says how many clocks after the
//! advance of a word everything happens, whatever the pixels are. So this model keeps whole frames, and judges
//! a region at once when its last word comes to the tail; what follows is done at the edge at which it is due:
//!
//! ```text
//! valid_i   +----------+ word  +---------+
//! pixel_i ->| advances |------>| picture |
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
//! Where the frame store is outside, a region is judged when the reference of its last word is taken there.

mod advances;
mod decisions;
mod due;
mod outside;
mod picture;
mod ports;
mod rcm;
mod readout;
mod regions;
mod staleness;
mod word;

pub use ports::RasterOutput;
pub use rcm::RasterRcm;
