// SPDX-License-Identifier: MIT OR Apache-2.0
//! Nodes whose outputs are known when the network is read: shapes and what is computed of them.

use super::constant::{Constant, Values};
use super::elementwise;
use super::moves::{axes, axes_of};
use super::node::{Known, NodeReader, from_start, signed};
use super::quantized;
use super::rearrange::{
    MAX_FOLDED, filled, gathered, joined, reshaped, sliced, spread, transposed,
};
use crate::element::Element;
use crate::form::MAX_AXES;
use crate::operator::broadcast;

/// The output of a node that only computes with constants; `None` if it is not one of those that are known.
pub(super) fn fold(node: &NodeReader<'_>) -> Result<Option<Constant>, String> {
    let one = |constant| Ok(Some(constant));
    match node.kind() {
        "Constant" => {
            let ints = node
                .ints("value_ints")
                .map(|ints| Constant::integers(vec![ints.len()], ints.to_vec()));
            let int = node
                .has("value_int")
                .then(|| Constant::integers(Vec::new(), vec![node.int("value_int", 0)]));
            let float = node
                .has("value_float")
                .then(|| Constant::floats(Vec::new(), vec![node.float("value_float", 0.0)]));
            let value = node.tensor("value")?.or(ints).or(int).or(float);
            one(value.ok_or("its value is of a kind that is not supported")?)
        }
        "Shape" => {
            let shape: Vec<usize> = match node.input(0) {
                Some(Known::Constant(constant)) => constant.shape.clone(),
                Some(&Known::Value(value)) => (node.forms)(value).shape().to_vec(),
                None => return Err("it has no input".to_owned()),
            };
            let lengths: Vec<i64> = shape
                .iter()
                .map(|&length| i64::try_from(length).expect("an axis is shorter"))
                .collect();
            let place = |at: i64| {
                usize::try_from(from_start(at, lengths.len()).max(0))
                    .expect("not negative")
                    .min(lengths.len())
            };
            let (start, end) =
                (place(node.int("start", 0)), place(node.int("end", signed(lengths.len()))));
            let part = lengths.get(start..end).unwrap_or_default().to_vec();
            one(Constant::integers(vec![part.len()], part))
        }
        _ => constants(node).map_or(Ok(None), |inputs| computed(node, &inputs)),
    }
}

/// All inputs, if there are some and all are constant.
fn constants<'a>(node: &NodeReader<'a>) -> Option<Vec<&'a Constant>> {
    let inputs: Option<Vec<_>> = (0..node.node.input.len())
        .map(|at| match node.input(at) {
            Some(Known::Constant(constant)) => Some(constant.as_ref()),
            _ => None,
        })
        .collect();
    inputs.filter(|inputs| !inputs.is_empty())
}

/// What a node makes of constants.
fn computed(node: &NodeReader<'_>, inputs: &[&Constant]) -> Result<Option<Constant>, String> {
    let first = inputs[0];
    let made = match node.kind() {
        "Cast" => match (node.int("to", 1), &first.values) {
            #[allow(clippy::cast_precision_loss, reason = "a cast rounds")]
            (1 | 10 | 16, Values::Integers(values)) => Constant::floats(
                first.shape.clone(),
                values.iter().map(|&value| value as f32).collect(),
            ),
            #[allow(clippy::cast_possible_truncation, reason = "a cast cuts off")]
            (6 | 7, Values::Floats(values)) => Constant::integers(
                first.shape.clone(),
                values.iter().map(|&value| value as i64).collect(),
            ),
            (1 | 10 | 16, Values::Floats(_)) | (6 | 7, Values::Integers(_)) => first.clone(),
            (9, values) => {
                let is = match values {
                    Values::Floats(values) => values.iter().map(|&value| value != 0.0).collect(),
                    Values::Integers(values) => {
                        values.iter().map(|&value| value != 0).collect::<Vec<bool>>()
                    }
                };
                Constant {
                    shape: first.shape.clone(),
                    values: Values::Integers(is.into_iter().map(i64::from).collect()),
                    element: Some(Element::U8),
                }
            }
            (other, _) => {
                return Err(format!("a cast of a constant to type {other} is not supported"));
            }
        },
        "DequantizeLinear" => return quantized::dequantized(node, first).map(Some),
        "QuantizeLinear" => return quantized::quantized(node, first).map(Some),
        "Gather" => gathered(node, first, inputs.get(1).ok_or("it has no indices")?)?,
        "Unsqueeze" => {
            let new = node.ints_of("axes", 1)?.ok_or("it has no axes")?;
            let axes = axes_of(&new, (first.shape.len() + new.len()).min(2 * MAX_AXES))?;
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
            let axes = axes(node, first.shape.len())?;
            let left = first.shape.iter().enumerate().filter(|(axis, length)| {
                **length != 1 || axes.as_ref().is_some_and(|axes| !axes.contains(axis))
            });
            Constant { shape: left.map(|(_, &length)| length).collect(), ..first.clone() }
        }
        "Concat" => joined(node, inputs)?,
        "Expand" => {
            let wanted = inputs.get(1).ok_or("it has no shape")?.as_integers()?;
            let wanted: Option<Vec<usize>> =
                wanted.iter().map(|&length| usize::try_from(length).ok()).collect();
            let wanted = wanted.filter(|wanted| wanted.len() <= MAX_AXES);
            let wanted = wanted.ok_or("its shape has too many axes, or a negative length")?;
            let shape = broadcast(&first.shape, &wanted)
                .ok_or_else(|| format!("{:?} cannot become {wanted:?}", first.shape))?;
            spread(first, &shape)?
        }
        "Range" => elementwise::range(inputs)?,
        "Where" => match inputs {
            [condition, a, b] => elementwise::select(condition, a, b)?,
            _ => return Err(format!("it has {} inputs, not 3", inputs.len())),
        },
        "ConstantOfShape" => filled(node, first)?,
        "Reshape" => reshaped(first, inputs.get(1).ok_or("it has no shape")?)?,
        "Transpose" => transposed(node, first)?,
        "Slice" => sliced(first, inputs)?,
        kind => {
            let made = match inputs {
                [one] => elementwise::unary(kind, one)?,
                [a, b] => elementwise::binary(kind, a, b)?,
                _ => None,
            };
            match made {
                Some(made) => made,
                None => return Ok(None),
            }
        }
    };
    let count = made.values.count();
    let most = inputs.iter().map(|input| input.values.count()).max().unwrap_or(0);
    if count > MAX_FOLDED.max(most) {
        return Err(format!("it makes a constant of more than {MAX_FOLDED} values"));
    }
    if count > MAX_FOLDED {
        node.folder.charge(4 * count as u64)?;
    }
    Ok(Some(made))
}
