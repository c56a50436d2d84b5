// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks from TensorFlow take the channels last, and first transpose them to the front.

use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::{ExecutionMode, Executor, InputLayout, Mask, Network};

const FIRST: [i64; 4] = [0, 3, 1, 2];
const LAST: [i64; 4] = [0, 2, 3, 1];

fn add_transpose(model: &mut ModelBuilder, name: &str, order: [i64; 4]) -> String {
    model.node("Transpose", &[name], &[("perm", AttributeValue::Ints(order.to_vec()))])
}

/// Returns a network of two convolutions of the same input, multiplied. With `turn` its input and
/// its output have the channels last, and each convolution takes a separate Transpose.
fn network(turn: bool, shape: &[i64]) -> Network {
    let mut model = ModelBuilder::new(shape);
    let weights = model.floats(&[2, 3, 3, 3], &noise(1, 54));
    let pads = [("pads", AttributeValue::Ints(vec![1; 4]))];
    let parts: Vec<String> = (0..2)
        .map(|_| {
            let picture = if turn {
                add_transpose(&mut model, "picture", FIRST)
            } else {
                "picture".to_owned()
            };
            model.node("Conv", &[&picture, &weights], &pads)
        })
        .collect();
    let mut output = model.node("Mul", &[&parts[0], &parts[1]], &[]);
    if turn {
        output = add_transpose(&mut model, &output, LAST);
    }
    model.output(&output);
    model.read(6, 4).unwrap()
}

/// Returns the outputs of a network for two frames, the second of which differs in a corner.
fn outputs(network: &Network) -> Vec<Vec<f32>> {
    let mut executor = Executor::new(network, ExecutionMode::Exact);
    let mut picture = noise(2, 72);
    let mut step = |picture: &[f32], changed: &Mask| {
        executor.step(picture, changed);
        executor.tensor(network.outputs()[0]).real_values().into_owned()
    };
    let first = step(&picture, &Mask::full(4, 6));
    let mut corner = Mask::empty(4, 6);
    corner.insert(0, 0);
    (0..3).for_each(|channel| picture[24 * channel] += 1.0);
    vec![first, step(&picture, &corner)]
}

/// The Transposes behind the input are removed, the one in front of the output remains, and the
/// values are those of the network with the channels first.
#[test]
fn channels_that_are_put_first_are_read_as_such() {
    let first = network(false, &[1, 3, 4, 6]);
    for shape in [[1, 4, 6, 3]] {
        let last = network(true, &shape);
        assert_eq!((first.layout(), last.layout()), (InputLayout::Nchw, InputLayout::Nhwc));
        assert_eq!(last.input().shape(), [1, 3, 4, 6]);
        assert_eq!(last.form(last.outputs()[0]).shape(), [1, 4, 6, 2]);
        let kinds: Vec<_> =
            last.nodes().iter().map(foveate_network::NetworkNode::operator_name).collect();
        assert_eq!(kinds, ["Conv", "Conv", "Mul", "Transpose"]);
        for (first, last) in outputs(&first).iter().zip(outputs(&last)) {
            for (at, value) in last.iter().enumerate() {
                let (place, channel) = (at / 2, at % 2);
                assert_eq!(value.to_bits(), first[24 * channel + place].to_bits());
            }
        }
    }
}

#[test]
fn channels_that_stay_last_are_refused_with_what_would_help() {
    let refusal = |model: ModelBuilder| model.read(6, 4).unwrap_err().to_string();
    let start = "the network: its input `picture` is [1, height, width, channels], and";
    let help = "Export it with channels first, as tf2onnx does with --inputs-as-nchw picture";
    let mut used = ModelBuilder::new(&[1, 4, 6, 3]);
    let turn = add_transpose(&mut used, "picture", FIRST);
    let relu = used.node("Relu", &["picture"], &[]);
    used.output(&turn);
    used.output(&relu);
    let mut other = ModelBuilder::new(&[1, 4, 6, 3]);
    let odd = add_transpose(&mut other, "picture", [0, 3, 2, 1]);
    other.output(&odd);
    let mut output = ModelBuilder::new(&[1, 4, 6, 1]);
    add_transpose(&mut output, "picture", FIRST);
    output.output("picture");
    for (model, why) in [
        (used, "node `Relu2` (Relu) takes it in this order"),
        (other, "node `Transpose1` (Transpose) takes it in this order"),
        (output, "it is an output, too"),
    ] {
        let refusal = refusal(model);
        assert!(refusal.starts_with(start), "{refusal}");
        assert!(refusal.contains(why) && refusal.ends_with(help), "{refusal}");
    }
    let mut many = ModelBuilder::new(&[1, 4, 6, 5]);
    let turn = add_transpose(&mut many, "picture", FIRST);
    many.output(&turn);
    assert!(refusal(many).ends_with("with 1 or 3 channels, but it has 4"));
    let mut large = ModelBuilder::new(&[1, 8, 8, 3]);
    let turn = add_transpose(&mut large, "picture", FIRST);
    large.output(&turn);
    assert!(refusal(large).contains("give --resize 8x8, or --framing letterbox"));
}
