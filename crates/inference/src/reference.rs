// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole computation of every frame, which says how far another one is from it.

use crate::closeness::Closeness;
use foveate_network::sight::Distance;
use foveate_network::{Executor, Mask, Mode, Network};
use std::time::Instant;

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
