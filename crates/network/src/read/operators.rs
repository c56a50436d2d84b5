// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of ONNX, and which of ours each becomes.

use super::constant::Constant;
use super::graph::Known;
use super::node::{NodeReader, from_start, positive, signed};
use super::quantized;
use crate::element::{Element, Encoding};
use crate::form::Form;
use crate::network::MAX_AXES;
use crate::operator::{
    Activation, Arithmetic, Binary, Concat, Conv, Coordinates, Cut, Dequantize, Linear, MatMul,
    Nearest, Operator, Pad, Pointwise, Pool, PoolKind, Reduce, Reduction, Reshape, Resize,
    ResizeKind, Scale, Scales, Size, Slice, Softmax, Table, Transpose,
};
use crate::tensor::Tensor;
use foveate_lanes::Level;
use std::sync::Arc;

/// What an output of a node is.
pub(super) enum Made {
    Constant(Constant),
    /// What an input is.
    Same(Known),
    Operator(Arc<dyn Operator>, Vec<usize>),
    /// An activation of a value, which the operator that makes it may apply itself.
    Finish(Activation, usize),
}

type Maker = fn(&NodeReader<'_>) -> Result<Vec<Made>, String>;

/// All operators, in the order of the alphabet.
const OPERATORS: &[(&str, Maker)] = &[
    ("Abs", |node| finish(node, Activation::Abs)),
    ("Add", |node| binary(node, Arithmetic::Add)),
    ("AveragePool", |node| {
        let with_padding = node.int("count_include_pad", 0) != 0;
        one(pool(node, PoolKind::Average { with_padding })?, vec![node.value(0)?])
    }),
    ("BatchNormalization", normalization),
    ("Cast", cast),
    ("Clip", clip),
    ("Concat", concat),
    ("Constant", |_| Err("its value is of a kind that is not supported".to_owned())),
    ("ConstantOfShape", |_| Err("it is supported only for constants".to_owned())),
    ("Conv", conv),
    ("ConvInteger", quantized::conv_integer),
    ("DequantizeLinear", quantized::dequantize),
    ("Div", |node| binary(node, Arithmetic::Div)),
    ("Dropout", dropout),
    ("Elu", |node| finish(node, Activation::Elu { alpha: node.float("alpha", 1.0) })),
    ("Erf", |node| finish(node, Activation::Erf)),
    ("Exp", |node| finish(node, Activation::Exp)),
    ("Flatten", flatten),
    ("Gather", |_| Err("it is supported only for constants".to_owned())),
    ("Gemm", gemm),
    ("GlobalAveragePool", |node| global(node, Reduction::Mean)),
    ("GlobalMaxPool", |node| global(node, Reduction::Max)),
    ("HardSigmoid", |node| {
        finish(
            node,
            Activation::HardSigmoid {
                alpha: node.float("alpha", 0.2),
                beta: node.float("beta", 0.5),
            },
        )
    }),
    ("HardSwish", |node| finish(node, Activation::HardSwish)),
    ("Identity", same),
    ("LeakyRelu", |node| finish(node, Activation::LeakyRelu { alpha: node.float("alpha", 0.01) })),
    ("Log", |node| finish(node, Activation::Log)),
    ("MatMul", matmul),
    ("MatMulInteger", quantized::matmul_integer),
    ("Max", |node| binary(node, Arithmetic::Max)),
    ("MaxPool", |node| one(pool(node, PoolKind::Max)?, vec![node.value(0)?])),
    ("Min", |node| binary(node, Arithmetic::Min)),
    ("Mul", |node| binary(node, Arithmetic::Mul)),
    ("Neg", |node| finish(node, Activation::Neg)),
    ("Pad", pad),
    ("Pow", |node| binary(node, Arithmetic::Pow)),
    ("QLinearConv", quantized::conv),
    ("QLinearMatMul", quantized::matmul),
    ("QuantizeLinear", quantized::quantize),
    ("ReduceMean", reduce_mean),
    ("Relu", relu),
    ("Reshape", reshape),
    ("Resize", resize),
    ("Shape", |_| Err("it has no input".to_owned())),
    ("Sigmoid", |node| finish(node, Activation::Sigmoid)),
    ("Slice", slice),
    ("Softmax", softmax),
    ("Softplus", |node| finish(node, Activation::Softplus)),
    ("Split", split),
    ("Sqrt", |node| finish(node, Activation::Sqrt)),
    ("Squeeze", squeeze),
    ("Sub", |node| binary(node, Arithmetic::Sub)),
    ("Tanh", |node| finish(node, Activation::Tanh)),
    ("Transpose", transpose),
    ("Unsqueeze", unsqueeze),
    ("Upsample", resize),
    ("com.microsoft.QGemm", quantized::gemm),
    ("com.microsoft.QLinearAdd", |node| quantized::binary(node, Arithmetic::Add)),
    ("com.microsoft.QLinearAveragePool", quantized::average_pool),
    ("com.microsoft.QLinearConcat", quantized::concat),
    ("com.microsoft.QLinearGlobalAveragePool", quantized::mean),
    ("com.microsoft.QLinearLeakyRelu", |node| {
        quantized::activation(node, Activation::LeakyRelu { alpha: node.float("alpha", 0.01) })
    }),
    ("com.microsoft.QLinearMul", |node| quantized::binary(node, Arithmetic::Mul)),
    ("com.microsoft.QLinearSigmoid", |node| quantized::activation(node, Activation::Sigmoid)),
];

/// The operators that are supported, in the order of the alphabet; those that are not of ONNX with their domain.
pub fn operators() -> impl Iterator<Item = &'static str> {
    OPERATORS.iter().map(|&(name, _)| name)
}

pub(super) fn is_known(kind: &str) -> bool {
    operators().any(|name| name == kind)
}

/// What the outputs of a node are.
pub(super) fn make(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let (_, maker) = OPERATORS
        .iter()
        .find(|&&(name, _)| name == node.full_kind())
        .expect("the operator is known");
    maker(node)
}

/// An activation as a node of its own.
pub(super) fn pointwise(activation: Activation) -> Arc<dyn Operator> {
    Arc::new(Pointwise(activation))
}

pub(super) fn one(
    operator: impl Operator + 'static,
    inputs: Vec<usize>,
) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Operator(Arc::new(operator), inputs)])
}

fn finish(node: &NodeReader<'_>, activation: Activation) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Finish(activation, node.value(0)?)])
}

fn relu(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    // ONNX knows it for integers with sign.
    match (node.forms)(value).encoding().element {
        Element::I8 => one(Table::of_stored(Element::I8, |stored| stored.max(0)), vec![value]),
        _ => finish(node, Activation::Relu),
    }
}

fn same(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Same(node.input(0).ok_or("it has no input")?.clone())])
}

fn dropout(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let training = node.constant(2, "training_mode")?;
    if training
        .is_some_and(|training| training.as_integers().is_ok_and(|values| values.contains(&1)))
    {
        return Err("it is in training mode".to_owned());
    }
    same(node)
}

fn cast(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let element = |value: usize| (node.forms)(value).encoding().element;
    match node.int("to", 1) {
        1 => match node.input(0) {
            Some(&Known::Value(value)) if element(value) != Element::F32 => {
                one(Dequantize(Scales::one(1.0, 0)), vec![value])
            }
            _ => same(node),
        },
        other => Err(format!(
            "a cast to type {other} is not supported, only one to 1, floating-point values of 32 bits"
        )),
    }
}

fn binary(node: &NodeReader<'_>, kind: Arithmetic) -> Result<Vec<Made>, String> {
    let tensor = |constant: &Constant| -> Result<Tensor, String> {
        Ok(Tensor::new(Form::whole(constant.shape.clone()), constant.as_weights()?.to_vec()))
    };
    match (node.input(0), node.input(1), node.input(2)) {
        (Some(&Known::Value(a)), Some(&Known::Value(b)), None) => {
            one(Binary { kind, constant: None, finish: Activation::Identity }, vec![a, b])
        }
        (Some(Known::Constant(a)), Some(&Known::Value(b)), None) => one(
            Binary { kind, constant: Some((tensor(a)?, true)), finish: Activation::Identity },
            vec![b],
        ),
        (Some(&Known::Value(a)), Some(Known::Constant(b)), None) => one(
            Binary { kind, constant: Some((tensor(b)?, false)), finish: Activation::Identity },
            vec![a],
        ),
        _ => Err("it takes two tensors, not both constant".to_owned()),
    }
}

fn clip(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let element = (node.forms)(value).encoding().element;
    if element.is_byte() {
        let (min, max) = (node.stored(1, "min", element)?, node.stored(2, "max", element)?);
        let within = |stored: i32| {
            let stored = min.map_or(stored, |min| stored.max(min));
            max.map_or(stored, |max| stored.min(max))
        };
        return one(Table::of_stored(element, within), vec![value]);
    }
    let bound = |attribute: &str, input: usize, default: f32| -> Result<f32, String> {
        match node.constant(input, attribute)? {
            Some(constant) => constant
                .as_floats()?
                .first()
                .copied()
                .ok_or_else(|| format!("its {attribute} is empty")),
            None => Ok(node.float(attribute, default)),
        }
    };
    let (min, max) = (bound("min", 1, f32::NEG_INFINITY)?, bound("max", 2, f32::INFINITY)?);
    finish(node, Activation::Clip { min, max })
}

fn conv(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn global(node: &NodeReader<'_>, kind: Reduction) -> Result<Vec<Made>, String> {
    one(Reduce { kind, from: 2, keep: true }, vec![node.value(0)?])
}

fn reduce_mean(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let count = (node.forms)(value).shape().len();
    let keep = node.int("keepdims", 1) != 0;
    let axes = node.ints_of("axes", 1)?.filter(|axes| !axes.is_empty());
    if axes.is_none() && node.int("noop_with_empty_axes", 0) != 0 {
        return same(node);
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

fn normalization(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.int("training_mode", 0) != 0 {
        return Err("it is in training mode".to_owned());
    }
    let of = |at, what| node.wanted(at, what).and_then(Constant::as_weights);
    let epsilon = node.float("epsilon", 1e-5);
    let scale = Scale::normalization(
        of(1, "scale")?,
        of(2, "bias")?,
        of(3, "mean")?,
        of(4, "variance")?,
        epsilon,
    )?;
    one(scale, vec![node.value(0)?])
}

fn concat(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let values = (0..node.node.input.len()).map(|at| node.value(at)).collect::<Result<_, _>>()?;
    one(Concat { axis: node.int("axis", 1) }, values)
}

fn gemm(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn matmul(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let matrix = node.wanted(1, "second matrix")?;
    one(MatMul::new(&matrix.shape, matrix.as_weights()?)?, vec![node.value(0)?])
}

fn flatten(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn reshape(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.int("allowzero", 0) != 0 {
        return Err("allowzero is not supported".to_owned());
    }
    let shape = node.ints_of("shape", 1)?.ok_or("it has no shape")?;
    if shape.len() > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    one(Reshape { shape }, vec![node.value(0)?])
}

fn squeeze(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let form = (node.forms)(value);
    let axes = axes(node, form.shape().len())?;
    let left = form.shape().iter().enumerate().filter(|(axis, length)| match &axes {
        Some(axes) => !axes.contains(axis),
        None => **length != 1,
    });
    one(Reshape { shape: left.map(|(_, &length)| signed(length)).collect() }, vec![value])
}

fn unsqueeze(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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
fn axes(node: &NodeReader<'_>, count: usize) -> Result<Option<Vec<usize>>, String> {
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

fn transpose(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn pad(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn slice(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn split(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn softmax(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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

fn resize(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
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
            [1.0, 1.0, rows, columns]
                if rows > 0.0 && columns > 0.0 && rows < 65536.0 && columns < 65536.0 =>
            {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operators_stand_in_order() {
        assert!(OPERATORS.is_sorted_by_key(|&(name, _)| name));
    }
}
