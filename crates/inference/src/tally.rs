// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over the frames of a run.

use foveate_network::{Executor, Mask, Network, Work};

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

/// How far values are from those of a whole computation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Distance {
    pub(crate) largest: f64,
    /// Sum of the squared differences.
    pub(crate) difference: f64,
    /// Sum of the squared values.
    pub(crate) energy: f64,
}

impl Distance {
    pub(crate) fn add(&mut self, other: Self) {
        self.largest = self.largest.max(other.largest);
        self.difference += other.difference;
        self.energy += other.energy;
    }

    /// Root of the mean squared difference, as a share of that of the values; 0 if there is no difference.
    pub(crate) fn relative(&self) -> f64 {
        if self.difference == 0.0 { 0.0 } else { (self.difference / self.energy).sqrt() }
    }
}

/// A whole computation beside the one that is judged.
pub(crate) struct Reference<'a> {
    network: &'a Network,
    dense: Executor<'a>,
    /// By node.
    pub(crate) layers: Vec<Distance>,
    /// Frames in which every output has its largest value at the same place.
    pub(crate) agreeing: u64,
    pub(crate) frames: u64,
    /// Frames in which some value of some tensor has other bits.
    pub(crate) different: u64,
    pub(crate) seconds: f64,
}

impl<'a> Reference<'a> {
    pub(crate) fn new(network: &'a Network, dense: Executor<'a>) -> Self {
        Self {
            network,
            dense,
            layers: vec![Distance::default(); network.nodes().len()],
            agreeing: 0,
            frames: 0,
            different: 0,
            seconds: 0.0,
        }
    }

    /// Computes the picture whole and compares every tensor; returns the distance of the outputs. Only a
    /// counted frame is in the means.
    pub(crate) fn judge(
        &mut self,
        picture: &[f32],
        full: &Mask,
        other: &Executor<'_>,
        is_counted: bool,
    ) -> Distance {
        let start = std::time::Instant::now();
        self.dense.step(picture, full);
        let seconds = start.elapsed().as_secs_f64();
        let mut is_different = false;
        let mut of_outputs = Distance::default();
        for node in 0..self.layers.len() {
            let (right, found) =
                (self.dense.value(node + 1).values(), other.value(node + 1).values());
            let (distance, differs) = distance(right, found);
            if is_counted {
                self.layers[node].add(distance);
            }
            is_different |= differs;
            if self.network.outputs().contains(&(node + 1)) {
                of_outputs.add(distance);
            }
        }
        let place = |executor: &Executor<'_>, value: usize| largest(executor.value(value).values());
        let agrees = self
            .network
            .outputs()
            .iter()
            .all(|&value| place(&self.dense, value) == place(other, value));
        self.different += u64::from(is_different);
        if is_counted {
            self.frames += 1;
            self.agreeing += u64::from(agrees);
            self.seconds += seconds;
        }
        of_outputs
    }
}

/// How far values are from the right ones, and whether any has other bits.
fn distance(right: &[f32], found: &[f32]) -> (Distance, bool) {
    let (mut sum, mut differs) = (Distance::default(), false);
    for (&right, &found) in right.iter().zip(found) {
        sum.energy += f64::from(right) * f64::from(right);
        if right.to_bits() != found.to_bits() {
            differs = true;
            let difference = (f64::from(right) - f64::from(found)).abs();
            sum.largest = sum.largest.max(difference);
            sum.difference += difference * difference;
        }
    }
    (sum, differs)
}

/// The place of the largest value, the first of equal ones.
fn largest(values: &[f32]) -> usize {
    let mut best = 0;
    for (at, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = at;
        }
    }
    best
}
