// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that sum or reduce over windows, channels or axes, also to normalize, as
//! softmax does.

use super::constant::Constant;
use super::node::{
    GraphValue, NodeOutput, NodeReader, Operand, checked_length, index_from_start,
    output_of_operands, output_of_tensors,
};
use super::pointwise_operators;
use super::reshaping::axes_of_node;
use crate::operator::{
    ArgMax, Conv, Linear, LocalResponseNorm, MatrixProduct, MeanGroup, Normalization, Pool,
    PoolKind, ReducedAxes, ReductionKind, ReductionOperator, Softmax,
};
use foveate_pixels::vectors::InstructionSet;

pub(super) fn conv(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let weights = node.required_constant(1, "weights")?;
    let geometry = node.conv_geometry(&weights.shape, value)?;
    let bias = node.constant(2, "bias")?.map(Constant::as_floats).transpose()?;
    output_of_tensors(
        Conv::new(geometry, weights.as_weights()?, bias, InstructionSet::detect())?,
        vec![value],
    )
}

pub(super) fn pool(node: &NodeReader<'_>, kind: PoolKind) -> Result<Pool, String> {
    if node.node.output.len() > 1 {
        return Err("its indices, a second output, are not supported".to_owned());
    }
    let value = node.tensor_input(0)?;
    let [rows, columns] =
        node.axis_windows(node.kernel_shape()?.ok_or("it has no kernel_shape")?, value)?;
    Ok(Pool { kind, rows, columns, rounds_up: node.int("ceil_mode", 0) != 0 })
}

pub(super) fn global_pool(
    node: &NodeReader<'_>,
    kind: ReductionKind,
) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let axes = (2..(node.forms)(value).shape().len()).collect();
    output_of_tensors(
        ReductionOperator { kind, reduced_axes: ReducedAxes { axes, keeps_axes: true } },
        vec![value],
    )
}

pub(super) fn reduce(
    node: &NodeReader<'_>,
    kind: ReductionKind,
) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let count = (node.forms)(value).shape().len();
    let keep = node.int("keepdims", 1) != 0;
    let named = axes_of_node(node, count)?.filter(|axes| !axes.is_empty());
    if named.is_none() && node.int("noop_with_empty_axes", 0) != 0 {
        return pointwise_operators::identity(node);
    }
    let mut axes = named.unwrap_or_else(|| (0..count).collect());
    axes.sort_unstable();
    output_of_tensors(
        ReductionOperator { kind, reduced_axes: ReducedAxes { axes, keeps_axes: keep } },
        vec![value],
    )
}

pub(super) fn arg_max(node: &NodeReader<'_>, is_lowest: bool) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let axis = (node.forms)(value).resolve_axis(node.int("axis", 0))?;
    let over = ReducedAxes { axes: vec![axis], keeps_axes: node.int("keepdims", 1) != 0 };
    let is_last = node.int("select_last_index", 0) != 0;
    output_of_tensors(
        ArgMax { reduced_axes: over, takes_lowest: is_lowest, takes_last: is_last },
        vec![value],
    )
}

pub(super) fn gemm(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    if node.int("transA", 0) != 0 {
        return Err("transA is not supported".to_owned());
    }
    let weights = node.required_constant(1, "matrix")?;
    let bias = node.constant(2, "bias")?.map(Constant::as_floats).transpose()?;
    let transposed = node.int("transB", 0) != 0;
    let (alpha, beta) = (node.float("alpha", 1.0), node.float("beta", 1.0));
    output_of_tensors(
        Linear::new(&weights.shape, weights.as_weights()?, bias, transposed, alpha, beta)?,
        vec![node.tensor_input(0)?],
    )
}

pub(super) fn matmul(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    match (node.input(0), node.input(1)) {
        (Some(&GraphValue::Tensor(value)), Some(GraphValue::Constant(matrix)))
            if matrix.shape.len() == 2 =>
        {
            output_of_tensors(
                Linear::from_matrix(&matrix.shape, matrix.as_weights()?)?,
                vec![value],
            )
        }
        (Some(GraphValue::Constant(_)), Some(GraphValue::Constant(_))) => {
            Err("a product of two constants is not supported".to_owned())
        }
        _ => {
            let operands = vec![node.operand(0)?, node.operand(1)?];
            let inner = match &operands[0] {
                Operand::Tensor(value) => (node.forms)(*value).shape().last().copied(),
                Operand::Constant(tensor) => tensor.form().shape().last().copied(),
            };
            output_of_operands(
                MatrixProduct { level: InstructionSet::detect(), depth: inner.unwrap_or(1) },
                operands,
            )
        }
    }
}

/// Returns the scale and the bias, which are the inputs 1 and 2.
fn scale_and_bias(node: &NodeReader<'_>) -> Result<[Vec<f32>; 2], String> {
    let scale = node.required_constant(1, "scale")?.as_weights()?.to_vec();
    let bias = node.constant(2, "bias")?.map(Constant::as_weights).transpose()?;
    Ok([scale, bias.unwrap_or_default().to_vec()])
}

pub(super) fn layer_normalization(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let axis = (node.forms)(value).resolve_axis(node.int("axis", -1))?;
    let [scale, bias] = scale_and_bias(node)?;
    let epsilon = node.float("epsilon", 1e-5);
    output_of_tensors(
        Normalization { mean_group: MeanGroup::Axes(axis), epsilon, scale, bias },
        vec![value],
    )
}

pub(super) fn instance_normalization(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let [scale, bias] = scale_and_bias(node)?;
    let epsilon = node.float("epsilon", 1e-5);
    let over = MeanGroup::Groups(scale.len());
    output_of_tensors(
        Normalization { mean_group: over, epsilon, scale, bias },
        vec![node.tensor_input(0)?],
    )
}

pub(super) fn group_normalization(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let [scale, bias] = scale_and_bias(node)?;
    let over = MeanGroup::Groups(checked_length("num_groups", node.int("num_groups", 0))?);
    let epsilon = node.float("epsilon", 1e-5);
    output_of_tensors(
        Normalization { mean_group: over, epsilon, scale, bias },
        vec![node.tensor_input(0)?],
    )
}

#[allow(clippy::cast_precision_loss, reason = "channels are below 65536")]
pub(super) fn local_response_norm(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let size = checked_length("size", node.int("size", 0))?;
    let response = LocalResponseNorm {
        neighbor_channels: [(size - 1) / 2, size / 2],
        alpha: node.float("alpha", 1e-4) / size as f32,
        beta: node.float("beta", 0.75),
        bias: node.float("bias", 1.0),
    };
    output_of_tensors(response, vec![node.tensor_input(0)?])
}

pub(super) fn softmax(
    node: &NodeReader<'_>,
    is_logarithm: bool,
) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    output_of_tensors(softmax_operator(node, value, node.opset, is_logarithm)?, vec![value])
}

/// Reads the attributes of a softmax, whose meaning depends on the version of the operators.
pub(super) fn softmax_operator(
    node: &NodeReader<'_>,
    value: usize,
    opset: i64,
    is_logarithm: bool,
) -> Result<Softmax, String> {
    let is_to_end = opset < 13;
    let axis = node.int("axis", if is_to_end { 1 } else { -1 });
    // If the axis is behind the last one, each value is the only one of its sum. The default of 1
    // is such an axis for a tensor of one axis.
    let count = (node.forms)(value).shape().len();
    if is_to_end && usize::try_from(index_from_start(axis, count)) == Ok(count) {
        return Err(format!(
            "its axis {axis} is behind the last one, so that every output is constant"
        ));
    }
    Ok(Softmax { axis, spans_following_axes: is_to_end, is_logarithm })
}
