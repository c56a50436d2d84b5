// SPDX-License-Identifier: MIT OR Apache-2.0
//! A constant tensor in the place of an input that depends on the frame.

use super::{Job, Operator, Products, values_of};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::Mask;
use crate::tensor::Tensor;

#[derive(Clone, Debug)]
pub(crate) struct Fixed(pub(crate) Tensor);

impl Operator for Fixed {
    fn form(&self, _inputs: &[&Form]) -> Result<Form, String> {
        Ok(self.0.form().clone())
    }

    fn encoding(&self, _inputs: &[Encoding]) -> Result<Encoding, String> {
        Ok(self.0.form().encoding())
    }

    fn spread(&self, _inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        Mask::empty(output.height(), output.width())
    }

    fn products(&self) -> Products {
        Products::Renamed
    }

    fn compute(&self, job: Job<'_>) {
        typed!(job.form.encoding().element, T => {
            values_of::<T>(job.output, job.form).copy_from_slice(self.0.values());
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.0.form().bytes()
    }
}
