// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of quantized networks: those of ONNX, and those of onnxruntime (`com.microsoft`).

use super::constant::Constant;
use super::constant_values::ConstantValues;
use super::node::{GraphValue, NodeOutput, NodeReader, output_of_tensors};
use super::reductions::{pool, softmax_operator};
use super::scales::{byte_weight_rows, row_major_matrix};
use crate::activation::Activation;
use crate::element::{ElementType, Encoding};
use crate::onnx::data_type;
use crate::operator::{
    ArithmeticKind, BinaryOperator, ByteTable, Concat, Dequantize, IntegerConv, IntegerMatMul,
    PoolKind, Quantize, QuantizedBinary, QuantizedConcat, QuantizedMean, QuantizedPool,
    QuantizedSoftmax, Requantization,
};
use crate::tensor::{Tensor, TensorForm};
use foveate_pixels::vectors::InstructionSet;

type QuantizedResult<T> = Result<T, String>;

pub(super) fn quantize(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let (scales, to) = node.quantization()?;
    output_of_tensors(Quantize { scales, to }, vec![node.tensor_input(0)?])
}

pub(super) fn dequantize(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let value = node.tensor_input(0)?;
    let element = (node.forms)(value).encoding().element;
    if element == ElementType::F32 {
        return Err("it takes integers, but its input holds floating-point values".to_owned());
    }
    output_of_tensors(Dequantize(node.dequantization(element)?), vec![value])
}

/// Returns the floating-point values that constant integers stand for.
pub(super) fn dequantize_constant(
    node: &NodeReader<'_>,
    constant: &Constant,
) -> QuantizedResult<Constant> {
    let element = constant.element().filter(|&element| element != ElementType::F32);
    let scales = node.dequantization(element.ok_or("it takes integers of 8 or 32 bits")?)?;
    let form = TensorForm::without_positions(constant.shape.clone());
    scales.check(&form)?;
    #[allow(clippy::cast_precision_loss, reason = "as the operator says")]
    let dequantized = |(place, &value): (usize, &i64)| {
        let (scale, zero) = scales.scale_and_zero_point(&form, place);
        (value as f32 - zero) * scale
    };
    let values = constant.as_integers()?.iter().enumerate().map(dequantized).collect();
    Ok(Constant::floats(constant.shape.clone(), values))
}

/// Quantizes constant floating-point values to integers.
pub(super) fn quantize_constant(
    node: &NodeReader<'_>,
    constant: &Constant,
) -> QuantizedResult<Constant> {
    let (scales, to) = node.quantization()?;
    let form = TensorForm::without_positions(constant.shape.clone());
    scales.check(&form)?;
    let (lowest, highest) = to.range();
    #[allow(clippy::cast_possible_truncation, reason = "as the operator says")]
    let quantized = |(place, &value): (usize, &f32)| {
        let (scale, zero) = scales.scale_and_zero_point(&form, place);
        ((value / scale).round_ties_even() as i64)
            .saturating_add(zero as i64)
            .clamp(lowest.into(), highest.into())
    };
    let values = constant.as_floats()?.iter().enumerate().map(quantized).collect();
    Ok(Constant {
        shape: constant.shape.clone(),
        values: ConstantValues::Integers(values),
        data_type: data_type_of_bytes(to),
    })
}

/// Returns the ONNX type of 8-bit integers.
fn data_type_of_bytes(element: ElementType) -> i32 {
    if element == ElementType::I8 { data_type::INT8 } else { data_type::UINT8 }
}

/// Reads `QLinearConv`.
pub(super) fn conv(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let value = node.tensor_input(0)?;
    let weights = node.required_constant(3, "w")?;
    let geometry = node.conv_geometry(&weights.shape, value)?;
    let from = node.encoding(1, "x", byte_element(node, value)?)?;
    let rows = byte_weight_rows(node, weights, 5, geometry.output_channels)?;
    let factors = node.factors([from.scale, 1.0], (4, "w_scale"), geometry.output_channels)?;
    let to = node.output_encoding(6, "y")?;
    let sums = Requantization { bias: node.bias(8)?, factors: divided_by(factors, to.scale), to };
    output_of_tensors(
        IntegerConv::new(geometry, rows, from.zero_point, sums, InstructionSet::detect())?,
        vec![value],
    )
}

/// Reads `ConvInteger`.
pub(super) fn conv_integer(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let value = node.tensor_input(0)?;
    let weights = node.required_constant(1, "w")?;
    let geometry = node.conv_geometry(&weights.shape, value)?;
    let zero = node.zero_point(2, "x_zero_point", byte_element(node, value)?)?;
    let rows = byte_weight_rows(node, weights, 3, geometry.output_channels)?;
    output_of_tensors(
        IntegerConv::new(geometry, rows, zero, Requantization::none(), InstructionSet::detect())?,
        vec![value],
    )
}

/// Reads `MatMulInteger`.
pub(super) fn matmul_integer(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let zero = node.zero_point(2, "a_zero_point", byte_element(node, node.tensor_input(0)?)?)?;
    matrix_product(node, (1, 3), false, zero, |_| Ok(Requantization::none()))
}

/// Reads `QLinearMatMul`.
pub(super) fn matmul(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let from = node.encoding(1, "a", byte_element(node, node.tensor_input(0)?)?)?;
    matrix_product(node, (3, 5), false, from.zero_point, |outputs| {
        let factors = node.factors([from.scale, 1.0], (4, "b_scale"), outputs)?;
        let to = node.output_encoding(6, "y")?;
        Ok(Requantization { bias: Vec::new(), factors: divided_by(factors, to.scale), to })
    })
}

/// Reads `QGemm`, whose output is of floating-point values if it has no scale.
pub(super) fn gemm(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    if node.int("transA", 0) != 0 {
        return Err("transA is not supported".to_owned());
    }
    let from = node.encoding(1, "a", byte_element(node, node.tensor_input(0)?)?)?;
    let (alpha, transposed) = (node.float("alpha", 1.0), node.int("transB", 0) != 0);
    matrix_product(node, (3, 5), transposed, from.zero_point, |outputs| {
        let factors = node.factors([from.scale, alpha], (4, "b_scale"), outputs)?;
        let (to, factors) = if node.input(7).is_some() {
            let to = node.output_encoding(7, "y")?;
            (to, divided_by(factors, to.scale))
        } else {
            (Encoding::FLOAT, factors)
        };
        let bias = match node.bias(6)?.as_slice() {
            &[one] => vec![one; outputs],
            bias if bias.is_empty() || bias.len() == outputs => bias.to_vec(),
            bias => return Err(format!("its C has {} values, not {outputs}", bias.len())),
        };
        Ok(Requantization { bias, factors, to })
    })
}

/// Reads the product with the matrix at one input, whose zero points are at another input.
fn matrix_product(
    node: &NodeReader<'_>,
    (matrix, zeros): (usize, usize),
    transposed: bool,
    zero: i32,
    sums: impl FnOnce(usize) -> QuantizedResult<Requantization>,
) -> QuantizedResult<Vec<NodeOutput>> {
    let matrix = node.required_constant(matrix, "matrix")?;
    let (matrix, outputs, inputs) = row_major_matrix(matrix, transposed)?;
    let rows = byte_weight_rows(node, &matrix, zeros, outputs)?;
    let sums = sums(outputs)?;
    output_of_tensors(
        IntegerMatMul { rows, inputs, zero_point: zero, sums },
        vec![node.tensor_input(0)?],
    )
}

/// Reads `QLinearAdd` and `QLinearMul`.
pub(super) fn binary(
    node: &NodeReader<'_>,
    kind: ArithmeticKind,
) -> QuantizedResult<Vec<NodeOutput>> {
    let to = node.output_encoding(6, "C")?;
    let from = [node.encoding(1, "A", to.element)?, node.encoding(4, "B", to.element)?];
    let (constant, inputs) = match (node.input(0), node.input(3)) {
        (Some(&GraphValue::Tensor(a)), Some(&GraphValue::Tensor(b))) => (None, vec![a, b]),
        (Some(GraphValue::Constant(a)), Some(&GraphValue::Tensor(b))) => {
            (Some((byte_tensor(a, to.element)?, true)), vec![b])
        }
        (Some(&GraphValue::Tensor(a)), Some(GraphValue::Constant(b))) => {
            (Some((byte_tensor(b, to.element)?, false)), vec![a])
        }
        _ => return Err("it takes two tensors, of which at most one is constant".to_owned()),
    };
    let binary = BinaryOperator { kind, constant, activation: Activation::Identity };
    output_of_tensors(QuantizedBinary { operator: binary, from, to }, inputs)
}

/// Returns a constant tensor of 8-bit values.
fn byte_tensor(constant: &Constant, element: ElementType) -> QuantizedResult<Tensor> {
    let form = TensorForm::without_positions(constant.shape.clone())
        .with_encoding(Encoding::plain(element));
    if constant.element() != Some(element) {
        return Err(format!("its constant must have {}", element.describe()));
    }
    Tensor::from_integers(form, constant.as_integers()?)
}

/// Reads `QLinearAveragePool`.
pub(super) fn average_pool(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    check_channels_first(node)?;
    let value = node.tensor_input(0)?;
    let (from, to) = input_and_output_encoding(node, value)?;
    let with_padding = node.int("count_include_pad", 0) != 0;
    let pool = pool(node, PoolKind::Average { with_padding })?;
    output_of_tensors(QuantizedPool { pool, with_padding, from, to }, vec![value])
}

/// Reads `QLinearGlobalAveragePool`.
pub(super) fn global_average_pool(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    check_channels_first(node)?;
    let value = node.tensor_input(0)?;
    let (from, to) = input_and_output_encoding(node, value)?;
    output_of_tensors(QuantizedMean { from, to }, vec![value])
}

/// Reads `QLinearLeakyRelu` and `QLinearSigmoid`.
pub(super) fn activation(
    node: &NodeReader<'_>,
    activation: Activation,
) -> QuantizedResult<Vec<NodeOutput>> {
    let value = node.tensor_input(0)?;
    let (from, to) = input_and_output_encoding(node, value)?;
    output_of_tensors(ByteTable::from_activation(from, to, activation), vec![value])
}

/// Reads `QLinearSoftmax`, which gives its version as an attribute.
pub(super) fn softmax(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let value = node.tensor_input(0)?;
    let (from, to) = input_and_output_encoding(node, value)?;
    let softmax = softmax_operator(node, value, node.int("opset", 13), false)?;
    output_of_tensors(QuantizedSoftmax { softmax, from, to }, vec![value])
}

/// Reads `QLinearConcat`.
pub(super) fn concat(node: &NodeReader<'_>) -> QuantizedResult<Vec<NodeOutput>> {
    let to = node.output_encoding(0, "Y")?;
    let (mut inputs, mut tables) = (Vec::new(), Vec::new());
    for at in (2..node.node.input.len()).step_by(3) {
        let value = node.tensor_input(at)?;
        let from = node.encoding(at + 1, &format!("input {at}"), to.element)?;
        tables.push(ByteTable::from_activation(from, to, Activation::Identity));
        inputs.push(value);
    }
    output_of_tensors(
        QuantizedConcat { concat: Concat { axis: node.int("axis", 1) }, tables, to },
        inputs,
    )
}

/// Returns the encodings of the input and the output of an operator that keeps the type of 8-bit
/// values.
fn input_and_output_encoding(
    node: &NodeReader<'_>,
    value: usize,
) -> QuantizedResult<(Encoding, Encoding)> {
    let element = byte_element(node, value)?;
    Ok((node.encoding(1, "X", element)?, node.encoding(3, "Y", element)?))
}

fn check_channels_first(node: &NodeReader<'_>) -> QuantizedResult<()> {
    match node.int("channels_last", 0) {
        0 => Ok(()),
        _ => Err("channels_last is not supported".to_owned()),
    }
}

/// Returns the type of an input, and fails if it does not have 8 bits.
fn byte_element(node: &NodeReader<'_>, value: usize) -> QuantizedResult<ElementType> {
    let element = (node.forms)(value).encoding().element;
    if element.is_byte() {
        Ok(element)
    } else {
        Err(format!("it takes 8-bit integers, but its input holds {}", element.describe()))
    }
}

/// Divides the factors by the scale of an output.
fn divided_by(factors: Vec<f32>, scale: f32) -> Vec<f32> {
    factors.into_iter().map(|factor| factor / scale).collect()
}
