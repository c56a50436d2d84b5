// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of scenes. Only the name of a scene can be wrong.

use thiserror::Error;

/// An error that keeps a scene from being made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum SceneError {
    /// A name of a scene that does not exist.
    #[error("unknown scene `{name}`{}; scenes are {known}", hint(nearest.as_deref()))]
    UnknownScene { name: String, nearest: Option<String>, known: String },
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
