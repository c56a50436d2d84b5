// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of a network: an executor goes over clips, or over the frames of data sets one by one.

use crate::camera::Seen;
use foveate_network::{Executor, Mask, Mode, Network, Work};

/// The computation of an executor.
#[derive(Clone, Debug)]
pub(crate) enum Way {
    Mode(Mode),
    /// A computation of the changes above a limit for each node.
    Limits(Vec<f32>),
}

/// Runs a network over frames. Every clip starts with a new executor.
#[derive(Clone, Debug)]
pub(crate) struct Player<'a> {
    network: &'a Network,
    way: Way,
    /// The executor of the current clip, once one has begun.
    clip: Option<Playing<'a>>,
}

/// An executor in a clip or data set.
#[derive(Clone, Debug)]
struct Playing<'a> {
    executor: Executor<'a>,
    /// The executor after a black screen, from which every frame of a data set starts; `None` for a
    /// clip.
    black: Option<Executor<'a>>,
    /// The number of frames so far.
    frames: u64,
}

impl<'a> Player<'a> {
    pub(crate) fn new(network: &'a Network, way: Way) -> Self {
        Self { network, way, clip: None }
    }

    pub(crate) fn network(&self) -> &'a Network {
        self.network
    }

    /// Begins a clip, or a data set if `black` is its input for a black screen.
    pub(crate) fn begin(&mut self, black: Option<&[f32]>) {
        // The memory of the clip before is freed first.
        self.clip = None;
        let mut executor = match &self.way {
            Way::Mode(mode) => Executor::new(self.network, *mode),
            Way::Limits(limits) => Executor::truncating(self.network, limits),
        };
        let form = self.network.input();
        let black = black.map(|picture| {
            executor.step(picture, &Mask::full(form.height(), form.width()));
            executor.clone()
        });
        self.clip = Some(Playing { executor, black, frames: 0 });
    }

    /// Runs the network on the next frame. Returns the work of every node.
    pub(crate) fn step(&mut self, seen: Seen<'_>) -> &[Work] {
        let playing = self.clip.as_mut().expect(BEGUN);
        if let Some(black) = &playing.black {
            playing.executor.clone_from(black);
        }
        playing.frames += 1;
        playing.executor.step(seen.values, seen.changed)
    }

    /// Returns whether the last frame counts: every frame of a data set, and every frame of a clip
    /// but the first, which is computed whole.
    pub(crate) fn is_counted(&self) -> bool {
        let playing = self.clip.as_ref().expect(BEGUN);
        playing.black.is_some() || playing.frames > 1
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        &self.clip.as_ref().expect(BEGUN).executor
    }
}

const BEGUN: &str = "a clip has begun";
