// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of a network: an executor goes over clips, or over the frames of data sets one by one.

use crate::camera::ReceivedFrame;
use foveate_network::{ExecutionMode, Executor, Mask, Network, NodeWork};

/// The computation of an executor.
#[derive(Clone, Debug)]
pub(crate) enum ExecutorMode {
    Mode(ExecutionMode),
    /// A computation of the changes above a limit for each node.
    Limits(Vec<f32>),
}

/// Runs a network over frames. Every clip starts with a new executor.
#[derive(Clone, Debug)]
pub(crate) struct NetworkRunner<'a> {
    network: &'a Network,
    mode: ExecutorMode,
    /// The executor of the current clip, once one has begun.
    clip_executor: Option<ClipExecutor<'a>>,
}

/// An executor in a clip or data set.
#[derive(Clone, Debug)]
struct ClipExecutor<'a> {
    executor: Executor<'a>,
    /// The executor after a black screen, from which every frame of a data set starts; `None` for a
    /// clip.
    black: Option<Executor<'a>>,
    /// The number of frames so far.
    frames: u64,
}

impl<'a> NetworkRunner<'a> {
    pub(crate) fn new(network: &'a Network, way: ExecutorMode) -> Self {
        Self { network, mode: way, clip_executor: None }
    }

    pub(crate) fn network(&self) -> &'a Network {
        self.network
    }

    /// Begins a clip, or a data set if `black` is its input for a black screen.
    pub(crate) fn begin(&mut self, black: Option<&[f32]>) {
        // The memory of the clip before is freed first.
        self.clip_executor = None;
        let mut executor = match &self.mode {
            ExecutorMode::Mode(mode) => Executor::new(self.network, *mode),
            ExecutorMode::Limits(limits) => Executor::with_limits(self.network, limits),
        };
        let form = self.network.input();
        let black = black.map(|picture| {
            executor.step(picture, &Mask::full(form.height(), form.width()));
            executor.clone()
        });
        self.clip_executor = Some(ClipExecutor { executor, black, frames: 0 });
    }

    /// Runs the network on the next frame. Returns the work of every node.
    pub(crate) fn step(&mut self, seen: ReceivedFrame<'_>) -> &[NodeWork] {
        let playing = self.clip_executor.as_mut().expect(CLIP_HAS_BEGUN);
        if let Some(black) = &playing.black {
            playing.executor.clone_from(black);
        }
        playing.frames += 1;
        playing.executor.step(seen.values, seen.changed)
    }

    /// Returns whether the last frame counts: every frame of a data set, and every frame of a clip
    /// but the first, which is computed whole.
    pub(crate) fn is_counted(&self) -> bool {
        let playing = self.clip_executor.as_ref().expect(CLIP_HAS_BEGUN);
        playing.black.is_some() || playing.frames > 1
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        &self.clip_executor.as_ref().expect(CLIP_HAS_BEGUN).executor
    }
}

const CLIP_HAS_BEGUN: &str = "a clip has begun";
