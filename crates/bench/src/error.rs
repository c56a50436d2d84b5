// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why there is no result; a missing tool is a row that says so, and a difference is a result.

use foveate_cosim::CosimError;
use foveate_design::DesignError;
use foveate_engine::EngineError;
use foveate_frame::FrameError;
use foveate_model::ModelError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// Why a bench could not come to a result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BenchError {
    /// Vectors could not be made, or a simulator failed.
    #[error(transparent)]
    Cosim(#[from] CosimError),
    /// Pixels are no frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A frame is not of the design's kind.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The part of the design that goes into the netlist is none.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// The vectors could not be read back.
    #[error("cannot read `{path}`: {source}")]
    Vectors {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// There is nothing to run.
    #[error("no frame to run; give at least one")]
    NoFrames,
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

impl BenchError {
    /// Whether the user stopped it.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        match self {
            Self::Interrupted | Self::Cosim(CosimError::Tool(ToolError::Interrupted)) => true,
            Self::Cosim(error) => error.is_interrupted(),
            _ => false,
        }
    }
}
