// SPDX-License-Identifier: MIT OR Apache-2.0
//! Constant folding: nodes whose outputs are known when the network is read, such as shapes and
//! results computed from them.

use super::constant::Constant;
use super::constant_selection::{
    broadcast_constant, concat_constants, fill_constant, gather_constant, reshape_constant,
    slice_constant, transpose_constant,
};
use super::node::{GraphValue, NodeReader, index_from_start, length_to_i64};
use super::reshaping::{axes_of_node, resolve_axes};
use super::{constant_arithmetic, quantized_operators};
use crate::operator::broadcast_shape;
use crate::tensor::MAX_AXES;

/// Returns the output of a node that depends only on constants, or `None` if the node is not one
/// that can be folded.
pub(super) fn fold_node(node: &NodeReader<'_>) -> Result<Option<Constant>, String> {
    let folded = |constant| Ok(Some(constant));
    match node.operator_name() {
        "Constant" => {
            let ints = node
                .ints("value_ints")
                .map(|ints| Constant::integers(vec![ints.len()], ints.to_vec()));
            let int = node
                .has_attribute("value_int")
                .then(|| Constant::integers(Vec::new(), vec![node.int("value_int", 0)]));
            let float = node
                .has_attribute("value_float")
                .then(|| Constant::floats(Vec::new(), vec![node.float("value_float", 0.0)]));
            let floats = node
                .floats("value_floats")
                .map(|floats| Constant::floats(vec![floats.len()], floats.to_vec()));
            let value = node.tensor("value")?.or(ints).or(int).or(float).or(floats);
            folded(value.ok_or("it has none of the attributes value, value_float, value_floats, value_int and value_ints")?)
        }
        "Shape" => {
            let shape: Vec<usize> = match node.input(0) {
                Some(GraphValue::Constant(constant)) => constant.shape.clone(),
                Some(&GraphValue::Tensor(value)) => (node.forms)(value).shape().to_vec(),
                None => return Err("it has no input".to_owned()),
            };
            let lengths: Vec<i64> = shape
                .iter()
                .map(|&length| i64::try_from(length).expect("an axis is shorter"))
                .collect();
            let index = |at: i64| {
                usize::try_from(index_from_start(at, lengths.len()).max(0))
                    .expect("not negative")
                    .min(lengths.len())
            };
            let (start, end) =
                (index(node.int("start", 0)), index(node.int("end", length_to_i64(lengths.len()))));
            let part = lengths.get(start..end).unwrap_or_default().to_vec();
            folded(Constant::integers(vec![part.len()], part))
        }
        _ => {
            let Some(inputs) = constant_inputs(node) else { return Ok(None) };
            let output = compute_output(node, &inputs)?;
            output
                .iter()
                .try_for_each(|output| node.folder.count_computed(&output.shape, &output.values))?;
            Ok(output)
        }
    }
}

/// Returns all inputs if there are some and all are constant.
fn constant_inputs<'a>(node: &NodeReader<'a>) -> Option<Vec<&'a Constant>> {
    let inputs: Option<Vec<_>> = (0..node.node.input.len())
        .map(|at| match node.input(at) {
            Some(GraphValue::Constant(constant)) => Some(constant.as_ref()),
            _ => None,
        })
        .collect();
    inputs.filter(|inputs| !inputs.is_empty())
}

/// Computes the output of a node from constants, or returns `None` if its operator cannot be
/// folded.
fn compute_output(node: &NodeReader<'_>, inputs: &[&Constant]) -> Result<Option<Constant>, String> {
    let first = inputs[0];
    let output = match node.operator_name() {
        "Cast" => first.cast(node.data_type("to")?)?,
        "CastLike" => first.cast(inputs.get(1).ok_or("it has no type")?.data_type)?,
        "DequantizeLinear" => quantized_operators::dequantize_constant(node, first)?,
        "QuantizeLinear" => quantized_operators::quantize_constant(node, first)?,
        "Gather" => gather_constant(node, first, inputs.get(1).ok_or("it has no indices")?)?,
        "Unsqueeze" => {
            let new = node.ints_or_input("axes", 1)?.ok_or("it has no axes")?;
            let axes = resolve_axes(&new, (first.shape.len() + new.len()).min(2 * MAX_AXES))?;
            let mut old = first.shape.iter();
            let length = |axis| match axes.contains(&axis) {
                true => 1,
                false => old.next().copied().unwrap_or(1),
            };
            let shape: Vec<usize> = (0..first.shape.len() + axes.len()).map(length).collect();
            if shape.len() > MAX_AXES {
                return Err(format!("its output has more than {MAX_AXES} axes"));
            }
            Constant { shape, ..first.clone() }
        }
        "Squeeze" => {
            let axes = axes_of_node(node, first.shape.len())?;
            let left = first.shape.iter().enumerate().filter(|(axis, length)| {
                **length != 1 || axes.as_ref().is_some_and(|axes| !axes.contains(axis))
            });
            Constant { shape: left.map(|(_, &length)| length).collect(), ..first.clone() }
        }
        "Concat" => concat_constants(node, inputs)?,
        "Expand" => {
            let wanted = inputs.get(1).ok_or("it has no shape")?.as_integers()?;
            let wanted: Option<Vec<usize>> =
                wanted.iter().map(|&length| usize::try_from(length).ok()).collect();
            let wanted = wanted.filter(|wanted| wanted.len() <= MAX_AXES);
            let wanted = wanted.ok_or("its shape has too many axes, or a negative length")?;
            let shape = broadcast_shape(&first.shape, &wanted)
                .ok_or_else(|| format!("{:?} cannot become {wanted:?}", first.shape))?;
            broadcast_constant(node.folder, first, &shape)?
        }
        "Range" => constant_arithmetic::number_range(node.folder, inputs)?,
        "Where" => match inputs {
            [condition, a, b] => {
                constant_arithmetic::select_by_condition(node.folder, condition, a, b)?
            }
            _ => return Err(format!("it has {} inputs, not 3", inputs.len())),
        },
        "ConstantOfShape" => fill_constant(node, first)?,
        "Reshape" => reshape_constant(node, first, inputs.get(1).ok_or("it has no shape")?)?,
        "Transpose" => transpose_constant(node, first)?,
        "Slice" => slice_constant(node, first)?,
        kind => {
            let output = match inputs {
                [a] => constant_arithmetic::unary_operation(kind, a)?,
                [a, b] => constant_arithmetic::binary_operation(node.folder, kind, a, b)?,
                _ => None,
            };
            match output {
                Some(output) => output,
                None => return Ok(None),
            }
        }
    };
    Ok(Some(output))
}
