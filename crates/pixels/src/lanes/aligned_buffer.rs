// SPDX-License-Identifier: MIT OR Apache-2.0
//! Buffers that start at a cache line, so that each block lies in one cache line.

use std::ops::{Deref, DerefMut};

use crate::lanes::lane::{BLOCK_LANES, Block};

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
        let store = vec![T::default(); len + BLOCK_LANES];
        let start = store.as_ptr().align_offset(64).min(BLOCK_LANES);
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
    fn buffers_and_their_copies_start_at_a_cache_line() {
        for len in [0, 1, 64, 1000] {
            let mut buffer = AlignedBuffer::<u16>::new(len);
            buffer.fill(7);
            let copy = buffer.clone();
            assert_eq!(copy.as_ptr().align_offset(64), 0);
            assert_eq!(copy[..], vec![7; len]);
            assert_eq!(copy.blocks().len(), len / BLOCK_LANES);
        }
    }
}
