// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions of one 8-bit value as tables of 256 entries.

use super::sums::rounded;
use super::{Activation, Job, Operator, only};
use crate::element::{Element, Encoding, typed_byte};
use crate::form::Form;
use crate::values::Byte;

#[derive(Clone, Debug)]
pub(crate) struct Table {
    from: Element,
    /// The encoding of the output, or `None` if it is that of the input.
    to: Option<Encoding>,
    /// The results in the order of the input values, from the lowest.
    values: Vec<i32>,
}

impl Table {
    /// Returns the table of a function of stored values.
    pub(crate) fn of_stored(element: Element, of: impl Fn(i32) -> i32) -> Self {
        Self { from: element, to: None, values: range(element).map(of).collect() }
    }

    /// Returns the table of an activation of the real numbers that the values stand for.
    #[allow(clippy::cast_precision_loss, reason = "a difference of 8-bit values")]
    pub(crate) fn of_reals(from: Encoding, to: Encoding, activation: Activation) -> Self {
        let of = |value: i32| {
            let steps = activation.of((value - from.zero) as f32 * from.scale) / to.scale;
            typed_byte!(to.element, Y => i32::from(rounded::<Y>(steps, to.zero)))
        };
        Self { from: from.element, to: Some(to), values: range(from.element).map(of).collect() }
    }

    /// Maps some values through the table.
    #[inline(always)]
    pub(super) fn apply<X: Byte, Y: Byte>(&self, from: &[X], to: &mut [Y]) {
        for (to, &from) in to.iter_mut().zip(from) {
            *to = Y::saturated(self.values[from.index()]);
        }
    }

    /// Returns the encoding of the output for an input with this encoding.
    pub(super) fn encoding_of(&self, input: Encoding) -> Result<Encoding, String> {
        if input.element == self.from {
            Ok(self.to.unwrap_or(input))
        } else {
            Err(super::wanted(self.from, input.element))
        }
    }
}

/// Returns the range of all values.
fn range(element: Element) -> std::ops::RangeInclusive<i32> {
    let (lowest, highest) = element.range();
    lowest..=highest
}

impl Operator for Table {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        only(inputs).cloned()
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        self.encoding_of(*inputs.first().ok_or("it has no input")?)
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, to) = (job.inputs, job.form.encoding().element);
        typed_byte!(self.from, X => {
            let from = inputs[0].values::<X>();
            typed_byte!(to, Y => job.fill::<Y>(|run, to| self.apply(&from[run], to)));
        });
    }
}
