// SPDX-License-Identifier: MIT OR Apache-2.0
//! The depth of a run.

/// The depth of a run, which decides how long it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunDepth {
    /// A run of seconds, as the tests do it.
    Short,
    /// A run of minutes, with all cases that the documentation promises.
    Full,
}

impl RunDepth {
    /// Returns one of two values, depending on the depth.
    pub(crate) fn choose<T>(self, short: T, full: T) -> T {
        match self {
            Self::Short => short,
            Self::Full => full,
        }
    }
}
