// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards in simulation: a sensor's wires in, a serial line out.

mod common;
mod film;
mod simulation;
