// SPDX-License-Identifier: MIT OR Apache-2.0
//! Non-negative decimal numbers without rounding.
//!
//! A threshold in grey levels may be decimal. It becomes one integer comparison, rounded up. Binary
//! floating point would round 0.1 * 640 up to 65; the decimal digits give 64.

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// The most digits after the point that a threshold may have.
const MAX_SCALE: u32 = 9;

/// The number `digits / 10^scale`, with at most nine digits after the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Decimal {
    digits: u64,
    scale: u32,
}

impl Decimal {
    /// Makes a whole number.
    #[must_use]
    pub const fn from_whole(value: u64) -> Self {
        Self { digits: value, scale: 0 }
    }

    /// Returns the shortest decimal number that reads back as `value`, or `None` if `value` is
    /// negative, not finite, too large, or has more than nine digits after the point.
    #[must_use]
    pub fn from_f64(value: f64) -> Option<Self> {
        if !value.is_finite() || value.is_sign_negative() && value != 0.0 {
            return None;
        }
        let text = value.abs().to_string();
        let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
        let scale = u32::try_from(fraction.len()).ok()?;
        if scale > MAX_SCALE {
            return None;
        }
        Some(Self { digits: format!("{whole}{fraction}").parse().ok()?, scale })
    }

    /// Returns `billionths / 10^9`, with as few digits as possible.
    #[must_use]
    pub const fn from_billionths(billionths: u64) -> Self {
        let (mut digits, mut scale) = (billionths, MAX_SCALE);
        while scale > 0 && digits.is_multiple_of(10) {
            digits /= 10;
            scale -= 1;
        }
        Self { digits, scale }
    }

    /// Returns the smallest integer that is at least `self * factor`.
    #[must_use]
    pub fn ceil_times(self, factor: u64) -> u128 {
        (u128::from(self.digits) * u128::from(factor)).div_ceil(10u128.pow(self.scale))
    }

    /// Returns the value as a whole number, or `None` if it has a fraction.
    #[must_use]
    pub fn as_whole(self) -> Option<u64> {
        let unit = 10u64.pow(self.scale);
        self.digits.is_multiple_of(unit).then_some(self.digits / unit)
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = 10u64.pow(self.scale);
        if let Some(whole) = self.as_whole() {
            return write!(f, "{whole}");
        }
        let width = self.scale as usize;
        write!(f, "{}.{:0width$}", self.digits / unit, self.digits % unit)
    }
}

impl Serialize for Decimal {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.as_whole() {
            Some(whole) => serializer.serialize_u64(whole),
            // The shortest text of the parsed number has the same digits again.
            None => match self.to_string().parse() {
                Ok(value) => serializer.serialize_f64(value),
                Err(_) => serializer.serialize_str(&self.to_string()),
            },
        }
    }
}

impl<'de> Deserialize<'de> for Decimal {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct DecimalVisitor;
        impl Visitor<'_> for DecimalVisitor {
            type Value = Decimal;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a number >= 0 with at most {MAX_SCALE} digits after the point")
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Decimal, E> {
                u64::try_from(value)
                    .map(Decimal::from_whole)
                    .map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Decimal, E> {
                Ok(Decimal::from_whole(value))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Decimal, E> {
                Decimal::from_f64(value)
                    .ok_or_else(|| E::invalid_value(Unexpected::Float(value), &self))
            }
        }
        deserializer.deserialize_any(DecimalVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_is_exact_where_binary_fractions_are_not() {
        let tenth = Decimal::from_f64(0.1).unwrap();
        assert_eq!(tenth.ceil_times(640), 64);
        assert_eq!(tenth.ceil_times(641), 65);
        assert_eq!(Decimal::from_f64(4.35).unwrap().ceil_times(100), 435);
        assert_eq!(Decimal::from_whole(5).ceil_times(64), 320);
    }

    #[test]
    fn billionths_are_kept_in_the_shortest_form() {
        assert_eq!(Decimal::from_billionths(625_000_000), Decimal::from_f64(0.625).unwrap());
        assert_eq!(Decimal::from_billionths(5_000_000_000), Decimal::from_whole(5));
        assert_eq!(Decimal::from_billionths(0), Decimal::from_whole(0));
        assert_eq!(Decimal::from_billionths(1).to_string(), "0.000000001");
    }

    #[test]
    fn refuses_what_is_no_threshold() {
        for value in [-1.0, f64::NAN, f64::INFINITY, 1e-10, 1e30] {
            assert_eq!(Decimal::from_f64(value), None, "{value}");
        }
        assert_eq!(Decimal::from_f64(-0.0), Some(Decimal::from_whole(0)));
    }

    #[test]
    fn prints_as_it_was_written() {
        for (value, text) in [(0.0, "0"), (2.5, "2.5"), (10.0, "10"), (0.05, "0.05")] {
            assert_eq!(Decimal::from_f64(value).unwrap().to_string(), text);
        }
    }
}
