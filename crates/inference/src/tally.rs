// SPDX-License-Identifier: MIT OR Apache-2.0
//! The means over the frames of a clip, and the frames whose outputs are not finite.

use crate::frame::{FrameFigures, counted_frames, mean_of_frames};
use crate::macs::Macs;
use crate::summary::ClipSummary;
use foveate_network::{Executor, Network};

/// Returns a clip with the means of its counted frames.
pub(crate) fn clip_summary(
    name: &str,
    problem: Option<&String>,
    frames: &[FrameFigures],
) -> ClipSummary {
    let counted = counted_frames(frames);
    ClipSummary {
        name: name.to_owned(),
        frames: frames.len() as u64,
        counted_frames: counted.len() as u64,
        active_share: mean_of_frames(&counted, |frame| frame.active_share),
        changed_share: mean_of_frames(&counted, |frame| frame.changed_share),
        macs: Macs {
            whole_frame: mean_of_frames(&counted, |frame| frame.macs.whole_frame),
            needed: mean_of_frames(&counted, |frame| frame.macs.needed),
            scheduled: mean_of_frames(&counted, |frame| frame.macs.scheduled),
            whole_blocks: mean_of_frames(&counted, |frame| frame.macs.whole_blocks),
        },
        problem: problem.cloned(),
    }
}

/// The frames whose outputs are infinite or NaN.
#[derive(Clone, Debug, Default)]
pub(crate) struct NotFiniteTally {
    frames: u64,
    /// The clip and the number of the first such frame, and the first node with such a value in it.
    first: Option<(String, u64, usize)>,
}

impl NotFiniteTally {
    pub(crate) fn check_outputs(
        &mut self,
        (clip, frame): (&str, u64),
        network: &Network,
        executor: &Executor<'_>,
    ) {
        let is_odd = |value: usize| {
            !executor.tensor(value).real_values().iter().all(|value| value.is_finite())
        };
        if !network.outputs().iter().any(|&value| is_odd(value)) {
            return;
        }
        self.frames += 1;
        if self.first.is_none() {
            let node = (0..network.nodes().len()).find(|node| is_odd(node + 1));
            self.first = node.map(|node| (clip.to_owned(), frame, node));
        }
    }

    /// Returns a warning, if there is such a frame. A single clip is not named.
    pub(crate) fn warning(&self, network: &Network, is_one_clip: bool) -> Option<String> {
        let (clip, frame, node) = self.first.as_ref()?;
        let node = &network.nodes()[*node];
        let clip = if is_one_clip { String::new() } else { format!(" of `{clip}`") };
        Some(format!(
            "outputs hold values that are infinite or not a number in {} frames; in the first, frame {frame}{clip}, these begin at node `{}` ({})",
            self.frames,
            node.name(),
            node.operator_name()
        ))
    }
}
