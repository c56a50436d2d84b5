// SPDX-License-Identifier: MIT OR Apache-2.0
//! Models that are damaged, hostile or not supported are rejected with a message of one line that
//! names the problem.

use crate::exactness::signed;
use crate::model::{AttributeValue, ModelBuilder};
use foveate_network::{
    FrameSize, Network,
    onnx::{FunctionProto, ModelProto, data_type},
};
use proptest::prelude::*;
use prost::Message as _;
use std::path::Path;

fn refusal(model: ModelBuilder) -> String {
    model.read(8, 8).unwrap_err().to_string()
}

fn one_node(kind: &str, attributes: &[(&str, AttributeValue)]) -> ModelBuilder {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let output = model.node(kind, &["picture"], attributes);
    model.output(&output);
    model
}

#[test]
fn an_unsupported_operator_is_reported_with_its_node() {
    assert_eq!(
        refusal(one_node("Einsum", &[])),
        "node `Einsum1` has the operator `Einsum`, which is not supported; `foveate infer --check MODEL` lists all such nodes"
    );
    let mut model = one_node("Relu", &[]);
    model.graph.node[0].domain = Some("com.example".to_owned());
    assert!(refusal(model).contains("`com.example.Relu`"));
}

#[test]
fn operators_that_an_export_can_do_without_are_named_with_the_way() {
    for kind in ["TopK", "NonMaxSuppression", "EfficientNMS_TRT"] {
        let said = refusal(one_node(kind, &[]));
        assert!(said.contains("`nms=False`") && said.contains("extract_model"), "{said}");
    }
    let mut model = one_node("Block", &[]);
    model.graph.node[0].domain = Some("own".to_owned());
    let block = FunctionProto { name: Some("Block".to_owned()), domain: Some("own".to_owned()) };
    let mut decoded = ModelProto::decode(&model.bytes()[..]).unwrap();
    decoded.functions = vec![block];
    let size = FrameSize { width: 8, height: 8 };
    let read = Network::parse(&decoded.encode_to_vec(), Path::new("test.onnx"), size);
    let said = read.unwrap_err().to_string();
    assert!(said.contains("`own.Block`") && said.contains("inline_local_functions"), "{said}");
}

#[test]
fn pictures_of_another_size_are_refused_with_the_right_size() {
    let mut model = ModelBuilder::new(&[1, 3, 224, 224]);
    let output = model.node("Relu", &["picture"], &[]);
    model.output(&output);
    assert_eq!(
        refusal(model),
        "the network takes frames of 224x224 pixels, but these frames have 8x8; give --resize 224x224, or --framing letterbox to scale behind the camera"
    );
}

#[test]
fn impossible_models_are_refused() {
    let mut of_weights = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = of_weights.floats(&[1, 1, 3, 3], &[0.5; 4]);
    of_weights.node("Conv", &["picture", &weights], &[]);
    let mut cycle = ModelBuilder::new(&[1, 1, 8, 8]);
    cycle.node("Add", &["picture", "value2"], &[]);
    cycle.node("Relu", &["value1"], &[]);
    let mut huge = ModelBuilder::new(&[1, 1, 8, 8]);
    let pads = huge.ints(&[0, 0, 65535, 65535, 0, 0, 65535, 65535]);
    huge.node("Pad", &["picture", &pads], &[]);
    let mut claims = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = claims.floats(&[1 << 40, 1 << 40, 3, 3], &[]);
    claims.node("Conv", &["picture", &weights], &[]);
    let mut kernel = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = kernel.floats(&[1, 1, 9, 9], &[0.5; 81]);
    kernel.node("Conv", &["picture", &weights], &[]);
    let mut twice = one_node("Relu", &[]);
    let name = twice.node("Abs", &["value1"], &[]);
    twice.graph.node[1].output = vec!["value1".to_owned()];
    twice.output(&name);
    let mut of_constant = one_node("Relu", &[]);
    let constant = of_constant.floats(&[1], &[1.0]);
    of_constant.graph.node[0].output = vec![constant];
    let two = {
        let mut model = one_node("Relu", &[]);
        let other = ModelBuilder::new(&[1, 1, 8, 8]);
        model.graph.input.push({
            let mut input = other.graph.input[0].clone();
            input.name = Some("second".to_owned());
            input
        });
        model
    };
    let cases: [(ModelBuilder, &str); 13] = [
        (of_weights, "it has 4 values, but the shape [1, 1, 3, 3]"),
        (cycle, "no earlier node makes its input `value2`"),
        (twice, "its output `value1` has the name of another tensor"),
        (of_constant, "has the name of another tensor"),
        (huge, "values"),
        (claims, "has 0 values, but the shape"),
        (kernel, "its window of 9 is larger than its input, 8 with padding"),
        (two, "it must have one input, the frame, but it has 2 (picture, second)"),
        (ModelBuilder::new(&[1, 1, 8, 8]), "it has no output"),
        (ModelBuilder::new(&[1, 1, 8]), "but it has 3 axes"),
        (ModelBuilder::new(&[4, 1, 8, 8]), "but it takes a batch of 4"),
        (
            one_node("MaxPool", &[("kernel_shape", AttributeValue::Ints(vec![0, 2]))]),
            "its kernel_shape is 0; it must be 1 to 65535",
        ),
        (
            one_node(
                "MaxPool",
                &[
                    ("kernel_shape", AttributeValue::Ints(vec![2, 2])),
                    ("auto_pad", AttributeValue::Text("SAME")),
                ],
            ),
            "its auto_pad is `SAME`",
        ),
    ];
    for (model, expected) in cases {
        let refusal = refusal(model);
        assert!(refusal.contains(expected) && !refusal.contains('\n'), "{refusal} for {expected}");
    }
}

#[test]
fn a_length_that_no_picture_has_is_not_an_open_one() {
    let lengths = |shape: [Option<i64>; 4]| {
        let mut model = one_node("Relu", &[]);
        let kind = model.graph.input[0].r#type.as_mut().unwrap().tensor_type.as_mut().unwrap();
        for (dim, length) in kind.shape.as_mut().unwrap().dim.iter_mut().zip(shape) {
            dim.dim_value = length;
        }
        model.read(8, 8).map(|_| ()).map_err(|error| error.to_string())
    };
    for (axis, length) in (0..4).flat_map(|axis| [0, -2, i64::MIN].map(|length| (axis, length))) {
        let mut shape = [Some(1), Some(1), Some(8), Some(8)];
        shape[axis] = Some(length);
        let refusal = lengths(shape).unwrap_err();
        let expected = format!("its axis {axis} has the length {length}; lengths are 1 and more");
        assert!(refusal.contains(&expected) && !refusal.contains('\n'), "{refusal}");
    }
    assert_eq!(lengths([None, Some(1), None, None]), Ok(()));
    // Some exporters write an open length as -1.
    assert_eq!(lengths([Some(-1), Some(1), Some(8), Some(8)]), Ok(()));
    assert_eq!(lengths([Some(-1), Some(1), Some(-1), Some(-1)]), Ok(()));
    assert!(
        lengths([Some(1), Some(-1), None, None])
            .unwrap_err()
            .contains("number of channels is not given")
    );
}

/// Models are rejected that would be computed differently from the standard, or that would take the
/// memory of the machine.
#[test]
fn models_that_differ_from_the_standard_or_are_huge_are_refused() {
    let with = |kind: &str, constants: &[&[i64]], attributes: &[(&str, AttributeValue)]| {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let names: Vec<String> = constants.iter().map(|values| model.ints(values)).collect();
        let inputs = std::iter::once("picture").chain(names.iter().map(String::as_str));
        let output = model.node(kind, &inputs.collect::<Vec<_>>(), attributes);
        model.output(&output);
        refusal(model)
    };
    let empty = {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let weights = model.floats(&[0, 1 << 62], &[]);
        let flat = model.node("Flatten", &["picture"], &[]);
        model.node("Gemm", &[&flat, &weights], &[]);
        refusal(model)
    };
    let doubled = {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let mut name = model.ints(&[1]);
        for _ in 0..40 {
            name = model.node("Concat", &[&name, &name], &[("axis", AttributeValue::Int(0))]);
        }
        model.output("picture");
        refusal(model)
    };
    let sliced = {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let shape = model.node("Shape", &["picture"], &[]);
        let bounds: Vec<String> = [0, 4, 0, 0].iter().map(|&value| model.ints(&[value])).collect();
        let inputs: Vec<&str> =
            std::iter::once(shape.as_str()).chain(bounds.iter().map(String::as_str)).collect();
        model.node("Slice", &inputs, &[]);
        refusal(model)
    };
    let bytes = {
        let mut model = one_node("Relu", &[]);
        let kind = model.graph.input[0].r#type.as_mut().unwrap().tensor_type.as_mut().unwrap();
        kind.elem_type = Some(2);
        refusal(model)
    };
    let scaled = |scales: [f32; 4]| {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let scales = model.floats(&[4], &scales);
        let output = model.node("Resize", &["picture", "", &scales], &[]);
        model.output(&output);
        refusal(model)
    };
    let long = {
        let mut model = one_node("Einsum", &[]);
        model.graph.node[0].name = Some("line\nline ".repeat(100));
        refusal(model)
    };
    let cases = [
        (empty, "a constant of weights is empty"),
        (doubled, "all computed constants together have at most 1 GiB"),
        (sliced, "its step is 0"),
        (bytes, "but it is of UINT8"),
        (scaled([1.0, 1.0, 2.0, 1e6]), "its scale of 1000000 is too large; it must be below 65536"),
        (scaled([1.0, 2.0, 2.0, 2.0]), "are not supported, only those of rows and columns"),
        (long, "lineline lineline"),
        (with("Unsqueeze", &[&[0; 9]], &[]), "more than 8 axes"),
        (with("Unsqueeze", &[&[0, 0]], &[]), "it names an axis twice"),
        (with("Reshape", &[&[1, 1, 1, 1, 1, 1, 1, 1, -1]], &[]), "more than 8 axes"),
        (
            with("Split", &[&[5, 4]], &[("axis", AttributeValue::Int(2))]),
            "8 elements cannot be split",
        ),
        (with("Slice", &[&[0, 0], &[4, 4], &[2, -2]], &[]), "its axis 2 is cut twice"),
        (with("Slice", &[&[0, 0], &[4], &[2, 3]], &[]), "differ in length"),
        (with("ReduceMean", &[&[4]], &[]), "its axis 4 is outside"),
        (
            with("Reshape", &[&[0, -1]], &[("allowzero", AttributeValue::Int(1))]),
            "its shape [0, -1] holds a 0 and allowzero is 1, so that its output is empty",
        ),
    ];
    for (refusal, expected) in cases {
        assert!(
            refusal.contains(expected) && !refusal.contains('\n') && refusal.len() < 800,
            "{refusal} for {expected}"
        );
    }
}

/// Quantized networks that are invalid or not supported are rejected.
#[test]
fn invalid_quantized_networks_are_refused() {
    // The closure builds a quantized convolution whose inputs a test case may change.
    let conv = |change: &dyn Fn(&mut ModelBuilder, &mut Vec<String>)| {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let (scale, zero) = (model.floats(&[], &[0.5]), model.typed(data_type::UINT8, &[], &[3]));
        let x = model.node("QuantizeLinear", &["picture", &scale, &zero], &[]);
        let weights = model.typed(data_type::INT8, &[2, 1, 1, 1], &[1, 2]);
        let none = model.typed(data_type::INT8, &[], &[0]);
        let mut inputs =
            [&x, &scale, &zero, &weights, &scale, &none, &scale, &zero].map(Clone::clone).to_vec();
        change(&mut model, &mut inputs);
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        let output = model.node("QLinearConv", &inputs, &[]);
        model.output(&output);
        refusal(model)
    };
    let of_scale = |values: &'static [f32]| {
        conv(&|model, inputs| inputs[4] = model.floats(&[signed(values.len())], values))
    };
    let of_zero = |data_type, values: &'static [i32]| {
        conv(&|model, inputs| inputs[2] = model.typed(data_type, &[signed(values.len())], values))
    };
    let alone = |kind: &str,
                 rest: &dyn Fn(&mut ModelBuilder) -> Vec<String>,
                 attributes: &[(&str, AttributeValue)]| {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let rest = rest(&mut model);
        let inputs = std::iter::once("picture").chain(rest.iter().map(String::as_str));
        let output = model.node(kind, &inputs.collect::<Vec<_>>(), attributes);
        model.output(&output);
        refusal(model)
    };
    let to = |kind, value: i32| {
        move |model: &mut ModelBuilder| {
            vec![model.floats(&[], &[1.0]), model.typed(kind, &[], &[value])]
        }
    };
    let after = |kind: &str, attributes: &[(&str, AttributeValue)]| {
        let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
        let scale = model.floats(&[], &[1.0]);
        let x = model.node("QuantizeLinear", &["picture", &scale], &[]);
        // Operators of onnxruntime take scales, too.
        let inputs = [x.as_str(), &scale, "", &scale];
        let count = if kind.starts_with("com.microsoft.") { 4 } else { 1 };
        let output = model.node(kind, &inputs[..count], attributes);
        model.output(&output);
        refusal(model)
    };
    let cases = [
        (of_scale(&[0.0]), "its w_scale is 0; it must be more than 0"),
        (of_scale(&[1.0, -1.0]), "its w_scale is -1; it must be more than 0"),
        (of_scale(&[f32::NAN]), "its w_scale is NaN"),
        (of_scale(&[f32::INFINITY]), "its w_scale is inf"),
        (of_scale(&[1.0; 3]), "its w_scale has 3 values; it must have 1 or 2"),
        (of_zero(data_type::UINT8, &[256]), "its x_zero_point is 256; it must be 0 to 255"),
        (of_zero(data_type::INT8, &[0]), "its x_zero_point must have 8-bit integers without sign"),
        (of_zero(data_type::UINT8, &[0, 0]), "its x_zero_point has 2 values; it must have 1"),
        (
            conv(&|model, inputs| inputs[3] = model.typed(data_type::INT8, &[1, 1, 1, 1], &[200])),
            "a weight of 200 is outside of its 8 bits, -128 to 127",
        ),
        (
            conv(&|model, inputs| {
                inputs[3] = model.typed(data_type::INT8, &[2, 1, 1, 257], &[1; 514]);
            }),
            "its kernel has 257 columns; at most 256 are supported for 8-bit values",
        ),
        (conv(&|_, inputs| inputs[3] = inputs[0].clone()), "its w must be constant"),
        (
            conv(&|model, inputs| inputs[4] = model.node("Relu", &["picture"], &[])),
            "its w_scale must be constant",
        ),
        (
            conv(&|_, inputs| inputs[0] = "picture".to_owned()),
            "it takes 8-bit integers, but its input holds 32-bit floating-point values",
        ),
        (
            conv(&|model, inputs| inputs.push(model.typed(data_type::INT32, &[3], &[1; 3]))),
            "its bias does not have 2 channels",
        ),
        (
            conv(&|model, inputs| inputs.push(model.floats(&[2], &[1.0; 2]))),
            "its bias must be of 32-bit integers",
        ),
        (
            alone("QuantizeLinear", &to(data_type::INT32, 0), &[]),
            "its y_zero_point must have 8-bit integers",
        ),
        (
            alone("QuantizeLinear", &to(data_type::INT8, -129), &[]),
            "its y_zero_point is -129; it must be -128 to 127",
        ),
        (
            alone(
                "QuantizeLinear",
                &to(data_type::INT8, 0),
                &[("block_size", AttributeValue::Int(2))],
            ),
            "blocked quantization is not supported",
        ),
        (
            alone("QuantizeLinear", &|model| vec![model.floats(&[3], &[1.0; 3])], &[]),
            "it has 3 scales, but axis 1 of [1, 1, 8, 8] has 1 elements; it must have 1 or 1",
        ),
        (alone("DequantizeLinear", &to(data_type::INT8, 0), &[]), "it takes integers"),
        (
            after("Sigmoid", &[]),
            "it takes 32-bit floating-point values, but its input holds 8-bit integers without sign",
        ),
        (after("Relu", &[]), "it takes 32-bit floating-point values"),
        (after("GlobalAveragePool", &[]), "it takes 32-bit floating-point values"),
        (
            after("com.microsoft.QLinearGlobalAveragePool", &[]),
            "it has 4 inputs; its operator has 5",
        ),
        (
            after("DynamicQuantizeLinear", &[]),
            "has the operator `DynamicQuantizeLinear`, which is not supported",
        ),
    ];
    for (refusal, expected) in cases {
        let names_node = refusal.starts_with("node `");
        assert!(
            names_node && refusal.contains(expected) && !refusal.contains('\n'),
            "{refusal} for {expected}"
        );
    }
}

/// The version of the operators determines the axes of a softmax.
#[test]
fn the_axes_of_a_softmax_depend_on_the_version_of_the_operators() {
    use foveate_network::onnx::{ModelProto, OperatorSetIdProto};
    use prost::Message as _;
    let parse = |version, axis: i64| {
        let model = one_node("Softmax", &[("axis", AttributeValue::Int(axis))]);
        let mut model = ModelProto::decode(model.bytes().as_slice()).unwrap();
        model.opset_import = vec![OperatorSetIdProto { domain: None, version: Some(version) }];
        let parsed = Network::parse(
            &model.encode_to_vec(),
            Path::new("test.onnx"),
            FrameSize { width: 8, height: 8 },
        );
        parsed.map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!((parse(13, 1), parse(11, 3)), (Ok(()), Ok(())));
    assert_eq!(parse(11, 1), Ok(()));
    assert!(parse(11, 4).unwrap_err().contains("its axis 4 is behind the last"));
    for version in [6, 29] {
        let expected = format!("it uses version {version} of the ONNX operators; versions 7 to 28");
        assert!(parse(version, 3).unwrap_err().contains(&expected));
    }
}

/// An empty message has two bytes in a file, and hundreds in memory.
#[test]
fn a_small_file_that_is_large_in_memory_is_refused() {
    let length = |length: usize| {
        let mut bytes = Vec::new();
        prost::encode_length_delimiter(length, &mut bytes).unwrap();
        bytes
    };
    let nested =
        |tag: u8, content: &[u8]| [&[tag << 3 | 2][..], &length(content.len()), content].concat();
    let read = |graph: &[u8]| {
        let size = FrameSize { width: 8, height: 8 };
        let bytes = nested(7, graph);
        Network::parse(&bytes, Path::new("test.onnx"), size).unwrap_err().to_string()
    };
    let many = |tag: u8, count: usize| [tag << 3 | 2, 0].repeat(count);
    // The graphs have many nodes, constants and inputs; many names and attributes of a node, and
    // integers of an attribute; many axes of an input; and many values of a constant.
    let graphs = [
        many(1, 9 << 20),
        many(5, 9 << 20),
        many(11, 9 << 20),
        nested(1, &many(1, 9 << 20)),
        nested(1, &many(5, 9 << 20)),
        nested(1, &nested(5, &[8 << 3, 1].repeat(9 << 20))),
        nested(11, &nested(2, &nested(1, &nested(2, &many(1, 9 << 20))))),
        nested(5, &nested(7, &vec![1; 400 << 20])),
    ];
    for graph in graphs {
        let refusal = read(&graph);
        assert!(refusal.contains("MiB of memory to read; at most 8192 are supported"), "{refusal}");
    }
    assert!(read(&many(1, 1000)).contains("it must have one input"));
}

#[test]
fn data_outside_of_the_folder_is_refused() {
    use foveate_network::onnx::{StringStringEntryProto, TensorProto};
    for location in ["../weights.bin", "/etc/hostname"] {
        let mut model = one_node("Relu", &[]);
        model.floats(&[1], &[]);
        let tensor = &mut model.graph.initializer[0];
        tensor.data_location = Some(TensorProto::EXTERNAL);
        tensor.external_data = vec![StringStringEntryProto {
            key: Some("location".to_owned()),
            value: Some(location.to_owned()),
        }];
        let refusal = refusal(model);
        assert!(refusal.contains("are outside of the folder of the model"), "{refusal}");
    }
}

/// Returns a small valid network of common operators.
fn common_network() -> Vec<u8> {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = model.floats(&[4, 1, 3, 3], &[0.5; 36]);
    let one =
        model.node("Conv", &["picture", &weights], &[("pads", AttributeValue::Ints(vec![1; 4]))]);
    let two = model.node("Relu", &[&one], &[]);
    let shape = model.ints(&[1, -1]);
    let three = model.node("Reshape", &[&two, &shape], &[]);
    model.output(&three);
    model.bytes()
}

/// Returns a small valid network of 8-bit integers.
fn quantized_network() -> Vec<u8> {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let (scale, zero) = (model.floats(&[], &[0.5]), model.typed(data_type::UINT8, &[], &[3]));
    let one = model.node("QuantizeLinear", &["picture", &scale, &zero], &[]);
    let weights = model.typed(data_type::UINT8, &[2, 1, 1, 1], &[1, 2]);
    let conv = [&one, &scale, &zero, &weights, &scale, &zero, &scale, &zero];
    let two = model.node("QLinearConv", &conv.map(String::as_str), &[]);
    let sum = [&two, &scale, &zero, &two, &scale, &zero, &scale, &zero];
    let three = model.node("com.microsoft.QLinearAdd", &sum.map(String::as_str), &[]);
    let four = model.node("DequantizeLinear", &[&three, &scale, &zero], &[]);
    model.output(&four);
    model.bytes()
}

/// Returns a part of a detector with computed shapes.
fn detector_network() -> Vec<u8> {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let weights = model.floats(&[1, 2, 2, 2], &[0.5; 8]);
    let up = model.node(
        "ConvTranspose",
        &["picture", &weights],
        &[("strides", AttributeValue::Ints(vec![2; 2]))],
    );
    let pads = model.ints(&[0, 0, 1, 2, 0, 0, 1, 2]);
    let padded = model.node("Pad", &[&up, &pads], &[("mode", AttributeValue::Text("reflect"))]);
    let blocks = model.node("SpaceToDepth", &[&padded], &[("blocksize", AttributeValue::Int(2))]);
    let shape = model.node("Shape", &[&blocks], &[]);
    let one = model.ints(&[1]);
    let channels = model.node("Gather", &[&shape, &one], &[]);
    let rest = model.ints(&[1, -1]);
    let shape = model.node("Concat", &[&rest, &channels], &[("axis", AttributeValue::Int(0))]);
    let flat = model.node("Reshape", &[&blocks, &shape], &[]);
    let turned =
        model.node("Transpose", &[&flat], &[("perm", AttributeValue::Ints(vec![0, 2, 1]))]);
    let alike = model.node("MatMul", &[&turned, &flat], &[]);
    let sum = model.node("ReduceSum", &[&alike, &one], &[]);
    let most = model.node("ArgMax", &[&sum], &[("axis", AttributeValue::Int(2))]);
    model.output(&most);
    model.bytes()
}

/// Returns a network of normalizations, selections and slices.
fn selection_network() -> Vec<u8> {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let scale = model.floats(&[1], &[0.5]);
    let one = model.node("InstanceNormalization", &["picture", &scale, &scale], &[]);
    let two =
        model.node("LayerNormalization", &[&one, &scale], &[("axis", AttributeValue::Int(2))]);
    let is = model.node("Less", &[&two, &scale], &[]);
    let three = model.node("Where", &[&is, &two, &scale], &[]);
    let four = model.node("LRN", &[&three], &[("size", AttributeValue::Int(3))]);
    let sizes = model.ints(&[1, 1, 12, 9]);
    let five =
        model.node("Resize", &[&four, "", "", &sizes], &[("mode", AttributeValue::Text("cubic"))]);
    let shape = model.ints(&[2, 1, 12, 9]);
    let six = model.node("Expand", &[&five, &shape], &[]);
    let index = model.index(-1);
    let seven = model.node("Gather", &[&six, &index], &[]);
    let bounds = [7, i64::MIN, 1, -2].map(|value| model.ints(&[value]));
    let [starts, ends, axes, steps] = &bounds;
    let eight = model.node("Slice", &[&seven, starts, ends, axes, steps], &[]);
    model.output(&eight);
    model.bytes()
}

/// The valid networks that are damaged.
const VALID_NETWORKS: [fn() -> Vec<u8>; 4] =
    [common_network, quantized_network, detector_network, selection_network];

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Truncated and changed bytes never panic, and never take more memory than the limits allow.
    #[test]
    fn damaged_bytes_do_not_panic(cut in 0..400usize, edits in prop::collection::vec((0..2000usize, any::<u8>()), 0..4), which in 0..VALID_NETWORKS.len()) {
        let mut bytes = VALID_NETWORKS[which]();
        let length = bytes.len();
        for (at, byte) in edits {
            bytes[at % length] = byte;
        }
        bytes.truncate(bytes.len().saturating_sub(cut / 20));
        let _ = Network::parse(&bytes, Path::new("test.onnx"), FrameSize { width: 8, height: 8 });
    }
}

#[test]
fn the_networks_that_are_damaged_are_valid() {
    for bytes in VALID_NETWORKS.map(|make| make()) {
        assert!(bytes.len() < 2000, "{}", bytes.len());
        let size = FrameSize { width: 8, height: 8 };
        assert!(Network::parse(&bytes, Path::new("test.onnx"), size).is_ok());
    }
}
