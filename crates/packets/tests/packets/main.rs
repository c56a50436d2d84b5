// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of packets: bytes written by hand from `docs/packets.md`, and damaged streams.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod claims;
mod clock;
mod damage;
mod fields;
mod flow;
mod golden;
mod register;
mod stream;
mod zones;
