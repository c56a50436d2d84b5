// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the form of emitted Verilog, and that no tool warns of it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod axi;
mod common;
mod ecp5;
mod elaborated;
mod emission;
mod flows;
mod limits;
mod lint;
mod one_chip;
