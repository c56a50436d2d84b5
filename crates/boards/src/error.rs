// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a board, and with what is to stand on it.

use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_staging::StagingError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// Why there is no project, or no bitstream.
#[derive(Debug, Error)]
pub enum BoardError {
    /// No board of that name.
    #[error("there is no board `{name}`; there are {known}; a file with one ends in .toml")]
    Board {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// No sensor of that name.
    #[error(
        "there is no sensor `{name}`; there are {known}, and `pattern` for a pattern in place of one"
    )]
    Sensor {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A file of a board cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// What the script should have left is not there.
    #[error("the build left no `{}`: {source}", path.display())]
    Left {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file of a board is none.
    #[error("the board `{name}` is not valid: {reason}")]
    Invalid {
        /// The board.
        name: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A design that does not fit the board or its sensor.
    #[error("this design does not fit the board `{name}`: {reason}")]
    Design {
        /// The board.
        name: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// No open tool makes a bitstream for it.
    #[error("no open tool makes a bitstream for `{name}`; its folder has the scripts for Vivado")]
    Closed {
        /// The board.
        name: String,
    },
    /// The configuration is none.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The folder cannot be written.
    #[error(transparent)]
    Staging(#[from] StagingError),
    /// A tool is missing, or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
}
