// SPDX-License-Identifier: MIT OR Apache-2.0
//! An instance in the top of an elaborated array, and the connections of its ports.

/// An instance in the top.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct ArrayInstance {
    pub(super) module: String,
    pub(super) ports: Vec<(String, PortConnection)>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PortConnection {
    /// A whole signal.
    WholeSignal(String),
    /// The `width` bits of a signal from bit `from` on.
    Bits { signal: String, from: u64, width: u64 },
    /// A constant.
    Constant(u64),
    /// Any other expression.
    Other,
}

impl PortConnection {
    pub(super) fn from_tokens(tokens: &[ConnectionToken]) -> Self {
        let number = |text: &str| u64::from_str_radix(text, 16).ok();
        match tokens {
            [ConnectionToken::Signal(name)] => Self::WholeSignal(name.clone()),
            [
                ConnectionToken::Select,
                ConnectionToken::Signal(name),
                ConnectionToken::Number(from),
                ConnectionToken::Number(width),
            ] => match (number(from), number(width)) {
                (Some(from), Some(width)) => Self::Bits { signal: name.clone(), from, width },
                _ => Self::Other,
            },
            [ConnectionToken::Number(value)] => number(value).map_or(Self::Other, Self::Constant),
            _ => Self::Other,
        }
    }
}

/// A token of the expression at a port.
pub(super) enum ConnectionToken {
    Select,
    Signal(String),
    Number(String),
    Other,
}
