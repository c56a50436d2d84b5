// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets: bytes written by hand from `docs/packets.md`, and streams that were damaged.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod claims;
mod clock;
mod damage;
mod fields;
mod golden;
mod register;
mod stream;
