// SPDX-License-Identifier: MIT OR Apache-2.0
//! The types of the registers that are wider than a pixel.

use std::fmt::Debug;

use foveate_lanes::Lane;

/// A counter of pixels of one region.
pub(crate) trait Count: Copy + Debug + Default + Ord + Send + Sync + 'static {
    /// `self + hits`.
    fn plus(self, hits: Self) -> Self;
    fn get(self) -> u64;
    /// As a threshold; `None` where no count can reach it.
    fn minimum(value: u64) -> Option<Self>;
}

macro_rules! count {
    ($type:ty) => {
        impl Count for $type {
            #[inline(always)]
            fn plus(self, hits: Self) -> Self {
                self.wrapping_add(hits)
            }

            #[inline(always)]
            fn get(self) -> u64 {
                self.into()
            }

            fn minimum(value: u64) -> Option<Self> {
                Self::try_from(value).ok()
            }
        }
    };
}

count!(u8);
count!(u16);

/// A sum over a region, or a score made of it.
pub(crate) trait Sum: Copy + Debug + Default + Ord + Send + Sync + 'static {
    /// `self + pixel`.
    fn add(self, pixel: impl Into<u64>) -> Self;
    /// `self + pixel * pixel`.
    fn add_square(self, pixel: impl Into<u64>) -> Self;
    /// `floor((2^f * self + floor(n / 2)) / n)`.
    fn mean(self, n: u64, fraction_bits: u32) -> Self;
    /// `self + |2^f * pixel - mean|`.
    fn add_deviation(self, pixel: impl Into<u64>, mean: Self, fraction_bits: u32) -> Self;
    /// `n * square_sum - sum * sum`.
    fn variance(sum: Self, square_sum: Self, n: u64) -> Self;
    fn get(self) -> u64;
    /// As a threshold; `None` where no sum can reach it.
    fn minimum(value: u64) -> Option<Self>;
}

macro_rules! sum {
    ($type:ty) => {
        #[allow(clippy::cast_possible_truncation, reason = "the plan takes a type that holds it")]
        impl Sum for $type {
            #[inline(always)]
            fn add(self, pixel: impl Into<u64>) -> Self {
                self.wrapping_add(pixel.into() as Self)
            }

            #[inline(always)]
            fn add_square(self, pixel: impl Into<u64>) -> Self {
                let pixel = pixel.into() as Self;
                self.wrapping_add(pixel.wrapping_mul(pixel))
            }

            fn mean(self, n: u64, fraction_bits: u32) -> Self {
                foveate_model::feature::mad::mean(self.into(), n, fraction_bits) as Self
            }

            #[inline(always)]
            fn add_deviation(self, pixel: impl Into<u64>, mean: Self, fraction_bits: u32) -> Self {
                let scaled = (pixel.into() as Self) << fraction_bits;
                self.wrapping_add(scaled.abs_diff(mean))
            }

            fn variance(sum: Self, square_sum: Self, n: u64) -> Self {
                foveate_model::feature::variance::score(n, sum.into(), square_sum.into()) as Self
            }

            #[inline(always)]
            fn get(self) -> u64 {
                self.into()
            }

            fn minimum(value: u64) -> Option<Self> {
                Self::try_from(value).ok()
            }
        }
    };
}

sum!(u32);
sum!(u64);

/// The types of one array.
pub(crate) trait Types: Debug + Clone + 'static {
    type Pixel: Lane;
    type Count: Count;
    type Sum: Sum;

    /// A hit, 1 or 0, as something to count.
    fn count(hit: Self::Pixel) -> Self::Count;
}

/// Pixels of up to 8 bits, at most 255 of them in a region, sums in 32 bits.
#[derive(Clone, Debug)]
pub(crate) struct Narrow;

/// Pixels of up to 8 bits.
#[derive(Clone, Debug)]
pub(crate) struct Bytes;

/// Pixels of up to 16 bits.
#[derive(Clone, Debug)]
pub(crate) struct Words;

impl Types for Narrow {
    type Pixel = u8;
    type Count = u8;
    type Sum = u32;

    #[inline(always)]
    fn count(hit: Self::Pixel) -> Self::Count {
        hit
    }
}

impl Types for Bytes {
    type Pixel = u8;
    type Count = u16;
    type Sum = u64;

    #[inline(always)]
    fn count(hit: Self::Pixel) -> Self::Count {
        hit.into()
    }
}

impl Types for Words {
    type Pixel = u16;
    type Count = u16;
    type Sum = u64;

    #[inline(always)]
    fn count(hit: Self::Pixel) -> Self::Count {
        hit
    }
}
