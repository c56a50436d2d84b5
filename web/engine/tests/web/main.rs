// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of a page's cameras against the model, and of the committed engine against its sources.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod calls;
mod cameras;
mod committed;
mod explanations;
mod networks;
mod recordings;
mod refusals;
