// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole computation of every frame, with which another computation is compared.

use crate::closeness::Closeness;
use foveate_network::sight::Distance;
use foveate_network::{Executor, Mask, Mode, Network};
use std::time::Instant;

/// A whole computation that runs next to the compared one.
pub(crate) struct Reference<'a> {
    network: &'a Network,
    dense: Executor<'a>,
    full: Mask,
    /// The distance of every node's output.
    pub(crate) layers: Vec<Distance>,
    pub(crate) outputs: Closeness,
    /// The number of frames in which some value of some tensor has other bits.
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

    /// Computes the frame whole, compares every tensor, and returns how close the outputs are. Only
    /// a counted frame is part of the means.
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
