// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over the frames of a clip, and frames whose outputs are not finite.

use crate::frame::Frame;
use crate::macs::Macs;
use crate::summary::Clip;
use foveate_network::{Executor, Network};

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
