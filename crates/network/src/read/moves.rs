// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators of ONNX that only move values: other shapes, parts, joints and sizes.

use super::made::{Made, one};
use super::node::{NodeReader, from_start, positive, signed};
use crate::element::{Element, Encoding};
use crate::form::{Form, MAX_AXES};
use crate::operator::{
    Concat, Coordinates, Cut, Nearest, Pad, Reshape, Resize, ResizeKind, Size, Slice, Transpose,
};
use crate::tensor::Tensor;
use std::sync::Arc;

/// The largest scale of a Resize is below this; what it makes is limited, too.
const MAX_SCALE: f32 = 65536.0;

pub(super) fn concat(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let values = (0..node.node.input.len()).map(|at| node.value(at)).collect::<Result<_, _>>()?;
    one(Concat { axis: node.int("axis", 1) }, values)
}

pub(super) fn flatten(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axis = node.int("axis", 1);
    let axis = from_start(axis, form.shape().len());
    let axis = usize::try_from(axis)
        .ok()
        .filter(|&axis| axis <= form.shape().len())
        .ok_or("its axis is outside")?;
    let before: usize = form.shape()[..axis].iter().product();
    one(
        Reshape { shape: vec![i64::try_from(before).map_err(|_| "it is too large")?, -1] },
        vec![value],
    )
}

pub(super) fn reshape(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.int("allowzero", 0) != 0 {
        return Err("allowzero is not supported".to_owned());
    }
    let shape = node.ints_of("shape", 1)?.ok_or("it has no shape")?;
    if shape.len() > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    one(Reshape { shape }, vec![node.value(0)?])
}

pub(super) fn squeeze(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axes = axes(node, form.shape().len())?;
    let left = form.shape().iter().enumerate().filter(|(axis, length)| match &axes {
        Some(axes) => !axes.contains(axis),
        None => **length != 1,
    });
    one(Reshape { shape: left.map(|(_, &length)| signed(length)).collect() }, vec![value])
}

pub(super) fn unsqueeze(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let new = node.ints_of("axes", 1)?.ok_or("it has no axes")?.len();
    if form.shape().len() + new > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    let axes = axes(node, form.shape().len() + new)?.ok_or("it has no axes")?;
    let mut old = form.shape().iter();
    let shape = (0..form.shape().len() + new).map(|axis| {
        if axes.contains(&axis) { 1 } else { old.next().map_or(1, |&length| signed(length)) }
    });
    one(Reshape { shape: shape.collect() }, vec![value])
}

/// The axes of `count` that a node names.
pub(super) fn axes(node: &NodeReader<'_>, count: usize) -> Result<Option<Vec<usize>>, String> {
    let distinct = |axes: Vec<usize>| {
        let are_distinct =
            axes.iter().collect::<std::collections::HashSet<_>>().len() == axes.len();
        if are_distinct { Ok(axes) } else { Err("it names an axis twice".to_owned()) }
    };
    let own = |&axis: &i64| {
        let own = from_start(axis, count);
        usize::try_from(own)
            .ok()
            .filter(|&own| own < count)
            .ok_or_else(|| format!("its axis {axis} is outside"))
    };
    let axes = node.ints_of("axes", 1)?.map(|axes| axes.iter().map(own).collect::<Result<_, _>>());
    axes.transpose()?.map(distinct).transpose()
}

pub(super) fn transpose(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let count = (node.forms)(value).shape().len();
    let order = match node.ints("perm") {
        None => (0..count).rev().collect(),
        Some(perm) => perm
            .iter()
            .map(|&axis| usize::try_from(axis).map_err(|_| format!("its perm is {perm:?}")))
            .collect::<Result<_, _>>()?,
    };
    one(Transpose { order }, vec![value])
}

pub(super) fn pad(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let mode = node.text("mode", "constant");
    if mode != "constant" {
        return Err(format!("the mode `{mode}` is not supported, only `constant`"));
    }
    if let Some(axes) = node.constant(3, "axes")?
        && axes.as_integers()? != [0, 1, 2, 3]
    {
        return Err("pads of some axes are not supported, only those of all four".to_owned());
    }
    let pads = node.ints_of("pads", 1)?.ok_or("it has no pads")?;
    let around = match pads.as_slice() {
        &[0, 0, top, left, 0, 0, bottom, right] => [top, left, bottom, right],
        _ => {
            return Err("only pads of rows and columns are supported".to_owned());
        }
    };
    let size = |pad: i64| {
        usize::try_from(pad)
            .ok()
            .filter(|&pad| pad < 1 << 16)
            .ok_or_else(|| format!("a pad of {pad} is not supported"))
    };
    let [top, left, bottom, right] = around;
    let input = node.value(0)?;
    let element = (node.forms)(input).encoding().element;
    let value = match node.constant(2, "value")? {
        Some(value) => value.single(element)?,
        None if element == Element::F32 => {
            Tensor::new(Form::whole(Vec::new()), vec![node.float("value", 0.0)])
        }
        None => Tensor::zeros(Form::whole(Vec::new()).encoded(Encoding::plain(element))),
    };
    one(Pad { around: [size(top)?, size(left)?, size(bottom)?, size(right)?], value }, vec![input])
}

pub(super) fn slice(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let starts = node.ints_of("starts", 1)?.ok_or("it has no starts")?;
    let ends = node.ints_of("ends", 2)?.ok_or("it has no ends")?;
    let axes = node.ints_of("axes", 3)?.unwrap_or_else(|| (0..).take(starts.len()).collect());
    let steps = node.ints_of("steps", 4)?.unwrap_or_else(|| vec![1; starts.len()]);
    if [ends.len(), axes.len(), steps.len()] != [starts.len(); 3] {
        return Err("its starts, ends, axes and steps differ in length".to_owned());
    }
    let cut = |at: usize| -> Result<Cut, String> {
        let step = positive("step", steps[at])?;
        Ok(Cut { axis: axes[at], start: starts[at], end: ends[at], step })
    };
    let cuts = (0..starts.len()).map(cut).collect::<Result<_, _>>()?;
    one(Slice { cuts }, vec![node.value(0)?])
}

pub(super) fn split(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axis = node.int("axis", 0);
    let length = form.shape()[form.axis(axis)?];
    let parts = node.node.output.len().max(1);
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
        let cut = Cut { axis, start, end: start.saturating_add(size), step: 1 };
        start = start.saturating_add(size);
        Made::Operator(Arc::new(Slice { cuts: vec![cut] }), vec![value])
    });
    Ok(slices.collect())
}

pub(super) fn resize(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let coordinates = match node
        .text(
            "coordinate_transformation_mode",
            if node.kind() == "Upsample" { "asymmetric" } else { "half_pixel" },
        )
        .as_str()
    {
        "half_pixel" => Coordinates::HalfPixel,
        "pytorch_half_pixel" => Coordinates::PytorchHalfPixel,
        "align_corners" => Coordinates::AlignCorners,
        "asymmetric" => Coordinates::Asymmetric,
        other => return Err(format!("the coordinates `{other}` are not supported")),
    };
    let nearest = match node
        .text(
            "nearest_mode",
            if node.kind() == "Upsample" { "floor" } else { "round_prefer_floor" },
        )
        .as_str()
    {
        "round_prefer_floor" => Nearest::RoundPreferFloor,
        "round_prefer_ceil" => Nearest::RoundPreferCeil,
        "floor" => Nearest::Floor,
        "ceil" => Nearest::Ceil,
        other => return Err(format!("the mode `{other}` is not supported")),
    };
    let kind = match node.text("mode", "nearest").as_str() {
        "nearest" => ResizeKind::Nearest(nearest),
        "linear" => ResizeKind::Linear,
        other => {
            return Err(format!("the mode `{other}` is not supported, only nearest and linear"));
        }
    };
    if node.int("antialias", 0) != 0 {
        return Err("antialias is not supported".to_owned());
    }
    if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
        return Err("only the keep_aspect_ratio_policy `stretch` is supported".to_owned());
    }
    if node.ints("axes").is_some_and(|axes| axes != [0, 1, 2, 3]) {
        return Err("scales of some axes are not supported, only those of all four".to_owned());
    }
    let value = node.value(0)?;
    let scales_at = if node.kind() == "Upsample" { 1 } else { 2 };
    let scales = node.constant(scales_at, "scales")?.filter(|scales| scales.values.count() > 0);
    let size = match (scales, node.constant(3, "sizes")?) {
        (Some(scales), _) => match *scales.as_floats()? {
            [1.0, 1.0, rows, columns] if rows > 0.0 && columns > 0.0 => {
                if let Some(scale) = [rows, columns].into_iter().find(|&scale| scale >= MAX_SCALE) {
                    return Err(format!(
                        "its scale of {scale} is too large; it must be below {MAX_SCALE}"
                    ));
                }
                Size::Scales([rows, columns])
            }
            ref scales => {
                return Err(format!(
                    "scales {scales:?} are not supported, only those of rows and columns"
                ));
            }
        },
        (None, Some(sizes)) => match *sizes.as_integers()? {
            [1, channels, rows, columns]
                if (node.forms)(value).shape().get(1)
                    == usize::try_from(channels).ok().as_ref() =>
            {
                Size::Sizes([positive("size", rows)?, positive("size", columns)?])
            }
            ref sizes => return Err(format!("sizes {sizes:?} are not supported")),
        },
        (None, None) => return Err("it has neither scales nor sizes".to_owned()),
    };
    one(Resize { kind, coordinates, size }, vec![value])
}
