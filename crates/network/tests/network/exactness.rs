// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recomputed positions suffice: every tensor of every frame has the bits of a dense
//! computation.

use crate::integer_layers::{self, IntegerLayer, integer_layer};
use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::{ExecutionMode, Executor, Mask, Network};
use proptest::prelude::*;

#[derive(Clone, Debug)]
enum RandomLayer {
    Conv {
        channels: usize,
        kernel: [i64; 2],
        strides: [i64; 2],
        dilations: [i64; 2],
        pads: [i64; 4],
    },
    Depthwise {
        kernel: i64,
        stride: i64,
        pads: [i64; 4],
    },
    Grouped,
    Pool {
        max: bool,
        kernel: i64,
        stride: i64,
        pad: i64,
        ceil: bool,
    },
    Relu,
    Sigmoid,
    Residual,
    ConcatBranch {
        up: bool,
    },
    Scale,
    SliceAxis {
        axis: i64,
        start: i64,
        step: i64,
    },
    /// A slice of rows and columns in one node.
    Crop {
        start: [i64; 2],
        step: [i64; 2],
    },
    Pad {
        around: [i64; 4],
    },
    /// A resize by `halves` / 2.
    Resize {
        linear: bool,
        halves: u8,
    },
    Softmax,
    /// A transposition that puts the channels last, and one that puts them first again.
    TransposeAndBack,
    /// A factor per channel that depends on the whole frame.
    Squeeze,
    /// A transposed convolution.
    Transposed {
        channels: usize,
        kernel: i64,
        stride: i64,
        dilation: i64,
        pad: i64,
        more: i64,
    },
    /// A permutation of the channels by way of other shapes.
    Shuffle,
    /// `DepthToSpace` if `up`, and `SpaceToDepth` otherwise.
    DepthBlocks {
        up: bool,
    },
    /// Padding of rows, columns and channels in one of the modes.
    PadModes {
        mode: &'static str,
        pads: [i64; 8],
    },
    ReverseColumns,
    /// A concatenation with a constant channel.
    ConcatConstant,
    /// The difference from the means along some axes.
    Centre {
        axes: Vec<i64>,
    },
    Normal {
        kind: &'static str,
    },
    /// A product of positions with positions, after flattening.
    Attention,
    /// A concatenation of flattened positions.
    ConcatFlat,
    /// A tensor of one channel, broadcast.
    Repeat,
    Where,
    /// The product of a tensor with its sigmoid, which another node takes, too, unless `alone`.
    Gate {
        alone: bool,
    },
    Cubic,
    /// Layers of signed or unsigned 8-bit values.
    Integers {
        signed: bool,
        layers: Vec<IntegerLayer>,
    },
}

/// Returns a 3x3 convolution that keeps the size with stride 1.
fn three_by_three(channels: usize, stride: i64) -> RandomLayer {
    RandomLayer::Conv {
        channels,
        kernel: [3, 3],
        strides: [stride; 2],
        dilations: [1, 1],
        pads: [1; 4],
    }
}

fn layer() -> impl Strategy<Value = RandomLayer> {
    let pads = || prop::array::uniform4(0..3i64);
    let dilation = || prop_oneof![7 => 1..3i64, 1 => Just(9i64)];
    prop_oneof![
        4 => (1..14usize, prop::array::uniform2(1..4i64), prop::array::uniform2(1..4i64), prop::array::uniform2(dilation()), pads())
            .prop_map(|(channels, kernel, strides, dilations, pads)| RandomLayer::Conv { channels, kernel, strides, dilations, pads }),
        2 => (1..4i64, 1..3i64, pads()).prop_map(|(kernel, stride, pads)| RandomLayer::Depthwise { kernel, stride, pads }),
        1 => Just(RandomLayer::Grouped),
        2 => (any::<bool>(), 2..4i64, 1..4i64, 0..2i64, any::<bool>()).prop_map(|(max, kernel, stride, pad, ceil)| RandomLayer::Pool { max, kernel, stride, pad, ceil }),
        2 => Just(RandomLayer::Relu),
        1 => Just(RandomLayer::Sigmoid),
        2 => Just(RandomLayer::Residual),
        2 => any::<bool>().prop_map(|up| RandomLayer::ConcatBranch { up }),
        1 => Just(RandomLayer::Scale),
        1 => (1..4i64, 0..2i64, 1..3i64).prop_map(|(axis, start, step)| RandomLayer::SliceAxis { axis, start, step }),
        1 => (prop::array::uniform2(0..2i64), prop::array::uniform2(1..3i64)).prop_map(|(start, step)| RandomLayer::Crop { start, step }),
        1 => pads().prop_map(|around| RandomLayer::Pad { around }),
        1 => (any::<bool>(), prop_oneof![Just(1u8), Just(3), Just(4)]).prop_map(|(linear, halves)| RandomLayer::Resize { linear, halves }),
        1 => Just(RandomLayer::Softmax),
        1 => Just(RandomLayer::TransposeAndBack),
        1 => Just(RandomLayer::Squeeze),
        2 => (1..6usize, 1..5i64, 1..4i64, 1..3i64, 0..3i64, 0..2i64)
            .prop_map(|(channels, kernel, stride, dilation, pad, more)| RandomLayer::Transposed { channels, kernel, stride, dilation, pad, more }),
        1 => Just(RandomLayer::Shuffle),
        1 => any::<bool>().prop_map(|up| RandomLayer::DepthBlocks { up }),
        1 => (prop::sample::select(vec!["constant", "reflect", "edge", "wrap"]), prop::array::uniform6(-1..3i64))
            .prop_map(|(mode, [a, b, c, d, e, f])| RandomLayer::PadModes { mode, pads: [0, a.max(0), b, c, 0, d.max(0), e, f] }),
        1 => Just(RandomLayer::ReverseColumns),
        1 => Just(RandomLayer::ConcatConstant),
        1 => prop::sample::subsequence(vec![1i64, 2, -1], 1..4).prop_map(|axes| RandomLayer::Centre { axes }),
        1 => prop::sample::select(vec!["InstanceNormalization", "GroupNormalization", "LayerNormalization", "LRN", "LogSoftmax"]).prop_map(|kind| RandomLayer::Normal { kind }),
        1 => Just(RandomLayer::Attention),
        1 => Just(RandomLayer::ConcatFlat),
        1 => Just(RandomLayer::Repeat),
        1 => Just(RandomLayer::Where),
        1 => any::<bool>().prop_map(|alone| RandomLayer::Gate { alone }),
        1 => Just(RandomLayer::Cubic),
        4 => (any::<bool>(), prop::collection::vec(integer_layer(), 1..5)).prop_map(|(signed, layers)| RandomLayer::Integers { signed, layers }),
    ]
}

/// Returns the network of these layers, without those that do not fit. The sizes are computed here
/// independently of the crate.
fn network(channels: usize, [height, width]: [usize; 2], layers: &[RandomLayer]) -> Network {
    let mut model = ModelBuilder::new(&[1, signed(channels), signed(height), signed(width)]);
    let mut previous = LayerOutput {
        name: "picture".to_owned(),
        channels,
        height: signed(height),
        width: signed(width),
    };
    for (at, layer) in layers.iter().enumerate() {
        if let Some(next) = add_layer(&mut model, &previous, layer, at as u64 + 1) {
            previous = next;
        }
    }
    // The last output depends on every position of the last layer.
    let mean = model.node("GlobalAveragePool", &[&previous.name], &[]);
    let flat = model.node("Flatten", &[&mean], &[]);
    model.output(&flat);
    model.read(width, height).unwrap()
}

#[derive(Clone)]
pub(crate) struct LayerOutput {
    pub(crate) name: String,
    pub(crate) channels: usize,
    pub(crate) height: i64,
    pub(crate) width: i64,
}

pub(crate) fn signed(length: usize) -> i64 {
    i64::try_from(length).unwrap()
}

fn add_layer(
    model: &mut ModelBuilder,
    previous: &LayerOutput,
    layer: &RandomLayer,
    seed: u64,
) -> Option<LayerOutput> {
    let LayerOutput { name, channels, height, width } = previous.clone();
    let outputs = |length: i64, kernel: i64, stride: i64, dilation: i64, pads: i64| {
        let room = length + pads - (kernel - 1) * dilation - 1;
        (room >= 0).then(|| room / stride + 1)
    };
    let same_size = |name: String| Some(LayerOutput { name, ..previous.clone() });
    match layer.clone() {
        RandomLayer::Conv { channels: outer, kernel: [h, w], strides, dilations, pads } => {
            let height = outputs(height, h, strides[0], dilations[0], pads[0] + pads[2])?;
            let width = outputs(width, w, strides[1], dilations[1], pads[1] + pads[3])?;
            let count = outer * channels * usize::try_from(h * w).unwrap();
            let weights =
                model.floats(&[signed(outer), signed(channels), h, w], &noise(seed, count));
            let bias = model.floats(&[signed(outer)], &noise(seed + 100, outer));
            let attributes = [
                ("strides", AttributeValue::Ints(strides.to_vec())),
                ("dilations", AttributeValue::Ints(dilations.to_vec())),
                ("pads", AttributeValue::Ints(pads.to_vec())),
            ];
            let name = model.node("Conv", &[&name, &weights, &bias], &attributes);
            Some(LayerOutput { name, channels: outer, height, width })
        }
        RandomLayer::Depthwise { kernel, stride, pads } => {
            let height = outputs(height, kernel, stride, 1, pads[0] + pads[2])?;
            let width = outputs(width, kernel, stride, 1, pads[1] + pads[3])?;
            let weights = model.floats(
                &[signed(channels), 1, kernel, kernel],
                &noise(seed, channels * usize::try_from(kernel * kernel).unwrap()),
            );
            let attributes = [
                ("strides", AttributeValue::Ints(vec![stride; 2])),
                ("pads", AttributeValue::Ints(pads.to_vec())),
                ("group", AttributeValue::Int(signed(channels))),
            ];
            let name = model.node("Conv", &[&name, &weights], &attributes);
            Some(LayerOutput { name, height, width, ..previous.clone() })
        }
        RandomLayer::Grouped => {
            let inner = channels.checked_div(2).filter(|&inner| inner > 1 && channels % 2 == 0)?;
            let weights = model.floats(&[10, signed(inner), 3, 3], &noise(seed, 90 * inner));
            let attributes =
                [("pads", AttributeValue::Ints(vec![1; 4])), ("group", AttributeValue::Int(2))];
            Some(LayerOutput {
                name: model.node("Conv", &[&name, &weights], &attributes),
                channels: 10,
                ..previous.clone()
            })
        }
        RandomLayer::Pool { max, kernel, stride, pad, ceil } => {
            let along = |length: i64| {
                let outputs = outputs(length, kernel, stride, 1, 2 * pad)?;
                let used = (outputs - 1) * stride + kernel;
                Some(
                    outputs
                        + i64::from(
                            ceil && used < length + 2 * pad && outputs * stride < length + pad,
                        ),
                )
            };
            let (height, width) = (along(height)?, along(width)?);
            let attributes = [
                ("kernel_shape", AttributeValue::Ints(vec![kernel; 2])),
                ("strides", AttributeValue::Ints(vec![stride; 2])),
                ("pads", AttributeValue::Ints(vec![pad; 4])),
                ("ceil_mode", AttributeValue::Int(ceil.into())),
                ("count_include_pad", AttributeValue::Int(i64::from(seed.is_multiple_of(2)))),
            ];
            // A maximum has no attribute for counting padding.
            let name = match max {
                true => model.node("MaxPool", &[&name], &attributes[..attributes.len() - 1]),
                false => model.node("AveragePool", &[&name], &attributes),
            };
            Some(LayerOutput { name, height, width, ..previous.clone() })
        }
        RandomLayer::Relu => same_size(model.node("Relu", &[&name], &[])),
        RandomLayer::Sigmoid => same_size(model.node("Sigmoid", &[&name], &[])),
        RandomLayer::Residual => {
            let weights = model.floats(
                &[signed(channels), signed(channels), 3, 3],
                &noise(seed, channels * channels * 9),
            );
            let branch = model.node(
                "Conv",
                &[&name, &weights],
                &[("pads", AttributeValue::Ints(vec![1; 4]))],
            );
            same_size(model.node("Add", &[&name, &branch], &[]))
        }
        RandomLayer::ConcatBranch { up } => {
            let weights = model.floats(&[3, signed(channels), 1, 3], &noise(seed, channels * 9));
            let branch = model.node(
                "Conv",
                &[&name, &weights],
                &[("pads", AttributeValue::Ints(vec![0, 1, 0, 1]))],
            );
            let inputs = if up { [&name, &branch] } else { [&branch, &name] };
            let name = model.node(
                "Concat",
                &inputs.map(String::as_str),
                &[("axis", AttributeValue::Int(if up { 1 } else { -3 }))],
            );
            (channels < 20).then(|| LayerOutput {
                name,
                channels: channels + 3,
                ..previous.clone()
            })
        }
        RandomLayer::Scale => {
            let factor = model.floats(&[1, signed(channels), 1, 1], &noise(seed, channels));
            same_size(model.node("Mul", &[&factor, &name], &[]))
        }
        RandomLayer::SliceAxis { axis, start, step } => {
            let length = [0, signed(channels), height, width][usize::try_from(axis).unwrap()];
            let count = (length - start + step - 1) / step;
            if count < 1 {
                return None;
            }
            let [starts, ends, axes, steps] =
                [start, i64::MAX, axis, step].map(|value| model.ints(&[value]));
            let name = model.node("Slice", &[&name, &starts, &ends, &axes, &steps], &[]);
            let mut next = LayerOutput { name, ..previous.clone() };
            match axis {
                1 => next.channels = usize::try_from(count).unwrap(),
                2 => next.height = count,
                _ => next.width = count,
            }
            Some(next)
        }
        RandomLayer::Crop { start, step } => {
            // The slice ends before the last element.
            let count = |length: i64, at: usize| (length - 1 - start[at] + step[at] - 1) / step[at];
            let (height, width) = (count(height, 0), count(width, 1));
            if height < 1 || width < 1 {
                return None;
            }
            let [starts, ends, axes, steps] =
                [start, [-1, -1], [2, -1], step].map(|values| model.ints(&values));
            let name = model.node("Slice", &[&name, &starts, &ends, &axes, &steps], &[]);
            Some(LayerOutput { name, height, width, ..previous.clone() })
        }
        RandomLayer::Pad { around: [top, left, bottom, right] } => {
            let pads = model.ints(&[0, 0, top, left, 0, 0, bottom, right]);
            let value = model.floats(&[], &[0.25]);
            let name = model.node("Pad", &[&name, &pads, &value], &[]);
            Some(LayerOutput {
                name,
                height: height + top + bottom,
                width: width + left + right,
                ..previous.clone()
            })
        }
        RandomLayer::Resize { linear, halves } => {
            if height * width > 4000 || height < 2 || width < 2 {
                return None;
            }
            let factor = f32::from(halves) / 2.0;
            let scales = model.floats(&[4], &[1.0, 1.0, factor, factor]);
            let mode = ("mode", AttributeValue::Text(if linear { "linear" } else { "nearest" }));
            let coordinates = (
                "coordinate_transformation_mode",
                AttributeValue::Text(if seed.is_multiple_of(2) {
                    "half_pixel"
                } else {
                    "asymmetric"
                }),
            );
            let name = model.node("Resize", &[&name, "", &scales], &[mode, coordinates]);
            let scaled = |length: i64| length * i64::from(halves) / 2;
            Some(LayerOutput {
                name,
                height: scaled(height),
                width: scaled(width),
                ..previous.clone()
            })
        }
        RandomLayer::Softmax => {
            same_size(model.node("Softmax", &[&name], &[("axis", AttributeValue::Int(1))]))
        }
        RandomLayer::TransposeAndBack => {
            let transposed = model.node(
                "Transpose",
                &[&name],
                &[("perm", AttributeValue::Ints(vec![0, 2, 3, 1]))],
            );
            let transposed =
                model.node("LeakyRelu", &[&transposed], &[("alpha", AttributeValue::Float(0.1))]);
            same_size(model.node(
                "Transpose",
                &[&transposed],
                &[("perm", AttributeValue::Ints(vec![0, 3, 1, 2]))],
            ))
        }
        RandomLayer::Integers { signed, layers } => {
            Some(integer_layers::add_block(model, previous, signed, &layers, seed))
        }
        RandomLayer::Transposed { channels: outer, kernel, stride, dilation, pad, more } => {
            let along = |length: i64| {
                let all = (length - 1) * stride + more + (kernel - 1) * dilation + 1 - 2 * pad;
                (all > 0 && all < 60).then_some(all)
            };
            let (height, width) = (along(height)?, along(width)?);
            let count = outer * channels * usize::try_from(kernel * kernel).unwrap();
            let shape = [signed(channels), signed(outer), kernel, kernel];
            let weights = model.floats(&shape, &noise(seed, count));
            let bias = model.floats(&[signed(outer)], &noise(seed + 100, outer));
            let attributes = [
                ("strides", AttributeValue::Ints(vec![stride; 2])),
                ("dilations", AttributeValue::Ints(vec![dilation; 2])),
                ("pads", AttributeValue::Ints(vec![pad; 4])),
                ("output_padding", AttributeValue::Ints(vec![more; 2])),
            ];
            let name = model.node("ConvTranspose", &[&name, &weights, &bias], &attributes);
            Some(LayerOutput { name, channels: outer, height, width })
        }
        RandomLayer::Shuffle => {
            let half = Some(signed(channels / 2)).filter(|half| half * 2 == signed(channels))?;
            let places = height * width;
            let shapes = [vec![half, 2, places], vec![2, -1, half, height, width]];
            let [split, joined] = shapes.map(|shape| model.ints(&shape));
            let split = model.node("Reshape", &[&name, &split], &[]);
            let transposed = model.node(
                "Transpose",
                &[&split],
                &[("perm", AttributeValue::Ints(vec![1, 0, 2]))],
            );
            let joined = model.node("Reshape", &[&transposed, &joined], &[]);
            let index = model.index(1);
            let part =
                model.node("Gather", &[&joined, &index], &[("axis", AttributeValue::Int(0))]);
            Some(LayerOutput { name: part, channels: channels / 2, ..previous.clone() })
        }
        RandomLayer::DepthBlocks { up } => {
            let side = ("blocksize", AttributeValue::Int(2));
            if up {
                let mode = (
                    "mode",
                    AttributeValue::Text(if seed.is_multiple_of(2) { "DCR" } else { "CRD" }),
                );
                let fits = channels % 4 == 0 && height * width < 1000;
                fits.then(|| LayerOutput {
                    name: model.node("DepthToSpace", &[&name], &[side, mode]),
                    channels: channels / 4,
                    height: 2 * height,
                    width: 2 * width,
                })
            } else {
                let fits = height % 2 == 0 && width % 2 == 0 && channels < 20;
                fits.then(|| LayerOutput {
                    name: model.node("SpaceToDepth", &[&name], &[side]),
                    channels: 4 * channels,
                    height: height / 2,
                    width: width / 2,
                })
            }
        }
        RandomLayer::PadModes { mode, pads } => {
            let along = |length: i64, axis: usize| length + pads[axis] + pads[axis + 4];
            let (height, width) = (along(height, 2), along(width, 3));
            let channels = along(signed(channels), 1);
            if height < 1 || width < 1 || channels > 40 {
                return None;
            }
            let pads = model.ints(&pads);
            let name = model.node("Pad", &[&name, &pads], &[("mode", AttributeValue::Text(mode))]);
            Some(LayerOutput { name, channels: usize::try_from(channels).unwrap(), height, width })
        }
        RandomLayer::ReverseColumns => {
            let bounds = [-1, i64::MIN, -1, -1].map(|value| model.ints(&[value]));
            let [starts, ends, axes, steps] = &bounds;
            same_size(model.node("Slice", &[&name, starts, ends, axes, steps], &[]))
        }
        RandomLayer::ConcatConstant => {
            let constant = model.floats(
                &[1, 1, height, width],
                &noise(seed, usize::try_from(height * width).unwrap()),
            );
            let name =
                model.node("Concat", &[&constant, &name], &[("axis", AttributeValue::Int(1))]);
            (channels < 20).then(|| LayerOutput {
                name,
                channels: channels + 1,
                ..previous.clone()
            })
        }
        RandomLayer::Centre { axes } => {
            let axes = model.ints(&axes);
            let mean = model.node("ReduceMean", &[&name, &axes], &[]);
            same_size(model.node("Sub", &[&name, &mean], &[]))
        }
        RandomLayer::Normal { kind } => {
            let groups = if channels.is_multiple_of(2) { 2 } else { 1 };
            let count = match kind {
                "LayerNormalization" => usize::try_from(width).unwrap(),
                _ => channels,
            };
            let scale = model.floats(&[signed(count)], &noise(seed, count));
            let bias = model.floats(&[signed(count)], &noise(seed + 1, count));
            same_size(match kind {
                "LRN" => model.node(
                    kind,
                    &[&name],
                    &[("size", AttributeValue::Int(3)), ("alpha", AttributeValue::Float(0.5))],
                ),
                "LogSoftmax" => model.node(kind, &[&name], &[("axis", AttributeValue::Int(1))]),
                "GroupNormalization" => model.node(
                    kind,
                    &[&name, &scale, &bias],
                    &[("num_groups", AttributeValue::Int(groups))],
                ),
                _ => model.node(kind, &[&name, &scale, &bias], &[]),
            })
        }
        RandomLayer::Attention => {
            if height * width > 400 {
                return None;
            }
            let shape = model.ints(&[1, 0, -1]);
            let flat = model.node("Reshape", &[&name, &shape], &[]);
            let transposed =
                model.node("Transpose", &[&flat], &[("perm", AttributeValue::Ints(vec![0, 2, 1]))]);
            let similarity = model.node("MatMul", &[&transposed, &flat], &[]);
            let shares = model.node("Softmax", &[&similarity], &[]);
            let mixed = model.node("MatMul", &[&shares, &transposed], &[]);
            let transposed = model.node(
                "Transpose",
                &[&mixed],
                &[("perm", AttributeValue::Ints(vec![0, 2, 1]))],
            );
            let shape = model.ints(&[1, -1, height, width]);
            same_size(model.node("Reshape", &[&transposed, &shape], &[]))
        }
        RandomLayer::ConcatFlat => {
            let shape = model.ints(&[1, signed(channels), -1]);
            let flat = model.node("Reshape", &[&name, &shape], &[]);
            let relu = model.node("Relu", &[&flat], &[]);
            let both = model.node("Concat", &[&flat, &relu], &[("axis", AttributeValue::Int(-1))]);
            let shape = model.ints(&[1, signed(channels), 2 * height, width]);
            (height * width < 1000).then(|| LayerOutput {
                name: model.node("Reshape", &[&both, &shape], &[]),
                height: 2 * height,
                ..previous.clone()
            })
        }
        RandomLayer::Repeat => {
            let axes = model.ints(&[1]);
            let largest = model.node("ReduceMax", &[&name, &axes], &[]);
            let shape = model.ints(&[1, 3, height, 1]);
            let name = model.node("Expand", &[&largest, &shape], &[]);
            Some(LayerOutput { name, channels: 3, ..previous.clone() })
        }
        RandomLayer::Where => {
            let limit = model.floats(&[], &[0.125]);
            let is_above = model.node("Greater", &[&name, &limit], &[]);
            let half = model.node("Mul", &[&name, &limit], &[]);
            same_size(model.node("Where", &[&is_above, &name, &half], &[]))
        }
        RandomLayer::Gate { alone } => {
            let gate = model.node("Sigmoid", &[&name], &[]);
            let gated = model.node("Mul", &[&name, &gate], &[]);
            same_size(if alone { gated } else { model.node("Sub", &[&gated, &gate], &[]) })
        }
        RandomLayer::Cubic => {
            if height * width > 1000 || height < 2 || width < 2 {
                return None;
            }
            let scales = model.floats(&[4], &[1.0, 1.0, 1.5, 2.0]);
            let attributes = [
                ("mode", AttributeValue::Text("cubic")),
                ("exclude_outside", AttributeValue::Int(i64::from(seed.is_multiple_of(2)))),
            ];
            let name = model.node("Resize", &[&name, "", &scales], &attributes);
            Some(LayerOutput { name, height: height * 3 / 2, width: 2 * width, ..previous.clone() })
        }
        RandomLayer::Squeeze => {
            let mean = model.node("GlobalAveragePool", &[&name], &[]);
            let gate = model.node("HardSigmoid", &[&mean], &[]);
            same_size(model.node("Mul", &[&name, &gate], &[]))
        }
    }
}

/// Returns frames, each with the mask of the positions at which it may differ from the previous
/// one.
pub(crate) fn masked_clip(
    channels: usize,
    [height, width]: [usize; 2],
    masks: &[Vec<(usize, usize, usize)>],
) -> Vec<(Vec<f32>, Mask)> {
    let mut picture = noise(7, channels * height * width);
    let mut frames = vec![(picture.clone(), Mask::empty(height, width))];
    for (number, blobs) in masks.iter().enumerate() {
        let is_changed = |x: usize, y: usize| {
            blobs.iter().any(|&(left, top, side)| {
                (left..left + side).contains(&x) && (top..top + side).contains(&y)
            })
        };
        let mask = Mask::from_fn(height, width, is_changed);
        let fresh = noise(number as u64 + 50, picture.len());
        for (at, value) in picture.iter_mut().enumerate() {
            // Some pixels of a changed region keep their values.
            if is_changed(at % width, at / width % height) && at % 5 != 0 {
                *value = fresh[at];
            }
        }
        frames.push((picture.clone(), mask));
    }
    frames
}

/// Describes the first tensor of a frame that differs from a dense computation, or returns `None`.
pub(crate) fn first_difference(
    network: &Network,
    mode: ExecutionMode,
    frames: &[(Vec<f32>, Mask)],
) -> Option<String> {
    let (mut dense, mut other) =
        (Executor::new(network, ExecutionMode::Dense), Executor::new(network, mode));
    let mut before: Vec<_> = Vec::new();
    for (number, (picture, mask)) in frames.iter().enumerate() {
        dense.step(picture, mask);
        other.step(picture, mask);
        for value in 0..=network.nodes().len() {
            let what = || {
                value.checked_sub(1).map_or("picture", |node| network.nodes()[node].operator_name())
            };
            let differences = dense.tensor(value).differing_positions(other.tensor(value));
            if !differences.is_empty() {
                return Some(format!("{mode:?}: frame {number}, value {value} ({})", what()));
            }
            // All positions that have changed must be in the mask.
            if let Some(before) = before.get(value)
                && !dense
                    .tensor(value)
                    .differing_positions(before)
                    .is_subset(other.change_mask(value))
            {
                return Some(format!(
                    "{mode:?}: frame {number}, value {value} ({}) changed outside of its mask",
                    what()
                ));
            }
        }
        before = (0..=network.nodes().len()).map(|value| dense.tensor(value).clone()).collect();
    }
    None
}

fn blobs() -> impl Strategy<Value = Vec<Vec<(usize, usize, usize)>>> {
    prop::collection::vec(prop::collection::vec((0..40usize, 0..30usize, 1..7usize), 0..4), 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn recomputed_parts_have_the_bits_of_a_dense_computation(
        channels in prop_oneof![Just(1usize), Just(3)], height in 6..26usize, width in 6..40usize,
        layers in prop::collection::vec(layer(), 1..8), masks in blobs(),
    ) {
        let network = network(channels, [height, width], &layers);
        let frames = masked_clip(channels, [height, width], &masks);
        for mode in [ExecutionMode::Exact, ExecutionMode::Compare, ExecutionMode::Truncate(0.0)] {
            prop_assert_eq!(first_difference(&network, mode, &frames), None);
        }
    }
}

/// Rows of many lengths have few chunks, many chunks, and chunks at borders.
#[test]
fn rows_of_every_length_have_the_bits_of_a_dense_computation() {
    for width in 6..30 {
        let layers = [
            three_by_three(13, 1),
            RandomLayer::Relu,
            three_by_three(37, 2),
            RandomLayer::Residual,
        ];
        let network = network(1, [9, width], &layers);
        let frames = masked_clip(
            1,
            [9, width],
            &[vec![(width / 2, 3, 2)], vec![(0, 0, 1), (width - 1, 8, 1)], vec![(0, 0, 40)]],
        );
        assert_eq!(first_difference(&network, ExecutionMode::Exact, &frames), None, "{width}");
    }
}

/// The negative control of these tests: a mask that misses a changed pixel is detected.
#[test]
fn a_change_outside_of_the_mask_is_found() {
    let layers = [three_by_three(4, 1)];
    let network = network(1, [12, 12], &layers);
    let mut frames = masked_clip(1, [12, 12], &[vec![(3, 3, 4)]]);
    frames[1].1.remove(6, 6);
    assert!(
        first_difference(&network, ExecutionMode::Exact, &frames)
            .unwrap()
            .contains("frame 1, value 0")
    );
}

/// Truncation passes on few changes, so that little is computed, and the output stays close.
#[test]
fn truncation_computes_less_and_stays_close() {
    let layers = [three_by_three(6, 1), RandomLayer::Relu, three_by_three(6, 1)];
    let network = network(1, [20, 20], &layers);
    let full = Mask::full(20, 20);
    let picture = noise(3, 400);
    let shifted: Vec<f32> = picture
        .iter()
        .enumerate()
        .map(|(at, value)| if at == 210 { value + 0.5 } else { value + 0.001 })
        .collect();
    let needed = |mode| {
        let mut executor = Executor::new(&network, mode);
        executor.step(&picture, &full);
        let needed: usize =
            executor.step(&shifted, &full).iter().map(|work| work.needed_positions).sum();
        (needed, executor.tensor(3).real_values().to_vec())
    };
    let ((exact, right), (truncated, near)) =
        (needed(ExecutionMode::Exact), needed(ExecutionMode::Truncate(0.1)));
    assert!(truncated < exact, "{truncated} of {exact}");
    let worst = right.iter().zip(&near).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst > 0.0 && worst < 0.1 * 54.0, "{worst}");
}

/// Limits of 0 are equivalent to a comparison, and equal limits to a truncation. A limit acts only
/// at its own node.
#[test]
fn every_node_has_a_limit_of_its_own() {
    let layers = [three_by_three(6, 1), RandomLayer::Sigmoid, three_by_three(6, 1)];
    let network = network(1, [20, 20], &layers);
    let frames = masked_clip(1, [20, 20], &[vec![(3, 3, 4)], vec![(9, 5, 6)], vec![(3, 3, 4)]]);
    let work = |mut executor: Executor<'_>| -> Vec<Vec<_>> {
        frames.iter().map(|(picture, mask)| executor.step(picture, mask).to_vec()).collect()
    };
    let nodes = network.nodes().len();
    let work_with_limits = |limits: Vec<f32>| work(Executor::with_limits(&network, &limits));
    assert_eq!(
        work_with_limits(vec![0.0; nodes]),
        work(Executor::new(&network, ExecutionMode::Compare))
    );
    assert_eq!(
        work_with_limits(vec![0.2; nodes]),
        work(Executor::new(&network, ExecutionMode::Truncate(0.2)))
    );
    let cut_at = |at: usize| {
        work_with_limits((0..nodes).map(|node| if node == at { 1e9 } else { 0.0 }).collect())
    };
    let all = work_with_limits(vec![0.0; nodes]);
    for at in 0..nodes {
        let (whole, cut) = (&all[1], &cut_at(at)[1]);
        assert_eq!(whole[..at], cut[..at], "{at}");
        assert_eq!(
            (whole[at].needed_positions, 0),
            (cut[at].needed_positions, cut[at].changed_positions),
            "{at}"
        );
    }
}

/// Threads share the rows of large inputs and the channels of small ones. The bits must be the
/// same.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let layers = [
        three_by_three(37, 1),
        RandomLayer::Depthwise { kernel: 3, stride: 1, pads: [1; 4] },
        three_by_three(19, 2),
        RandomLayer::Residual,
    ];
    let network = network(1, [96, 128], &layers);
    let frames = masked_clip(1, [96, 128], &[vec![(3, 3, 40)], vec![(60, 50, 30), (2, 90, 5)]]);
    let values = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut executor = Executor::new(&network, ExecutionMode::Exact);
            for (picture, mask) in &frames {
                executor.step(picture, mask);
            }
            (0..=network.nodes().len())
                .map(|value| executor.tensor(value).clone())
                .collect::<Vec<_>>()
        })
    };
    let single = values(1);
    for threads in [2, 3, 5] {
        for (value, (single, shared)) in single.iter().zip(values(threads)).enumerate() {
            assert!(
                single.differing_positions(&shared).is_empty(),
                "{threads} threads, value {value}"
            );
        }
    }
}

/// Blocks do not overlap, so a part never costs more than a dense computation, however scattered it
/// is.
#[test]
fn a_part_never_costs_more_than_a_dense_computation() {
    let network = network(
        1,
        [31, 70],
        &[three_by_three(5, 1), RandomLayer::Depthwise { kernel: 3, stride: 1, pads: [1; 4] }],
    );
    let (mut dense, mut exact) = (
        Executor::new(&network, ExecutionMode::Dense),
        Executor::new(&network, ExecutionMode::Exact),
    );
    let picture = noise(5, 31 * 70);
    let scattered = Mask::from_fn(31, 70, |x, y| x % 9 == 0 && y % 2 == 0);
    for mask in [Mask::full(31, 70), scattered] {
        let (all, part) = (dense.step(&picture, &mask).to_vec(), exact.step(&picture, &mask));
        for (all, part) in all.iter().zip(part) {
            assert!(
                part.needed_positions <= part.scheduled_positions
                    && part.scheduled_positions <= all.scheduled_positions,
                "{part:?} of {all:?}"
            );
        }
    }
}

/// Flattened positions of several scales have no place in the frame. They are computed if a
/// position on which they depend has changed.
#[test]
fn the_fixed_mode_follows_changes_through_flattened_positions() {
    let mut model = ModelBuilder::new(&[1, 1, 16, 16]);
    let weights = model.floats(&[4, 1, 1, 1], &noise(1, 4));
    let features = model.node("Conv", &["picture", &weights], &[]);
    let shape = model.ints(&[1, 4, -1]);
    let flat = model.node("Reshape", &[&features, &shape], &[]);
    let both = model.node("Concat", &[&flat, &flat], &[("axis", AttributeValue::Int(2))]);
    let shape = model.ints(&[1, 4, 8, 64]);
    let other = model.node("Reshape", &[&both, &shape], &[]);
    let relu = model.node("Relu", &[&other], &[]);
    model.output(&relu);
    let network = model.read(16, 16).unwrap();
    let frames = masked_clip(1, [16, 16], &[vec![(4, 4, 6)]]);
    assert_eq!(first_difference(&network, ExecutionMode::Fixed, &frames), None);
}

/// The fixed mode keeps the values outside of the camera's mask.
#[test]
fn the_fixed_mode_is_wrong_at_borders_only() {
    let layers = [three_by_three(2, 1)];
    let network = network(1, [16, 16], &layers);
    let frames = masked_clip(1, [16, 16], &[vec![(4, 4, 6)]]);
    let (mut dense, mut fixed) = (
        Executor::new(&network, ExecutionMode::Dense),
        Executor::new(&network, ExecutionMode::Fixed),
    );
    for (picture, mask) in &frames {
        dense.step(picture, mask);
        fixed.step(picture, mask);
    }
    let wrong = dense.tensor(1).differing_positions(fixed.tensor(1));
    let is_border = |x: usize, y: usize| {
        (3..=10).contains(&x)
            && (3..=10).contains(&y)
            && !((4..=9).contains(&x) && (4..=9).contains(&y))
    };
    assert!(!wrong.is_empty() && wrong.is_subset(&Mask::from_fn(16, 16, is_border)));
}

/// An activation of a tensor that has a second name does not change the values under the first
/// name.
#[test]
fn an_activation_does_not_change_a_tensor_that_other_nodes_take() {
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    let weights = model.floats(&[1, 1, 1, 1], &[-1.0]);
    let conv = model.node("Conv", &["picture", &weights], &[]);
    let alias = model.node("Identity", &[&conv], &[]);
    let relu = model.node("Relu", &[&alias], &[]);
    let sum = model.node("Add", &[&conv, &relu], &[]);
    model.output(&sum);
    let network = model.read(4, 4).unwrap();
    let mut executor = Executor::new(&network, ExecutionMode::Dense);
    executor.step(&[2.0; 16], &Mask::full(4, 4));
    let &[output] = network.outputs() else { panic!("one output") };
    assert_eq!(*executor.tensor(output).real_values(), [-2.0; 16]);
}

/// Positions on other axes of equal lengths are different positions.
#[test]
fn a_sum_with_its_own_transpose_is_exact() {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = model.floats(&[8, 1, 1, 1], &noise(1, 8));
    let features = model.node("Conv", &["picture", &weights], &[]);
    let order = ("perm", AttributeValue::Ints(vec![0, 2, 3, 1]));
    let transposed = model.node("Transpose", &[&features], &[order]);
    let sum = model.node("Add", &[&features, &transposed], &[]);
    model.output(&sum);
    let network = model.read(8, 8).unwrap();
    let frames = masked_clip(1, [8, 8], &[vec![(5, 2, 1)]]);
    assert_eq!(first_difference(&network, ExecutionMode::Exact, &frames), None);
}

/// Squeeze and excitation with convolutions, as in MobileNetV3, are exact.
#[test]
fn convolutions_of_a_pooled_tensor_are_exact() {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = model.floats(&[6, 1, 3, 3], &noise(1, 54));
    let features =
        model.node("Conv", &["picture", &weights], &[("pads", AttributeValue::Ints(vec![1; 4]))]);
    let mean = model.node("GlobalAveragePool", &[&features], &[]);
    let weights = model.floats(&[6, 6, 1, 1], &noise(2, 36));
    let gate = model.node("Conv", &[&mean, &weights], &[]);
    let gate = model.node("Sigmoid", &[&gate], &[]);
    let scaled = model.node("Mul", &[&features, &gate], &[]);
    model.output(&scaled);
    let network = model.read(8, 8).unwrap();
    let frames = masked_clip(1, [8, 8], &[vec![(5, 2, 1)], vec![]]);
    for mode in [ExecutionMode::Exact, ExecutionMode::Compare] {
        assert_eq!(first_difference(&network, mode, &frames), None);
    }
}
