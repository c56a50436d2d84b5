// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that normalize, including softmax.

use super::constant::Constant;
use super::made::{Made, one};
use super::node::{NodeReader, from_start, positive};
use crate::operator::{LocalResponse, Normalize, Over, Softmax};

/// Returns the scale and the bias, which are the inputs 1 and 2.
fn affine(node: &NodeReader<'_>) -> Result<[Vec<f32>; 2], String> {
    let scale = node.wanted(1, "scale")?.as_weights()?.to_vec();
    let bias = node.constant(2, "bias")?.map(Constant::as_weights).transpose()?;
    Ok([scale, bias.unwrap_or_default().to_vec()])
}

pub(super) fn layer(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let axis = (node.forms)(value).axis(node.int("axis", -1))?;
    let [scale, bias] = affine(node)?;
    let epsilon = node.float("epsilon", 1e-5);
    one(Normalize { over: Over::Axes(axis), epsilon, scale, bias }, vec![value])
}

pub(super) fn instance(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let [scale, bias] = affine(node)?;
    let epsilon = node.float("epsilon", 1e-5);
    let over = Over::Groups(scale.len());
    one(Normalize { over, epsilon, scale, bias }, vec![node.value(0)?])
}

pub(super) fn group(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let [scale, bias] = affine(node)?;
    let over = Over::Groups(positive("num_groups", node.int("num_groups", 0))?);
    let epsilon = node.float("epsilon", 1e-5);
    one(Normalize { over, epsilon, scale, bias }, vec![node.value(0)?])
}

#[allow(clippy::cast_precision_loss, reason = "channels are below 65536")]
pub(super) fn local_response(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let size = positive("size", node.int("size", 0))?;
    let response = LocalResponse {
        around: [(size - 1) / 2, size / 2],
        alpha: node.float("alpha", 1e-4) / size as f32,
        beta: node.float("beta", 0.75),
        bias: node.float("bias", 1.0),
    };
    one(response, vec![node.value(0)?])
}

pub(super) fn softmax(node: &NodeReader<'_>, is_logarithm: bool) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    one(shares(node, value, node.opset, is_logarithm)?, vec![value])
}

/// Reads the attributes of a softmax, whose meaning depends on the version of the operators.
pub(super) fn shares(
    node: &NodeReader<'_>,
    value: usize,
    opset: i64,
    is_logarithm: bool,
) -> Result<Softmax, String> {
    let is_to_end = opset < 13;
    let axis = node.int("axis", if is_to_end { 1 } else { -1 });
    // With the axis behind the last one, each value is the only one of its sum. A tensor of one
    // axis has this with the default.
    let count = (node.forms)(value).shape().len();
    if is_to_end && usize::try_from(from_start(axis, count)) == Ok(count) {
        return Err(format!("its axis {axis} is behind the last, so that every share is 1"));
    }
    Ok(Softmax { axis, is_to_end, is_logarithm })
}
