// SPDX-License-Identifier: MIT OR Apache-2.0
//! Conversion of thresholds in grey levels to another depth. Defaults, files, overrides, design
//! spaces and searches for a design all follow these rules:
//!
//! * Defaults are those of 8 bits, scaled to the depth of the design.
//! * A threshold that is written is in grey levels of the depth that it is written with. An
//!   override of `frame.pixel_bits` alone scales the thresholds of the file. A threshold that is
//!   overridden too is not scaled.
//! * A level that no pixel can exceed is refused.
//!
//! At a smaller depth the k low bits are dropped, x' = floor(x / 2^k), and a difference of pixels
//! shrinks by 2^k. Hits are differences above a level L. For a whole number m', m' > L / 2^k
//! exactly when m' > floor(L / 2^k), so levels are divided and rounded down. `min_score` of `mad`,
//! `surface` and `flow` is a mean of differences and that of `range` a difference; they are divided
//! by 2^k. `min_score` of `variance` is a mean of squared differences and is divided by 4^k. All
//! five are rounded up at the ninth digit. Counts of pixels stay as they are.

use std::fmt::Display;

use crate::{Decimal, FeatureKind};

/// The depth, in bits per pixel, that default thresholds are given for.
pub(crate) const DEFAULT_BITS: u32 = 8;

/// Converts a level from `from` bits to `to` bits per pixel.
pub(crate) fn scale_level(value: u32, from: u32, to: u32) -> u32 {
    if to >= from {
        u32::try_from(u64::from(value) << (to - from)).unwrap_or(u32::MAX)
    } else {
        value.checked_shr(from - to).unwrap_or(0)
    }
}

/// Converts a minimum score from `from` bits to `to` bits per pixel.
pub(crate) fn scale_min_score(feature: FeatureKind, value: Decimal, from: u32, to: u32) -> Decimal {
    match feature.score_unit().scaling_exponent() {
        0 => value,
        power => times_power_of_two(value, from, to, power),
    }
}

/// Returns `value * 2^(power * (to - from))`, rounded up at the ninth digit after the point.
fn times_power_of_two(value: Decimal, from: u32, to: u32, power: u32) -> Decimal {
    const UNIT: u64 = 1_000_000_000;
    let billionths = value.ceil_times(UNIT);
    let scaled = if to >= from {
        billionths << (power * (to - from))
    } else {
        billionths.div_ceil(1 << (power * (from - to)))
    };
    Decimal::from_billionths(u64::try_from(scaled).unwrap_or(u64::MAX))
}

/// Returns the end of a message about a threshold that is out of range at fewer than 8 bits: the
/// value that a threshold of 8 bits has at `bits` bits. The text is empty where that value would
/// not be valid either.
pub(crate) fn depth_hint(
    value: &dyn Display,
    scaled: &dyn Display,
    fits: bool,
    bits: u32,
) -> String {
    if bits >= DEFAULT_BITS || !fits {
        return String::new();
    }
    format!("; {value} at {DEFAULT_BITS} bits is {scaled} at {bits} bits")
}
