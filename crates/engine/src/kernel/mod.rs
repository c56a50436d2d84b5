// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arithmetic on blocks of lanes: one file per step, plain loops that vectorise.
//!
//! Slices of blocks of one call are equally long; a loop that pairs them stops at the shortest.
#![allow(
    clippy::needless_range_loop,
    clippy::manual_memcpy,
    reason = "lanes by number, in one loop: what vectorises"
)]

pub(crate) mod corner;
pub(crate) mod edge;
pub(crate) mod mad;
pub(crate) mod median;
pub(crate) mod sums;
pub(crate) mod temporal;

use crate::lane::Block;

/// The eight neighbors of every lane, and the lane itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Windows<'a, T> {
    pub(crate) above: Line<'a, T>,
    pub(crate) here: Line<'a, T>,
    pub(crate) below: Line<'a, T>,
}

/// One row of windows: what is left of every lane, the lane, and what is right of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<'a, T> {
    pub(crate) west: &'a [Block<T>],
    pub(crate) center: &'a [Block<T>],
    pub(crate) east: &'a [Block<T>],
}

impl<'a, T> Line<'a, T> {
    /// The same, known to the compiler to have as many blocks as another slice.
    #[inline(always)]
    pub(crate) fn of(self, blocks: usize) -> Self {
        Self {
            west: &self.west[..blocks],
            center: &self.center[..blocks],
            east: &self.east[..blocks],
        }
    }
}
