// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds in grey levels of one depth as thresholds of another.
//!
//! Fewer bits drop low bits, x' = floor(x / 2^k), and a difference of pixels shrinks by 2^k. Hits are
//! differences above a level; as whole numbers m' > L / 2^k exactly when m' > floor(L / 2^k), so levels
//! are divided and rounded down. `min_score` of `mad` is a mean of differences, divided by 2^k; that of
//! `variance` is a mean of their squares, divided by 4^k. Counts stay as they are.

use foveate_design::{Config, Decimal, FeatureKind};

/// `config`, whose thresholds are in grey levels of `bits` bits, with those of its own depth.
pub(crate) fn at_depth(config: &Config, bits: u32) -> Config {
    let own = config.frame.pixel_bits;
    let mut config = config.clone();
    let shift = |level: u32| match own.checked_sub(bits) {
        Some(more) => u32::try_from(u64::from(level) << more).unwrap_or(u32::MAX),
        None => level.checked_shr(bits - own).unwrap_or(0),
    };
    let changed = config.temporal.level;
    config.temporal.level = shift(changed);
    for entry in &mut config.spatial {
        *entry = entry.with_defaults();
        entry.level = entry.level.map(&shift);
        let power = match entry.feature {
            FeatureKind::Edge | FeatureKind::Corner => continue,
            FeatureKind::Mad => 1,
            FeatureKind::Variance => 2,
        };
        let scaled = |least| times_power_of_two(least, own, bits, power);
        entry.min_score = entry.min_score.map(scaled);
    }
    config
}

/// `value * 2^(power * (own - bits))`, to nine digits after the point, rounded up.
fn times_power_of_two(value: Decimal, own: u32, bits: u32, power: u32) -> Decimal {
    const UNIT: u64 = 1_000_000_000;
    let billionths = value.ceil_times(UNIT);
    let scaled = if own >= bits {
        billionths << (power * (own - bits))
    } else {
        billionths.div_ceil(1 << (power * (bits - own)))
    };
    Decimal::billionths(u64::try_from(scaled).unwrap_or(u64::MAX))
}
