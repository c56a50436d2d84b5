// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a command ended, and with which exit code.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use foveate_cosim::CosimError;
use foveate_estimate::EstimateError;
use foveate_simulator::SimulatorError;
use foveate_spec::SpecError;
use foveate_staging::StagingError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// Why a command did not end well. The message is all that the user sees.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// A configuration that is no design, from a file or from the command line.
    #[error("{}{error}", origin(file.as_deref()))]
    Spec { file: Option<PathBuf>, error: SpecError },
    #[error(transparent)]
    Tool(#[from] ToolError),
    #[error(transparent)]
    Cosim(#[from] CosimError),
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    #[error(transparent)]
    Simulator(Box<SimulatorError>),
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A file or folder could not be used.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: std::io::Error },
    /// Arguments that are valid alone but not here.
    #[error("{0}")]
    Usage(String),
    /// The user stopped it; what was done is there.
    #[error("interrupted; what was done until then is in `{}`", path.display())]
    Interrupted { path: PathBuf },
    /// The check that was asked for did not hold; what and where has been printed.
    #[error("{0}")]
    Failed(String),
}

impl CliError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Failed(_) => 1,
            Self::Interrupted { .. } => 130,
            Self::Tool(_)
            | Self::Cosim(CosimError::Tool(_) | CosimError::Short { .. })
            | Self::Estimate(_) => 3,
            Self::Simulator(error) => simulator_code(error),
            _ => 2,
        })
    }
}

fn simulator_code(error: &SimulatorError) -> u8 {
    match error {
        SimulatorError::Cancelled => 130,
        SimulatorError::Tool(_)
        | SimulatorError::NoVideo(_)
        | SimulatorError::VideoOutput { .. } => 3,
        _ => 2,
    }
}

impl From<SimulatorError> for CliError {
    fn from(error: SimulatorError) -> Self {
        Self::Simulator(Box::new(error))
    }
}

impl From<SpecError> for CliError {
    fn from(error: SpecError) -> Self {
        Self::Spec { file: None, error }
    }
}

fn origin(file: Option<&Path>) -> String {
    file.map(|file| format!("{}: ", file.display())).unwrap_or_default()
}
