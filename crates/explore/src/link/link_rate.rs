// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rate of a link, as users write it.

use std::fmt;

use foveate_camera::Decimal;

use super::report::millions_text;

/// The names of the units, with their values in bits per second.
const UNITS: [(&str, u64); 4] =
    [("bit", 1), ("kbit", 1000), ("Mbit", 1_000_000), ("Gbit", 1_000_000_000)];

/// The rate of a link in bits per second, 1..=10^12.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkRate(pub u64);

impl LinkRate {
    const MAX: u64 = 1_000_000_000_000;

    /// Reads a number with a unit, such as `100Mbit` or `1.5Gbit/s`.
    ///
    /// # Errors
    /// Fails with a text that says what would be right if the unit is missing or unknown, or if the
    /// rate is out of range.
    pub fn parse(text: &str) -> Result<Self, String> {
        let plain = text.strip_suffix("/s").unwrap_or(text);
        let split = plain.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(plain.len());
        let (number, unit) = plain.split_at(split);
        let unit = UNITS.iter().find(|(name, _)| unit.eq_ignore_ascii_case(name));
        let number = number.trim().parse().ok().and_then(Decimal::from_f64);
        let rate = unit.zip(number).map(|(&(_, unit), number)| number.ceil_times(unit));
        rate.and_then(|rate| u64::try_from(rate).ok())
            .filter(|rate| (1..=Self::MAX).contains(rate))
            .map(Self)
            .ok_or_else(|| "expected 1bit to 1000Gbit per second, for example 100Mbit".to_owned())
    }
}

impl fmt::Display for LinkRate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} Mbit/s", millions_text(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_units() {
        let rate = |text| LinkRate::parse(text).map(|rate| rate.0);
        assert_eq!(rate("100Mbit"), Ok(100_000_000));
        assert_eq!(rate("1.5Gbit/s"), Ok(1_500_000_000));
        assert_eq!((rate("9bit"), rate("64kbit")), (Ok(9), Ok(64_000)));
        for wrong in ["", "100", "Mbit", "0Mbit", "-1Mbit", "5MB", "1001Gbit", "100Mbit/h"] {
            assert!(rate(wrong).is_err(), "{wrong}");
        }
        let texts = [9, 64_000, 100_000_000, 1_500_000_000].map(|rate| LinkRate(rate).to_string());
        assert_eq!(texts, ["0.000009 Mbit/s", "0.064 Mbit/s", "100 Mbit/s", "1500 Mbit/s"]);
    }
}
