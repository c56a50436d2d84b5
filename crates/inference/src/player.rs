// SPDX-License-Identifier: MIT OR Apache-2.0
//! An executor that follows a clip, or takes the images of a set one by one.

use crate::camera::Seen;
use foveate_network::{Executor, Mask, Work};

/// Steps an executor through frames.
#[derive(Clone, Debug)]
pub(crate) struct Player<'a> {
    executor: Executor<'a>,
    /// As it is after a black picture, from which every image of a set begins.
    black: Option<Executor<'a>>,
    /// Frames so far.
    frames: u64,
}

impl<'a> Player<'a> {
    /// For a set with its black picture, for a clip without.
    pub(crate) fn new(mut executor: Executor<'a>, black: Option<&[f32]>) -> Self {
        let form = executor.value(0).form().clone();
        let black = black.map(|picture| {
            executor.step(picture, &Mask::full(form.height(), form.width()));
            executor.clone()
        });
        Self { executor, black, frames: 0 }
    }

    /// Runs the network on the next frame. Returns what every node did.
    pub(crate) fn step(&mut self, seen: Seen<'_>) -> &[Work] {
        if let Some(black) = &self.black {
            self.executor.clone_from(black);
        }
        self.frames += 1;
        self.executor.step(seen.values, seen.changed)
    }

    /// Whether the frame before counts: all of a set, of a clip all but the first, which is computed whole.
    pub(crate) fn is_counted(&self) -> bool {
        self.black.is_some() || self.frames > 1
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        &self.executor
    }
}
