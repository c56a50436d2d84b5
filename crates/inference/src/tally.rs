// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over the frames of a run.

use crate::closeness::{Closeness, Distance};
use foveate_network::{Executor, Mask, Mode, Network, Work};
use std::time::Instant;

/// Positions of a node over all counted frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positions {
    pub(crate) all: u64,
    pub(crate) needed: u64,
    pub(crate) scheduled: u64,
    pub(crate) changed: u64,
}

impl Positions {
    pub(crate) fn add(&mut self, work: &Work, places: usize) {
        self.all += places as u64;
        self.needed += work.needed as u64;
        self.scheduled += work.scheduled as u64;
        self.changed += work.changed as u64;
    }
}

/// Frames with outputs that are infinite or no numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct NotFinite {
    frames: u64,
    /// Number of the first such frame, and the first node of it that made such a value.
    first: Option<(u64, usize)>,
}

impl NotFinite {
    /// Looks at the outputs of a frame.
    pub(crate) fn look(&mut self, frame: u64, network: &Network, executor: &Executor<'_>) {
        let is_odd =
            |value: usize| !executor.value(value).reals().iter().all(|value| value.is_finite());
        if !network.outputs().iter().any(|&value| is_odd(value)) {
            return;
        }
        self.frames += 1;
        if self.first.is_none() {
            let node = (0..network.nodes().len()).find(|node| is_odd(node + 1));
            self.first = node.map(|node| (frame, node));
        }
    }

    /// In words, if there was one.
    pub(crate) fn warning(&self, network: &Network) -> Option<String> {
        let (frame, node) = self.first?;
        let node = &network.nodes()[node];
        Some(format!(
            "outputs hold infinite values, or such that are no numbers, in {} frames; in the first, frame {frame}, they begin at node `{}` ({})",
            self.frames,
            node.name(),
            node.kind()
        ))
    }
}

/// A whole computation beside the one that is judged.
pub(crate) struct Reference<'a> {
    network: &'a Network,
    dense: Executor<'a>,
    full: Mask,
    /// By node.
    pub(crate) layers: Vec<Distance>,
    pub(crate) outputs: Closeness,
    /// Frames in which some value of some tensor has other bits.
    pub(crate) different: u64,
    pub(crate) seconds: f64,
}

impl<'a> Reference<'a> {
    pub(crate) fn new(network: &'a Network) -> Self {
        Self {
            network,
            dense: Executor::new(network, Mode::Dense),
            full: Mask::full(network.input().height(), network.input().width()),
            layers: vec![Distance::default(); network.nodes().len()],
            outputs: Closeness::default(),
            different: 0,
            seconds: 0.0,
        }
    }

    /// Computes the picture whole and compares every tensor; returns how close the outputs are. Only a
    /// counted frame is in the means.
    pub(crate) fn judge(
        &mut self,
        picture: &[f32],
        other: &Executor<'_>,
        is_counted: bool,
    ) -> Closeness {
        let start = Instant::now();
        self.dense.step(picture, &self.full);
        let seconds = start.elapsed().as_secs_f64();
        let mut is_different = false;
        for (node, layer) in self.layers.iter_mut().enumerate() {
            let (distance, differs) =
                Distance::of(&self.dense.value(node + 1).reals(), &other.value(node + 1).reals());
            if is_counted {
                layer.add(distance);
            }
            is_different |= differs;
        }
        let outputs = Closeness::of(self.network, |value| self.dense.value(value).reals(), other);
        self.different += u64::from(is_different);
        if is_counted {
            self.outputs.add(&outputs);
            self.seconds += seconds;
        }
        outputs
    }
}
