// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exceptions for errors. The messages are those of the command line.

use std::error::Error;
use std::io::{self, ErrorKind};
use std::path::Path;

use foveate_camera::ConfigError;
use foveate_cosim::CosimError;
use foveate_engine::EngineError;
use foveate_estimate::EstimateError;
use foveate_explore::ExploreError;
use foveate_inference::InferenceError;
use foveate_media::{FootageError, InputError, PlaybackError, boxes::BoxError};
use foveate_simulator::SimulatorError;
use foveate_timed::TimedError;
use foveate_tools::{StagingError, ToolError as Tool};
use pyo3::exceptions::{
    PyFileExistsError, PyFileNotFoundError, PyIndexError, PyIsADirectoryError, PyKeyboardInterrupt,
    PyNotADirectoryError, PyOSError, PyPermissionError, PyRuntimeError, PyValueError,
};
use pyo3::{PyErr, create_exception};

create_exception!(
    foveate,
    ToolError,
    PyRuntimeError,
    "An external tool, such as Yosys or ffmpeg, is missing, too old, or has failed."
);

/// Returns Python's exception for an error of a crate.
pub(crate) trait Raise {
    fn raise(self) -> PyErr;
}

/// Returns Python's exception for an error, for use in `map_err`.
pub(crate) fn raise(error: impl Raise) -> PyErr {
    error.raise()
}

/// Returns a ValueError about a value, for use in `map_err`.
pub(crate) fn value_error(problem: impl ToString) -> PyErr {
    PyValueError::new_err(problem.to_string())
}

/// Returns the exception for the kind of an error of the operating system, with the project's message.
pub(crate) fn os_error(source: &io::Error, message: String) -> PyErr {
    match source.kind() {
        ErrorKind::NotFound => PyFileNotFoundError::new_err(message),
        ErrorKind::AlreadyExists => PyFileExistsError::new_err(message),
        ErrorKind::PermissionDenied => PyPermissionError::new_err(message),
        ErrorKind::IsADirectory => PyIsADirectoryError::new_err(message),
        ErrorKind::NotADirectory => PyNotADirectoryError::new_err(message),
        // The reader refuses the content or the length of the file.
        ErrorKind::InvalidData | ErrorKind::FileTooLarge => PyValueError::new_err(message),
        _ => PyOSError::new_err(message),
    }
}

/// Returns a ValueError about a value, or the exception of an error of the operating system that caused it.
fn behind(error: &(dyn Error + 'static)) -> PyErr {
    let mut cause = Some(error);
    while let Some(own) = cause {
        if let Some(source) = own.downcast_ref::<io::Error>() {
            return os_error(source, error.to_string());
        }
        cause = own.source();
    }
    value_error(error)
}

/// Finds the exception for a file that could not be read, if only a text of the error is left.
fn unread(path: &Path, message: String) -> PyErr {
    let directory = || io::Error::from(ErrorKind::IsADirectory);
    let cause = match std::fs::File::open(path) {
        Err(error) => Some(error),
        Ok(_) => path.is_dir().then(directory),
    };
    cause.map_or_else(
        || PyOSError::new_err(message.clone()),
        |cause| os_error(&cause, message.clone()),
    )
}

/// Defines the exceptions of errors. A variant that is not listed is a fault of a value, or of a file behind it.
macro_rules! raise_as {
    ($message:ident: $($error:ty { $($variant:pat => $raised:expr,)* })*) => {$(
        impl Raise for $error {
            #[allow(unreachable_patterns, unused_variables, reason = "some errors list all variants")]
            fn raise(self) -> PyErr {
                let $message = self.to_string();
                match self {
                    $($variant => $raised,)*
                    _ => behind(&self),
                }
            }
        }
    )*};
}

raise_as! { message:
    ConfigError {}
    EngineError {
        Self::Threads { .. } => PyRuntimeError::new_err(message),
    }
    TimedError {
        Self::Engine(error) => error.raise(),
    }
    Tool {
        Self::Interrupted => PyKeyboardInterrupt::new_err(()),
        _ => ToolError::new_err(message),
    }
    FootageError {
        Self::Missing { .. } => PyFileNotFoundError::new_err(message),
        Self::Unreadable { ref path, .. } => unread(path, message),
        Self::Tool(error) => error.raise(),
    }
    InputError {
        Self::Footage(error) => error.raise(),
        Self::Boxes(BoxError::Missing { .. }) => PyFileNotFoundError::new_err(message),
        Self::RefusedFrame(error) => error.raise(),
    }
    PlaybackError {
        Self::Input(error) => error.raise(),
        Self::Tool(error) => error.raise(),
        Self::Interrupted => PyKeyboardInterrupt::new_err(()),
    }
    StagingError {
        Self::Unwritable { ref source, .. } => os_error(source, message),
        // An option of the command line is an argument of a function here.
        _ => PyFileExistsError::new_err(message.replace("--force", "force=True")),
    }
    SimulatorError {
        Self::Playback(error) => error.raise(),
        Self::Output(error) => error.raise(),
        Self::Tool(error) => error.raise(),
        Self::NoSuchRegion { .. } | Self::NoSuchFrame { .. } => PyIndexError::new_err(message),
    }
    ExploreError {
        Self::Playback(error) => error.raise(),
    }
    InferenceError {
        Self::Playback(error) => error.raise(),
        Self::Output(error) => error.raise(),
    }
    CosimError {
        Self::Tool(error) => error.raise(),
        Self::Output(error) => error.raise(),
    }
    EstimateError {
        Self::Tool(error) => error.raise(),
        _ => ToolError::new_err(message),
    }
}
