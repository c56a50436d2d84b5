// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of boards in simulation, from the wires of a sensor to the serial line.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod array;
mod common;
mod cores;
mod hostile_texts;
mod pattern;
mod projects;
mod sensor_signals;
mod simulation;
mod user_texts;
