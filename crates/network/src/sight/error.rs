// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a network cannot be shown frames, or what it says cannot be read.

use crate::error::NetworkError;

/// Why a network cannot be shown frames, or what it says cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SightError {
    /// The network cannot be read.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The mapping has another number of channels than the network.
    #[error(
        "{what} has {found} value{}, but the network's input has {channels} channel{}; give one value, or one per channel",
        plural(*found),
        plural(*channels)
    )]
    Channels {
        /// The option.
        what: &'static str,
        /// How many values it has.
        found: usize,
        /// Channels of the input.
        channels: usize,
    },
    /// The outputs are not those of the detector.
    #[error("{problem}")]
    Detector {
        /// What is expected, and what there is.
        problem: String,
    },
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
