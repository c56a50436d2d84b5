// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scales, zero points and weights of quantized networks, with their checks.

use super::constant::Constant;
use super::constant_values::ConstantValues;
use super::node::NodeReader;
use crate::element::{ElementType, Encoding};
use crate::onnx::data_type;
use crate::operator::{ByteWeightRows, QuantizationScales};
use std::borrow::Cow;

type ScaleResult<T> = Result<T, String>;

impl NodeReader<'_> {
    /// Returns the scales at an input, which must be positive. There must be one or `count`;
    /// without `count` any number but none is valid.
    fn scales(&self, at: usize, what: &str, count: Option<usize>) -> ScaleResult<Vec<f32>> {
        let scales = self.required_constant(at, what)?.as_floats()?;
        if let Some(invalid) = scales.iter().find(|scale| !scale.is_finite() || **scale <= 0.0) {
            return Err(format!("its {what} is {invalid}; it must be more than 0"));
        }
        match (scales.len(), count) {
            (1, _) => Ok(scales.to_vec()),
            (0, None) => Err(format!("its {what} is empty")),
            (_, None) => Ok(scales.to_vec()),
            (found, Some(count)) if found == count => Ok(scales.to_vec()),
            (found, Some(1)) => Err(format!("its {what} has {found} values; it must have 1")),
            (found, Some(count)) => {
                Err(format!("its {what} has {found} values; it must have 1 or {count}"))
            }
        }
    }

    /// Returns `count` zero points from an input that has one or `count`. They are 0 if the node
    /// has none.
    fn zero_points(
        &self,
        at: usize,
        what: &str,
        element: ElementType,
        count: usize,
    ) -> ScaleResult<Vec<i32>> {
        let Some(zeros) = self.constant(at, what)? else { return Ok(vec![0; count]) };
        if zeros.element() != Some(element) {
            return Err(format!("its {what} must have {}, as its tensor has", element.describe()));
        }
        let (lowest, highest) = if element.is_byte() { element.range() } else { (0, 0) };
        let zero = |&zero: &i64| {
            i32::try_from(zero)
                .ok()
                .filter(|zero| (lowest..=highest).contains(zero))
                .ok_or_else(|| format!("its {what} is {zero}; it must be {lowest} to {highest}"))
        };
        let found: Vec<i32> = zeros.as_integers()?.iter().map(zero).collect::<ScaleResult<_>>()?;
        match found.as_slice() {
            &[one] => Ok(vec![one; count]),
            _ if found.len() == count => Ok(found),
            _ => Err(format!("its {what} has {} values; it must have {count}", found.len())),
        }
    }

    /// Returns the only zero point of a tensor.
    pub(super) fn zero_point(
        &self,
        at: usize,
        what: &str,
        element: ElementType,
    ) -> ScaleResult<i32> {
        self.zero_points(at, what, element, 1).map(|zeros| zeros[0])
    }

    /// Returns the encoding of a tensor whose scale is at an input and whose zero point is at the
    /// next.
    pub(super) fn encoding(
        &self,
        at: usize,
        what: &str,
        element: ElementType,
    ) -> ScaleResult<Encoding> {
        let scale = self.scales(at, &format!("{what}_scale"), Some(1))?[0];
        let zero = self.zero_point(at + 1, &format!("{what}_zero_point"), element)?;
        Ok(Encoding { element, scale, zero_point: zero })
    }

    /// Returns the encoding of an output whose scale is at an input. The zero point at the next
    /// input determines the type.
    pub(super) fn output_encoding(&self, at: usize, what: &str) -> ScaleResult<Encoding> {
        let element = match self.constant(at + 1, &format!("{what}_zero_point"))? {
            None => ElementType::U8,
            Some(zero) => checked_byte_type(zero.element(), &format!("{what}_zero_point"))?,
        };
        self.encoding(at, what, element)
    }

    /// Returns the real number that a step of a sum stands for, as a product of factors. There is
    /// one for all of `count` channels, or one per channel.
    pub(super) fn factors(
        &self,
        [scale, alpha]: [f32; 2],
        (at, what): (usize, &str),
        count: usize,
    ) -> ScaleResult<Vec<f32>> {
        let scales = self.scales(at, what, Some(count))?;
        Ok(scales.into_iter().map(|tensor_scale| alpha * (scale * tensor_scale)).collect())
    }

    /// Returns a bias of 32-bit integers, or an empty one if the node has none.
    pub(super) fn bias(&self, at: usize) -> ScaleResult<Vec<i32>> {
        let Some(bias) = self.constant(at, "bias")? else { return Ok(Vec::new()) };
        if bias.element() != Some(ElementType::I32) {
            return Err("its bias must be of 32-bit integers".to_owned());
        }
        let value = |&value: &i64| {
            i32::try_from(value)
                .map_err(|_| format!("its bias is {value}, which does not fit into 32 bits"))
        };
        bias.as_integers()?.iter().map(value).collect()
    }

    /// Returns the scales and zero points of `QuantizeLinear`, and the type of its output.
    pub(super) fn quantization(&self) -> ScaleResult<(QuantizationScales, ElementType)> {
        let declared = match self.int("output_dtype", 0) {
            0 => None,
            number if number == i64::from(data_type::UINT8) => Some(ElementType::U8),
            number if number == i64::from(data_type::INT8) => Some(ElementType::I8),
            other => {
                let other = data_type::type_name(other);
                return Err(format!(
                    "an output_dtype of {other} is not supported, only UINT8 and INT8"
                ));
            }
        };
        let to = match self.constant(2, "y_zero_point")? {
            None => declared.unwrap_or(ElementType::U8),
            Some(zero) => checked_byte_type(zero.element(), "y_zero_point")?,
        };
        Ok((self.axis_scales("y", to)?, to))
    }

    /// Returns the scales and zero points of `DequantizeLinear` for integers of this type.
    pub(super) fn dequantization(&self, element: ElementType) -> ScaleResult<QuantizationScales> {
        let to = self.data_type("output_dtype")?;
        if ![0, data_type::FLOAT, data_type::FLOAT16, data_type::BFLOAT16].contains(&to) {
            let to = data_type::type_name(to.into());
            return Err(format!("an output_dtype of {to} is not supported"));
        }
        self.axis_scales("x", element)
    }

    fn axis_scales(&self, what: &str, element: ElementType) -> ScaleResult<QuantizationScales> {
        if self.int("block_size", 0) != 0 {
            return Err("blocked quantization is not supported".to_owned());
        }
        let scales = self.scales(1, &format!("{what}_scale"), None)?;
        let zeros = self.zero_points(2, &format!("{what}_zero_point"), element, scales.len())?;
        Ok(QuantizationScales { scales, zero_points: zeros, axis: self.int("axis", 1) })
    }
}

fn checked_byte_type(element: Option<ElementType>, what: &str) -> ScaleResult<ElementType> {
    element.filter(|element| element.is_byte()).ok_or_else(|| {
        format!("its {what} must have 8-bit integers; other types are not supported")
    })
}

/// Returns constant weights with one row per channel. Their zero points, one or one per channel,
/// are at the input `zeros`.
pub(super) fn byte_weight_rows(
    node: &NodeReader<'_>,
    weights: &Constant,
    zeros: usize,
    channels: usize,
) -> ScaleResult<ByteWeightRows> {
    let element = checked_byte_type(weights.element(), "weights")?;
    let (lowest, highest) = element.range();
    // Unsigned values are stored less 128, so that 0 becomes the lowest signed value.
    let stored_weight = |value: i64| {
        Some(value)
            .filter(|value| (lowest.into()..=highest.into()).contains(value))
            .and_then(|value| i8::try_from(value - i64::from(lowest) + i64::from(i8::MIN)).ok())
    };
    let weight = |&value: &i64| {
        stored_weight(value).ok_or_else(|| {
            format!("a weight of {value} is outside of its 8 bits, {lowest} to {highest}")
        })
    };
    let values: Vec<i8> = weights.as_integers()?.iter().map(weight).collect::<ScaleResult<_>>()?;
    if values.is_empty() {
        return Err(format!("a constant of weights is empty: {:?}", weights.shape));
    }
    let zeros = node.zero_points(zeros, "zero point of weights", element, channels)?;
    let zeros =
        zeros.into_iter().map(|zero| stored_weight(zero.into()).expect("it has been checked"));
    Ok(ByteWeightRows { values, zero_points: zeros.collect() })
}

/// Returns a matrix with one row per output, and its numbers of outputs and inputs.
pub(super) fn row_major_matrix(
    matrix: &Constant,
    is_row_major: bool,
) -> ScaleResult<(Cow<'_, Constant>, usize, usize)> {
    let &[rows, columns] = matrix.shape.as_slice() else {
        return Err(format!("its matrix has {} axes, not 2", matrix.shape.len()));
    };
    if rows == 0 || columns == 0 {
        return Err(format!("a constant of weights is empty: {:?}", matrix.shape));
    }
    if is_row_major {
        return Ok((Cow::Borrowed(matrix), rows, columns));
    }
    let values = matrix.as_integers()?;
    let transposed = |output| (0..rows).map(move |input| values[input * columns + output]);
    let values = (0..columns).flat_map(transposed).collect();
    let transposed = Constant {
        shape: vec![columns, rows],
        values: ConstantValues::Integers(values),
        ..*matrix
    };
    Ok((Cow::Owned(transposed), columns, rows))
}
