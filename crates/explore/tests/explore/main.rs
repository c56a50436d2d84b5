// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explorations and fits over scenes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod error_source;
mod explore;
mod fit;
mod link;
mod space;
mod unit;
