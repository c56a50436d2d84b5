// SPDX-License-Identifier: MIT OR Apache-2.0
//! Requantization: the conversion of exact sums of products of 8-bit values to outputs.

use crate::element::Encoding;
use crate::values::{ByteNumber, TensorNumber};

/// The last steps of a sum: the bias of its channel is added, and the sum is scaled to the output.
#[derive(Clone, Debug)]
pub(crate) struct Requantization {
    /// One bias per channel, or empty.
    pub(crate) bias: Vec<i32>,
    /// The quantization steps of the output per step of the sum: one factor for all channels, or
    /// one per channel. Sums that remain sums do not use it.
    pub(crate) factors: Vec<f32>,
    pub(crate) to: Encoding,
}

impl Requantization {
    /// Returns the conversion for sums that remain 32-bit integers.
    pub(crate) fn none() -> Self {
        Self {
            bias: Vec::new(),
            factors: vec![1.0],
            to: Encoding::plain(crate::element::ElementType::I32),
        }
    }

    /// Returns the output of a channel. Sums beyond 32 bits wrap around, so that the order of
    /// additions does not matter.
    #[inline(always)]
    pub(crate) fn requantize<Y: SumOutput>(&self, channel: usize, sum: i32) -> Y {
        let bias = if self.bias.is_empty() { 0 } else { self.bias[channel] };
        let factor = self.factors[if self.factors.len() == 1 { 0 } else { channel }];
        Y::from_sum(sum.wrapping_add(bias), factor, self.to.zero_point)
    }

    pub(crate) fn bytes(&self) -> u64 {
        4 * (self.bias.len() + self.factors.len()) as u64
    }
}

/// A type of outputs that a sum can be converted to.
pub(crate) trait SumOutput: TensorNumber {
    fn from_sum(sum: i32, factor: f32, zero: i32) -> Self;
}

macro_rules! byte_of_sum {
    ($number:ident) => {
        impl SumOutput for $number {
            #[allow(clippy::cast_precision_loss, reason = "requantization is in floating point")]
            #[inline(always)]
            fn from_sum(sum: i32, factor: f32, zero: i32) -> Self {
                quantize_steps(sum as f32 * factor, zero)
            }
        }
    };
}
byte_of_sum!(u8);
byte_of_sum!(i8);

impl SumOutput for i32 {
    #[inline(always)]
    fn from_sum(sum: i32, _factor: f32, _zero: i32) -> Self {
        sum
    }
}

impl SumOutput for f32 {
    #[allow(clippy::cast_precision_loss, reason = "the value that the sum stands for")]
    #[inline(always)]
    fn from_sum(sum: i32, factor: f32, _zero: i32) -> Self {
        sum as f32 * factor
    }
}

/// Returns the 8-bit value for a number of quantization steps from the zero point. Halves are
/// rounded to even, and results saturate. NaN becomes 0.
#[inline(always)]
pub(crate) fn quantize_steps<Y: ByteNumber>(steps: f32, zero: i32) -> Y {
    // `FAR` is beyond the reach of any zero point. `WHOLE` lies between 2^23 and 2^24, where
    // floating-point values are integers, so that an addition rounds halves to even on every
    // processor without a function call.
    const FAR: f32 = 1024.0;
    const WHOLE: f32 = 12_582_912.0;
    #[allow(clippy::cast_possible_truncation, reason = "it is an integer of few bits")]
    let steps = ((steps.clamp(-FAR, FAR) + WHOLE) - WHOLE) as i32;
    Y::from_saturated(steps + zero)
}
