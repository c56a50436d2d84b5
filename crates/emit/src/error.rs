// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of this crate.

/// An error in what the user requests from this crate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum EmitError {
    /// No module name can begin with this prefix.
    #[error(
        "the prefix `{prefix}` {wrong}; use letters, digits and single `_` between them, a letter first, at most \
         {most} in all, such as `cam0`"
    )]
    InvalidPrefix { prefix: String, wrong: String, most: usize },
}
