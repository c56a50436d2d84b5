// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a network cannot be read.

use std::path::{Path, PathBuf};

/// Why a network cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// A file cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// The file is not an ONNX model.
    #[error("`{}` is not an ONNX model: {problem}", path.display())]
    NotOnnx {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// An operator is unknown.
    #[error(
        "node `{}` has the operator `{}`, which is not supported{advice}",
        shown(node),
        shown(operator)
    )]
    Operator {
        /// Its name.
        node: String,
        /// The operator with its domain.
        operator: String,
        /// Advice behind a semicolon; empty where it has been given.
        advice: &'static str,
    },
    /// A node is not valid, or uses its operator in a way that is not supported.
    #[error("node `{}` ({}): {}", shown(node), shown(operator), shown(problem))]
    Node {
        /// Its name.
        node: String,
        /// Its operator.
        operator: String,
        /// What is wrong.
        problem: String,
    },
    /// The network as a whole is not valid or not supported.
    #[error("the network: {}", shown(.0))]
    Network(String),
    /// The frames have another size than the network's input.
    #[error(
        "the network takes pictures of {wanted} pixels, but the frames have {found}; give --resize {wanted}, or --framing letterbox to scale behind the camera"
    )]
    Size {
        /// Width x height of the input.
        wanted: String,
        /// Width x height of the frames.
        found: String,
    },
}

impl NetworkError {
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        move |source| Self::Io { path: path.to_owned(), source }
    }
}

/// Text from a file for a message: without control characters, and not longer than a line or two.
fn shown(text: &str) -> String {
    const LONGEST: usize = 300;
    let mut shown: String =
        text.chars().filter(|letter| !letter.is_control()).take(LONGEST).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}
