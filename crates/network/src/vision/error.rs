// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of feeding frames to a network and of reading its outputs.

use crate::error::NetworkError;

/// The reason why a network cannot take frames, or why its outputs cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum VisionError {
    /// The network cannot be read.
    #[error(transparent)]
    InvalidNetwork(#[from] NetworkError),
    /// The mapping has another number of channels than the network.
    #[error(
        "{what} has {found} value{}, but the network's input has {channels} channel{}; give one value, or one per channel",
        plural(*found),
        plural(*channels)
    )]
    ChannelCount { what: &'static str, found: usize, channels: usize },
    /// The outputs do not have the format of the detector.
    #[error("{problem}")]
    DetectorFormat { problem: String },
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
