// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums and shares that are 0 for nothing.

/// Returns a sum; 0 for no values, where the sum of the standard library is -0.
pub(crate) fn sum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |sum, value| sum + value)
}

/// Returns a share; 0 if `all` is 0.
#[allow(clippy::cast_precision_loss, reason = "a share")]
pub(crate) fn share(part: u64, all: u64) -> f64 {
    if all == 0 { 0.0 } else { part as f64 / all as f64 }
}
