// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels of one frame as their source holds them: rows some stride apart, nothing copied.

/// A borrowed frame of `width` x `height` pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixels<'a, T> {
    pub(crate) values: &'a [T],
    pub(crate) stride: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl<'a, T> Pixels<'a, T> {
    /// Row `y` of the padded frame, without padding on its right.
    #[inline(always)]
    pub(crate) fn row(&self, y: usize) -> &'a [T] {
        &self.values[y.min(self.height - 1) * self.stride..][..self.width]
    }
}
