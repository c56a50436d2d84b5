// SPDX-License-Identifier: MIT OR Apache-2.0
//! A constant tensor in the place of an input that depends on the frame.

use super::{Operator, OperatorJob, ProductKind, output_values};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor::Tensor;
use crate::tensor_form::TensorForm;

#[derive(Clone, Debug)]
pub(crate) struct ConstantTensor(pub(crate) Tensor);

impl Operator for ConstantTensor {
    fn form(&self, _inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        Ok(self.0.form().clone())
    }

    fn encoding(&self, _inputs: &[Encoding]) -> Result<Encoding, String> {
        Ok(self.0.form().encoding())
    }

    fn spread(&self, _inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        Mask::empty(output.height(), output.width())
    }

    fn products(&self) -> ProductKind {
        ProductKind::NoComputation
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_element_type!(job.form.encoding().element, T => {
            output_values::<T>(job.output, job.form).copy_from_slice(self.0.values());
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.0.form().bytes()
    }
}
