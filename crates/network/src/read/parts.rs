// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that take parts of a tensor, or pad it.

use super::made::{Made, one};
use super::moves::axes_of;
use super::node::{NodeReader, Operand, from_start, signed};
use super::rearrange::stretch;
use crate::element::{Element, Encoding};
use crate::form::Form;
use crate::operator::{Pick, Picked};
use crate::tensor::Tensor;
use std::sync::Arc;

/// The largest number of elements that padding adds at one end of an axis.
const MAX_PAD: i64 = 65535;

pub(super) fn slice(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let starts = node.ints_of("starts", 1)?.ok_or("it has no starts")?;
    let ends = node.ints_of("ends", 2)?.ok_or("it has no ends")?;
    let axes = node.ints_of("axes", 3)?.unwrap_or_else(|| (0..).take(starts.len()).collect());
    let steps = node.ints_of("steps", 4)?.unwrap_or_else(|| vec![1; starts.len()]);
    if [ends.len(), axes.len(), steps.len()] != [starts.len(); 3] {
        return Err("its starts, ends, axes and steps differ in length".to_owned());
    }
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let mut picked: Vec<Option<Picked>> = vec![None; form.shape().len()];
    for (at, &axis) in axes.iter().enumerate() {
        let axis = form.axis(axis)?;
        let part = part(starts[at], ends[at], steps[at], form.shape()[axis])?;
        if picked[axis].replace(part).is_some() {
            return Err(format!("its axis {axis} is cut twice"));
        }
    }
    let axes = picked.into_iter().map(|part| part.unwrap_or(Picked::All)).collect();
    one(Pick { axes, dropped: None, padding: None }, vec![value])
}

/// Returns a slice of an axis, and fails if it is empty.
fn part(start: i64, end: i64, step: i64, length: usize) -> Result<Picked, String> {
    let (first, count) = stretch(start, end, step, length)?;
    if count == 0 {
        return Err(format!("{start}..{end} of {length} elements is empty"));
    }
    if (first, count, step) == (0, length, 1) {
        return Ok(Picked::All);
    }
    let at = |number: usize| {
        let at = signed(number).checked_mul(step).and_then(|way| first.checked_add(way));
        at.and_then(|at| usize::try_from(at).ok())
    };
    Ok(Picked::at((0..count).map(at)))
}

pub(super) fn split(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axis = form.axis(node.int("axis", 0))?;
    let length = form.shape()[axis];
    let parts = node.node.output.len().max(1);
    let wanted = node.int("num_outputs", signed(parts));
    if wanted != signed(parts) {
        return Err(format!("its num_outputs is {wanted}, but it has {parts} outputs"));
    }
    let each = length.div_ceil(parts);
    let sizes = node.ints_of("split", 1)?.unwrap_or_else(|| {
        (0..parts)
            .map(|part| signed(length.min((part + 1) * each) - length.min(part * each)))
            .collect()
    });
    let mut start = 0i64;
    let all = sizes.iter().try_fold(0i64, |sum, &size| sum.checked_add(size).filter(|_| size >= 0));
    if all != Some(signed(length)) || sizes.len() != parts {
        return Err(format!("{length} elements cannot be split into {parts} parts as it says"));
    }
    let slices = sizes.iter().map(|&size| {
        let own = part(start, start + size, 1, length)?;
        start += size;
        let pick = Pick::along(axis, own, form.shape().len());
        Ok(Made::Operator(Arc::new(pick), vec![Operand::Value(value)]))
    });
    slices.collect()
}

pub(super) fn gather(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axis = form.axis(node.int("axis", 0))?;
    let indices = node.wanted(1, "indices, of a tensor that is not constant,")?;
    if indices.shape.len() > 1 {
        return Err(format!(
            "indices of {} axes are not supported where the tensor is not constant, only one index or a list",
            indices.shape.len()
        ));
    }
    let length = form.shape()[axis];
    let place = |&index: &i64| {
        let at = usize::try_from(from_start(index, length)).ok().filter(|&at| at < length);
        at.map(Some).ok_or_else(|| format!("its index {index} is outside of {length} elements"))
    };
    let places: Vec<_> = indices.as_integers()?.iter().map(place).collect::<Result<_, _>>()?;
    if places.is_empty() {
        return Err("it has no indices, so that its output is empty".to_owned());
    }
    let dropped = indices.shape.is_empty().then_some(axis);
    let pick = Pick::along(axis, Picked::at(places.into_iter()), form.shape().len());
    one(Pick { dropped, ..pick }, vec![value])
}

pub(super) fn pad(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let count = form.shape().len();
    let axes = match node.constant(3, "axes")? {
        Some(axes) => axes_of(axes.as_integers()?, count)?,
        None => (0..count).collect(),
    };
    let pads = node.ints_of("pads", 1)?.ok_or("it has no pads")?;
    if pads.len() != 2 * axes.len() {
        return Err(format!("it has {} pads; it must have {}", pads.len(), 2 * axes.len()));
    }
    let mode = Mode::of(&node.text("mode", "constant"))?;
    let mut picked = vec![Picked::All; count];
    for (at, &axis) in axes.iter().enumerate() {
        let around = [pads[at], pads[axes.len() + at]];
        if around != [0, 0] {
            picked[axis] = padded(around, form.shape()[axis], mode)?;
        }
    }
    let element = form.encoding().element;
    let padding = match (mode, node.constant(2, "value")?) {
        (Mode::Reflect | Mode::Edge | Mode::Wrap, _) => None,
        (Mode::Constant, Some(value)) => Some(value.single(element)?),
        (Mode::Constant, None) if element == Element::F32 => {
            Some(Tensor::new(Form::whole(Vec::new()), vec![node.float("value", 0.0)]))
        }
        (Mode::Constant, None) => {
            Some(Tensor::zeros(Form::whole(Vec::new()).encoded(Encoding::plain(element))))
        }
    };
    one(Pick { axes: picked, dropped: None, padding }, vec![value])
}

/// The values that padding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Constant,
    Reflect,
    Edge,
    Wrap,
}

impl Mode {
    fn of(name: &str) -> Result<Self, String> {
        match name {
            "constant" => Ok(Self::Constant),
            "reflect" => Ok(Self::Reflect),
            "edge" => Ok(Self::Edge),
            "wrap" => Ok(Self::Wrap),
            other => {
                Err(format!("the mode `{other}` is unknown; it is constant, reflect, edge or wrap"))
            }
        }
    }

    /// Returns the element of an axis that stands at an index, which may be outside of the axis.
    fn element(self, at: i64, length: usize) -> Option<usize> {
        let all = signed(length);
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
fn padded([before, after]: [i64; 2], length: usize, mode: Mode) -> Result<Picked, String> {
    if let Some(odd) = [before, after].into_iter().find(|pad| !(-MAX_PAD..=MAX_PAD).contains(pad)) {
        return Err(format!("a pad of {odd} is not supported; it must be within {MAX_PAD}"));
    }
    let end = signed(length) + after;
    if end + before <= 0 {
        return Err(format!("pads of {before} and {after} leave nothing of {length} elements"));
    }
    Ok(Picked::at((-before..end).map(|at| mode.element(at, length))))
}
