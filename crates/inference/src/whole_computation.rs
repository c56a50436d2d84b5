// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole computation of every frame, with which another computation is compared.

use crate::closeness::ClosenessTally;
use foveate_network::{ExecutionMode, Executor, Mask, Network, vision::OutputDistance};
use std::time::Instant;

/// A whole computation that runs next to the compared one.
pub(crate) struct WholeComputation<'a> {
    network: &'a Network,
    dense: Executor<'a>,
    full_mask: Mask,
    /// The distance of every node's output.
    pub(crate) layers: Vec<OutputDistance>,
    pub(crate) outputs: ClosenessTally,
    /// The number of frames in which some value of some tensor has other bits.
    pub(crate) different_frames: u64,
    pub(crate) seconds: f64,
}

impl<'a> WholeComputation<'a> {
    pub(crate) fn new(network: &'a Network) -> Self {
        Self {
            network,
            dense: Executor::new(network, ExecutionMode::Dense),
            full_mask: Mask::full(network.input().height(), network.input().width()),
            layers: vec![OutputDistance::default(); network.nodes().len()],
            outputs: ClosenessTally::default(),
            different_frames: 0,
            seconds: 0.0,
        }
    }

    /// Computes the frame whole, compares every tensor, and returns how close the outputs are. Only
    /// a counted frame is part of the means.
    pub(crate) fn compare(
        &mut self,
        picture: &[f32],
        other: &Executor<'_>,
        is_counted: bool,
    ) -> ClosenessTally {
        let start = Instant::now();
        self.dense.step(picture, &self.full_mask);
        let seconds = start.elapsed().as_secs_f64();
        let mut is_different = false;
        for (node, layer) in self.layers.iter_mut().enumerate() {
            let (distance, differs) = OutputDistance::between(
                &self.dense.tensor(node + 1).real_values(),
                &other.tensor(node + 1).real_values(),
            );
            if is_counted {
                layer.add(distance);
            }
            is_different |= differs;
        }
        let outputs = ClosenessTally::compare_outputs(
            self.network,
            |value| self.dense.tensor(value).real_values(),
            other,
        );
        self.different_frames += u64::from(is_different);
        if is_counted {
            self.outputs.add(&outputs);
            self.seconds += seconds;
        }
        outputs
    }
}
