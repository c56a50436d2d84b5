// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine against the functional model: every camera, all options, many frames.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batches;
mod clip_script;
mod hard_cases;
mod largest_thresholds;
mod losses;
mod memory;
mod properties;
mod random_cameras;
mod refusals;
mod zones;

/// Returns the number of cases of a property test: `whole` if tests take whole lists, and a fourth
/// of it in most runs.
fn cases(whole: u32) -> u32 {
    if std::env::var_os("FOVEATE_WHOLE").is_some() { whole } else { whole / 4 }
}
