// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that move values to other places and shapes: they reshape, transpose and
//! concatenate, take parts of a tensor, pad it, or change the height and width of features.

use super::constant::Constant;
use super::constant_selection::slice_bounds;
use super::node::{
    NodeOutput, NodeReader, Operand, checked_length, index_from_start, length_to_i64,
    output_of_operands, output_of_tensors,
};
use crate::element::{ElementType, Encoding};
use crate::operator::{
    AxisGather, AxisSelection, Concat, DepthToSpace, DepthToSpaceOrder, Expand, NearestRounding,
    Reshape, Resize, ResizeCoordinates, ResizeKind, ResizeSize, SpaceToDepth, Transpose,
    broadcast_shape,
};
use crate::tensor::{MAX_AXES, Tensor, TensorForm};
use std::sync::Arc;

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

/// The scale of a Resize must be below this. The size of its output is limited separately.
const MAX_SCALE: f32 = 65536.0;

pub(super) fn resize(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    // Before version 11 a Resize has the meaning of an Upsample.
    let is_old = node.operator_name() == "Upsample" || node.opset < 11;
    let text = |name, old, new| node.text(name, if is_old { old } else { new });
    let coordinates =
        match text("coordinate_transformation_mode", "asymmetric", "half_pixel").as_str() {
            "half_pixel" => ResizeCoordinates::HalfPixel,
            "pytorch_half_pixel" => ResizeCoordinates::PytorchHalfPixel,
            "align_corners" => ResizeCoordinates::AlignCorners,
            "asymmetric" => ResizeCoordinates::Asymmetric,
            other => return Err(format!("the coordinates `{other}` are not supported")),
        };
    let nearest = match text("nearest_mode", "simple", "round_prefer_floor").as_str() {
        "round_prefer_floor" => NearestRounding::RoundPreferFloor,
        "round_prefer_ceil" => NearestRounding::RoundPreferCeil,
        "floor" => NearestRounding::Floor,
        "ceil" => NearestRounding::Ceil,
        "simple" if is_old => NearestRounding::Simple,
        other => return Err(format!("the mode `{other}` is not supported")),
    };
    let kind = match node.text("mode", "nearest").as_str() {
        "nearest" => ResizeKind::Nearest(nearest),
        // The name `bilinear` is used before version 9.
        "linear" | "bilinear" => ResizeKind::Linear,
        "cubic" => ResizeKind::Cubic {
            a: node.float("cubic_coeff_a", -0.75),
            is_inside_only: node.int("exclude_outside", 0) != 0,
        },
        other => {
            return Err(format!(
                "the mode `{other}` is not supported, only nearest, linear and cubic"
            ));
        }
    };
    if node.int("antialias", 0) != 0 {
        return Err("antialias is not supported".to_owned());
    }
    if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
        return Err("only the keep_aspect_ratio_policy `stretch` is supported".to_owned());
    }
    let value = node.tensor_input(0)?;
    output_of_tensors(
        Resize { kind, coordinates, size: resize_size(node, value, is_old)? },
        vec![value],
    )
}

/// Returns the rows and columns of the output.
fn resize_size(node: &NodeReader<'_>, value: usize, is_old: bool) -> Result<ResizeSize, String> {
    let are_of_all = match node.ints("axes") {
        None | Some(&[0, 1, 2, 3]) => true,
        Some(&[2, 3]) => false,
        Some(axes) => {
            return Err(format!(
                "scales of the axes {axes:?} are not supported, only those of rows and columns"
            ));
        }
    };
    let scales = match node.floats("scales") {
        Some(scales) => Some(scales),
        None => node
            .constant(if is_old { 1 } else { 2 }, "scales")?
            .map(Constant::as_floats)
            .transpose()?,
    };
    let scales = scales.filter(|scales| !scales.is_empty());
    let sizes = if is_old { None } else { node.constant(3, "sizes")? };
    match (scales, sizes, are_of_all) {
        (Some(&[1.0, 1.0, rows, columns]), _, true) | (Some(&[rows, columns]), _, false)
            if rows > 0.0 && columns > 0.0 =>
        {
            match [rows, columns].into_iter().find(|&scale| scale >= MAX_SCALE) {
                None => Ok(ResizeSize::Scales([rows, columns])),
                Some(scale) => {
                    Err(format!("its scale of {scale} is too large; it must be below {MAX_SCALE}"))
                }
            }
        }
        (Some(scales), _, _) => {
            Err(format!("scales {scales:?} are not supported, only those of rows and columns"))
        }
        (None, Some(sizes), _) => match (sizes.as_integers()?, are_of_all) {
            (&[rows, columns], false) => Ok(ResizeSize::Sizes([
                checked_length("size", rows)?,
                checked_length("size", columns)?,
            ])),
            (&[1, channels, rows, columns], true)
                if (node.forms)(value).shape().get(1)
                    == usize::try_from(channels).ok().as_ref() =>
            {
                Ok(ResizeSize::Sizes([
                    checked_length("size", rows)?,
                    checked_length("size", columns)?,
                ]))
            }
            (sizes, _) => Err(format!("sizes {sizes:?} are not supported")),
        },
        (None, None, _) => Err("it has neither scales nor sizes".to_owned()),
    }
}

pub(super) fn depth_to_space(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let (side, order) = block_size_and_order(node)?;
    output_of_tensors(DepthToSpace { block_size: side, order }, vec![node.tensor_input(0)?])
}

pub(super) fn space_to_depth(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let (side, order) = block_size_and_order(node)?;
    output_of_tensors(SpaceToDepth { block_size: side, order }, vec![node.tensor_input(0)?])
}

/// Returns the side of the blocks of positions, and the order of the channels.
fn block_size_and_order(node: &NodeReader<'_>) -> Result<(usize, DepthToSpaceOrder), String> {
    let side = checked_length("blocksize", node.int("blocksize", 0))?;
    match node.text("mode", "DCR").as_str() {
        "DCR" => Ok((side, DepthToSpaceOrder::DepthColumnRow)),
        "CRD" => Ok((side, DepthToSpaceOrder::ColumnRowDepth)),
        other => Err(format!("the mode `{other}` is unknown; it must be DCR or CRD")),
    }
}
