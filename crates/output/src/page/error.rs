// SPDX-License-Identifier: MIT OR Apache-2.0
//! The error of a page.

use thiserror::Error;

/// A page cannot be written.
#[derive(Debug, Error)]
#[error("cannot write the page `{page}`: {problem}")]
pub struct PageError {
    /// The title of the page.
    pub page: String,
    /// The problem.
    pub problem: String,
}
