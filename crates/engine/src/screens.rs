// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rendered frames of a batch, kept by the caller from batch to batch.
//!
//! Most of a rendered frame is black, and was black in the frame that was here before: what is known
//! to be black already is not written again, which is why the buffers are not simply the caller's.

use crate::plan::CameraPlan;
use foveate_lanes::Lane;

/// Rendered frames, one per frame of the last batch; to be given to batch after batch, of any engine.
/// Pixels are `u8` up to 8 bits and `u16` beyond.
#[derive(Clone, Debug, Default)]
pub struct Screens<T> {
    /// Width, height and region of the frames.
    shape: (usize, usize, usize),
    /// Those of longer batches stay for the next one.
    screens: Vec<Screen<T>>,
    used: usize,
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub(crate) struct Screen<T> {
    pub(crate) pixels: Vec<T>,
    /// Regions that are black.
    pub(crate) black: Vec<bool>,
}

impl<T> Screens<T> {
    /// No frames yet.
    #[must_use]
    pub fn new() -> Self {
        Self { shape: (0, 0, 0), screens: Vec::new(), used: 0 }
    }

    /// The rendered frame after frame `number` of the last batch: row by row with nothing between.
    #[must_use]
    pub fn get(&self, number: usize) -> Option<&[T]> {
        self.iter().nth(number)
    }

    /// All of them in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[T]> {
        self.screens[..self.used].iter().map(|screen| &screen.pixels[..])
    }
}

/// As many screens as there are frames, to be written.
pub(crate) fn prepare<'a, T: Lane>(
    screens: &'a mut Screens<T>,
    plan: &CameraPlan<T>,
    frames: usize,
) -> &'a mut [Screen<T>] {
    let shape = (plan.width, plan.height, plan.side);
    if screens.shape != shape {
        *screens = Screens { shape, ..Screens::new() };
    }
    let new = || Screen {
        pixels: vec![T::default(); plan.width * plan.height],
        black: vec![true; plan.regions()],
    };
    screens.screens.resize_with(frames.max(screens.screens.len()), new);
    screens.used = frames;
    &mut screens.screens[..frames]
}
