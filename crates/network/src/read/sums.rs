// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators of ONNX that sum over windows, channels or everything.

use super::constant::Constant;
use super::made::{Made, one};
use super::node::{NodeReader, from_start, signed};
use super::pointwise;
use crate::operator::{Conv, Linear, MatMul, Pool, PoolKind, Reduce, Reduction, Softmax};
use foveate_lanes::Level;

pub(super) fn conv(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let weights = node.wanted(1, "weights")?;
    let geometry = node.geometry(&weights.shape, value)?;
    let bias = node.constant(2, "bias")?.map(Constant::as_floats).transpose()?;
    one(Conv::new(geometry, weights.as_weights()?, bias, Level::detect())?, vec![value])
}

pub(super) fn pool(node: &NodeReader<'_>, kind: PoolKind) -> Result<Pool, String> {
    if node.node.output.len() > 1 {
        return Err("its indices, a second output, are not supported".to_owned());
    }
    let value = node.value(0)?;
    let [rows, columns] = node.windows(node.kernel()?.ok_or("it has no kernel_shape")?, value)?;
    Ok(Pool { kind, rows, columns, ceil: node.int("ceil_mode", 0) != 0 })
}

pub(super) fn global(node: &NodeReader<'_>, kind: Reduction) -> Result<Vec<Made>, String> {
    one(Reduce { kind, from: 2, keep: true }, vec![node.value(0)?])
}

pub(super) fn reduce_mean(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let count = (node.forms)(value).shape().len();
    let keep = node.int("keepdims", 1) != 0;
    let axes = node.ints_of("axes", 1)?.filter(|axes| !axes.is_empty());
    if axes.is_none() && node.int("noop_with_empty_axes", 0) != 0 {
        return pointwise::same(node);
    }
    let axes = axes.unwrap_or_else(|| (0..).take(count).collect());
    let mut axes: Vec<i64> = axes.iter().map(|&axis| from_start(axis, count)).collect();
    axes.sort_unstable();
    let from = axes.first().copied().unwrap_or(0);
    if !axes.iter().copied().eq(from..signed(count)) {
        return Err(format!(
            "the mean over axes {axes:?} of {count} is not supported, only one over the last axes"
        ));
    }
    let from = usize::try_from(from).map_err(|_| format!("its axes are {axes:?}"))?;
    one(Reduce { kind: Reduction::Mean, from, keep }, vec![value])
}

pub(super) fn gemm(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.int("transA", 0) != 0 {
        return Err("transA is not supported".to_owned());
    }
    let weights = node.wanted(1, "matrix")?;
    let bias = node.constant(2, "bias")?.map(Constant::as_floats).transpose()?;
    let transposed = node.int("transB", 0) != 0;
    let (alpha, beta) = (node.float("alpha", 1.0), node.float("beta", 1.0));
    one(
        Linear::new(&weights.shape, weights.as_weights()?, bias, transposed, alpha, beta)?,
        vec![node.value(0)?],
    )
}

pub(super) fn matmul(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let matrix = node.wanted(1, "second matrix")?;
    one(MatMul::new(&matrix.shape, matrix.as_weights()?)?, vec![node.value(0)?])
}

pub(super) fn softmax(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    if node.opset >= 13 {
        return one(Softmax { axis: node.int("axis", -1) }, vec![value]);
    }
    // Until version 13 it is over all axes from one on.
    let form = (node.forms)(value);
    let axis = from_start(node.int("axis", 1), form.shape().len());
    let rest = usize::try_from(axis).ok().and_then(|axis| form.shape().get(axis + 1..));
    match rest {
        Some(rest) if rest.iter().all(|&length| length == 1) => one(Softmax { axis }, vec![value]),
        _ => Err(format!(
            "over all axes from {axis} on, as before version 13 of the operators, it is not supported"
        )),
    }
}
