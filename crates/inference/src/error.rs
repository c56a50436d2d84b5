// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong. Every message names the thing and says what to do.

use foveate_design::DesignError;
use foveate_engine::EngineError;
use foveate_footage::FootageError;
use foveate_network::NetworkError;
use foveate_staging::StagingError;
use thiserror::Error;

/// A run that cannot be started or finished.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InferenceError {
    /// The network cannot be read.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// An input cannot be read.
    #[error(transparent)]
    Footage(#[from] FootageError),
    /// The configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A table cannot be written.
    #[error("cannot write the table `{name}`: {source}")]
    Table {
        /// The file.
        name: &'static str,
        /// Why.
        source: std::io::Error,
    },
    /// The mapping has another number of channels than the network.
    #[error(
        "{what} has {found} values, but the network's input has {channels} channels; give one value, or one per channel"
    )]
    Channels {
        /// The option.
        what: &'static str,
        /// How many values it has.
        found: usize,
        /// Channels of the input.
        channels: usize,
    },
    /// The user stopped it before there was a result.
    #[error("interrupted; nothing was written")]
    Cancelled,
}
