// SPDX-License-Identifier: MIT OR Apache-2.0
//! Constants of a model.

use crate::element::{Element, Encoding};
use crate::form::{Form, MAX_AXES};
use crate::onnx::{TensorProto, data_type};
use crate::tensor::Tensor;
use crate::values::Number;
use std::cell::Cell;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// A constant tensor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Constant {
    pub(super) shape: Vec<usize>,
    pub(super) values: Values,
    /// Its type, a number of `data_type`.
    pub(super) kind: i32,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Floats(Vec<f32>),
    Integers(Vec<i64>),
}

/// The folder of the model, in which data outside of the file must lie.
pub(super) struct Folder {
    path: PathBuf,
    /// Bytes of constants that may still be read.
    left: Cell<u64>,
    /// Bytes of constants that may still be computed.
    room: Cell<u64>,
}

/// Bytes of all constants in the files of a model.
const MAX_BYTES: u64 = 1 << 32;
/// Bytes of all constants that are computed when a model is read. A few bytes of a file are enough to ask for them.
const MAX_COMPUTED: u64 = 1 << 30;

impl Folder {
    pub(super) fn of(model: &Path) -> Self {
        let path = model.parent().unwrap_or_else(|| Path::new("")).to_owned();
        Self { path, left: Cell::new(MAX_BYTES), room: Cell::new(MAX_COMPUTED) }
    }

    /// Counts bytes that are to be read.
    pub(super) fn charge(&self, bytes: u64) -> Result<(), String> {
        let left = self.left.get().checked_sub(bytes);
        self.left.set(left.ok_or("all constants together have more than 4 GiB")?);
        Ok(())
    }

    /// The number of values of a shape, if there is room for them as a computed constant of this type.
    pub(super) fn check_room(&self, shape: &[usize], like: &Values) -> Result<usize, String> {
        let count = shape.iter().try_fold(1usize, |count, &length| count.checked_mul(length));
        let bytes = count.and_then(|count| (count as u64).checked_mul(like.bytes_each()));
        match (count, bytes.and_then(|bytes| self.room.get().checked_sub(bytes))) {
            (Some(count), Some(_)) => Ok(count),
            _ => Err(format!(
                "it makes a constant of shape {shape:?}, and all computed constants together have at most 1 GiB, of which {} MiB are left",
                self.room.get() >> 20
            )),
        }
    }

    /// Counts a computed constant, which is kept.
    pub(super) fn keep(&self, made: &Constant) -> Result<(), String> {
        let count = self.check_room(&made.shape, &made.values)? as u64;
        self.room.set(self.room.get() - count * made.values.bytes_each());
        Ok(())
    }
}

impl Constant {
    pub(super) fn integers(shape: Vec<usize>, values: Vec<i64>) -> Self {
        Self { shape, values: Values::Integers(values), kind: data_type::INT64 }
    }

    pub(super) fn floats(shape: Vec<usize>, values: Vec<f32>) -> Self {
        Self { shape, values: Values::Floats(values), kind: data_type::FLOAT }
    }

    /// Decodes a tensor. Memory grows with the data that is there, not with what the shape claims.
    pub(super) fn read(tensor: &TensorProto, folder: &Folder) -> Result<Self, String> {
        let length = |&length: &i64| {
            usize::try_from(length).map_err(|_| format!("its shape has a length of {length}"))
        };
        if tensor.dims.len() > MAX_AXES {
            return Err(format!("it has {} axes, more than {MAX_AXES}", tensor.dims.len()));
        }
        let shape: Vec<usize> = tensor.dims.iter().map(length).collect::<Result<_, _>>()?;
        let kind = tensor.data_type.unwrap_or(0);
        let values = if tensor.data_location == Some(TensorProto::EXTERNAL) {
            decode(kind, &external(tensor, folder)?)?
        } else if let Some(raw) = &tensor.raw_data {
            decode(kind, raw)?
        } else {
            unpacked(kind, tensor)?
        };
        let wanted = shape.iter().try_fold(1usize, |product, &length| product.checked_mul(length));
        if wanted != Some(values.count()) {
            return Err(format!("it has {} values, but the shape {shape:?}", values.count()));
        }
        Ok(Self { shape, values, kind })
    }

    /// The values of a tensor as they are stored.
    pub(super) fn of_tensor(tensor: &Tensor) -> Self {
        fn integers<T: Number + Into<i64>>(tensor: &Tensor) -> Values {
            Values::Integers(tensor.values::<T>().iter().map(|&value| value.into()).collect())
        }
        let (values, kind) = match tensor.form().encoding().element {
            Element::F32 => (Values::Floats(tensor.values().to_vec()), data_type::FLOAT),
            Element::U8 => (integers::<u8>(tensor), data_type::UINT8),
            Element::I8 => (integers::<i8>(tensor), data_type::INT8),
            Element::I32 => (integers::<i32>(tensor), data_type::INT32),
        };
        Self { shape: tensor.form().shape().to_vec(), values, kind }
    }

    /// The message of its values as a type, in bytes; floating-point ones have 32 bits, whatever the type.
    pub(super) fn encode(&self, kind: i32) -> Result<TensorProto, String> {
        let own = self.cast(kind)?;
        let (bytes, kind) = match &own.values {
            Values::Floats(values) => {
                (values.iter().flat_map(|value| value.to_le_bytes()).collect(), data_type::FLOAT)
            }
            Values::Integers(values) => {
                let width = match kind {
                    data_type::BOOL | data_type::UINT8 | data_type::INT8 => 1,
                    data_type::INT32 => 4,
                    _ => 8,
                };
                let low = |value: &i64| value.to_le_bytes().into_iter().take(width);
                (values.iter().flat_map(low).collect(), kind)
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

    /// The type in which tensors store its values, if there is one.
    pub(super) fn element(&self) -> Option<Element> {
        element(self.kind)
    }

    /// The same values as a type, as `Cast` has it.
    pub(super) fn cast(&self, kind: i32) -> Result<Self, String> {
        #[allow(clippy::cast_precision_loss, reason = "a cast rounds")]
        let float = |&value: &i64| value as f32;
        let values = match (element(kind), &self.values) {
            (Some(Element::F32), Values::Floats(_)) => self.values.clone(),
            (Some(Element::F32), Values::Integers(values)) => {
                Values::Floats(values.iter().map(float).collect())
            }
            (None, _) if kind != data_type::INT64 => {
                return Err(format!(
                    "a cast of a constant to {} is not supported",
                    data_type::name(kind.into())
                ));
            }
            (_, Values::Integers(values)) => {
                Values::Integers(values.iter().map(|&value| cut(value, kind)).collect())
            }
            (_, Values::Floats(values)) if kind == data_type::BOOL => {
                Values::Integers(values.iter().map(|&value| i64::from(value != 0.0)).collect())
            }
            #[allow(clippy::cast_possible_truncation, reason = "a cast cuts off")]
            (_, Values::Floats(values)) => {
                Values::Integers(values.iter().map(|&value| cut(value as i64, kind)).collect())
            }
        };
        Ok(Self { shape: self.shape.clone(), values, kind })
    }

    /// How many values are infinite or no numbers.
    pub(super) fn not_finite(&self) -> usize {
        match &self.values {
            Values::Floats(values) => values.iter().filter(|value| !value.is_finite()).count(),
            Values::Integers(_) => 0,
        }
    }

    /// Its values as integers.
    pub(super) fn as_integers(&self) -> Result<&[i64], String> {
        match &self.values {
            Values::Integers(values) => Ok(values),
            Values::Floats(_) => Err(format!(
                "a constant must be of integers, but is of {}",
                data_type::name(self.kind.into())
            )),
        }
    }

    /// Its values as weights, of which there are some.
    pub(super) fn as_weights(&self) -> Result<&[f32], String> {
        let values = self.as_floats()?;
        if values.is_empty() {
            Err(format!("a constant of weights is empty: {:?}", self.shape))
        } else {
            Ok(values)
        }
    }

    /// Its only value, as one of a tensor of these.
    pub(super) fn single(&self, wanted: Element) -> Result<Tensor, String> {
        if self.element() != Some(wanted) || self.values.count() != 1 {
            let count = self.values.count();
            return Err(format!(
                "a constant must be one value of {}, but is {count} of {}",
                wanted.describe(),
                data_type::name(self.kind.into())
            ));
        }
        let form = Form::whole(Vec::new()).encoded(Encoding::plain(wanted));
        Ok(match &self.values {
            Values::Floats(values) => Tensor::new(form, values.clone()),
            Values::Integers(values) => Tensor::of_integers(form, values)?,
        })
    }

    /// Its values as a tensor of the same element; integers of other types are refused.
    pub(super) fn tensor(&self) -> Result<Tensor, String> {
        let element = self.element().ok_or_else(|| {
            format!(
                "a constant must be of floating-point values or of integers of 8 or 32 bits, but is of {}",
                data_type::name(self.kind.into())
            )
        })?;
        if self.values.count() == 0 {
            return Err(format!("a constant is empty: {:?}", self.shape));
        }
        let form = Form::whole(self.shape.clone()).encoded(Encoding::plain(element));
        Ok(match &self.values {
            Values::Floats(values) => Tensor::new(form, values.clone()),
            Values::Integers(values) => Tensor::of_integers(form, values)?,
        })
    }

    /// Its values as floating-point ones, whatever they are; integers are rounded to 24 bits.
    pub(super) fn floats_of(&self) -> Vec<f32> {
        match &self.values {
            Values::Floats(values) => values.clone(),
            #[allow(clippy::cast_precision_loss, reason = "as documented")]
            Values::Integers(values) => values.iter().map(|&value| value as f32).collect(),
        }
    }

    /// Its values as floating-point ones.
    pub(super) fn as_floats(&self) -> Result<&[f32], String> {
        match &self.values {
            Values::Floats(values) => Ok(values),
            Values::Integers(_) => Err(format!(
                "a constant must be of floating-point values, but is of {}",
                data_type::name(self.kind.into())
            )),
        }
    }
}

impl Values {
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Integers(values) => values.len(),
        }
    }

    /// Bytes of a value.
    fn bytes_each(&self) -> u64 {
        match self {
            Self::Floats(_) => 4,
            Self::Integers(_) => 8,
        }
    }
}

/// An integer as one of a type: its lowest bits, or whether it is not 0.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast cuts off")]
fn cut(value: i64, kind: i32) -> i64 {
    match kind {
        data_type::BOOL => i64::from(value != 0),
        data_type::UINT8 => i64::from(value as u8),
        data_type::INT8 => i64::from(value as i8),
        data_type::INT32 => i64::from(value as i32),
        _ => value,
    }
}

/// The type of ONNX as one of tensors.
fn element(kind: i32) -> Option<Element> {
    match kind {
        data_type::FLOAT | data_type::DOUBLE | data_type::FLOAT16 | data_type::BFLOAT16 => {
            Some(Element::F32)
        }
        // Truth values are 0 and 1.
        data_type::UINT8 | data_type::BOOL => Some(Element::U8),
        data_type::INT8 => Some(Element::I8),
        data_type::INT32 => Some(Element::I32),
        _ => None,
    }
}

/// Values from bytes, the lowest first.
fn decode(kind: i32, bytes: &[u8]) -> Result<Values, String> {
    fn each<const N: usize, T>(bytes: &[u8], of: impl Fn([u8; N]) -> T) -> Result<Vec<T>, String> {
        let (values, rest) = bytes.as_chunks::<N>();
        if rest.is_empty() {
            Ok(values.iter().map(|&bytes| of(bytes)).collect())
        } else {
            Err(format!("{} bytes are not values of {N} bytes", bytes.len()))
        }
    }
    Ok(match kind {
        data_type::FLOAT => Values::Floats(each(bytes, f32::from_le_bytes)?),
        #[allow(clippy::cast_possible_truncation, reason = "weights are 32 bits wide here")]
        data_type::DOUBLE => Values::Floats(each(bytes, |bytes| f64::from_le_bytes(bytes) as f32)?),
        data_type::FLOAT16 => Values::Floats(each(bytes, |bytes| half(u16::from_le_bytes(bytes)))?),
        data_type::BFLOAT16 => {
            Values::Floats(each(bytes, |bytes| brain(u16::from_le_bytes(bytes)))?)
        }
        data_type::INT64 => Values::Integers(each(bytes, i64::from_le_bytes)?),
        data_type::INT32 => {
            Values::Integers(each(bytes, |bytes| i64::from(i32::from_le_bytes(bytes)))?)
        }
        data_type::INT8 => {
            Values::Integers(each(bytes, |bytes| i64::from(i8::from_le_bytes(bytes)))?)
        }
        data_type::UINT8 | data_type::BOOL => {
            Values::Integers(each(bytes, |[byte]| i64::from(byte))?)
        }
        other => return Err(unknown(other)),
    })
}

/// Values that are fields of the message.
fn unpacked(kind: i32, tensor: &TensorProto) -> Result<Values, String> {
    Ok(match kind {
        data_type::FLOAT => Values::Floats(tensor.float_data.clone()),
        #[allow(clippy::cast_possible_truncation, reason = "weights are 32 bits wide here")]
        data_type::DOUBLE => {
            Values::Floats(tensor.double_data.iter().map(|&value| value as f32).collect())
        }
        data_type::FLOAT16 => {
            Values::Floats(tensor.int32_data.iter().map(bits).map(half).collect())
        }
        data_type::BFLOAT16 => {
            Values::Floats(tensor.int32_data.iter().map(bits).map(brain).collect())
        }
        data_type::INT64 => Values::Integers(tensor.int64_data.clone()),
        data_type::INT32 | data_type::INT8 | data_type::UINT8 | data_type::BOOL => {
            Values::Integers(tensor.int32_data.iter().map(|&value| i64::from(value)).collect())
        }
        other => return Err(unknown(other)),
    })
}

fn unknown(kind: i32) -> String {
    format!("values of {} are not supported", data_type::name(kind.into()))
}

/// The lowest 16 bits, which are a value.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what the field holds")]
fn bits(field: &i32) -> u16 {
    *field as u16
}

/// A value of 16 bits that is the first half of one of 32.
fn brain(bits: u16) -> f32 {
    f32::from_bits(u32::from(bits) << 16)
}

/// A value of 16 bits: IEEE 754 binary16.
fn half(bits: u16) -> f32 {
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

/// The bytes of a tensor in a file of its own, which must lie in the folder of the model.
fn external(tensor: &TensorProto, folder: &Folder) -> Result<Vec<u8>, String> {
    let entry = |key: &str| {
        tensor
            .external_data
            .iter()
            .find(|entry| entry.key.as_deref() == Some(key))
            .and_then(|entry| entry.value.as_deref())
    };
    let number = |key: &str| {
        entry(key)
            .map(|text| text.parse::<u64>().map_err(|_| format!("its {key} is no number: {text}")))
            .transpose()
    };
    let location = Path::new(entry("location").ok_or("its data has no location")?);
    if !location.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(format!(
            "its data `{}` is outside the folder of the model",
            location.display()
        ));
    }
    let path = folder.path.join(location);
    let fails =
        |error: std::io::Error| format!("cannot read its data `{}`: {error}", path.display());
    let outside =
        |_| format!("its data `{}` is outside the folder of the model", location.display());
    if !path.metadata().map_err(fails)?.is_file() {
        return Err(format!("its data `{}` is not a file", location.display()));
    }
    let (real, root) = (
        path.canonicalize().map_err(fails)?,
        if folder.path.as_os_str().is_empty() { Path::new(".") } else { &folder.path }
            .canonicalize()
            .map_err(fails)?,
    );
    real.strip_prefix(root).map_err(outside)?;
    let mut file = std::fs::File::open(real).map_err(fails)?;
    let all = file.metadata().map_err(fails)?.len();
    let offset = number("offset")?.unwrap_or(0);
    let length = number("length")?.unwrap_or(all.saturating_sub(offset));
    if offset.checked_add(length).is_none_or(|end| end > all) {
        return Err(format!(
            "its data is {length} bytes from {offset} on, but `{}` has {all}",
            location.display()
        ));
    }
    folder.charge(length)?;
    file.seek(SeekFrom::Start(offset)).map_err(fails)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(fails)?;
    Ok(bytes)
}
