// SPDX-License-Identifier: MIT OR Apache-2.0
//! Compares a core on AXI with the model. Video goes in as `docs/axi.md` allows it, with
//! damaged frames and stalls, and every packet that leaves must say what the functional model
//! says.
//!
//! A [`BusJob`] plays [`scenes`], each a [`Traffic`](traffic::Traffic), in Verilator. The
//! recorded activity on the ports ([`replay`]) is [checked](checker) packet by packet: each
//! packet is decoded, and its fields are compared with the outcome of the model, which makes no
//! packets. The clock at which a packet leaves is not compared, because no contract defines it.
//! Each packet must leave whole, in order and once.

mod checker;
mod class_scenes;
mod event_clears;
mod frame_source;
mod job;
mod lossy_model;
mod replay;
mod scenes;
mod thresholds;
mod traffic;

pub use job::BusJob;
