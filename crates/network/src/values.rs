// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values as they are stored, and the types of numbers that they have.

use crate::element::Element;
use std::fmt::Debug;

/// Values as they are stored.
#[derive(Clone, Debug)]
pub(crate) enum Values {
    F32(Vec<f32>),
    U8(Vec<u8>),
    I8(Vec<i8>),
    I32(Vec<i32>),
}

impl Values {
    pub(crate) fn zeros(element: Element, count: usize) -> Self {
        match element {
            Element::F32 => Self::F32(vec![0.0; count]),
            Element::U8 => Self::U8(vec![0; count]),
            Element::I8 => Self::I8(vec![0; count]),
            Element::I32 => Self::I32(vec![0; count]),
        }
    }
}

/// A value of one of the [`Element`]s.
pub(crate) trait Number:
    Copy + Default + Debug + PartialOrd + Send + Sync + 'static
{
    /// What is not more than any other.
    const LOWEST: Self;

    fn of(values: &Values) -> &[Self];
    fn of_mut(values: &mut Values) -> &mut [Self];

    /// By how many steps it differs from another.
    fn distance(self, other: Self) -> f32;

    /// The value in floating point.
    fn float(self) -> f32;

    /// Whether it has the same bits.
    #[inline(always)]
    fn is_same(self, other: Self) -> bool {
        self == other
    }

    /// Whether it is more than another; a value that is no number is more than any.
    #[inline(always)]
    fn is_more(self, than: Self) -> bool {
        self > than
    }
}

/// A value of 8 bits.
pub(crate) trait Byte: Number + Into<i32> + Into<f32> {
    /// The nearest value to an integer.
    fn saturated(value: i32) -> Self;

    /// How many values are below.
    fn index(self) -> usize;
}

/// Where values of a type are stored.
macro_rules! stored {
    ($variant:ident) => {
        fn of(values: &Values) -> &[Self] {
            match values {
                Values::$variant(values) => values,
                _ => unreachable!("a network's encodings are checked when it is read"),
            }
        }

        fn of_mut(values: &mut Values) -> &mut [Self] {
            match values {
                Values::$variant(values) => values,
                _ => unreachable!("a network's encodings are checked when it is read"),
            }
        }
    };
}

impl Number for f32 {
    const LOWEST: Self = Self::NEG_INFINITY;
    stored!(F32);

    #[inline(always)]
    fn distance(self, other: Self) -> f32 {
        (self - other).abs()
    }

    #[inline(always)]
    fn float(self) -> f32 {
        self
    }

    #[inline(always)]
    fn is_same(self, other: Self) -> bool {
        self.to_bits() == other.to_bits()
    }

    #[inline(always)]
    fn is_more(self, than: Self) -> bool {
        self > than || self.is_nan()
    }
}

#[allow(clippy::cast_precision_loss, reason = "a distance, and what ONNX calls a cast")]
impl Number for i32 {
    const LOWEST: Self = Self::MIN;
    stored!(I32);

    #[inline(always)]
    fn distance(self, other: Self) -> f32 {
        self.abs_diff(other) as f32
    }

    #[inline(always)]
    fn float(self) -> f32 {
        self as f32
    }
}

macro_rules! byte {
    ($number:ident, $variant:ident) => {
        impl Number for $number {
            const LOWEST: Self = Self::MIN;
            stored!($variant);

            #[inline(always)]
            fn distance(self, other: Self) -> f32 {
                self.abs_diff(other).into()
            }

            #[inline(always)]
            fn float(self) -> f32 {
                self.into()
            }
        }

        impl Byte for $number {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it has been clamped"
            )]
            #[inline(always)]
            fn saturated(value: i32) -> Self {
                value.clamp(Self::MIN.into(), Self::MAX.into()) as Self
            }

            #[inline(always)]
            fn index(self) -> usize {
                usize::from(self.abs_diff(Self::MIN))
            }
        }
    };
}
byte!(u8, U8);
byte!(i8, I8);
