// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that normalize, including softmax.

use super::constant::Constant;
use super::node::{NodeReader, checked_length, index_from_start};
use super::node_output::{NodeOutput, output_of_tensors};
use crate::operator::{LocalResponseNorm, MeanGroup, Normalization, Softmax};

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
