// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core on AXI against the model: video goes in as `docs/axi.md` allows it, damaged video and stalls included, and every packet
//! that leaves must say what the functional model says.
//!
//! A [`BusJob`] plays [`scenes`], each a [`Traffic`](traffic::Traffic) through Verilator. What was [`heard`] on the ports is
//! [`checked`](check) packet by packet. When packets leave is not compared, as no contract says it; that they come whole,
//! in order and once is.

mod check;
mod clears;
mod damage;
mod film;
mod follower;
mod heard;
mod job;
mod program;
mod replay;
mod scenes;
mod thresholds;
mod traffic;
mod wrong;

pub use job::BusJob;
