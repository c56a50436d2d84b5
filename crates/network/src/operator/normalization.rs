// SPDX-License-Identifier: MIT OR Apache-2.0
//! Normalization: values less their mean, divided by their standard deviation
//! ([`Normalization`]), or values divided by a power of a sum of squares
//! ([`LocalResponseNorm`]). Batch normalization is a factor and an offset per channel after
//! training ([`ChannelScale`]).

use super::binary_operator::aligned_mask;
use super::{Operator, OperatorJob, only_input, output_values};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::threads;

/// The values that share a mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeanGroup {
    /// All axes from this one on share a mean, and every value has a separate scale.
    Axes(usize),
    /// The channels are split into this many groups. All positions of a group share a mean, and the
    /// scale is given per channel or per group.
    Groups(usize),
}

#[derive(Clone, Debug)]
pub(crate) struct Normalization {
    pub(crate) mean_group: MeanGroup,
    pub(crate) epsilon: f32,
    pub(crate) scale: Vec<f32>,
    /// The bias: as many values as there are scales, or empty.
    pub(crate) bias: Vec<f32>,
}

impl Normalization {
    /// Returns the number of values that share a mean, and the number of neighboring values that
    /// share a scale.
    fn lengths(&self, form: &TensorForm) -> (usize, usize) {
        match self.mean_group {
            MeanGroup::Axes(axis) => {
                let block = form.shape()[axis..].iter().product::<usize>();
                (block, block / self.scale.len())
            }
            MeanGroup::Groups(groups) => {
                let each = form.shape()[0] * self.scale.len();
                (form.element_count() / form.shape()[0] / groups, form.element_count() / each)
            }
        }
    }
}

impl Operator for Normalization {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        let (wanted, what) = match self.mean_group {
            MeanGroup::Axes(axis) => {
                let shared_axes =
                    form.shape().get(axis..).filter(|shared_axes| !shared_axes.is_empty());
                let shared_axes =
                    shared_axes.ok_or_else(|| format!("{} has no axis {axis}", form.describe()))?;
                (vec![shared_axes.iter().product(), 1], "values that share a mean")
            }
            MeanGroup::Groups(groups) => {
                let channels = form.shape().get(1).copied().unwrap_or(0);
                if channels == 0 || groups == 0 || channels % groups != 0 {
                    return Err(format!(
                        "{} does not have {groups} groups of channels",
                        form.describe()
                    ));
                }
                (vec![channels, groups], "channels or groups")
            }
        };
        if !wanted.contains(&self.scale.len()) {
            return Err(format!(
                "it has {} scales; {} has {} {what}",
                self.scale.len(),
                form.describe(),
                wanted[0]
            ));
        }
        if !self.bias.is_empty() && self.bias.len() != self.scale.len() {
            return Err(format!(
                "it has {} scales, but a bias of {}",
                self.scale.len(),
                self.bias.len()
            ));
        }
        Ok(form.clone())
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let from = match self.mean_group {
            MeanGroup::Axes(axis) => axis,
            MeanGroup::Groups(_) => 1,
        };
        aligned_mask(inputs[0], output, |axis| (axis < from).then_some(axis))
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "mean and deviation are rounded once"
    )]
    fn compute(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let (block, values_per_scale) = self.lengths(form);
        let values = inputs[0].values::<f32>();
        threads::for_each_chunk(output_values::<f32>(output, form), block, &|number, to| {
            let from = &values[number * block..][..block];
            let count = block as f64;
            let mean = from.iter().map(|&value| f64::from(value)).sum::<f64>() / count;
            let square = |&value: &f32| (f64::from(value) - mean) * (f64::from(value) - mean);
            let variance = from.iter().map(square).sum::<f64>() / count;
            let factor = (1.0 / (variance + f64::from(self.epsilon)).sqrt()) as f32;
            let mean = mean as f32;
            for (at, (to, &from)) in to.iter_mut().zip(from).enumerate() {
                let scale_index = (number * block + at) / values_per_scale % self.scale.len();
                let bias = self.bias.get(scale_index).copied().unwrap_or(0.0);
                *to = (from - mean) * factor * self.scale[scale_index] + bias;
            }
        });
    }

    fn weight_bytes(&self) -> u64 {
        4 * (self.scale.len() + self.bias.len()) as u64
    }
}

/// Local response normalization: values divided by a power of the sum of squares over neighboring
/// channels.
#[derive(Clone, Debug)]
pub(crate) struct LocalResponseNorm {
    /// The number of channels that count before the channel of a value, and behind it.
    pub(crate) neighbor_channels: [usize; 2],
    /// The factor of the sum, already divided by the number of channels.
    pub(crate) alpha: f32,
    pub(crate) beta: f32,
    pub(crate) bias: f32,
}

impl Operator for LocalResponseNorm {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        let is_one =
            form.shape().len() > 1 && form.shape()[0] == 1 && !form.position_axes().contains(&1);
        if is_one {
            Ok(form.clone())
        } else {
            Err(format!("its input must be features, not {}", form.describe()))
        }
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let channels = job.form.shape()[1];
        let plane = job.form.element_count() / channels;
        let from = job.inputs[0].values::<f32>();
        job.fill(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, at) = (place / plane, place % plane);
                let first = channel.saturating_sub(self.neighbor_channels[0]);
                let end = (channel + self.neighbor_channels[1] + 1).min(channels);
                let square =
                    |channel: usize| from[channel * plane + at] * from[channel * plane + at];
                let sum: f32 = (first..end).map(square).sum();
                *to = from[place] / (self.bias + self.alpha * sum).powf(self.beta);
            }
        });
    }
}

#[derive(Clone, Debug)]
pub(crate) struct ChannelScale {
    factors: Vec<f32>,
    offsets: Vec<f32>,
}

impl ChannelScale {
    /// Returns the factors and offsets of `scale * (x - mean) / sqrt(variance + epsilon) + bias`.
    pub(crate) fn from_batch_normalization(
        scale: &[f32],
        bias: &[f32],
        mean: &[f32],
        variance: &[f32],
        epsilon: f32,
    ) -> Result<Self, String> {
        if [bias.len(), mean.len(), variance.len()] != [scale.len(); 3] {
            return Err("scale, bias, mean and variance differ in length".to_owned());
        }
        let factor = |(scale, variance): (&f32, &f32)| scale / (variance + epsilon).sqrt();
        let factors: Vec<f32> = scale.iter().zip(variance).map(factor).collect();
        let offsets = bias
            .iter()
            .zip(mean)
            .zip(&factors)
            .map(|((bias, mean), factor)| bias - mean * factor)
            .collect();
        Ok(Self { factors, offsets })
    }
}

impl Operator for ChannelScale {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        match form.shape().get(1) {
            Some(&channels) if channels == self.factors.len() && form.shape()[0] == 1 => {
                Ok(form.clone())
            }
            _ => Err(format!(
                "its input must have {} channels, not {}",
                self.factors.len(),
                form.describe()
            )),
        }
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let plane = job.form.element_count() / self.factors.len();
        let from = job.inputs[0].values::<f32>();
        job.fill(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let channel = start / plane;
                let (part, rest) = to.split_at_mut(to.len().min((channel + 1) * plane - start));
                let (factor, offset) = (self.factors[channel], self.offsets[channel]);
                for (to, &from) in part.iter_mut().zip(&from[start..]) {
                    *to = from * factor + offset;
                }
                start += part.len();
                to = rest;
            }
        });
    }

    fn weight_bytes(&self) -> u64 {
        8 * self.factors.len() as u64
    }
}
