// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bytes that the layers read and write for a frame, and their time.

use foveate_network::{Executor, Network, TensorForm};
use serde::Serialize;
use std::ops::AddAssign;

/// The traffic summed over frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TrafficTally {
    pub(crate) read: u64,
    pub(crate) halo: u64,
    pub(crate) written: u64,
    pub(crate) seconds: f64,
}

/// The mean traffic of a frame, or of a layer of it, without weights, over the counted frames.
/// Blocks that are computed beyond the needed positions are not counted.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct FrameTraffic {
    /// The bytes of the inputs that the needed outputs see, each input once.
    pub read_bytes: f64,
    /// The bytes of the unchanged inputs that the needed outputs see: the halo around changes.
    pub halo_bytes: f64,
    /// The bytes of the needed outputs.
    pub written_bytes: f64,
    /// The time in the operators in seconds.
    pub seconds: f64,
}

impl TrafficTally {
    /// Returns the traffic of a node for the last frame.
    pub(crate) fn of_node(network: &Network, executor: &Executor<'_>, node: usize) -> Self {
        let bytes = |form: &TensorForm, positions: usize| {
            form.bytes() / form.position_count() as u64 * positions as u64
        };
        let mut found = Self {
            written: bytes(network.form(node + 1), executor.needed_mask(node).count()),
            seconds: executor.operator_time(node).as_secs_f64(),
            ..Self::default()
        };
        for (value, seen) in executor.needed_inputs(node) {
            let form = network.form(value);
            found.read += bytes(form, seen.count());
            found.halo += bytes(form, seen.count_outside(executor.change_mask(value)));
        }
        found
    }

    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub(crate) fn mean(&self, frames: u64) -> FrameTraffic {
        let frames = frames.max(1) as f64;
        FrameTraffic {
            read_bytes: self.read as f64 / frames,
            halo_bytes: self.halo as f64 / frames,
            written_bytes: self.written as f64 / frames,
            seconds: self.seconds / frames,
        }
    }
}

impl AddAssign for TrafficTally {
    fn add_assign(&mut self, other: Self) {
        self.read += other.read;
        self.halo += other.halo;
        self.written += other.written;
        self.seconds += other.seconds;
    }
}
