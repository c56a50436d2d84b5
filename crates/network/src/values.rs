// SPDX-License-Identifier: MIT OR Apache-2.0
//! Stored values of a tensor, and the traits of their number types.

use crate::element::ElementType;
use std::fmt::Debug;

/// The stored values of a tensor.
#[derive(Clone, Debug)]
pub(crate) enum TensorValues {
    F32(Vec<f32>),
    U8(Vec<u8>),
    I8(Vec<i8>),
    I32(Vec<i32>),
}

impl TensorValues {
    pub(crate) fn zeros(element: ElementType, count: usize) -> Self {
        match element {
            ElementType::F32 => Self::F32(vec![0.0; count]),
            ElementType::U8 => Self::U8(vec![0; count]),
            ElementType::I8 => Self::I8(vec![0; count]),
            ElementType::I32 => Self::I32(vec![0; count]),
        }
    }
}

/// A number of the type of an [`ElementType`].
pub(crate) trait TensorNumber:
    Copy + Default + Debug + PartialOrd + Send + Sync + 'static
{
    /// The value that is not greater than any other.
    const LOWEST: Self;

    fn slice_of(values: &TensorValues) -> &[Self];
    fn slice_of_mut(values: &mut TensorValues) -> &mut [Self];

    /// The absolute difference from another value, in quantization steps for integers.
    fn distance(self, other: Self) -> f32;

    /// The value as a floating-point number.
    fn to_f32(self) -> f32;

    /// Returns true if all bits are equal.
    #[inline(always)]
    fn has_same_bits(self, other: Self) -> bool {
        self == other
    }

    /// Returns true if the value is greater than another. NaN is greater than any value.
    #[inline(always)]
    fn is_greater(self, than: Self) -> bool {
        self > than
    }
}

/// A value of 8 bits.
pub(crate) trait ByteNumber: TensorNumber + Into<i32> + Into<f32> {
    /// Returns the value of this type that is nearest to an integer.
    fn from_saturated(value: i32) -> Self;

    /// The number of values of the type that are lower.
    fn table_index(self) -> usize;
}

/// Implements access to the stored values of a type.
macro_rules! stored_access {
    ($variant:ident) => {
        fn slice_of(values: &TensorValues) -> &[Self] {
            match values {
                TensorValues::$variant(values) => values,
                _ => unreachable!("a network's encodings are checked when it is read"),
            }
        }

        fn slice_of_mut(values: &mut TensorValues) -> &mut [Self] {
            match values {
                TensorValues::$variant(values) => values,
                _ => unreachable!("a network's encodings are checked when it is read"),
            }
        }
    };
}

impl TensorNumber for f32 {
    const LOWEST: Self = Self::NEG_INFINITY;
    stored_access!(F32);

    #[inline(always)]
    fn distance(self, other: Self) -> f32 {
        (self - other).abs()
    }

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }

    #[inline(always)]
    fn has_same_bits(self, other: Self) -> bool {
        self.to_bits() == other.to_bits()
    }

    #[inline(always)]
    fn is_greater(self, than: Self) -> bool {
        self > than || self.is_nan()
    }
}

#[allow(clippy::cast_precision_loss, reason = "a distance, and what ONNX calls a cast")]
impl TensorNumber for i32 {
    const LOWEST: Self = Self::MIN;
    stored_access!(I32);

    #[inline(always)]
    fn distance(self, other: Self) -> f32 {
        self.abs_diff(other) as f32
    }

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self as f32
    }
}

macro_rules! byte_number {
    ($number:ident, $variant:ident) => {
        impl TensorNumber for $number {
            const LOWEST: Self = Self::MIN;
            stored_access!($variant);

            #[inline(always)]
            fn distance(self, other: Self) -> f32 {
                self.abs_diff(other).into()
            }

            #[inline(always)]
            fn to_f32(self) -> f32 {
                self.into()
            }
        }

        impl ByteNumber for $number {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it has been clamped"
            )]
            #[inline(always)]
            fn from_saturated(value: i32) -> Self {
                value.clamp(Self::MIN.into(), Self::MAX.into()) as Self
            }

            #[inline(always)]
            fn table_index(self) -> usize {
                usize::from(self.abs_diff(Self::MIN))
            }
        }
    };
}
byte_number!(u8, U8);
byte_number!(i8, I8);
