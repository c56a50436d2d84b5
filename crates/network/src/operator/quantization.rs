// SPDX-License-Identifier: MIT OR Apache-2.0
//! Conversions between floating-point values, 8-bit values ([`Quantize`], [`Dequantize`]), and
//! exact sums of products of 8-bit values ([`Requantization`]). Any function of one 8-bit value
//! is a table of 256 entries ([`ByteTable`]).

use super::{Operator, OperatorJob, only_input, wrong_element_message};
use crate::activation::Activation;
use crate::element::{ElementType, Encoding, with_byte_type, with_element_type};
use crate::tensor::TensorForm;
use crate::values::{ByteNumber, TensorNumber};

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

/// The last steps of a sum: the bias of its channel is added, and the sum is scaled to the output.
#[derive(Clone, Debug)]
pub(crate) struct Requantization {
    /// One bias per channel, or empty.
    pub(crate) bias: Vec<i32>,
    /// The quantization steps of the output per step of the sum: one factor for all channels, or
    /// one per channel. Sums that remain sums do not use it.
    pub(crate) factors: Vec<f32>,
    pub(crate) to: Encoding,
}

impl Requantization {
    /// Returns the conversion for sums that remain 32-bit integers.
    pub(crate) fn none() -> Self {
        Self { bias: Vec::new(), factors: vec![1.0], to: Encoding::plain(ElementType::I32) }
    }

    /// Returns the output of a channel. Sums beyond 32 bits wrap around, so that the order of
    /// additions does not matter.
    #[inline(always)]
    pub(crate) fn requantize<Y: SumOutput>(&self, channel: usize, sum: i32) -> Y {
        let bias = if self.bias.is_empty() { 0 } else { self.bias[channel] };
        let factor = self.factors[if self.factors.len() == 1 { 0 } else { channel }];
        Y::from_sum(sum.wrapping_add(bias), factor, self.to.zero_point)
    }

    pub(crate) fn bytes(&self) -> u64 {
        4 * (self.bias.len() + self.factors.len()) as u64
    }
}

/// A type of outputs that a sum can be converted to.
pub(crate) trait SumOutput: TensorNumber {
    fn from_sum(sum: i32, factor: f32, zero: i32) -> Self;
}

macro_rules! byte_of_sum {
    ($number:ident) => {
        impl SumOutput for $number {
            #[allow(clippy::cast_precision_loss, reason = "requantization is in floating point")]
            #[inline(always)]
            fn from_sum(sum: i32, factor: f32, zero: i32) -> Self {
                quantize_steps(sum as f32 * factor, zero)
            }
        }
    };
}
byte_of_sum!(u8);
byte_of_sum!(i8);

impl SumOutput for i32 {
    #[inline(always)]
    fn from_sum(sum: i32, _factor: f32, _zero: i32) -> Self {
        sum
    }
}

impl SumOutput for f32 {
    #[allow(clippy::cast_precision_loss, reason = "the value that the sum stands for")]
    #[inline(always)]
    fn from_sum(sum: i32, factor: f32, _zero: i32) -> Self {
        sum as f32 * factor
    }
}

/// Returns the 8-bit value for a number of quantization steps from the zero point. Halves are
/// rounded to even, and results saturate. NaN becomes 0.
#[inline(always)]
pub(crate) fn quantize_steps<Y: ByteNumber>(steps: f32, zero: i32) -> Y {
    // `FAR` is beyond the reach of any zero point. `WHOLE` lies between 2^23 and 2^24, where
    // floating-point values are integers, so that an addition rounds halves to even on every
    // processor without a function call.
    const FAR: f32 = 1024.0;
    const WHOLE: f32 = 12_582_912.0;
    #[allow(clippy::cast_possible_truncation, reason = "it is an integer of few bits")]
    let steps = ((steps.clamp(-FAR, FAR) + WHOLE) - WHOLE) as i32;
    Y::from_saturated(steps + zero)
}

#[derive(Clone, Debug)]
pub(crate) struct ByteTable {
    from: ElementType,
    /// The encoding of the output, or `None` if it is that of the input.
    to: Option<Encoding>,
    /// The results in the order of the input values, from the lowest.
    values: Vec<i32>,
}

impl ByteTable {
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
            Err(wrong_element_message(self.from, input.element))
        }
    }
}

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
