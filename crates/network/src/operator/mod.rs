// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of a network: the form and encoding of their outputs, their computation, and the
//! spread of changes through them.

mod activation_operator;
mod axis_gather;
mod binary_operator;
mod concat;
mod conv;
mod integer_conv;
mod matrix_product;
mod normalization;
mod pool;
mod quantization;
mod quantized_operators;
mod reduction;
mod reshape;
mod resize;
mod selection;
mod softmax;
mod strided_copy;
mod transposed_conv;

pub(crate) use activation_operator::ActivationOperator;
pub(crate) use axis_gather::{AxisGather, AxisSelection};
pub(crate) use binary_operator::{ArithmeticKind, BinaryOperator, broadcast_shape};
pub(crate) use concat::{Concat, DepthToSpace, DepthToSpaceOrder, SpaceToDepth};
pub(crate) use conv::{Conv, ConvGeometry};
pub(crate) use integer_conv::{ByteWeightRows, IntegerConv};
pub(crate) use matrix_product::{IntegerMatMul, Linear, MatrixProduct};
pub(crate) use normalization::{ChannelScale, LocalResponseNorm, MeanGroup, Normalization};
pub(crate) use pool::{Pool, PoolKind};
pub(crate) use quantization::{
    ByteTable, Dequantize, QuantizationScales, Quantize, Requantization,
};
pub(crate) use quantized_operators::{
    QuantizedBinary, QuantizedConcat, QuantizedMean, QuantizedPool,
};
pub(crate) use reduction::{ArgMax, ReducedAxes, ReductionKind, ReductionOperator};
pub(crate) use reshape::{ConstantTensor, FeatureView, Reshape};
pub(crate) use resize::{NearestRounding, Resize, ResizeCoordinates, ResizeKind, ResizeSize};
pub(crate) use selection::{ComparisonKind, ComparisonOperator, WhereOperator};
pub(crate) use softmax::{QuantizedSoftmax, Softmax};
pub(crate) use strided_copy::{Expand, Transpose};
pub(crate) use transposed_conv::{TransposedConv, TransposedWindow};

use super::tensor::TensorForm;
use crate::activation::Activation;
use crate::element::{ElementType, Encoding};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::Tensor;
use crate::threads;
use crate::values::{TensorNumber, TensorValues};
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// The sums of products of an operator, as accelerators map them onto their arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProductKind {
    /// The operator has no sums of products: pooling, activation, addition and the like.
    None,
    /// The operator computes nothing, because its output has the values of its input in another
    /// shape, or is constant.
    NoComputation,
    /// The operator is a convolution over rows and columns.
    Convolution {
        /// The windows along the rows.
        rows: AxisWindow,
        /// The windows along the columns.
        columns: AxisWindow,
        /// The number of groups of channels.
        groups: usize,
    },
    /// The operator is a transposed convolution: every channel of a position is a sum over at most
    /// `inputs` inputs.
    Transposed {
        /// The number of inputs of each sum.
        inputs: usize,
    },
    /// The operator is a matrix product: every output is a sum over `inputs` inputs.
    Matrix {
        /// The number of inputs of each sum.
        inputs: usize,
    },
}

/// An operator with its attributes and weights.
pub(crate) trait Operator: Debug + Send + Sync {
    /// Returns the form of the output for inputs of these forms.
    ///
    /// # Errors
    /// Fails, with a message, if the operator does not take such inputs.
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String>;

    /// Returns the encoding of the output for inputs of these encodings. By default an operator
    /// takes and makes floating-point values.
    ///
    /// # Errors
    /// Fails, with a message, if the operator does not take such values.
    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != ElementType::F32) {
            None => Ok(Encoding::FLOAT),
            Some(input) => Err(wrong_element_message(ElementType::F32, input.element)),
        }
    }

    /// Returns the positions of the output that depend on a changed position of an input. By
    /// default an output depends on the inputs of its window, or on the input at its own position
    /// if the operator has no windows.
    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        match self.axis_windows() {
            Some([rows, columns]) => {
                inputs[0].1.outputs_through(rows, columns, output.height(), output.width())
            }
            None => position_union(inputs, output),
        }
    }

    /// Computes the output at least at the positions of the job. At other positions it may write
    /// only the values that a complete computation would write there.
    fn compute(&self, job: OperatorJob<'_>);

    /// Returns the kind of sums of products that the operator computes.
    fn products(&self) -> ProductKind {
        ProductKind::None
    }

    /// Returns the windows, along rows and columns, through which outputs depend on the only input.
    /// Without windows an output depends on the input at its own position, or on all inputs.
    fn axis_windows(&self) -> Option<[AxisWindow; 2]> {
        match self.products() {
            ProductKind::Convolution { rows, columns, .. } => Some([rows, columns]),
            _ => None,
        }
    }

    /// Returns the positions of an input on which the outputs at the positions `at` depend.
    fn needed_input(&self, at: &Mask, input: &TensorForm) -> Mask {
        let (height, width) = (input.height(), input.width());
        match self.axis_windows() {
            Some([rows, columns]) => at.inputs_through(rows, columns, height, width),
            None if (at.height(), at.width()) == (height, width) => at.clone(),
            None => at.scaled_to(height, width),
        }
    }

    /// Returns the number of positions that are computed if those of a mask are needed.
    fn scheduled_positions(&self, at: &Mask) -> usize {
        at.count()
    }

    /// Returns the operator with an activation on its outputs, or `None` if it cannot apply one
    /// itself.
    fn with_activation(&self, _activation: Activation) -> Option<Arc<dyn Operator>> {
        None
    }

    /// Returns true if the inputs must be features with rows and columns.
    fn takes_features(&self) -> bool {
        self.axis_windows().is_some()
    }

    /// The bytes of the weights.
    fn weight_bytes(&self) -> u64 {
        0
    }
}

/// The work of an operator for one frame.
pub(crate) struct OperatorJob<'a> {
    pub(crate) inputs: &'a [&'a Tensor],
    /// The form of the output.
    pub(crate) form: &'a TensorForm,
    /// The values of the output; there are at least as many as the form has elements.
    pub(crate) output: &'a mut TensorValues,
    pub(crate) positions: &'a Mask,
}

impl OperatorJob<'_> {
    /// Calls `fill` for every run of positions of the mask, with the memory range of the run in the
    /// output and with the values there. A run may go on in the next row. Threads share the outer
    /// indices, such as channels.
    fn fill<T: TensorNumber>(self, fill: impl Fn(Range<usize>, &mut [T]) + Sync) {
        self.fill_dyn(&fill);
    }

    /// Calls `fill` as [`OperatorJob::fill`] does, but is compiled once for each type of values.
    fn fill_dyn<T: TensorNumber>(self, fill: &(dyn Fn(Range<usize>, &mut [T]) + Sync)) {
        let Self { form, output, positions: at, .. } = self;
        let output = output_values(output, form);
        let (inner, ranges) = (form.inner_size(), at.memory_ranges());
        let length = form.position_count() * inner;
        threads::for_each_chunk(output, length, &|outer, plane| {
            for range in &ranges {
                let run = range.start * inner..range.end * inner;
                let start = outer * length;
                fill(start + run.start..start + run.end, &mut plane[run]);
            }
        });
    }
}

pub(crate) fn output_values<'a, T: TensorNumber>(
    output: &'a mut TensorValues,
    form: &TensorForm,
) -> &'a mut [T] {
    &mut T::slice_of_mut(output)[..form.element_count()]
}

/// Returns the encoding of the output of an operator that only moves values.
pub(crate) fn moved_encoding(inputs: &[Encoding]) -> Result<Encoding, String> {
    let first = *inputs.first().ok_or("it has no inputs")?;
    if let Some(other) = inputs.iter().find(|input| input.element != first.element) {
        return Err(wrong_element_message(first.element, other.element));
    }
    let all_equal = inputs.iter().all(|input| *input == first);
    Ok(if all_equal { first } else { Encoding::plain(first.element) })
}

/// Returns `to`, the encoding of the output of an operator on 8-bit values, and fails if an input
/// has other values.
pub(crate) fn encoding_from_bytes(inputs: &[Encoding], to: Encoding) -> Result<Encoding, String> {
    match inputs.iter().find(|input| !input.element.is_byte()) {
        None => Ok(to),
        Some(input) => Err(format!(
            "it takes 8-bit integers, but its input holds {}",
            input.element.describe()
        )),
    }
}

/// Returns the message for an input with values of another type than the operator takes.
pub(crate) fn wrong_element_message(wanted: ElementType, found: ElementType) -> String {
    format!("it takes {}, but its input holds {}", wanted.describe(), found.describe())
}

/// Returns the union of all masks. An input whose positions differ from those of the output changes
/// all of the output.
pub(crate) fn position_union(inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
    let mut positions = Mask::empty(output.height(), output.width());
    for (form, mask) in inputs {
        if (form.height(), form.width()) == (output.height(), output.width()) {
            positions.union(mask);
        } else if !mask.is_empty() {
            positions.fill();
        }
    }
    positions
}

/// Returns all positions if any input has changed, and none otherwise.
pub(crate) fn full_if_changed(inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
    let mut positions = Mask::empty(output.height(), output.width());
    if inputs.iter().any(|(_, mask)| !mask.is_empty()) {
        positions.fill();
    }
    positions
}

/// Returns the form of the only input.
pub(crate) fn only_input<'a>(inputs: &[&'a TensorForm]) -> Result<&'a TensorForm, String> {
    match inputs {
        [input] => Ok(input),
        _ => Err(format!("it takes one tensor that is not constant, but has {}", inputs.len())),
    }
}

/// Returns the channels, rows and columns of features.
pub(crate) fn feature_size(form: &TensorForm) -> Result<[usize; 3], String> {
    match *form.shape() {
        [1, channels, height, width] if form.position_axes() == (2..4) => {
            Ok([channels, height, width])
        }
        _ => Err(format!(
            "its input must be features [1, channels, height, width], not {}",
            form.describe()
        )),
    }
}
