// SPDX-License-Identifier: MIT OR Apache-2.0
//! An instance in the top of an elaborated array, and the connections of its ports.

/// An instance in the top.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub(super) module: String,
    pub(super) ports: Vec<(String, Connection)>,
}

/// The connection of a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Connection {
    /// A whole signal.
    All(String),
    /// The `width` bits of a signal from bit `from` on.
    Part { signal: String, from: u64, width: u64 },
    /// A constant.
    Number(u64),
    /// Any other expression.
    Other,
}

impl Connection {
    pub(super) fn of(tokens: &[Token]) -> Self {
        let number = |text: &str| u64::from_str_radix(text, 16).ok();
        match tokens {
            [Token::Signal(name)] => Self::All(name.clone()),
            [Token::Select, Token::Signal(name), Token::Number(from), Token::Number(width)] => {
                match (number(from), number(width)) {
                    (Some(from), Some(width)) => Self::Part { signal: name.clone(), from, width },
                    _ => Self::Other,
                }
            }
            [Token::Number(value)] => number(value).map_or(Self::Other, Self::Number),
            _ => Self::Other,
        }
    }
}

/// A token of the expression at a port.
pub(super) enum Token {
    Select,
    Signal(String),
    Number(String),
    Other,
}
