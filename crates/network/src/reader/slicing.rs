// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that take parts of a tensor, or pad it.

use super::constant_selection::slice_bounds;
use super::node::{NodeReader, Operand, index_from_start, length_to_i64};
use super::node_output::{NodeOutput, output_of_tensors};
use super::reshaping::resolve_axes;
use crate::element::{ElementType, Encoding};
use crate::operator::{AxisGather, AxisSelection};
use crate::tensor::Tensor;
use crate::tensor_form::TensorForm;
use std::sync::Arc;

/// The largest number of elements that padding adds at one end of an axis.
const MAX_PAD: i64 = 65535;

pub(super) fn slice(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let starts = node.ints_or_input("starts", 1)?.ok_or("it has no starts")?;
    let ends = node.ints_or_input("ends", 2)?.ok_or("it has no ends")?;
    let axes = node.ints_or_input("axes", 3)?.unwrap_or_else(|| (0..).take(starts.len()).collect());
    let steps = node.ints_or_input("steps", 4)?.unwrap_or_else(|| vec![1; starts.len()]);
    if [ends.len(), axes.len(), steps.len()] != [starts.len(); 3] {
        return Err("its starts, ends, axes and steps differ in length".to_owned());
    }
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let mut picked: Vec<Option<AxisSelection>> = vec![None; form.shape().len()];
    for (at, &axis) in axes.iter().enumerate() {
        let axis = form.resolve_axis(axis)?;
        let part = axis_slice(starts[at], ends[at], steps[at], form.shape()[axis])?;
        if picked[axis].replace(part).is_some() {
            return Err(format!("its axis {axis} is cut twice"));
        }
    }
    let axes = picked.into_iter().map(|part| part.unwrap_or(AxisSelection::All)).collect();
    output_of_tensors(AxisGather { axes, dropped_axis: None, padding: None }, vec![value])
}

/// Returns a slice of an axis, and fails if it is empty.
fn axis_slice(start: i64, end: i64, step: i64, length: usize) -> Result<AxisSelection, String> {
    let (first, count) = slice_bounds(start, end, step, length)?;
    if count == 0 {
        return Err(format!("{start}..{end} of {length} elements is empty"));
    }
    if (first, count, step) == (0, length, 1) {
        return Ok(AxisSelection::All);
    }
    let at = |number: usize| {
        let at = length_to_i64(number)
            .checked_mul(step)
            .and_then(|distance| first.checked_add(distance));
        at.and_then(|at| usize::try_from(at).ok())
    };
    Ok(AxisSelection::from_indices((0..count).map(at)))
}

pub(super) fn split(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let axis = form.resolve_axis(node.int("axis", 0))?;
    let length = form.shape()[axis];
    let parts = node.node.output.len().max(1);
    let wanted = node.int("num_outputs", length_to_i64(parts));
    if wanted != length_to_i64(parts) {
        return Err(format!("its num_outputs is {wanted}, but it has {parts} outputs"));
    }
    let each = length.div_ceil(parts);
    let sizes = node.ints_or_input("split", 1)?.unwrap_or_else(|| {
        (0..parts)
            .map(|part| length_to_i64(length.min((part + 1) * each) - length.min(part * each)))
            .collect()
    });
    let mut start = 0i64;
    let all = sizes.iter().try_fold(0i64, |sum, &size| sum.checked_add(size).filter(|_| size >= 0));
    if all != Some(length_to_i64(length)) || sizes.len() != parts {
        return Err(format!(
            "{length} elements cannot be split into {parts} parts of the lengths that it gives"
        ));
    }
    let slices = sizes.iter().map(|&size| {
        let selection = axis_slice(start, start + size, 1, length)?;
        start += size;
        let gather = AxisGather::along_axis(axis, selection, form.shape().len());
        Ok(NodeOutput::Operator(Arc::new(gather), vec![Operand::Tensor(value)]))
    });
    slices.collect()
}

pub(super) fn gather(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let axis = form.resolve_axis(node.int("axis", 0))?;
    let indices = node.required_constant(1, "indices, of a tensor that is not constant,")?;
    if indices.shape.len() > 1 {
        return Err(format!(
            "indices of {} axes are not supported where the tensor is not constant, only one index or a list",
            indices.shape.len()
        ));
    }
    let length = form.shape()[axis];
    let place = |&index: &i64| {
        let at = usize::try_from(index_from_start(index, length)).ok().filter(|&at| at < length);
        at.map(Some).ok_or_else(|| format!("its index {index} is outside of {length} elements"))
    };
    let places: Vec<_> = indices.as_integers()?.iter().map(place).collect::<Result<_, _>>()?;
    if places.is_empty() {
        return Err("it has no indices, so that its output is empty".to_owned());
    }
    let dropped = indices.shape.is_empty().then_some(axis);
    let pick = AxisGather::along_axis(
        axis,
        AxisSelection::from_indices(places.into_iter()),
        form.shape().len(),
    );
    output_of_tensors(AxisGather { dropped_axis: dropped, ..pick }, vec![value])
}

pub(super) fn pad(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let form = (node.forms)(value);
    let count = form.shape().len();
    let axes = match node.constant(3, "axes")? {
        Some(axes) => resolve_axes(axes.as_integers()?, count)?,
        None => (0..count).collect(),
    };
    let pads = node.ints_or_input("pads", 1)?.ok_or("it has no pads")?;
    if pads.len() != 2 * axes.len() {
        return Err(format!("it has {} pads; it must have {}", pads.len(), 2 * axes.len()));
    }
    let mode = PaddingMode::parse(&node.text("mode", "constant"))?;
    let mut picked = vec![AxisSelection::All; count];
    for (at, &axis) in axes.iter().enumerate() {
        let pads_of_axis = [pads[at], pads[axes.len() + at]];
        if pads_of_axis != [0, 0] {
            picked[axis] = padded_axis(pads_of_axis, form.shape()[axis], mode)?;
        }
    }
    let element = form.encoding().element;
    let padding = match (mode, node.constant(2, "value")?) {
        (PaddingMode::Reflect | PaddingMode::Edge | PaddingMode::Wrap, _) => None,
        (PaddingMode::Constant, Some(value)) => Some(value.single_value(element)?),
        (PaddingMode::Constant, None) if element == ElementType::F32 => Some(Tensor::new(
            TensorForm::without_positions(Vec::new()),
            vec![node.float("value", 0.0)],
        )),
        (PaddingMode::Constant, None) => Some(Tensor::zeros(
            TensorForm::without_positions(Vec::new()).with_encoding(Encoding::plain(element)),
        )),
    };
    output_of_tensors(AxisGather { axes: picked, dropped_axis: None, padding }, vec![value])
}

/// The values that padding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PaddingMode {
    Constant,
    Reflect,
    Edge,
    Wrap,
}

impl PaddingMode {
    fn parse(name: &str) -> Result<Self, String> {
        match name {
            "constant" => Ok(Self::Constant),
            "reflect" => Ok(Self::Reflect),
            "edge" => Ok(Self::Edge),
            "wrap" => Ok(Self::Wrap),
            other => Err(format!(
                "the mode `{other}` is unknown; it must be constant, reflect, edge or wrap"
            )),
        }
    }

    /// Returns the element of an axis for an index, which may be outside of the axis; `None` for
    /// padding.
    fn element(self, at: i64, length: usize) -> Option<usize> {
        let all = length_to_i64(length);
        let inside = |at: i64| usize::try_from(at).ok();
        match self {
            Self::Constant => inside(at).filter(|&at| at < length),
            Self::Edge => inside(at.clamp(0, all - 1)),
            Self::Wrap => inside(at.rem_euclid(all)),
            Self::Reflect => {
                // A reflected axis runs forward and back, and its end elements occur once.
                let period = (2 * (all - 1)).max(1);
                let at = at.rem_euclid(period);
                inside(at.min(period - at).min(all - 1))
            }
        }
    }
}

/// Returns an axis padded with `before` and `after` elements. Negative numbers remove elements.
fn padded_axis(
    [before, after]: [i64; 2],
    length: usize,
    mode: PaddingMode,
) -> Result<AxisSelection, String> {
    if let Some(too_large) =
        [before, after].into_iter().find(|pad| !(-MAX_PAD..=MAX_PAD).contains(pad))
    {
        return Err(format!("a pad of {too_large} is not supported; it must be within {MAX_PAD}"));
    }
    let end = length_to_i64(length) + after;
    if end + before <= 0 {
        return Err(format!("pads of {before} and {after} leave nothing of {length} elements"));
    }
    Ok(AxisSelection::from_indices((-before..end).map(|at| mode.element(at, length))))
}
