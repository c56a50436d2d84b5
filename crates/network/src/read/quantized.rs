// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of quantized networks: those of ONNX, and those of onnxruntime (`com.microsoft`).

use super::constant::Constant;
use super::constant_values::ConstantValues;
use super::made::{Made, one};
use super::node::{Known, NodeReader};
use super::normal::shares;
use super::scales::{bytes, row_major};
use super::sums::pool;
use crate::element::{Element, Encoding};
use crate::form::Form;
use crate::onnx::data_type;
use crate::operator::{
    Activation, Arithmetic, Binary, Concat, Dequantize, IntegerConv, IntegerMatMul, PoolKind,
    Quantize, QuantizedBinary, QuantizedConcat, QuantizedMean, QuantizedPool, QuantizedSoftmax,
    Sums, Table,
};
use crate::tensor::Tensor;
use foveate_lanes::Level;

type Result<T> = std::result::Result<T, String>;

pub(super) fn quantize(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let (scales, to) = node.quantization()?;
    one(Quantize { scales, to }, vec![node.value(0)?])
}

pub(super) fn dequantize(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let value = node.value(0)?;
    let element = (node.forms)(value).encoding().element;
    if element == Element::F32 {
        return Err("it takes integers, but its input holds floating-point values".to_owned());
    }
    one(Dequantize(node.dequantization(element)?), vec![value])
}

/// Returns the floating-point values that constant integers stand for.
pub(super) fn dequantized(node: &NodeReader<'_>, constant: &Constant) -> Result<Constant> {
    let element = constant.element().filter(|&element| element != Element::F32);
    let scales = node.dequantization(element.ok_or("it takes integers of 8 or 32 bits")?)?;
    let form = Form::whole(constant.shape.clone());
    scales.check(&form)?;
    #[allow(clippy::cast_precision_loss, reason = "as the operator says")]
    let real = |(place, &value): (usize, &i64)| {
        let (scale, zero) = scales.of(&form, place);
        (value as f32 - zero) * scale
    };
    let values = constant.as_integers()?.iter().enumerate().map(real).collect();
    Ok(Constant::floats(constant.shape.clone(), values))
}

/// Quantizes constant floating-point values to integers.
pub(super) fn quantized(node: &NodeReader<'_>, constant: &Constant) -> Result<Constant> {
    let (scales, to) = node.quantization()?;
    let form = Form::whole(constant.shape.clone());
    scales.check(&form)?;
    let (lowest, highest) = to.range();
    #[allow(clippy::cast_possible_truncation, reason = "as the operator says")]
    let stored = |(place, &value): (usize, &f32)| {
        let (scale, zero) = scales.of(&form, place);
        ((value / scale).round_ties_even() as i64)
            .saturating_add(zero as i64)
            .clamp(lowest.into(), highest.into())
    };
    let values = constant.as_floats()?.iter().enumerate().map(stored).collect();
    Ok(Constant {
        shape: constant.shape.clone(),
        values: ConstantValues::Integers(values),
        kind: stored_as(to),
    })
}

/// Returns the ONNX type of 8-bit integers.
fn stored_as(element: Element) -> i32 {
    if element == Element::I8 { data_type::INT8 } else { data_type::UINT8 }
}

/// Reads `QLinearConv`.
pub(super) fn conv(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let value = node.value(0)?;
    let weights = node.wanted(3, "w")?;
    let geometry = node.geometry(&weights.shape, value)?;
    let from = node.encoding(1, "x", element(node, value)?)?;
    let rows = bytes(node, weights, 5, geometry.channels)?;
    let factors = node.factors([from.scale, 1.0], (4, "w_scale"), geometry.channels)?;
    let to = node.encoding_out(6, "y")?;
    let sums = Sums { bias: node.bias(8)?, factors: over(factors, to.scale), to };
    one(IntegerConv::new(geometry, rows, from.zero, sums, Level::detect())?, vec![value])
}

/// Reads `ConvInteger`.
pub(super) fn conv_integer(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let value = node.value(0)?;
    let weights = node.wanted(1, "w")?;
    let geometry = node.geometry(&weights.shape, value)?;
    let zero = node.zero(2, "x_zero_point", element(node, value)?)?;
    let rows = bytes(node, weights, 3, geometry.channels)?;
    one(IntegerConv::new(geometry, rows, zero, Sums::kept(), Level::detect())?, vec![value])
}

/// Reads `MatMulInteger`.
pub(super) fn matmul_integer(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let zero = node.zero(2, "a_zero_point", element(node, node.value(0)?)?)?;
    product(node, (1, 3), false, zero, |_| Ok(Sums::kept()))
}

/// Reads `QLinearMatMul`.
pub(super) fn matmul(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let from = node.encoding(1, "a", element(node, node.value(0)?)?)?;
    product(node, (3, 5), false, from.zero, |outputs| {
        let factors = node.factors([from.scale, 1.0], (4, "b_scale"), outputs)?;
        let to = node.encoding_out(6, "y")?;
        Ok(Sums { bias: Vec::new(), factors: over(factors, to.scale), to })
    })
}

/// Reads `QGemm`, whose output is of floating-point values if it has no scale.
pub(super) fn gemm(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    if node.int("transA", 0) != 0 {
        return Err("transA is not supported".to_owned());
    }
    let from = node.encoding(1, "a", element(node, node.value(0)?)?)?;
    let (alpha, transposed) = (node.float("alpha", 1.0), node.int("transB", 0) != 0);
    product(node, (3, 5), transposed, from.zero, |outputs| {
        let factors = node.factors([from.scale, alpha], (4, "b_scale"), outputs)?;
        let (to, factors) = if node.input(7).is_some() {
            let to = node.encoding_out(7, "y")?;
            (to, over(factors, to.scale))
        } else {
            (Encoding::FLOAT, factors)
        };
        let bias = match node.bias(6)?.as_slice() {
            &[one] => vec![one; outputs],
            bias if bias.is_empty() || bias.len() == outputs => bias.to_vec(),
            bias => return Err(format!("its C has {} values, not {outputs}", bias.len())),
        };
        Ok(Sums { bias, factors, to })
    })
}

/// Reads the product with the matrix at one input, whose zero points are at another input.
fn product(
    node: &NodeReader<'_>,
    (matrix, zeros): (usize, usize),
    transposed: bool,
    zero: i32,
    sums: impl FnOnce(usize) -> Result<Sums>,
) -> Result<Vec<Made>> {
    let matrix = node.wanted(matrix, "matrix")?;
    let (matrix, outputs, inputs) = row_major(matrix, transposed)?;
    let rows = bytes(node, &matrix, zeros, outputs)?;
    let sums = sums(outputs)?;
    one(IntegerMatMul { rows, inputs, zero, sums }, vec![node.value(0)?])
}

/// Reads `QLinearAdd` and `QLinearMul`.
pub(super) fn binary(node: &NodeReader<'_>, kind: Arithmetic) -> Result<Vec<Made>> {
    let to = node.encoding_out(6, "C")?;
    let from = [node.encoding(1, "A", to.element)?, node.encoding(4, "B", to.element)?];
    let (constant, inputs) = match (node.input(0), node.input(3)) {
        (Some(&Known::Value(a)), Some(&Known::Value(b))) => (None, vec![a, b]),
        (Some(Known::Constant(a)), Some(&Known::Value(b))) => {
            (Some((stored(a, to.element)?, true)), vec![b])
        }
        (Some(&Known::Value(a)), Some(Known::Constant(b))) => {
            (Some((stored(b, to.element)?, false)), vec![a])
        }
        _ => return Err("it takes two tensors, not both constant".to_owned()),
    };
    let binary = Binary { kind, constant, finish: Activation::Identity };
    one(QuantizedBinary { binary, from, to }, inputs)
}

/// Returns a constant tensor of 8-bit values.
fn stored(constant: &Constant, element: Element) -> Result<Tensor> {
    let form = Form::whole(constant.shape.clone()).encoded(Encoding::plain(element));
    if constant.element() != Some(element) {
        return Err(format!("its constant must be of {}", element.describe()));
    }
    Tensor::of_integers(form, constant.as_integers()?)
}

/// Reads `QLinearAveragePool`.
pub(super) fn average_pool(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    channels_first(node)?;
    let value = node.value(0)?;
    let (from, to) = through(node, value)?;
    let with_padding = node.int("count_include_pad", 0) != 0;
    let pool = pool(node, PoolKind::Average { with_padding })?;
    one(QuantizedPool { pool, with_padding, from, to }, vec![value])
}

/// Reads `QLinearGlobalAveragePool`.
pub(super) fn mean(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    channels_first(node)?;
    let value = node.value(0)?;
    let (from, to) = through(node, value)?;
    one(QuantizedMean { from, to }, vec![value])
}

/// Reads `QLinearLeakyRelu` and `QLinearSigmoid`.
pub(super) fn activation(node: &NodeReader<'_>, activation: Activation) -> Result<Vec<Made>> {
    let value = node.value(0)?;
    let (from, to) = through(node, value)?;
    one(Table::of_reals(from, to, activation), vec![value])
}

/// Reads `QLinearSoftmax`, which gives its version as an attribute.
pub(super) fn softmax(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let value = node.value(0)?;
    let (from, to) = through(node, value)?;
    let softmax = shares(node, value, node.int("opset", 13), false)?;
    one(QuantizedSoftmax { softmax, from, to }, vec![value])
}

/// Reads `QLinearConcat`.
pub(super) fn concat(node: &NodeReader<'_>) -> Result<Vec<Made>> {
    let to = node.encoding_out(0, "Y")?;
    let (mut inputs, mut tables) = (Vec::new(), Vec::new());
    for at in (2..node.node.input.len()).step_by(3) {
        let value = node.value(at)?;
        let from = node.encoding(at + 1, &format!("input {at}"), to.element)?;
        tables.push(Table::of_reals(from, to, Activation::Identity));
        inputs.push(value);
    }
    one(QuantizedConcat { concat: Concat { axis: node.int("axis", 1) }, tables, to }, inputs)
}

/// Returns the encodings of the input and the output of an operator that keeps the type of 8-bit
/// values.
fn through(node: &NodeReader<'_>, value: usize) -> Result<(Encoding, Encoding)> {
    let element = element(node, value)?;
    Ok((node.encoding(1, "X", element)?, node.encoding(3, "Y", element)?))
}

fn channels_first(node: &NodeReader<'_>) -> Result<()> {
    match node.int("channels_last", 0) {
        0 => Ok(()),
        _ => Err("channels_last is not supported".to_owned()),
    }
}

/// Returns the type of an input, and fails if it does not have 8 bits.
fn element(node: &NodeReader<'_>, value: usize) -> Result<Element> {
    let element = (node.forms)(value).encoding().element;
    if element.is_byte() {
        Ok(element)
    } else {
        Err(format!("it takes 8-bit integers, but its input holds {}", element.describe()))
    }
}

/// Divides the factors by the scale of an output.
fn over(factors: Vec<f32>, scale: f32) -> Vec<f32> {
    factors.into_iter().map(|factor| factor / scale).collect()
}
