// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that sum or reduce over windows, channels or axes.

use super::constant::Constant;
use super::made::{Made, of, one};
use super::moves::axes;
use super::node::{Known, NodeReader, Operand};
use super::pointwise;
use crate::operator::{ArgMax, Conv, Linear, Pool, PoolKind, Product, Reduce, Reduced, Reduction};
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
    let value = node.value(0)?;
    let axes = (2..(node.forms)(value).shape().len()).collect();
    one(Reduce { kind, over: Reduced { axes, keep: true } }, vec![value])
}

pub(super) fn reduce(node: &NodeReader<'_>, kind: Reduction) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let count = (node.forms)(value).shape().len();
    let keep = node.int("keepdims", 1) != 0;
    let named = axes(node, count)?.filter(|axes| !axes.is_empty());
    if named.is_none() && node.int("noop_with_empty_axes", 0) != 0 {
        return pointwise::same(node);
    }
    let mut axes = named.unwrap_or_else(|| (0..count).collect());
    axes.sort_unstable();
    one(Reduce { kind, over: Reduced { axes, keep } }, vec![value])
}

pub(super) fn arg_max(node: &NodeReader<'_>, is_lowest: bool) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let axis = (node.forms)(value).axis(node.int("axis", 0))?;
    let over = Reduced { axes: vec![axis], keep: node.int("keepdims", 1) != 0 };
    let is_last = node.int("select_last_index", 0) != 0;
    one(ArgMax { over, is_lowest, is_last }, vec![value])
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
    match (node.input(0), node.input(1)) {
        (Some(&Known::Value(value)), Some(Known::Constant(matrix))) if matrix.shape.len() == 2 => {
            one(Linear::matrix(&matrix.shape, matrix.as_weights()?)?, vec![value])
        }
        (Some(Known::Constant(_)), Some(Known::Constant(_))) => {
            Err("a product of two constants is not supported".to_owned())
        }
        _ => {
            let operands = vec![node.operand(0)?, node.operand(1)?];
            let inner = match &operands[0] {
                Operand::Value(value) => (node.forms)(*value).shape().last().copied(),
                Operand::Constant(tensor) => tensor.form().shape().last().copied(),
            };
            of(Product { level: Level::detect(), inner: inner.unwrap_or(1) }, operands)
        }
    }
}
