// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of this crate.

/// An error in what the user requests from this crate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EmitError {
    /// No module name can begin with this prefix.
    #[error(
        "the prefix `{prefix}` {wrong}; use letters, digits and single `_` between them, a letter first, at most \
         {most} in all, such as `cam0`"
    )]
    InvalidPrefix {
        /// The prefix.
        prefix: String,
        /// The fault of the prefix, as words that follow its text.
        wrong: String,
        /// The largest number of characters of a prefix.
        most: usize,
    },
}
