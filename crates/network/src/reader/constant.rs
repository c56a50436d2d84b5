// SPDX-License-Identifier: MIT OR Apache-2.0
//! Constant tensors of a model ([`Constant`]), with the decoding of their values in messages.

use super::constant_values::ConstantValues;
use super::model_folder::{ModelFolder, read_external_data};
use crate::element::{ElementType, Encoding};
use crate::onnx::{TensorProto, data_type};
use crate::tensor::{MAX_AXES, Tensor, TensorForm, checked_element_count};
use crate::values::TensorNumber;

/// A constant tensor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Constant {
    pub(super) shape: Vec<usize>,
    pub(super) values: ConstantValues,
    /// The element type, a number of `data_type`.
    pub(super) data_type: i32,
}

impl Constant {
    pub(super) fn integers(shape: Vec<usize>, values: Vec<i64>) -> Self {
        Self { shape, values: ConstantValues::Integers(values), data_type: data_type::INT64 }
    }

    pub(super) fn floats(shape: Vec<usize>, values: Vec<f32>) -> Self {
        Self { shape, values: ConstantValues::Floats(values), data_type: data_type::FLOAT }
    }

    /// Decodes a tensor. Its memory grows with the data that are present, not with what the shape
    /// claims.
    pub(super) fn decode(tensor: &TensorProto, folder: &ModelFolder) -> Result<Self, String> {
        let length = |&length: &i64| {
            usize::try_from(length).map_err(|_| format!("its shape has a length of {length}"))
        };
        if tensor.dims.len() > MAX_AXES {
            return Err(format!("it has {} axes, more than {MAX_AXES}", tensor.dims.len()));
        }
        let shape: Vec<usize> = tensor.dims.iter().map(length).collect::<Result<_, _>>()?;
        let kind = tensor.data_type.unwrap_or(0);
        let values = if tensor.data_location == Some(TensorProto::EXTERNAL) {
            decode_raw(kind, &read_external_data(tensor, folder)?)?
        } else if let Some(raw) = &tensor.raw_data {
            decode_raw(kind, raw)?
        } else {
            decode_fields(kind, tensor)?
        };
        if checked_element_count(&shape) != Some(values.value_count()) {
            return Err(format!("it has {} values, but the shape {shape:?}", values.value_count()));
        }
        Ok(Self { shape, values, data_type: kind })
    }

    /// Returns the stored values of a tensor as a constant.
    pub(super) fn from_tensor(tensor: &Tensor) -> Self {
        fn integers<T: TensorNumber + Into<i64>>(tensor: &Tensor) -> ConstantValues {
            ConstantValues::Integers(
                tensor.values::<T>().iter().map(|&value| value.into()).collect(),
            )
        }
        let (values, kind) = match tensor.form().encoding().element {
            ElementType::F32 => {
                (ConstantValues::Floats(tensor.values().to_vec()), data_type::FLOAT)
            }
            ElementType::U8 => (integers::<u8>(tensor), data_type::UINT8),
            ElementType::I8 => (integers::<i8>(tensor), data_type::INT8),
            ElementType::I32 => (integers::<i32>(tensor), data_type::INT32),
        };
        Self { shape: tensor.form().shape().to_vec(), values, data_type: kind }
    }

    /// Encodes the values as `raw_data` of an element type. Floating-point values have 32 bits,
    /// whatever the type.
    pub(super) fn encode(&self, kind: i32) -> Result<TensorProto, String> {
        let converted = self.cast(kind)?;
        let (bytes, kind) = match &converted.values {
            ConstantValues::Floats(values) => {
                (values.iter().flat_map(|value| value.to_le_bytes()).collect(), data_type::FLOAT)
            }
            ConstantValues::Integers(values) => {
                let width = match kind {
                    data_type::BOOL | data_type::UINT8 | data_type::INT8 => 1,
                    data_type::INT32 => 4,
                    _ => 8,
                };
                let low_bytes = |value: &i64| value.to_le_bytes().into_iter().take(width);
                (values.iter().flat_map(low_bytes).collect(), kind)
            }
        };
        Ok(TensorProto {
            dims: self
                .shape
                .iter()
                .map(|&length| i64::try_from(length).expect("a length is below 2^63"))
                .collect(),
            data_type: Some(kind),
            raw_data: Some(bytes),
            ..TensorProto::default()
        })
    }

    /// The type in which tensors store the values, if there is one.
    pub(super) fn element(&self) -> Option<ElementType> {
        element_of(self.data_type)
    }

    /// Converts the values to another type, as `Cast` of ONNX defines it.
    pub(super) fn cast(&self, kind: i32) -> Result<Self, String> {
        #[allow(clippy::cast_precision_loss, reason = "a cast rounds")]
        let float = |&value: &i64| value as f32;
        let values = match (element_of(kind), &self.values) {
            (Some(ElementType::F32), ConstantValues::Floats(_)) => self.values.clone(),
            (Some(ElementType::F32), ConstantValues::Integers(values)) => {
                ConstantValues::Floats(values.iter().map(float).collect())
            }
            (None, _) if kind != data_type::INT64 => {
                return Err(format!(
                    "a cast of a constant to {} is not supported",
                    data_type::type_name(kind.into())
                ));
            }
            (_, ConstantValues::Integers(values)) => ConstantValues::Integers(
                values.iter().map(|&value| cast_integer(value, kind)).collect(),
            ),
            (_, ConstantValues::Floats(values)) if kind == data_type::BOOL => {
                ConstantValues::Integers(
                    values.iter().map(|&value| i64::from(value != 0.0)).collect(),
                )
            }
            #[allow(clippy::cast_possible_truncation, reason = "a cast cuts off")]
            (_, ConstantValues::Floats(values)) => ConstantValues::Integers(
                values.iter().map(|&value| cast_integer(value as i64, kind)).collect(),
            ),
        };
        Ok(Self { shape: self.shape.clone(), values, data_type: kind })
    }

    /// The number of values that are infinite or NaN.
    pub(super) fn count_not_finite(&self) -> usize {
        match &self.values {
            ConstantValues::Floats(values) => {
                values.iter().filter(|value| !value.is_finite()).count()
            }
            ConstantValues::Integers(_) => 0,
        }
    }

    /// Returns the values as integers, and fails if they are not integers.
    pub(super) fn as_integers(&self) -> Result<&[i64], String> {
        match &self.values {
            ConstantValues::Integers(values) => Ok(values),
            ConstantValues::Floats(_) => Err(format!(
                "a constant must have integers, but has values of {}",
                data_type::type_name(self.data_type.into())
            )),
        }
    }

    /// Returns the values as weights, and fails if they are not floating-point values or if there
    /// are none.
    pub(super) fn as_weights(&self) -> Result<&[f32], String> {
        let values = self.as_floats()?;
        if values.is_empty() {
            Err(format!("a constant of weights is empty: {:?}", self.shape))
        } else {
            Ok(values)
        }
    }

    /// Returns the only value as a tensor of this type, and fails if there is not exactly one value
    /// of the type.
    pub(super) fn single_value(&self, wanted: ElementType) -> Result<Tensor, String> {
        if self.element() != Some(wanted) || self.values.value_count() != 1 {
            let count = self.values.value_count();
            return Err(format!(
                "a constant must be one value of {}, but has {count} values of {}",
                wanted.describe(),
                data_type::type_name(self.data_type.into())
            ));
        }
        let form = TensorForm::without_positions(Vec::new()).with_encoding(Encoding::plain(wanted));
        Ok(match &self.values {
            ConstantValues::Floats(values) => Tensor::new(form, values.clone()),
            ConstantValues::Integers(values) => Tensor::from_integers(form, values)?,
        })
    }

    /// Returns the values as a tensor of the same type, and fails for types that tensors cannot
    /// store.
    pub(super) fn tensor(&self) -> Result<Tensor, String> {
        let element = self.element().ok_or_else(|| {
            format!(
                "a constant must have floating-point values or integers of 8 or 32 bits, but has values of {}",
                data_type::type_name(self.data_type.into())
            )
        })?;
        if self.values.value_count() == 0 {
            return Err(format!("a constant is empty: {:?}", self.shape));
        }
        let form = TensorForm::without_positions(self.shape.clone())
            .with_encoding(Encoding::plain(element));
        Ok(match &self.values {
            ConstantValues::Floats(values) => Tensor::new(form, values.clone()),
            ConstantValues::Integers(values) => Tensor::from_integers(form, values)?,
        })
    }

    /// Returns the values as floating-point values, and fails if they are not.
    pub(super) fn as_floats(&self) -> Result<&[f32], String> {
        match &self.values {
            ConstantValues::Floats(values) => Ok(values),
            ConstantValues::Integers(_) => Err(format!(
                "a constant must have floating-point values, but has values of {}",
                data_type::type_name(self.data_type.into())
            )),
        }
    }
}

/// Casts an integer to a type: to its lowest bits, or to 1 for a truth value that is not 0.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast cuts off")]
fn cast_integer(value: i64, kind: i32) -> i64 {
    match kind {
        data_type::BOOL => i64::from(value != 0),
        data_type::UINT8 => i64::from(value as u8),
        data_type::INT8 => i64::from(value as i8),
        data_type::INT32 => i64::from(value as i32),
        _ => value,
    }
}

/// Returns the type in which tensors store values of an ONNX type, if there is one.
fn element_of(kind: i32) -> Option<ElementType> {
    match kind {
        data_type::FLOAT | data_type::DOUBLE | data_type::FLOAT16 | data_type::BFLOAT16 => {
            Some(ElementType::F32)
        }
        // Truth values are stored as 0 and 1.
        data_type::UINT8 | data_type::BOOL => Some(ElementType::U8),
        data_type::INT8 => Some(ElementType::I8),
        data_type::INT32 => Some(ElementType::I32),
        _ => None,
    }
}

/// Decodes values from bytes in little-endian order.
pub(super) fn decode_raw(kind: i32, bytes: &[u8]) -> Result<ConstantValues, String> {
    fn each<const N: usize, T>(bytes: &[u8], of: impl Fn([u8; N]) -> T) -> Result<Vec<T>, String> {
        let (values, rest) = bytes.as_chunks::<N>();
        if rest.is_empty() {
            Ok(values.iter().map(|&bytes| of(bytes)).collect())
        } else {
            Err(format!("{} bytes are not values of {N} bytes", bytes.len()))
        }
    }
    Ok(match kind {
        data_type::FLOAT => ConstantValues::Floats(each(bytes, f32::from_le_bytes)?),
        #[allow(clippy::cast_possible_truncation, reason = "weights are 32 bits wide here")]
        data_type::DOUBLE => {
            ConstantValues::Floats(each(bytes, |bytes| f64::from_le_bytes(bytes) as f32)?)
        }
        data_type::FLOAT16 => {
            ConstantValues::Floats(each(bytes, |bytes| float16_to_f32(u16::from_le_bytes(bytes)))?)
        }
        data_type::BFLOAT16 => {
            ConstantValues::Floats(each(bytes, |bytes| bfloat16_to_f32(u16::from_le_bytes(bytes)))?)
        }
        data_type::INT64 => ConstantValues::Integers(each(bytes, i64::from_le_bytes)?),
        data_type::INT32 => {
            ConstantValues::Integers(each(bytes, |bytes| i64::from(i32::from_le_bytes(bytes)))?)
        }
        data_type::INT8 => {
            ConstantValues::Integers(each(bytes, |bytes| i64::from(i8::from_le_bytes(bytes)))?)
        }
        data_type::UINT8 | data_type::BOOL => {
            ConstantValues::Integers(each(bytes, |[byte]| i64::from(byte))?)
        }
        other => return Err(unsupported_type_message(other)),
    })
}

/// Returns values that are stored as fields of the message.
pub(super) fn decode_fields(kind: i32, tensor: &TensorProto) -> Result<ConstantValues, String> {
    Ok(match kind {
        data_type::FLOAT => ConstantValues::Floats(tensor.float_data.clone()),
        #[allow(clippy::cast_possible_truncation, reason = "weights are 32 bits wide here")]
        data_type::DOUBLE => {
            ConstantValues::Floats(tensor.double_data.iter().map(|&value| value as f32).collect())
        }
        data_type::FLOAT16 => ConstantValues::Floats(
            tensor.int32_data.iter().map(low_16_bits).map(float16_to_f32).collect(),
        ),
        data_type::BFLOAT16 => ConstantValues::Floats(
            tensor.int32_data.iter().map(low_16_bits).map(bfloat16_to_f32).collect(),
        ),
        data_type::INT64 => ConstantValues::Integers(tensor.int64_data.clone()),
        data_type::INT32 | data_type::INT8 | data_type::UINT8 | data_type::BOOL => {
            ConstantValues::Integers(
                tensor.int32_data.iter().map(|&value| i64::from(value)).collect(),
            )
        }
        other => return Err(unsupported_type_message(other)),
    })
}

fn unsupported_type_message(kind: i32) -> String {
    format!("values of {} are not supported", data_type::type_name(kind.into()))
}

/// Returns the lowest 16 bits, which hold the value.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what the field holds")]
fn low_16_bits(field: &i32) -> u16 {
    *field as u16
}

/// Converts a bfloat16 value, which is the upper half of a 32-bit value.
fn bfloat16_to_f32(bits: u16) -> f32 {
    f32::from_bits(u32::from(bits) << 16)
}

/// Converts an IEEE 754 binary16 value.
fn float16_to_f32(bits: u16) -> f32 {
    let (sign, exponent, fraction) = (bits >> 15, bits >> 10 & 31, bits & 1023);
    let fraction = f32::from(fraction);
    let value = match exponent {
        0 => fraction * f32::powi(2.0, -24),
        31 if fraction == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        _ => (1.0 + fraction / 1024.0) * f32::powi(2.0, i32::from(exponent) - 15),
    };
    if sign == 1 { -value } else { value }
}
