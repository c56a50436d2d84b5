// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards in simulation: a sensor's wires in, a serial line out.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod array;
mod common;
mod cores;
mod film;
mod hostile;
mod pattern;
mod projects;
mod simulation;
mod user_texts;
