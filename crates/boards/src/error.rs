// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of boards, and of designs for them.

use std::path::PathBuf;

use foveate_camera::ConfigError;
use foveate_tools::{StagingError, ToolError};
use thiserror::Error;

/// An error that prevents a project or a bitstream.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum BoardError {
    /// There is no board of that name.
    #[error("unknown board `{name}`; boards are {known}, or a file NAME.toml")]
    UnknownBoard { name: String, known: String },
    /// There is no sensor of that name.
    #[error(
        "unknown sensor `{name}`; sensors are {known}, and `pattern` for a pattern in place of a sensor"
    )]
    UnknownSensor { name: String, known: String },
    /// A file of a board or a sensor cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    /// The script has not left a file that it should make.
    #[error("the build did not write `{}`: {source}", path.display())]
    MissingOutput { path: PathBuf, source: std::io::Error },
    /// A file of a board or a sensor is not valid.
    #[error("the board `{name}` is not valid: {reason}")]
    Invalid { name: String, reason: String },
    /// The design does not fit the board or its sensor.
    #[error("this design does not fit the board `{name}`: {reason}")]
    Design { name: String, reason: String },
    /// No open tool makes a bitstream for the board.
    #[error("no open tool makes a bitstream for `{name}`; its folder has the scripts for Vivado")]
    NoOpenTool { name: String },
    /// The configuration is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The folder cannot be written.
    #[error(transparent)]
    Staging(#[from] StagingError),
    /// A tool is missing or has failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
}
