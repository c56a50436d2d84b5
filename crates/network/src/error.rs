// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of reading a network.

use std::path::{Path, PathBuf};

/// The reason why a network cannot be read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum NetworkError {
    /// A file cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Io { path: PathBuf, source: std::io::Error },
    /// The file is not an ONNX model.
    #[error("`{}` is not an ONNX model: {problem}", path.display())]
    NotOnnx { path: PathBuf, problem: String },
    /// An operator is not supported.
    #[error(
        "node `{}` has the operator `{}`, which is not supported{advice}",
        printable_text(node),
        printable_text(operator)
    )]
    UnsupportedOperator { node: String, operator: String, advice: &'static str },
    /// A node is not valid, or uses its operator in a way that is not supported.
    #[error(
        "node `{}` ({}): {}",
        printable_text(node),
        printable_text(operator),
        printable_text(problem)
    )]
    InvalidNode { node: String, operator: String, problem: String },
    /// The network as a whole is not valid or not supported.
    #[error("the network: {}", printable_text(.0))]
    InvalidNetwork(String),
    /// The frames have another size than the network's input.
    #[error(
        "the network takes frames of {wanted} pixels, but these frames have {found}; give --resize {wanted}, or --framing letterbox to scale behind the camera"
    )]
    FrameSizeMismatch { wanted: String, found: String },
}

impl NetworkError {
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        move |source| Self::Io { path: path.to_owned(), source }
    }
}

/// Makes text from a file fit for a message: removes control characters and cuts it after a line or
/// two.
fn printable_text(text: &str) -> String {
    const LONGEST: usize = 300;
    let mut shown: String =
        text.chars().filter(|letter| !letter.is_control()).take(LONGEST).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}
