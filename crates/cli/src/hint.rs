// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hints about former names of options. Only the user knows which of the present options is meant.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

const FPS_HINT: &str = "'--fps' is now two options: '--input-fps' limits the frames per second that are read from the \
                   inputs, and '--min-fps' is the rate that a design must reach (check, fit)";

/// Returns the error. If it is about an option that no longer exists, a hint is added.
pub(crate) fn with_hint(mut error: clap::Error) -> clap::Error {
    let named = matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(name)) if name == "--fps");
    if error.kind() == ErrorKind::UnknownArgument && named {
        error.remove(ContextKind::SuggestedArg);
        error.insert(
            ContextKind::Suggested,
            ContextValue::StyledStrs(vec![StyledStr::from(FPS_HINT)]),
        );
    }
    error
}
