// SPDX-License-Identifier: MIT OR Apache-2.0
//! A factor and an offset per channel, which is batch normalization after training.

use super::{Operator, OperatorJob, only_input};
use crate::tensor_form::TensorForm;

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
