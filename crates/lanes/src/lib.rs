// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels in vector lanes: what the engine and the executor of networks share.
//!
//! * [`Level`]: a set of vector instructions, chosen at run time; a [`Task`] is compiled once for each level, a [`PanelTask`] with the panels of that level.
//! * [`Lane`]: a pixel as a byte or a word, and the arithmetic on it that vectorises; [`Block`]: lanes that fill a register.
//! * [`Aligned`]: buffers whose blocks are cache lines.
//! * [`best_arc`]: FAST 5/8 as a network of minima and maxima.

mod aligned;
mod lane;
mod level;
mod ring;

pub use aligned::Aligned;
pub use lane::{BLOCK, Block, Lane, threshold};
pub use level::{Level, PanelTask, Task, prefetch};
pub use ring::best_arc;
