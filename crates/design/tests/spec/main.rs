// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the public interface of the crate.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod configuration;
mod depth;
mod feature_pages;
mod fuzz;
#[path = "../../../boards/tests/boards/hostile_texts.rs"]
#[allow(dead_code, reason = "files of boards need more of it")]
mod hostile;
mod interface;
mod key_owners;
mod sync;
mod user_texts;
