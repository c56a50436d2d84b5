// SPDX-License-Identifier: MIT OR Apache-2.0
//! Activation functions of one value.

/// An activation function of one value, as ONNX defines it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Activation {
    Identity,
    Relu,
    LeakyRelu {
        alpha: f32,
    },
    ThresholdedRelu {
        alpha: f32,
    },
    Elu {
        alpha: f32,
    },
    Celu {
        alpha: f32,
    },
    Selu {
        alpha: f32,
        gamma: f32,
    },
    Clip {
        min: f32,
        max: f32,
    },
    Sigmoid,
    HardSigmoid {
        alpha: f32,
        beta: f32,
    },
    HardSwish,
    Swish {
        alpha: f32,
    },
    Gelu,
    /// The GELU with a hyperbolic tangent in place of the error function.
    TanhGelu,
    Mish,
    Tanh,
    Softplus,
    Softsign,
    Exp,
    Log,
    Sqrt,
    Abs,
    Neg,
    Erf,
    Reciprocal,
    Floor,
    Ceil,
    Round,
    Sign,
    Sin,
    Cos,
}

impl Activation {
    #[inline(always)]
    pub(crate) fn apply(self, x: f32) -> f32 {
        match self {
            Self::Identity => x,
            // `max` is not used, because it would turn NaN into 0.
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
            Self::ThresholdedRelu { alpha } => {
                if x <= alpha {
                    0.0
                } else {
                    x
                }
            }
            Self::Elu { alpha } => elu(x, alpha),
            Self::Celu { alpha } => {
                if x < 0.0 {
                    alpha * (x / alpha).exp_m1()
                } else {
                    x
                }
            }
            Self::Selu { alpha, gamma } => gamma * elu(x, alpha),
            Self::Clip { min, max } => {
                let x = if x < min { min } else { x };
                if x > max { max } else { x }
            }
            Self::Sigmoid => sigmoid(x),
            Self::HardSigmoid { alpha, beta } => (alpha * x + beta).clamp(0.0, 1.0),
            Self::HardSwish => x * (x / 6.0 + 0.5).clamp(0.0, 1.0),
            Self::Swish { alpha } => x * sigmoid(alpha * x),
            Self::Gelu => 0.5 * x * (1.0 + erf(x * std::f32::consts::FRAC_1_SQRT_2)),
            Self::TanhGelu => {
                // The constant is the square root of 2 / pi.
                0.5 * x * (1.0 + (0.797_884_6 * (x + 0.044_715 * x * x * x)).tanh())
            }
            Self::Mish => x * softplus(x).tanh(),
            Self::Tanh => x.tanh(),
            Self::Softplus => softplus(x),
            Self::Softsign => x / (1.0 + x.abs()),
            Self::Exp => x.exp(),
            Self::Log => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Neg => -x,
            Self::Erf => erf(x),
            Self::Reciprocal => 1.0 / x,
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            // Halves are rounded to the even integer, as ONNX defines it.
            Self::Round => x.round_ties_even(),
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => 1.0f32.copysign(x),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
        }
    }

    /// Applies the function to every value. The usual functions have loops of their own, which
    /// become vector instructions.
    #[inline(always)]
    pub(crate) fn apply_to_all(self, values: &mut [f32]) {
        match self {
            Self::Identity => {}
            Self::Relu => replace(values, |x| Self::Relu.apply(x)),
            Self::Clip { min, max } => replace(values, |x| Self::Clip { min, max }.apply(x)),
            Self::Sigmoid => replace(values, sigmoid),
            Self::Swish { alpha } => replace(values, |x| Self::Swish { alpha }.apply(x)),
            Self::HardSwish => replace(values, |x| Self::HardSwish.apply(x)),
            other => replace(values, |x| other.apply(x)),
        }
    }
}

#[inline(always)]
fn replace(values: &mut [f32], function: impl Fn(f32) -> f32) {
    for value in values {
        *value = function(*value);
    }
}

#[inline(always)]
fn elu(x: f32, alpha: f32) -> f32 {
    if x < 0.0 { alpha * x.exp_m1() } else { x }
}

#[inline(always)]
fn softplus(x: f32) -> f32 {
    if x > 20.0 { x } else { x.exp().ln_1p() }
}

#[inline(always)]
fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + exp(-x))
}

/// Returns the exponential function with a relative error of at most 2e-7, limited to the range
/// from e^-87 to e^88. It has no branches, so that loops of it become vector instructions. It is
/// computed as 2^n e^r, where n is the nearest integer to x / ln(2), and |r| <= ln(2) / 2. The
/// polynomial and the two parts of ln(2) are those of `expf` in Moshier's Cephes library.
#[inline(always)]
fn exp(x: f32) -> f32 {
    // Added to a small number, this constant leaves the nearest integer in the last bits.
    const ROUND: f32 = 12_582_912.0;
    let x = if x < -87.0 { -87.0 } else { x };
    let x = if x > 88.0 { 88.0 } else { x };
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = x - n * 0.693_359_4 - n * -2.121_944_4e-4;
    let series = [1.398_2e-3, 8.333_452e-3, 4.166_579_6e-2, 1.666_666_6e-1, 0.5];
    let sum = series.iter().fold(1.987_569_1e-4, |sum, term| sum * r + term);
    let power = f32::from_bits(shifted.to_bits().wrapping_add(127) << 23);
    (sum * r * r + r + 1.0) * power
}

/// Returns the error function with an error of at most 1.5e-7: Abramowitz and Stegun, Handbook of
/// Mathematical Functions, 7.1.26.
fn erf(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * f64::from(x.abs()));
    let series = [1.061_405_429, -1.453_152_027, 1.421_413_741, -0.284_496_736, 0.254_829_592];
    let sum = series.iter().fold(0.0, |sum, term| (sum + term) * t);
    let value = 1.0 - sum * (-f64::from(x) * f64::from(x)).exp();
    #[allow(clippy::cast_possible_truncation, reason = "the value is needed as a 32-bit one")]
    let value = value as f32;
    value.copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_function_is_exact_to_two_parts_in_ten_million() {
        let mut x = -86.99f32;
        while x < 87.99 {
            let exact = f64::from(x).exp();
            assert!((f64::from(exp(x)) - exact).abs() <= 2e-7 * exact, "{x}: {}", exp(x));
            x += 0.000_713;
        }
        assert!(exp(f32::NAN).is_nan());
        assert!(sigmoid(-1e30) < 1e-37 && (sigmoid(1e30) - 1.0).abs() < 1e-7);
        assert_eq!((sigmoid(f32::NEG_INFINITY) < 1e-37, sigmoid(f32::INFINITY)), (true, 1.0));
        assert!(sigmoid(f32::NAN).is_nan());
    }
}
