// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions of one 8-bit value as tables of 256 entries.

use super::requantization::quantize_steps;
use super::{Operator, OperatorJob, only_input};
use crate::activation::Activation;
use crate::element::{ElementType, Encoding, with_byte_type};
use crate::tensor_form::TensorForm;
use crate::values::ByteNumber;

#[derive(Clone, Debug)]
pub(crate) struct ByteTable {
    from: ElementType,
    /// The encoding of the output, or `None` if it is that of the input.
    to: Option<Encoding>,
    /// The results in the order of the input values, from the lowest.
    values: Vec<i32>,
}

impl ByteTable {
    /// Returns the table of a function of stored values.
    pub(crate) fn from_stored_function(
        element: ElementType,
        function: impl Fn(i32) -> i32,
    ) -> Self {
        Self { from: element, to: None, values: value_range(element).map(function).collect() }
    }

    /// Returns the table of an activation of the real numbers that the values stand for.
    #[allow(clippy::cast_precision_loss, reason = "a difference of 8-bit values")]
    pub(crate) fn from_activation(from: Encoding, to: Encoding, activation: Activation) -> Self {
        let entry = |value: i32| {
            let steps = activation.apply((value - from.zero_point) as f32 * from.scale) / to.scale;
            with_byte_type!(to.element, Y => i32::from(quantize_steps::<Y>(steps, to.zero_point)))
        };
        Self {
            from: from.element,
            to: Some(to),
            values: value_range(from.element).map(entry).collect(),
        }
    }

    /// Maps some values through the table.
    #[inline(always)]
    pub(super) fn apply<X: ByteNumber, Y: ByteNumber>(&self, from: &[X], to: &mut [Y]) {
        for (to, &from) in to.iter_mut().zip(from) {
            *to = Y::from_saturated(self.values[from.table_index()]);
        }
    }

    /// Returns the encoding of the output for an input with this encoding.
    pub(super) fn encoding_of(&self, input: Encoding) -> Result<Encoding, String> {
        if input.element == self.from {
            Ok(self.to.unwrap_or(input))
        } else {
            Err(super::wrong_element_message(self.from, input.element))
        }
    }
}

/// Returns the range of all values.
fn value_range(element: ElementType) -> std::ops::RangeInclusive<i32> {
    let (lowest, highest) = element.range();
    lowest..=highest
}

impl Operator for ByteTable {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        only_input(inputs).cloned()
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        self.encoding_of(*inputs.first().ok_or("it has no input")?)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (inputs, to) = (job.inputs, job.form.encoding().element);
        with_byte_type!(self.from, X => {
            let from = inputs[0].values::<X>();
            with_byte_type!(to, Y => job.fill::<Y>(|run, to| self.apply(&from[run], to)));
        });
    }
}
