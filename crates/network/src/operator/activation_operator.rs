// SPDX-License-Identifier: MIT OR Apache-2.0
//! An activation function as a node of its own.

use super::{Operator, OperatorJob, only_input};
use crate::activation::Activation;
use crate::tensor::TensorForm;
use foveate_pixels::vectors::{InstructionSet, VectorTask};

/// The number of values that are copied to the output before the function is applied to them, so
/// that they are still in the nearest cache.
const VALUES_AT_ONCE: usize = 1024;

/// An activation as a separate node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ActivationOperator(pub(crate) Activation);

impl Operator for ActivationOperator {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        only_input(inputs).cloned()
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let from = job.inputs[0].values::<f32>();
        let level = InstructionSet::detect();
        job.fill(|run, to| level.run(ActivationTask { from: &from[run], to, of: self.0 }));
    }
}

/// A function of some values, applied as vectors.
struct ActivationTask<'a> {
    from: &'a [f32],
    to: &'a mut [f32],
    of: Activation,
}

impl VectorTask for ActivationTask<'_> {
    #[inline(always)]
    fn run(self) {
        for (to, from) in self.to.chunks_mut(VALUES_AT_ONCE).zip(self.from.chunks(VALUES_AT_ONCE)) {
            to.copy_from_slice(from);
            self.of.apply_to_all(to);
        }
    }
}
