// SPDX-License-Identifier: MIT OR Apache-2.0
//! The types in which values of a tensor are stored, and the real numbers that they stand for.

/// Evaluates an expression with the Rust type of an [`ElementType`].
macro_rules! with_element_type {
    ($element:expr, $number:ident => $body:expr) => {
        match $element {
            $crate::element::ElementType::F32 => {
                type $number = f32;
                $body
            }
            $crate::element::ElementType::U8 => {
                type $number = u8;
                $body
            }
            $crate::element::ElementType::I8 => {
                type $number = i8;
                $body
            }
            $crate::element::ElementType::I32 => {
                type $number = i32;
                $body
            }
        }
    };
}

/// Evaluates an expression with the Rust type of an [`ElementType`] of 8 bits.
macro_rules! with_byte_type {
    ($element:expr, $number:ident => $body:expr) => {
        match $element {
            $crate::element::ElementType::U8 => {
                type $number = u8;
                $body
            }
            $crate::element::ElementType::I8 => {
                type $number = i8;
                $body
            }
            $crate::element::ElementType::F32 | $crate::element::ElementType::I32 => {
                unreachable!("a network's encodings are checked when it is read")
            }
        }
    };
}

pub(crate) use {with_byte_type, with_element_type};

/// The type of a stored value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementType {
    /// A 32-bit floating-point value.
    F32,
    /// An unsigned 8-bit integer.
    U8,
    /// A signed 8-bit integer.
    I8,
    /// A signed 32-bit integer, which holds sums of products.
    I32,
}

impl ElementType {
    pub(crate) const ALL: [Self; 4] = [Self::F32, Self::U8, Self::I8, Self::I32];

    /// The bytes of a value.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 | Self::I32 => 4,
            Self::U8 | Self::I8 => 1,
        }
    }

    /// Returns true for the types of 8 bits.
    pub(crate) fn is_byte(self) -> bool {
        self.bytes() == 1
    }

    /// The lowest and the highest integer of a type of 8 bits.
    pub(crate) fn range(self) -> (i32, i32) {
        with_byte_type!(self, T => (T::MIN.into(), T::MAX.into()))
    }

    /// The name of such values in messages, in the plural.
    pub(crate) fn describe(self) -> &'static str {
        match self {
            Self::F32 => "32-bit floating-point values",
            Self::U8 => "8-bit integers without sign",
            Self::I8 => "8-bit integers with sign",
            Self::I32 => "32-bit integers",
        }
    }
}

/// The type of stored values, and the affine mapping to the real numbers that they stand for:
/// `(value - zero_point) * scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoding {
    /// The type of a stored value.
    pub element: ElementType,
    /// The real number of one quantization step.
    pub scale: f32,
    /// The zero point: the stored value that stands for 0.
    pub zero_point: i32,
}

impl Encoding {
    /// Floating-point values that stand for themselves.
    pub const FLOAT: Self = Self::plain(ElementType::F32);

    /// Values that stand for themselves, or whose scale is not known.
    #[must_use]
    pub const fn plain(element: ElementType) -> Self {
        Self { element, scale: 1.0, zero_point: 0 }
    }
}
