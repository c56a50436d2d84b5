// SPDX-License-Identifier: MIT OR Apache-2.0
//! How pixels become the values that a network takes.

use super::error::SightError;
use serde::Serialize;

/// How pixels become inputs: `(pixel / largest pixel - mean) / scale`, in every channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mapping {
    /// One value, or one per channel.
    pub mean: Vec<f32>,
    /// One value, or one per channel.
    pub scale: Vec<f32>,
}

impl Mapping {
    /// Refuses a mapping for other channels.
    pub(super) fn check(&self, channels: usize) -> Result<(), SightError> {
        for (what, values) in [("--mean", &self.mean), ("--scale", &self.scale)] {
            if values.len() != 1 && values.len() != channels {
                return Err(SightError::Channels { what, found: values.len(), channels });
            }
        }
        Ok(())
    }

    /// What a share of white becomes in a channel.
    pub(super) fn value(&self, channel: usize, share: f64) -> f32 {
        let of = |values: &[f32]| f64::from(values[if values.len() == 1 { 0 } else { channel }]);
        #[allow(clippy::cast_possible_truncation, reason = "inputs are 32 bits wide")]
        let value = ((share - of(&self.mean)) / of(&self.scale)) as f32;
        value
    }
}

/// A value of a mean as people write it: a number, or a quotient of two.
///
/// # Errors
/// When the text is none, or not finite; the error says what would be right.
pub fn parse_mean(text: &str) -> Result<f32, String> {
    quotient(text).ok_or_else(|| "expected a number, or a quotient such as 127/255".to_owned())
}

/// A value of a scale as people write it: a number above 0, or a quotient of two.
///
/// # Errors
/// When the text is none, or not finite; the error says what would be right.
pub fn parse_scale(text: &str) -> Result<f32, String> {
    quotient(text)
        .filter(|&value| value > 0.0)
        .ok_or_else(|| "expected a number above 0, or a quotient such as 1/255".to_owned())
}

/// A number, or a quotient of two, if it is finite.
fn quotient(text: &str) -> Option<f32> {
    let number = |text: &str| text.parse().ok().filter(|value: &f32| value.is_finite());
    let value = match text.split_once('/') {
        None => number(text)?,
        Some((over, under)) => number(over)? / number(under)?,
    };
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_numbers_or_quotients() {
        assert_eq!((parse_mean("-0.5"), parse_mean("127/255")), (Ok(-0.5), Ok(127.0 / 255.0)));
        assert_eq!((parse_scale("2"), parse_scale("1/255")), (Ok(2.0), Ok(1.0 / 255.0)));
        for wrong in ["", "x", "inf", "nan", "1/0", "1/", "1/2/3"] {
            assert!(parse_mean(wrong).unwrap_err().contains("127/255"), "{wrong}");
            assert!(parse_scale(wrong).unwrap_err().contains("1/255"), "{wrong}");
        }
        for wrong in ["0", "-1", "-1/255"] {
            assert!(parse_scale(wrong).is_err() && parse_mean(wrong).is_ok(), "{wrong}");
        }
    }
}
