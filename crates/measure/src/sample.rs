// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels in the narrowest type that holds them.

use foveate_pixels::FramePixels;

/// A pixel: a byte up to 8 bits, and a word above.
pub(crate) trait PixelSample: Copy + Default + Ord + Into<u32> {
    /// The type that holds the sum of four products of two pixels.
    type Product: Copy + Default + std::fmt::Debug + Into<u64> + std::ops::AddAssign;

    /// The type that holds the sum of 64 pixels.
    type Sum: Copy + Default + std::fmt::Debug + From<Self> + Into<u32> + std::ops::AddAssign;

    /// Converts a sum of products, below 2^52, to a floating-point number.
    fn sum_to_f64(sum: Self::Product) -> f64;

    /// Returns the product of two pixels.
    fn product(self, other: Self) -> Self::Product;

    /// Returns the absolute difference of two pixels.
    fn difference(self, other: Self) -> Self;

    /// Converts a value that is known to fit.
    fn from_word(value: u16) -> Self;

    /// Converts a grey level that is known to fit. A fraction, which must be a multiple of 1/16, is
    /// rounded to the nearest whole level, and a half is rounded up, as the filter `binomial3x3`
    /// does.
    fn from_grey_level(value: f64) -> Self;

    /// Returns the pixels of a plane, if they have this type.
    fn plane_pixels<'p>(plane: FramePixels<'p>) -> Option<&'p [Self]>;
}

/// The number 2^52. The sum of this number and a whole number below 2^52 is a floating-point number
/// whose lowest bits are the whole number. A conversion by this sum takes one addition in every
/// vector instruction set.
const SHIFT: f64 = 4_503_599_627_370_496.0; // 2^52

/// Half of a sixteenth. The addition of [`SHIFT`] rounds halves to an even number; with this addend,
/// it rounds halves up, and other multiples of a sixteenth as before.
const HALVES_UP: f64 = 0.031_25;

impl PixelSample for u8 {
    type Product = u32;
    type Sum = u16;

    #[inline(always)]
    fn sum_to_f64(sum: u32) -> f64 {
        f64::from_bits(SHIFT.to_bits() | u64::from(sum)) - SHIFT
    }

    #[inline(always)]
    fn product(self, other: Self) -> u32 {
        // The product 255 * 255 fits into 16 bits, and products of 16 bits are the cheapest.
        u32::from(u16::from(self).wrapping_mul(u16::from(other)))
    }

    #[inline(always)]
    fn difference(self, other: Self) -> Self {
        self.abs_diff(other)
    }

    fn from_word(value: u16) -> Self {
        Self::try_from(value).unwrap_or(Self::MAX)
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "the digits are in the lowest bits")]
    fn from_grey_level(value: f64) -> Self {
        (value + HALVES_UP + SHIFT).to_bits() as Self
    }

    fn plane_pixels<'p>(plane: FramePixels<'p>) -> Option<&'p [Self]> {
        match plane {
            FramePixels::Bytes(pixels) => Some(pixels),
            FramePixels::Words(_) => None,
        }
    }
}

impl PixelSample for u16 {
    type Product = u64;
    type Sum = u32;

    #[inline(always)]
    fn sum_to_f64(sum: u64) -> f64 {
        f64::from_bits(SHIFT.to_bits() | sum) - SHIFT
    }

    #[inline(always)]
    fn product(self, other: Self) -> u64 {
        u64::from(u32::from(self) * u32::from(other))
    }

    #[inline(always)]
    fn difference(self, other: Self) -> Self {
        self.abs_diff(other)
    }

    fn from_word(value: u16) -> Self {
        value
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "the digits are in the lowest bits")]
    fn from_grey_level(value: f64) -> Self {
        (value + HALVES_UP + SHIFT).to_bits() as Self
    }

    fn plane_pixels<'p>(plane: FramePixels<'p>) -> Option<&'p [Self]> {
        match plane {
            FramePixels::Words(pixels) => Some(pixels),
            FramePixels::Bytes(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grey_level_comes_back() {
        for value in 0..=u16::MAX {
            assert_eq!(u16::from_grey_level(f64::from(value)), value);
        }
        for value in 0..=u8::MAX {
            assert_eq!(u8::from_grey_level(f64::from(value)), value);
        }
        for sixteenths in 0..=16 * 255_u16 {
            let rounded = u8::try_from((sixteenths + 8) / 16).unwrap();
            assert_eq!(u8::from_grey_level(f64::from(sixteenths) / 16.0), rounded, "{sixteenths}");
        }
        assert_eq!((u8::sum_to_f64(0), u8::sum_to_f64(u32::MAX)), (0.0, 4_294_967_295.0));
        assert_eq!(u16::sum_to_f64(1 << 51), 2_f64.powi(51));
        assert_eq!((255_u8.product(255), u16::MAX.product(u16::MAX)), (65_025, 65_535 * 65_535));
    }
}
