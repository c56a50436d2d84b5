// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two widths in which pixels are held, and the types their sums need.
//!
//! Up to 8 bits a pixel is a byte, beyond that a 16-bit word; one set of kernels serves both. Loops
//! run over blocks of [`BLOCK`] lanes, so that no loop has a remainder.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitXor, Neg, Sub};

/// Lanes per block: a full AVX-512 register of bytes.
pub const BLOCK: usize = 64;

/// A block of values.
pub type Block<T> = [T; BLOCK];

/// A pixel as the kernels hold it.
pub trait Lane:
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
    /// Sums of three differences of pixels.
    type Signed: Copy
        + Debug
        + Ord
        + Send
        + Sync
        + Add<Output = Self::Signed>
        + Sub<Output = Self::Signed>
        + Neg<Output = Self::Signed>
        + From<Self>
        + TryFrom<u32>;
    /// A column of pixels of one region, added up: 64 pixels at most.
    type Sum: Copy + Debug + Default + Send + Sync + AddAssign + From<Self> + Into<u32> + Into<u64>;
    /// The same of squares.
    type Square: Copy + Debug + Default + Send + Sync + AddAssign + Into<u64>;

    /// One.
    const ONE: Self;
    /// Every bit set.
    const MAX: Self;

    /// `self - other`, at least 0.
    fn minus(self, other: Self) -> Self;
    /// `self + other`, at most [`Lane::MAX`].
    fn plus(self, other: Self) -> Self;
    /// `|self - other|`.
    fn distance(self, other: Self) -> Self;
    /// The square.
    fn square(self) -> Self::Square;
    /// One for true.
    fn hit(hit: bool) -> Self;
    /// The low bits of a number, of which there are no others.
    fn low(value: u32) -> Self;
}

macro_rules! lane {
    ($pixel:ty, signed $signed:ty, sum $sum:ty, square $square:ty) => {
        impl Lane for $pixel {
            type Signed = $signed;
            type Sum = $sum;
            type Square = $square;

            const ONE: Self = 1;
            const MAX: Self = Self::MAX;

            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                self.saturating_sub(other)
            }

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self.saturating_add(other)
            }

            #[inline(always)]
            fn distance(self, other: Self) -> Self {
                self.abs_diff(other)
            }

            #[inline(always)]
            fn square(self) -> Self::Square {
                Self::Square::from(self) * Self::Square::from(self)
            }

            #[inline(always)]
            fn hit(hit: bool) -> Self {
                Self::from(hit)
            }

            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "there are no higher bits")]
            fn low(value: u32) -> Self {
                value as Self
            }
        }
    };
}

lane!(u8, signed i16, sum u16, square u32);
lane!(u16, signed i32, sum u32, square u64);

/// A threshold that the design has checked against its pixel range, as lane type. What does not fit
/// cannot be exceeded, and the largest value of the type stands for it.
pub fn threshold<T: Lane>(value: u32) -> T {
    T::try_from(value).unwrap_or(T::MAX)
}
