// SPDX-License-Identifier: MIT OR Apache-2.0
//! An executor that follows clips, or takes the images of sets one by one.

use crate::camera::Seen;
use foveate_network::{Executor, Mask, Mode, Network, Work};

/// What an executor computes.
#[derive(Clone, Debug)]
pub(crate) enum Way {
    Mode(Mode),
    /// What differs by more than a limit, of each node.
    Limits(Vec<f32>),
}

/// Steps executors through frames: every clip has one that has seen nothing.
#[derive(Clone, Debug)]
pub(crate) struct Player<'a> {
    network: &'a Network,
    way: Way,
    /// That of the clip, once one has begun.
    clip: Option<Playing<'a>>,
}

/// An executor in a clip or set.
#[derive(Clone, Debug)]
struct Playing<'a> {
    executor: Executor<'a>,
    /// As it is after a black picture, from which every image of a set begins.
    black: Option<Executor<'a>>,
    /// Frames so far.
    frames: u64,
}

impl<'a> Player<'a> {
    pub(crate) fn new(network: &'a Network, way: Way) -> Self {
        Self { network, way, clip: None }
    }

    pub(crate) fn network(&self) -> &'a Network {
        self.network
    }

    /// Begins a set with its black picture, a clip without.
    pub(crate) fn begin(&mut self, black: Option<&[f32]>) {
        // The memory of the one before goes first.
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

    /// Runs the network on the next frame. Returns what every node did.
    pub(crate) fn step(&mut self, seen: Seen<'_>) -> &[Work] {
        let playing = self.clip.as_mut().expect(BEGUN);
        if let Some(black) = &playing.black {
            playing.executor.clone_from(black);
        }
        playing.frames += 1;
        playing.executor.step(seen.values, seen.changed)
    }

    /// Whether the frame before counts: all of a set, of a clip all but the first, which is computed whole.
    pub(crate) fn is_counted(&self) -> bool {
        let playing = self.clip.as_ref().expect(BEGUN);
        playing.black.is_some() || playing.frames > 1
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        &self.clip.as_ref().expect(BEGUN).executor
    }
}

const BEGUN: &str = "a clip has begun";
