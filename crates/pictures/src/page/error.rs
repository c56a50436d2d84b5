// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong with a page.

use thiserror::Error;

/// A page that cannot be written.
#[derive(Debug, Error)]
#[error("cannot write the page `{page}`: {problem}")]
pub struct PageError {
    /// Its title.
    pub page: String,
    /// What is wrong.
    pub problem: String,
}
