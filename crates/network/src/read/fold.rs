// SPDX-License-Identifier: MIT OR Apache-2.0
//! Nodes whose outputs are known when the network is read: shapes and what is computed of them.

use super::constant::{Constant, Values};
use super::node::{Known, NodeReader, from_start, signed};
use super::quantized;
use super::rearrange::{MAX_FOLDED, filled, reshaped, sliced, transposed};

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
            (other, _) => {
                return Err(format!("a cast of a constant to type {other} is not supported"));
            }
        },
        "DequantizeLinear" => return quantized::dequantized(node, first).map(Some),
        "QuantizeLinear" => return quantized::quantized(node, first).map(Some),
        "Gather" if first.shape.len() == 1 => {
            let index = inputs.get(1).ok_or("it has no indices")?;
            let pick = |&at: &i64| {
                let at = from_start(at, first.shape[0]);
                usize::try_from(at)
                    .ok()
                    .filter(|&at| at < first.shape[0])
                    .ok_or_else(|| format!("its index {at} is outside"))
            };
            let places: Vec<usize> =
                index.as_integers()?.iter().map(pick).collect::<Result<_, _>>()?;
            let values = first.as_integers()?;
            Constant::integers(index.shape.clone(), places.iter().map(|&at| values[at]).collect())
        }
        // Of shapes, which have one axis at most, only the values matter.
        "Unsqueeze" if first.shape.is_empty() => Constant { shape: vec![1], ..first.clone() },
        "Squeeze" if first.values.count() == 1 => Constant { shape: Vec::new(), ..first.clone() },
        "Concat" => {
            let parts: Vec<&[i64]> =
                inputs.iter().map(|input| input.as_integers()).collect::<Result<_, _>>()?;
            let values = parts.concat();
            Constant::integers(vec![values.len()], values)
        }
        "Add" | "Sub" | "Mul" | "Div" if inputs.len() == 2 && first.as_integers().is_ok() => {
            let (a, b) = (first.as_integers()?, inputs[1].as_integers()?);
            let of = |a: i64, b: i64| match node.kind() {
                "Add" => a.checked_add(b),
                "Sub" => a.checked_sub(b),
                "Mul" => a.checked_mul(b),
                _ => a.checked_div(b),
            };
            let length = a.len().max(b.len());
            if [a.len(), b.len()].iter().any(|&own| own != length && own != 1) {
                return Err("its inputs do not fit together".to_owned());
            }
            let at = |values: &[i64], at: usize| values[if values.len() == 1 { 0 } else { at }];
            let values: Option<Vec<i64>> =
                (0..length).map(|place| of(at(a, place), at(b, place))).collect();
            let shape =
                if a.len() == length { first.shape.clone() } else { inputs[1].shape.clone() };
            Constant::integers(shape, values.ok_or("its result is no integer of 64 bits")?)
        }
        "ConstantOfShape" => filled(node, first)?,
        "Reshape" => reshaped(first, inputs.get(1).ok_or("it has no shape")?)?,
        "Transpose" => transposed(node, first)?,
        "Slice" => sliced(first, inputs)?,
        _ => return Ok(None),
    };
    if made.values.count() > MAX_FOLDED {
        return Err(format!("it makes a constant of more than {MAX_FOLDED} values"));
    }
    Ok(Some(made))
}
