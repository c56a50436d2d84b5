// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values of a constant.

/// The values of a constant: floating-point values of 32 bits, or integers of 64 bits.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ConstantValues {
    Floats(Vec<f32>),
    Integers(Vec<i64>),
}

impl ConstantValues {
    pub(super) fn value_count(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Integers(values) => values.len(),
        }
    }

    /// The bytes of a value.
    pub(super) fn bytes_per_value(&self) -> u64 {
        match self {
            Self::Floats(_) => 4,
            Self::Integers(_) => 8,
        }
    }
}
