// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that only move values: reshaping, transposition and concatenation.

use super::node::{NodeReader, index_from_start, length_to_i64};
use super::node_output::{NodeOutput, output_of_operands, output_of_tensors};
use crate::operator::{Concat, Expand, Reshape, Transpose, broadcast_shape};
use crate::tensor_form::MAX_AXES;

pub(super) fn concat(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let operands = (0..node.node.input.len()).map(|at| node.operand(at));
    output_of_operands(Concat { axis: node.int("axis", 1) }, operands.collect::<Result<_, _>>()?)
}

pub(super) fn expand(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let wanted = node.required_constant(1, "shape")?.as_integers()?;
    if wanted.len() > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    let wanted: Option<Vec<usize>> =
        wanted.iter().map(|&length| usize::try_from(length).ok()).collect();
    let wanted = wanted.ok_or("its shape has a negative length")?;
    let form = (node.forms)(value);
    // A length of 1 broadcasts from either side.
    let shape = broadcast_shape(form.shape(), &wanted)
        .ok_or_else(|| format!("{} cannot become {wanted:?}", form.describe()))?;
    output_of_tensors(Expand { shape }, vec![value])
}

pub(super) fn flatten(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let axis = node.int("axis", 1);
    let axis = index_from_start(axis, form.shape().len());
    let axis = usize::try_from(axis)
        .ok()
        .filter(|&axis| axis <= form.shape().len())
        .ok_or("its axis is outside of the axes of its input")?;
    let before: usize = form.shape()[..axis].iter().product();
    output_of_tensors(
        Reshape { shape: vec![i64::try_from(before).map_err(|_| "its input is too large")?, -1] },
        vec![value],
    )
}

pub(super) fn reshape(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let shape = node.ints_or_input("shape", 1)?.ok_or("it has no shape")?;
    if node.int("allowzero", 0) != 0 && shape.contains(&0) {
        return Err(format!(
            "its shape {shape:?} holds a 0 and allowzero is 1, so that its output is empty; without allowzero a 0 is the input's own length"
        ));
    }
    if shape.len() > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    output_of_tensors(Reshape { shape }, vec![node.tensor_input(0)?])
}

pub(super) fn squeeze(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let axes = axes_of_node(node, form.shape().len())?;
    let left = form.shape().iter().enumerate().filter(|(axis, length)| match &axes {
        Some(axes) => !axes.contains(axis),
        None => **length != 1,
    });
    output_of_tensors(
        Reshape { shape: left.map(|(_, &length)| length_to_i64(length)).collect() },
        vec![value],
    )
}

pub(super) fn unsqueeze(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let new = node.ints_or_input("axes", 1)?.ok_or("it has no axes")?.len();
    if form.shape().len() + new > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    let axes = axes_of_node(node, form.shape().len() + new)?.ok_or("it has no axes")?;
    let mut old = form.shape().iter();
    let shape = (0..form.shape().len() + new).map(|axis| {
        if axes.contains(&axis) { 1 } else { old.next().map_or(1, |&length| length_to_i64(length)) }
    });
    output_of_tensors(Reshape { shape: shape.collect() }, vec![value])
}

/// Returns the axes among `count` that a node names.
pub(super) fn axes_of_node(
    node: &NodeReader<'_>,
    count: usize,
) -> Result<Option<Vec<usize>>, String> {
    node.ints_or_input("axes", 1)?.map(|axes| resolve_axes(&axes, count)).transpose()
}

/// Resolves axes among `count`, and fails if one is named twice.
pub(super) fn resolve_axes(axes: &[i64], count: usize) -> Result<Vec<usize>, String> {
    let resolved = |&axis: &i64| {
        usize::try_from(index_from_start(axis, count))
            .ok()
            .filter(|&resolved| resolved < count)
            .ok_or_else(|| format!("its axis {axis} is outside of the axes of its input"))
    };
    let axes: Vec<usize> = axes.iter().map(resolved).collect::<Result<_, _>>()?;
    let are_distinct = (1..axes.len()).all(|at| !axes[..at].contains(&axes[at]));
    if are_distinct { Ok(axes) } else { Err("it names an axis twice".to_owned()) }
}

pub(super) fn transpose(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let count = (node.forms)(value).shape().len();
    let order = match node.ints("perm") {
        None => (0..count).rev().collect(),
        Some(perm) => perm
            .iter()
            .map(|&axis| {
                usize::try_from(axis)
                    .map_err(|_| format!("its perm is {perm:?}, which has a negative axis"))
            })
            .collect::<Result<_, _>>()?,
    };
    output_of_tensors(Transpose { order }, vec![value])
}
