// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums that do not depend on the order of their terms: fixed point with 40 fraction bits.
//!
//! The quantum is 9.1e-13, and the range 1.5e26, which a day of 16-bit video does not reach. Sums
//! beyond the range saturate.

use serde::{Deserialize, Serialize};

const UNIT: f64 = 1_099_511_627_776.0; // 2^40

/// A number in units of 2^-40. It is written as decimal text, because few formats have integers
/// that large.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub(crate) struct FixedPoint(i128);

impl FixedPoint {
    #[allow(clippy::cast_possible_truncation, reason = "rounded on purpose; saturates")]
    pub(crate) fn nearest(value: f64) -> Self {
        Self((value * UNIT).round() as i128)
    }

    pub(crate) fn whole(value: u64) -> Self {
        Self(i128::from(value) << 40)
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }

    /// Returns the nearest `f64`.
    #[allow(clippy::cast_precision_loss, reason = "rounded on purpose, at the very end")]
    pub(crate) fn to_f64(self) -> f64 {
        self.0 as f64 / UNIT
    }
}

impl From<FixedPoint> for String {
    fn from(exact: FixedPoint) -> Self {
        exact.0.to_string()
    }
}

impl TryFrom<String> for FixedPoint {
    type Error = std::num::ParseIntError;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse().map(Self)
    }
}

/// Returns `part / whole`; `empty` if `whole` is 0.
pub(crate) fn ratio(part: u64, whole: u64, empty: f64) -> f64 {
    if whole == 0 { empty } else { count_to_f64(part) / count_to_f64(whole) }
}

/// Converts a count to a floating-point number, exact up to 2^53.
#[allow(clippy::cast_precision_loss, reason = "counts of pixels and scores are below 2^53")]
pub(crate) fn count_to_f64(value: u64) -> f64 {
    value as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_does_not_matter_and_text_keeps_every_bit() {
        let values = [1e20, 0.1, -3.75, 1.0 / 3.0, 1e-9];
        let sum = |values: &mut dyn Iterator<Item = f64>| {
            let mut sum = FixedPoint::default();
            values.for_each(|value| sum.add(FixedPoint::nearest(value)));
            sum
        };
        let forward_sum = sum(&mut values.into_iter());
        assert_eq!(forward_sum, sum(&mut values.into_iter().rev()));
        assert_eq!(FixedPoint::try_from(String::from(forward_sum)), Ok(forward_sum));
        assert_eq!(FixedPoint::whole(7).to_f64(), 7.0);
        assert_eq!(FixedPoint::nearest(f64::INFINITY), FixedPoint(i128::MAX));
    }
}
