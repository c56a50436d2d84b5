// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quantization of floating-point values to 8 bits, and dequantization.

use super::requantization::quantize_steps;
use super::{Operator, OperatorJob, only_input, wrong_element_message};
use crate::element::{ElementType, Encoding, with_byte_type, with_element_type};
use crate::tensor_form::TensorForm;
use crate::values::TensorNumber as _;

/// Scales and zero points: one for a complete tensor, or one for each index of an axis.
#[derive(Clone, Debug)]
pub(crate) struct QuantizationScales {
    pub(crate) scales: Vec<f32>,
    /// The zero points; there are as many as scales.
    pub(crate) zero_points: Vec<i32>,
    /// The axis; a negative number counts from the end.
    pub(crate) axis: i64,
}

impl QuantizationScales {
    /// Returns the scale and zero point of a complete tensor.
    pub(crate) fn per_tensor(scale: f32, zero: i32) -> Self {
        Self { scales: vec![scale], zero_points: vec![zero], axis: 0 }
    }

    /// Returns the encoding of a tensor that has been quantized with these scales.
    fn encoding(&self, element: ElementType) -> Encoding {
        match (self.scales.as_slice(), self.zero_points.as_slice()) {
            (&[scale], &[zero]) => Encoding { element, scale, zero_point: zero },
            _ => Encoding::plain(element),
        }
    }

    /// Fails if the axis of a form does not have as many indices as there are scales.
    pub(crate) fn check(&self, form: &TensorForm) -> Result<(), String> {
        let count = self.scales.len();
        if count == 1 {
            return Ok(());
        }
        let axis = form.resolve_axis(self.axis)?;
        match form.shape()[axis] {
            length if length == count => Ok(()),
            length => Err(format!(
                "it has {count} scales, but axis {axis} of {} has {length} elements; it must have 1 or {length}",
                form.describe()
            )),
        }
    }

    /// Returns the scale and the zero point of the value at memory index `place`.
    #[allow(clippy::cast_precision_loss, reason = "a zero point is an 8-bit value")]
    #[inline(always)]
    pub(crate) fn scale_and_zero_point(&self, form: &TensorForm, place: usize) -> (f32, f32) {
        let at = match self.scales.len() {
            1 => 0,
            count => {
                let axis = form.resolve_axis(self.axis).expect("the form has it");
                place / form.shape()[axis + 1..].iter().product::<usize>() % count
            }
        };
        (self.scales[at], self.zero_points[at] as f32)
    }

    fn bytes(&self) -> u64 {
        8 * self.scales.len() as u64
    }
}

/// Quantizes floating-point values to 8-bit values.
#[derive(Clone, Debug)]
pub(crate) struct Quantize {
    pub(crate) scales: QuantizationScales,
    pub(crate) to: ElementType,
}

impl Operator for Quantize {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        self.scales.check(form).map(|()| form.clone())
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != ElementType::F32) {
            None => Ok(self.scales.encoding(self.to)),
            Some(input) => Err(wrong_element_message(ElementType::F32, input.element)),
        }
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (from, form) = (job.inputs[0].values::<f32>(), job.form);
        with_byte_type!(self.to, Y => job.fill::<Y>(|run, to| {
            for (place, to) in run.zip(to) {
                let (scale, zero) = self.scales.scale_and_zero_point(form, place);
                #[allow(clippy::cast_possible_truncation, reason = "a zero point is an integer")]
                let zero = zero as i32;
                *to = quantize_steps(from[place] / scale, zero);
            }
        }));
    }

    fn weight_bytes(&self) -> u64 {
        self.scales.bytes()
    }
}

/// Dequantizes integers to floating-point values.
#[derive(Clone, Debug)]
pub(crate) struct Dequantize(pub(crate) QuantizationScales);

impl Operator for Dequantize {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        self.0.check(form).map(|()| form.clone())
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element == ElementType::F32) {
            None => Ok(Encoding::FLOAT),
            Some(_) => Err("it takes integers, but its input holds floating-point values".into()),
        }
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        with_element_type!(inputs[0].form().encoding().element, X => {
            let from = inputs[0].values::<X>();
            job.fill(|run, to| {
                for (place, to) in run.zip(to) {
                    let (scale, zero) = self.0.scale_and_zero_point(form, place);
                    *to = (from[place].to_f32() - zero) * scale;
                }
            });
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.0.bytes()
    }
}
