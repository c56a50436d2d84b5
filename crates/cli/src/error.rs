// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors that end a command, and their exit codes.

use std::path::{Path, PathBuf};

use foveate_boards::{BoardError, view::ViewError};
use foveate_camera::ConfigError;
use foveate_cosim::{CosimError, EnergyError};
use foveate_emit::EmitError;
use foveate_estimate::{EstimateError, SiliconError};
use foveate_explore::{ExploreError, link::LinkError, studies::StudyError};
use foveate_inference::InferenceError;
use foveate_media::{FootageError, PlaybackError};
use foveate_simulator::SimulatorError;
use foveate_tools::{StagingError, ToolError};
use thiserror::Error;

use crate::interrupt::{self, SignalError};

/// An error that ends a command. The user sees nothing but its message.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// An invalid configuration, from a file or from the command line.
    #[error("{}{error}", file_prefix(file.as_deref()))]
    Config { file: Option<PathBuf>, error: ConfigError },
    #[error(transparent)]
    Tool(#[from] ToolError),
    #[error(transparent)]
    Cosim(#[from] CosimError),
    #[error(transparent)]
    Emit(#[from] EmitError),
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    #[error(transparent)]
    Silicon(#[from] SiliconError),
    #[error(transparent)]
    Energy(Box<EnergyError>),
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    #[error(transparent)]
    Simulator(Box<SimulatorError>),
    #[error(transparent)]
    Study(Box<StudyError>),
    #[error(transparent)]
    Explore(Box<ExploreError>),
    #[error(transparent)]
    Inference(Box<InferenceError>),
    #[error(transparent)]
    Link(Box<LinkError>),
    #[error(transparent)]
    Board(Box<BoardError>),
    #[error(transparent)]
    Output(#[from] StagingError),
    #[error(transparent)]
    View(#[from] ViewError),
    #[error(transparent)]
    Signals(#[from] SignalError),
    /// A file or folder that could not be used.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: std::io::Error },
    /// Arguments that are valid alone, but not in this combination.
    #[error("{0}")]
    Usage(String),
    /// A stop by the user, after which the results so far are in a folder.
    #[error("interrupted; the results so far are in `{}`", path.display())]
    Interrupted { path: PathBuf },
    /// A stop by the user of a command that leaves no files.
    #[error("interrupted after {done}")]
    Stopped { done: String },
    /// A check that has failed, after its details have been printed.
    #[error("{0}")]
    Failed(String),
}

impl From<EnergyError> for CliError {
    fn from(error: EnergyError) -> Self {
        Self::Energy(Box::new(error))
    }
}

impl CliError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Failed(_) => 1,
            Self::Interrupted { .. } | Self::Stopped { .. } => interrupt::exit_code(),
            Self::Config { .. }
            | Self::Emit(_)
            | Self::Output(_)
            | Self::Signals(_)
            | Self::Io { .. }
            | Self::Usage(_) => INPUT_CODE,
            Self::Tool(error) => tool_code(error),
            Self::Cosim(error) => cosim_code(error),
            Self::Estimate(error) => estimate_code(error),
            Self::Silicon(error) => silicon_code(error),
            Self::Energy(error) => energy_code(error),
            Self::Playback(error) => playback_code(error),
            Self::Simulator(error) => simulator_code(error),
            Self::Study(error) => study_code(error),
            Self::Explore(error) => explore_code(error),
            Self::Inference(error) => inference_code(error),
            Self::Link(error) => link_code(error),
            Self::Board(error) => board_code(error),
            Self::View(error) => view_code(error),
        }
    }
}

/// The exit code for bad usage or bad input.
const INPUT_CODE: u8 = 2;
/// The exit code for a tool that is missing or has failed.
const TOOL_CODE: u8 = 3;

// The enums of the libraries are `non_exhaustive`, so each match on one needs an arm for the
// variants that it does not name. Errors of a library are about its input unless a variant says
// otherwise; those of a synthesis are about a tool.

fn tool_code(error: &ToolError) -> u8 {
    if error.is_interrupted() {
        interrupt::exit_code()
    } else if error.is_environment() {
        // The user chooses the folders of the cache and of temporary files.
        INPUT_CODE
    } else {
        TOOL_CODE
    }
}

fn cosim_code(error: &CosimError) -> u8 {
    match error {
        CosimError::Tool(error) => tool_code(error),
        CosimError::EndedEarly { .. } | CosimError::NoModel { .. } => TOOL_CODE,
        _ => INPUT_CODE,
    }
}

fn estimate_code(error: &EstimateError) -> u8 {
    match error {
        EstimateError::Tool(error) => tool_code(error),
        _ => TOOL_CODE,
    }
}

fn silicon_code(error: &SiliconError) -> u8 {
    match error {
        SiliconError::Tool(error) => tool_code(error),
        SiliconError::Netlist { .. } | SiliconError::Timing { .. } => TOOL_CODE,
        _ => INPUT_CODE,
    }
}

fn energy_code(error: &EnergyError) -> u8 {
    match error {
        EnergyError::Silicon(error) => silicon_code(error),
        EnergyError::Playback(error) => playback_code(error),
        EnergyError::Cosim(error) => cosim_code(error),
        EnergyError::Mismatch { .. } => 1,
        EnergyError::Netlist { .. } => TOOL_CODE,
        _ => INPUT_CODE,
    }
}

fn simulator_code(error: &SimulatorError) -> u8 {
    match error {
        SimulatorError::Playback(error) => playback_code(error),
        SimulatorError::Tool(error) | SimulatorError::NoVideo(error) => tool_code(error),
        SimulatorError::VideoOutput { .. } => TOOL_CODE,
        _ => INPUT_CODE,
    }
}

fn study_code(error: &StudyError) -> u8 {
    match error {
        StudyError::Playback(error) => playback_code(error),
        _ => INPUT_CODE,
    }
}

fn explore_code(error: &ExploreError) -> u8 {
    match error {
        ExploreError::Playback(error) => playback_code(error),
        ExploreError::Estimate(error) => estimate_code(error),
        ExploreError::Silicon(error) => silicon_code(error),
        ExploreError::Energy(error) => energy_code(error),
        ExploreError::Link(error) => link_code(error),
        // The input is valid; the answer is that it does not decide.
        ExploreError::Undecided { .. } => 1,
        _ => INPUT_CODE,
    }
}

fn inference_code(error: &InferenceError) -> u8 {
    match error {
        InferenceError::Playback(error) => playback_code(error),
        _ => INPUT_CODE,
    }
}

fn link_code(error: &LinkError) -> u8 {
    match error {
        LinkError::Playback(error) => playback_code(error),
        LinkError::Tool(error) => tool_code(error),
        LinkError::NoEncoder { .. } | LinkError::LostFrames { .. } => TOOL_CODE,
        _ => INPUT_CODE,
    }
}

fn board_code(error: &BoardError) -> u8 {
    match error {
        BoardError::MissingOutput { .. } => TOOL_CODE,
        BoardError::Tool(error) => tool_code(error),
        BoardError::UnknownBoard { .. }
        | BoardError::UnknownSensor { .. }
        | BoardError::Read { .. }
        | BoardError::Invalid { .. }
        | BoardError::Design { .. }
        | BoardError::NoOpenTool { .. }
        | BoardError::Config(_)
        | BoardError::Staging(_) => INPUT_CODE,
    }
}

fn view_code(error: &ViewError) -> u8 {
    match error {
        ViewError::Playback(error) => playback_code(error),
        _ => INPUT_CODE,
    }
}

fn playback_code(error: &PlaybackError) -> u8 {
    match error {
        PlaybackError::Input(_) => INPUT_CODE,
        PlaybackError::Tool(error) => tool_code(error),
        PlaybackError::Interrupted => interrupt::exit_code(),
    }
}

impl From<FootageError> for CliError {
    fn from(error: FootageError) -> Self {
        PlaybackError::from(error).into()
    }
}

impl From<SimulatorError> for CliError {
    fn from(error: SimulatorError) -> Self {
        Self::Simulator(Box::new(error))
    }
}

impl From<StudyError> for CliError {
    fn from(error: StudyError) -> Self {
        Self::Study(Box::new(error))
    }
}

impl From<ExploreError> for CliError {
    fn from(error: ExploreError) -> Self {
        Self::Explore(Box::new(error))
    }
}

impl From<BoardError> for CliError {
    fn from(error: BoardError) -> Self {
        match error {
            BoardError::Tool(error) => error.into(),
            BoardError::Config(error) => error.into(),
            BoardError::Staging(error) => error.into(),
            error => Self::Board(Box::new(error)),
        }
    }
}

impl From<LinkError> for CliError {
    fn from(error: LinkError) -> Self {
        Self::Link(Box::new(error))
    }
}

impl From<InferenceError> for CliError {
    fn from(error: InferenceError) -> Self {
        Self::Inference(Box::new(error))
    }
}

impl From<ConfigError> for CliError {
    fn from(error: ConfigError) -> Self {
        Self::Config { file: None, error }
    }
}

fn file_prefix(file: Option<&Path>) -> String {
    file.map(|file| format!("{}: ", file.display())).unwrap_or_default()
}
