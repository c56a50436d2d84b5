// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arithmetic, comparisons and selection of constants, with broadcasting.

use super::constant::Constant;
use super::constant_selection::broadcast_constant;
use super::constant_values::ConstantValues;
use super::model_folder::ModelFolder;
use crate::activation::Activation;
use crate::onnx::data_type;
use crate::operator::broadcast_shape;

type FoldResult<T> = Result<T, String>;

/// Applies a function of one value to a constant, or returns `None` if the operator is not known.
pub(super) fn unary_operation(kind: &str, from: &Constant) -> FoldResult<Option<Constant>> {
    let activation = match kind {
        "Abs" => Activation::Abs,
        "Ceil" => Activation::Ceil,
        "Cos" => Activation::Cos,
        "Exp" => Activation::Exp,
        "Floor" => Activation::Floor,
        "Log" => Activation::Log,
        "Neg" => Activation::Neg,
        "Reciprocal" => Activation::Reciprocal,
        "Round" => Activation::Round,
        "Sin" => Activation::Sin,
        "Sqrt" => Activation::Sqrt,
        _ => return Ok(None),
    };
    let values = match (&from.values, activation) {
        (ConstantValues::Floats(values), activation) => {
            ConstantValues::Floats(values.iter().map(|&value| activation.apply(value)).collect())
        }
        (ConstantValues::Integers(values), Activation::Neg) => {
            ConstantValues::Integers(values.iter().map(|value| value.wrapping_neg()).collect())
        }
        (ConstantValues::Integers(values), Activation::Abs) => {
            ConstantValues::Integers(values.iter().map(|value| value.wrapping_abs()).collect())
        }
        (ConstantValues::Integers(_), _) => {
            return Err("its constant has integers, which are not supported here".to_owned());
        }
    };
    Ok(Some(Constant { values, ..from.clone() }))
}

/// Applies a function of two values to two constants, or returns `None` if the operator is not
/// known.
pub(super) fn binary_operation(
    folder: &ModelFolder,
    kind: &str,
    a: &Constant,
    b: &Constant,
) -> FoldResult<Option<Constant>> {
    let is_known = ["Add", "Sub", "Mul", "Div", "Pow", "Min", "Max"].contains(&kind);
    let is_comparison =
        ["Equal", "Greater", "GreaterOrEqual", "Less", "LessOrEqual"].contains(&kind);
    if !is_known && !is_comparison {
        return Ok(None);
    }
    let shape = broadcast_shape_of(&[a, b])?;
    let (a, mut b) =
        (broadcast_constant(folder, a, &shape)?, broadcast_constant(folder, b, &shape)?);
    if kind == "Pow" {
        b = cast_exponent(&b, a.data_type)?;
    }
    let values = match (&a.values, &b.values) {
        (ConstantValues::Integers(values_of_a), ConstantValues::Integers(values_of_b)) => {
            let pairs = values_of_a.iter().zip(values_of_b);
            let values: Option<Vec<i64>> =
                pairs.map(|(&a, &b)| integer_operation(kind, a, b)).collect();
            ConstantValues::Integers(values.ok_or("its result does not fit into 64 bits")?)
        }
        (ConstantValues::Floats(values_of_a), ConstantValues::Floats(values_of_b)) => {
            let pairs = values_of_a.iter().zip(values_of_b);
            if is_comparison {
                ConstantValues::Integers(pairs.map(|(a, b)| compare(kind, a, b).into()).collect())
            } else {
                ConstantValues::Floats(pairs.map(|(&a, &b)| float_operation(kind, a, b)).collect())
            }
        }
        (ConstantValues::Integers(_), ConstantValues::Floats(_))
        | (ConstantValues::Floats(_), ConstantValues::Integers(_)) => {
            return Err("one of its constants has integers, but the other does not".to_owned());
        }
    };
    let kind = if is_comparison { data_type::BOOL } else { a.data_type };
    Ok(Some(Constant { shape, values, data_type: kind }))
}

/// Returns an exponent in the type of the base of its power. The exponent may be of another type.
pub(super) fn cast_exponent(exponent: &Constant, base: i32) -> FoldResult<Constant> {
    let largest = 1 << f32::MANTISSA_DIGITS;
    if let ConstantValues::Integers(values) = &exponent.values
        && let Some(too_large) = values.iter().find(|value| !(-largest..=largest).contains(*value))
    {
        return Err(format!(
            "its exponent is {too_large}; integers are from {} to {largest}",
            -largest
        ));
    }
    let is_whole = |value: &f32| value.fract() == 0.0;
    let is_integer = base == data_type::INT64 || base == data_type::INT32;
    match &exponent.values {
        ConstantValues::Floats(values) if is_integer && !values.iter().all(is_whole) => {
            Err("a power of integers with an exponent that is not a whole number is not supported"
                .to_owned())
        }
        _ => exponent.cast(base),
    }
}

fn compare<T: PartialOrd>(kind: &str, a: &T, b: &T) -> bool {
    match kind {
        "Equal" => a == b,
        "Greater" => a > b,
        "GreaterOrEqual" => a >= b,
        "Less" => a < b,
        _ => a <= b,
    }
}

fn integer_operation(kind: &str, a: i64, b: i64) -> Option<i64> {
    match kind {
        "Add" => a.checked_add(b),
        "Sub" => a.checked_sub(b),
        "Mul" => a.checked_mul(b),
        "Div" => a.checked_div(b),
        "Pow" => u32::try_from(b).ok().and_then(|b| a.checked_pow(b)),
        "Min" => Some(a.min(b)),
        "Max" => Some(a.max(b)),
        _ => Some(compare(kind, &a, &b).into()),
    }
}

fn float_operation(kind: &str, a: f32, b: f32) -> f32 {
    match kind {
        "Add" => a + b,
        "Sub" => a - b,
        "Mul" => a * b,
        "Div" => a / b,
        "Pow" => a.powf(b),
        // A NaN stays, as in the operators that run on frames; `f32::min` would drop it.
        "Min" if b < a || b.is_nan() => b,
        "Max" if b > a || b.is_nan() => b,
        _ => a,
    }
}

/// Returns the values of `a` where the condition is not 0, and the values of `b` elsewhere.
pub(super) fn select_by_condition(
    folder: &ModelFolder,
    condition: &Constant,
    a: &Constant,
    b: &Constant,
) -> FoldResult<Constant> {
    let shape = broadcast_shape_of(&[condition, a, b])?;
    let conditions = broadcast_constant(folder, condition, &shape)?;
    let (a, b) = (broadcast_constant(folder, a, &shape)?, broadcast_constant(folder, b, &shape)?);
    let conditions = conditions.as_integers()?;
    fn chosen<T: Copy>(conditions: &[i64], a: &[T], b: &[T]) -> Vec<T> {
        conditions
            .iter()
            .zip(a.iter().zip(b))
            .map(|(&condition, (&a, &b))| if condition == 0 { b } else { a })
            .collect()
    }
    let values = match (&a.values, &b.values) {
        (ConstantValues::Integers(values_of_a), ConstantValues::Integers(values_of_b)) => {
            ConstantValues::Integers(chosen(conditions, values_of_a, values_of_b))
        }
        (ConstantValues::Floats(values_of_a), ConstantValues::Floats(values_of_b)) => {
            ConstantValues::Floats(chosen(conditions, values_of_a, values_of_b))
        }
        (ConstantValues::Integers(_), ConstantValues::Floats(_))
        | (ConstantValues::Floats(_), ConstantValues::Integers(_)) => {
            return Err("one of its constants has integers, but the other does not".to_owned());
        }
    };
    Ok(Constant { shape, values, data_type: a.data_type })
}

/// Returns the numbers from a start to before a limit, in steps, as `Range` of ONNX defines it.
pub(super) fn number_range(folder: &ModelFolder, inputs: &[&Constant]) -> FoldResult<Constant> {
    let &[start, limit, delta] = inputs else {
        return Err(format!("it has {} inputs, not 3", inputs.len()));
    };
    let kind = start.data_type;
    if let (Ok(&[start]), Ok(&[limit]), Ok(&[delta])) =
        (start.as_integers(), limit.as_integers(), delta.as_integers())
    {
        let distance = i128::from(limit) - i128::from(start);
        let count = match i128::from(delta) {
            0 => return Err("its step is 0".to_owned()),
            delta => (distance / delta
                + i128::from(distance % delta != 0 && (distance < 0) == (delta < 0)))
            .max(0),
        };
        let shape = vec![usize::try_from(count).unwrap_or(usize::MAX)];
        let count = folder.check_room(&shape, &ConstantValues::Integers(Vec::new()))?;
        let numbers = (0..).take(count);
        let values = numbers.map(|at: i64| start.wrapping_add(at.wrapping_mul(delta))).collect();
        return Ok(Constant { shape, values: ConstantValues::Integers(values), data_type: kind });
    }
    let single_number = |constant: &Constant| match constant.as_floats()? {
        &[value] => Ok(value),
        values => Err(format!("it takes single numbers, not {}", values.len())),
    };
    let (start, limit, delta) =
        (single_number(start)?, single_number(limit)?, single_number(delta)?);
    let count = ((limit - start) / delta).ceil().max(0.0);
    if count.is_nan() {
        return Err(format!("there are no numbers from {start} to {limit} in steps of {delta}"));
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is not negative"
    )]
    let shape = [count as usize];
    let count = folder.check_room(&shape, &ConstantValues::Floats(Vec::new()))?;
    #[allow(clippy::cast_precision_loss, reason = "as the operator says")]
    let values = (0..count).map(|at| start + at as f32 * delta).collect();
    Ok(Constant::floats(vec![count], values))
}

/// Returns the shape of all constants broadcast together.
fn broadcast_shape_of(constants: &[&Constant]) -> FoldResult<Vec<usize>> {
    constants.iter().try_fold(Vec::new(), |shape: Vec<usize>, constant| {
        broadcast_shape(&shape, &constant.shape)
            .ok_or_else(|| format!("{shape:?} and {:?} do not fit together", constant.shape))
    })
}

#[cfg(test)]
mod tests {
    use super::float_operation;

    /// Constants are folded as the operators compute: `f32::min` would drop a NaN.
    #[test]
    fn the_smaller_and_the_larger_of_a_nan_are_a_nan() {
        for kind in ["Min", "Max"] {
            assert!(float_operation(kind, f32::NAN, 1.0).is_nan(), "{kind}");
            assert!(float_operation(kind, 1.0, f32::NAN).is_nan(), "{kind}");
        }
        assert_eq!(
            [("Min", 1.0), ("Max", 2.0)].map(|(kind, _)| float_operation(kind, 1.0, 2.0)),
            [1.0, 2.0]
        );
    }
}
