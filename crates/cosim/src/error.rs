// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of a co-simulation. A mismatch is a result and not an error.

use foveate_camera::ConfigError;
use foveate_engine::EngineError;
use foveate_model::ModelError;
use foveate_pixels::FrameError;
use foveate_timed::TimedError;
use foveate_tools::{StagedFolder, StagingError, ToolError};
use std::path::{Path, PathBuf};

/// The reason for which a co-simulation has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum CosimError {
    /// A tool is missing, too old, or refused its input.
    #[error(transparent)]
    Tool(ToolError),

    /// A cell of the netlist cannot be simulated.
    #[error(
        "Yosys has no simulation model of the cell `{cell}`; co-simulate the RTL of this design instead, \
         or the netlist of a design without that cell"
    )]
    NoModel { cell: String },

    /// The netlist does not implement the Verilog.
    #[error(
        "{yosys} wires block RAM of 64 bits and more wrongly (YosysHQ/yosys#5833), so its netlist is not this design; \
         take a Yosys of May 2026 or later (FOVEATE_YOSYS), fewer `hardware.pixels_per_clock`, or co-simulate the RTL"
    )]
    MiswiredBlockRam { yosys: String },

    /// The design does not allow the requested settings.
    #[error(transparent)]
    Design(#[from] ConfigError),

    /// The hierarchy that Verilator wrote cannot be read.
    #[error("the hierarchy that Verilator wrote cannot be read: {why}; Verilator 5 is expected")]
    UnreadableHierarchy { why: String },

    /// The Verilog has no module with the name that is to be simulated.
    #[error("the Verilog ({files}) has no module `{top}`; give the sources of the whole core")]
    NoTop { top: String, files: String },

    /// The Verilog's top module lacks a port of the design.
    #[error("module `{top}` has no port `{port}`; the Verilog may belong to another design")]
    NoPort { top: String, port: String },

    /// A port of the Verilog's top module is not as wide as the design's.
    #[error(
        "port `{port}` of module `{top}` has {found} bits, but the design has {wanted}; \
         the Verilog may belong to another design"
    )]
    PortWidth { top: String, port: String, found: u32, wanted: u32 },

    /// There is nothing to simulate. This must not look like a run without a mismatch.
    #[error(
        "there is nothing to simulate: no frames are given and rounds is 0; give frames, or 1 round or more"
    )]
    NothingToSimulate,

    /// A benchmark has no frame to run.
    #[error("no frame to run; give at least one")]
    NoFrames,

    /// The array is too large for memory.
    #[error(
        "an array of {regions} regions, which take {pixels} pixels per frame, is too large to simulate; \
         the limits are {max_regions} regions and {max_pixels} pixels, so simulate a part of it as `rcm`"
    )]
    TooLarge { regions: u64, pixels: u64, max_regions: u64, max_pixels: u64 },

    /// A frame does not fit the design.
    #[error(
        "frame {index} has {found}, but the design takes {wanted}; \
         set frame.width, frame.height and frame.pixel_bits to match"
    )]
    FrameShape { index: usize, found: String, wanted: String },

    /// The model refused a frame or an input.
    #[error("the model refused its input: {reason}")]
    Model { reason: String },

    /// The engine refused a frame, or its threads cannot be started.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The timed model of a benchmark refuses a delivery.
    #[error(transparent)]
    Timed(#[from] TimedError),

    /// The simulator ended early.
    #[error("{simulator} ended after {got} of {clocks} clocks ({status}){log}")]
    EndedEarly { simulator: String, clocks: u64, got: u64, status: String, log: String },

    /// The folder for the replay cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),

    /// The vectors, which are temporary files, cannot be written.
    #[error(
        "cannot {action} `{}`: {source}; set TMPDIR to a writable folder with free space",
        path.display()
    )]
    TemporaryFile { action: &'static str, path: PathBuf, source: std::io::Error },

    /// A file could not be used.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: std::io::Error },
}

impl From<ToolError> for CosimError {
    /// Converts a tool's error. Verilog that does not fit the design is not a failure of the tool
    /// that noticed it.
    fn from(error: ToolError) -> Self {
        match error {
            ToolError::PortWidth { top, port, found, wanted } => {
                Self::PortWidth { top, port, found, wanted }
            }
            ToolError::MissingPort { top, port } => Self::NoPort { top, port },
            error => Self::Tool(error),
        }
    }
}

impl From<FrameError> for CosimError {
    fn from(error: FrameError) -> Self {
        Self::Model { reason: error.to_string() }
    }
}

impl From<ModelError> for CosimError {
    fn from(error: ModelError) -> Self {
        Self::Model { reason: error.to_string() }
    }
}

impl CosimError {
    /// Returns true if the user has stopped the run.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        matches!(self, Self::Tool(error) if error.is_interrupted())
    }

    /// Returns true if the error is about a file or folder that the user chooses, and not about a
    /// tool.
    #[must_use]
    pub fn is_environment(&self) -> bool {
        match self {
            Self::Tool(error) => error.is_environment(),
            Self::TemporaryFile { .. } | Self::Output(_) | Self::Io { .. } => true,
            _ => false,
        }
    }

    /// Returns the error with paths as the user knows them: those in a staged folder are shown in
    /// the output folder.
    #[must_use]
    pub fn with_final_paths(self, staged: &StagedFolder) -> Self {
        match self {
            Self::Output(error) => Self::Output(staged.with_shown_path(error)),
            Self::Io { action, path, source } => {
                Self::Io { action, path: staged.shown_path(&path), source }
            }
            other => other,
        }
    }

    /// Returns a function for `map_err` that reports a failure in the folder of temporary files.
    pub(crate) fn temporary(
        action: &'static str,
        path: &Path,
    ) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::TemporaryFile { action, path: path.to_owned(), source }
    }

    /// Returns a function for `map_err` that reports a file and the attempted action.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}
