// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions of one value.

use super::{Job, Operator, only};
use crate::form::Form;

/// A function of one value, by the definition of ONNX.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Activation {
    Identity,
    Relu,
    LeakyRelu { alpha: f32 },
    Elu { alpha: f32 },
    Clip { min: f32, max: f32 },
    Sigmoid,
    HardSigmoid { alpha: f32, beta: f32 },
    HardSwish,
    Tanh,
    Softplus,
    Exp,
    Log,
    Sqrt,
    Abs,
    Neg,
    Erf,
}

impl Activation {
    #[inline(always)]
    pub(crate) fn of(self, x: f32) -> f32 {
        match self {
            Self::Identity => x,
            // Not `max`, which would make 0 of NaN.
            Self::Relu => {
                if x < 0.0 {
                    0.0
                } else {
                    x
                }
            }
            Self::LeakyRelu { alpha } => {
                if x < 0.0 {
                    alpha * x
                } else {
                    x
                }
            }
            Self::Elu { alpha } => {
                if x < 0.0 {
                    alpha * x.exp_m1()
                } else {
                    x
                }
            }
            Self::Clip { min, max } => {
                let x = if x < min { min } else { x };
                if x > max { max } else { x }
            }
            Self::Sigmoid => sigmoid(x),
            Self::HardSigmoid { alpha, beta } => (alpha * x + beta).clamp(0.0, 1.0),
            Self::HardSwish => x * (x / 6.0 + 0.5).clamp(0.0, 1.0),
            Self::Tanh => x.tanh(),
            Self::Softplus => {
                if x > 20.0 {
                    x
                } else {
                    x.exp().ln_1p()
                }
            }
            Self::Exp => x.exp(),
            Self::Log => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Neg => -x,
            Self::Erf => erf(x),
        }
    }
}

fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + (-x).exp())
}

/// The error function, to 1.5e-7: Abramowitz and Stegun, Handbook of Mathematical Functions, 7.1.26.
fn erf(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * f64::from(x.abs()));
    let series = [1.061_405_429, -1.453_152_027, 1.421_413_741, -0.284_496_736, 0.254_829_592];
    let sum = series.iter().fold(0.0, |sum, term| (sum + term) * t);
    let value = 1.0 - sum * (-f64::from(x) * f64::from(x)).exp();
    #[allow(clippy::cast_possible_truncation, reason = "the value is needed as a 32-bit one")]
    let value = value as f32;
    value.copysign(x)
}

/// An activation as a node of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pointwise(pub(crate) Activation);

impl Operator for Pointwise {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        only(inputs).cloned()
    }

    fn compute(&self, job: Job<'_>) {
        let from = job.inputs[0].values::<f32>();
        job.fill(|run, to| {
            for (to, &from) in to.iter_mut().zip(&from[run]) {
                *to = self.0.of(from);
            }
        });
    }
}
