// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a benchmark. A missing tool is a row of the result, and a mismatch is a result;
//! neither is an error.

use foveate_cosim::CosimError;
use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_frame::FrameError;
use foveate_model::ModelError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// The error that is returned if a benchmark has no result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BenchmarkError {
    /// The vectors could not be made, or a simulator failed.
    #[error(transparent)]
    Cosim(#[from] CosimError),
    /// Pixels do not make a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A frame does not have the size and depth of the design.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The part of the design for the netlist is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The vectors could not be read back.
    #[error("cannot read `{path}`: {source}")]
    Vectors {
        /// The path of the file.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
    /// There is no frame to run.
    #[error("no frame to run; give at least one")]
    NoFrames,
    /// The user stopped the benchmark.
    #[error("interrupted")]
    Interrupted,
}

impl BenchmarkError {
    /// Returns true if the user stopped the benchmark.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        match self {
            Self::Interrupted | Self::Cosim(CosimError::Tool(ToolError::Interrupted)) => true,
            Self::Cosim(error) => error.is_interrupted(),
            _ => false,
        }
    }
}
