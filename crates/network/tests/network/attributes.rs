// SPDX-License-Identifier: MIT OR Apache-2.0
//! Each attribute of a node must be one of its operator in the version that the model uses, and
//! must be read.

use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::{
    ExecutionMode, Executor, Mask, Network, NetworkError,
    onnx::{TensorProto, attribute_type, data_type},
};

const SIDE: usize = 4;

/// Returns a model of one node on an input of one channel.
fn one_node(opset: Option<i64>, kind: &str, attributes: &[(&str, AttributeValue)]) -> ModelBuilder {
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    model.opset = opset;
    let output = model.node(kind, &["picture"], attributes);
    model.output(&output);
    model
}

fn refusal(model: ModelBuilder) -> String {
    model.read(SIDE, SIDE).unwrap_err().to_string()
}

fn outputs(network: &Network) -> Vec<f32> {
    let mut executor = Executor::new(network, ExecutionMode::Dense);
    let picture = noise(1, network.input().element_count());
    executor.step(&picture, &Mask::full(SIDE, SIDE));
    executor.tensor(network.outputs()[0]).real_values().into_owned()
}

#[test]
fn an_attribute_that_the_operator_has_not_is_refused_by_its_name() {
    let mut conv = ModelBuilder::new(&[1, 1, 4, 4]);
    let weights = conv.floats(&[1, 1, 3, 3], &[1.0; 9]);
    conv.node("Conv", &["picture", &weights], &[("padding", AttributeValue::Ints(vec![1; 4]))]);
    assert_eq!(
        refusal(conv),
        "node `Conv2` (Conv): it has no attribute `padding` in version 28 of the operators; it has auto_pad, dilations, group, kernel_shape, pads, strides"
    );
    let relu = one_node(None, "Relu", &[("alpha", AttributeValue::Float(0.1))]);
    assert!(
        refusal(relu)
            .contains("it has no attribute `alpha` in version 28 of the operators; it has none")
    );
}

#[test]
fn attributes_belong_to_versions() {
    let blocks = |opset| {
        let attributes =
            [("blocksize", AttributeValue::Int(2)), ("mode", AttributeValue::Text("CRD"))];
        one_node(Some(opset), "SpaceToDepth", &attributes)
    };
    assert!(refusal(blocks(27)).contains("it has no attribute `mode` in version 27"));
    assert!(blocks(28).read(SIDE, SIDE).is_ok());
    let axes =
        |opset| one_node(Some(opset), "ReduceMax", &[("axes", AttributeValue::Ints(vec![1]))]);
    assert!(axes(17).read(SIDE, SIDE).is_ok());
    assert!(refusal(axes(18)).contains("it has no attribute `axes` in version 18"));
    let says = "it exists since version 20 of the operators, but the model uses version 19";
    assert!(refusal(one_node(Some(19), "Gelu", &[])).contains(says));
}

/// Both orders of `SpaceToDepth` are checked by hand: an input of two channels and 2x2 positions
/// becomes eight channels of one position.
#[test]
fn space_to_depth_has_two_orders() {
    for (mode, order) in [
        (None, [0, 4, 1, 5, 2, 6, 3, 7]),
        (Some("DCR"), [0, 4, 1, 5, 2, 6, 3, 7]),
        (Some("CRD"), [0, 1, 2, 3, 4, 5, 6, 7]),
    ] {
        let mut model = ModelBuilder::new(&[1, 1, 2, 2]);
        let other = model.node("Neg", &["picture"], &[]);
        let both = model.node("Concat", &["picture", &other], &[("axis", AttributeValue::Int(1))]);
        let named = mode.map(|mode| ("mode", AttributeValue::Text(mode)));
        let attributes: Vec<_> =
            named.into_iter().chain([("blocksize", AttributeValue::Int(2))]).collect();
        let output = model.node("SpaceToDepth", &[&both], &attributes);
        model.output(&output);
        let network = model.read(2, 2).unwrap();
        let picture = [1.0, 2.0, 3.0, 4.0];
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(2, 2));
        let all = [1.0, 2.0, 3.0, 4.0, -1.0, -2.0, -3.0, -4.0];
        let wanted = order.map(|at: usize| all[at]);
        assert_eq!(
            executor.tensor(network.outputs()[0]).real_values().as_ref(),
            wanted,
            "{mode:?}"
        );
    }
}

#[test]
fn attributes_are_of_their_type_and_there_once() {
    let of_type = |kind: i32| {
        let mut model = one_node(None, "Elu", &[("alpha", AttributeValue::Float(0.5))]);
        model.graph.node[0].attribute[0].r#type = Some(kind);
        refusal(model)
    };
    assert!(of_type(2).contains("its attribute `alpha` is of INT, not of FLOAT"));
    assert!(of_type(99).contains("its attribute `alpha` is of another type, not of FLOAT"));
    let wrong = one_node(None, "Elu", &[("alpha", AttributeValue::Int(1))]);
    assert!(refusal(wrong).contains("its attribute `alpha` is of INT, not of FLOAT"));
    let alpha = || ("alpha", AttributeValue::Float(0.5));
    let twice = one_node(None, "Elu", &[alpha(), alpha()]);
    assert!(refusal(twice).contains("it has the attribute `alpha` twice"));
    let mut of_function = one_node(None, "Elu", &[alpha()]);
    of_function.graph.node[0].attribute[0].ref_attr_name = Some("slope".to_owned());
    assert!(refusal(of_function).contains("an attribute of a function"));
    assert!(
        refusal(one_node(None, "DepthToSpace", &[])).contains("it has no attribute `blocksize`")
    );
}

/// A writer may leave out a field whose value is 0.
#[test]
fn a_number_that_is_not_written_is_zero() {
    let network = |axis: Option<i64>| {
        let mut model = one_node(None, "Softmax", &[("axis", AttributeValue::Int(0))]);
        let attribute = &mut model.graph.node[0].attribute[0];
        attribute.r#type = Some(2);
        attribute.i = axis;
        outputs(&model.read(SIDE, SIDE).unwrap())
    };
    assert_eq!(attribute_type::type_name(2), Some("INT"));
    assert_eq!(network(None), network(Some(0)));
    assert_ne!(network(None), network(Some(-1)));
}

/// An attribute may be left unread only if it changes nothing.
#[test]
fn an_attribute_that_says_something_is_looked_at() {
    let quantize = |attribute: (&str, AttributeValue)| {
        let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
        let scale = model.floats(&[], &[1.0]);
        let output = model.node("QuantizeLinear", &["picture", &scale], &[attribute]);
        model.output(&output);
        model.read(SIDE, SIDE).map(|_| ()).map_err(|error: NetworkError| error.to_string())
    };
    let refused = quantize(("precision", AttributeValue::Int(10))).unwrap_err();
    assert!(refused.contains("its attribute `precision` is not supported here"), "{refused}");
    assert_eq!(quantize(("precision", AttributeValue::Int(0))), Ok(()));
    assert_eq!(quantize(("saturate", AttributeValue::Int(0))), Ok(()));
}

#[test]
fn inputs_and_outputs_are_as_many_as_the_operator_has() {
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    let more = model.floats(&[1], &[1.0]);
    model.node("Relu", &["picture", &more], &[]);
    assert!(refusal(model).contains("it has 2 inputs; its operator has 1"));
    let with_mask = || {
        let mut model = one_node(None, "Dropout", &[]);
        model.graph.node[0].output.push("mask".to_owned());
        model
    };
    assert!(with_mask().read(SIDE, SIDE).is_ok());
    let mut model = with_mask();
    model.output("mask");
    assert!(refusal(model).contains("its output 1, `mask`, is not supported"));
}

#[test]
fn constants_of_every_way_to_write_them_are_read() {
    let value = |attribute: (&str, AttributeValue)| {
        let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
        let constant = model.node("Constant", &[], &[attribute]);
        let output = model.node("Pow", &["picture", &constant], &[]);
        model.output(&output);
        outputs(&model.read(SIDE, SIDE).unwrap())
    };
    let squares: Vec<f32> = noise(1, 16).iter().map(|value| value * value).collect();
    let integer = TensorProto {
        data_type: Some(data_type::INT64),
        int64_data: vec![2],
        ..TensorProto::default()
    };
    for attribute in [
        ("value_float", AttributeValue::Float(2.0)),
        ("value_floats", AttributeValue::Floats(vec![2.0; 4])),
        ("value_int", AttributeValue::Int(2)),
        ("value_ints", AttributeValue::Ints(vec![2; 4])),
        ("value", AttributeValue::Tensor(integer)),
    ] {
        assert_eq!(value(attribute.clone()), squares, "{}", attribute.0);
    }
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    model.node("Constant", &[], &[("value_string", AttributeValue::Text("a"))]);
    assert!(refusal(model).contains("it has none of the attributes value, value_float"));
}

/// The weights of the light networks of ONNX are written in this way.
#[test]
fn constants_of_a_shape_may_be_large() {
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    let shape = model.ints(&[70_000, 1, 1, 1]);
    let value = TensorProto {
        dims: vec![1],
        data_type: Some(data_type::FLOAT),
        float_data: vec![0.5],
        ..TensorProto::default()
    };
    let weights =
        model.node("ConstantOfShape", &[&shape], &[("value", AttributeValue::Tensor(value))]);
    let features = model.node("Conv", &["picture", &weights], &[]);
    model.output(&features);
    let values = outputs(&model.read(SIDE, SIDE).unwrap());
    let halves: Vec<f32> = noise(1, 16).iter().map(|value| value / 2.0).collect();
    assert_eq!(values.len(), 70_000 * 16);
    assert!(values.chunks(16).all(|channel| channel == halves));
}

#[test]
fn a_cast_may_take_its_type_from_another_tensor() {
    let mut model = ModelBuilder::new(&[1, 1, 4, 4]);
    let (like, number) = (model.ints(&[1]), model.floats(&[1], &[2.9]));
    let cast = model.node("CastLike", &[&number, &like], &[]);
    let power = model.node("Pow", &["picture", &cast], &[]);
    let output = model.node("CastLike", &[&power, "picture"], &[]);
    model.output(&output);
    let squares: Vec<f32> = noise(1, 16).iter().map(|value| value * value).collect();
    assert_eq!(outputs(&model.read(SIDE, SIDE).unwrap()), squares);
}
