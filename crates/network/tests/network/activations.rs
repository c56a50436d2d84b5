// SPDX-License-Identifier: MIT OR Apache-2.0
//! Activations are compared with the formulas of the ONNX standard, in double precision.

use crate::model::{AttributeValue, ModelBuilder};
use foveate_network::{ExecutionMode, Executor, Mask};

/// Runs a node on values from -30 to 30, and returns pairs of input and output.
fn activation_pairs(model: ModelBuilder, name: &str) -> Vec<(f64, f64)> {
    const SIDE: usize = 35;
    let mut model = model;
    model.output(name);
    let network = model.read(SIDE, SIDE).unwrap_or_else(|error| panic!("{error}"));
    let at = |number: usize| f32::from(u16::try_from(number).unwrap()) / 20.4 - 30.0;
    let picture: Vec<f32> = (0..SIDE * SIDE).map(at).collect();
    let mut executor = Executor::new(&network, ExecutionMode::Dense);
    executor.step(&picture, &Mask::full(SIDE, SIDE));
    let values = executor.tensor(network.outputs()[0]).real_values().into_owned();
    picture.iter().zip(values).map(|(&x, y)| (x.into(), y.into())).collect()
}

fn model() -> ModelBuilder {
    ModelBuilder::new(&[1, 1, 35, 35])
}

/// Returns the error function from its series, which converges everywhere.
fn erf(x: f64) -> f64 {
    if x.abs() > 4.5 {
        return x.signum();
    }
    let mut term = x;
    let mut sum = x;
    for n in 1..200 {
        let n = f64::from(n);
        term *= -x * x / n;
        sum += term / (2.0 * n + 1.0);
    }
    sum * 2.0 / std::f64::consts::PI.sqrt()
}

type ActivationFormula = Box<dyn Fn(f64) -> f64>;
type ActivationCase = (&'static str, Vec<(&'static str, AttributeValue)>, ActivationFormula);

#[test]
fn activations_are_those_of_the_standard() {
    let alpha = |value: f32| vec![("alpha", AttributeValue::Float(value))];
    let tanh = vec![("approximate", AttributeValue::Text("tanh"))];
    let below = |x: f64, below: f64| if x < 0.0 { below } else { x };
    let cases: Vec<ActivationCase> = vec![
        ("Celu", vec![], Box::new(move |x| below(x, x.exp() - 1.0))),
        ("Celu", alpha(2.5), Box::new(move |x| below(x, 2.5 * ((x / 2.5).exp() - 1.0)))),
        ("Elu", alpha(0.5), Box::new(move |x| below(x, 0.5 * (x.exp() - 1.0)))),
        ("Gelu", vec![], Box::new(|x| 0.5 * x * (1.0 + erf(x / 2f64.sqrt())))),
        (
            "Gelu",
            tanh,
            Box::new(|x| {
                let inner = (2.0 / std::f64::consts::PI).sqrt() * (x + 0.044715 * x.powi(3));
                0.5 * x * (1.0 + inner.tanh())
            }),
        ),
        ("HardSwish", vec![], Box::new(|x| x * (x / 6.0 + 0.5).clamp(0.0, 1.0))),
        ("LeakyRelu", alpha(0.25), Box::new(move |x| below(x, 0.25 * x))),
        ("Mish", vec![], Box::new(|x| x * x.exp().ln_1p().tanh())),
        (
            "Selu",
            vec![],
            Box::new(move |x| 1.050_700_987 * below(x, 1.673_263_242 * (x.exp() - 1.0))),
        ),
        (
            "Selu",
            vec![("alpha", AttributeValue::Float(2.0)), ("gamma", AttributeValue::Float(3.0))],
            Box::new(move |x| 3.0 * below(x, 2.0 * (x.exp() - 1.0))),
        ),
        ("Softplus", vec![], Box::new(|x| x.exp().ln_1p())),
        ("Softsign", vec![], Box::new(|x| x / (1.0 + x.abs()))),
        ("Swish", vec![], Box::new(|x| x / (1.0 + (-x).exp()))),
        ("Swish", alpha(1.5), Box::new(|x| x / (1.0 + (-1.5 * x).exp()))),
        ("ThresholdedRelu", alpha(2.0), Box::new(|x| if x > 2.0 { x } else { 0.0 })),
    ];
    for (kind, attributes, formula) in cases {
        let mut model = model();
        let output = model.node(kind, &["picture"], &attributes);
        for (x, y) in activation_pairs(model, &output) {
            let wanted = formula(x);
            assert!(
                (y - wanted).abs() <= 2e-6 * (1.0 + x.abs()),
                "{kind}({x}) = {y}, not {wanted}"
            );
        }
    }
}

/// The product of a tensor with its sigmoid becomes an activation of the operator before, unless
/// another node takes the tensor or the sigmoid.
#[test]
fn a_sigmoid_that_gates_its_own_input_is_joined_to_it() {
    let kinds = |others: &[&str]| {
        let mut model = model();
        let weights = model.floats(&[1, 1, 1, 1], &[1.0]);
        let conv = model.node("Conv", &["picture", &weights], &[]);
        let gate = model.node("Sigmoid", &[&conv], &[]);
        let gated = model.node("Mul", &[&gate, &conv], &[]);
        for other in others {
            let other = model.node("Abs", &[if *other == "conv" { &conv } else { &gate }], &[]);
            model.output(&other);
        }
        model.output(&gated);
        let network = model.read(35, 35).unwrap();
        network.nodes().iter().map(|node| node.operator_name().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&[]), ["Conv+Sigmoid+Mul"]);
    assert_eq!(kinds(&["conv"]), ["Conv", "Sigmoid+Mul", "Abs"]);
    assert_eq!(kinds(&["gate"]), ["Conv", "Sigmoid", "Mul", "Abs"]);
    let mut model = model();
    let gate = model.node("Sigmoid", &["picture"], &[]);
    let output = model.node("Mul", &["picture", &gate], &[]);
    for (x, y) in activation_pairs(model, &output) {
        assert!((y - x / (1.0 + (-x).exp())).abs() <= 2e-6 * (1.0 + x.abs()), "{x}: {y}");
    }
}

#[test]
fn a_slope_is_that_of_its_channel_and_sums_take_one_or_two() {
    let mut model = model();
    let channels = model.floats(&[3, 1, 1, 1], &[1.0, -1.0, 2.0]);
    let spread = model.node("Conv", &["picture", &channels], &[]);
    let slopes = model.floats(&[3, 1, 1], &[0.5, 0.25, -1.0]);
    let sloped = model.node("PRelu", &[&spread, &slopes], &[]);
    let mixing = model.floats(&[1, 3, 1, 1], &[1.0, 1.0, 1.0]);
    let mixed = model.node("Conv", &[&sloped, &mixing], &[]);
    let same = model.node("Sum", &[&mixed], &[]);
    let output = model.node("Sum", &[&same, "picture"], &[]);
    let slope = |x: f64, slope: f64| if x < 0.0 { slope * x } else { x };
    for (x, y) in activation_pairs(model, &output) {
        let wanted = slope(x, 0.5) + slope(-x, 0.25) + slope(2.0 * x, -1.0) + x;
        assert!((y - wanted).abs() < 1e-4, "{x}: {y}, not {wanted}");
    }
}
