// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of pixels to the values that a network takes.

use super::error::VisionError;
use serde::Serialize;

/// The conversion of pixels to inputs of a network: `(pixel / largest pixel - mean) / scale`, in
/// every channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelMapping {
    /// The mean: one value, or one per channel.
    pub mean: Vec<f32>,
    /// The scale: one value, or one per channel.
    pub scale: Vec<f32>,
}

impl PixelMapping {
    /// Fails if the mapping is for another number of channels.
    pub(super) fn check(&self, channels: usize) -> Result<(), VisionError> {
        for (what, values) in [("--mean", &self.mean), ("--scale", &self.scale)] {
            if values.len() != 1 && values.len() != channels {
                return Err(VisionError::ChannelCount { what, found: values.len(), channels });
            }
        }
        Ok(())
    }

    /// Returns the input value in a channel for a pixel given as a share of white.
    pub(super) fn input_value(&self, channel: usize, share: f64) -> f32 {
        let channel_value =
            |values: &[f32]| f64::from(values[if values.len() == 1 { 0 } else { channel }]);
        #[allow(clippy::cast_possible_truncation, reason = "inputs are 32 bits wide")]
        let value = ((share - channel_value(&self.mean)) / channel_value(&self.scale)) as f32;
        value
    }
}

/// Parses a value of a mean as users write it: a number, or a quotient of two numbers.
///
/// # Errors
/// Fails if the text is no number or quotient, or if the value is not finite; the message tells
/// what is expected.
pub fn parse_mean(text: &str) -> Result<f32, String> {
    parse_quotient(text)
        .ok_or_else(|| "expected a number, or a quotient such as 127/255".to_owned())
}

/// Parses a value of a scale as users write it: a number above 0, or a quotient of two numbers.
///
/// # Errors
/// Fails if the text is no number or quotient, or if the value is not finite or not above 0; the
/// message tells what is expected.
pub fn parse_scale(text: &str) -> Result<f32, String> {
    parse_quotient(text)
        .filter(|&value| value > 0.0)
        .ok_or_else(|| "expected a number above 0, or a quotient such as 1/255".to_owned())
}

/// Parses a number, or a quotient of two numbers, and returns it if it is finite.
fn parse_quotient(text: &str) -> Option<f32> {
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
