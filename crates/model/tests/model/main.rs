// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the models against an oracle that shares no code with them, against each other, and
//! against the waveforms of `docs/timing.md`, `docs/serial.md` and `docs/raster.md`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "the oracle is plain arithmetic on small numbers"
)]

mod changing_thresholds;
mod class_maps;
mod frames;
mod functional_properties;
mod hard_cases;
mod oracle;
mod parameters;
mod pipelined_properties;
mod port_thresholds;
mod raster;
mod schedule;
mod serial;
mod sync;
mod temporal_behavior;
mod waveforms;
mod zone_timing;
mod zones;

/// Returns the number of cases of a property test: `whole` if tests take whole lists, and a fourth
/// of it in most runs.
fn cases(whole: u32) -> u32 {
    if std::env::var_os("FOVEATE_WHOLE").is_some() { whole } else { whole / 4 }
}
