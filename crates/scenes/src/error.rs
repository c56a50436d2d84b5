// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong with a scene: only its name.

use thiserror::Error;

/// A scene that cannot be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneError {
    /// There is no scene of that name.
    #[error("unknown scene `{name}`{}; scenes are {known}", hint(nearest.as_deref()))]
    Unknown {
        /// The name as given.
        name: String,
        /// The nearest name that exists.
        nearest: Option<String>,
        /// All names that exist.
        known: String,
    },
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
