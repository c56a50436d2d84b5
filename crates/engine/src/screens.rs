// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rendered frames of a batch. The caller keeps them from batch to batch.
//!
//! Most of a rendered frame is black, and was black in the frame that the buffer held before.
//! Regions that are known to be black are not written again. This is why the buffers are not plain
//! slices of the caller.

use crate::plan::CameraPlan;
use foveate_pixels::lanes::PixelLane;

/// The rendered frames of the last batch, one per frame. The same value can be given to batch after
/// batch of any engine. Pixels are `u8` up to 8 bits and `u16` beyond.
#[derive(Clone, Debug, Default)]
pub struct BatchScreens<T> {
    /// The width and height of the frames and the side of a region.
    size_and_region: (usize, usize, usize),
    /// The screens, followed by unused ones if an earlier batch was longer.
    screens: Vec<KeptScreen<T>>,
    used: usize,
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub(crate) struct KeptScreen<T> {
    pub(crate) pixels: Vec<T>,
    /// The regions that are black.
    pub(crate) black_regions: Vec<bool>,
}

impl<T> BatchScreens<T> {
    /// Makes a buffer without frames.
    #[must_use]
    pub fn new() -> Self {
        Self { size_and_region: (0, 0, 0), screens: Vec::new(), used: 0 }
    }

    /// Returns the rendered frame after frame `number` of the last batch, in row-major order
    /// without padding.
    #[must_use]
    pub fn get(&self, number: usize) -> Option<&[T]> {
        self.iter().nth(number)
    }

    /// Returns all rendered frames of the last batch in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[T]> {
        self.screens[..self.used].iter().map(|screen| &screen.pixels[..])
    }
}

/// Returns one screen per frame, to be written.
pub(crate) fn resize_screens<'a, T: PixelLane>(
    screens: &'a mut BatchScreens<T>,
    plan: &CameraPlan<T>,
    frames: usize,
) -> &'a mut [KeptScreen<T>] {
    let shape = (plan.width, plan.height, plan.side);
    if screens.size_and_region != shape {
        *screens = BatchScreens { size_and_region: shape, ..BatchScreens::new() };
    }
    let new = || KeptScreen {
        pixels: vec![T::default(); plan.width * plan.height],
        black_regions: vec![true; plan.regions()],
    };
    screens.screens.resize_with(frames.max(screens.screens.len()), new);
    screens.used = frames;
    &mut screens.screens[..frames]
}
