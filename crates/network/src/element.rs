// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the values of a tensor are stored, and what they stand for.

/// Does something with the type of an [`Element`].
macro_rules! typed {
    ($element:expr, $number:ident => $body:expr) => {
        match $element {
            $crate::element::Element::F32 => {
                type $number = f32;
                $body
            }
            $crate::element::Element::U8 => {
                type $number = u8;
                $body
            }
            $crate::element::Element::I8 => {
                type $number = i8;
                $body
            }
            $crate::element::Element::I32 => {
                type $number = i32;
                $body
            }
        }
    };
}

/// The same for an [`Element`] of 8 bits.
macro_rules! typed_byte {
    ($element:expr, $number:ident => $body:expr) => {
        match $element {
            $crate::element::Element::U8 => {
                type $number = u8;
                $body
            }
            $crate::element::Element::I8 => {
                type $number = i8;
                $body
            }
            $crate::element::Element::F32 | $crate::element::Element::I32 => {
                unreachable!("a network's encodings are checked when it is read")
            }
        }
    };
}

pub(crate) use {typed, typed_byte};

/// How a value is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A 32-bit floating-point value.
    F32,
    /// An 8-bit integer without sign.
    U8,
    /// An 8-bit integer with sign.
    I8,
    /// A 32-bit integer with sign: a sum of products.
    I32,
}

impl Element {
    pub(crate) const ALL: [Self; 4] = [Self::F32, Self::U8, Self::I8, Self::I32];

    /// Bytes of a value.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 | Self::I32 => 4,
            Self::U8 | Self::I8 => 1,
        }
    }

    /// Whether it has 8 bits.
    pub(crate) fn is_byte(self) -> bool {
        self.bytes() == 1
    }

    /// The lowest and the highest integer, of 8 bits.
    pub(crate) fn range(self) -> (i32, i32) {
        typed_byte!(self, T => (T::MIN.into(), T::MAX.into()))
    }

    /// What messages call many of them.
    pub(crate) fn describe(self) -> &'static str {
        match self {
            Self::F32 => "32-bit floating-point values",
            Self::U8 => "8-bit integers without sign",
            Self::I8 => "8-bit integers with sign",
            Self::I32 => "32-bit integers",
        }
    }
}

/// How values are stored, and the real numbers that they stand for: `(value - zero) * scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoding {
    /// How a value is stored.
    pub element: Element,
    /// What one step stands for.
    pub scale: f32,
    /// What stands for 0.
    pub zero: i32,
}

impl Encoding {
    /// Floating-point values, which stand for themselves.
    pub const FLOAT: Self = Self::plain(Element::F32);

    /// Values that stand for themselves, or of which nothing else is known.
    #[must_use]
    pub const fn plain(element: Element) -> Self {
        Self { element, scale: 1.0, zero: 0 }
    }
}
