// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds in grey levels at another depth. One rule for defaults, files, overrides, spaces and fits:
//!
//! * Defaults are those of 8 bits, scaled to the depth of the design.
//! * What is written is in grey levels of the depth that it is written with. An override of
//!   `frame.pixel_bits` alone scales what the file says; a threshold that is overridden too is taken as it is.
//! * A level that no pixel can exceed is refused.
//!
//! Fewer bits drop low bits, x' = floor(x / 2^k), and a difference of pixels shrinks by 2^k. Hits are
//! differences above a level; as whole numbers m' > L / 2^k exactly when m' > floor(L / 2^k), so levels are
//! divided and rounded down. `min_score` of `mad` is a mean of differences, divided by 2^k; that of
//! `variance` is a mean of their squares, divided by 4^k; both are rounded up at the ninth digit. Counts of
//! pixels stay as they are.

use std::fmt::Display;

use crate::{Decimal, FeatureKind};

/// The depth of which defaults are.
pub(crate) const DEFAULT_BITS: u32 = 8;

/// A level of `from` bits at `to` bits.
pub(crate) fn level(value: u32, from: u32, to: u32) -> u32 {
    if to >= from {
        u32::try_from(u64::from(value) << (to - from)).unwrap_or(u32::MAX)
    } else {
        value.checked_shr(from - to).unwrap_or(0)
    }
}

/// A minimum score of `from` bits at `to` bits.
pub(crate) fn min_score(feature: FeatureKind, value: Decimal, from: u32, to: u32) -> Decimal {
    match feature.measure().power() {
        0 => value,
        power => times_power_of_two(value, from, to, power),
    }
}

/// `value * 2^(power * (to - from))`, to nine digits after the point, rounded up.
fn times_power_of_two(value: Decimal, from: u32, to: u32, power: u32) -> Decimal {
    const UNIT: u64 = 1_000_000_000;
    let billionths = value.ceil_times(UNIT);
    let scaled = if to >= from {
        billionths << (power * (to - from))
    } else {
        billionths.div_ceil(1 << (power * (from - to)))
    };
    Decimal::billionths(u64::try_from(scaled).unwrap_or(u64::MAX))
}

/// What a threshold of 8 bits is at `bits`, as the end of a message about one that is out of range at
/// fewer bits; empty where that would not help.
pub(crate) fn hint(value: &dyn Display, scaled: &dyn Display, fits: bool, bits: u32) -> String {
    if bits >= DEFAULT_BITS || !fits {
        return String::new();
    }
    format!("; {value} at {DEFAULT_BITS} bits is {scaled} at {bits} bits")
}
