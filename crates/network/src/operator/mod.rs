// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of a network: the form and encoding of their outputs, their computation, and the
//! spread of changes through them.

mod activation;
mod arithmetic;
mod blocks;
mod concat;
mod conv;
mod fixed;
mod geometry;
mod integer_conv;
mod integer_matmul;
mod linear;
mod normalize;
mod pick;
mod places;
mod pool;
mod product;
mod quantize;
mod quantized;
mod reduce;
mod reduced;
mod reshape;
mod resize;
mod scale;
mod select;
mod softmax;
mod strided;
mod sums;
mod table;
mod transposed;

pub(crate) use activation::{Activation, Pointwise};
pub(crate) use arithmetic::{Arithmetic, Binary, broadcast};
pub(crate) use blocks::{DepthToSpace, Order, SpaceToDepth};
pub(crate) use concat::Concat;
pub(crate) use conv::Conv;
pub(crate) use fixed::Fixed;
pub(crate) use geometry::Geometry;
pub(crate) use integer_conv::{IntegerConv, Rows};
pub(crate) use integer_matmul::IntegerMatMul;
pub(crate) use linear::Linear;
pub(crate) use normalize::{LocalResponse, Normalize, Over};
pub(crate) use pick::{Pick, Picked};
pub(crate) use pool::{Pool, PoolKind};
pub(crate) use product::Product;
pub(crate) use quantize::{Dequantize, Quantize, Scales};
pub(crate) use quantized::{QuantizedBinary, QuantizedConcat, QuantizedMean, QuantizedPool};
pub(crate) use reduce::{ArgMax, Reduce, Reduction};
pub(crate) use reduced::Reduced;
pub(crate) use reshape::{Placed, Reshape};
pub(crate) use resize::{Coordinates, Nearest, Resize, ResizeKind, Size};
pub(crate) use scale::Scale;
pub(crate) use select::{Compare, Comparison, Select};
pub(crate) use softmax::{QuantizedSoftmax, Softmax};
pub(crate) use strided::{Expand, Transpose};
pub(crate) use sums::Sums;
pub(crate) use table::Table;
pub(crate) use transposed::{Reach, TransposedConv};

use crate::element::{Element, Encoding};
use crate::form::Form;
use crate::mask::{Mask, Window};
use crate::tensor::Tensor;
use crate::threads;
use crate::values::{Number, Values};
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// The sums of products of an operator, as accelerators map them onto their arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Products {
    /// The operator has no sums of products: pooling, activation, addition and the like.
    None,
    /// The operator computes nothing, because its output has the values of its input in another
    /// shape, or is constant.
    Renamed,
    /// The operator is a convolution over rows and columns.
    Convolution {
        /// The windows along the rows.
        rows: Window,
        /// The windows along the columns.
        columns: Window,
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
    fn form(&self, inputs: &[&Form]) -> Result<Form, String>;

    /// Returns the encoding of the output for inputs of these encodings. By default an operator
    /// takes and makes floating-point values.
    ///
    /// # Errors
    /// Fails, with a message, if the operator does not take such values.
    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != Element::F32) {
            None => Ok(Encoding::FLOAT),
            Some(input) => Err(wanted(Element::F32, input.element)),
        }
    }

    /// Returns the positions of the output that depend on a changed position of an input. By
    /// default an output depends on the inputs of its window, or on the input at its own position
    /// if the operator has no windows.
    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        match self.windows() {
            Some([rows, columns]) => {
                inputs[0].1.through(rows, columns, output.height(), output.width())
            }
            None => same_position(inputs, output),
        }
    }

    /// Computes the output at least at the positions of the job. At other positions it may write
    /// only the values that a complete computation would write there.
    fn compute(&self, job: Job<'_>);

    /// Returns the kind of sums of products that the operator computes.
    fn products(&self) -> Products {
        Products::None
    }

    /// Returns the windows, along rows and columns, through which outputs see the only input. An
    /// operator without windows sees the input at the position of the output, or all inputs.
    fn windows(&self) -> Option<[Window; 2]> {
        match self.products() {
            Products::Convolution { rows, columns, .. } => Some([rows, columns]),
            _ => None,
        }
    }

    /// Returns the positions of an input that the outputs at the positions `at` see.
    fn seen(&self, at: &Mask, input: &Form) -> Mask {
        let (height, width) = (input.height(), input.width());
        match self.windows() {
            Some([rows, columns]) => at.seen(rows, columns, height, width),
            None if (at.height(), at.width()) == (height, width) => at.clone(),
            None => at.under(height, width),
        }
    }

    /// Returns the number of positions that are computed if those of a mask are needed.
    fn scheduled(&self, at: &Mask) -> usize {
        at.count()
    }

    /// Returns the operator with an activation on its outputs, or `None` if it cannot apply one
    /// itself.
    fn finished(&self, _activation: Activation) -> Option<Arc<dyn Operator>> {
        None
    }

    /// Returns true if the inputs must be features with rows and columns.
    fn takes_features(&self) -> bool {
        self.windows().is_some()
    }

    /// The bytes of the weights.
    fn weight_bytes(&self) -> u64 {
        0
    }
}

/// The work of an operator for one frame.
pub(crate) struct Job<'a> {
    pub(crate) inputs: &'a [&'a Tensor],
    /// The form of the output.
    pub(crate) form: &'a Form,
    /// The values of the output; there are at least as many as the form has elements.
    pub(crate) output: &'a mut Values,
    pub(crate) at: &'a Mask,
}

impl Job<'_> {
    /// Calls `fill` for every run of positions of the mask, with the memory range of the run in the
    /// output and with the values there. A run may go on in the next row. Threads share the outer
    /// indices, such as channels.
    fn fill<T: Number>(self, fill: impl Fn(Range<usize>, &mut [T]) + Sync) {
        self.fill_any(&fill);
    }

    /// Calls `fill` as [`Job::fill`] does, but is compiled once for each type of values.
    fn fill_any<T: Number>(self, fill: &(dyn Fn(Range<usize>, &mut [T]) + Sync)) {
        let Self { form, output, at, .. } = self;
        let output = values_of(output, form);
        let (inner, ranges) = (form.inner(), at.ranges());
        let length = form.places() * inner;
        threads::each_chunk(output, length, &|outer, plane| {
            for range in &ranges {
                let run = range.start * inner..range.end * inner;
                let start = outer * length;
                fill(start + run.start..start + run.end, &mut plane[run]);
            }
        });
    }
}

/// Returns the values of an output.
pub(crate) fn values_of<'a, T: Number>(output: &'a mut Values, form: &Form) -> &'a mut [T] {
    &mut T::of_mut(output)[..form.elements()]
}

/// Returns the encoding of the output of an operator that only moves values.
pub(crate) fn moved(inputs: &[Encoding]) -> Result<Encoding, String> {
    let first = *inputs.first().ok_or("it has no inputs")?;
    if let Some(other) = inputs.iter().find(|input| input.element != first.element) {
        return Err(wanted(first.element, other.element));
    }
    let alike = inputs.iter().all(|input| *input == first);
    Ok(if alike { first } else { Encoding::plain(first.element) })
}

/// Returns `to`, the encoding of the output of an operator on 8-bit values, and fails if an input
/// has other values.
pub(crate) fn of_bytes(inputs: &[Encoding], to: Encoding) -> Result<Encoding, String> {
    match inputs.iter().find(|input| !input.element.is_byte()) {
        None => Ok(to),
        Some(input) => Err(format!(
            "it takes 8-bit integers, but its input holds {}",
            input.element.describe()
        )),
    }
}

/// Returns the message for an input with values of another type than the operator takes.
pub(crate) fn wanted(wanted: Element, found: Element) -> String {
    format!("it takes {}, but its input holds {}", wanted.describe(), found.describe())
}

/// Returns the union of all masks. An input whose positions differ from those of the output changes
/// all of the output.
pub(crate) fn same_position(inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
    let mut seen = Mask::empty(output.height(), output.width());
    for (form, mask) in inputs {
        if (form.height(), form.width()) == (output.height(), output.width()) {
            seen.union(mask);
        } else if !mask.is_empty() {
            seen.fill();
        }
    }
    seen
}

/// Returns all positions if any input has changed, and none otherwise.
pub(crate) fn everything(inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
    let mut seen = Mask::empty(output.height(), output.width());
    if inputs.iter().any(|(_, mask)| !mask.is_empty()) {
        seen.fill();
    }
    seen
}

/// Returns the form of the only input.
pub(crate) fn only<'a>(inputs: &[&'a Form]) -> Result<&'a Form, String> {
    match inputs {
        [input] => Ok(input),
        _ => Err(format!("it takes one tensor that is not constant, but has {}", inputs.len())),
    }
}

/// Returns the channels, rows and columns of features.
pub(crate) fn features(form: &Form) -> Result<[usize; 3], String> {
    match *form.shape() {
        [1, channels, height, width] if form.axes() == (2..4) => Ok([channels, height, width]),
        _ => Err(format!(
            "its input must be features [1, channels, height, width], not {}",
            form.describe()
        )),
    }
}
