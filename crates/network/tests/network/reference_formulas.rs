// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution and pooling are compared with the formulas of the ONNX standard, in double
//! precision.

use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::{ExecutionMode, Executor, Mask};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn convolution_is_that_of_the_standard(
        groups in 1..4usize, inner in 1..4usize, outer in prop_oneof![Just(1), 1..20usize], size in (4..50usize, 4..90usize),
        kernel in (1..4usize, 1..4usize), stride in (1..4usize, 1..4usize), dilation in (1..3usize, 1..3usize), pads in prop::array::uniform4(0..3usize),
    ) {
        let (inputs, outputs) = (groups * inner, groups * outer);
        // The input has one channel; a first convolution makes the required number.
        let spread = noise(11, inputs);
        let weights = noise(12, outputs * inner * kernel.0 * kernel.1);
        let bias = noise(13, outputs);
        let picture = noise(14, size.0 * size.1);
        let i64s = |values: &[usize]| AttributeValue::Ints(values.iter().map(|&value| i64::try_from(value).unwrap()).collect());
        let dims = |values: &[usize]| -> Vec<i64> { values.iter().map(|&value| i64::try_from(value).unwrap()).collect() };
        let mut model = ModelBuilder::new(&dims(&[1, 1, size.0, size.1]));
        let first = model.floats(&dims(&[inputs, 1, 1, 1]), &spread);
        let channels = model.node("Conv", &["picture", &first], &[]);
        let second = model.floats(&dims(&[outputs, inner, kernel.0, kernel.1]), &weights);
        let third = model.floats(&dims(&[outputs]), &bias);
        let attributes = [
            ("strides", i64s(&[stride.0, stride.1])), ("dilations", i64s(&[dilation.0, dilation.1])),
            ("pads", i64s(&pads)), ("group", AttributeValue::Int(i64::try_from(groups).unwrap())),
        ];
        let output = model.node("Conv", &[&channels, &second, &third], &attributes);
        model.output(&output);
        let room = |length: usize, pad: usize, kernel: usize, dilation: usize| (length + pad).checked_sub((kernel - 1) * dilation + 1);
        let rooms = (room(size.0, pads[0] + pads[2], kernel.0, dilation.0), room(size.1, pads[1] + pads[3], kernel.1, dilation.1));
        let (Some(room_y), Some(room_x)) = rooms else {
            prop_assert!(model.read(size.1, size.0).is_err());
            return Ok(());
        };
        let network = model.read(size.1, size.0).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(size.0, size.1));
        let found = executor.tensor(2);
        let (height, width) = (room_y / stride.0 + 1, room_x / stride.1 + 1);
        prop_assert_eq!(found.form().shape(), &[1, outputs, height, width]);
        for (at, &found) in found.real_values().iter().enumerate() {
            let (channel, y, x) = (at / width / height, at / width % height, at % width);
            let mut sum = f64::from(bias[channel]);
            for input in 0..inner {
                for ky in 0..kernel.0 {
                    for kx in 0..kernel.1 {
                        let (iy, ix) = (y * stride.0 + ky * dilation.0, x * stride.1 + kx * dilation.1);
                        if iy < pads[0] || ix < pads[1] || iy - pads[0] >= size.0 || ix - pads[1] >= size.1 {
                            continue;
                        }
                        let from = channel / outer * inner + input;
                        let value = f64::from(spread[from]) * f64::from(picture[(iy - pads[0]) * size.1 + ix - pads[1]]);
                        sum += value * f64::from(weights[((channel * inner + input) * kernel.0 + ky) * kernel.1 + kx]);
                    }
                }
            }
            prop_assert!((f64::from(found) - sum).abs() < 1e-4, "{found} for {sum} at {at}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Every input is added, with its weights, to the outputs that it reaches.
    #[test]
    fn transposed_convolution_is_that_of_the_standard(
        groups in 1..3usize, inner in 1..3usize, outer in 1..4usize, size in (1..6usize, 1..7usize), kernel in (1..5usize, 1..5usize),
        stride in (1..4usize, 1..4usize), dilation in (1..4usize, 1..3usize), pads in prop::array::uniform4(0..3usize), more in (0..2usize, 0..2usize),
    ) {
        let (inputs, outputs) = (groups * inner, groups * outer);
        let spread = noise(21, inputs);
        let weights = noise(22, inputs * outer * kernel.0 * kernel.1);
        let bias = noise(23, outputs);
        let picture = noise(24, size.0 * size.1);
        let dims = |values: &[usize]| -> Vec<i64> { values.iter().map(|&value| i64::try_from(value).unwrap()).collect() };
        let mut model = ModelBuilder::new(&dims(&[1, 1, size.0, size.1]));
        let first = model.floats(&dims(&[inputs, 1, 1, 1]), &spread);
        let channels = model.node("Conv", &["picture", &first], &[]);
        let second = model.floats(&dims(&[inputs, outer, kernel.0, kernel.1]), &weights);
        let third = model.floats(&dims(&[outputs]), &bias);
        let attributes = [
            ("strides", AttributeValue::Ints(dims(&[stride.0, stride.1]))), ("dilations", AttributeValue::Ints(dims(&[dilation.0, dilation.1]))),
            ("pads", AttributeValue::Ints(dims(&pads))), ("output_padding", AttributeValue::Ints(dims(&[more.0, more.1]))), ("group", AttributeValue::Int(i64::try_from(groups).unwrap())),
        ];
        let output = model.node("ConvTranspose", &[&channels, &second, &third], &attributes);
        model.output(&output);
        let all = |length: usize, stride: usize, kernel: usize, dilation: usize, more: usize| (length - 1) * stride + (kernel - 1) * dilation + 1 + more;
        let all = (all(size.0, stride.0, kernel.0, dilation.0, more.0), all(size.1, stride.1, kernel.1, dilation.1, more.1));
        let left = (all.0.checked_sub(pads[0] + pads[2]), all.1.checked_sub(pads[1] + pads[3]));
        let (Some(height @ 1..), Some(width @ 1..)) = left else {
            prop_assert!(model.read(size.1, size.0).unwrap_err().to_string().contains("leave no output"));
            return Ok(());
        };
        let mut wanted: Vec<f64> = bias.iter().flat_map(|&bias| vec![f64::from(bias); all.0 * all.1]).collect();
        for (input, channel) in (0..inputs).flat_map(|input| (0..outer).map(move |channel| (input, channel))) {
            for (y, x) in (0..size.0).flat_map(|y| (0..size.1).map(move |x| (y, x))) {
                for (ky, kx) in (0..kernel.0).flat_map(|ky| (0..kernel.1).map(move |kx| (ky, kx))) {
                    let weight = weights[((input * outer + channel) * kernel.0 + ky) * kernel.1 + kx];
                    let to = (input / inner * outer + channel) * all.0 + y * stride.0 + ky * dilation.0;
                    wanted[to * all.1 + x * stride.1 + kx * dilation.1] +=
                        f64::from(weight) * f64::from(spread[input]) * f64::from(picture[y * size.1 + x]);
                }
            }
        }
        let network = model.read(size.1, size.0).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(size.0, size.1));
        let found = executor.tensor(2);
        prop_assert_eq!(found.form().shape(), &[1, outputs, height, width]);
        for (at, &found) in found.real_values().iter().enumerate() {
            let (channel, y, x) = (at / width / height, at / width % height, at % width);
            let wanted = wanted[(channel * all.0 + y + pads[0]) * all.1 + x + pads[1]];
            prop_assert!((f64::from(found) - wanted).abs() < 1e-4, "{found} for {wanted} at {at}");
        }
    }
}

/// One value of every pooling is computed by hand.
#[test]
fn pooling_is_that_of_the_standard() {
    let picture: Vec<f32> = (0..25u8).map(f32::from).collect();
    let run = |kind: &str, attributes: &[(&str, AttributeValue)]| {
        let mut model = ModelBuilder::new(&[1, 1, 5, 5]);
        let output = model.node(kind, &["picture"], attributes);
        model.output(&output);
        let network = model.read(5, 5).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(5, 5));
        executor.tensor(1).real_values().to_vec()
    };
    let square = |side| ("kernel_shape", AttributeValue::Ints(vec![side; 2]));
    let strides = ("strides", AttributeValue::Ints(vec![2; 2]));
    let pads = ("pads", AttributeValue::Ints(vec![1; 4]));
    assert_eq!(run("MaxPool", &[square(2), strides.clone()]), [6.0, 8.0, 16.0, 18.0]);
    assert_eq!(
        run("MaxPool", &[square(2), strides.clone(), ("ceil_mode", AttributeValue::Int(1))]),
        [6.0, 8.0, 9.0, 16.0, 18.0, 19.0, 21.0, 23.0, 24.0]
    );
    assert_eq!(run("AveragePool", &[square(2), strides.clone()]), [3.0, 5.0, 13.0, 15.0]);
    // The first window holds 0, 1, 5 and 6, and five values of padding.
    assert_eq!(run("AveragePool", &[square(3), strides.clone(), pads.clone()])[0], 3.0);
    assert_eq!(
        run(
            "AveragePool",
            &[square(3), strides, pads, ("count_include_pad", AttributeValue::Int(1))]
        )[0],
        12.0 / 9.0
    );
    assert_eq!(run("GlobalAveragePool", &[]), [12.0]);
    assert_eq!(run("GlobalMaxPool", &[]), [24.0]);
}

/// If the size is even, one more channel counts behind the channel of a value than before it.
#[test]
fn local_responses_are_those_of_the_standard() {
    const CHANNELS: usize = 7;
    let (spread, picture) = (noise(31, CHANNELS), noise(32, 20));
    let (alpha, beta, bias) = (0.5, 0.6, 1.5);
    for (size, before, behind) in [(1, 0, 0), (3, 1, 1), (4, 1, 2), (5, 2, 2)] {
        let mut model = ModelBuilder::new(&[1, 1, 4, 5]);
        let weights = model.floats(&[7, 1, 1, 1], &spread);
        let channels = model.node("Conv", &["picture", &weights], &[]);
        let attributes = [
            ("size", AttributeValue::Int(size)),
            ("alpha", AttributeValue::Float(alpha)),
            ("beta", AttributeValue::Float(beta)),
            ("bias", AttributeValue::Float(bias)),
        ];
        let output = model.node("LRN", &[&channels], &attributes);
        model.output(&output);
        let network = model.read(5, 4).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(4, 5));
        for (at, &found) in executor.tensor(2).real_values().iter().enumerate() {
            let (channel, place) = (at / 20, at % 20);
            let value = |channel: usize| f64::from(spread[channel]) * f64::from(picture[place]);
            let seen = channel.saturating_sub(before)..(channel + behind + 1).min(CHANNELS);
            let squares: f64 = seen.map(|channel| value(channel).powi(2)).sum();
            let share = f64::from(alpha) / f64::from(i32::try_from(size).unwrap());
            let wanted = value(channel) / (f64::from(bias) + share * squares).powf(beta.into());
            assert!((f64::from(found) - wanted).abs() < 1e-6, "{found} for {wanted}, size {size}");
        }
    }
}

/// The slice takes rows 1 and 2 and columns 1 and 3 of four rows and five columns, once in one node
/// and once in two nodes.
#[test]
fn slices_are_those_of_the_standard() {
    let picture: Vec<f32> = (0..20u8).map(f32::from).collect();
    let run = |slices: &[[&[i64]; 4]]| {
        let mut model = ModelBuilder::new(&[1, 1, 4, 5]);
        let mut name = "picture".to_owned();
        for slice in slices {
            let bounds = slice.map(|values| model.ints(values));
            let inputs: Vec<&str> =
                std::iter::once(name.as_str()).chain(bounds.iter().map(String::as_str)).collect();
            name = model.node("Slice", &inputs, &[]);
        }
        model.output(&name);
        let network = model.read(5, 4).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture, &Mask::full(4, 5));
        executor.tensor(slices.len()).real_values().to_vec()
    };
    let at_once = run(&[[&[1, -4], &[-1, 9], &[2, -1], &[1, 2]]]);
    assert_eq!(at_once, [6.0, 8.0, 11.0, 13.0]);
    assert_eq!(run(&[[&[-4], &[9], &[3], &[2]], [&[1], &[-1], &[-2], &[1]]]), at_once);
}
