// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over the frames of a run.

use crate::closeness::{Closeness, Distance};
use crate::frame::Frame;
use crate::summary::{Clip, Macs};
use foveate_network::{Executor, Mask, Mode, Network, Work};
use std::ops::AddAssign;
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
    /// Of a frame.
    pub(crate) fn of(work: &Work, places: usize) -> Self {
        Self {
            all: places as u64,
            needed: work.needed as u64,
            scheduled: work.scheduled as u64,
            changed: work.changed as u64,
        }
    }
}

impl AddAssign for Positions {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.needed += other.needed;
        self.scheduled += other.scheduled;
        self.changed += other.changed;
    }
}

/// Sums over the frames of a clip.
#[derive(Clone, Debug)]
pub(crate) struct ClipSums {
    pub(crate) name: String,
    pub(crate) problem: Option<String>,
    frames: u64,
    counted: u64,
    active: f64,
    changed: f64,
    macs: Macs,
}

impl ClipSums {
    pub(crate) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            problem: None,
            frames: 0,
            counted: 0,
            active: 0.0,
            changed: 0.0,
            macs: Macs::default(),
        }
    }

    pub(crate) fn add(&mut self, frame: &Frame) {
        self.frames += 1;
        if !frame.is_counted {
            return;
        }
        self.counted += 1;
        self.active += frame.active;
        self.changed += frame.changed;
        self.macs += frame.macs;
    }

    /// The means of the counted frames.
    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub(crate) fn summary(&self) -> Clip {
        let mean = |sum: f64| sum / self.counted.max(1) as f64;
        Clip {
            name: self.name.clone(),
            frames: self.frames,
            counted_frames: self.counted,
            active_share: mean(self.active),
            changed_share: mean(self.changed),
            macs: Macs {
                dense: mean(self.macs.dense),
                needed: mean(self.macs.needed),
                scheduled: mean(self.macs.scheduled),
                whole: mean(self.macs.whole),
            },
            problem: self.problem.clone(),
        }
    }
}

/// Frames with outputs that are infinite or no numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct NotFinite {
    frames: u64,
    /// Clip and number of the first such frame, and the first node of it that made such a value.
    first: Option<(String, u64, usize)>,
}

impl NotFinite {
    /// Looks at the outputs of a frame.
    pub(crate) fn look(
        &mut self,
        (clip, frame): (&str, u64),
        network: &Network,
        executor: &Executor<'_>,
    ) {
        let is_odd =
            |value: usize| !executor.value(value).reals().iter().all(|value| value.is_finite());
        if !network.outputs().iter().any(|&value| is_odd(value)) {
            return;
        }
        self.frames += 1;
        if self.first.is_none() {
            let node = (0..network.nodes().len()).find(|node| is_odd(node + 1));
            self.first = node.map(|node| (clip.to_owned(), frame, node));
        }
    }

    /// In words, if there was one. The only clip needs no name.
    pub(crate) fn warning(&self, network: &Network, is_one_clip: bool) -> Option<String> {
        let (clip, frame, node) = self.first.as_ref()?;
        let node = &network.nodes()[*node];
        let clip = if is_one_clip { String::new() } else { format!(" of `{clip}`") };
        Some(format!(
            "outputs hold infinite values, or such that are no numbers, in {} frames; in the first, frame {frame}{clip}, they begin at node `{}` ({})",
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
