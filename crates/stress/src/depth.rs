// SPDX-License-Identifier: MIT OR Apache-2.0
//! How long a run may take.

/// How much of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Seconds: what the tests run.
    Short,
    /// Minutes: all that is promised.
    Full,
}

impl Depth {
    /// One of two numbers.
    pub(crate) fn pick<T>(self, short: T, full: T) -> T {
        match self {
            Self::Short => short,
            Self::Full => full,
        }
    }
}
