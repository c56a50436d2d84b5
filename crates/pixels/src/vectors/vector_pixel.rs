// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pixel in vector registers ([`VectorPixel`]): one of up to 8 bits is a byte, a wider one is
//! a 16-bit word. The kernels are generic over both. Loops run over blocks of [`BLOCK_LENGTH`]
//! elements, so that no loop has a remainder; in an [`AlignedBuffer`] each block lies in one
//! cache line.
//!
//! FAST 5/8 is a network of minima and maxima of such pixels ([`best_arc`]). The score of an
//! arc is the minimum of its five pixels, and the best arc has the largest of the eight minima.
//! Two arcs that share four pixels have the maximum `min(four, max(pixel before, pixel
//! after))`, so four groups of four pixels serve all eight arcs.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitXor, Deref, DerefMut, Neg, Sub};

/// The number of elements of a block, which is the number of bytes of an AVX-512 register.
pub const BLOCK_LENGTH: usize = 64;

/// One value per element of a block.
pub type Block<T> = [T; BLOCK_LENGTH];

/// A pixel in the type in which the kernels compute.
pub trait VectorPixel:
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
    /// Returns `self + other`, at most [`VectorPixel::MAX`].
    fn saturating_plus(self, other: Self) -> Self;
    /// Returns `|self - other|`.
    fn absolute_difference(self, other: Self) -> Self;
    /// Returns the square of the pixel.
    fn square(self) -> Self::SquareSum;
    /// Returns 1 for true and 0 for false.
    fn from_hit(hit: bool) -> Self;
    /// Returns a sixteenth of the sum, rounded to the nearest integer; a half is rounded up. It
    /// must fit into the type.
    fn rounded_sixteenth(sum: Self::ColumnSum) -> Self;
    /// Converts a number that fits into the type; higher bits would be cut off.
    fn from_low_bits(value: u32) -> Self;
}

macro_rules! element {
    ($pixel:ty, signed $signed:ty, sum $sum:ty, square $square:ty) => {
        impl VectorPixel for $pixel {
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

element!(u8, signed i16, sum u16, square u32);
element!(u16, signed i32, sum u32, square u64);

/// Converts a threshold that the design has checked against its pixel range. A threshold that does
/// not fit into the element type cannot be exceeded, so the largest value of the type replaces it.
pub fn saturated_threshold<T: VectorPixel>(value: u32) -> T {
    T::try_from(value).unwrap_or(T::MAX)
}

/// Returns the score of the best of the eight arcs of five neighbors in a ring. `worse` returns the
/// worse of two pixels, and `better` the better one. The score of an arc is its worst pixel. With
/// minimum and maximum, the best arc is the brightest one; with maximum and minimum, the darkest.
#[inline(always)]
pub fn best_arc<T: VectorPixel>(
    x: [T; 8],
    worse: impl Fn(T, T) -> T,
    better: impl Fn(T, T) -> T,
) -> T {
    let pair = [worse(x[0], x[1]), worse(x[2], x[3]), worse(x[4], x[5]), worse(x[6], x[7])];
    // An arc is the four pixels k to k + 3 with a fifth, k - 1 or k + 4.
    let best_of_two = |four: T, before: T, after: T| worse(four, better(before, after));
    let a = best_of_two(worse(pair[0], pair[1]), x[7], x[4]);
    let b = best_of_two(worse(pair[1], pair[2]), x[1], x[6]);
    let c = best_of_two(worse(pair[2], pair[3]), x[3], x[0]);
    let d = best_of_two(worse(pair[3], pair[0]), x[5], x[2]);
    better(better(a, b), better(c, d))
}

/// A buffer whose first value is at the start of a cache line.
#[derive(Debug)]
pub struct AlignedBuffer<T> {
    store: Vec<T>,
    start: usize,
    len: usize,
}

impl<T: Copy + Default> AlignedBuffer<T> {
    /// Returns a buffer of `len` default values.
    pub fn new(len: usize) -> Self {
        let store = vec![T::default(); len + BLOCK_LENGTH];
        let start = store.as_ptr().align_offset(64).min(BLOCK_LENGTH);
        Self { store, start, len }
    }
}

impl<T> AlignedBuffer<T> {
    /// The values as blocks. A remainder that fills no whole block is left out.
    pub fn blocks(&self) -> &[Block<T>] {
        self.as_chunks().0
    }

    /// The values as mutable blocks. A remainder that fills no whole block is left out.
    pub fn blocks_mut(&mut self) -> &mut [Block<T>] {
        self.as_chunks_mut().0
    }
}

impl<T: Copy + Default> Clone for AlignedBuffer<T> {
    /// Copies the values into a new aligned buffer.
    fn clone(&self) -> Self {
        let mut copy = Self::new(self.len);
        copy.copy_from_slice(self);
        copy
    }
}

impl<T> Deref for AlignedBuffer<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.store[self.start..][..self.len]
    }
}

impl<T> DerefMut for AlignedBuffer<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.store[self.start..][..self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ring_of_zeros_and_ones_has_its_best_arc() {
        for bits in 0..256u32 {
            let ring: [u8; 8] = std::array::from_fn(|place| u8::from(bits >> place & 1 == 1));
            let has_arc_of =
                |value| (0..8).any(|start| (0..5).all(|k| ring[(start + k) % 8] == value));
            assert_eq!(best_arc(ring, u8::min, u8::max) == 1, has_arc_of(1), "{ring:?}");
            assert_eq!(best_arc(ring, u8::max, u8::min) == 0, has_arc_of(0), "{ring:?}");
        }
    }

    #[test]
    fn buffers_and_their_copies_start_at_a_cache_line() {
        for len in [0, 1, 64, 1000] {
            let mut buffer = AlignedBuffer::<u16>::new(len);
            buffer.fill(7);
            let copy = buffer.clone();
            assert_eq!(copy.as_ptr().align_offset(64), 0);
            assert_eq!(copy[..], vec![7; len]);
            assert_eq!(copy.blocks().len(), len / BLOCK_LENGTH);
        }
    }
}
