// SPDX-License-Identifier: MIT OR Apache-2.0
//! Layers of 8-bit values for random networks.

use crate::exactness::{LayerOutput, signed};
use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::onnx::data_type;
use proptest::prelude::*;

/// A layer of 8-bit values.
#[derive(Clone, Debug)]
pub(crate) enum IntegerLayer {
    Conv {
        channels: usize,
        kernel: [i64; 2],
        strides: [i64; 2],
        dilations: [i64; 2],
        pads: [i64; 4],
        signed_weights: bool,
        per_channel: bool,
    },
    Depthwise {
        kernel: i64,
        stride: i64,
        pads: [i64; 4],
    },
    /// A convolution whose sums become floating-point values and are then quantized.
    IntegerSums,
    Residual,
    Gate,
    ConcatBranch,
    Average {
        kernel: i64,
        stride: i64,
        pad: i64,
        with_padding: i64,
    },
    MaxPool,
    LeakyRelu,
    Sigmoid,
    Clip,
    Pad {
        around: [i64; 4],
    },
    ResizeTwice,
    TransposeAndBack,
    /// A slice that takes every second column.
    SliceColumns,
    /// A convolution of floating-point values between two tensors of 8-bit values.
    ThroughFloats,
    Product,
}

pub(crate) fn integer_layer() -> impl Strategy<Value = IntegerLayer> {
    let pads = || prop::array::uniform4(0..3i64);
    let sizes = || prop::array::uniform2(1..4i64);
    prop_oneof![
        6 => ((1..14usize, sizes(), sizes(), prop::array::uniform2(1..3i64)), pads(), any::<bool>(), any::<bool>())
            .prop_map(|((channels, kernel, strides, dilations), pads, signed_weights, per_channel)| {
                IntegerLayer::Conv { channels, kernel, strides, dilations, pads, signed_weights, per_channel }
            }),
        2 => (1..4i64, 1..3i64, pads()).prop_map(|(kernel, stride, pads)| IntegerLayer::Depthwise { kernel, stride, pads }),
        1 => Just(IntegerLayer::IntegerSums),
        2 => Just(IntegerLayer::Residual),
        1 => Just(IntegerLayer::Gate),
        1 => Just(IntegerLayer::ConcatBranch),
        1 => (2..4i64, 1..3i64, 0..2i64, 0..2i64).prop_map(|(kernel, stride, pad, with_padding)| IntegerLayer::Average { kernel, stride, pad, with_padding }),
        1 => Just(IntegerLayer::MaxPool),
        1 => Just(IntegerLayer::LeakyRelu),
        1 => Just(IntegerLayer::Sigmoid),
        1 => Just(IntegerLayer::Clip),
        1 => pads().prop_map(|around| IntegerLayer::Pad { around }),
        1 => Just(IntegerLayer::ResizeTwice),
        1 => Just(IntegerLayer::TransposeAndBack),
        1 => Just(IntegerLayer::SliceColumns),
        1 => Just(IntegerLayer::ThroughFloats),
        1 => Just(IntegerLayer::Product),
    ]
}

/// Returns pseudo-random integers in a range.
pub(crate) fn integers(seed: u64, count: usize, range: std::ops::RangeInclusive<i32>) -> Vec<i32> {
    let (low, high) = (f64::from(*range.start()), f64::from(*range.end()));
    let place = |value: f32| low + (f64::from(value) + 1.0) / 2.0 * (high - low + 0.999);
    #[allow(clippy::cast_possible_truncation, reason = "it is within the range")]
    let whole = |value: f32| place(value).floor() as i32;
    noise(seed, count).into_iter().map(whole).collect()
}

/// The names of the constants of a tensor of 8-bit values: its scale and its zero point.
#[derive(Clone)]
struct QuantizationConstants {
    scale: String,
    zero_point: String,
    /// The element type of ONNX.
    kind: i32,
}

impl QuantizationConstants {
    fn new(model: &mut ModelBuilder, is_signed: bool, scale: f32, seed: u64) -> Self {
        let kind = if is_signed { data_type::INT8 } else { data_type::UINT8 };
        let range = if is_signed { -20..=20 } else { 100..=150 };
        let zero = integers(seed + 900, 1, range);
        Self { scale: model.floats(&[], &[scale]), zero_point: model.typed(kind, &[], &zero), kind }
    }
}

/// Returns the names of weights, their scale and their zero point, as inputs of a node.
fn weights(
    model: &mut ModelBuilder,
    shape: &[i64],
    is_signed: bool,
    per_channel: bool,
    seed: u64,
) -> [String; 3] {
    let count: i64 = shape.iter().product();
    let (kind, range) =
        if is_signed { (data_type::INT8, -127..=127) } else { (data_type::UINT8, 0..=255) };
    let values = integers(seed, usize::try_from(count).unwrap(), range);
    let channels = if per_channel { usize::try_from(shape[0]).unwrap() } else { 1 };
    let scales: Vec<f32> =
        noise(seed + 1, channels).iter().map(|value| (value + 1.5) / 1000.0).collect();
    let zeros = if is_signed { vec![0; channels] } else { integers(seed + 2, channels, 120..=136) };
    let dims: &[i64] = if per_channel { &shape[..1] } else { &[] };
    [
        model.typed(kind, shape, &values),
        model.floats(dims, &scales),
        model.typed(kind, dims, &zeros),
    ]
}

/// Adds a block: quantization, the layers that fit, and dequantization.
pub(crate) fn add_block(
    model: &mut ModelBuilder,
    now: &LayerOutput,
    is_signed: bool,
    layers: &[IntegerLayer],
    seed: u64,
) -> LayerOutput {
    let first = QuantizationConstants::new(model, is_signed, 1.0 / 64.0, seed);
    let name = model.node("QuantizeLinear", &[&now.name, &first.scale, &first.zero_point], &[]);
    let mut block =
        QuantizedTensor { state: LayerOutput { name, ..now.clone() }, bytes: first, is_signed };
    for (at, layer) in layers.iter().enumerate() {
        if let Some(next) = block.add(model, layer, seed * 40 + at as u64) {
            block = next;
        }
    }
    let QuantizedTensor { state, bytes, .. } = block;
    let name = model.node("DequantizeLinear", &[&state.name, &bytes.scale, &bytes.zero_point], &[]);
    LayerOutput { name, ..state }
}

/// A tensor of 8-bit values.
#[derive(Clone)]
struct QuantizedTensor {
    state: LayerOutput,
    bytes: QuantizationConstants,
    is_signed: bool,
}

impl QuantizedTensor {
    /// The inputs of this tensor for operators of onnxruntime: values, scale and zero point.
    fn inputs(&self) -> [&str; 3] {
        [&self.state.name, &self.bytes.scale, &self.bytes.zero_point]
    }

    fn with_name(&self, name: String, bytes: &QuantizationConstants) -> Option<Self> {
        let state = LayerOutput { name, ..self.state.clone() };
        Some(Self { state, bytes: bytes.clone(), ..self.clone() })
    }

    /// Returns a tensor with the same scale and another height and width.
    fn with_size(&self, name: String, height: i64, width: i64) -> Option<Self> {
        let state = LayerOutput { name, height, width, ..self.state.clone() };
        (height > 0 && width > 0).then(|| Self { state, ..self.clone() })
    }

    fn conv(
        &self,
        model: &mut ModelBuilder,
        weights: &[String; 3],
        to: &QuantizationConstants,
        attributes: &[(&str, AttributeValue)],
        bias: Option<&str>,
    ) -> String {
        let mut inputs = self.inputs().to_vec();
        inputs.extend(weights.iter().map(String::as_str));
        inputs.extend([to.scale.as_str(), to.zero_point.as_str()]);
        inputs.extend(bias);
        model.node("QLinearConv", &inputs, attributes)
    }

    fn add(&self, model: &mut ModelBuilder, layer: &IntegerLayer, seed: u64) -> Option<Self> {
        let LayerOutput { name, channels, height, width } = self.state.clone();
        let outputs = |length: i64, kernel: i64, stride: i64, dilation: i64, pads: i64| {
            let room = length + pads - (kernel - 1) * dilation - 1;
            (room >= 0).then(|| room / stride + 1)
        };
        let to = QuantizationConstants::new(model, self.is_signed, 1.0 / 20.0, seed);
        let around = ("pads", AttributeValue::Ints(vec![1; 4]));
        match layer.clone() {
            IntegerLayer::Conv {
                channels: outer,
                kernel: [h, w],
                strides,
                dilations,
                pads,
                signed_weights,
                per_channel,
            } => {
                let height = outputs(height, h, strides[0], dilations[0], pads[0] + pads[2])?;
                let width = outputs(width, w, strides[1], dilations[1], pads[1] + pads[3])?;
                let shape = [signed(outer), signed(channels), h, w];
                let weights = weights(model, &shape, signed_weights, per_channel, seed);
                let bias = integers(seed + 7, outer, -2000..=2000);
                let bias = model.typed(data_type::INT32, &[signed(outer)], &bias);
                let attributes = [
                    ("strides", AttributeValue::Ints(strides.to_vec())),
                    ("dilations", AttributeValue::Ints(dilations.to_vec())),
                    ("pads", AttributeValue::Ints(pads.to_vec())),
                ];
                let name = self.conv(model, &weights, &to, &attributes, Some(&bias));
                let state = LayerOutput { name, channels: outer, height, width };
                Some(Self { state, bytes: to, ..self.clone() })
            }
            IntegerLayer::Depthwise { kernel, stride, pads } => {
                let height = outputs(height, kernel, stride, 1, pads[0] + pads[2])?;
                let width = outputs(width, kernel, stride, 1, pads[1] + pads[3])?;
                let shape = [signed(channels), 1, kernel, kernel];
                let weights = weights(model, &shape, false, true, seed);
                let attributes = [
                    ("strides", AttributeValue::Ints(vec![stride; 2])),
                    ("pads", AttributeValue::Ints(pads.to_vec())),
                    ("group", AttributeValue::Int(signed(channels))),
                ];
                let name = self.conv(model, &weights, &to, &attributes, None);
                let state = LayerOutput { name, channels, height, width };
                Some(Self { state, bytes: to, ..self.clone() })
            }
            IntegerLayer::IntegerSums => {
                let shape = [signed(channels), signed(channels), 3, 3];
                let [values, _, zero] = weights(model, &shape, true, false, seed);
                let sums = model.node(
                    "ConvInteger",
                    &[&name, &values, &self.bytes.zero_point, &zero],
                    &[around],
                );
                let sums = model.node("Cast", &[&sums], &[("to", AttributeValue::Int(1))]);
                let scale = model.floats(&[], &[1.0 / 4000.0]);
                let scaled = model.node("Mul", &[&sums, &scale], &[]);
                let name = model.node("QuantizeLinear", &[&scaled, &to.scale, &to.zero_point], &[]);
                self.with_name(name, &to)
            }
            IntegerLayer::Residual => {
                let shape = [signed(channels), signed(channels), 3, 3];
                let weights = weights(model, &shape, true, true, seed);
                let branch = self.conv(model, &weights, &to, &[around], None);
                let sum = QuantizationConstants::new(model, self.is_signed, 1.0 / 15.0, seed + 1);
                let inputs = [
                    &branch,
                    &to.scale,
                    &to.zero_point,
                    &name,
                    &self.bytes.scale,
                    &self.bytes.zero_point,
                    &sum.scale,
                    &sum.zero_point,
                ];
                let name = model.node("com.microsoft.QLinearAdd", &inputs.map(String::as_str), &[]);
                self.with_name(name, &sum)
            }
            IntegerLayer::Gate => {
                let inputs = [self.inputs().as_slice(), &[&to.scale, &to.zero_point]].concat();
                let mean = model.node("com.microsoft.QLinearGlobalAveragePool", &inputs, &[]);
                let product =
                    QuantizationConstants::new(model, self.is_signed, 1.0 / 30.0, seed + 1);
                let inputs = [
                    self.inputs().as_slice(),
                    &[&mean, &to.scale, &to.zero_point, &product.scale, &product.zero_point],
                ]
                .concat();
                let name = model.node("com.microsoft.QLinearMul", &inputs, &[]);
                self.with_name(name, &product)
            }
            IntegerLayer::ConcatBranch => {
                let shape = [3, signed(channels), 1, 3];
                let weights = weights(model, &shape, true, true, seed);
                let pads = ("pads", AttributeValue::Ints(vec![0, 1, 0, 1]));
                let branch = self.conv(model, &weights, &to, &[pads], None);
                let both = QuantizationConstants::new(model, self.is_signed, 1.0 / 40.0, seed + 1);
                let inputs = [
                    &[both.scale.as_str(), &both.zero_point, &branch, &to.scale, &to.zero_point],
                    self.inputs().as_slice(),
                ]
                .concat();
                let name = model.node(
                    "com.microsoft.QLinearConcat",
                    &inputs,
                    &[("axis", AttributeValue::Int(1))],
                );
                let state = LayerOutput { name, channels: channels + 3, ..self.state.clone() };
                (channels < 20).then(|| Self { state, bytes: both, ..self.clone() })
            }
            IntegerLayer::Average { kernel, stride, pad, with_padding } => {
                let along = |length| outputs(length, kernel, stride, 1, 2 * pad);
                let (height, width) = (along(height)?, along(width)?);
                let attributes = [
                    ("kernel_shape", AttributeValue::Ints(vec![kernel; 2])),
                    ("strides", AttributeValue::Ints(vec![stride; 2])),
                    ("pads", AttributeValue::Ints(vec![pad; 4])),
                    ("count_include_pad", AttributeValue::Int(with_padding)),
                ];
                let inputs = [self.inputs().as_slice(), &[&to.scale, &to.zero_point]].concat();
                let name = model.node("com.microsoft.QLinearAveragePool", &inputs, &attributes);
                self.with_name(name.clone(), &to)?.with_size(name, height, width)
            }
            IntegerLayer::MaxPool => {
                let attributes = [("kernel_shape", AttributeValue::Ints(vec![3; 2])), around];
                self.with_name(model.node("MaxPool", &[&name], &attributes), &self.bytes)
            }
            IntegerLayer::LeakyRelu => {
                let inputs = [self.inputs().as_slice(), &[&to.scale, &to.zero_point]].concat();
                let alpha = [("alpha", AttributeValue::Float(0.1))];
                self.with_name(model.node("com.microsoft.QLinearLeakyRelu", &inputs, &alpha), &to)
            }
            IntegerLayer::Sigmoid => {
                let inputs = [self.inputs().as_slice(), &[&to.scale, &to.zero_point]].concat();
                self.with_name(model.node("com.microsoft.QLinearSigmoid", &inputs, &[]), &to)
            }
            IntegerLayer::Clip => {
                let name = if self.is_signed {
                    model.node("Relu", &[&name], &[])
                } else {
                    let [min, max] =
                        [90, 160].map(|bound| model.typed(self.bytes.kind, &[], &[bound]));
                    model.node("Clip", &[&name, &min, &max], &[])
                };
                self.with_name(name, &self.bytes)
            }
            IntegerLayer::Pad { around: [top, left, bottom, right] } => {
                let pads = model.ints(&[0, 0, top, left, 0, 0, bottom, right]);
                let name = model.node("Pad", &[&name, &pads, &self.bytes.zero_point], &[]);
                self.with_size(name, height + top + bottom, width + left + right)
            }
            IntegerLayer::ResizeTwice => {
                if height * width > 2000 {
                    return None;
                }
                let scales = model.floats(&[4], &[1.0, 1.0, 2.0, 2.0]);
                let name = model.node("Resize", &[&name, "", &scales], &[]);
                self.with_size(name, height * 2, width * 2)
            }
            IntegerLayer::TransposeAndBack => {
                let order = |order: &[i64]| [("perm", AttributeValue::Ints(order.to_vec()))];
                let turned = model.node("Transpose", &[&name], &order(&[0, 2, 3, 1]));
                self.with_name(
                    model.node("Transpose", &[&turned], &order(&[0, 3, 1, 2])),
                    &self.bytes,
                )
            }
            IntegerLayer::SliceColumns => {
                let [starts, ends, axes, steps] =
                    [0, i64::MAX, 3, 2].map(|value| model.ints(&[value]));
                let name = model.node("Slice", &[&name, &starts, &ends, &axes, &steps], &[]);
                self.with_size(name, height, (width + 1) / 2)
            }
            IntegerLayer::ThroughFloats => {
                let floats = model.node("DequantizeLinear", &self.inputs(), &[]);
                let shape = [signed(channels), signed(channels), 3, 3];
                let [values, scales, zeros] = weights(model, &shape, true, true, seed);
                let axis = [("axis", AttributeValue::Int(0))];
                let weights = model.node("DequantizeLinear", &[&values, &scales, &zeros], &axis);
                let floats = model.node("Conv", &[&floats, &weights], &[around]);
                let floats = model.node("Relu", &[&floats], &[]);
                let name = model.node("QuantizeLinear", &[&floats, &to.scale, &to.zero_point], &[]);
                self.with_name(name, &to)
            }
            IntegerLayer::Product => {
                let matrix = weights(model, &[width, 5], true, false, seed);
                let inputs = [
                    self.inputs().as_slice(),
                    &matrix.each_ref().map(String::as_str),
                    &[&to.scale, &to.zero_point],
                ]
                .concat();
                let name = model.node("QLinearMatMul", &inputs, &[]);
                // The last axis is no longer a position, so no layer may follow that needs one.
                model.output(&name);
                None
            }
        }
    }
}
