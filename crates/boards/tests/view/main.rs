// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the page's data for a stream that comes over a pseudo-terminal, from a file or through
//! a FIFO.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod board;
mod browser;
mod client;
mod guard;
mod line;
mod player;
mod sent;
mod shown;
mod slow;
mod trouble;
