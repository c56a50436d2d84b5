// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators on 8-bit values are compared with the ONNX specification, in plain loops over 64-bit
//! integers.
#![allow(
    clippy::cast_precision_loss,
    reason = "all integers here are below 2^24, or are rounded as sums are"
)]

use crate::integer_layers::integers;
use crate::model::{AttributeValue, ModelBuilder, noise};
use foveate_network::{ExecutionMode, Executor, Mask, onnx::data_type};
use proptest::prelude::*;

/// Divides a number by a power of two, and rounds halves to even.
fn divided_by_power_of_two(number: i64, shift: u32) -> i64 {
    let (floor, rest) = (number >> shift, number & ((1 << shift) - 1));
    let half = 1 << shift >> 1;
    floor + i64::from(shift > 0 && (rest > half || (rest == half && floor & 1 == 1)))
}

/// Returns the ONNX type of 8-bit values, and their range.
fn byte_type(is_signed: bool) -> (i32, [i64; 2]) {
    if is_signed { (data_type::INT8, [-128, 127]) } else { (data_type::UINT8, [0, 255]) }
}

fn dims(lengths: &[usize]) -> Vec<i64> {
    lengths.iter().map(|&length| i64::try_from(length).unwrap()).collect()
}

fn two_to(exponent: u32) -> f32 {
    f32::powi(2.0, exponent.cast_signed())
}

/// A convolution as ONNX defines it. Padding has the value of the zero point, so it adds nothing.
struct NaiveConv<'a> {
    inputs: &'a [i64],
    zero: i64,
    size: [usize; 2],
    /// The number of input channels of a group.
    inner: usize,
    /// The number of output channels of a group.
    outer: usize,
    weights: &'a [i32],
    zeros: &'a [i32],
    kernel: [usize; 2],
    stride: [usize; 2],
    dilation: [usize; 2],
    pads: [usize; 4],
}

impl NaiveConv<'_> {
    fn outputs(&self) -> Option<[usize; 2]> {
        let along = |axis: usize| {
            let padded = self.size[axis] + self.pads[axis] + self.pads[axis + 2];
            let span = (self.kernel[axis] - 1) * self.dilation[axis] + 1;
            padded.checked_sub(span).map(|room| room / self.stride[axis] + 1)
        };
        Some([along(0)?, along(1)?])
    }

    fn sum(&self, channel: usize, at: [usize; 2]) -> i64 {
        let mut sum = 0;
        for input in 0..self.inner {
            for ky in 0..self.kernel[0] {
                for kx in 0..self.kernel[1] {
                    let y = at[0] * self.stride[0] + ky * self.dilation[0];
                    let x = at[1] * self.stride[1] + kx * self.dilation[1];
                    if y < self.pads[0]
                        || x < self.pads[1]
                        || y - self.pads[0] >= self.size[0]
                        || x - self.pads[1] >= self.size[1]
                    {
                        continue;
                    }
                    let from = channel / self.outer * self.inner + input;
                    let place =
                        (from * self.size[0] + y - self.pads[0]) * self.size[1] + x - self.pads[1];
                    let weight = ((channel * self.inner + input) * self.kernel[0] + ky)
                        * self.kernel[1]
                        + kx;
                    let weight = self.weights[weight] - self.zeros[channel % self.zeros.len()];
                    sum += i64::from(weight) * (self.inputs[place] - self.zero);
                }
            }
        }
        sum
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// All scales are powers of two, so that every quotient is exact and many quotients lie
    /// halfway.
    #[test]
    fn convolution_is_that_of_the_standard(
        (groups, inner, outer) in (1..4usize, prop_oneof![4 => 1..5usize, 1 => 30..40usize], 1..16usize),
        size in prop::array::uniform2(4..20usize),
        (kernel, stride, dilation) in (prop::array::uniform2(1..4usize), prop::array::uniform2(1..4usize), prop::array::uniform2(1..3usize)),
        pads in prop::array::uniform4(0..3usize),
        (x_signed, w_signed, y_signed, per_channel, is_integer) in any::<(bool, bool, bool, bool, bool)>(),
        seed in 0..1000u64,
    ) {
        let (inputs, outputs) = (groups * inner, groups * outer);
        let (x_type, x_range) = byte_type(x_signed);
        let (w_type, w_range) = byte_type(w_signed);
        let (y_type, y_range) = byte_type(y_signed);
        let range = |[low, high]: [i64; 2]| i32::try_from(low).unwrap()..=i32::try_from(high).unwrap();
        let one = |seed, limits| integers(seed, 1, range(limits))[0];
        let (x_zero, y_zero) = (one(seed + 1, x_range), one(seed + 2, y_range));
        let channels = if per_channel { outputs } else { 1 };
        let zeros = integers(seed + 3, channels, range(w_range));
        let weights = integers(seed + 4, outputs * inner * kernel[0] * kernel[1], range(w_range));
        let bias = integers(seed + 5, outputs, -40000..=40000);
        let shifts: Vec<u32> = integers(seed + 6, channels, 2..=12).iter().map(|&shift| shift.cast_unsigned()).collect();
        let factors = integers(seed + 7, inputs, -127..=127);
        let picture: Vec<i32> = integers(seed + 8, size[0] * size[1], 0..=255);

        let mut model = ModelBuilder::new(&dims(&[1, 1, size[0], size[1]]));
        let scale = model.floats(&[], &[1.0]);
        let zero = model.typed(data_type::UINT8, &[], &[0]);
        let quantized = model.node("QuantizeLinear", &["picture", &scale, &zero], &[]);
        // A first convolution makes the required number of channels: products with the factors,
        // divided by 128.
        let spread = model.typed(data_type::INT8, &dims(&[inputs, 1, 1, 1]), &factors);
        let spread_zero = model.typed(data_type::INT8, &[], &[0]);
        let (to, to_zero) = (model.floats(&[], &[128.0]), model.typed(x_type, &[], &[x_zero]));
        let x = model.node("QLinearConv", &[&quantized, &scale, &zero, &spread, &scale, &spread_zero, &to, &to_zero], &[]);
        let w = model.typed(w_type, &dims(&[outputs, inner, kernel[0], kernel[1]]), &weights);
        let along: &[i64] = if per_channel { &dims(&[outputs]) } else { &[] };
        let w_zeros = model.typed(w_type, along, &zeros);
        let values = |values: &[usize]| AttributeValue::Ints(dims(values));
        let attributes = [
            ("strides", values(&stride)), ("dilations", values(&dilation)), ("pads", values(&pads)),
            ("group", AttributeValue::Int(i64::try_from(groups).unwrap())),
        ];
        let output = if is_integer {
            model.node("ConvInteger", &[&x, &w, &to_zero, &w_zeros], &attributes)
        } else {
            // The sums are in steps of 128 x 2^-shift.
            let w_scales: Vec<f32> = shifts.iter().map(|&shift| 1.0 / two_to(shift)).collect();
            let w_scales = model.floats(along, &w_scales);
            let y_zero = model.typed(y_type, &[], &[y_zero]);
            let bias = model.typed(data_type::INT32, &dims(&[outputs]), &bias);
            model.node("QLinearConv", &[&x, &to, &to_zero, &w, &w_scales, &w_zeros, &to, &y_zero, &bias], &attributes)
        };
        model.output(&output);

        let between = |value: i64, [low, high]: [i64; 2]| value.clamp(low, high);
        let spread = factors.iter().flat_map(|&factor| picture.iter().map(move |&pixel| i64::from(factor) * i64::from(pixel)));
        let spread: Vec<i64> = spread.map(|product| between(divided_by_power_of_two(product, 7) + i64::from(x_zero), x_range)).collect();
        let naive = NaiveConv { inputs: &spread, zero: x_zero.into(), size, inner, outer, weights: &weights, zeros: &zeros, kernel, stride, dilation, pads };
        let Some([height, width]) = naive.outputs() else {
            prop_assert!(model.read(size[1], size[0]).is_err());
            return Ok(());
        };
        let network = model.read(size[1], size[0]).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&picture.iter().map(|&pixel| pixel as f32).collect::<Vec<_>>(), &Mask::full(size[0], size[1]));
        // The real numbers of the first convolution are exact, too.
        let spread: Vec<f32> = spread.iter().map(|&value| (value - i64::from(x_zero)) as f32 * 128.0).collect();
        prop_assert_eq!(&*executor.tensor(2).real_values(), spread.as_slice());
        let found = executor.tensor(3);
        prop_assert_eq!(found.form().shape(), &[1, outputs, height, width]);
        prop_assert_eq!(found.form().bytes(), (outputs * height * width * if is_integer { 4 } else { 1 }) as u64);
        for (at, &found) in found.real_values().iter().enumerate() {
            let channel = at / width / height;
            let sum = naive.sum(channel, [at / width % height, at % width]);
            let right = if is_integer {
                sum as f32
            } else {
                let rounded = divided_by_power_of_two(sum + i64::from(bias[channel]), shifts[channel % channels]);
                (between(rounded + i64::from(y_zero), y_range) - i64::from(y_zero)) as f32 * 128.0
            };
            prop_assert_eq!(found, right, "at {}", at);
        }
    }

    /// All matrix products are compared with the standard.
    #[test]
    fn products_are_those_of_the_standard(
        inputs in 1..700usize, outputs in 1..20usize, kind in 0..3usize, (x_signed, w_signed, per_column) in any::<(bool, bool, bool)>(), seed in 0..1000u64,
    ) {
        let (x_type, x_range) = byte_type(x_signed);
        let (w_type, w_range) = byte_type(w_signed);
        let range = |[low, high]: [i64; 2]| i32::try_from(low).unwrap()..=i32::try_from(high).unwrap();
        let zero = integers(seed, 1, range(x_range))[0];
        let columns = if per_column { outputs } else { 1 };
        let zeros = integers(seed + 1, columns, range(w_range));
        let weights = integers(seed + 2, inputs * outputs, range(w_range));
        let bias = integers(seed + 3, outputs, -40000..=40000);
        let shifts: Vec<u32> = integers(seed + 4, columns, 6..=14).iter().map(|&shift| shift.cast_unsigned()).collect();
        let stored = integers(seed + 5, inputs, range(x_range));

        let mut model = ModelBuilder::new(&dims(&[1, 1, 1, inputs]));
        let one = model.floats(&[], &[1.0]);
        let x_zero = model.typed(x_type, &[], &[zero]);
        let x = model.node("QuantizeLinear", &["picture", &one, &x_zero], &[]);
        let x = model.node("Flatten", &[&x], &[]);
        let along: &[i64] = if per_column { &dims(&[outputs]) } else { &[] };
        let w_zeros = model.typed(w_type, along, &zeros);
        let scales: Vec<f32> = shifts.iter().map(|&shift| 1.0 / two_to(shift)).collect();
        let scales = model.floats(along, &scales);
        let y_zero = model.typed(data_type::INT8, &[], &[3]);
        let transposed = kind == 2 && seed % 2 == 0;
        let turned = |at: usize| weights[at % inputs * outputs + at / inputs];
        let w = if transposed {
            let turned: Vec<i32> = (0..weights.len()).map(turned).collect();
            model.typed(w_type, &dims(&[outputs, inputs]), &turned)
        } else {
            model.typed(w_type, &dims(&[inputs, outputs]), &weights)
        };
        let output = match kind {
            0 => model.node("MatMulInteger", &[&x, &w, &x_zero, &w_zeros], &[]),
            1 => model.node("QLinearMatMul", &[&x, &one, &x_zero, &w, &scales, &w_zeros, &one, &y_zero], &[]),
            _ => {
                let bias = model.typed(data_type::INT32, &dims(&[outputs]), &bias);
                let attributes = [("transB", AttributeValue::Int(transposed.into()))];
                model.node("com.microsoft.QGemm", &[&x, &one, &x_zero, &w, &scales, &w_zeros, &bias, &one, &y_zero], &attributes)
            }
        };
        model.output(&output);
        let network = model.read(inputs, 1).unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        let picture: Vec<f32> = stored.iter().map(|&stored| (stored - zero) as f32).collect();
        executor.step(&picture, &Mask::full(1, inputs));
        for (column, &found) in executor.tensor(3).real_values().iter().enumerate() {
            let product = |row: usize| {
                let weight = weights[row * outputs + column] - zeros[column % columns];
                i64::from(stored[row] - zero) * i64::from(weight)
            };
            let mut sum: i64 = (0..inputs).map(product).sum();
            if kind == 2 {
                sum += i64::from(bias[column]);
            }
            // The comparison needs a sum below 2^24, because larger sums are not exact in floating
            // point, in which they are divided.
            let in_steps = (divided_by_power_of_two(sum, shifts[column % columns]) + 3).clamp(-128, 127) - 3;
            let right = if kind == 0 { sum as f32 } else { in_steps as f32 };
            prop_assert!(sum.abs() >= 1 << 24 || found == right, "{found} for {right}");
        }
    }
}

/// Returns the outputs of a network whose input is first quantized with these constants.
fn run(
    picture: &[f32],
    (is_signed, scale, zero): (bool, f32, i32),
    rest: impl Fn(&mut ModelBuilder, [&str; 3]) -> String,
) -> Vec<f32> {
    let width = picture.len();
    let mut model = ModelBuilder::new(&dims(&[1, 1, 1, width]));
    let scale = model.floats(&[], &[scale]);
    let zero = model.typed(byte_type(is_signed).0, &[], &[zero]);
    let x = model.node("QuantizeLinear", &["picture", &scale, &zero], &[]);
    let output = rest(&mut model, [&x, &scale, &zero]);
    model.output(&output);
    let network = model.read(width, 1).unwrap();
    let mut executor = Executor::new(&network, ExecutionMode::Dense);
    executor.step(picture, &Mask::full(1, width));
    let &[output] = network.outputs() else { panic!("one output") };
    executor.tensor(output).real_values().to_vec()
}

/// Halves are rounded to even, and values out of range saturate.
#[test]
fn quantization_rounds_as_the_standard_says() {
    let picture = [0.5, 1.5, 2.5, -0.5, -1.5, 200.0, -300.0, f32::INFINITY];
    let same = |_: &mut ModelBuilder, [x, _, _]: [&str; 3]| x.to_owned();
    assert_eq!(
        run(&picture, (true, 1.0, 0), same),
        [0.0, 2.0, 2.0, 0.0, -2.0, 127.0, -128.0, 127.0]
    );
    assert_eq!(
        run(&picture, (false, 1.0, 3), same),
        [0.0, 2.0, 2.0, 0.0, -2.0, 200.0, -3.0, 252.0]
    );
    assert_eq!(run(&[0.5, -0.75], (true, 0.5, 7), same), [0.5, -1.0]);
}

/// A function that adds a node on the quantized input with another scale and zero point.
type NodeBuilder<'a> = dyn Fn(&mut ModelBuilder, [&str; 3], [&str; 2]) -> String + 'a;

/// Operators of onnxruntime are computed by hand. The input is 1, 2, 3 and -4 with a scale of 0.5
/// and a zero point of 10.
#[test]
fn operators_of_onnxruntime_are_as_it_says() {
    let of = |rest: &NodeBuilder<'_>| {
        run(&[1.0, 2.0, 3.0, -4.0], (true, 0.5, 10), |model, x| {
            let (scale, zero) =
                (model.floats(&[], &[0.25]), model.typed(data_type::INT8, &[], &[-5]));
            rest(model, x, [&scale, &zero])
        })
    };
    let with = |kind: &'static str, attributes: &'static [(&'static str, AttributeValue)]| {
        move |model: &mut ModelBuilder, x: [&str; 3], y: [&str; 2]| {
            model.node(kind, &[x[0], x[1], x[2], y[0], y[1]], attributes)
        }
    };
    let twice = |kind: &'static str| {
        move |model: &mut ModelBuilder, x: [&str; 3], y: [&str; 2]| {
            model.node(kind, &[x[0], x[1], x[2], x[0], x[1], x[2], y[0], y[1]], &[])
        }
    };
    assert_eq!(of(&twice("com.microsoft.QLinearAdd")), [2.0, 4.0, 6.0, -8.0]);
    assert_eq!(of(&twice("com.microsoft.QLinearMul")), [1.0, 4.0, 9.0, 16.0]);
    assert_eq!(of(&with("com.microsoft.QLinearGlobalAveragePool", &[])), [0.5]);
    // With the default alpha of 0.01 the last value is -0.04, which is 0 in steps of 0.25.
    assert_eq!(of(&with("com.microsoft.QLinearLeakyRelu", &[])), [1.0, 2.0, 3.0, 0.0]);
    let steep = [("alpha", AttributeValue::Float(0.5))];
    let leaky = |model: &mut ModelBuilder, x: [&str; 3], y: [&str; 2]| {
        model.node("com.microsoft.QLinearLeakyRelu", &[x[0], x[1], x[2], y[0], y[1]], &steep)
    };
    assert_eq!(of(&leaky), [1.0, 2.0, 3.0, -2.0]);
    // The exact values are 0.73, 0.88, 0.95 and 0.02.
    assert_eq!(of(&with("com.microsoft.QLinearSigmoid", &[])), [0.75, 1.0, 1.0, 0.0]);
    // The exact values are 0.09, 0.24, 0.66 and 0.0006.
    let shares = with("com.microsoft.QLinearSoftmax", &[("opset", AttributeValue::Int(13))]);
    assert_eq!(of(&shares), [0.0, 0.25, 0.75, 0.0]);
    let pairs = |model: &mut ModelBuilder, x: [&str; 3], y: [&str; 2]| {
        let attributes = [
            ("kernel_shape", AttributeValue::Ints(vec![1, 2])),
            ("pads", AttributeValue::Ints(vec![0, 1, 0, 0])),
        ];
        model.node("com.microsoft.QLinearAveragePool", &[x[0], x[1], x[2], y[0], y[1]], &attributes)
    };
    // The first window holds one value of padding, which does not count.
    assert_eq!(of(&pairs), [1.0, 1.5, 2.5, -0.5]);
    let joined = |model: &mut ModelBuilder, x: [&str; 3], y: [&str; 2]| {
        let axis = [("axis", AttributeValue::Int(1))];
        model.node(
            "com.microsoft.QLinearConcat",
            &[y[0], y[1], x[0], x[1], x[2], x[0], x[1], x[2]],
            &axis,
        )
    };
    assert_eq!(of(&joined), [1.0, 2.0, 3.0, -4.0, 1.0, 2.0, 3.0, -4.0]);
}

/// A scale is given for each index of an axis.
#[test]
fn axes_have_scales_of_their_own() {
    let mut model = ModelBuilder::new(&[1, 1, 1, 3]);
    let scales = model.floats(&[3], &[1.0, 0.5, 0.25]);
    let zeros = model.typed(data_type::UINT8, &[3], &[0, 10, 20]);
    let axis = [("axis", AttributeValue::Int(-1))];
    let x = model.node("QuantizeLinear", &["picture", &scales, &zeros], &axis);
    let y = model.node("DequantizeLinear", &[&x, &scales, &zeros], &axis);
    model.output(&y);
    let network = model.read(3, 1).unwrap();
    let mut executor = Executor::new(&network, ExecutionMode::Dense);
    executor.step(&[3.4, -1.6, 1.6], &Mask::full(1, 3));
    // The values are in steps, because no single scale is that of the whole tensor.
    assert_eq!(*executor.tensor(1).real_values(), [3.0, 7.0, 26.0]);
    assert_eq!(*executor.tensor(2).real_values(), [3.0, -1.5, 1.5]);
}

/// A change that rounding to 8 bits removes does not count. A limit is compared with the real
/// numbers that values stand for.
#[test]
fn what_rounds_away_is_not_passed_on() {
    let mut model = ModelBuilder::new(&[1, 1, 8, 8]);
    let scale = model.floats(&[], &[0.1]);
    let x = model.node("QuantizeLinear", &["picture", &scale], &[]);
    let weights = model.typed(data_type::INT8, &[1, 1, 3, 3], &[9; 9]);
    let zero = model.typed(data_type::INT8, &[], &[0]);
    let from = model.typed(data_type::UINT8, &[], &[0]);
    let y = model.node(
        "QLinearConv",
        &[&x, &scale, &from, &weights, &scale, &zero, &scale, &from],
        &[],
    );
    model.output(&y);
    let network = model.read(8, 8).unwrap();
    let before: Vec<f32> =
        noise(1, 64).iter().map(|value| (value.abs() * 10.0).round() / 10.0).collect();
    let changed = |by: f32, mode| {
        let mut executor = Executor::new(&network, mode);
        executor.step(&before, &Mask::full(8, 8));
        let mut after = before.clone();
        after[27] += by;
        executor.step(&after, &Mask::full(8, 8))[0].changed_positions
    };
    assert_eq!(
        (
            changed(0.04, ExecutionMode::Exact),
            changed(0.04, ExecutionMode::Compare),
            changed(0.2, ExecutionMode::Compare)
        ),
        (64, 0, 1)
    );
    assert_eq!(
        (changed(0.2, ExecutionMode::Truncate(0.25)), changed(0.2, ExecutionMode::Truncate(0.15))),
        (0, 1)
    );
}
