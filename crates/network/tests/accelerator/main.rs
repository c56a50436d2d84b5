// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of costs: by hand, against a naive array, SCALE-Sim and Eyeriss, and over random layers
//! and masks.
#![allow(clippy::unwrap_used, reason = "tests")]

mod by_hand;
mod eyeriss;
mod files;
mod masked;
mod oracle;
mod properties;
mod random;
mod scale_sim;
