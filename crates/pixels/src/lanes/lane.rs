// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two lane types of a pixel, and the types of their sums.
//!
//! A pixel of up to 8 bits is a byte, a wider one is a 16-bit word. The kernels are generic over
//! both. Loops run over blocks of [`BLOCK_LANES`] lanes, so that no loop has a remainder.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitXor, Neg, Sub};

/// The number of lanes of a block, which is the number of bytes of an AVX-512 register.
pub const BLOCK_LANES: usize = 64;

/// One value per lane of a block.
pub type Block<T> = [T; BLOCK_LANES];

/// A pixel in the type in which the kernels compute.
pub trait PixelLane:
    Copy
    + Debug
    + Default
    + Ord
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + BitAnd<Output = Self>
    + BitXor<Output = Self>
    + TryFrom<u32>
    + Into<u64>
    + 'static
{
    /// The sum of three differences of pixels, with sign.
    type Signed: Copy
        + Debug
        + Default
        + Ord
        + Send
        + Sync
        + Add<Output = Self::Signed>
        + Sub<Output = Self::Signed>
        + Neg<Output = Self::Signed>
        + From<Self>
        + TryFrom<u32>;
    /// The sum of a column of pixels of one region: 64 pixels at most.
    type ColumnSum: Copy
        + Debug
        + Default
        + Send
        + Sync
        + AddAssign
        + From<Self>
        + Into<u32>
        + Into<u64>;
    /// The sum of the squares of a column of pixels of one region: 64 pixels at most.
    type SquareSum: Copy + Debug + Default + Send + Sync + AddAssign + Into<u64>;

    /// The value 1.
    const ONE: Self;
    /// The largest value: every bit is set.
    const MAX: Self;

    /// Returns `self - other`, at least 0.
    fn saturating_minus(self, other: Self) -> Self;
    /// Returns `self + other`, at most [`PixelLane::MAX`].
    fn saturating_plus(self, other: Self) -> Self;
    /// Returns `|self - other|`.
    fn absolute_difference(self, other: Self) -> Self;
    /// Returns the square of the pixel.
    fn square(self) -> Self::SquareSum;
    /// Returns 1 for true and 0 for false.
    fn from_hit(hit: bool) -> Self;
    /// Returns a sixteenth of the sum, rounded to the nearest integer; a half is rounded up. It must
    /// fit into the type.
    fn rounded_sixteenth(sum: Self::ColumnSum) -> Self;
    /// Converts a number that fits into the type; higher bits would be cut off.
    fn from_low_bits(value: u32) -> Self;
}

macro_rules! lane {
    ($pixel:ty, signed $signed:ty, sum $sum:ty, square $square:ty) => {
        impl PixelLane for $pixel {
            type Signed = $signed;
            type ColumnSum = $sum;
            type SquareSum = $square;

            const ONE: Self = 1;
            const MAX: Self = Self::MAX;

            #[inline(always)]
            fn saturating_minus(self, other: Self) -> Self {
                self.saturating_sub(other)
            }

            #[inline(always)]
            fn saturating_plus(self, other: Self) -> Self {
                self.saturating_add(other)
            }

            #[inline(always)]
            fn absolute_difference(self, other: Self) -> Self {
                self.abs_diff(other)
            }

            #[inline(always)]
            fn square(self) -> Self::SquareSum {
                Self::SquareSum::from(self) * Self::SquareSum::from(self)
            }

            #[inline(always)]
            fn from_hit(hit: bool) -> Self {
                Self::from(hit)
            }

            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "there are no higher bits")]
            fn rounded_sixteenth(sum: Self::ColumnSum) -> Self {
                ((sum + 8) >> 4) as Self
            }

            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "there are no higher bits")]
            fn from_low_bits(value: u32) -> Self {
                value as Self
            }
        }
    };
}

lane!(u8, signed i16, sum u16, square u32);
lane!(u16, signed i32, sum u32, square u64);

/// Converts a threshold that the design has checked against its pixel range. A threshold that does
/// not fit into the lane type cannot be exceeded, so the largest value of the type replaces it.
pub fn saturated_threshold<T: PixelLane>(value: u32) -> T {
    T::try_from(value).unwrap_or(T::MAX)
}
