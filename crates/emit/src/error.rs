// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with what is asked for.

/// What can be wrong with what is asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EmitError {
    /// A prefix that names of modules cannot begin with.
    #[error(
        "the prefix `{prefix}` {wrong}; use letters, digits and single `_` between them, a letter first, at most \
         {most} in all, such as `cam0`"
    )]
    Prefix {
        /// The prefix.
        prefix: String,
        /// What is wrong with it, in words.
        wrong: String,
        /// The most characters that one may have.
        most: usize,
    },
}
