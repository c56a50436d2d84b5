// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decoding of the values of tensors in messages.

use super::constant_values::ConstantValues;
use crate::onnx::{TensorProto, data_type};

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
